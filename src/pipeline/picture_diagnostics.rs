//! Diagnostics about a rendered picture: an empty picture, imprecise arithmetic, values that the
//! file can't hold, a failed verification.

use super::ValidatedScene;
use rtc_diag::{Diagnostic, Severity, codes};
use rtc_image::{FileFormat, RangeClipping};
use rtc_ir::{EntityField, EntityKind, ValuePath};
use rtc_plan::{self as plan, PrecisionArtifact, Rule};
use rtc_render::PlanMismatch;
use rtc_source::Span;

/// A note that the picture is empty.
pub(super) fn nothing_in_view(camera: Option<Span>) -> Diagnostic {
    Diagnostic::new(&codes::NOTHING_IN_VIEW, "no ray of the camera hit anything")
        .at(camera, "this camera sees only the background")
        .hint("check where the camera stands and looks, and where the objects are")
}

/// A warning that all surfaces in view are black, though the scene has light.
pub(super) fn dark(light: Option<Span>) -> Diagnostic {
    let message = "all surfaces in view are black: no light was found to reach them";
    Diagnostic::new(&codes::DARK, message)
        .at(light, "this light shines elsewhere")
        .hint("the `direction` of a sun points to it; see where lamps are, and how strong")
}

/// A warning that a picture ended above its target error, in grey levels; `error` is its bound, if
/// it has one.
pub(super) fn above_target(target: f64, error: Option<f64>) -> Diagnostic {
    let message = match error {
        Some(error) => format!(
            "the error of the picture is at most {:.2} grey levels, and was to be {target}",
            // Rounded up, so that the text promises no more than the bound.
            (100.0 * error).ceil() / 100.0
        ),
        None => format!("the error of the picture is not bounded, and was to be {target}"),
    };
    let hint = match error {
        Some(_) => "few pixels have most of the noise, or `--limit rays` ended the picture",
        None => "light that no sample has hit may be there; larger lights are hit sooner",
    };
    Diagnostic::new(&codes::UNMET, message).hint(hint)
}

/// A note that the picture was exposed automatically, by this many stops.
pub(super) fn exposed(stops: f64) -> Diagnostic {
    let message =
        format!("the picture is exposed by {stops:+.2} stops, to show what its lights light");
    let hint = format!(
        "`--exposure {stops:.4}` sets the same, `--exposure 0` leaves the values unchanged"
    );
    Diagnostic::new(&codes::EXPOSED, message).hint(hint)
}

/// A note that the requested aspect ratio differs from that of the camera of an asset, so that more
/// is visible at two sides.
pub(super) fn fitted(before: [u32; 2], requested: [u32; 2]) -> Option<Diagnostic> {
    /// The relative difference below which aspect ratios count as equal, for example after
    /// rounding.
    const SAME: f64 = 0.01;
    let aspect = |[width, height]: [u32; 2]| f64::from(width) / f64::from(height);
    let ratio = aspect(requested) / aspect(before);
    if (ratio - 1.0).abs() < SAME {
        return None;
    }
    let sides = if ratio > 1.0 {
        "left and right"
    } else {
        "above and below"
    };
    let message = format!("the camera sees another shape; more is shown {sides}");
    let [width, height] = before;
    let hint = format!("its own picture is {width}×{height}, or any size of that shape");
    Some(Diagnostic::new(&codes::FITTED, message).hint(hint))
}

/// A note that the studio adds light to the scene.
pub(super) fn filled(seen: f64) -> Diagnostic {
    let message = format!(
        "the scene's own lights illuminate {:.0} % of the visible surfaces, so the dimmed studio \
        is added",
        100.0 * seen
    );
    Diagnostic::new(&codes::FILLED, message).hint(
        "`--studio off` shows its own light alone, `--studio dark` puts it into the studio \
        undimmed",
    )
}

