//! Local shading: the light that reaches a point directly, by Phong's and by Gooch's model.

use super::film::Counts;
use super::optics::highlight;
use super::ray::Interaction;
use super::world::World;
use crate::math::Vec3;
use crate::valid::{Gooch, Light, Phong};

/// A point seen from one side.
pub(super) struct View<'world> {
    /// The point.
    pub(super) interaction: Interaction,
    /// The unit normal on the side of the viewer.
    pub(super) normal: Vec3,
    /// The unit vector to the viewer.
    pub(super) to_viewer: Vec3,
    /// What the surface is made of.
    pub(super) material: &'world Phong,
}

/// A light as seen from a point.
struct Incidence {
    /// N·L.
    n_dot_l: f64,
    /// R·V.
    r_dot_v: f64,
}

impl View<'_> {
    /// `None` if the light stands exactly at the point: it has no direction then, and adds its ambient term only.
    fn incidence(&self, light: &Light) -> Option<Incidence> {
        let to_light = (light.position - self.interaction.point).try_normalize()?;
        let n_dot_l = self.normal.dot(to_light);
        let reflected = self.normal * (2.0 * n_dot_l) - to_light;
        Some(Incidence { n_dot_l, r_dot_v: reflected.dot(self.to_viewer) })
    }

    /// `Σ c_l·[ka·C + vis·(kd·C·max(0, N·L) + ks·max(0, R·V)ⁿ)]`.
    ///
    /// Without shadows vis is 1, for the highlight too; with them it is 0 where something stands between, and where
    /// N·L ≤ 0: the surface stands in its own light, and no ray is needed.
    #[must_use]
    pub(super) fn phong(&self, world: &World, counts: &mut Counts) -> Vec3 {
        let Phong { color, ka, kd, ks, n, .. } = self.material;
        let shadows = world.scene.settings().shadows;
        let mut sum = Vec3::ZERO;
        for light in world.scene.lights() {
            let mut term = *color * ka.get();
            if let Some(incidence) = self.incidence(light)
                && (!shadows || (incidence.n_dot_l > 0.0 && self.sees(light, world, counts)))
            {
                term += *color * (kd.get() * incidence.n_dot_l.max(0.0));
                if ks.get() > 0.0 {
                    term += Vec3::splat(ks.get() * highlight(incidence.r_dot_v, n.get()));
                }
            }
            sum += light.color * term;
        }
        sum
    }

    fn sees(&self, light: &Light, world: &World, counts: &mut Counts) -> bool {
        counts.shadow += 1;
        let start = self.interaction.start(light.position - self.interaction.point);
        !world.occluded(start, light.position)
    }

    /// Gooch et al., "A non-photorealistic lighting model for automatic technical illustration" (SIGGRAPH 1998), in the
    /// course's form: `Σ cool·(1 − N·L)/2 + warm·(1 + N·L)/2 + ks·max(0, R·V)ⁿ·c_l`.
    #[must_use]
    pub(super) fn gooch(&self, world: &World, parameters: &Gooch) -> Vec3 {
        let Gooch { b, y, alpha, beta } = *parameters;
        let Phong { color, kd, ks, n, .. } = self.material;
        let mut sum = Vec3::ZERO;
        for light in world.scene.lights() {
            let Some(incidence) = self.incidence(light) else { continue };
            let tone = light.color * *color * kd.get();
            let cool = Vec3::new(0.0, 0.0, b) + tone * alpha;
            let warm = Vec3::new(y, y, 0.0) + tone * beta;
            sum += cool * (0.5 * (1.0 - incidence.n_dot_l)) + warm * (0.5 * (1.0 + incidence.n_dot_l));
            if ks.get() > 0.0 {
                sum += light.color * (ks.get() * highlight(incidence.r_dot_v, n.get()));
            }
        }
        sum
    }
}
