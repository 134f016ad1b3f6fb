//! The ray tree of a camera ray: reflected and refracted rays, on a stack until they are traced.

use super::WhittedTracer;
use super::shade::ShadingPoint;
use crate::bsdf::fresnel::{normal_reflectance, schlick};
use crate::bsdf::optics::{reflect, refract};
use crate::integrator::Integrator;
use crate::material::phong::PhongMaterial;
use crate::ray::{Interaction, Ray};
use crate::sampler::{PathVertexKey, PhongLobeSampler, is_above};
use crate::shape::geometry::Intersect;
use rtc_math::Vec3;
use rtc_plan::{Effect, Rule, WhittedFeatures};

/// A path in progress.
#[derive(Clone, Copy)]
pub(super) struct RayBranch {
    pub(super) ray: Ray,
    /// The weight of the radiance along the ray.
    pub(super) beta: f64,
    pub(super) bounces_left: u32,
    pub(super) key: PathVertexKey,
    pub(super) kind: RayBranchKind,
}

/// The kind of the last bounce of a path.
#[derive(Clone, Copy)]
pub(super) enum RayBranchKind {
    Mirrored,
    Refracted,
}

/// Pending work: a path, or the rest of a glossy lobe.
pub(super) enum PendingWork {
    Ray(RayBranch),
    Glossy(Box<GlossyBatch>),
}

/// The directions of a lobe not yet followed.
#[derive(Clone, Copy)]
pub(super) struct GlossyBatch {
    lobe: PhongLobeSampler,
    from: Interaction,
    /// The normals above which all directions lie.
    normals: [Vec3; 2],
    next: u32,
    count: u32,
    /// The path of each direction, except for its ray.
    path: RayBranch,
}

impl<'world, S: Intersect, const F: u32> WhittedTracer<'world, S, F> {
    /// Adds the reflected and refracted paths from here to the pending ones.
    pub(super) fn branch(&mut self, path: &RayBranch, shading_point: &ShadingPoint<'_>) {
        if path.bounces_left == 0 || path.beta == 0.0 {
            return;
        }
        let direction = path.ray.direction;
        let refracted = transmit(direction, shading_point, self.world.settings.shadows);
        let kt = shading_point.material.kt.get();
        let reflected_part = match refracted {
            Some(_) => reflected_part(direction, shading_point),
            None => 1.0,
        };
        let mirror_weight = shading_point.mirror_weight() + kt * reflected_part;
        if self.is_nonzero(path.beta * mirror_weight) {
            let mirror = mirror_direction(direction, shading_point);
            self.push_mirror(path, shading_point, mirror, mirror_weight);
        }
        if let Some(refracted) = refracted {
            self.push_ray(
                path,
                &shading_point.interaction,
                refracted,
                kt * (1.0 - reflected_part),
                RayBranchKind::Refracted,
            );
        }
    }

    fn push_mirror(
        &mut self,
        path: &RayBranch,
        shading_point: &ShadingPoint<'_>,
        mirror: Vec3,
        weight: f64,
    ) {
        let PhongMaterial {
            n, glossy_samples, ..
        } = shading_point.material;
        if !Self::can(WhittedFeatures::SAMPLED) || glossy_samples.get() == 1 || weight == 0.0 {
            self.push_ray(
                path,
                &shading_point.interaction,
                mirror,
                weight,
                RayBranchKind::Mirrored,
            );
            return;
        }
        let lobe = PhongLobeSampler::new(mirror, *n, glossy_samples.get(), path.key);
        // With shadows no light comes through a surface that mirrors.
        let geometric = if self.world.settings.shadows {
            shading_point.geometric()
        } else {
            shading_point.normal
        };
        let normals = [shading_point.normal, geometric];
        let above = lobe.count_above(normals, || self.should_continue());
        let ray = Ray {
            direction: mirror,
            ..path.ray
        };
        let Some(path) = self.next(
            path,
            weight / f64::from(above.max(1)),
            ray,
            RayBranchKind::Mirrored,
        ) else {
            return;
        };
        let fan = GlossyBatch {
            lobe,
            from: shading_point.interaction,
            normals,
            next: 0,
            count: glossy_samples.get(),
            path,
        };
        self.pending.push(PendingWork::Glossy(Box::new(fan)));
    }

    fn push_ray(
        &mut self,
        path: &RayBranch,
        from: &Interaction,
        direction: Vec3,
        weight: f64,
        kind: RayBranchKind,
    ) {
        let path = self.next(path, weight, from.ray(direction), kind);
        self.pending.extend(path.map(PendingWork::Ray));
    }

