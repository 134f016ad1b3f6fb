//! Where the page looks from: as flags of `rtc render`, and written into the scene, whose keys are
//! found by their spans. Nothing but their values is changed.

use crate::parse;
use rtc_ir::{Camera, EntityField, EntityKind, LoweredScene, ValuePath};
use rtc_math::{Vec3, cross, shortest, unit};
use rtc_passes::{SceneKind, StudioChoice, View, ViewAndLight};
use rtc_pipeline::{Input, Options};
use rtc_source::{SourceMap, Span};
use serde::Deserialize;
use serde_json::{Value, json};
use std::ops::Range;
use std::path::Path;

/// The tolerance of a written camera, relative to its distance.
const NEAR: f64 = 1e-9;

/// The same of the steps between its pixels, whose digits are fewer.
const NEAR_STEP: f64 = 2e-4;

/// The digits of a view's coordinates, relative to the distance to the centre: less than a
/// hundredth of a pixel is lost.
const PLACE_DIGITS: usize = 5;

/// The same of the upward direction.
const UP_DIGITS: usize = 4;

/// A requested view.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ViewOverride {
    eye: [f64; 3],
    center: [f64; 3],
    up: [f64; 3],
}

/// The camera of the scene as it was read, and the syntax for other views of it.
#[derive(Clone, Debug)]
pub(super) struct SceneCamera {
    eye: [f64; 3],
    center: [f64; 3],
    up: [f64; 3],
    /// The axis of the world that is nearest to `up`.
    axis: [f64; 3],
    /// The angle that the flags say, in degrees; none where the scene has keys.
    yfov: Option<String>,
    /// The flags that show the same, where the scene does not.
    pub(super) flags: Vec<(&'static str, String)>,
    can_write: bool,
}

impl ViewOverride {
    /// A view sent by the page; `None` for values that are not finite.
    pub(super) fn read(value: &Value) -> Option<Self> {
        let view_override = Self::deserialize(value).ok()?;
        let Self { eye, center, up } = view_override;
        let is_sound = |text: [f64; 3]| parse::vector(&comma(text)).is_ok();
        let is_any = up != [0.0; 3] && eye != center;
        let is_view = is_any && [eye, center, up].into_iter().all(is_sound);
        is_view
            .then(|| view_override.rounded())
            .filter(|view_override| view_override.eye != view_override.center)
    }

    /// The same view, by the digits that show.
    fn rounded(self) -> Self {
        let [eye, center, up] = [self.eye, self.center, self.up].map(Vec3::from_array);
        let distance = eye.distance(center);
        Self {
            eye: rounded(eye, distance, PLACE_DIGITS),
            center: rounded(center, distance, PLACE_DIGITS),
            up: rounded(up, up.length(), UP_DIGITS),
        }
    }

    /// The upward direction of this length: along an axis of the world, unless the view is rolled
    /// about its direction.
    fn upward(&self, length: f64, axis: Vec3) -> [f64; 3] {
        /// The sine of an angle that rounding leaves.
        const ROLL: f64 = 1e-4;
        let [eye, center, up] = [self.eye, self.center, self.up].map(Vec3::from_array);
        let side = unit(cross(up, eye - center));
        let is_rolled = side.is_none_or(|side| side.dot(axis).abs() > ROLL);
        let up = match is_rolled {
            true => unit(up).unwrap_or(Vec3::Y),
            false => axis * up.dot(axis).signum(),
        };
        // A length of 1 is to be exact enough to be taken for it.
        let digits = if length == 1.0 { 8 } else { UP_DIGITS };
        rounded(up * length, length, digits)
    }

    /// The same as passes use it.
    pub(super) fn view(&self, yfov: Option<f64>) -> View {
        let Self { eye, center, up } = *self;
        View {
            eye: Some(eye),
            center: Some(center),
            up: Some(up),
            yfov,
            orbit: None,
        }
    }

