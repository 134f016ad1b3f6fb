//! Values of arguments: the words people type to the values they mean, or what was expected.

use crate::image::Backdrop;
use crate::plan::Rule;
use crate::render::Crop;
use std::path::PathBuf;
use std::time::Duration;

pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X', '×']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    sides.filter(|sides| !sides.contains(&0)).ok_or_else(|| "expected width and height above 0, as 640x480".to_owned())
}

pub(super) fn moment(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "expected a number of seconds, as 1.5".to_owned())
}

pub(super) fn rule(text: &str) -> Result<Rule, String> {
    Rule::find(text).ok_or_else(|| {
        let names = Rule::ALL.map(Rule::name).join(", ");
        format!("there is no such rule; there are {names}")
    })
}

pub(super) fn levels(text: &str) -> Result<f64, String> {
    let levels = text.parse().ok().filter(|levels| (0.01..=255.0).contains(levels));
    levels.ok_or_else(|| "expected 0.01 to 255 grey levels".to_owned())
}

pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds.filter(|time| !time.is_zero()).ok_or_else(|| "expected seconds above 0, as 2.5".to_owned())
}

pub(super) fn setting(text: &str) -> Result<(String, String), String> {
    let pair = text.split_once('=').map(|(name, value)| (name.trim().to_owned(), value.trim().to_owned()));
    pair.ok_or_else(|| "expected a name and a value, as multipleScattering=false".to_owned())
}

pub(super) fn stops(text: &str) -> Result<f64, String> {
    let stops = text.parse().ok().filter(|stops| (-64.0..=64.0).contains(stops));
    stops.ok_or_else(|| "expected -64 to 64 stops".to_owned())
}

pub(super) fn backdrop(text: &str) -> Result<Backdrop, String> {
    let numbers = || text.split(',').map(|part| part.trim().parse().ok().filter(|v: &f64| v.is_finite() && *v >= 0.0));
    match text {
        "env" => Ok(Backdrop::Film),
        "transparent" => Ok(Backdrop::Transparent),
        _ => match numbers().collect::<Option<Vec<_>>>().as_deref() {
            Some(&[r, g, b]) => Ok(Backdrop::Color([r, g, b])),
            _ => Err("expected `env`, `transparent`, or red, green and blue, as 1,1,1".to_owned()),
        },
    }
}

pub(super) fn folder(text: &str) -> Result<PathBuf, String> {
    Some(PathBuf::from(text)).filter(|path| path.is_dir()).ok_or_else(|| "there is no such folder".to_owned())
}

pub(super) fn crop(text: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<u32>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop { x, y, width, height }),
        _ => Err("expected left, top, width and height in pixels, as 10,20,64,48".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_and_crops() {
        assert_eq!((size("640x480"), size("3×2")), (Ok([640, 480]), Ok([3, 2])));
        assert!(["640", "0x4", "4x", "-1x2", "1x2x3"].into_iter().all(|text| size(text).is_err()));
        assert!(["0", "-1", "nan", "inf", "256", "x"].into_iter().all(|text| levels(text).is_err()));
        assert!(["0", "-1", "nan", "inf", "1e300", "x"].into_iter().all(|text| seconds(text).is_err()));
        assert_eq!((levels("0.5"), seconds("2.5")), (Ok(0.5), Ok(Duration::from_millis(2500))));
        assert!(["65", "-65", "nan", "x"].into_iter().all(|text| stops(text).is_err()));
        assert_eq!(backdrop("0.5,1, 2"), Ok(Backdrop::Color([0.5, 1.0, 2.0])));
        assert!(["", "sky", "1,1", "1,1,1,1", "-1,0,0", "inf,0,0"].into_iter().all(|text| backdrop(text).is_err()));
        assert_eq!(crop("1, 2,3,4"), Ok(Crop { x: 1, y: 2, width: 3, height: 4 }));
        assert!(["1,2,3", "1,2,0,4", "a,b,c,d", "1,2,3,4,5"].into_iter().all(|text| crop(text).is_err()));
    }
}
