//! One path after another: what it meets, where it goes on, and the light it finds at each corner.

use crate::color::Tone;
use crate::math::{Vec3, cos_sin_turns, exp};
use crate::render::bsdf::Bsdf;
use crate::render::camera::{image_point, ray_through};
use crate::render::film::heartbeat::{Heartbeat, Proceed};
use crate::render::film::{Behind, Counts, Seeds};
use crate::render::frame::progressive::Sampling;
use crate::render::integrator::path::Strategy;
use crate::render::light::{Incident, Lights};
use crate::render::material::point::{Frame, Point};
use crate::render::material::standard::{Alpha, StandardMaterial};
use crate::render::ray::{Interaction, Ray};
use crate::render::sampler::sobol::{CORNERS, FILM, LENS, Sobol};
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::Asked;
use crate::render::world::{Hit, NOWHERE, World, segment};
use crate::valid::Path;

/// Corners before Russian roulette may end a path.
const SPARED: u32 = 3;

/// Surfaces that a ray goes through at most that are not there for it.
const VEILS: u32 = 1 << 10;

/// Pairs of numbers that a corner takes.
const PAIRS: u32 = 4;

/// Follows paths through a world.
pub(in crate::render) struct Tracer<'world, S> {
    pub(in crate::render) world: &'world World<S>,
    lights: &'world Lights<'world, S>,
    pub(in crate::render) path: Path,
    strategy: Strategy,
    veils: Veils,
    /// What each material needs to know of a surface.
    asked: Vec<Asked>,
    /// What a ray of the camera that meets nothing shows.
    behind: Behind,
    /// Tells of the pixel under way, and whether to go on with it.
    pub(in crate::render) heartbeat: Heartbeat<'world>,
    /// The rays traced so far.
    pub(in crate::render) counts: Counts,
}

/// A path under way.
pub(in crate::render) struct Walk {
    pub(in crate::render) ray: Ray,
    /// The part of a surface where it starts.
    from: (usize, u32),
    /// The factor by which what the ray sees counts.
    beta: Vec3,
    /// The light found so far.
    found: Vec3,
    sobol: Sobol,
    corners: u32,
    /// The density with which scattering took the ray; `None` if nothing else could have.
    pdf: Option<f64>,
    /// The coefficient of absorption along the ray.
    absorption: Vec3,
    /// The colour that dispersion left.
    channel: Option<usize>,
    /// How far the ray has come through veils.
    travelled: f64,
}

/// What a ray met.
pub(in crate::render) struct Corner<'world> {
    pub(in crate::render) at: Interaction,
    pub(in crate::render) point: Point<'world>,
    pub(in crate::render) frame: Frame,
    coat: Vec3,
    pub(in crate::render) hit: Hit,
}

impl<'world, S: Geometry> Tracer<'world, S> {
    pub(in crate::render) fn new(
        world: &'world World<S>,
        lights: &'world Lights<'world, S>,
        path: Path,
        strategy: Strategy,
        proceed: &'world Proceed<'world>,
    ) -> Self {
        Self {
            world,
            lights,
            path,
            strategy,
            veils: Veils::of(world),
            asked: world.standards.iter().map(|m| m.asked).collect(),
            behind: Behind::default(),
            heartbeat: Heartbeat::new(proceed),
            counts: Counts::default(),
        }
    }

    /// The same, with something else behind all surfaces.
    pub(in crate::render) fn before(self, behind: Behind) -> Self {
        Self { behind, ..self }
    }

    /// The same, with all that surfaces know in the corners of its paths.
    pub(in crate::render) fn knowing_all(self) -> Self {
        Self {
            asked: vec![Asked::ALL; self.asked.len()],
            ..self
        }
    }

    /// The mean radiance of a pixel's paths, spread over all of its area.
    pub(in crate::render) fn pixel(&mut self, pixel: [u32; 2], seeds: Seeds) -> Vec3 {
        let count = self.path.samples.get();
        let sample = |index| {
            self.heartbeat
                .goes_on(&self.counts)
                .then(|| self.sample_of(pixel, index, seeds))
        };
        (0..count).map_while(sample).sum::<Vec3>() / f64::from(count)
    }

