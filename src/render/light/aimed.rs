//! How much a path can bring of an emitter that is aimed at. A camera ray or a mirror that finds it
//! by chance brings its whole radiance. Where neither can, paths find it from rough surfaces alone,
//! and by the balance heuristic no such sample brings more than next-event estimation does.

use super::shape::ShapeLight;
use super::{Light, LightId, Lights};
use crate::camera::{Camera, Projection, image_point};
use crate::integrator::path::SamplingStrategy;
use crate::material::standard::{BaseReflectance, StandardMaterial};
use crate::shape::emitter::Emitter;
use crate::shape::geometry::Intersect;
use crate::world::World;
use rtc_math::{Bounds, Vec3, cross};
use std::f64::consts::PI;

impl<S: Intersect> World<S> {
    /// The greatest value that a path finds by chance at a surface of this world that shines, in
    /// the strongest channel.
    pub(crate) fn brightest_surface(&self) -> f64 {
        let radiance = |id| self.standards[id].emission.factor.max_element();
        let all = self.surfaces.iter();
        let most = all
            .map(|surface| radiance(surface.material))
            .fold(0.0, f64::max);
        // Light of white or less needs no proof; moving surfaces have none.
        let is_still = self.moments.is_empty();
        let lobe = self.widest_peak().filter(|_| most > 1.0 && is_still);
        let Some(peak) = lobe else {
            return most;
        };
        let lights = Lights::new(self, SamplingStrategy::Mis);
        let found = self.surfaces.entries().map(|(index, surface)| {
            let light = lights.first_light_of_surface[index];
            let size = light.and_then(|light| lights.aimed_size(light));
            radiance(surface.material) * size.map_or(1.0, |size| (peak * size).min(1.0))
        });
        found.fold(0.0, f64::max)
    }

    /// A bound on f·cos θ of all surfaces; `None` if some may be nearly smooth.
    fn widest_peak(&self) -> Option<f64> {
        let mut peaks = self
            .surfaces
            .iter()
            .map(|surface| peak(&self.standards[surface.material]));
        peaks.try_fold(0.0, |most: f64, peak| Some(most.max(peak?)))
    }
}

/// A bound on f·cos θ of a material; `None` if it may be nearly smooth.
///
/// A diffuse lobe and the bounces between facets bring at most 1/π each. The facets bring
/// D·G₂·F/(4 cos θₒ), where D is at most 1/(π α²), and G₂/cos θₒ at most 2/α, that of G₁ at grazing
/// views (Heitz, "Understanding the masking-shadowing function", JCGT 3, 2014).
fn peak(material: &StandardMaterial) -> Option<f64> {
    /// Rougher lobes are wide.
    const MIN_ROUGHNESS: f64 = 0.4;
    let roughness = match &material.reflection {
        BaseReflectance::Metallic {
            roughness,
            map: None,
            ..
        } => *roughness,
        BaseReflectance::Metallic { .. } | BaseReflectance::Specular(_) => 0.0,
    };
    let is_plain = material.transmission.factor == 0.0
        && material.blend.is_none()
        && material.media.is_none()
        && material.plastic.is_none()
        && material.clearcoat.is_none()
        && material.sheen.is_none()
        && material.anisotropy.is_none()
        && roughness >= MIN_ROUGHNESS;
    let alpha = roughness * roughness;
    is_plain.then_some(2.0 / PI + 1.0 / (2.0 * PI * alpha * alpha * alpha))
}

impl<S: Intersect> Lights<'_, S> {
    /// The largest solid angle of a light as seen from any surface, over the probability that it is
    /// chosen; `None` if camera rays or rays from itself may hit it, or that is not known.
    fn aimed_size(&self, light: LightId) -> Option<f64> {
        let Light::Shape(shape) = &self.lights[light] else {
            return None;
        };
        // The faces of a solid may see each other.
        if shape.face.is_some() {
            return None;
        }
        let probability = self.probabilities[light];
        let distance = self.distance(shape)?;
        let filter = self.world.settings.filter.as_ref();
        let reach = filter.map_or(0.0, |filter| filter.reach());
        let is_aimed = probability > 0.0
            && distance > 0.0
            && is_out_of_view(&self.world.camera, reach, &shape.bounds?);
        // A sphere is aimed at by its cone, others by their area.
        let area = match shape.emitter {
            Emitter::Sphere { .. } => shape.emitter.area() / 4.0,
            // It sees itself, or a point of it has no distance.
            Emitter::Torus { .. } | Emitter::Patch(_) | Emitter::InfiniteCylinder { .. } => {
                return None;
            }
            Emitter::Frustum {
                height, is_capped, ..
            } if height > 0.0 && !is_capped => return None,
            Emitter::Ellipsoid { .. }
            | Emitter::Triangles(_)
            | Emitter::Frustum { .. }
            | Emitter::Paraboloid { .. } => shape.emitter.area(),
        };
        is_aimed.then(|| area / (distance * distance * probability))
    }

    /// The least distance of the box of a light from those of the other surfaces; `None` if one has
    /// no box.
    fn distance(&self, light: &ShapeLight) -> Option<f64> {
        let own = light.bounds?;
        let entries = self.world.surfaces.entries();
        let mut others = entries.filter(|(index, _)| *index != light.surface);
        others.try_fold(f64::INFINITY, |least, (_, surface)| {
            let bounds = surface.shape.bounds()?;
            let gap = (bounds.min - own.max).max(own.min - bounds.max);
            Some(least.min(gap.max(Vec3::ZERO).length()))
        })
    }
}

/// Whether no camera ray can hit a box: it is beyond one edge of the image, which the filter of the
/// pixels reaches beyond by so many pixels.
fn is_out_of_view(camera: &Camera, reach: f64, bounds: &Bounds) -> bool {
    let is_pinhole = camera.lens_radius == 0.0
        && camera.eyes.is_none()
        && camera.projection == Projection::Perspective;
    let [right, bottom] = camera.size.map(|side| side - 1);
    let corners = [
        ([0, 0], [-reach, -reach]),
        ([right, 0], [1.0 + reach, -reach]),
        ([right, bottom], [1.0 + reach, 1.0 + reach]),
        ([0, bottom], [-reach, 1.0 + reach]),
    ];
    let rays = corners.map(|(pixel, place)| image_point(camera, pixel, place) - camera.eye);
    let middle = camera.center - camera.eye;
    is_pinhole
        && (0..4).any(|k| {
            let normal = cross(rays[k], rays[(k + 1) % 4]);
            let inward = normal * normal.dot(middle).signum();
            let is_beyond = |corner: &Vec3| inward.dot(*corner - camera.eye) < 0.0;
            bounds.corners().iter().all(is_beyond)
        })
}