    /// Shows a scene that was staged from here.
    pub(super) fn aim(&self, lowered: &mut LoweredScene) -> bool {
        let stage = ViewAndLight {
            view: self.view(None),
            studio: StudioChoice::Off,
            ground: Some(false),
            ..ViewAndLight::default()
        };
        stage.apply(lowered, SceneKind::Text).is_ok()
    }
}

impl SceneCamera {
    /// The camera of a scene for the page, with the override if there is one; `own` is the scene's
    /// own view.
    pub(super) fn new(
        camera: &Camera,
        view_override: Option<&ViewOverride>,
        can_write: bool,
        previous: Option<&Self>,
    ) -> Self {
        let yfov = || {
            let yfov = camera.yfov().filter(|_| !can_write);
            yfov.map(|yfov| shortest(yfov.to_degrees()))
        };
        let yfov = previous.map_or_else(yfov, |view| view.yfov.clone());
        let flags = view_override.map_or_else(Vec::new, |ViewOverride { eye, center, up }| {
            let view = [("--eye", eye), ("--center", center), ("--up", up)];
            let view = view.map(|(name, value)| (name, comma(*value))).into_iter();
            view.chain(yfov.clone().map(|degrees| ("--yfov", degrees)))
                .collect()
        });
        let up = unit(Vec3::from_array(camera.up)).unwrap_or(Vec3::Y);
        Self {
            eye: camera.eye,
            center: camera.center,
            up: up.to_array(),
            axis: camera.upright().to_array(),
            yfov,
            flags,
            can_write,
        }
    }

    /// The angle that another view of the scene is to have, in radians.
    pub(super) fn yfov(&self) -> Option<f64> {
        parse::degrees(self.yfov.as_deref()?).ok()
    }

    pub(super) fn reported(&self) -> Value {
        let Self {
            eye,
            center,
            up,
            axis,
            yfov: _,
            flags: _,
            can_write,
        } = self;
        json!({ "eye": eye, "center": center, "up": up, "axis": axis, "canWrite": can_write })
    }
}

/// The spans of the values of `eye`, `center` and `up` in a scene text.
pub(super) fn keys(
    lowered: &LoweredScene,
    map: &SourceMap,
    name: &str,
) -> Option<[Range<usize>; 3]> {
    let span = |field| {
        let span: Span = lowered
            .source_spans
            .span(ValuePath::new(EntityKind::Camera, 0, field))?;
        let text = map.slice(span);
        let is_plain =
            text.starts_with('[') && text.ends_with(']') && !text.contains(['#', '&', '*']);
        (is_plain && map.name(span.file) == name).then_some(span.start as usize..span.end as usize)
    };
    let [eye, center, up] = [EntityField::Eye, EntityField::Center, EntityField::Up].map(span);
    let own = [eye?, center?, up?];
    let mut sorted = own.clone();
    sorted.sort_by_key(|range| range.start);
    let are_disjoint = sorted.windows(2).all(|pair| pair[0].end <= pair[1].start);
    let right =
        lowered
            .source_spans
            .span(ValuePath::new(EntityKind::Camera, 0, EntityField::Right));
    // A number, such as a field of view, sets no direction.
    let is_square = right.is_none_or(|right| {
        let is_number = !map.slice(right).starts_with('[');
        is_number || own.iter().any(|range| range.start == right.start as usize)
    });
    (are_disjoint && is_square).then_some(own)
}

/// The text of the scene at `path`, with another view.
///
/// # Errors
/// The reason why it is impossible.
pub(super) fn written(
    path: &Path,
    text: &str,
    options: &Options,
    view_override: &ViewOverride,
) -> Result<String, &'static str> {
    let mut input = Input::edited(path, text.as_bytes().to_vec(), options.clone());
    let mut lowered = input.load().ok_or("the scene can't be read")?.lowered;
    let own = keys(&lowered, input.map(), input.name());
    let own = own.ok_or("the scene has no `eye`, `center` and `up` of its own")?;
    let axis = lowered.scene.camera.upright();
    if !view_override.aim(&mut lowered) {
        return Err("it is no view");
    }
    // With a field of view its length has no effect, else it is that of a pixel.
    let pixel = Vec3::from_array(lowered.scene.camera.up).length();
    let Camera { eye, center, .. } = lowered.scene.camera;
    let mut outcome = Err("its keys do not say the view alone");
    for length in [1.0, pixel] {
        let up = view_override.upward(length, axis);
        let new = replaced(text, &own, [eye, center, up]);
        let mut changed = Input::edited(path, new.clone().into_bytes(), options.clone());
        let changed = changed.load().map(|loaded| loaded.lowered.scene);
        let mut changed = changed.ok_or("the scene can't be read afterwards")?;
        let is_seen = is_near(&changed.camera, &lowered.scene.camera);
        // No other value may change: one value can set more than the camera.
        changed.camera = lowered.scene.camera.clone();
        if is_seen && changed == lowered.scene {
            outcome = Ok(new);
            break;
        }
    }
    outcome
}

