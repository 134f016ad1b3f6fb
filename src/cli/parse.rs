//! Parsers of argument values; errors state the expected form.

use super::args::BackgroundArg;
use rtc_image::BackgroundFill;
use rtc_passes::{OrbitAngles, SunLight};
use rtc_pipeline::{Exposure, MAX_SHARDS};
use rtc_plan::Rule;
use rtc_render::Crop;
use rtc_source::Resource;
use rtc_valid as valid;
use std::path::PathBuf;
use std::time::Duration;

/// Width and height; one number is both.
pub(super) fn size(text: &str) -> Result<[u32; 2], String> {
    let (width, height) = text.split_once(['x', 'X', '×']).unwrap_or((text, text));
    let sides = width.parse().ok().zip(height.parse().ok());
    sides
        .map(|(width, height)| [width, height])
        .filter(|sides| !sides.contains(&0))
        .ok_or_else(|| "expected width and height above 0, as 640x480 or 512".to_owned())
}

/// Which share, and of how many.
pub(super) fn share(text: &str) -> Result<[u32; 2], String> {
    let numbers = text.split_once('/');
    let numbers = numbers.and_then(|(i, n)| Some([i.parse().ok()?, n.parse().ok()?]));
    numbers
        .filter(|[index, count]| (1..=*count).contains(index) && *count <= MAX_SHARDS)
        .ok_or_else(|| format!("expected a share and their number, at most {MAX_SHARDS}, as 3/8"))
}

/// The first and the last of some frames, from 1 on.
pub(super) fn frames(text: &str) -> Result<[u32; 2], String> {
    let numbers = text.split_once("..");
    let numbers = numbers.and_then(|(a, b)| Some([a.parse().ok()?, b.parse().ok()?]));
    numbers
        .filter(|[first, last]| (1..=*last).contains(first))
        .ok_or_else(|| "expected the first frame and the last, from 1 on, as 1..48".to_owned())
}

pub(super) fn moment(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "expected a number of seconds, as 1.5".to_owned())
}

/// Pictures a second.
pub(super) fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok();
    rate.filter(|rate| (0.001..=10_000.0).contains(rate))
        .ok_or_else(|| "expected 0.001 to 10000 pictures a second, as 24".to_owned())
}

/// A length above 0.
pub(super) fn length(text: &str) -> Result<f64, String> {
    let length = text.parse().ok();
    let length = length.filter(|length: &f64| *length > 0.0 && length.is_finite());
    length.ok_or_else(|| "expected a length above 0, as 0.01".to_owned())
}

/// A limit by its name, and its number, which a unit may follow.
pub(super) fn limit(text: &str) -> Result<(Resource, u64), String> {
    let expected = || {
        let names: Vec<_> = Resource::all().map(Resource::name).collect();
        format!(
            "expected a limit and a number, as memory=2GiB or rays=5000000; there are {}",
            names.join(", ")
        )
    };
    let (name, value) = text.split_once('=').ok_or_else(expected)?;
    let resource = Resource::all()
        .find(|resource| resource.name() == name.trim())
        .ok_or_else(expected)?;
    Ok((resource, number(value.trim()).ok_or_else(expected)?))
}

/// A whole number, which a unit may follow.
fn number(text: &str) -> Option<u64> {
    let digits = text.trim_end_matches(|c: char| !c.is_ascii_digit());
    let unit: u64 = match text.strip_prefix(digits)?.trim() {
        "" => 1,
        "KiB" => 1 << 10,
        "MiB" => 1 << 20,
        "GiB" => 1 << 30,
        _ => return None,
    };
    digits.parse::<u64>().ok()?.checked_mul(unit)
}

/// A number of bytes.
pub(super) fn bytes(text: &str) -> Result<u64, String> {
    number(text.trim()).ok_or_else(|| "expected a number of bytes, as 500MiB or 2GiB".to_owned())
}

/// Finite numbers with commas between them.
fn numbers(text: &str) -> Option<Vec<f64>> {
    let finite = |part: &str| {
        part.trim()
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite())
    };
    text.split(',').map(finite).collect()
}

pub(super) fn vector(text: &str) -> Result<[f64; 3], String> {
    let vector: Option<[f64; 3]> = numbers(text).and_then(|numbers| numbers.try_into().ok());
    let vector = vector.ok_or_else(|| "expected three numbers, as 1,-0.5,2".to_owned())?;
    let is_large = vector
        .iter()
        .any(|component| component.abs() > valid::LARGEST);
    if is_large {
        Err(format!(
            "numbers of a scene are at most {:e} in absolute value",
            valid::LARGEST
        ))
    } else {
        Ok(vector)
    }
}

