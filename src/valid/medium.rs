//! Validates participating media, and warns of media that open shapes bound.

use super::check::Checker;
use rtc_diag::{Diagnostic, codes};
use rtc_ir::{EntityField, EntityKind, Instance, Material, Medium, Mode, Scene, Shape, ValuePath};
use rtc_math::{Vec3, shortest};
use std::collections::BTreeMap;

/// A medium with finite coefficients, each at least 0, and a mean cosine above −1 and below 1.
pub(super) fn medium(medium: &Medium, at: ValuePath, check: &mut Checker<'_>) -> Option<Medium> {
    let Medium {
        sigma_a,
        sigma_s,
        g,
    } = *medium;
    let coefficients = [sigma_a, sigma_s].map(|sigma| check.color(sigma, at));
    let is_cosine = -1.0 < g && g < 1.0;
    if !is_cosine {
        let message = format!(
            "`g` of a medium is `{}`, but must be above -1 and below 1",
            shortest(g)
        );
        check.report(at, "", Diagnostic::new(&codes::BAD_FACTOR, message));
    }
    let [sigma_a, sigma_s] = coefficients;
    is_cosine.then_some(Medium {
        sigma_a: sigma_a?.to_array(),
        sigma_s: sigma_s?.to_array(),
        g,
    })
}

/// The largest number of triangles of which edges are compared.
const MAX_TRIANGLES: usize = 1 << 20;

/// Warns of each material with media whose surfaces are not closed, all together.
pub(super) fn open_shapes(scene: &Scene, check: &mut Checker<'_>) {
    if !matches!(scene.settings.mode, Mode::Path(_)) {
        return;
    }
    let has_media = |material: &Material| match material {
        Material::Standard(standard) => standard.interior.is_some() || standard.exterior.is_some(),
        Material::Phong(_) => false,
    };
    // The surfaces of each material with media, in one pass.
    let mut surfaces_of: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (index, surface) in scene.surfaces.iter().enumerate() {
        let material = scene.materials.get(surface.material.0 as usize);
        if material.is_some_and(has_media) {
            surfaces_of
                .entry(surface.material.0)
                .or_default()
                .push(index);
        }
    }
    for surfaces in surfaces_of.values() {
        let mut edges = Edges::default();
        for index in surfaces {
            edges.add(&scene.surfaces[*index].shape, scene);
        }
        if edges.is_open() {
            let message = "a shape with a participating medium inside is not closed";
            let diagnostic = Diagnostic::new(&codes::OPEN_MEDIUM, message)
                .hint("close it, so that each path that comes in goes out");
            let path = ValuePath::new(EntityKind::Surface, surfaces[0], EntityField::Whole);
            check.report(path, "paths pass by its edges", diagnostic);
        }
    }
}

/// The edges of flat shapes and meshes: for each how often it runs one way more than the other.
#[derive(Default)]
struct Edges {
    counts: BTreeMap<[[u64; 3]; 2], i64>,
    triangles: usize,
    has_disc: bool,
}

impl Edges {
    /// Adds the edges of a shape, until there are too many.
    fn add(&mut self, shape: &Shape, scene: &Scene) {
        match shape {
            Shape::Triangle(triangle) => self.polygon(&triangle.vertices),
            Shape::Quad(quad) => self.polygon(&quad.vertices),
            Shape::Disc(_) => self.has_disc = true,
            Shape::Instance(instance) => self.mesh(instance, scene),
            // They have an inside.
            Shape::Sphere(_)
            | Shape::Plane(_)
            | Shape::Cylinder(_)
            | Shape::Cone(_)
            | Shape::Paraboloid(_)
            | Shape::Torus(_)
            | Shape::Csg(_)
            | Shape::Ellipsoid(_)
            | Shape::InfiniteCylinder(_) => {}
        }
    }

    fn mesh(&mut self, instance: &Instance, scene: &Scene) {
        let Some(mesh) = scene.meshes.get(instance.mesh.0 as usize) else {
            return;
        };
        // Many instances of a large mesh are not gone through.
        if self.triangles + mesh.triangles.len() > MAX_TRIANGLES {
            self.triangles = MAX_TRIANGLES + 1;
            return;
        }
        let [x, y, z, origin] = instance.world_from_object.map(Vec3::from_array);
        let place = |index: u32| {
            let [u, v, w] = mesh.positions.at(index as usize);
            (x * u + y * v + z * w + origin).to_array()
        };
        for triangle in mesh.triangles.iter() {
            self.polygon(&triangle.map(place));
        }
    }

    fn polygon(&mut self, corners: &[[f64; 3]]) {
        self.triangles += 1;
        if self.triangles > MAX_TRIANGLES {
            return;
        }
        // −0 is at the place of 0.
        let place = |corner: [f64; 3]| corner.map(|coordinate| (coordinate + 0.0).to_bits());
        let ends = corners.iter().cycle().skip(1);
        for (from, to) in corners.iter().zip(ends) {
            let (from, to) = (place(*from), place(*to));
            // An edge between equal places is none.
            match from.cmp(&to) {
                std::cmp::Ordering::Less => *self.counts.entry([from, to]).or_default() += 1,
                std::cmp::Ordering::Equal => {}
                std::cmp::Ordering::Greater => *self.counts.entry([to, from]).or_default() -= 1,
            }
        }
    }

    /// Whether an edge certainly has one side only.
    fn is_open(&self) -> bool {
        let is_odd = || self.counts.values().any(|count| *count != 0);
        self.has_disc || (self.triangles <= MAX_TRIANGLES && is_odd())
    }
}
