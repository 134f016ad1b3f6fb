//! Helpers for exporting to other renderers.

use super::reporter::ExportReporter;
use rtc_diag::{clip, codes};
use rtc_ir::{
    EntityField, EntityKind, Environment, Image, Material, Punctual, PunctualKind, Scene, Shape,
    ShapeKind, Standard, Surface, ValuePath,
};
use rtc_math::{Vec3, shortest};
use rtc_source::{Budget, Resource};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// A scene for another renderer.
#[derive(Debug)]
pub struct ExportedScene {
    /// The text of the scene file.
    pub text: String,
    /// The sidecar files, by their paths relative to the scene file, with `/`.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// The message for a light that would project a texture.
pub(super) const NOT_PROJECTED: &str =
    "the texture that the light projects is left out: it shines as without it";

impl ExportReporter<'_> {
    /// Reports a feature that the other renderer does not support exactly.
    pub(super) fn unsupported(&mut self, message: &str, path: ValuePath) {
        self.report(&codes::NO_TWIN, message, path);
    }

    /// Reports settings that other programs lack.
    pub(super) fn own_settings(&mut self, scene: &Scene) {
        let settings = &scene.settings;
        let mut left_out = |is_set, field, message| {
            if is_set {
                let path = ValuePath::new(EntityKind::Settings, 0, field);
                self.unsupported(message, path);
            }
        };
        let background = "the background is left out: mirrors would show it";
        left_out(
            settings.background.is_some(),
            EntityField::Background,
            background,
        );
        left_out(
            settings.stereo > 0.0,
            EntityField::Stereo,
            "the camera is written with one eye",
        );
        let is_moving = |surface: &Surface| surface.velocity.get() != [0.0; 3];
        if let Some(index) = scene.surfaces.iter().position(is_moving) {
            let path = ValuePath::new(EntityKind::Surface, index, EntityField::Velocity);
            self.unsupported(
                "motion is left out: surfaces are where they are at the time 0",
                path,
            );
        }
    }

    /// Reports an error if nothing that is written emits light.
    pub(super) fn shines(&mut self, shines: bool) -> Option<()> {
        if !shines {
            let message = "nothing in the file would emit light: its picture would be black";
            let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Whole);
            self.report_error(&codes::NO_TWIN, message, path);
        }
        shines.then_some(())
    }

    /// Reports a light that another renderer has without its range, its IES profile or the texture
    /// that it projects.
    pub(super) fn simplified_light(&mut self, light: &Punctual, renderer: &str, path: ValuePath) {
        let Punctual {
            emitter, projected, ..
        } = light;
        if projected.is_some() {
            self.unsupported(NOT_PROJECTED, path);
        }
        if emitter.range().is_some() {
            let message =
                format!("{renderer}'s lights have no range: this one shines beyond its own");
            self.unsupported(&message, path);
        }
        if let PunctualKind::Photometric { photometry, .. } = emitter {
            let message = format!(
                "the IES light `{}` is written as a uniform point light",
                clip(&photometry.name)
            );
            self.unsupported(&message, path);
        }
    }

    /// Charges the bytes of a mesh file or of a picture; `None` if they exceed the budget, which is
    /// reported.
    pub(super) fn charge(&mut self, bytes: u64, budget: &Budget, path: ValuePath) -> Option<()> {
        let charged = budget.charge(Resource::Memory, bytes);
        charged
            .map_err(|error| {
                let message = format!("its file needs too much memory: {error}");
                self.report_error(&codes::OVER_LIMIT, &message, path);
            })
            .ok()
    }
}

/// The mean over all directions of what a light emits, as a factor of its intensity.
pub(super) fn mean_over_directions(emitter: &PunctualKind) -> f64 {
    let solid_angle = emitter.profile().map_or(0.0, |all| all.solid_angle());
    solid_angle / (4.0 * PI)
}

/// The environment of a scene for another renderer.
pub(super) struct ExportedEnvironment<'s> {
    /// The radiance, or the factor of the map.
    pub(super) radiance: [f64; 3],
    /// The map of longitude and latitude, whose middle is −z, with its axes in the world.
    pub(super) map: Option<(&'s Image, [Vec3; 3])>,
    pub(super) path: ValuePath,
}

/// The environment of a scene, if it has one.
pub(super) fn environment(scene: &Scene) -> Option<ExportedEnvironment<'_>> {
    let Environment {
        radiance,
        image,
        image_from_world,
    } = scene.environment.as_ref()?;
    let image = image.map(|image| &scene.images[image.0 as usize]);
    // The rows of the rotation are the columns of its inverse.
    let rows = image_from_world.map(|rows| rows.map(Vec3::from_array));
    let axes = rows.unwrap_or([Vec3::X, Vec3::Y, Vec3::Z]);
    Some(ExportedEnvironment {
        radiance: *radiance,
        map: image.map(|image| (image, axes)),
        path: ValuePath::new(EntityKind::Environment, 0, EntityField::Whole),
    })
}

