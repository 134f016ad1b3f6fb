//! Local shading: the light that reaches a point directly, by Phong's and by Gooch's model.

use super::film::Counts;
use super::optics::highlight;
use super::ray::Interaction;
use super::sampler::{DiscPoints, Key};
use super::world::World;
use crate::math::{Basis, Vec3};
use crate::valid::{Gooch, Light, Phong};

/// A point seen from one side.
pub(super) struct View<'world> {
    /// The point.
    pub(super) interaction: Interaction,
    /// The unit shading normal on the side of the viewer.
    pub(super) normal: Vec3,
    /// The unit vector to the viewer.
    pub(super) to_viewer: Vec3,
    /// What the surface is made of.
    pub(super) material: &'world Phong,
    /// C at this point.
    pub(super) color: Vec3,
    /// ks at this point.
    pub(super) ks: f64,
    /// Names the point for sampling.
    pub(super) key: Key,
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
    fn incidence(&self, light: Vec3) -> Option<Incidence> {
        let to_light = (light - self.interaction.point).try_normalize()?;
        let n_dot_l = self.normal.dot(to_light);
        let reflected = self.normal * (2.0 * n_dot_l) - to_light;
        Some(Incidence { n_dot_l, r_dot_v: reflected.dot(self.to_viewer) })
    }

    /// `Σ c_l·[ka·C + vis·(kd·C·max(0, N·L) + ks·max(0, R·V)ⁿ)]`, the mean over the points of a soft light.
    ///
    /// Without shadows vis is 1, for the highlight too; with them it is 0 where something stands between, and where
    /// N·L ≤ 0: the surface stands in its own light, and no ray is needed.
    #[must_use]
    pub(super) fn phong(&self, world: &World, counts: &mut Counts) -> Vec3 {
        let samples = world.scene.settings().light_samples.get();
        let mut sum = Vec3::ZERO;
        for (index, light) in world.scene.lights().iter().enumerate() {
            let mut term = self.color * self.material.ka.get();
            if light.radius.get() == 0.0 || samples == 1 {
                term += self.direct(light.position, world, counts);
            } else {
                let key = self.key.child(index as u64);
                let points = soft_light_points(light, self.interaction.point, samples, key);
                let direct = points.map(|point| self.direct(point, world, counts)).sum::<Vec3>();
                term += direct / f64::from(samples);
            }
            sum += light.color * term;
        }
        sum
    }

    /// What one point of a light adds, for a light of colour 1.
    fn direct(&self, light: Vec3, world: &World, counts: &mut Counts) -> Vec3 {
        let Some(incidence) = self.incidence(light) else { return Vec3::ZERO };
        let shadows = world.scene.settings().shadows;
        if shadows && !(incidence.n_dot_l > 0.0 && self.sees(light, world, counts)) {
            return Vec3::ZERO;
        }
        let mut term = self.color * (self.material.kd.get() * incidence.n_dot_l.max(0.0));
        if self.ks > 0.0 {
            term += Vec3::splat(self.ks * highlight(incidence.r_dot_v, self.material.n.get()));
        }
        term
    }

    fn sees(&self, light: Vec3, world: &World, counts: &mut Counts) -> bool {
        counts.shadow += 1;
        let start = self.interaction.start(light - self.interaction.point);
        !world.occluded(start, light)
    }

    /// Gooch et al., "A non-photorealistic lighting model for automatic technical illustration" (SIGGRAPH 1998), in the
    /// course's form: `Σ cool·(1 − N·L)/2 + warm·(1 + N·L)/2 + ks·max(0, R·V)ⁿ·c_l`.
    #[must_use]
    pub(super) fn gooch(&self, world: &World, parameters: &Gooch) -> Vec3 {
        let Gooch { b, y, alpha, beta } = *parameters;
        let (kd, n) = (self.material.kd.get(), self.material.n.get());
        let mut sum = Vec3::ZERO;
        for light in world.scene.lights() {
            let Some(incidence) = self.incidence(light.position) else { continue };
            let tone = light.color * self.color * kd;
            let cool = Vec3::new(0.0, 0.0, b) + tone * alpha;
            let warm = Vec3::new(y, y, 0.0) + tone * beta;
            sum += cool * (0.5 * (1.0 - incidence.n_dot_l)) + warm * (0.5 * (1.0 + incidence.n_dot_l));
            if self.ks > 0.0 {
                sum += light.color * (self.ks * highlight(incidence.r_dot_v, n));
            }
        }
        sum
    }
}

/// Points of the disc that a soft light shows to `from`.
fn soft_light_points(light: &Light, from: Vec3, count: u32, key: Key) -> impl Iterator<Item = Vec3> {
    let towards = (light.position - from).try_normalize().unwrap_or(Vec3::Z);
    let (basis, points) = (Basis::around(towards), DiscPoints::new(count, key));
    let (center, radius) = (light.position, light.radius.get());
    (0..count).map(move |k| {
        let [x, y] = points.point(k);
        center + basis.to_world(Vec3::new(x * radius, y * radius, 0.0))
    })
}