/// A text with other values of three keys.
fn replaced(text: &str, keys: &[Range<usize>; 3], values: [[f64; 3]; 3]) -> String {
    let mut edits: Vec<_> = keys.iter().zip(values).collect();
    edits.sort_by_key(|(range, _)| range.start);
    let (mut new, mut from) = (String::with_capacity(text.len()), 0);
    for (range, value) in edits {
        new.push_str(text.get(from..range.start).unwrap_or_default());
        new.push_str(&format!("[{}]", value.map(shortest).join(", ")));
        from = range.end;
    }
    new.push_str(text.get(from..).unwrap_or_default());
    new
}

/// Whether two cameras show the same, but for rounding.
fn is_near(a: &Camera, b: &Camera) -> bool {
    let scale = Vec3::from_array(b.eye).distance(Vec3::from_array(b.center));
    let distance_between =
        |a: [f64; 3], b: [f64; 3]| Vec3::from_array(a).distance(Vec3::from_array(b));
    let step = Vec3::from_array(b.up).distance(Vec3::ZERO);
    distance_between(a.eye, b.eye) <= NEAR * scale
        && distance_between(a.center, b.center) <= NEAR * scale
        && distance_between(a.up, b.up) <= NEAR_STEP * step
        && distance_between(a.right, b.right) <= NEAR_STEP * step
        && a.size == b.size
}

/// A vector rounded to a number of digits relative to a length.
fn rounded(vector: Vec3, length: f64, digits: usize) -> [f64; 3] {
    let shown = format!("{length:e}");
    let exponent = shown.split_once('e').and_then(|(_, e)| e.parse().ok());
    let exponent: i64 = exponent.unwrap_or(0);
    let digits = i64::try_from(digits).unwrap_or(0);
    let decimals = usize::try_from(digits - exponent).unwrap_or(0);
    let round = |number: f64| format!("{number:.decimals$}").parse().unwrap_or(number);
    vector.to_array().map(|number| round(number) + 0.0)
}

