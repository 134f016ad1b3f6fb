//! Local shading: direct illumination with Phong's or Gooch's model.

use super::WhittedTracer;
use crate::bsdf::optics::highlight;
use crate::integrator::Integrator;
use crate::light::course::CourseLight;
use crate::material::phong::PhongMaterial;
use crate::ray::Interaction;
use crate::sampler::{DiscPoints, PathVertexKey};
use crate::shape::geometry::Intersect;
use crate::world::CourseLightId;
use crate::world::settings::Gooch;
use crate::world::small_scene::SmallScene;
use rtc_math::{NonNegative, OrthonormalBasis, Vec3};
use rtc_plan::{Effect, Rule, WhittedFeatures};

/// A point seen from one side.
pub(crate) struct ShadingPoint<'world> {
    /// The point.
    pub(crate) interaction: Interaction,
    /// The unit shading normal on the side of the viewer.
    pub(crate) normal: Vec3,
    /// The unit vector to the viewer.
    pub(crate) to_viewer: Vec3,
    /// The material of the surface.
    pub(crate) material: &'world PhongMaterial,
    /// C at this point.
    pub(crate) color: Vec3,
    /// ks at this point.
    pub(crate) ks: f64,
    /// The index of the surface in the scene.
    pub(crate) surface: usize,
    /// Names the point for sampling.
    pub(crate) key: PathVertexKey,
}

impl ShadingPoint<'_> {
    /// The weight of the reflected ray at this point.
    pub(crate) fn mirror_weight(&self) -> f64 {
        self.material.kr.map_or(self.ks, NonNegative::get)
    }
}

/// Whether something may hide a light from a point.
#[derive(Clone, Copy)]
struct Occlusion {
    /// The light.
    light: CourseLightId,
    maybe: bool,
}

/// A light as seen from a point.
struct LightIncidence {
    /// N·L.
    n_dot_l: f64,
    /// R·V.
    r_dot_v: f64,
}

/// The colour of the outlines of a cartoon.
pub(super) const OUTLINE: Vec3 = Vec3::splat(0.1);

impl LightIncidence {
    /// As in a cartoon: N·L falls in steps, and a highlight is there or not. The numbers are those
    /// of a program for the course's JSON years.
    fn stepped(self) -> Self {
        let n_dot_l = match self.n_dot_l {
            n if n < 0.1 => 0.0,
            n if n < 0.25 => 0.25,
            n if n < 0.3 => 0.3,
            _ => 1.0,
        };
        let r_dot_v = if self.r_dot_v < 0.9 { 0.0 } else { 1.0 };
        Self { n_dot_l, r_dot_v }
    }
}

impl ShadingPoint<'_> {
    /// Whether it is on a silhouette in toon shading: the viewer grazes the surface itself there,
    /// independent of its maps and vertex normals, which a plan may remove.
    pub(super) fn is_outline(&self) -> bool {
        self.geometric().dot(self.to_viewer) < 0.2
    }

    /// The geometric unit normal on the side of the viewer: the shading normal, where they are
    /// equal.
    pub(crate) fn geometric(&self) -> Vec3 {
        let normal = self.interaction.normal;
        if self.to_viewer.dot(normal) < 0.0 {
            -normal
        } else {
            normal
        }
    }

    /// Whether a point is on the viewer's side of the surface itself, by the sum that decides the
    /// start of a ray to it; where both normals are equal, the shading normal decides.
    fn is_before(&self, place: Vec3) -> bool {
        let normal = self.geometric();
        normal == self.normal || normal.dot(place - self.interaction.point) > 0.0
    }

    /// `None` if the light is exactly at the point: it has no direction then, and adds its ambient
    /// term only.
    fn incidence(&self, light: Vec3) -> Option<LightIncidence> {
        let to_light = (light - self.interaction.point).try_normalize()?;
        let n_dot_l = self.normal.dot(to_light);
        let reflected = self.normal * (2.0 * n_dot_l) - to_light;
        Some(LightIncidence {
            n_dot_l,
            r_dot_v: reflected.dot(self.to_viewer),
        })
    }
}