/// One number or three, none below 0.
fn light(numbers: &[f64]) -> Option<[f64; 3]> {
    let channels = match *numbers {
        [grey] => [grey; 3],
        [r, g, b] => [r, g, b],
        _ => return None,
    };
    channels
        .iter()
        .all(|channel| *channel >= 0.0)
        .then_some(channels)
}

pub(super) fn color(text: &str) -> Result<[f64; 3], String> {
    let color = numbers(text).and_then(|numbers| light(&numbers));
    color
        .ok_or_else(|| "expected one number or three of at least 0, as 0.5 or 1,0.9,0.8".to_owned())
}

pub(super) fn sun(text: &str) -> Result<SunLight, String> {
    let numbers = numbers(text).unwrap_or_default();
    let (direction, irradiance) = numbers.split_first_chunk().unwrap_or((&[0.0; 3], &[]));
    let direction = Some(*direction).filter(|direction| *direction != [0.0; 3]);
    let sun = direction
        .zip(light(irradiance))
        .map(|(direction, irradiance)| SunLight {
            direction,
            irradiance,
        });
    sun.ok_or_else(|| {
        "expected a direction and an irradiance of one number or three, as 0,1,0,3".to_owned()
    })
}

/// An opening in radians.
pub(super) fn degrees(text: &str) -> Result<f64, String> {
    let degrees = text
        .parse()
        .ok()
        .filter(|degrees: &f64| 0.001 <= *degrees && *degrees < 180.0);
    degrees
        .map(f64::to_radians)
        .ok_or_else(|| "expected an angle above 0 and below 180 degrees".to_owned())
}

pub(super) fn rule(text: &str) -> Result<Rule, String> {
    Rule::find(text).ok_or_else(|| {
        let names = Rule::ALL.map(Rule::name).join(", ");
        format!("there is no such rule; there are {names}")
    })
}

pub(super) fn levels(text: &str) -> Result<f64, String> {
    let levels = text
        .parse()
        .ok()
        .filter(|levels| (0.01..=255.0).contains(levels));
    levels.ok_or_else(|| "expected 0.01 to 255 grey levels".to_owned())
}

/// The limit of a clamp.
pub(super) fn radiance(text: &str) -> Result<f64, String> {
    let limit = text
        .parse()
        .ok()
        .filter(|limit| (1e-6..=1e9).contains(limit));
    limit.ok_or_else(|| "expected a radiance from 1e-6 to 1e9, as 10".to_owned())
}

pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text
        .parse()
        .ok()
        .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
    seconds
        .filter(|time| !time.is_zero())
        .ok_or_else(|| "expected seconds above 0, as 2.5".to_owned())
}

/// Seconds, with an `s` or without.
pub(super) fn interval(text: &str) -> Result<Duration, String> {
    seconds(text.strip_suffix('s').unwrap_or(text))
}

pub(super) fn setting(text: &str) -> Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .map(|(name, value)| (name.trim().to_owned(), value.trim().to_owned()));
    pair.ok_or_else(|| "expected a name and a value, as multipleScattering=false".to_owned())
}

/// The angles of an orbit in degrees.
pub(super) fn orbit(text: &str) -> Result<OrbitAngles, String> {
    let angles = numbers(text).unwrap_or_default();
    let (azimuth, elevation, roll) = match angles[..] {
        [azimuth, elevation] => (azimuth, elevation, 0.0),
        [azimuth, elevation, roll] => (azimuth, elevation, roll),
        _ => return Err("expected two or three angles in degrees, as 30,20".to_owned()),
    };
    if !(-90.0..=90.0).contains(&elevation) {
        return Err("the elevation is -90 to 90 degrees".to_owned());
    }
    Ok(OrbitAngles {
        azimuth: azimuth.to_radians(),
        elevation: elevation.to_radians(),
        roll: roll.to_radians(),
    })
}

pub(super) fn exposure(text: &str) -> Result<Exposure, String> {
    if text == "auto" {
        return Ok(Exposure::Auto);
    }
    let stops = text
        .parse()
        .ok()
        .filter(|stops| (-64.0..=64.0).contains(stops));
    stops
        .map(Exposure::Stops)
        .ok_or_else(|| "expected `auto` or -64 to 64 stops".to_owned())
}

pub(super) fn background(text: &str) -> Result<BackgroundArg, String> {
    let numbers = || {
        text.split(',').map(|part| {
            part.trim()
                .parse()
                .ok()
                .filter(|v: &f64| v.is_finite() && *v >= 0.0)
        })
    };
    match text {
        "env" => Ok(BackgroundArg::Fill(BackgroundFill::Film)),
        "transparent" => Ok(BackgroundArg::Fill(BackgroundFill::Transparent)),
        "white" => Ok(BackgroundArg::Color([255; 3])),
        "black" => Ok(BackgroundArg::Color([0; 3])),
        _ if text.starts_with('#') => hex(text)
            .map(BackgroundArg::Color)
            .ok_or_else(|| "expected a colour as #ff8000".to_owned()),
        _ => match numbers().collect::<Option<Vec<_>>>().as_deref() {
            Some(&[r, g, b]) => Ok(BackgroundArg::Fill(BackgroundFill::Color([r, g, b]))),
            _ => Err(
                "expected `env`, `transparent`, `white`, `black`, #rrggbb, or red, green and \
                blue, as 1,1,1"
                    .to_owned(),
            ),
        },
    }
}