/// A note that lamps are placed in a closed room; without any, a warning that it is dark.
pub(super) fn closed_room(lamps: usize) -> Diagnostic {
    let room = "the camera sees through the walls of a closed room, and no light gets in";
    let (message, severity, hint) = match lamps {
        0 => (
            format!("{room}: it is dark"),
            Severity::Warning,
            "put a light into the room; without `--studio off`, lamps are placed in it",
        ),
        1 => (
            format!("{room}: a lamp is placed in it"),
            Severity::Note,
            "`--studio off` leaves it dark; a light in the room replaces the lamp",
        ),
        _ => (
            format!("{room}: {lamps} lamps are placed in it"),
            Severity::Note,
            "`--studio off` leaves it dark; lights in the room replace the lamps",
        ),
    };
    let diagnostic = Diagnostic::new(&codes::CLOSED_ROOM, message);
    diagnostic.severity(severity).hint(hint)
}

/// A warning about the errors of the chosen arithmetic; `None` for the robust one.
pub(super) fn imprecise(
    validated: &ValidatedScene,
    arithmetic: plan::Arithmetic,
) -> Option<Diagnostic> {
    // Estimate the loss and describe its symptom.
    let loss = plan::loss(&validated.scene, arithmetic)?;
    let option = arithmetic.name();
    let (problem, label) = match loss.symptom {
        PrecisionArtifact::SelfHit => {
            let off = format!(
                "rays start about {:.0e} off this surface and hit it again",
                loss.error
            );
            ("surfaces shade or mirror themselves", off)
        }
        PrecisionArtifact::Shape => (
            "curved surfaces lose their shape",
            format!("points are about {:.0e} off", loss.error),
        ),
        PrecisionArtifact::Skipped => (
            "rays miss near surfaces",
            "hardly larger than the 1e-5 that rays skip".to_owned(),
        ),
    };
    // Point to the surface with the largest loss.
    let surface = validated.scene.surfaces()[loss.surface].index;
    let span = validated.lowered.source_spans.span(ValuePath::new(
        EntityKind::Surface,
        surface,
        EntityField::Whole,
    ));
    let diagnostic = Diagnostic::new(
        &codes::IMPRECISE,
        format!("in {option} this picture will be wrong: {problem}"),
    );
    let others = match loss.surfaces - 1 {
        0 => String::new(),
        others => format!("; {others} more such surfaces"),
    };
    Some(
        diagnostic
            .at(span, format!("{label}{others}"))
            .hint(format!("leave out `--arithmetic {option}`")),
    )
}

/// Warnings about values that the file can't hold.
pub(super) fn out_of_range(
    RangeClipping { unnumbered, beyond }: &RangeClipping,
    form: FileFormat,
    arithmetic: plan::Arithmetic,
) -> Vec<Diagnostic> {
    // Report values beyond the range of the file format.
    let names = beyond
        .iter()
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>()
        .join(", ");
    let beyond = (!beyond.is_empty()).then(|| {
        let diagnostic = Diagnostic::new(
            &codes::BEYOND_FLOAT,
            format!("values beyond the range of the file in {names}"),
        );
        diagnostic.hint(if form == FileFormat::ExrHalf {
            "the file has its largest number there, 65504 in 16 bits; leave out `--bits 16`"
        } else {
            "the file has 3.4e38 there; a smaller scene makes the same picture"
        })
    });
    // Report pixels that are NaN.
    let unnumbered = (*unnumbered > 0).then(|| {
        let diagnostic = Diagnostic::new(
            &codes::UNNUMBERED,
            format!("pixels that are no number: {unnumbered}"),
        );
        let advice = match arithmetic {
            plan::Arithmetic::Robust => "colours or coefficients are too large".to_owned(),
            coarse @ (plan::Arithmetic::Plain | plan::Arithmetic::F32) => {
                format!("leave out `--arithmetic {}`", coarse.name())
            }
        };
        diagnostic.hint(format!("they are black in the file; {advice}"))
    });
    beyond.into_iter().chain(unnumbered).collect()
}

/// The message of a failed verification.
pub(super) fn verification_failure(mismatch: &PlanMismatch) -> String {
    let PlanMismatch {
        pixel: [x, y],
        effect,
        rule,
        what,
    } = mismatch;
    let effect = effect.map_or(String::new(), |effect| format!("{}, ", effect.name()));
    let rule = rule.map_or("the choice of features", Rule::name);
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "internal error: {effect}left out by {rule}: {what} at pixel {x}, {y}\n\
         This is a fault of rtc {version}, please report it with the scene."
    )
}