    /// The radiance along path `index` of a pixel.
    fn sample_of(&mut self, pixel: [u32; 2], index: u32, seeds: Seeds) -> Vec3 {
        let sobol = Sobol::new(pixel, index, seeds);
        let (ray, hits) = (self.camera_ray(pixel, &sobol), self.counts.hits);
        let radiance = self.radiance(ray, sobol);
        let counts = self.behind == Behind::Surroundings || self.counts.hits > hits;
        // A number that overflowed says nothing.
        if counts && radiance.is_finite() {
            radiance
        } else {
            Vec3::ZERO
        }
    }

    /// The ray from the camera that a path of a pixel begins with.
    pub(in crate::render) fn camera_ray(&self, pixel: [u32; 2], sobol: &Sobol) -> Ray {
        let camera = self.world.scene.camera();
        let target = image_point(camera, pixel, sobol.pair(FILM));
        let radius = camera.lens.radius.get();
        if radius == 0.0 {
            return ray_through(camera, camera.eye, target);
        }
        let [u, turn] = sobol.pair(LENS);
        let (x, y) = cos_sin_turns(turns(turn));
        let r = radius * u.sqrt() / camera.up.length();
        ray_through(
            camera,
            camera.eye + camera.right * (r * x) + camera.up * (r * y),
            target,
        )
    }

    /// The radiance along one path.
    fn radiance(&mut self, ray: Ray, sobol: Sobol) -> Vec3 {
        self.counts.camera += 1;
        let mut walk = Walk::new(ray, sobol);
        loop {
            let Some(corner) = self.meet(&mut walk) else {
                self.find_environment(&mut walk);
                return walk.found;
            };
            self.counts.hits += u64::from(walk.corners == 0);
            if !self.heartbeat.goes_on(&self.counts) || !self.scatter(&mut walk, &corner) {
                return walk.found;
            }
            walk.corners += 1;
        }
    }