    /// Whether a path of a weight is followed.
    fn is_nonzero(&self, beta: f64) -> bool {
        beta > 0.0 || !self.applies(Rule::MirrorKs)
    }

    /// The path one bounce further, or `None` if its weight is 0.
    fn next(
        &self,
        path: &RayBranch,
        weight: f64,
        ray: Ray,
        kind: RayBranchKind,
    ) -> Option<RayBranch> {
        let beta = (path.beta * weight).min(f64::MAX);
        let should_continue = self.is_nonzero(beta);
        let key = if Self::can(WhittedFeatures::SAMPLED) {
            path.key.child(kind as u64)
        } else {
            PathVertexKey::UNUSED
        };
        should_continue.then(|| RayBranch {
            ray,
            beta,
            bounces_left: path.bounces_left - 1,
            key,
            kind,
        })
    }

    /// The next path to follow: refracted before reflected, and the directions of a lobe one by
    /// one.
    pub(super) fn next_branch(&mut self) -> Option<RayBranch> {
        let path = loop {
            if !self.should_continue() {
                self.pending.clear();
                return None;
            }
            match self.pending.pop()? {
                PendingWork::Ray(path) => break path,
                PendingWork::Glossy(mut fan) => {
                    let Some(path) = fan.take(|| self.should_continue()) else {
                        continue;
                    };
                    self.counts.add(Effect::GlossyReflection);
                    self.pending.push(PendingWork::Glossy(fan));
                    break path;
                }
            }
        };
        match path.kind {
            RayBranchKind::Mirrored => self.counts.mirror += 1,
            RayBranchKind::Refracted => self.counts.refracted += 1,
        }
        Some(path)
    }
}

impl GlossyBatch {
    /// The path along the next direction above the surface.
    fn take(&mut self, mut should_continue: impl FnMut() -> bool) -> Option<RayBranch> {
        while self.next < self.count && should_continue() {
            let k = self.next;
            self.next += 1;
            let direction = self.lobe.direction(k);
            if is_above(direction, self.normals) {
                let key = self.path.key.child(u64::from(k));
                return Some(RayBranch {
                    ray: self.from.ray(direction),
                    key,
                    ..self.path
                });
            }
        }
        None
    }
}

/// The mirror direction at the shading normal, or at the geometric normal if the former points into
/// the surface.
fn mirror_direction(direction: Vec3, shading_point: &ShadingPoint<'_>) -> Vec3 {
    let mirror = reflect(direction, shading_point.normal);
    let leads_inside = mirror.dot(shading_point.interaction.normal)
        * direction.dot(shading_point.interaction.normal)
        > 0.0;
    if leads_inside {
        reflect(direction, shading_point.interaction.normal)
    } else {
        mirror
    }
}

/// The part of kt that a surface reflects: Fresnel's equations in Schlick's approximation ("An
/// inexpensive BRDF model for physically-based rendering", 1994, equation 15), by the angle of the
/// ray on its side of the surface. A surface of index 1 reflects nothing.
fn reflected_part(direction: Vec3, shading_point: &ShadingPoint<'_>) -> f64 {
    let PhongMaterial { eta, fresnel, .. } = shading_point.material;
    let along_normal = normal_reflectance(eta.get());
    if !fresnel || along_normal == 0.0 {
        return 0.0;
    }
    let cosine = direction.dot(shading_point.normal).abs();
    along_normal + (1.0 - along_normal) * schlick(cosine)
}

/// The refracted direction, if the material transmits light and there is no total reflection.
///
/// The geometric normal decides where the shading normal cannot: where the shading normal faces
/// away from the ray, or where its total reflection points into the surface. With `sided` it also
/// does where the shading normal would keep transmitted light on this side of the surface. So an
/// eta of 1 bends no ray, whatever the shading normal.
fn transmit(direction: Vec3, shading_point: &ShadingPoint<'_>, sided: bool) -> Option<Vec3> {
    let PhongMaterial { kt, eta, .. } = shading_point.material;
    if kt.get() == 0.0 {
        return None;
    }
    let enters = direction.dot(shading_point.interaction.normal) <= 0.0;
    let (from, to) = if enters {
        (1.0, eta.get())
    } else {
        (eta.get(), 1.0)
    };
    let (shading, geometric) = (shading_point.normal, shading_point.geometric());
    if direction.dot(shading) < 0.0 {
        match refract(direction, shading, from, to) {
            Some(refracted) if !sided || refracted.dot(geometric) < 0.0 => return Some(refracted),
            None if reflect(direction, shading).dot(geometric) > 0.0 => return None,
            Some(_) | None => {}
        }
    }
    refract(direction, geometric, from, to)
}
