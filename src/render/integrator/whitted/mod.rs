//! The integrator of the course: local shading plus mirror and refracted rays (Whitted, "An
//! improved illumination model for shaded display", CACM 23 (1980)), as a loop with a throughput: a
//! long path takes no call stack.

mod aov;
mod pixel;
mod shade;

use crate::math::Vec3;
use crate::plan::{Effect, Features, Plan, Rule};
use crate::render::bsdf::optics::{reflect, refract};
use crate::render::camera::grid::Grid;
use crate::render::film::Counts;
use crate::render::film::heartbeat::{Heartbeat, Proceed};
use crate::render::integrator::Integrator;
use crate::render::material::phong::PhongMaterial;
use crate::render::ray::{Interaction, Ray};
use crate::render::sampler::{Key, Lobe, is_above};
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::{Asked, Details};
use crate::render::texture::bilinear::{Frame, look_up};
use crate::render::world::{Hit, World};
use crate::valid::{Mode, Proof};
use pixel::PixelState;
use shade::View;

/// One path under way.
#[derive(Clone, Copy)]
struct Path {
    ray: Ray,
    /// The factor by which what the ray sees counts.
    beta: f64,
    bounces_left: u32,
    key: Key,
    kind: Kind,
}

/// How a path came about at its last bounce.
#[derive(Clone, Copy)]
enum Kind {
    Mirrored,
    Refracted,
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
    /// The normals above which all directions lie.
    normals: [Vec3; 2],
    next: u32,
    count: u32,
    /// The path each direction goes on with, but for its ray.
    path: Path,
}

/// Follows camera rays through a world with the [`Features`] `F`; reuse one for many rays, it keeps
/// its memory.
pub(in crate::render) struct Tracer<'world, S, const F: u32> {
    pub(in crate::render) world: &'world World<S>,
    pending: Vec<Pending>,
    /// Tells of the pixel under way, and whether to go on with it.
    pub(in crate::render) heartbeat: Heartbeat<'world>,
    /// Whether the path under way counts 0 times: then nothing it meets says anything about a
    /// plan.
    pub(in crate::render) weightless: bool,
    /// Whether points of soft lights are spread without bias, however few they are.
    pub(in crate::render) spread: bool,
    grid: Grid,
    pixel: PixelState,
    /// The rays traced so far.
    pub(in crate::render) counts: Counts,
}

impl<'world, S: Geometry, const F: u32> Tracer<'world, S, F> {
    /// A tracer of the world, watched by `proceed`.
    #[must_use]
    pub(in crate::render) fn new(
        world: &'world World<S>,
        proceed: &'world Proceed<'world>,
    ) -> Self {
        let (heartbeat, counts) = (Heartbeat::new(proceed), Counts::default());
        Self {
            world,
            pending: Vec::new(),
            heartbeat,
            weightless: false,
            spread: false,
            grid: Grid::of(&world.scene),
            pixel: PixelState::default(),
            counts,
        }
    }

    /// The same, with points of soft lights spread without bias.
    pub(in crate::render) fn spread(self) -> Self {
        Self {
            spread: true,
            ..self
        }
    }

