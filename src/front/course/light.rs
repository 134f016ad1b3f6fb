//! The lights: points and spheres, suns, spots, and photometric lights.

use super::area_light::AreaLightCells;
use super::assets::AssetTarget;
use super::decode::{DecodeContext, Spanned};
use super::keyword::{Keyword, KeywordTable};
use super::lower::Lowering;
use super::number::{HalfAngle, NonNegative, Positive};
use super::record::{FieldResult, record};
use super::synonym::{POSITION, with_canonical};
use super::value::{Channels, Color, FileName, Point, Vector};
use rtc_diag::{Severity, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, Photometry};
use rtc_source::Span;

record! {
    /// A point or sphere that emits equally in all directions, without falloff; an area light, a
    /// rectangle of such points; a directional light (sun); or a light with inverse-square falloff:
    /// a point or a spot with an `intensity`, or a light with a measured profile. A scene with any
    /// but the first two is rendered by path tracing.
    struct Light, "light" {
        /// The type of the light.
        kind: Spanned<LightKind>, optional, &[&["type"]], own true;
        /// The position of the light.
        position: Spanned<Point>, optional, &with_canonical(POSITION, "position"), json "position";
        /// The colour: red, green, blue; values above 1 are allowed. With a `file`, a factor of its
        /// candelas.
        color: Spanned<Color>, optional, &[&["color"], &["colour"]], json "color";
        /// The radius of the emitting sphere; 0 is a point. A larger radius makes soft shadows.
        radius: Spanned<NonNegative>, default(NonNegative(0.0)),
            &[&["radius"], &["size"]], own true;
        /// The width of an area light, horizontal and perpendicular to its `direction`.
        width: Spanned<Positive>, optional, &[&["width"]], own true;
        /// The height of an area light, perpendicular to its width and its `direction`.
        height: Spanned<Positive>, optional, &[&["height"]], own true;
        /// The number of points of an area light along its width and its height, one number for
        /// both or a list of two, each with an equal part of the colour: more points make softer
        /// shadows.
        cells: Spanned<AreaLightCells>, default(AreaLightCells([4; 2])), &[&["cells"]], own true;
        /// The direction from the scene to a sun; the direction in which a spot points, or that an
        /// area light faces, which is down by default; with a `file`, the direction of vertical
        /// angle 0.
        direction: Spanned<Vector>, optional, &[&["direction"]], own true;
        /// The irradiance on a surface that faces the sun: red, green, blue, or one number for all.
        /// A white diffuse surface then has the radiance irradiance/π.
        irradiance: Spanned<Channels>, optional, &[&["irradiance"]], own true;
        /// The radiant intensity of a point or a spot, power per steradian: red, green, blue, or
        /// one number for all. Beside a `color` it is a factor of that: a point then keeps its
        /// colour at any distance.
        intensity: Spanned<Channels>, optional, &[&["intensity"]], own true;
        /// The distance at which a point or a spot with an `intensity` fades to 0, by the falloff
        /// of `KHR_lights_punctual`; unlimited by default.
        range: Spanned<Positive>, optional, &[&["range"]], own true;
        /// The angle from the direction of a spot, in radians, up to which it has its full
        /// intensity.
        inner_angle: Spanned<NonNegative>, default(NonNegative(0.0)), &[&["innerAngle"]], own true;
        /// The angle from the direction of a spot, in radians, from which on it is dark: more than
        /// `innerAngle`, at most π/2.
        outer_angle: Spanned<HalfAngle>, optional, &[&["outerAngle"]], own true;
        /// The photometric profile: an IES file (LM-63) of type C with `TILT=NONE`.
        file: Spanned<FileName>, optional, &[&["file"]], own true;
        /// The direction of horizontal angle 0 of the profile; only its component perpendicular to
        /// `direction` is used.
        horizontal: Spanned<Vector>, default(Vector([1.0, 0.0, 0.0])), &[&["horizontal"]], own true;
    }
    variants {
        [position color] [position color width height] [position color width height direction]
        [direction irradiance] [position direction file]
        [position direction file color]
        [position intensity] [position direction intensity outer_angle]
        [position color intensity] [position direction color intensity outer_angle]
    }
}

/// The type of a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightKind {
    Point,
    Sun,
    Spot,
    Ies,
    Area,
}