    /// The next surface that is there; veils let the ray on by chance, and the backs of one-sided
    /// ones a ray of the camera.
    #[inline(always)]
    pub(in crate::render) fn meet(&self, walk: &mut Walk) -> Option<Corner<'world>> {
        walk.travelled = 0.0;
        for veil in 0..VEILS {
            let hit = self.world.nearest_from(&walk.ray, walk.from)?;
            let surface = &self.world.surfaces[hit.surface];
            let at = surface.shape.interaction(&walk.ray, hit.t, hit.part);
            let details =
                surface
                    .shape
                    .details(&walk.ray, &at, hit.part, self.asked[surface.material]);
            let point = Point::new(&self.world.standards[surface.material], &details);
            walk.travelled += hit.t;
            let coverage = if walk.looks_through(&at, point.material) {
                0.0
            } else {
                point.coverage()
            };
            if coverage < 1.0 && walk.sobol.uniform(walk.corners, veil) >= coverage {
                (walk.ray, walk.from) = (at.ray(walk.ray.direction), (hit.surface, hit.part));
                continue;
            }
            let (frame, coat) = point.frame(&at, &details, -walk.ray.direction);
            return Some(Corner {
                at,
                point,
                frame,
                coat,
                hit,
            });
        }
        None
    }

    /// Light from where no surface stands.
    fn find_environment(&self, walk: &mut Walk) {
        let (radiance, aimed) = self.lights.environment(walk.ray.direction);
        walk.found += walk.beta * radiance * self.weight(walk.pdf, || aimed);
    }

    /// The weight of light that scattering found and aiming could have.
    fn weight(&self, scattered: Option<f64>, aimed: impl FnOnce() -> f64) -> f64 {
        match (scattered, self.strategy) {
            (Some(scattered), Strategy::Both) => power_heuristic(scattered, aimed()),
            (Some(_), Strategy::Lights) if aimed() > 0.0 => 0.0,
            _ => 1.0,
        }
    }

    /// Finds light at a corner and turns the path; false if it ends here.
    fn scatter(&mut self, walk: &mut Walk, corner: &Corner<'world>) -> bool {
        let Corner {
            at,
            point,
            frame,
            coat,
            hit,
        } = corner;
        let wo = -walk.ray.direction;
        if walk.absorption != Vec3::ZERO {
            walk.beta *= (walk.absorption * -walk.travelled).map(exp);
        }
        if point.material.is_unlit {
            walk.found += walk.beta * point.base_color();
            return false;
        }
        let emission = point.emission();
        if emission != Vec3::ZERO {
            let square = walk.travelled * walk.travelled;
            let aimed = || {
                self.lights
                    .pdf_of_surface(hit.surface, hit.part, -wo, square)
            };
            walk.found += walk.beta * emission * self.weight(walk.pdf, aimed);
        }
        if walk.corners >= self.world.plan.max_depth {
            return false;
        }
        let [choice, light] = walk.pair(0);
        if point.material.dispersed.is_some() && walk.channel.is_none() {
            walk.disperse();
        }
        let standard = point.standard(frame, *coat, walk.channel, self.path.multiple_scattering);
        let local = frame.to_local(wo);
        let bsdf = Bsdf::new(&standard, local);
        if !bsdf.is_delta() {
            walk.found += walk.beta * self.direct(walk, corner, &bsdf, light);
        }
        let [u, v] = walk.pair(1);
        let Some(sample) = bsdf.sample([choice, u, v]) else {
            return false;
        };
        let wi = frame.to_world(sample.wi).normalize();
        // Light that the shading normal lets through and the surface itself does not, or the
        // reverse, would leak.
        let through = sample.wi.z * local.z < 0.0;
        if through != (wi.dot(at.normal) * wo.dot(at.normal) < 0.0) {
            return false;
        }
        walk.beta *= sample.f * (sample.wi.z.abs() / sample.pdf);
        walk.pdf = (!sample.delta).then_some(sample.pdf);
        if through && point.material.bounds_a_volume {
            walk.absorption = if wi.dot(at.normal) < 0.0 {
                point.material.absorption
            } else {
                Vec3::ZERO
            };
        }
        (walk.ray, walk.from) = (at.ray(wi), (hit.surface, hit.part));
        *if through {
            &mut self.counts.refracted
        } else {
            &mut self.counts.mirror
        } += 1;
        walk.survives()
    }

    /// The light that one light sends to a corner and on along the path.
    fn direct(&mut self, walk: &Walk, corner: &Corner<'world>, bsdf: &Bsdf, choice: f64) -> Vec3 {
        let Corner { at, frame, .. } = corner;
        let Some(Incident {
            wi,
            radiance,
            pdf,
            place,
        }) = self.lights.sample(at.point, choice, || walk.pair(2))
        else {
            return Vec3::ZERO;
        };
        let (local, wo) = (frame.to_local(wi), -walk.ray.direction);
        let through = local.z * frame.to_local(wo).z < 0.0;
        if through != (wi.dot(at.normal) * wo.dot(at.normal) < 0.0) {
            return Vec3::ZERO;
        }
        let value = bsdf.evaluate(local);
        let weight = match (pdf, self.strategy) {
            (Some(aimed), Strategy::Both) => power_heuristic(aimed, value.pdf),
            _ => 1.0,
        };
        let light = value.f * radiance * (local.z.abs() * weight);
        if light == Vec3::ZERO {
            light
        } else {
            light * self.visibility(corner, wi, place)
        }
    }

    /// The share of light that comes through from a place, or from infinitely far away.
    fn visibility(&mut self, corner: &Corner<'world>, wi: Vec3, place: Option<Vec3>) -> f64 {
        self.counts.shadow += 1;
        let ray = corner.at.ray(wi);
        if self.veils == Veils::Solid {
            return self.passing_one_by_one(ray, wi, place);
        }
        let Some((ray, t_max)) = place.map_or(Some((ray, f64::INFINITY)), |place| {
            segment(ray.origin, place)
        }) else {
            return 1.0;
        };
        let pass = |hit: Hit| {
            if self.veils == Veils::None {
                0.0
            } else {
                self.passing(&ray, &hit).1
            }
        };
        self.world
            .passing(&ray, t_max, (corner.hit.surface, corner.hit.part), pass)
    }

    /// Where a ray meets a surface, and the share of light that the surface lets through there.
    fn passing(&self, ray: &Ray, hit: &Hit) -> (Option<Interaction>, f64) {
        let surface = &self.world.surfaces[hit.surface];
        if self.world.standards[surface.material].alpha == Alpha::Opaque {
            return (None, 0.0);
        }
        let at = surface.shape.interaction(ray, hit.t, hit.part);
        let details = surface
            .shape
            .details(ray, &at, hit.part, self.asked[surface.material]);
        (
            Some(at),
            1.0 - Point::new(&self.world.standards[surface.material], &details).coverage(),
        )
    }

    /// As [`Self::visibility`], for surfaces that a ray may cross more than once.
    fn passing_one_by_one(&self, mut ray: Ray, wi: Vec3, place: Option<Vec3>) -> f64 {
        let mut share = 1.0;
        for _ in 0..VEILS {
            if place.is_some_and(|place| !self.world.occluded(ray.origin, place)) {
                return share;
            }
            let Some(hit) = self.world.nearest(&ray) else {
                return share;
            };
            let (at, passing) = self.passing(&ray, &hit);
            share *= passing;
            let Some(at) = at.filter(|_| share > 0.0) else {
                return 0.0;
            };
            ray = at.ray(wi);
        }
        0.0
    }
}

