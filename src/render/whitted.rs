//! The integrator of the course: local shading plus mirror and refracted rays (Whitted, "An improved illumination model
//! for shaded display", CACM 23 (1980)), as a loop with a throughput: a long path takes no call stack.

use super::film::Counts;
use super::instance::Details;
use super::optics::{reflect, refract};
use super::ray::{Interaction, Ray};
use super::sampler::{Key, Lobe};
use super::shade::View;
use super::texture::{Frame, look_up};
use super::world::World;
use crate::math::Vec3;
use crate::valid::{Mode, Phong, ValidScene};

/// One path under way.
#[derive(Clone, Copy)]
struct Path {
    ray: Ray,
    /// The factor by which what the ray sees counts.
    beta: f64,
    bounces_left: u32,
    key: Key,
}

/// Work put off: a path, or the rest of a glossy lobe.
enum Pending {
    Path(Path),
    Lobe(Box<Fan>),
}

/// The directions of a lobe not yet followed.
#[derive(Clone, Copy)]
struct Fan {
    lobe: Lobe,
    from: Interaction,
    normal: Vec3,
    next: u32,
    count: u32,
    /// The path each direction goes on with, but for its ray.
    path: Path,
}

/// Follows camera rays through a world; reuse one for many rays, it keeps its memory.
pub(super) struct Tracer<'world> {
    world: &'world World,
    pending: Vec<Pending>,
    /// The rays traced so far.
    pub(super) counts: Counts,
}

impl<'world> Tracer<'world> {
    /// A tracer of the world.
    #[must_use]
    pub(super) fn new(world: &'world World) -> Self {
        Self { world, pending: Vec::new(), counts: Counts::default() }
    }

    /// The scene traced.
    #[must_use]
    pub(super) fn scene(&self) -> &'world ValidScene {
        &self.world.scene
    }

    /// What a camera ray sees, by the mode of the scene; black where it meets nothing.
    pub(super) fn radiance(&mut self, ray: Ray, key: Key) -> Vec3 {
        self.counts.camera += 1;
        let depth = self.scene().settings().max_depth;
        let mut sum = Vec3::ZERO;
        let first = Path { ray, beta: 1.0, bounces_left: depth, key };
        if let Some(view) = self.view(&first.ray, first.key) {
            self.counts.hits += 1;
            sum += self.local(&view);
            if let Mode::Phong = self.scene().settings().mode {
                self.branch(&first, &view);
            }
        }
        while let Some(path) = self.next_path() {
            if let Some(view) = self.view(&path.ray, path.key) {
                sum += self.local(&view) * path.beta;
                self.branch(&path, &view);
            }
        }
        sum
    }

    /// The distance along a camera ray to what it sees.
    pub(super) fn distance(&mut self, ray: &Ray) -> Option<f64> {
        self.counts.camera += 1;
        let hit = self.world.nearest(ray)?;
        self.counts.hits += 1;
        Some(hit.t)
    }

    /// What a ray sees, with the maps of its material applied.
    fn view(&self, ray: &Ray, key: Key) -> Option<View<'world>> {
        let hit = self.world.nearest(ray)?;
        let surface = &self.world.surfaces[hit.surface];
        let interaction = surface.shape.interaction(ray, hit.t, hit.part);
        let material = &self.scene().materials()[surface.material];
        let mut view = View {
            interaction,
            normal: interaction.normal,
            to_viewer: -ray.direction,
            material,
            color: material.color,
            ks: material.ks.get(),
            key,
        };
        if material.maps.is_some() || surface.shape.has_shading_normals() {
            let details = surface.shape.details(ray, &interaction, hit.part);
            self.apply_maps(&mut view, &details);
        }
        if ray.direction.dot(interaction.normal) > 0.0 {
            view.normal = -view.normal;
        }
        Some(view)
    }

    /// Replaces normal, colour and ks by those of the surface's maps; without uv a surface keeps its own.
    fn apply_maps(&self, view: &mut View<'_>, details: &Details) {
        let scene = self.scene();
        view.normal = details.normal.unwrap_or(view.normal);
        let (Some(uv), Some(maps)) = (details.uv, view.material.maps.as_deref()) else { return };
        if let Some(map) = maps.color {
            view.color = look_up(scene, map, uv);
        }
        if let Some(map) = maps.specular {
            view.ks *= look_up(scene, map, uv).x;
        }
        let Some(frame) = details.tangent.and_then(|tangent| Frame::new(view.normal, tangent)) else { return };
        if let Some(map) = maps.normal {
            view.normal = frame.mapped(scene, map, uv);
        } else if let Some(bump) = maps.bump {
            view.normal = frame.bumped(scene, bump, uv);
        }
    }

    fn local(&mut self, view: &View<'_>) -> Vec3 {
        match &self.scene().settings().mode {
            Mode::Phong => view.phong(self.world, &mut self.counts),
            Mode::Gooch(parameters) => view.gooch(self.world, parameters),
            Mode::Normal | Mode::Zbuffer => (view.normal + Vec3::ONE) * 0.5,
        }
    }

    /// Puts off the mirrored and refracted paths that go on from here.
    fn branch(&mut self, path: &Path, view: &View<'_>) {
        if path.bounces_left == 0 {
            return;
        }
        let direction = path.ray.direction;
        let refracted = transmit(direction, view);
        let mirror_weight = match refracted {
            Some(_) => view.ks,
            None => view.ks + view.material.kt.get(),
        };
        let mirror = mirror_direction(direction, view);
        self.put_off_mirror(path, view, mirror, mirror_weight);
        if let Some(refracted) = refracted {
            self.put_off(path, &view.interaction, refracted, view.material.kt.get(), 1);
        }
    }

    fn put_off_mirror(&mut self, path: &Path, view: &View<'_>, mirror: Vec3, weight: f64) {
        let Phong { n, glossy_samples, .. } = view.material;
        if glossy_samples.get() == 1 {
            self.put_off(path, &view.interaction, mirror, weight, 0);
            return;
        }
        let lobe = Lobe::new(mirror, *n, glossy_samples.get(), path.key);
        let above = lobe.count_above(view.normal);
        let Some(path) = next(path, weight / f64::from(above.max(1)), Ray { direction: mirror, ..path.ray }, 0) else {
            return;
        };
        let fan = Fan { lobe, from: view.interaction, normal: view.normal, next: 0, count: glossy_samples.get(), path };
        self.pending.push(Pending::Lobe(Box::new(fan)));
    }

    fn put_off(&mut self, path: &Path, from: &Interaction, direction: Vec3, weight: f64, branch: u64) {
        let path = next(path, weight, from.ray(direction), branch);
        self.pending.extend(path.map(Pending::Path));
    }

    /// The next path to follow: refracted before mirrored, a lobe one direction after the other.
    fn next_path(&mut self) -> Option<Path> {
        loop {
            match self.pending.pop()? {
                Pending::Path(path) => {
                    self.counts.secondary += 1;
                    return Some(path);
                }
                Pending::Lobe(mut fan) => {
                    let Some(path) = fan.take() else { continue };
                    self.pending.push(Pending::Lobe(fan));
                    self.counts.secondary += 1;
                    return Some(path);
                }
            }
        }
    }
}