impl Keyword for LightKind {
    const KEYWORDS: KeywordTable<Self> = &[
        (
            "point",
            LightKind::Point,
            "A point or a sphere, which shines in all directions.",
        ),
        (
            "sun",
            LightKind::Sun,
            "A directional light: parallel rays from far away.",
        ),
        (
            "spot",
            LightKind::Spot,
            "A point that shines within a cone.",
        ),
        (
            "ies",
            LightKind::Ies,
            "A lamp with a measured profile, an IES file.",
        ),
        (
            "area",
            LightKind::Area,
            "A rectangle of points, for soft shadows.",
        ),
    ];
}

impl Lowering {
    /// Lowers a light.
    pub(super) fn light(&mut self, light: &Spanned<Light>, context: &mut DecodeContext<'_>) {
        if self.area_light(light) {
            report_unused(&light.value, LightKind::Area, false, context);
            return;
        }
        let Some((light_ir, kind)) = self.light_from_keys(&light.value) else {
            return;
        };
        if light_ir.point().is_some() {
            report_factor(&light.value.intensity, context);
        }
        report_unused(&light.value, kind, light_ir.point().is_none(), context);
        let index = self.scene.lights.len();
        self.scene.lights.push(light_ir);
        self.record_span(EntityKind::Light, index, EntityField::Whole, light.span);
    }

    /// The light and its type, from the keys that are present.
    fn light_from_keys(&mut self, light: &Light) -> Option<(ir::Light, LightKind)> {
        let Light {
            position,
            color,
            direction,
            irradiance,
            file,
            intensity,
            ..
        } = light;
        // The keys that are present select the type.
        match (position, color, direction, irradiance, file, intensity) {
            (
                FieldResult::Read(position),
                color,
                FieldResult::Read(direction),
                _,
                FieldResult::Read(file),
                _,
            ) => self.photometric_light(light, [position.value.0, direction.value.0], color, file),
            (FieldResult::Read(_), FieldResult::Broken, .., FieldResult::Read(_)) => None,
            (FieldResult::Read(position), color, direction, .., FieldResult::Read(intensity))
                if color.is_absent()
                    || !(direction.is_absent() || light.outer_angle.is_absent()) =>
            {
                let (emitter, kind) = point_or_spot(light, position.value.0, direction)?;
                let is_plain = kind == LightKind::Point && light.range.is_absent();
                self.dependent.record_intensity(is_plain, intensity.span);
                let color = color.read().map_or([1.0; 3], |color| color.value.0);
                let light = ir::Punctual::new(emitter, scaled(color, intensity.value.0));
                Some((ir::Light::Punctual(light), kind))
            }
            (FieldResult::Read(position), FieldResult::Read(color), ..) => {
                let factor = intensity.read().map_or([1.0; 3], |factor| factor.value.0);
                let (index, radius) = (self.scene.lights.len(), &light.radius);
                self.record_span(
                    EntityKind::Light,
                    index,
                    EntityField::Position,
                    position.span,
                );
                self.record_span(EntityKind::Light, index, EntityField::Color, color.span);
                self.record_span(
                    EntityKind::Light,
                    index,
                    EntityField::LightRadius,
                    radius.span,
                );
                let color = scaled(color.value.0, factor);
                let (position, radius) = (position.value.0, radius.value.0);
                let point = ir::PointLight {
                    position,
                    color,
                    radius,
                };
                Some((ir::Light::Point(point), LightKind::Point))
            }
            (_, _, FieldResult::Read(direction), FieldResult::Read(irradiance), ..) => {
                let emitter = ir::PunctualKind::Sun {
                    direction: direction.value.0,
                };
                let sun = ir::Punctual::new(emitter, irradiance.value.0);
                Some((ir::Light::Punctual(sun), LightKind::Sun))
            }
            _ => None,
        }
    }

    /// A photometric light, dark until its profile is loaded.
    fn photometric_light(
        &mut self,
        light: &Light,
        [position, direction]: [[f64; 3]; 2],
        color: &FieldResult<Spanned<Color>>,
        file: &Spanned<FileName>,
    ) -> Option<(ir::Light, LightKind)> {
        let intensity = match color {
            FieldResult::Read(color) => color.value.0,
            FieldResult::Absent => [1.0; 3],
            FieldResult::Broken => return None,
        };
        self.files
            .add_pending(AssetTarget::Photometry(self.scene.lights.len()), file);
        let emitter = ir::PunctualKind::Photometric {
            position,
            direction,
            horizontal: light.horizontal.value.0,
            photometry: Box::new(Photometry::dark(file.value.0.replace('\\', "/"))),
        };
        let photometric_light = ir::Punctual::new(emitter, intensity);
        Some((ir::Light::Punctual(photometric_light), LightKind::Ies))
    }
}

