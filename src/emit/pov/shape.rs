//! Writes surfaces: all shapes except bilinear patches and paraboloids; meshes with all vertices.

use super::material::written_map;
use super::{PovWriter, vector};
use crate::export::{part_of, parts_of_one, shape_name};
use crate::flat::split;
use crate::picture::TexturePicture;
use rtc_ir::{
    Cone, Csg, Cylinder, Disc, Ellipsoid, EntityField, EntityKind, InfiniteCylinder, Instance,
    MaterialId, MeshId, Plane, Quad, Shape, Sphere, Surface, Torus, Triangle, ValuePath,
    VertexColumn,
};
use rtc_math::{OrthonormalBasis, SetStep, Vec3, is_flat, shortest, unit};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The maximum number of bytes of three numbers, or three indices, as text.
const TRIPLE: u64 = 80;

impl PovWriter<'_> {
    /// Writes all surfaces; `None` if a mesh exceeds the budget, which is reported.
    pub(super) fn surfaces(&mut self) -> Option<()> {
        let scene = self.scene;
        let mut declared = BTreeSet::new();
        let mut next = 0;
        while let Some(surface) = scene.surfaces.get(next) {
            let index = next;
            let parts = &scene.surfaces[index..][..parts_of_one(&scene.surfaces[index..])];
            next += parts.len();
            let path = ValuePath::new(EntityKind::Surface, index, EntityField::Whole);
            if let Shape::Instance(Instance { mesh, .. }) = &surface.shape {
                let name = self.mesh_name(*mesh, surface.material);
                if declared.insert(name.clone()) {
                    self.declare(&name, mesh.0 as usize, surface.material)?;
                }
            }
            if let Shape::Csg(csg) = &surface.shape {
                self.csg(csg, parts, path);
            } else {
                self.surface(surface, path);
            }
        }
        Some(())
    }

    fn surface(&mut self, surface: &Surface, path: ValuePath) {
        let Surface {
            shape,
            material,
            casts_no_shadow,
            velocity: _,
        } = surface;
        if self.is_empty(shape) {
            return;
        }
        let Some(shape_text) = self.shape_text(shape, *material) else {
            let message = format!("POV-Ray has no {}: it is left out", shape_name(shape));
            self.reporter.unsupported(&message, path);
            return;
        };
        let blocks_light = self.scene.settings.shadows && !casts_no_shadow;
        let shadow = if blocks_light { "" } else { " no_shadow" };
        self.line(&format!(
            "{shape_text} texture {{ M{} }}{}{shadow} }}",
            material.0,
            self.interior(*material)
        ));
    }

    /// Writes a CSG solid, by the surfaces that are its parts.
    fn csg(&mut self, csg: &Csg, parts: &[Surface], path: ValuePath) {
        let Some(text) = self.csg_text(csg, parts) else {
            let message = "POV-Ray has no paraboloid: solids with one are left out";
            self.reporter.unsupported(message, path);
            return;
        };
        let casts = |part: &Surface| self.scene.settings.shadows && !part.casts_no_shadow;
        let casting = parts.iter().filter(|part| casts(part)).count();
        if casting > 0 && casting < parts.len() {
            let message = "POV-Ray lets a solid cast its shadow with all of its operands";
            self.reporter.unsupported(message, path);
        }
        let shadow = if casting > 0 { "" } else { " no_shadow" };
        let interior = self.interior(parts[0].material);
        self.line(&format!("object {{ {text}{interior}{shadow} }}"));
    }

    /// The operations over the operands, each with its texture.
    fn csg_text(&self, csg: &Csg, parts: &[Surface]) -> Option<String> {
        let mut operands = csg.operands.iter().enumerate();
        let mut stack: Vec<String> = Vec::new();
        for step in &csg.steps {
            let operation = match step {
                SetStep::Operand => {
                    let (index, operand) = operands.next()?;
                    let material = part_of(parts, index).unwrap_or(&parts[0]).material;
                    let shape_text = self.shape_text(&operand.shape(), material)?;
                    stack.push(format!("{shape_text} texture {{ M{} }} }}", material.0));
                    continue;
                }
                SetStep::Union => "merge",
                SetStep::Intersection => "intersection",
                SetStep::Difference => "difference",
            };
            let (b, a) = (stack.pop()?, stack.pop()?);
            stack.push(format!("{operation} {{ {a} {b} }}"));
        }
        stack.pop()
    }

    /// Whether it is an instance of a mesh without triangles.
    fn is_empty(&self, shape: &Shape) -> bool {
        let meshes = &self.scene.meshes;
        let Shape::Instance(instance) = shape else {
            return false;
        };
        meshes[instance.mesh.0 as usize].triangles.is_empty()
    }

    /// A shape without its closing brace; `None` if POV-Ray has no such shape.
    fn shape_text(&self, shape: &Shape, material: MaterialId) -> Option<String> {
        // Write the primitive up to its modifiers, which follow.
        Some(match shape {
            Shape::Sphere(Sphere { center, radius, .. }) => {
                format!("sphere {{ {}, {}", vector(*center), shortest(*radius))
            }
            Shape::Plane(Plane { center, normal }) => {
                let normal = direction(*normal);
                let distance = normal.dot(Vec3::from_array(*center));
                let normal = vector(normal.to_array());
                format!("plane {{ {normal}, {}", shortest(distance))
            }
            Shape::Triangle(Triangle { vertices, .. }) => {
                format!("triangle {{ {}", corners(vertices))
            }
            Shape::Quad(quad) => self::quad(quad)?,
            Shape::Disc(Disc {
                center,
                normal,
                radius,
            }) => {
                let (center, normal) = (vector(*center), vector(*normal));
                format!("disc {{ {center}, {normal}, {}", shortest(*radius))
            }
            Shape::Cylinder(cylinder) => self::cylinder(cylinder),
            Shape::Cone(Cone { base, up, radius }) => {
                let base = Vec3::from_array(*base);
                let apex = vector((base + Vec3::from_array(*up)).to_array());
                let base = vector(base.to_array());
                format!("cone {{ {base}, {}, {apex}, 0", shortest(*radius))
            }
            Shape::Torus(torus) => self::torus(torus),
            Shape::Instance(Instance {
                mesh,
                world_from_object,
            }) => {
                let columns = vector(world_from_object.iter().flatten().copied());
                format!(
                    "object {{ {} matrix {columns}",
                    self.mesh_name(*mesh, material)
                )
            }
            Shape::Ellipsoid(Ellipsoid { center, axes }) => {
                let columns = vector(axes.iter().chain([center]).flatten().copied());
                format!("sphere {{ <0, 0, 0>, 1 matrix {columns}")
            }
            Shape::InfiniteCylinder(cylinder) => infinite_cylinder(cylinder),
            Shape::Paraboloid(_) | Shape::Csg(_) => return None,
        })
    }

    /// The name of a mesh with the texture coordinates that a material looks up.
    fn mesh_name(&self, MeshId(mesh): MeshId, MaterialId(material): MaterialId) -> String {
        match written_map(&self.scene.materials[material as usize]) {
            Some(_) => format!("Mesh{mesh}M{material}"),
            None => format!("Mesh{mesh}"),
        }
    }

    /// Declares a mesh for its instances; `None` if it exceeds the budget, which is reported.
    fn declare(
        &mut self,
        name: &str,
        index: usize,
        MaterialId(material): MaterialId,
    ) -> Option<()> {
        let scene = self.scene;
        let mesh = &scene.meshes[index];
        let path = ValuePath::new(EntityKind::Mesh, index, EntityField::Whole);
        if !mesh.colors.is_empty() {
            let message = "the colours of the corners of a mesh are left out";
            self.reporter.unsupported(message, path);
        }
        let map = written_map(&scene.materials[material as usize]);
        let uvs = match map.as_ref().map_or(0, |map| map.set) {
            1 => &mesh.second_uvs,
            _ => &mesh.uvs,
        };
        let lines = mesh.positions.len() + mesh.normals.len() + uvs.len() + mesh.triangles.len();
        self.reporter
            .charge(TRIPLE * lines as u64, self.budget, path)?;
        if mesh.triangles.is_empty() {
            return Some(());
        }
        self.line(&format!("#declare {name} = mesh2 {{"));
        self.vectors("vertex_vectors", &mesh.positions);
        if !mesh.normals.is_empty() {
            self.vectors("normal_vectors", &mesh.normals);
        }
        if let Some(map) = map.filter(|_| !uvs.is_empty()) {
            // POV-Ray's pictures have their origin at the bottom.
            let [u, v] = TexturePicture::new(scene, &self.areas, map.texture).rows(&map);
            let at = |row: [f64; 3], [u, v]: [f64; 2]| row[0] * u + row[1] * v + row[2];
            let each = (0..uvs.len()).map(|corner| uvs.at(corner));
            let each = each.map(|uv| vector([at(u, uv), 1.0 - at(v, uv)]));
            self.list("uv_vectors", uvs.len(), each);
        }
        let faces = mesh.triangles.iter();
        let faces = faces.map(|[a, b, c]| format!("<{a}, {b}, {c}>"));
        self.list("face_indices", mesh.triangles.len(), faces);
        self.line("}");
        Some(())
    }

    fn vectors(&mut self, key: &str, column: &VertexColumn<3>) {
        let each = (0..column.len()).map(|index| vector(column.at(index)));
        self.list(key, column.len(), each);
    }

    fn list(&mut self, key: &str, count: usize, each: impl Iterator<Item = String>) {
        write!(self.text, "{key} {{ {count}").expect("a string takes all that is written to it");
        for item in each {
            self.text += ",\n";
            self.text += &item;
        }
        self.line(" }");
    }
}

