//! Chains of smooth surfaces, followed from a ray with its differentials.
//!
//! A ray has two differentials: the derivatives of its origin and of its unit direction by the
//! angles of the direction in which it left the receiver (Igehy, "Tracing ray differentials",
//! SIGGRAPH 1999). They say how the end of a chain moves when that direction turns.

use super::PathTracer;
use crate::bsdf::fresnel::{normal_reflectance, schlick};
use crate::light::caustic::CausticLights;
use crate::material::standard::{BaseReflectance, StandardMaterial};
use crate::ray::{Interaction, Ray};
use crate::shape::geometry::{AttributeRequest, Intersect};
use crate::shape::triangle::WatertightRay;
use crate::world::{Hit, SurfaceId, SurfacePrimitive};
use rtc_math::{OrthonormalBasis, Vec3};

/// The maximum number of smooth surfaces in a chain.
pub(super) const MAX_CHAIN: usize = 4;

/// Indices that differ by less do not refract.
const STRAIGHT: f64 = 1e-6;

/// A chain: whether each of its surfaces transmits, from the receiver on; the others reflect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SmoothChain {
    transmits: [bool; MAX_CHAIN],
    length: usize,
}

impl SmoothChain {
    const EMPTY: Self = Self {
        transmits: [false; MAX_CHAIN],
        length: 0,
    };

    /// Whether each surface transmits.
    pub(super) fn transmits(&self) -> &[bool] {
        &self.transmits[..self.length]
    }

    fn push(&mut self, transmits: bool) {
        self.transmits[self.length] = transmits;
        self.length += 1;
    }
}

/// A derivative of a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayDifferential {
    /// Of its origin.
    pub(super) origin: Vec3,
    /// Of its unit direction.
    pub(super) direction: Vec3,
}

/// Where a chain meets its first surface, for the next step of a walk.
#[derive(Clone, Copy, Debug)]
pub(super) struct FirstVertex {
    surface: SurfaceId,
    point: Vec3,
    /// The unit shading normal on the side of the receiver.
    normal: Vec3,
    /// The derivatives of the point by the angles of the direction at the receiver.
    changes: [Vec3; 2],
}

/// A ray with its differentials.
#[derive(Clone, Copy, Debug)]
pub(super) struct DifferentialRay {
    pub(super) ray: Ray,
    /// The primitive that it starts from.
    pub(super) from: SurfacePrimitive,
    pub(super) differentials: [RayDifferential; 2],
}

impl DifferentialRay {
    /// The ray that leaves a receiver in a direction.
    pub(super) fn new(at: &Interaction, from: SurfacePrimitive, direction: Vec3) -> Self {
        let OrthonormalBasis {
            tangent, bitangent, ..
        } = OrthonormalBasis::around(direction);
        let differential = |direction| RayDifferential {
            origin: Vec3::ZERO,
            direction,
        };
        Self {
            ray: at.ray(direction),
            from,
            differentials: [tangent, bitangent].map(differential),
        }
    }

    /// The derivatives of the point where the ray meets a surface with a normal.
    fn arrive(&self, normal: Vec3, t: f64) -> [Vec3; 2] {
        let d = self.ray.direction;
        self.differentials.map(|differential| {
            let moved = differential.origin + differential.direction * t;
            moved - d * (moved.dot(normal) / d.dot(normal))
        })
    }
}

/// A smooth surface that a chain meets.
struct SmoothVertex {
    at: Interaction,
    hit: Hit,
    /// The unit shading normal on the side of the ray.
    normal: Vec3,
    /// The derivatives of the point and of that normal.
    changes: [(Vec3, Vec3); 2],
    /// The index beyond the surface over that before it; 1 for a thin wall.
    eta: f64,
}

impl SmoothVertex {
    /// The vertex as the first one of a chain.
    fn place(&self) -> FirstVertex {
        FirstVertex {
            surface: self.hit.surface,
            point: self.at.point,
            normal: self.normal,
            changes: self.changes.map(|(point, _)| point),
        }
    }