/// A colour times a factor of each channel.
fn scaled(color: [f64; 3], factor: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|channel| color[channel] * factor[channel])
}

/// Reports an `intensity` beside a `color`.
fn report_factor(intensity: &FieldResult<Spanned<Channels>>, context: &mut DecodeContext<'_>) {
    let Some(span) = intensity.read().and_then(|intensity| intensity.span) else {
        return;
    };
    let message = || "the `intensity` of the light multiplies its `color`".to_owned();
    context.report(&codes::KEY_READ_DIFFERENTLY, span, message, |d| {
        d.at(span, "a factor, and no falloff with the distance")
            .hint("the product as `color`, which may be more than 1, says so everywhere")
    });
}

/// A point or a spot with an intensity.
fn point_or_spot(
    light: &Light,
    position: [f64; 3],
    direction: &FieldResult<Spanned<Vector>>,
) -> Option<(ir::PunctualKind, LightKind)> {
    let range = match light.range {
        FieldResult::Read(range) => Some(range.value.0),
        FieldResult::Absent => None,
        FieldResult::Broken => return None,
    };
    match (direction, light.outer_angle) {
        (FieldResult::Read(direction), FieldResult::Read(outer)) => {
            let spot = ir::PunctualKind::Spot {
                position,
                direction: direction.value.0,
                inner_angle: light.inner_angle.value.0,
                outer_angle: outer.value.0,
                range,
            };
            Some((spot, LightKind::Spot))
        }
        (_, FieldResult::Absent) => Some((
            ir::PunctualKind::Point { position, range },
            LightKind::Point,
        )),
        _ => None,
    }
}

/// Reports keys without effect on a light of this type.
fn report_unused(
    light: &Light,
    kind: LightKind,
    is_physical: bool,
    context: &mut DecodeContext<'_>,
) {
    // The keys of the light decide its kind, not its declared type.
    if let FieldResult::Read(declared) = light.kind
        && declared.value != kind
    {
        let message = "the `type` of the light has no effect: its other keys say otherwise";
        let hint = "a sun has `direction` and `irradiance`, a point `position` and `color` or \
                    `intensity`, a spot `direction` and `outerAngle` too, a profile `position`, \
                    `direction` and `file`, an area light `position`, `color`, `width` and \
                    `height`";
        no_effect(declared.span, message, hint, context);
    }
    // Report each key that has an effect on other kinds only.
    if kind != LightKind::Point || is_physical {
        let message =
            "the `radius` of the light has no effect: only a point with a `color` has one";
        no_effect(light.radius.span, message, "remove it", context);
    }
    if kind != LightKind::Area {
        let message = "`cells` has no effect on the light: only an area light has them";
        let hint = "an area light has a `position`, a `color`, a `width` and a `height`";
        no_effect(light.cells.span, message, hint, context);
    }
    if kind != LightKind::Ies {
        let message =
            "`horizontal` has no effect on the light: only a profile has horizontal angles";
        no_effect(light.horizontal.span, message, "remove it", context);
    }
    if kind != LightKind::Spot {
        let message = "`innerAngle` has no effect on the light: only a spot has angles";
        no_effect(light.inner_angle.span, message, "remove it", context);
    }
    let has_range = is_physical && matches!(kind, LightKind::Point | LightKind::Spot);
    if let (false, FieldResult::Read(range)) = (has_range, light.range) {
        let message = "`range` has no effect on the light: only a point or a spot with an \
                       `intensity` has one";
        no_effect(range.span, message, "remove it", context);
    }
}

/// Reports a key without effect, if it is present.
fn no_effect(span: Option<Span>, message: &str, hint: &str, context: &mut DecodeContext<'_>) {
    if let Some(span) = span {
        context.report(
            &codes::NO_EFFECT,
            span,
            || message.to_owned(),
            |d| d.at(span, "ignored").severity(Severity::Warning).hint(hint),
        );
    }
}