/// Three numbers as a flag takes them.
fn comma(numbers: [f64; 3]) -> String {
    numbers.map(shortest).join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAZE: ViewOverride = ViewOverride {
        eye: [50.0, 0.0, 0.0],
        center: [0.0; 3],
        up: [0.0, 1.0, 0.0],
    };

    fn turned(text: &str) -> Result<String, &'static str> {
        written(Path::new("a.yaml"), text, &Options::default(), &GAZE)
    }

    #[test]
    fn the_values_of_the_keys_alone_are_replaced() {
        let text = |eye: &str, center: &str, up: &str| {
            format!(
                "# Mine.\nCamera:\n  up: {up} # a pixel\n  eye: {eye} # far away\n\
                 \x20 center: {center}\n  viewSize: [8, 6]\nObjects: []\n"
            )
        };
        assert_eq!(
            turned(&text("[0, 0, 100]", "[0,0,0]", "[0, 0.5, 0]")),
            Ok(text("[50, 0, 0]", "[0, 0, 0]", "[0, 0.25, 0]")),
            "a picture of the same angle from half as far has pixels half as large"
        );
    }

    #[test]
    fn up_stays_upright_unless_the_view_is_rolled() {
        let text = "Camera: {eye: [0, 0, 200], center: [0, 0, 0], up: [0, 0.5, 0], viewSize: \
            [120, 90]}\nObjects: []\n";
        let up_of = |eye: [f64; 3], up: [f64; 3]| {
            let view_override = ViewOverride {
                eye,
                center: [0.0; 3],
                up,
            };
            let path = Path::new("a.yaml");
            let new = written(path, text, &Options::default(), &view_override).unwrap();
            let up = new.split_once("up: [").unwrap().1;
            up.split_once(']').unwrap().0.to_owned()
        };
        // From above by 45°, as the mouse turns a view.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let eye = [0.0, 200.0 * half, 200.0 * half];
        assert_eq!(up_of(eye, [0.0, half, -half]), "0, 0.5, 0");
        assert_ne!(up_of(eye, [0.3, half, -half]), "0, 0.5, 0");
    }

    /// Beside a field of view the length of `up` says nothing.
    #[test]
    fn with_a_field_of_view_up_is_one_long() {
        let text = |eye: &str| {
            format!(
                "Camera: {{eye: {eye}, center: [0, 0, 0], up: [0, 1, 0], fov: 35, viewSize: \
                [480, 320]}}\nObjects: []\n"
            )
        };
        let new = turned(&text("[0, 0, 8]"));
        assert_eq!(new, Ok(text("[50, 0, 0]")));
        let mut input = Input::edited(Path::new("a.yaml"), new.unwrap().into(), Options::default());
        assert!(input.load().is_some() && input.take_diagnostics().kept().is_empty());
    }

    /// A view from the mouse has 16 digits; digits below a hundredth of a pixel are not written.
    #[test]
    fn a_view_is_written_in_few_digits() {
        let sent = json!({
            "eye": [-79.2181731920223, 55.12048439037687, 155.47443853437272],
            "center": [0.1 + 0.2, 0, 0],
            "up": [0.12373657560778914, 0.8628125386248774, -0.24284673381895566],
        });
        let view_override = ViewOverride::read(&sent).unwrap();
        let text = "Camera: {eye: [0, 0, 200], center: [0, 0, 0], up: [0, 0.5, 0], viewSize: \
            [120, 90]}\nObjects: []\n";
        let path = Path::new("a.yaml");
        let turned = written(path, text, &Options::default(), &view_override).unwrap();
        let is_short = |number: &str| number.len() <= "-155.4744".len();
        let mut numbers = turned.split(|c: char| !c.is_ascii_digit() && !"-.".contains(c));
        assert!(numbers.all(is_short), "{turned}");
        // The written view is the sent one within a hundredth of a pixel.
        let before: ViewOverride = ViewOverride::deserialize(&sent).unwrap();
        for (own, sent) in [
            (view_override.eye, before.eye),
            (view_override.center, before.center),
        ] {
            let distance_between = Vec3::from_array(own).distance(Vec3::from_array(sent));
            assert!(distance_between < 0.002, "{distance_between}");
        }
    }

    #[test]
    fn what_has_no_such_keys_is_left_as_it_is() {
        for text in [
            "Eye: [200, 200, 1000]\nObjects: []\n",
            "Camera: {eye: &a [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], viewSize: [8, \
            6]}\nLights: [{position: *a, color: [1, 1, 1]}]\nObjects: []\n",
            "Camera: {eye: [0, 0, 9], center: [0, 0, 0], up: [0, 1, 0], right: [2, 0, 0], \
            viewSize: [8, 6]}\nObjects: []\n",
        ] {
            assert!(turned(text).is_err(), "{text}");
        }
    }

    #[test]
    fn views_that_are_none_are_refused() {
        let read = |eye: Value, up: Value| {
            ViewOverride::read(&json!({ "eye": eye, "center": [0, 0, 0], "up": up }))
        };
        assert!(read(json!([1, 2, 3]), json!([0, 1, 0])).is_some());
        for (eye, up) in [
            (json!([0, 0, 0]), json!([0, 1, 0])),
            (json!([1, 2, 3]), json!([0, 0, 0])),
            (json!([1e300, 2, 3]), json!([0, 1, 0])),
            (json!([1, 2]), json!([0, 1, 0])),
            (json!("1,2,3"), json!([0, 1, 0])),
        ] {
            assert_eq!(read(eye, up), None);
        }
    }
}