    /// The scene traced.
    #[must_use]
    pub(in crate::render) fn scene(&self) -> &'world Proof {
        &self.world.scene
    }

    /// Whether this tracer can do it: known at compile time.
    #[inline]
    pub(in crate::render) const fn can(feature: Features) -> bool {
        Features(F).contains(feature)
    }

    /// Whether a rule that decides hit by hit applies: always, but for the naive tracer.
    #[inline]
    pub(in crate::render) fn applies(&self, rule: Rule) -> bool {
        !Self::can(Features::NAIVE) || self.world.plan.rules.contains(rule)
    }

    /// Reports a fault of the plan under validation, if there is one and `is_fault` finds it.
    pub(in crate::render) fn verify(
        &self,
        effect: Effect,
        what: &'static str,
        is_fault: impl FnOnce(&Plan) -> bool,
    ) {
        if Self::can(Features::NAIVE)
            && !self.weightless
            && let Some(verify) = &self.world.verify
            && is_fault(&verify.plan)
        {
            verify.report(self.heartbeat.pixel(), effect, what);
        }
    }

    /// What a camera ray sees, by the mode of the scene; black where it meets nothing.
    pub(in crate::render) fn radiance(&mut self, ray: Ray, key: Key) -> Vec3 {
        self.counts.camera += 1;
        let depth = self.world.plan.max_depth;
        let mut sum = Vec3::ZERO;
        self.weightless = false;
        let first = Path {
            ray,
            beta: 1.0,
            bounces_left: depth,
            key,
            kind: Kind::Mirrored,
        };
        if let Some(view) = self.view(&first.ray, first.key) {
            self.counts.hits += 1;
            self.verify(Effect::Surfaces, "a ray meets a surface left out", |plan| {
                !plan.surfaces[view.surface]
            });
            sum += self.local(&view);
            if Self::can(Features::BOUNCE) {
                self.branch(&first, &view);
            }
        }
        while Self::can(Features::BOUNCE)
            && let Some(path) = self.next_path()
        {
            self.weightless = path.beta == 0.0;
            if let Some(view) = self.view(&path.ray, path.key) {
                let value = self.local(&view) * path.beta;
                self.verify_bounce(&path, &view, value);
                sum += value;
                self.branch(&path, &view);
            }
        }
        sum
    }

    /// Looks whether a bounce that counts meets what the plan leaves out.
    fn verify_bounce(&self, path: &Path, view: &View<'_>, value: Vec3) {
        let bounces = self.world.plan.max_depth - path.bounces_left;
        self.verify(Effect::Depth, "a bounce left out adds something", |plan| {
            bounces > plan.max_depth && value != Vec3::ZERO && !plan.rules.contains(Rule::Cut)
        });
        self.verify(
            Effect::Surfaces,
            "a bounce meets a surface left out",
            |plan| bounces <= plan.max_depth && !plan.surfaces[view.surface],
        );
    }

    /// What a ray sees, with the maps of its material applied.
    fn view(&mut self, ray: &Ray, key: Key) -> Option<View<'world>> {
        let hit = self.world.nearest(ray)?;
        Some(self.view_of(ray, hit, key))
    }

    /// What a ray sees at a hit.
    pub(in crate::render) fn view_of(&mut self, ray: &Ray, hit: Hit, key: Key) -> View<'world> {
        let surface = &self.world.surfaces[hit.surface];
        let interaction = surface.shape.interaction(ray, hit.t, hit.part);
        let material = &self.world.phongs[surface.material];
        let mut view = View {
            interaction,
            normal: interaction.normal,
            to_viewer: -ray.direction,
            material,
            color: material.color,
            ks: material.ks.get(),
            surface: surface.index,
            key,
        };
        if Self::can(Features::MAPS)
            && (material.maps.is_some() || surface.shape.has_shading_normals())
        {
            let details = surface
                .shape
                .details(ray, &interaction, hit.part, Asked::ALL);
            self.apply_maps(&mut view, &details);
        }
        if ray.direction.dot(interaction.normal) > 0.0 {
            view.normal = -view.normal;
        }
        view
    }

    /// Replaces normal, colour and ks by those of the surface's maps; without uv a surface keeps
    /// its own.
    fn apply_maps(&mut self, view: &mut View<'_>, details: &Details) {
        if details.normal.is_some() {
            self.counts.add(Effect::NormalInterpolation);
        }
        view.normal = details.normal.unwrap_or(view.normal);
        let (Some(uv), Some(maps)) = (details.uv, view.material.maps.as_deref()) else {
            return;
        };
        if maps.color.is_some() || maps.specular.is_some() {
            self.counts.add(Effect::Textures);
        }
        if let Some(map) = &maps.color {
            view.color = look_up(map, uv);
        }
        if let Some(map) = &maps.specular {
            view.ks *= look_up(map, uv).x.max(0.0);
        }
        let Some(frame) = details
            .tangent
            .and_then(|tangent| Frame::new(view.normal, tangent))
        else {
            return;
        };
        if maps.normal.is_some() || maps.bump.is_some() {
            self.counts.add(Effect::NormalMapping);
        }
        if let Some(map) = &maps.normal {
            view.normal = frame.mapped(map, uv);
        } else if let Some(bump) = &maps.bump {
            view.normal = frame.bumped(bump, uv);
        }
    }

    fn local(&mut self, view: &View<'_>) -> Vec3 {
        match &self.scene().settings().mode {
            Mode::Gooch(parameters) if Self::can(Features::GOOCH) => self.gooch(view, parameters),
            Mode::Phong | Mode::Gooch(_) | Mode::Path(_) => self.phong(view),
            Mode::Normal | Mode::Zbuffer => {
                self.counts.add(Effect::NormalBuffer);
                (view.normal + Vec3::ONE) * 0.5
            }
        }
    }

    /// Puts off the mirrored and refracted paths that go on from here.
    fn branch(&mut self, path: &Path, view: &View<'_>) {
        if path.bounces_left == 0 || path.beta == 0.0 {
            return;
        }
        let direction = path.ray.direction;
        let refracted = transmit(direction, view, self.scene().settings().shadows);
        let mirror_weight = match refracted {
            Some(_) => view.ks,
            None => view.ks + view.material.kt.get(),
        };
        let mirror = mirror_direction(direction, view);
        self.put_off_mirror(path, view, mirror, mirror_weight);
        if let Some(refracted) = refracted {
            self.put_off(
                path,
                &view.interaction,
                refracted,
                view.material.kt.get(),
                Kind::Refracted,
            );
        }
    }

    fn put_off_mirror(&mut self, path: &Path, view: &View<'_>, mirror: Vec3, weight: f64) {
        let PhongMaterial {
            n, glossy_samples, ..
        } = view.material;
        if !Self::can(Features::SAMPLED) || glossy_samples.get() == 1 || weight == 0.0 {
            self.put_off(path, &view.interaction, mirror, weight, Kind::Mirrored);
            return;
        }
        let lobe = Lobe::new(mirror, *n, glossy_samples.get(), path.key);
        // With shadows no light comes through a surface that mirrors.
        let geometric = if self.scene().settings().shadows {
            view.geometric()
        } else {
            view.normal
        };
        let normals = [view.normal, geometric];
        let above = lobe.count_above(normals, || self.goes_on());
        let ray = Ray {
            direction: mirror,
            ..path.ray
        };
        let Some(path) = self.next(path, weight / f64::from(above.max(1)), ray, Kind::Mirrored)
        else {
            return;
        };
        let fan = Fan {
            lobe,
            from: view.interaction,
            normals,
            next: 0,
            count: glossy_samples.get(),
            path,
        };
        self.pending.push(Pending::Lobe(Box::new(fan)));
    }

    fn put_off(
        &mut self,
        path: &Path,
        from: &Interaction,
        direction: Vec3,
        weight: f64,
        kind: Kind,
    ) {
        let path = self.next(path, weight, from.ray(direction), kind);
        self.pending.extend(path.map(Pending::Path));
    }

    /// The path one bounce further, or `None` if nothing it sees can count.
    fn next(&self, path: &Path, weight: f64, ray: Ray, kind: Kind) -> Option<Path> {
        let beta = (path.beta * weight).min(f64::MAX);
        let goes_on = beta > 0.0 || !self.applies(Rule::MirrorKs);
        let key = path.key.child(kind as u64);
        goes_on.then(|| Path {
            ray,
            beta,
            bounces_left: path.bounces_left - 1,
            key,
            kind,
        })
    }

    /// The next path to follow: refracted before mirrored, a lobe one direction after the other.
    fn next_path(&mut self) -> Option<Path> {
        let path = loop {
            if !self.goes_on() {
                self.pending.clear();
                return None;
            }
            match self.pending.pop()? {
                Pending::Path(path) => break path,
                Pending::Lobe(mut fan) => {
                    let Some(path) = fan.take(|| self.goes_on()) else {
                        continue;
                    };
                    self.counts.add(Effect::GlossyReflection);
                    self.pending.push(Pending::Lobe(fan));
                    break path;
                }
            }
        };
        match path.kind {
            Kind::Mirrored => self.counts.mirror += 1,
            Kind::Refracted => self.counts.refracted += 1,
        }
        Some(path)
    }
}

