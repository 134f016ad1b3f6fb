//! Shapes: spheres, discs and bilinear patches as they are, others as meshes.

use super::Lowering;
use super::loop_subdivision;
use super::material::LoweredMaterial;
use super::medium::InterfaceMedia;
use super::parameter::Parameters;
use super::plugins::SHAPES;
use crate::exchange::one_sided::{behind, flat, flat_mesh};
use crate::exchange::round::{disc, sphere};
use crate::exchange::tessellate;
use crate::exchange::transform::AffineTransform;
use crate::exchange::{SURFACE_BYTES, SpannedText};
use crate::mesh::{self, TextParseError};
use crate::over_limit;
use rtc_diag::{clip_words, codes};
use rtc_ir::{EntityKind, Mesh, MeshId, Quad, Shape, Surface, VertexColumn};
use rtc_math::{Vec3, acos, cos, sin, unit};
use rtc_source::{FileKind, Resource, Span};
use std::rc::Rc;

/// Mesh files, which may be compressed.
const PLY: FileKind = FileKind {
    extensions: &["ply", "gz"],
    begins: |head| head.starts_with(b"ply") || super::file::is_gzip(head),
};

/// The memory of a vertex with its triangles, in bytes, rounded up.
const VERTEX_BYTES: u64 = 128;
/// The rows of a round profile.
const ROWS: u32 = 32;
/// The most levels of subdivision: each has four times the triangles of the one before.
const MAX_LEVELS: u32 = 12;
/// The time that a vertex of a subdivided mesh takes, in vertices of a mesh that is read.
const SUBDIVISION_COST: u64 = 20;

/// The geometry of a shape in its own coordinates.
#[derive(Clone, Debug)]
enum ShapeGeometry {
    /// A whole sphere about the origin.
    Sphere(f64),
    /// A whole disc about +z.
    Disc {
        height: f64,
        radius: f64,
    },
    Mesh(MeshId),
    /// A bilinear patch by its corners in order around it.
    Patch([[f64; 3]; 4]),
}

/// A shape with its transform.
#[derive(Clone, Debug)]
pub(super) struct PlacedShape {
    geometry: ShapeGeometry,
    to_world: AffineTransform,
    material: Rc<LoweredMaterial>,
    radiance: [f64; 3],
    opacity: f64,
    media: InterfaceMedia,
    span: Span,
}

