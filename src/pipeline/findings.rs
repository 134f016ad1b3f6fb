//! What is found in a picture: nothing, numbers that give way, values that no file holds, a rule that
//! was wrong.

use super::Proven;
use rtc_diag::{Diagnostic, codes};
use rtc_image::{FileFormat, RangeClipping};
use rtc_ir::{EntityKind, Field, ValuePath};
use rtc_plan::{self as plan, Rule, Symptom};
use rtc_render::Mismatch;
use rtc_source::Span;

/// Remarks that the picture is empty.
pub(super) fn nothing_in_view(camera: Option<Span>) -> Diagnostic {
    Diagnostic::new(&codes::NOTHING_IN_VIEW, "no ray of the camera hit anything")
        .at(camera, "this camera sees only the background")
        .hint("check where the camera stands and looks, and where the objects are")
}

/// Remarks that a picture is shown brighter or darker than its values, in stops.
pub(super) fn exposed(stops: f64) -> Diagnostic {
    let message =
        format!("the picture is exposed by {stops:+.2} stops, to show what its lights light");
    let hint = format!(
        "`--exposure {stops:.4}` says the same, `--exposure 0` shows the values as they are"
    );
    Diagnostic::new(&codes::EXPOSED, message).hint(hint)
}

/// Says that the camera of an asset sees a picture of another shape than the one asked for, so that
/// more is shown at two sides.
pub(super) fn fitted(own: [u32; 2], asked: [u32; 2]) -> Option<Diagnostic> {
    /// Shapes that differ by less, as by a rounded pixel, are the same.
    const SAME: f64 = 0.01;
    let aspect = |[width, height]: [u32; 2]| f64::from(width) / f64::from(height);
    let ratio = aspect(asked) / aspect(own);
    if (ratio - 1.0).abs() < SAME {
        return None;
    }
    let sides = if ratio > 1.0 {
        "left and right"
    } else {
        "above and below"
    };
    let message = format!("the camera of the asset sees another shape; more is shown {sides}");
    let [width, height] = own;
    let hint = format!("its own picture is {width}×{height}, or any size of that shape");
    Some(Diagnostic::new(&codes::FITTED, message).hint(hint))
}

/// Says that the studio fills in beside the light of a scene.
pub(super) fn filled(seen: f64) -> Diagnostic {
    let message = format!(
        "the scene's own light shows {:.0} % of what is in the picture, so the dimmed studio fills in",
        100.0 * seen
    );
    Diagnostic::new(&codes::FILLED, message).hint(
        "`--studio off` shows its own light alone, `--studio on` puts it into the studio undimmed",
    )
}

/// Warns of what the arithmetic chosen loses; none of the robust one.
pub(super) fn imprecise(proven: &Proven, arithmetic: plan::Arithmetic) -> Option<Diagnostic> {
    let loss = plan::loss(&proven.scene, arithmetic)?;
    let option = arithmetic.name();
    let (fault, label) = match loss.symptom {
        Symptom::SelfHit => {
            let off = format!(
                "rays start about {:.0e} off this surface and meet it again",
                loss.error
            );
            ("surfaces shade or mirror themselves", off)
        }
        Symptom::Shape => (
            "curved surfaces lose their shape",
            format!("points are about {:.0e} off", loss.error),
        ),
        Symptom::Skipped => (
            "rays pass by what is near",
            "hardly larger than the 1e-5 that rays skip".to_owned(),
        ),
    };
    let surface = proven.scene.surfaces()[loss.surface].index;
    let span = proven.lowered.source_spans.span(ValuePath::new(
        EntityKind::Surface,
        surface,
        Field::Whole,
    ));
    let finding = Diagnostic::new(
        &codes::IMPRECISE,
        format!("in {option} this picture will be wrong: {fault}"),
    );
    let others = match loss.surfaces - 1 {
        0 => String::new(),
        others => format!("; {others} more such surfaces"),
    };
    Some(
        finding
            .at(span, format!("{label}{others}"))
            .hint(format!("leave out `--arithmetic {option}`")),
    )
}

/// Warns of what the file can't hold.
pub(super) fn unholdable(
    RangeClipping { unnumbered, beyond }: &RangeClipping,
    form: FileFormat,
    arithmetic: plan::Arithmetic,
) -> Vec<Diagnostic> {
    let names = beyond
        .iter()
        .map(|name| format!("`{name}`"))
        .collect::<Vec<_>>()
        .join(", ");
    let beyond = (!beyond.is_empty()).then(|| {
        let finding = Diagnostic::new(
            &codes::BEYOND_FLOAT,
            format!("values beyond what the file holds in {names}"),
        );
        finding.hint(if form == FileFormat::ExrHalf {
            "the file has its largest number there, 65504 in 16 bits; leave out `--bits 16`"
        } else {
            "the file has 3.4e38 there; a smaller scene makes the same picture"
        })
    });
    let unnumbered = (*unnumbered > 0).then(|| {
        let finding = Diagnostic::new(
            &codes::UNNUMBERED,
            format!("pixels that are no number: {unnumbered}"),
        );
        let advice = match arithmetic {
            plan::Arithmetic::Robust => "colours or coefficients are too large".to_owned(),
            coarse @ (plan::Arithmetic::Plain | plan::Arithmetic::F32) => {
                format!("leave out `--arithmetic {}`", coarse.name())
            }
        };
        finding.hint(format!("they are black in the file; {advice}"))
    });
    beyond.into_iter().chain(unnumbered).collect()
}

/// What to say of a rule that was wrong.
pub(super) fn left_out(mismatch: &Mismatch) -> String {
    let Mismatch {
        pixel: [x, y],
        effect,
        rule,
        what,
    } = mismatch;
    let rule = rule.map_or("no rule", Rule::name);
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "internal error: {}, left out by {rule}: {what} at pixel {x}, {y}\n\
         This is a fault of rtc {version}, please report it with the scene.",
        effect.name()
    )
}