impl Fan {
    /// The path along the next direction above the surface.
    fn take(&mut self, mut goes_on: impl FnMut() -> bool) -> Option<Path> {
        while self.next < self.count && goes_on() {
            let k = self.next;
            self.next += 1;
            let direction = self.lobe.direction(k);
            if is_above(direction, self.normals) {
                let key = self.path.key.child(u64::from(k));
                return Some(Path {
                    ray: self.from.ray(direction),
                    key,
                    ..self.path
                });
            }
        }
        None
    }
}

/// The mirror direction at the shading normal, or at the geometric one where that would lead into
/// the surface.
fn mirror_direction(direction: Vec3, view: &View<'_>) -> Vec3 {
    let mirror = reflect(direction, view.normal);
    let leads_inside =
        mirror.dot(view.interaction.normal) * direction.dot(view.interaction.normal) > 0.0;
    if leads_inside {
        reflect(direction, view.interaction.normal)
    } else {
        mirror
    }
}

/// The refracted direction, if the material lets light through and the angle does.
///
/// The geometric normal decides where the shading normal can't: where it is turned away from the
/// ray, or totally reflects what its mirror then sends into the surface. With `sided` it also does
/// where the shading normal would keep on this side of the surface what is to go through. So an eta
/// of 1 bends no ray, whatever the shading normal.
fn transmit(direction: Vec3, view: &View<'_>, sided: bool) -> Option<Vec3> {
    let PhongMaterial { kt, eta, .. } = view.material;
    if kt.get() == 0.0 {
        return None;
    }
    let enters = direction.dot(view.interaction.normal) <= 0.0;
    let (from, to) = if enters {
        (1.0, eta.get())
    } else {
        (eta.get(), 1.0)
    };
    let (shading, geometric) = (view.normal, view.geometric());
    if direction.dot(shading) < 0.0 {
        match refract(direction, shading, from, to) {
            Some(refracted) if !sided || refracted.dot(geometric) < 0.0 => return Some(refracted),
            None if reflect(direction, shading).dot(geometric) > 0.0 => return None,
            Some(_) | None => {}
        }
    }
    refract(direction, geometric, from, to)
}