impl Lowering<'_> {
    /// A shape directive.
    pub(super) fn shape(&mut self, plugin: &SpannedText, parameters: &Parameters, span: Span) {
        let material = match &self.state.material {
            Some(material) => Rc::clone(material),
            None => self.default_material(),
        };
        // A constant opacity is that of the shape, a texture is one of the material.
        parameters.skip(&["shadowalpha"]);
        let opacity = self.number_or_map(parameters, "alpha", 1.0);
        let (material, opacity) = match opacity.map.is_some() {
            true => (self.covered(&material, opacity, span), 1.0),
            false => (material, opacity.number.clamp(0.0, 1.0)),
        };
        let geometries = self.geometries(plugin, parameters, &material);
        self.ignored("shape", &plugin.text, (&SHAPES, parameters));
        let Some(geometries) = geometries else { return };
        let (to_world, media) = (self.state.transform, self.state.media);
        for geometry in geometries {
            let (radiance, back) = self.emitted(&geometry, &to_world);
            let shape = PlacedShape {
                geometry,
                to_world,
                material: Rc::clone(&material),
                radiance,
                opacity,
                media,
                span,
            };
            let back = back.map(|to_world| PlacedShape {
                radiance: [0.0; 3],
                media: InterfaceMedia::default(),
                to_world,
                ..shape.clone()
            });
            if self.open_object.is_some() {
                if self.charge(Resource::Memory, SURFACE_BYTES, span).is_none() {
                    return;
                }
                if let Some((_, shapes)) = &mut self.open_object {
                    shapes.push(shape);
                }
            } else if self.place(&shape, &AffineTransform::IDENTITY).is_none() {
                return;
            }
            if back.is_some_and(|back| self.place(&back, &AffineTransform::IDENTITY).is_none()) {
                return;
            }
        }
    }

    /// The radiance of a shape by the current area light, and the transform of a second shape that
    /// covers its back, if any.
    fn emitted(
        &mut self,
        geometry: &ShapeGeometry,
        to_world: &AffineTransform,
    ) -> ([f64; 3], Option<AffineTransform>) {
        const DARK: ([f64; 3], Option<AffineTransform>) = ([0.0; 3], None);
        let Some(light) = self.state.area_light.clone() else {
            return DARK;
        };
        let span = light.text().span;
        if self.open_object.is_some() {
            let message = "the light of a shape in an object is left out";
            self.report(&codes::PBRT_PLUGIN, span, message);
            return DARK;
        }
        let Some(radiance) = light.radiance(self.area(geometry, to_world)) else {
            let message = "the power of a light whose area is not known is left out";
            self.report(&codes::PBRT_PLUGIN, span, message);
            return DARK;
        };
        // No camera is inside a sphere.
        if light.is_two_sided() || matches!(geometry, ShapeGeometry::Sphere(_)) {
            return (radiance, None);
        }
        let back = self.behind(geometry, to_world);
        if back.is_none() {
            self.approximate(span, "the light shines from both sides of its shape");
        }
        (radiance, back)
    }

    /// A transform just behind a flat shape, relative to its normal; `None` if it is curved.
    fn behind(
        &self,
        geometry: &ShapeGeometry,
        to_world: &AffineTransform,
    ) -> Option<AffineTransform> {
        let (normal, extent) = match geometry {
            ShapeGeometry::Sphere(_) => return None,
            ShapeGeometry::Disc { radius, .. } => {
                let side = if self.state.reverse_orientation {
                    -1.0
                } else {
                    1.0
                };
                (Vec3::Z * side, radius * 2.0)
            }
            ShapeGeometry::Mesh(id) => flat_mesh(self.scene.meshes.get(id.0 as usize)?)?,
            ShapeGeometry::Patch(corners) => {
                let [a, b, c, d] = corners.map(Vec3::from_array);
                flat([[a, b, c], [a, c, d]].into_iter())?
            }
        };
        let back = behind(normal, extent, to_world)?;
        Some(AffineTransform::translation(back.to_array()).after(to_world))
    }

    fn area(&self, geometry: &ShapeGeometry, to_world: &AffineTransform) -> Option<f64> {
        let point = |p: [f64; 3]| to_world.point(Vec3::from_array(p));
        let triangle = |a: Vec3, b: Vec3, c: Vec3| (b - a).cross(c - a).length() / 2.0;
        match geometry {
            ShapeGeometry::Sphere(radius) => {
                let radius = radius * to_world.similarity()?;
                Some(4.0 * std::f64::consts::PI * radius * radius)
            }
            ShapeGeometry::Disc { radius, .. } => {
                let AffineTransform([x, y, ..]) = to_world;
                Some(std::f64::consts::PI * radius * radius * x.cross(*y).length())
            }
            ShapeGeometry::Mesh(id) => {
                let mesh = self.scene.meshes.get(id.0 as usize)?;
                let corner = |index: u32| point(mesh.positions.at(index as usize));
                let triangles = mesh.triangles.iter();
                let areas = triangles.map(|[a, b, c]| triangle(corner(*a), corner(*b), corner(*c)));
                Some(areas.sum())
            }
            ShapeGeometry::Patch(corners) => {
                let [a, b, c, d] = corners.map(point);
                Some(triangle(a, b, c) + triangle(a, c, d))
            }
        }
    }

    /// Adds a shape to the scene, moved by `outer`. `None` if the budget is used up.
    pub(super) fn place(&mut self, placed: &PlacedShape, outer: &AffineTransform) -> Option<()> {
        let to_world = outer.after(&placed.to_world);
        let is_lit = placed.radiance != [0.0; 3];
        if placed.opacity == 0.0 && !is_lit && !placed.media.is_transition() {
            return Some(());
        }
        let span = placed.span;
        let material = self.material_id(
            &placed.material,
            placed.radiance,
            (placed.opacity, placed.media),
            span,
        );
        let Some(material) = material else {
            // Light passes through: the shape bounds a medium, or nothing.
            return (!self.is_exhausted).then_some(());
        };
        self.charge(Resource::Surfaces, 1, span)?;
        self.charge(Resource::Memory, SURFACE_BYTES, span)?;
        let shape = self.placed(&placed.geometry, &to_world, span)?;
        self.record(EntityKind::Surface, self.scene.surfaces.len(), span);
        self.scene.surfaces.push(Surface::new(shape, material));
        Some(())
    }

    fn placed(
        &mut self,
        geometry: &ShapeGeometry,
        to_world: &AffineTransform,
        span: Span,
    ) -> Option<Shape> {
        Some(match geometry {
            ShapeGeometry::Sphere(radius) => sphere(*radius, to_world),
            ShapeGeometry::Disc { height, radius } => match disc(*height, *radius, to_world) {
                Some(disc) => Shape::Disc(disc),
                None => {
                    let mesh = flat_disc(*height, *radius, 0.0, std::f64::consts::TAU);
                    let id = self.charged_mesh(mesh, span)?;
                    to_world.instance(id)
                }
            },
            ShapeGeometry::Mesh(id) => to_world.instance(*id),
            ShapeGeometry::Patch(corners) => Shape::Quad(Quad {
                vertices: corners.map(|corner| to_world.point(Vec3::from_array(corner)).to_array()),
            }),
        })
    }

    fn geometries(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        material: &LoweredMaterial,
    ) -> Option<Vec<ShapeGeometry>> {
        let geometry = match SHAPES.known(&plugin.text) {
            "sphere" => self.sphere_shape(plugin, parameters, material),
            "disk" => self.disk_shape(plugin, parameters, material),
            "cylinder" | "cone" | "paraboloid" | "hyperboloid" => {
                self.round_shape(plugin, parameters)
            }
            "trianglemesh" => self.triangle_mesh(plugin, parameters, material),
            "plymesh" => self.ply_mesh(plugin, parameters),
            "loopsubdiv" => self.subdivided(plugin, parameters),
            "bilinearmesh" => return self.bilinear_mesh(plugin, parameters),
            _ => {
                parameters.skip(&[
                    "P", "N", "indices", "type", "width", "width0", "width1", "degree",
                ]);
                self.unsupported("shape", plugin, &SHAPES, "it is left out");
                None
            }
        };
        geometry.map(|geometry| vec![geometry])
    }

    fn sphere_shape(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        material: &LoweredMaterial,
    ) -> Option<ShapeGeometry> {
        let number = |name, default| parameters.number(name).unwrap_or(default);
        let radius = number("radius", 1.0).abs();
        let low = number("zmin", -radius).clamp(-radius, radius);
        let high = number("zmax", radius).clamp(-radius, radius);
        let (low, high) = (low.min(high), low.max(high));
        let phi = number("phimax", 360.0).clamp(0.0, 360.0);
        if radius == 0.0 {
            self.mistake(plugin.span, "the sphere has no radius");
            return None;
        }
        let is_whole = low <= -radius && high >= radius && phi >= 360.0;
        if is_whole {
            if self.state.reverse_orientation && material.transmits() {
                let message = "a sphere of glass has its inside inside, whatever its orientation";
                self.approximate(plugin.span, message);
            }
            return Some(ShapeGeometry::Sphere(radius));
        }
        self.approximate(plugin.span, "the part of a sphere is shown as a mesh");
        // v runs from the lower end to the upper one.
        let theta = |z: f64| acos((z / radius).clamp(-1.0, 1.0));
        let (from, to) = (theta(low), theta(high));
        let profile = (0..=ROWS).map(|row| {
            let angle = from + (to - from) * f64::from(row) / f64::from(ROWS);
            // The poles are points.
            let ring = sin(angle);
            let ring = if ring < 1e-12 { 0.0 } else { ring };
            let normal = Vec3::new(ring, 0.0, cos(angle));
            (normal * radius, normal)
        });
        self.revolved(profile.collect(), phi, plugin.span)
    }

    fn disk_shape(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        material: &LoweredMaterial,
    ) -> Option<ShapeGeometry> {
        let number = |name, default| parameters.number(name).unwrap_or(default);
        let (height, radius) = (number("height", 0.0), number("radius", 1.0).abs());
        let inner = number("innerradius", 0.0).clamp(0.0, radius);
        let phi = number("phimax", 360.0).clamp(0.0, 360.0);
        if radius == 0.0 {
            self.mistake(plugin.span, "the disk has no radius");
            return None;
        }
        if inner == 0.0 && phi >= 360.0 && !material.has_maps() {
            return Some(ShapeGeometry::Disc { height, radius });
        }
        self.approximate(plugin.span, "the disk is shown as a mesh");
        let mesh = flat_disc(height, radius, inner, phi.to_radians());
        self.charged_mesh(self.oriented(mesh), plugin.span)
            .map(ShapeGeometry::Mesh)
    }

    /// A shape that a profile sweeps about +z.
    fn round_shape(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
    ) -> Option<ShapeGeometry> {
        let message = format!("the {} is shown as a mesh", plugin.text);
        self.approximate(plugin.span, message);
        let number = |name, default| parameters.number(name).unwrap_or(default);
        let point = |name, default| Vec3::from_array(parameters.vector(name).unwrap_or(default));
        let radius = || number("radius", 1.0).abs();
        let phi = number("phimax", 360.0).clamp(0.0, 360.0);
        // The normal of a surface of revolution: across a line of its profile and the turn.
        let normal =
            |p: Vec3, along: Vec3| unit(Vec3::new(-p.y, p.x, 0.0).cross(along)).unwrap_or(Vec3::Z);
        // A line in a plane with the axis has one normal.
        let flat = |from: Vec3, to: Vec3| [from, to].map(|p| (p, normal(from, to - from))).to_vec();
        let line = |from: Vec3, to: Vec3| {
            let along = to - from;
            let rows = (0..=ROWS).map(|row| from + along * (f64::from(row) / f64::from(ROWS)));
            rows.map(|p| (p, normal(p, along))).collect::<Vec<_>>()
        };
        let profile = match plugin.text.as_str() {
            "cylinder" => {
                let (low, high) = (number("zmin", -1.0), number("zmax", 1.0));
                let radius = radius();
                flat(Vec3::new(radius, 0.0, low), Vec3::new(radius, 0.0, high))
            }
            "cone" => flat(
                Vec3::new(radius(), 0.0, 0.0),
                Vec3::Z * number("height", 1.0),
            ),
            "hyperboloid" => line(point("p1", [0.0; 3]), point("p2", [1.0; 3])),
            _ => {
                let (low, high) = (number("zmin", 0.0).max(0.0), number("zmax", 1.0));
                let radius = radius();
                let rows = (0..=ROWS).map(|row| {
                    let z = low + (high - low) * f64::from(row) / f64::from(ROWS);
                    let r = radius * (z / high).max(0.0).sqrt();
                    // The gradient of r² − z·radius²/zmax.
                    let normal = Vec3::new(2.0 * r, 0.0, -radius * radius / high);
                    (Vec3::new(r, 0.0, z), unit(normal).unwrap_or(Vec3::NEG_Z))
                });
                rows.collect()
            }
        };
        self.revolved(profile, phi, plugin.span)
    }

    fn revolved(
        &mut self,
        profile: Vec<(Vec3, Vec3)>,
        degrees: f64,
        span: Span,
    ) -> Option<ShapeGeometry> {
        let is_finite = |(point, normal): &(Vec3, Vec3)| point.is_finite() && normal.is_finite();
        if !profile.iter().all(is_finite) {
            self.mistake(span, "the shape has no size");
            return None;
        }
        let mesh = tessellate::revolved(&profile, degrees.to_radians());
        self.charged_mesh(self.oriented(mesh), span)
            .map(ShapeGeometry::Mesh)
    }

    /// A mesh of a size that is known before.
    fn charged_mesh(&mut self, mesh: Mesh, span: Span) -> Option<MeshId> {
        let vertices = mesh.positions.len() as u64;
        self.charge(Resource::Vertices, vertices, span)?;
        self.charge(Resource::Memory, VERTEX_BYTES * vertices, span)?;
        Some(self.add_mesh(mesh, span))
    }

    /// A mesh whose triangles turn as its normals say, as pbrt has it, and to the other side if the
    /// orientation is reversed.
    fn oriented(&self, mut mesh: Mesh) -> Mesh {
        let is_reversed = self.state.reverse_orientation;
        if mesh.normals.is_empty() && !is_reversed {
            return mesh;
        }
        let (positions, normals) = (&mesh.positions, &mesh.normals);
        let at = |column: &VertexColumn<3>, index: u32| Vec3::from_array(column.at(index as usize));
        let turned = |triangle: &[u32; 3]| {
            let [a, b, c] = *triangle;
            let [p, q, r] = triangle.map(|corner| at(positions, corner));
            let is_against = !normals.is_empty() && {
                let normal: Vec3 = triangle.iter().map(|corner| at(normals, *corner)).sum();
                (q - p).cross(r - p).dot(normal) < 0.0
            };
            if is_against == is_reversed {
                [a, b, c]
            } else {
                [a, c, b]
            }
        };
        mesh.triangles = mesh.triangles.iter().map(turned).collect();
        if is_reversed {
            mesh.normals = VertexColumn::rounded(mesh.normals.iter().map(|n| n.map(|c| -c)));
        }
        mesh
    }

    /// The indices of a mesh with corners by `size`, all in range.
    fn indices<const N: usize>(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        vertices: usize,
    ) -> Option<Vec<[u32; N]>> {
        let Some(numbers) = parameters.numbers("indices") else {
            let only = std::array::from_fn(|corner| u32::try_from(corner).unwrap_or(0));
            if vertices == N {
                return Some(vec![only]);
            }
            self.mistake(plugin.span, "the mesh has no `indices`");
            return None;
        };
        let (cells, []) = numbers.as_chunks::<N>() else {
            let message = format!("the number of `indices` is not a multiple of {N}");
            self.mistake(plugin.span, message);
            return None;
        };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates, and indices out of range are found"
        )]
        let index = |number: f64| match number >= 0.0 {
            true => number as u32,
            false => u32::MAX,
        };
        let cells: Vec<[u32; N]> = cells.iter().map(|cell| cell.map(index)).collect();
        let wrong = cells
            .iter()
            .flatten()
            .find(|index| **index as usize >= vertices);
        if wrong.is_some() {
            let message = format!("an index is not one of the {vertices} vertices");
            self.mistake(plugin.span, message);
            return None;
        }
        Some(cells)
    }

    /// Values for each vertex; others are left out with a warning.
    fn per_vertex<'p, const N: usize>(
        &mut self,
        parameters: &'p Parameters,
        names: &[&'static str],
        vertices: usize,
    ) -> &'p [[f64; N]] {
        for name in names {
            let Some(tuples) = parameters.tuples::<N>(name) else {
                continue;
            };
            if tuples.len() == vertices {
                return tuples;
            }
            let span = parameters.get(name).map(|parameter| parameter.name.span);
            let message = format!(
                "`{name}` has values for {} of {vertices} vertices: it is ignored",
                tuples.len()
            );
            let diagnostic = rtc_diag::Diagnostic::new(&codes::PBRT_IGNORED, message);
            self.sink.push(diagnostic.at(span, ""));
        }
        &[]
    }

    fn triangle_mesh(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
        material: &LoweredMaterial,
    ) -> Option<ShapeGeometry> {
        // Read the vertices, the triangles and the attributes.
        let Some(positions) = parameters.tuples::<3>("P") else {
            self.mistake(plugin.span, "the mesh has no vertices `P`");
            return None;
        };
        let vertices = positions.len();
        let triangles = self.indices::<3>(plugin, parameters, vertices)?;
        let normals = self.per_vertex::<3>(parameters, &["N"], vertices);
        let uvs = self.per_vertex::<2>(parameters, &["uv", "st"], vertices);
        parameters.skip(&["S", "discarddegenerateUVs", "faceIndices"]);
        // Charge the memory before it is taken.
        let more = triangles.len().saturating_sub(vertices) as u64;
        self.charge(Resource::Memory, 12 * more, plugin.span)?;
        // A mesh without coordinates has those of pbrt, one triangle at a time.
        let needs_uvs = uvs.is_empty() && material.has_maps();
        let mesh = match needs_uvs {
            true => {
                let corners = 3 * triangles.len() as u64;
                self.charge(Resource::Memory, VERTEX_BYTES * corners, plugin.span)?;
                with_corner_uvs(positions, normals, &triangles)
            }
            false => Mesh {
                positions: VertexColumn::rounded(positions.iter().copied()),
                normals: VertexColumn::rounded(normals.iter().copied()),
                uvs: VertexColumn::rounded(uvs.iter().copied()),
                triangles: triangles.into(),
                ..Mesh::default()
            },
        };
        let mesh = self.oriented(mesh);
        self.charged_mesh(mesh, plugin.span)
            .map(ShapeGeometry::Mesh)
    }

    fn ply_mesh(&mut self, plugin: &SpannedText, parameters: &Parameters) -> Option<ShapeGeometry> {
        if let Some(parameter) = parameters.get("displacement") {
            let message = "the displacement of a mesh is not supported: it is shown smooth";
            self.report(&codes::PBRT_PLUGIN, parameter.name.span, message);
            parameters.skip(&["edgelength"]);
        }
        parameters.skip(&["discarddegenerateUVs"]);
        let Some(path) = parameters.string("filename").cloned() else {
            self.mistake(plugin.span, "the mesh has no `filename`");
            return None;
        };
        let is_reversed = self.state.reverse_orientation;
        let key = format!("{}{}", path.text, if is_reversed { "\0" } else { "" });
        let id = match self.meshes.get(&key) {
            Some(known) => *known,
            None => {
                let id = self.read_ply(&path);
                self.meshes.insert(key, id);
                id
            }
        };
        id.map(ShapeGeometry::Mesh)
    }

    fn read_ply(&mut self, path: &SpannedText) -> Option<MeshId> {
        const INSTEAD: &str = "the mesh is left out";
        let bytes = self.file(path, &PLY, INSTEAD)?;
        let is_ply = bytes.starts_with(b"ply");
        if !is_ply {
            self.damaged(&codes::BAD_MESH_FILE, path, "it is no PLY", INSTEAD);
            return None;
        }
        match mesh::parse(&bytes, self.map.budget()) {
            Ok(parsed) => {
                let mesh = Mesh {
                    name: path.text.clone(),
                    // pbrt does not show the colours of vertices.
                    colors: VertexColumn::default(),
                    ..parsed.mesh
                };
                let mesh = self.oriented(mesh);
                Some(self.add_mesh(mesh, path.span))
            }
            Err(TextParseError::Limit(fault)) => {
                self.without(over_limit("the mesh", &fault), path.span, INSTEAD);
                None
            }
            Err(TextParseError::Faults(faults)) => {
                let why = faults.first().map_or("", |fault| fault.message.as_str());
                let why = clip_words(why).into_owned();
                self.damaged(&codes::BAD_MESH_FILE, path, &why, INSTEAD);
                None
            }
        }
    }

    fn subdivided(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
    ) -> Option<ShapeGeometry> {
        let Some(positions) = parameters.tuples::<3>("P") else {
            self.mistake(plugin.span, "the mesh has no vertices `P`");
            return None;
        };
        let positions: Vec<Vec3> = positions.iter().copied().map(Vec3::from_array).collect();
        let triangles = self.indices::<3>(plugin, parameters, positions.len())?;
        let levels = parameters
            .count("levels")
            .or_else(|| parameters.count("nlevels"));
        let levels = levels.unwrap_or(3);
        parameters.skip(&["scheme"]);
        if levels > MAX_LEVELS {
            let message = format!("`levels` is {levels}, and at most {MAX_LEVELS}");
            self.mistake(plugin.span, message);
            return None;
        }
        // Each level has four triangles for one, and half as many vertices; their edges are sorted.
        let faces = (triangles.len() as u64) << (2 * levels);
        let vertices = (faces / 2).saturating_add(2 * positions.len() as u64);
        let work = vertices.saturating_mul(SUBDIVISION_COST);
        self.charge(Resource::Vertices, work, plugin.span)?;
        self.charge(Resource::Memory, faces.saturating_mul(144), plugin.span)?;
        let mesh = loop_subdivision::subdivide(positions, triangles, levels);
        let mesh = self.oriented(mesh);
        Some(ShapeGeometry::Mesh(self.add_mesh(mesh, plugin.span)))
    }

    fn bilinear_mesh(
        &mut self,
        plugin: &SpannedText,
        parameters: &Parameters,
    ) -> Option<Vec<ShapeGeometry>> {
        let Some(positions) = parameters.tuples::<3>("P") else {
            self.mistake(plugin.span, "the mesh has no vertices `P`");
            return None;
        };
        let patches = self.indices::<4>(plugin, parameters, positions.len())?;
        let normals = self.per_vertex::<3>(parameters, &["N"], positions.len());
        let uvs = self.per_vertex::<2>(parameters, &["uv"], positions.len());
        parameters.skip(&["faceIndices"]);
        if let Some(parameter) = parameters.get("emissionfilename") {
            let message = "the picture of an area light is left out";
            self.approximate(parameter.name.span, message);
        }
        if normals.is_empty() && uvs.is_empty() {
            let bytes = 192 * patches.len() as u64;
            self.charge(Resource::Memory, bytes, plugin.span)?;
            // The corners are (0, 0), (1, 0), (0, 1) and (1, 1) of the patch.
            let corners = |[a, b, c, d]: [u32; 4]| match self.state.reverse_orientation {
                false => [a, b, d, c],
                true => [a, c, d, b],
            };
            let patch = |patch: &[u32; 4]| {
                ShapeGeometry::Patch(corners(*patch).map(|index| positions[index as usize]))
            };
            return Some(patches.iter().map(patch).collect());
        }
        self.approximate(plugin.span, "each bilinear patch is shown as two triangles");
        let triangles = patches
            .iter()
            .flat_map(|[a, b, c, d]| [[*a, *b, *d], [*a, *d, *c]]);
        let mesh = Mesh {
            positions: VertexColumn::rounded(positions.iter().copied()),
            normals: VertexColumn::rounded(normals.iter().copied()),
            uvs: VertexColumn::rounded(uvs.iter().copied()),
            triangles: triangles.collect(),
            ..Mesh::default()
        };
        let mesh = self.oriented(mesh);
        let id = self.charged_mesh(mesh, plugin.span)?;
        Some(vec![ShapeGeometry::Mesh(id)])
    }
}

/// A mesh whose triangles share no vertex. Without coordinates pbrt gives the corners of each
/// triangle (0, 0), (1, 0) and (1, 1).
fn with_corner_uvs(positions: &[[f64; 3]], normals: &[[f64; 3]], triangles: &[[u32; 3]]) -> Mesh {
    let corners = || triangles.as_flattened().iter().map(|index| *index as usize);
    let vertices = (0_u32..).take(3 * triangles.len()).collect::<Vec<_>>();
    let uvs = triangles
        .iter()
        .flat_map(|_| [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
    let normals = corners().filter_map(|index| normals.get(index).copied());
    Mesh {
        positions: VertexColumn::rounded(corners().map(|index| positions[index])),
        normals: VertexColumn::rounded(normals),
        uvs: VertexColumn::rounded(uvs),
        triangles: vertices.as_chunks().0.iter().copied().collect(),
        ..Mesh::default()
    }
}

/// A disc or a ring, or a part of it. u runs along the turn, v from the edge to the middle.
fn flat_disc(height: f64, radius: f64, inner: f64, angle: f64) -> Mesh {
    let at = |r: f64| (Vec3::new(r, 0.0, height), Vec3::Z);
    tessellate::revolved(&[at(radius), at(inner)], angle)
}