    /// The cosine of the incoming ray, and that of the refracted one unless it is totally
    /// reflected.
    fn cosines(&self, direction: Vec3) -> (f64, Option<f64>) {
        let cosine = -direction.dot(self.normal);
        let square = 1.0 - (1.0 - cosine * cosine) / (self.eta * self.eta);
        (cosine, (square > 0.0).then(|| square.sqrt()))
    }

    /// The ray beyond the surface, or the reflected one; `None` for total reflection, and where
    /// shading and geometric normal disagree on the side.
    fn scatter(&self, beam: &DifferentialRay, transmits: bool) -> Option<DifferentialRay> {
        let (d, n) = (beam.ray.direction, self.normal);
        let (cosine, refracted) = self.cosines(d);
        let changes = |change: &dyn Fn(Vec3, Vec3) -> Vec3| {
            let pairs = [0, 1].map(|k| (beam.differentials[k].direction, self.changes[k]));
            pairs.map(|(direction, (origin, normal))| RayDifferential {
                origin,
                direction: change(direction, normal),
            })
        };
        let (direction, differentials) = if !transmits {
            // D' = D + 2 cos·N.
            let change = |dd: Vec3, dn: Vec3| {
                let change = -(dd.dot(n) + d.dot(dn));
                dd + n * (2.0 * change) + dn * (2.0 * cosine)
            };
            (d + n * (2.0 * cosine), changes(&change))
        } else if self.eta == 1.0 {
            (d, changes(&|dd, _| dd))
        } else {
            // D' = D/η + (cos/η − cos')·N.
            let (inverse, refracted) = (1.0 / self.eta, refracted?);
            let along = cosine * inverse - refracted;
            let change = |dd: Vec3, dn: Vec3| {
                let change = -(dd.dot(n) + d.dot(dn));
                let slope = inverse - cosine * inverse * inverse / refracted;
                dd * inverse + n * (slope * change) + dn * along
            };
            (d * inverse + n * along, changes(&change))
        };
        let direction = direction.normalize();
        let crosses = direction.dot(self.at.normal) * d.dot(self.at.normal) > 0.0;
        (crosses == transmits).then(|| DifferentialRay {
            ray: self.at.ray(direction),
            from: (self.hit.surface, self.hit.prim_id),
            differentials,
        })
    }
}

