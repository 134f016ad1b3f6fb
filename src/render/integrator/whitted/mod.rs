//! The Whitted integrator: local shading plus reflected and refracted rays (Whitted, "An improved
//! illumination model for shaded display", CACM 23, 1980). It is a loop over a stack of rays with
//! their throughputs, so long paths need no call stack.

mod aov;
mod branch;
#[cfg_attr(
    not(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        target_feature = "simd128"
    )),
    allow(
        dead_code,
        unused_variables,
        reason = "without SIMD, rays go one by one"
    )
)]
mod four;
mod pixel;
mod shade;

use crate::accel::ray_cone_cache::RayConeCache;
use crate::camera::grid::SampleGrid;
use crate::film::RayCounts;
use crate::film::heartbeat::{Heartbeat, PixelObserver};
use crate::ray::Ray;
use crate::sampler::PathVertexKey;
use crate::shape::geometry::Intersect;
use crate::shape::geometry::{AttributeRequest, ShadingAttributes};
use crate::texture::bilinear::{TextureFrame, look_up};
use crate::texture::{Texture, TextureLookupPoint};
use crate::world::settings::Mode;
use crate::world::{Hit, World};
use branch::{PendingWork, RayBranch, RayBranchKind};
use pixel::PixelState;
use rtc_math::Vec3;
use rtc_plan::{Effect, FeatureSet, Plan, Rule, WhittedFeatures};
use shade::{OUTLINE, ShadingPoint};

/// Follows camera rays through a world with the [`WhittedFeatures`] `F`; reuse one for many rays,
/// it keeps its memory.
pub(crate) struct WhittedTracer<'world, S, const F: u32> {
    pub(crate) world: &'world World<S>,
    /// The world with those of all moments of the shutter.
    all_moments: &'world World<S>,
    pending: Vec<PendingWork>,
    /// Tells of the pixel under way, and whether to continue with it.
    pub(crate) heartbeat: Heartbeat<'world>,
    /// Whether the current path has a weight of 0: then its hits are irrelevant for a plan.
    pub(crate) weightless: bool,
    /// Whether terms fall in steps: at the first hit of a cartoon.
    steps: bool,
    /// Whether points of soft lights are spread without bias for any number of them.
    pub(crate) spread: bool,
    grid: SampleGrid,
    pixel: PixelState,
    /// The number of bounces of the current path.
    bounces: u32,
    bundles: RayConeCache,
    /// Whether samples are taken four at a time where they can be.
    by_four: bool,
    /// The rays traced so far.
    pub(crate) counts: RayCounts,
}

impl<'world, S: Intersect, const F: u32> WhittedTracer<'world, S, F> {
    /// A tracer of the world, watched by `on_pixel`.
    #[must_use]
    pub(crate) fn new(world: &'world World<S>, on_pixel: &'world PixelObserver<'world>) -> Self {
        let (heartbeat, counts) = (Heartbeat::new(on_pixel), RayCounts::default());
        Self {
            world,
            all_moments: world,
            pending: Vec::new(),
            heartbeat,
            weightless: false,
            steps: false,
            spread: false,
            grid: world.settings.grid,
            pixel: PixelState::default(),
            bounces: 0,
            bundles: RayConeCache::EMPTY,
            by_four: Self::goes_by_four(world),
            counts,
        }
    }

    /// The same, with points of soft lights spread without bias.
    pub(crate) fn spread(self) -> Self {
        Self {
            spread: true,
            ..self
        }
    }

    /// Whether this tracer can do it: known at compile time.
    #[inline]
    pub(crate) const fn can(feature: WhittedFeatures) -> bool {
        FeatureSet(F).contains(feature)
    }

    /// Whether a rule that decides hit by hit applies: always, but for the naive tracer.
    #[inline]
    pub(crate) fn applies(&self, rule: Rule) -> bool {
        !Self::can(WhittedFeatures::UNPRUNED) || self.world.plan.rules.contains(rule)
    }

    /// Reports a difference of the plan under verification, if there is one and `is_fault` finds
    /// it.
    pub(crate) fn verify(
        &self,
        effect: Effect,
        what: &'static str,
        is_fault: impl FnOnce(&Plan) -> bool,
    ) {
        if Self::can(WhittedFeatures::UNPRUNED)
            && !self.weightless
            && let Some(verify) = &self.world.verify
            && is_fault(&verify.plan)
        {
            verify.report(self.heartbeat.pixel(), effect, what);
        }
    }

    /// The value of a camera ray, by the mode of the scene; black for a miss.
    ///
    /// It is compiled once for pictures, progressive pictures and layers, so that the functions
    /// called at every hit are inlined into it.
    #[inline(never)]
    pub(crate) fn radiance(&mut self, ray: Ray, key: PathVertexKey) -> Vec3 {
        self.counts.camera += 1;
        let depth = self.world.plan.max_depth;
        let mut sum = Vec3::ZERO;
        let mut path = RayBranch {
            ray,
            beta: 1.0,
            bounces_left: depth,
            key,
            kind: RayBranchKind::Mirrored,
        };
        // Follow the branches of the path, from the camera ray on.
        loop {
            if Self::can(WhittedFeatures::UNPRUNED) {
                self.weightless = path.beta == 0.0;
            }
            let bounces = depth - path.bounces_left;
            self.bounces = bounces;
            if let Some(shading_point) = self.shading_point(&path.ray, path.key) {
                self.counts.hits += u64::from(bounces == 0);
                self.steps = self.is_cartoon() && bounces == 0;
                if self.steps && shading_point.is_outline() {
                    return OUTLINE;
                }
                // Add the local shading, weighted by the branch.
                let value = self.local(&shading_point) * path.beta;
                self.verify_hit(bounces, &shading_point, value);
                sum += value;
                if Self::can(WhittedFeatures::BOUNCE) {
                    // Push the reflected and refracted rays.
                    self.branch(&path, &shading_point);
                }
            }
            if !Self::can(WhittedFeatures::BOUNCE) || self.pending.is_empty() {
                return sum;
            }
            match self.next_branch() {
                Some(next) => path = next,
                None => return sum,
            }
        }
    }