fn direction(numbers: [f64; 3]) -> Vec3 {
    unit(Vec3::from_array(numbers)).unwrap_or(Vec3::Z)
}

fn corners(corners: &[[f64; 3]]) -> String {
    let corners: Vec<_> = corners.iter().map(|corner| vector(*corner)).collect();
    corners.join(", ")
}

/// Two triangles, if the quadrilateral is flat.
fn quad(quad: &Quad) -> Option<String> {
    let vertices = quad.vertices.map(Vec3::from_array);
    let halves = split(vertices);
    let halves = halves.iter().map(|half| {
        let half = half.map(|corner| quad.vertices[corner as usize]);
        format!("triangle {{ {} }}", corners(&half))
    });
    is_flat(vertices).then(|| format!("mesh {{ {}", halves.collect::<Vec<_>>().join(" ")))
}

fn cylinder(cylinder: &Cylinder) -> String {
    let base = Vec3::from_array(cylinder.base);
    let top = base + direction(cylinder.axis) * cylinder.height;
    let (base, top) = (vector(base.to_array()), vector(top.to_array()));
    format!("cylinder {{ {base}, {top}, {}", shortest(cylinder.radius))
}

/// The quadric x² + z² = radius², about the y axis.
fn infinite_cylinder(cylinder: &InfiniteCylinder) -> String {
    let basis = OrthonormalBasis::around(direction(cylinder.axis));
    let columns = [basis.bitangent, basis.normal, basis.tangent];
    let columns = columns.iter().flat_map(Vec3::to_array);
    let columns = vector(columns.chain(cylinder.center));
    let square = shortest(cylinder.radius * cylinder.radius);
    format!("quadric {{ <1, 0, 1>, <0, 0, 0>, <0, 0, 0>, -{square} matrix {columns}")
}

/// POV-Ray's torus has the y axis as its axis.
fn torus(torus: &Torus) -> String {
    let basis = OrthonormalBasis::around(direction(torus.axis));
    let columns = [basis.bitangent, basis.normal, basis.tangent];
    let columns = columns.iter().flat_map(Vec3::to_array);
    let columns = vector(columns.chain(torus.center));
    let (major, minor) = (shortest(torus.major), shortest(torus.minor));
    format!("torus {{ {major}, {minor} matrix {columns}")
}