impl<S: Intersect, const F: u32> PathTracer<'_, S, F> {
    /// Follows a ray along a given chain: the ray at its end, and its first vertex.
    pub(super) fn follow(
        &self,
        caustics: &CausticLights,
        mut beam: DifferentialRay,
        chain: &SmoothChain,
    ) -> Option<(DifferentialRay, FirstVertex)> {
        let mut first = None;
        for transmits in chain.transmits() {
            let vertex = self.smooth_vertex(caustics, &beam)?;
            beam = vertex.scatter(&beam, *transmits)?;
            first = first.or(Some(vertex.place()));
        }
        Some((beam, first?))
    }

    /// The point after a step along the surface of a first vertex, moved onto that surface: the
    /// step is that of the angles at the receiver, at most `longest`, times `share`.
    pub(super) fn moved(
        &self,
        first: &FirstVertex,
        [a, b]: [f64; 2],
        longest: f64,
        share: f64,
    ) -> Vec3 {
        let [along, across] = first.changes;
        let step = along * a + across * b;
        let length = step.length();
        let step = step * ((longest / length).min(1.0) * share);
        // A ray along the normal finds the surface at most as far away as the step is long.
        let (target, height) = (first.point + step, length.min(longest) * share);
        let ray = Ray {
            origin: target + first.normal * height,
            direction: -first.normal,
        };
        let shape = &self.world.surfaces[first.surface].shape;
        let reach = 2.0 * height;
        match shape.intersect(&ray, &WatertightRay::new(&ray), reach) {
            Some((t, _)) if t <= reach => ray.origin + ray.direction * t,
            Some(_) | None => target,
        }
    }

    /// Follows a ray through smooth surfaces, as long as it meets such, but at most `most`. At each
    /// a random number chooses between reflection and transmission.
    pub(super) fn random_chain(
        &self,
        caustics: &CausticLights,
        mut beam: DifferentialRay,
        most: usize,
        mut number: impl FnMut() -> f64,
    ) -> Option<(SmoothChain, DifferentialRay, FirstVertex)> {
        let (mut chain, mut first) = (SmoothChain::EMPTY, None);
        while chain.length < most
            && let Some(vertex) = self.smooth_vertex(caustics, &beam)
        {
            let surface = &self.world.surfaces[vertex.hit.surface];
            let material = &self.world.standards[surface.material];
            let transmits = number() >= share_reflected(material, &vertex, beam.ray.direction);
            beam = vertex.scatter(&beam, transmits)?;
            chain.push(transmits);
            first = first.or(Some(vertex.place()));
        }
        Some((chain, beam, first?))
    }

    /// The smooth surface that a ray meets first, if it does.
    fn smooth_vertex(
        &self,
        caustics: &CausticLights,
        beam: &DifferentialRay,
    ) -> Option<SmoothVertex> {
        let ray = &beam.ray;
        let hit = self.world.closest_hit_from(ray, beam.from)?;
        if !caustics.casts(hit.surface) {
            return None;
        }
        let surface = &self.world.surfaces[hit.surface];
        let (shape, prim_id) = (&surface.shape, hit.prim_id);
        let at = shape.interaction(ray, hit.t, prim_id);
        let derivative = shape.normal_field()?.derivative(&at, prim_id);
        let shading = if shape.has_shading_normals() {
            let request = AttributeRequest::NONE;
            shape.shading_attributes(ray, &at, prim_id, request).normal
        } else {
            None
        };
        // Turn the normal to the side of the ray, as the geometric normal says.
        let outward = shading.unwrap_or(at.normal);
        let is_behind = ray.direction.dot(at.normal) > 0.0;
        let side = match (outward.dot(at.normal) < 0.0) == is_behind {
            true => 1.0,
            false => -1.0,
        };
        let points = beam.arrive(at.normal, hit.t);
        let material = &self.world.standards[surface.material];
        let vertex = SmoothVertex {
            at,
            hit,
            normal: outward * side,
            changes: points.map(|point| (point, derivative.along(point) * side)),
            eta: index_beyond(material, is_behind),
        };
        (ray.direction.dot(vertex.normal) < 0.0).then_some(vertex)
    }
}

/// The index beyond a surface over that on the side of the ray, which comes from behind or not.
fn index_beyond(material: &StandardMaterial, is_behind: bool) -> f64 {
    let ior = if material.ior > 0.0 {
        material.ior
    } else {
        1.0
    };
    let is_wall = !material.bounds_a_volume || (ior - 1.0).abs() < STRAIGHT;
    match is_behind {
        _ if is_wall => 1.0,
        true => 1.0 / ior,
        false => ior,
    }
}

/// The probability of reflection in a random chain: about the fraction of the light reflected, but
/// never certain where light is transmitted, too.
fn share_reflected(material: &StandardMaterial, vertex: &SmoothVertex, direction: Vec3) -> f64 {
    const LEAST: f64 = 0.04;
    let BaseReflectance::Metallic { metallic, .. } = &material.reflection else {
        return 1.0;
    };
    let (cosine, refracted) = vertex.cosines(direction);
    let Some(refracted) = refracted.filter(|_| material.transmission.factor > 0.0) else {
        return 1.0;
    };
    let curve = schlick(cosine.min(refracted));
    let f0 = normal_reflectance(material.ior);
    let dielectric = f0 + (1.0 - f0) * curve;
    (metallic + (1.0 - metallic) * dielectric).clamp(LEAST, 1.0 - LEAST)
}