impl<'world, S: Geometry> Sampling<'world> for Tracer<'world, S> {
    const TONE: Option<Tone> = Some(Tone::Srgb);

    fn sample(&mut self, pixel: [u32; 2], number: u64, index: u32) -> Vec3 {
        self.sample_of(
            pixel,
            index,
            Seeds {
                pixel: number,
                lens: number,
                path: number,
            },
        )
    }

    fn counts(&self) -> Counts {
        self.counts
    }

    fn heartbeat(&mut self) -> &mut Heartbeat<'world> {
        &mut self.heartbeat
    }
}

/// What surfaces there are that may be absent in part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Veils {
    None,
    /// Triangles that stand in the world one by one.
    Flat,
    /// Others as well.
    Solid,
}

impl Veils {
    fn of<S: Geometry>(world: &World<S>) -> Self {
        let is_veil = |material: usize| world.standards[material].alpha != Alpha::Opaque;
        let veils =
            (0..world.surfaces.len()).filter(|surface| is_veil(world.surfaces[*surface].material));
        veils.fold(Self::None, |veils, surface| match veils {
            Self::None | Self::Flat if world.is_merged(surface) => Self::Flat,
            Self::None | Self::Flat | Self::Solid => Self::Solid,
        })
    }
}

impl Walk {
    /// A path that begins with a ray.
    pub(in crate::render) fn new(ray: Ray, sobol: Sobol) -> Self {
        Self {
            ray,
            from: NOWHERE,
            beta: Vec3::ONE,
            found: Vec3::ZERO,
            sobol,
            corners: 0,
            pdf: None,
            absorption: Vec3::ZERO,
            channel: None,
            travelled: 0.0,
        }
    }

    /// Whether its ray is of the camera and meets the back of what is seen from one side.
    fn looks_through(&self, at: &Interaction, material: &StandardMaterial) -> bool {
        self.corners == 0
            && self.ray.direction.dot(at.normal) > 0.0
            && material.is_seen_from_one_side
    }

    /// A pair of numbers of this corner.
    fn pair(&self, pair: u32) -> [f64; 2] {
        self.sobol.pair(CORNERS + PAIRS * self.corners + pair)
    }

    /// Keeps one colour, which stands for all three.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "one of three"
    )]
    fn disperse(&mut self) {
        let [u, _] = self.pair(3);
        let channel = ((u * 3.0) as usize).min(2);
        let mut kept = [0.0; 3];
        kept[channel] = 3.0;
        self.beta *= Vec3::from_array(kept);
        self.channel = Some(channel);
    }

    /// Ends the path with a probability that grows as its factor falls.
    fn survives(&mut self) -> bool {
        let largest = self.beta.max_element();
        if self.corners < SPARED || largest >= 1.0 {
            return largest > 0.0;
        }
        let [_, u] = self.pair(3);
        self.beta /= largest;
        u < largest
    }
}

/// Veach's power heuristic with exponent 2.
fn power_heuristic(own: f64, other: f64) -> f64 {
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}

/// A share of a turn in units of 2⁻⁶⁴ turns.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share; the cast saturates"
)]
fn turns(share: f64) -> u64 {
    (share * 18_446_744_073_709_551_616.0) as u64
}