    /// Whether the first hits are shown as in a cartoon.
    #[inline]
    fn is_cartoon(&self) -> bool {
        Self::can(WhittedFeatures::GOOCH) && self.world.settings.toon
    }

    /// Checks whether a ray after this many bounces hits something that the plan removed.
    fn verify_hit(&self, bounces: u32, shading_point: &ShadingPoint<'_>, value: Vec3) {
        self.verify(Effect::Depth, "a bounce left out adds something", |plan| {
            bounces > plan.max_depth && value != Vec3::ZERO && !plan.rules.contains(Rule::Cut)
        });
        self.verify(Effect::Surfaces, "a ray meets a surface left out", |plan| {
            bounces <= plan.max_depth && !plan.surfaces[shading_point.surface]
        });
    }

    /// The surface that a ray hits, with the maps of its material applied.
    #[inline(always)]
    fn shading_point(&mut self, ray: &Ray, key: PathVertexKey) -> Option<ShadingPoint<'world>> {
        let hit = self.closest_hit(ray)?;
        Some(self.shading_point_of(ray, hit, key))
    }

    /// The closest hit, among the surfaces that the cone of the ray may hit.
    #[inline(always)]
    fn closest_hit(&mut self, ray: &Ray) -> Option<Hit> {
        if let Some(small_scene) = &self.world.small_scene
            && let Some(items) = self
                .bundles
                .along(&small_scene.balls, self.bounces as usize, ray)
        {
            return self.world.closest_hit_of(small_scene, items, ray);
        }
        self.world.closest_hit(ray)
    }

    /// The surface at a hit.
    #[inline(always)]
    pub(crate) fn shading_point_of(
        &mut self,
        ray: &Ray,
        hit: Hit,
        key: PathVertexKey,
    ) -> ShadingPoint<'world> {
        // Compute the interaction on the surface.
        let surface = &self.world.surfaces[hit.surface];
        let interaction = surface.shape.interaction(ray, hit.t, hit.prim_id);
        let material = &self.world.phongs[surface.material];
        let mut shading_point = ShadingPoint {
            interaction,
            normal: interaction.normal,
            to_viewer: -ray.direction,
            material,
            color: material.color,
            ks: material.ks.get(),
            surface: surface.index,
            key,
        };
        // Apply texture maps and interpolated normals.
        if Self::can(WhittedFeatures::MAPS)
            && (material.maps.is_some() || surface.shape.has_shading_normals())
        {
            let shading_attributes = surface.shape.shading_attributes(
                ray,
                &interaction,
                hit.prim_id,
                AttributeRequest::ALL,
            );
            self.apply_maps(&mut shading_point, &shading_attributes);
        }
        // Turn the normal towards the viewer.
        if ray.direction.dot(interaction.normal) > 0.0 {
            shading_point.normal = -shading_point.normal;
        }
        shading_point
    }

    /// Replaces normal, colour and ks by those of the surface's maps; without uv a surface keeps
    /// its own.
    fn apply_maps(
        &mut self,
        shading_point: &mut ShadingPoint<'_>,
        shading_attributes: &ShadingAttributes,
    ) {
        if shading_attributes.normal.is_some() {
            self.counts.add(Effect::NormalInterpolation);
        }
        shading_point.normal = shading_attributes.normal.unwrap_or(shading_point.normal);
        let Some(maps) = shading_point.material.maps.as_deref() else {
            return;
        };
        let place = TextureLookupPoint {
            uv: shading_attributes.uv,
            point: shading_point.interaction.point,
        };
        let at_place = |map: &Option<Texture>| look_up(map.as_ref()?, &place);
        if let Some(color) = at_place(&maps.color) {
            self.counts.add(Effect::Textures);
            shading_point.color = color;
        }
        if let Some(color) = at_place(&maps.specular) {
            self.counts.add(Effect::Textures);
            shading_point.ks *= color.x.max(0.0);
        }
        // Bend the normal.
        let (normal, tangent) = (shading_point.normal, shading_attributes.tangent);
        let bent = match (&maps.normal, &maps.bump) {
            (Some(map), _) => look_up(map, &place).and_then(|color| {
                let frame = TextureFrame::new(normal, tangent?)?;
                Some(frame.mapped(color))
            }),
            (None, Some(bump)) => bump.normal(normal, tangent, &place),
            (None, None) => None,
        };
        if let Some(normal) = bent {
            self.counts.add(Effect::NormalMapping);
            shading_point.normal = normal;
        }
    }

    fn local(&mut self, shading_point: &ShadingPoint<'_>) -> Vec3 {
        match &self.world.settings.mode {
            Mode::Gooch(parameters) if Self::can(WhittedFeatures::GOOCH) => {
                self.gooch(shading_point, parameters)
            }
            Mode::Phong | Mode::Gooch(_) | Mode::Path(_) => self.phong(shading_point),
            Mode::Normal | Mode::Depth => {
                self.counts.add(Effect::NormalBuffer);
                (shading_point.normal + Vec3::ONE) * 0.5
            }
        }
    }
}
