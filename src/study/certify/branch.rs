//! The ray tree of a camera ray: mirrored, glossy and refracted rays.

use super::number::CertifiedNumber;
use super::reason::Doubts;
use super::sampling::{CertifiedKey, spiral_turns};
use super::shade::{CertifiedPoint, CertifiedScene, frame};
use super::shape::CertifiedRay;
use rtc_ir::Phong;
use rtc_math::Vector;

/// A ray to follow.
pub(super) struct CertifiedBranch<N> {
    pub(super) ray: CertifiedRay<N>,
    /// The weight of its light.
    pub(super) beta: N,
    pub(super) bounces_left: u32,
    pub(super) key: CertifiedKey,
}

/// The numbers of the branches in a key.
const MIRRORED: u64 = 0;
const REFRACTED: u64 = 1;

impl<N: CertifiedNumber> CertifiedScene<'_, N> {
    /// Adds the reflected and the refracted rays to the pending ones.
    pub(super) fn branch(
        &self,
        branch: &CertifiedBranch<N>,
        point: &CertifiedPoint<'_, N>,
        pending: &mut Vec<CertifiedBranch<N>>,
    ) -> Result<(), Doubts> {
        let kt = N::point(point.material.kt);
        let is_dark = point.ks.is_zero() && point.material.kr.is_none() && kt.is_zero();
        if branch.bounces_left == 0 || is_dark {
            return Ok(());
        }
        let direction = -point.to_viewer;
        let refracted = transmit(direction, point)?;
        let reflected_part = match refracted {
            Some(_) => reflected_part(direction, point),
            None => N::ONE,
        };
        let mut push = |direction: Vector<N>, weight: N, key: CertifiedKey| {
            let beta = branch.beta * weight;
            if !beta.is_zero() {
                pending.push(CertifiedBranch {
                    ray: point.ray(direction),
                    beta,
                    bounces_left: branch.bounces_left - 1,
                    key,
                });
            }
        };
        // Push the mirrored ray, or those of a glossy lobe.
        let kr = point.material.kr.map_or(point.ks, N::point);
        let weight = kr + kt * reflected_part;
        if !weight.is_zero() {
            let (mirror, key) = (mirrored(direction, point)?, branch.key.child(MIRRORED));
            if point.material.glossy_samples > 1 {
                let rays = self.lobe(point, mirror)?;
                let share = weight / N::point(rays.len() as f64);
                for (k, direction) in rays {
                    push(direction, share, key.child(k.into()));
                }
            } else {
                push(mirror, weight, key);
            }
        }
        if let Some(refracted) = refracted {
            let weight = kt * (N::ONE - reflected_part);
            push(refracted, weight, branch.key.child(REFRACTED));
        }
        Ok(())
    }

    /// The directions of the lobe about a mirror direction that lie above the surface, each with
    /// its number.
    fn lobe(
        &self,
        point: &CertifiedPoint<'_, N>,
        mirror: Vector<N>,
    ) -> Result<Vec<(u32, Vector<N>)>, Doubts> {
        let [across, upward] = frame(mirror).ok_or(Doubts::SEAM)?;
        let Phong {
            n, glossy_samples, ..
        } = *point.material;
        let (shift, rotation) = (point.key.uniform(0), point.key.bits(1));
        let exponent = N::ONE / (N::point(n) + N::ONE);
        let geometric = match self.scene.settings.shadows {
            true => point.geometric,
            false => point.normal,
        };
        let mut rays = Vec::new();
        for k in 0..glossy_samples {
            let place = N::point(f64::from(k)) + N::point(shift);
            let fraction = place / N::point(f64::from(glossy_samples));
            let cosine = fraction.power(exponent).clamp(0.0, 1.0);
            let sine = ((N::ONE - cosine) * (N::ONE + cosine)).sqrt();
            let [x, y] = N::cos_sin(spiral_turns(k, rotation));
            let direction = across * (sine * x) + upward * (sine * y) + mirror * cosine;
            let slopes = [point.normal, geometric].map(|normal| direction.dot(normal));
            if slopes.into_iter().all(N::is_positive) {
                rays.push((k, direction));
            } else if !slopes.into_iter().any(N::is_negative) {
                return Err(Doubts::SILHOUETTE);
            }
        }
        Ok(rays)
    }
}

/// d − 2·(d·n)·n with the shading normal, or with the geometric one where the former leads into the
/// surface.
fn mirrored<N: CertifiedNumber>(
    direction: Vector<N>,
    point: &CertifiedPoint<'_, N>,
) -> Result<Vector<N>, Doubts> {
    let two = N::point(2.0);
    let about = |normal: Vector<N>| direction - normal * (two * direction.dot(normal));
    let mirror = about(point.normal);
    if !point.has_shading_normal {
        return Ok(mirror);
    }
    // The direction leads into the geometric normal of this side.
    let slope = mirror.dot(point.geometric);
    if slope.is_positive() {
        Ok(mirror)
    } else if slope.is_negative() {
        Ok(about(point.geometric))
    } else {
        Err(Doubts::SILHOUETTE)
    }
}

/// Snell's law: the unit direction beyond the surface; `None` for a surface that transmits nothing,
/// or for total reflection.
fn transmit<N: CertifiedNumber>(
    direction: Vector<N>,
    point: &CertifiedPoint<'_, N>,
) -> Result<Option<Vector<N>>, Doubts> {
    let Phong { kt, ior, .. } = *point.material;
    if kt == 0.0 {
        return Ok(None);
    }
    if point.has_shading_normal {
        return Err(Doubts::unsupported("refraction by vertex normals"));
    }
    let ior = N::point(ior);
    let (from, to) = if point.is_front {
        (N::ONE, ior)
    } else {
        (ior, N::ONE)
    };
    let sine = from * direction.cross(point.normal).length();
    let square = (to - sine) * (to + sine);
    if square.is_negative() {
        return Ok(None);
    }
    if !square.is_positive() {
        return Err(Doubts::CRITICAL_ANGLE);
    }
    let along = direction - point.normal * direction.dot(point.normal);
    // The length of the sum is the index beyond.
    let refracted = along * from - point.normal * square.sqrt();
    Ok(Some(refracted / to))
}

/// The part of kt that is reflected: Schlick's approximation of Fresnel's equations, by the angle
/// on the side of the ray.
fn reflected_part<N: CertifiedNumber>(direction: Vector<N>, point: &CertifiedPoint<'_, N>) -> N {
    let Phong { ior, fresnel, .. } = *point.material;
    if !fresnel || ior == 1.0 {
        return N::ZERO;
    }
    let (ior, one) = (N::point(ior), N::ONE);
    let along_normal = ((ior - one) / (ior + one)).square();
    // The normal faces the ray.
    let cosine = -direction.dot(point.normal);
    let x = (one - cosine).clamp(0.0, 1.0);
    along_normal + (one - along_normal) * x.square().square() * x
}