/// The materials that surfaces use, with their indices and paths.
pub(super) fn used_materials(scene: &Scene) -> impl Iterator<Item = (usize, &Material, ValuePath)> {
    let used_materials = scene
        .surfaces
        .iter()
        .map(|surface| surface.material.0 as usize);
    let used_materials: BTreeSet<_> = used_materials.collect();
    let path = |index| ValuePath::new(EntityKind::Material, index, EntityField::Whole);
    let material = move |index| Some((index, scene.materials.get(index)?, path(index)));
    used_materials.into_iter().filter_map(material)
}

/// The number of surfaces from the first on that are parts of one CSG solid; 1 for another shape.
pub(super) fn parts_of_one(surfaces: &[Surface]) -> usize {
    let Some(Shape::Csg(first)) = surfaces.first().map(|surface| &surface.shape) else {
        return 1;
    };
    let mut faces = BTreeSet::new();
    let mut is_part = |surface: &&Surface| {
        let Shape::Csg(csg) = &surface.shape else {
            return false;
        };
        csg.is_of_one_solid(first) && csg.faces.iter().all(|face| faces.insert(*face))
    };
    let count = surfaces
        .iter()
        .take_while(|surface| is_part(surface))
        .count();
    count.max(1)
}

/// The surface among the parts of a CSG solid that shows an operand.
pub(super) fn part_of(parts: &[Surface], operand: usize) -> Option<&Surface> {
    let shows = |face: &u32| usize::try_from(*face) == Ok(operand);
    parts
        .iter()
        .find(|part| matches!(&part.shape, Shape::Csg(csg) if csg.faces.iter().any(shows)))
}

/// The width of the distribution of microfacets of a roughness, its square: the shortest decimal
/// whose root is the roughness again.
pub(super) fn facet_width(roughness: f64) -> f64 {
    shortest_preimage(roughness * roughness, roughness, f64::sqrt)
}

/// The widths across and along the direction of the anisotropy a, α and α + (1 − α)·a²
/// (`KHR_materials_anisotropy`), which read back as they are.
pub(super) fn facet_widths(material: &Standard) -> [f64; 2] {
    let across = facet_width(material.roughness);
    let anisotropy = material.anisotropy;
    if anisotropy == 0.0 || across >= 1.0 {
        return [across; 2];
    }
    let along = across + (1.0 - across) * anisotropy * anisotropy;
    let strength = |along: f64| ((along - across) / (1.0 - across)).sqrt();
    [across, shortest_preimage(along, anisotropy, strength)]
}

/// The decimal of the fewest digits near a number that a function maps to a value, but for
/// rounding; the number itself if there is none.
fn shortest_preimage(number: f64, value: f64, function: impl Fn(f64) -> f64) -> f64 {
    let rounded = |digits: usize| format!("{number:.digits$e}").parse::<f64>().ok();
    let mut rounded = (0..17).filter_map(rounded);
    let tolerance = 4.0 * f64::EPSILON * value.abs();
    let found = rounded.find(|rounded| (function(*rounded) - value).abs() <= tolerance);
    found.unwrap_or(number)
}

/// The shortest decimals of numbers that read back exactly, with a separator; −0 as 0.
pub(super) fn joined(numbers: impl IntoIterator<Item = f64>, separator: &str) -> String {
    let displayed: Vec<_> = numbers
        .into_iter()
        .map(|number| shortest(number + 0.0))
        .collect();
    displayed.join(separator)
}

/// The name of an unsupported shape: of quadrilaterals only bilinear patches are unsupported.
pub(super) fn shape_name(shape: &Shape) -> &'static str {
    if shape.kind() == ShapeKind::Quad {
        return "bilinear patch";
    }
    if shape.kind() == ShapeKind::Csg {
        return "union, intersection or difference";
    }
    shape.kind().name()
}

/// A material in a message: by its name, if it has one.
pub(super) fn called(name: &str) -> String {
    match name {
        "" => "a material".to_owned(),
        name => format!("the material `{}`", clip(name)),
    }
}

/// Phrases as an enumeration.
pub(super) fn enumeration(parts: &[&str]) -> String {
    match parts {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_width_is_the_decimal_that_was_read() {
        for thousandths in 1..1000_u32 {
            let width = f64::from(thousandths) / 1000.0;
            assert_eq!(facet_width(width.sqrt()).to_bits(), width.to_bits());
            let along = (width + 1.0) / 2.0;
            let material = Standard {
                roughness: width.sqrt(),
                anisotropy: ((along - width) / (1.0 - width)).sqrt(),
                ..Standard::default()
            };
            assert_eq!(facet_widths(&material)[0].to_bits(), width.to_bits());
            assert!((facet_widths(&material)[1] - along).abs() < 1e-15);
        }
        assert_eq!([0.0, 1.0].map(facet_width), [0.0, 1.0]);
    }
}