impl<S: Intersect, const F: u32> WhittedTracer<'_, S, F> {
    /// `Σ c_l·[ka·C + vis·(kd·C·max(0, N·L) + ks·max(0, R·V)ⁿ)]`, the mean over the points of a
    /// soft light; an ambient term that is added once precedes the sum, as `ka·C` times the
    /// colour of the ambient light.
    ///
    /// Without shadows vis is 1, for the highlight too; with them it is 0 where the light is
    /// occluded, and where N·L ≤ 0, with the shading or the geometric normal: the surface shadows
    /// itself. So a closed mesh lets no light in, whatever the normals of its corners.
    #[must_use]
    pub(crate) fn phong(&mut self, shading_point: &ShadingPoint<'_>) -> Vec3 {
        let world = self.world;
        let samples = world.settings.light_samples;
        // Add the ambient term once, or once per light.
        let ambient = shading_point.color * shading_point.material.ka.get();
        let (mut sum, ambient) = match world.settings.ambient_light {
            Some(light) => (light * ambient, Vec3::ZERO),
            None => (Vec3::ZERO, ambient),
        };
        for (index, light) in world.lights.course.entries() {
            let plan = &world.plan.lights[index];
            if !plan.is_used {
                continue;
            }
            if !self.should_continue() {
                break;
            }
            let mut term = ambient;
            // Add the direct light, averaged over the points of a soft light.
            if Self::can(WhittedFeatures::LIGHT) && plan.direct {
                let shadowed = Occlusion {
                    light: index,
                    maybe: plan.shadowed[shading_point.surface],
                };
                if !Self::can(WhittedFeatures::SAMPLED) || light.radius.get() == 0.0 || samples == 1
                {
                    term += self.direct(shading_point, light.position, shadowed);
                } else {
                    let key = shading_point.key.child(index.index() as u64);
                    let points = DiscPoints::new(samples, key, self.spread);
                    let points =
                        on_soft_light(light, shading_point.interaction.point, samples, points);
                    let direct = points.map_while(|point| {
                        self.counts.add(Effect::SoftLight);
                        self.should_continue()
                            .then(|| self.direct(shading_point, point, shadowed))
                    });
                    term += direct.sum::<Vec3>() / f64::from(samples);
                }
            }
            // Check the plan, if requested.
            self.verify(Effect::DirectLight, "a light left out shines", |plan| {
                let kept = &plan.lights[index];
                let left_out = if kept.is_used { term - ambient } else { term };
                !(kept.is_used && kept.direct) && light.color * left_out != Vec3::ZERO
            });
            sum += light.color * term;
        }
        sum
    }

    /// The contribution of one point of a light, for a light of colour 1.
    fn direct(
        &mut self,
        shading_point: &ShadingPoint<'_>,
        light: Vec3,
        shadowed: Occlusion,
    ) -> Vec3 {
        let diffuse = shading_point.color * shading_point.material.kd.get();
        let shines = Self::can(WhittedFeatures::HIGHLIGHT)
            && (shading_point.ks > 0.0 || !self.applies(Rule::HighlightKs));
        if diffuse == Vec3::ZERO && !shines && self.applies(Rule::ShadowUnlit) {
            return Vec3::ZERO;
        }
        self.counts.add(Effect::DirectLight);
        let Some(incidence) = shading_point.incidence(light) else {
            return Vec3::ZERO;
        };
        if self.world.settings.shadows
            && !self.is_lit(shading_point, light, incidence.n_dot_l, shadowed)
        {
            return Vec3::ZERO;
        }
        let incidence = if Self::can(WhittedFeatures::GOOCH) && self.steps {
            incidence.stepped()
        } else {
            incidence
        };
        let mut term =
            shading_point.color * (shading_point.material.kd.get() * incidence.n_dot_l.max(0.0));
        if shines {
            self.counts.add(Effect::Highlight);
            term += Vec3::splat(
                shading_point.ks * highlight(incidence.r_dot_v, shading_point.material.n.get()),
            );
        }
        term
    }

    /// Whether a surface faces a light that is not occluded.
    fn is_lit(
        &mut self,
        shading_point: &ShadingPoint<'_>,
        light: Vec3,
        n_dot_l: f64,
        shadowed: Occlusion,
    ) -> bool {
        let faces =
            n_dot_l > 0.0 && (!Self::can(WhittedFeatures::MAPS) || shading_point.is_before(light));
        if !faces && self.applies(Rule::ShadowFacing) {
            return false;
        }
        let sees = !Self::can(WhittedFeatures::SHADOW) || self.sees(shading_point, light, shadowed);
        self.verify(
            Effect::Shadows,
            "a shadow ray left out is blocked",
            |plan| {
                let light = &plan.lights[shadowed.light];
                let shows = shading_point.ks > 0.0
                    || shading_point.color * shading_point.material.kd.get() != Vec3::ZERO;
                faces && !sees && light.direct && !light.shadowed[shading_point.surface] && shows
            },
        );
        faces && sees
    }

    /// Whether a point of a light is visible from a point.
    fn sees(&mut self, shading_point: &ShadingPoint<'_>, light: Vec3, shadowed: Occlusion) -> bool {
        if !shadowed.maybe {
            return true;
        }
        self.counts.shadow += 1;
        let interaction = &shading_point.interaction;
        let start = || interaction.start(light - interaction.point);
        let world = self.world;
        let Some(small_scene) = &world.small_scene else {
            return !world.occluded(start(), light);
        };
        let hiding = small_scene.hiding(shadowed.light, shading_point.surface);
        if hiding == 0 {
            return true;
        }
        let items = hiding & self.towards(small_scene, shadowed.light, interaction.point);
        items == 0 || !world.occluded_by(small_scene, items, [start(), light])
    }

    /// The surfaces that may occlude a light from a point, by a cone of such segments.
    #[inline(always)]
    pub(super) fn towards(
        &mut self,
        small_scene: &SmallScene,
        light: CourseLightId,
        from: Vec3,
    ) -> u64 {
        let lights = &self.world.lights.course;
        let place = [self.bounces as usize, light.index(), lights.len()];
        let target = || lights[light].ball();
        self.bundles
            .towards(&small_scene.balls, place, from, target)
    }

    /// Gooch et al., "A non-photorealistic lighting model for automatic technical illustration"
    /// (SIGGRAPH 1998), in the course's form: `Σ cool·(1 − N·L)/2 + warm·(1 + N·L)/2 +
    /// ks·max(0, R·V)ⁿ·c_l`.
    #[must_use]
    pub(crate) fn gooch(&mut self, shading_point: &ShadingPoint<'_>, parameters: &Gooch) -> Vec3 {
        let Gooch { b, y, alpha, beta } = *parameters;
        let (kd, n) = (
            shading_point.material.kd.get(),
            shading_point.material.n.get(),
        );
        let mut sum = Vec3::ZERO;
        for light in &self.world.lights.course {
            if !self.should_continue() {
                break;
            }
            let Some(incidence) = shading_point.incidence(light.position) else {
                continue;
            };
            let tone = light.color * shading_point.color * kd;
            let cool = Vec3::new(0.0, 0.0, b) + tone * alpha;
            let warm = Vec3::new(y, y, 0.0) + tone * beta;
            sum +=
                cool * (0.5 * (1.0 - incidence.n_dot_l)) + warm * (0.5 * (1.0 + incidence.n_dot_l));
            if Self::can(WhittedFeatures::HIGHLIGHT)
                && (shading_point.ks > 0.0 || !self.applies(Rule::HighlightKs))
            {
                sum += light.color * (shading_point.ks * highlight(incidence.r_dot_v, n));
            }
        }
        sum
    }
}

/// The first points of the disc that a soft light shows to `from`.
fn on_soft_light(
    light: &CourseLight,
    from: Vec3,
    count: u32,
    points: DiscPoints,
) -> impl Iterator<Item = Vec3> {
    let towards = (light.position - from).try_normalize().unwrap_or(Vec3::Z);
    let basis = OrthonormalBasis::around(towards);
    let (center, radius) = (light.position, light.radius.get());
    (0..count).map(move |k| {
        let [x, y] = points.point(k);
        center + basis.to_world(Vec3::new(x * radius, y * radius, 0.0))
    })
}
