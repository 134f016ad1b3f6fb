//! Path vertices: the surface interactions of the rays of a path.

use super::PathTracer;
use super::state::PathState;
use crate::material::point::MaterialPoint;
use crate::material::standard::{Alpha, StandardMaterial};
use crate::ray::Interaction;
use crate::shape::geometry::Intersect;
use crate::shape::geometry::{AttributeRequest, ShadingAttributes};
use crate::world::{Hit, MaterialId, MediumId};
use rtc_math::Vec3;
use rtc_plan::{Effect, PathFeatures};

/// The maximum number of skipped surfaces along a ray.
pub(super) const MAX_SKIPPED: u32 = 1 << 10;

/// What a ray meets.
pub(super) enum RayEnd<T> {
    /// A surface, and the value of the shading there.
    Surface(T),
    /// A point of a medium that scatters it.
    Medium(MediumId),
    /// Neither.
    Nothing,
}

/// A vertex of a path: a hit, with everything that shading needs.
pub(super) struct PathVertex<'hit, 'world> {
    pub(super) at: &'hit Interaction,
    pub(super) point: &'hit MaterialPoint<'world>,
    pub(super) shading_attributes: &'hit ShadingAttributes,
    pub(super) hit: Hit,
}

impl PathVertex<'_, '_> {
    /// Whether a viewer at this height over the shading normal is behind the surface. In front is
    /// where vertex normals point, or without them the geometric one.
    pub(super) fn is_behind(&self, height: f64) -> bool {
        let normal = self.shading_attributes.normal;
        let is_against = normal.is_some_and(|normal| normal.dot(self.at.normal) < 0.0);
        if is_against {
            height >= 0.0
        } else {
            height <= 0.0
        }
    }
}

impl<'world, S: Intersect, const F: u32> PathTracer<'world, S, F> {
    /// Shades the next hit that is not skipped, where it is found: a vertex is too large to be
    /// moved. Alpha-tested surfaces are skipped with probability 1 − opacity; camera rays also skip
    /// back faces of single-sided materials. The ray ends before the hit where a medium scatters
    /// it.
    #[inline(always)]
    pub(super) fn at_closest_hit<T>(
        &mut self,
        state: &mut PathState,
        shade: impl FnOnce(&mut Self, &mut PathState, &PathVertex<'_, 'world>) -> T,
    ) -> RayEnd<T> {
        state.travelled = 0.0;
        let mut flight = self.free_flight(state);
        for skipped in 0..MAX_SKIPPED {
            // Find the closest hit and its shading attributes.
            let hit = self.next_hit(state);
            if let Some(flight) = &mut flight
                && let Some(end) = self.fly(state, flight, hit.map(|hit| hit.t))
            {
                return RayEnd::Medium(end);
            }
            let Some(hit) = hit else {
                break;
            };
            let surface = &self.world.surfaces[hit.surface];
            let at = surface.shape.interaction(&state.ray, hit.t, hit.prim_id);
            let request = self.request(surface.material);
            let shading_attributes =
                surface
                    .shape
                    .shading_attributes(&state.ray, &at, hit.prim_id, request);
            let mut point = self.point(surface.material, &shading_attributes, at.point);
            if Self::can(PathFeatures::ALPHA) && point.is_blend() {
                point = self.part(state, point, skipped, &shading_attributes);
            }
            if let Some(set) = point.bump_set() {
                let shape = &surface.shape;
                point.derivatives = shape.uv_derivatives(&state.ray, &at, hit.prim_id, set);
            }
            state.travelled += hit.t;
            // Skip the hit with the probability of its transparency.
            let opacity = if skips_back(state, &at, point.material) {
                0.0
            } else {
                self.opacity(&point)
            };
            if opacity < 1.0 && state.sobol.uniform(state.bounces, skipped) >= opacity {
                (state.ray, state.from) = (at.ray(state.ray.direction), (hit.surface, hit.prim_id));
                state.caustic = None;
                if Self::can(PathFeatures::MEDIA) {
                    self.cross(state, hit.surface, at.normal);
                }
                if !self.heartbeat.passes(&self.counts) {
                    break;
                }
                continue;
            }
            // Shade the vertex.
            if let Some(flight) = &flight {
                state.beta *= flight.weight();
            }
            let vertex = PathVertex {
                at: &at,
                point: &point,
                shading_attributes: &shading_attributes,
                hit,
            };
            return RayEnd::Surface(shade(self, state, &vertex));
        }
        if let Some(flight) = &flight {
            state.beta *= flight.weight();
        }
        RayEnd::Nothing
    }