impl Fan {
    /// The path along the next direction above the surface.
    fn take(&mut self) -> Option<Path> {
        while self.next < self.count {
            let k = self.next;
            self.next += 1;
            let direction = self.lobe.direction(k);
            if direction.dot(self.normal) > 0.0 {
                let key = self.path.key.child(u64::from(k));
                return Some(Path { ray: self.from.ray(direction), key, ..self.path });
            }
        }
        None
    }
}

/// The mirror direction at the shading normal, or at the geometric one where that would lead into the surface.
fn mirror_direction(direction: Vec3, view: &View<'_>) -> Vec3 {
    let mirror = reflect(direction, view.normal);
    let leads_inside = mirror.dot(view.interaction.normal) * direction.dot(view.interaction.normal) > 0.0;
    if leads_inside { reflect(direction, view.interaction.normal) } else { mirror }
}

/// The refracted direction, if the material lets light through and the angle does.
fn transmit(direction: Vec3, view: &View<'_>) -> Option<Vec3> {
    let Phong { kt, eta, .. } = view.material;
    if kt.get() == 0.0 {
        return None;
    }
    let enters = direction.dot(view.interaction.normal) <= 0.0;
    let (from, to) = if enters { (1.0, eta.get()) } else { (eta.get(), 1.0) };
    refract(direction, view.normal, from, to)
}

/// The path one bounce further, or `None` if nothing it sees can count.
fn next(path: &Path, weight: f64, ray: Ray, branch: u64) -> Option<Path> {
    let beta = (path.beta * weight).min(f64::MAX);
    let goes_on = beta > 0.0;
    goes_on.then(|| Path { ray, beta, bounces_left: path.bounces_left - 1, key: path.key.child(branch) })
}