/// A colour of six hexadecimal digits, as #ff8000.
fn hex(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#')?;
    let is_hex = digits.len() == 6 && digits.bytes().all(|digit| digit.is_ascii_hexdigit());
    let number = u32::from_str_radix(digits, 16).ok().filter(|_| is_hex)?;
    let [_, color @ ..] = number.to_be_bytes();
    Some(color)
}

pub(super) fn folder(text: &str) -> Result<PathBuf, String> {
    Some(PathBuf::from(text))
        .filter(|path| path.is_dir())
        .ok_or_else(|| "there is no such folder".to_owned())
}

pub(super) fn crop(text: &str) -> Result<Crop, String> {
    let numbers: Option<Vec<u32>> = text
        .split(',')
        .map(|part| part.trim().parse().ok())
        .collect();
    match numbers.as_deref() {
        Some(&[x, y, width, height]) if width > 0 && height > 0 => Ok(Crop {
            x,
            y,
            width,
            height,
        }),
        _ => Err("expected left, top, width and height in pixels, as 10,20,64,48".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn are_refused<T>(read: fn(&str) -> Result<T, String>, texts: &[&str]) -> bool {
        texts.iter().all(|text| read(text).is_err())
    }

    #[test]
    fn sizes_and_crops_have_pixels() {
        assert_eq!((size("640x480"), size("3×2")), (Ok([640, 480]), Ok([3, 2])));
        assert_eq!(size("512"), Ok([512, 512]));
        assert!(are_refused(
            size,
            &["", "0", "1.5", "0x4", "4x", "-1x2", "1x2x3"]
        ));
        let [x, y, width, height] = [1, 2, 3, 4];
        let wanted = Crop {
            x,
            y,
            width,
            height,
        };
        assert_eq!(crop("1, 2,3,4"), Ok(wanted));
        assert!(are_refused(
            crop,
            &["1,2,3", "1,2,0,4", "a,b,c,d", "1,2,3,4,5"]
        ));
    }

    #[test]
    fn numbers_are_those_that_mean_something() {
        assert_eq!(
            (levels("0.5"), seconds("2.5")),
            (Ok(0.5), Ok(Duration::from_millis(2500)))
        );
        assert!(are_refused(levels, &["0", "-1", "nan", "inf", "256", "x"]));
        assert!(are_refused(
            seconds,
            &["0", "-1", "nan", "inf", "1e300", "x"]
        ));
        assert!(are_refused(exposure, &["65", "-65", "nan", "x", "Auto"]));
        assert!(are_refused(degrees, &["0", "180", "-5", "nan", "x"]));
    }

    #[test]
    fn vectors_and_colors_have_numbers_of_a_scene() {
        assert_eq!(
            (vector("1,-2, 3"), color("0.5")),
            (Ok([1.0, -2.0, 3.0]), Ok([0.5; 3]))
        );
        assert_eq!(
            vector("0,1e300,0"),
            Err("numbers of a scene are at most 1e60 in absolute value".to_owned())
        );
        assert!(are_refused(
            vector,
            &["1,2", "1,2,x", "1,2,inf", "1,2,3,4", ""]
        ));
        assert!(are_refused(color, &["-1", "1,2", "1,2,nan"]));
        assert_eq!(
            background("0.5,1, 2"),
            Ok(BackgroundArg::Fill(BackgroundFill::Color([0.5, 1.0, 2.0])))
        );
        assert_eq!(
            [background("#fF8001"), background("white")],
            [[255, 128, 1], [255; 3]].map(|color| Ok(BackgroundArg::Color(color)))
        );
        assert!(are_refused(
            background,
            &[
                "", "sky", "1,1", "1,1,1,1", "-1,0,0", "inf,0,0", "#fff", "#+12345", "#ff80000"
            ]
        ));
    }

    #[test]
    fn suns_have_a_direction_and_light() {
        let wanted = SunLight {
            direction: [0.0, -1.0, 0.0],
            irradiance: [2.0; 3],
        };
        assert_eq!(sun("0,-1,0,2"), Ok(wanted));
        assert_eq!(
            sun("0,1,0,3,2,1").map(|sun| sun.irradiance),
            Ok([3.0, 2.0, 1.0])
        );
        assert!(are_refused(
            sun,
            &["0,0,0,1", "0,1,0", "0,1,0,-1", "0,1,0,1,2", "x"]
        ));
    }
}