    /// The part of a blend that a hit shows.
    fn part(
        &mut self,
        state: &PathState,
        point: MaterialPoint<'world>,
        skipped: u32,
        shading_attributes: &ShadingAttributes,
    ) -> MaterialPoint<'world> {
        self.count_blend(&point);
        // The alpha test has the numbers before these.
        let u = state.sobol.uniform(state.bounces, MAX_SKIPPED + skipped);
        point.chosen(u, &self.world.standards, shading_attributes)
    }

    /// Counts the evaluation of a blend.
    fn count_blend(&mut self, point: &MaterialPoint<'_>) {
        self.counts.add(Effect::Blend);
        let blend = point.material.blend.as_ref();
        if blend.is_some_and(|blend| blend.weight.map.is_some()) {
            self.counts.add(Effect::Textures);
        }
    }

    /// The closest hit of the ray. It is a separate function, as is [`Self::visibility`], so that
    /// `benches/kernels.sh` can count the instructions of BVH traversal.
    #[inline(never)]
    fn next_hit(&self, state: &PathState) -> Option<Hit> {
        self.world.closest_hit_from(&state.ray, state.from)
    }

    /// The surface details that a material needs.
    pub(super) fn request(&self, material: MaterialId) -> AttributeRequest {
        if self.knows_all {
            AttributeRequest::ALL
        } else {
            self.world.standards[material].request
        }
    }

    /// A material at a point of a surface, in world coordinates.
    pub(super) fn point(
        &mut self,
        material: MaterialId,
        shading_attributes: &ShadingAttributes,
        point: Vec3,
    ) -> MaterialPoint<'world> {
        let material = &self.world.standards[material];
        if material.base_color.map.is_some() {
            self.counts.add(Effect::Textures);
        }
        if shading_attributes.color.is_some() {
            self.counts.add(Effect::VertexColors);
        }
        MaterialPoint::new(material, shading_attributes, point)
    }

    /// The opacity at a point: the probability that the alpha test keeps the hit.
    pub(super) fn opacity(&mut self, point: &MaterialPoint<'_>) -> f64 {
        if !Self::can(PathFeatures::ALPHA) || point.material.alpha == Alpha::Opaque {
            return 1.0;
        }
        self.count_alpha(point.material);
        point.opacity()
    }

    /// The opacity at a point of a surface, of a blend that of all its parts.
    pub(super) fn whole_opacity(
        &mut self,
        point: MaterialPoint<'world>,
        shading_attributes: &ShadingAttributes,
    ) -> f64 {
        if !point.is_blend() {
            return self.opacity(&point);
        }
        self.count_blend(&point);
        self.count_alpha(point.material);
        point.mean_opacity(&self.world.standards, shading_attributes)
    }

    /// Counts the evaluation of an opacity.
    fn count_alpha(&mut self, material: &StandardMaterial) {
        if material.alpha == Alpha::Opaque {
            return;
        }
        self.counts.add(Effect::Alpha);
        if material.opacity.map.is_some() {
            self.counts.add(Effect::Textures);
        }
    }
}

/// Whether a camera ray hits the back of a single-sided material.
fn skips_back(state: &PathState, at: &Interaction, material: &StandardMaterial) -> bool {
    state.bounces == 0 && state.ray.direction.dot(at.normal) > 0.0 && material.is_seen_from_one_side
}
