//! Every scene `tests/render/<entity>/<case>` is a test: its picture is that of `<case>.png` beside
//! it, pixel by pixel. Its first comment says what it shows; see [`options`] for what else it says.
//!
//! Pictures of the course's modes are the same bytes. Those of traced paths may be off by one level
//! of 8 bits: where samples are summed in another order, the last bits of a sum change, and a value
//! on the border of two levels falls to the other side.
//!
//! A failure leaves expected | actual | difference as one picture in the folder of the build.

mod compare;
mod options;
mod shoot;

use crate::suite::{files, name, root, trial, updates};
use compare::EffectStatus;
use libtest_mimic::{Failed, Trial};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The most pixels a side, and bytes a file.
const SIDE: u32 = 64;
const BYTES: usize = 20 << 10;
/// A picture of fewer colours shows nothing.
const COLORS: usize = 4;

pub(crate) fn trials() -> Vec<Trial> {
    let folder = root("tests/render");
    let mut trials: Vec<_> = cases(&folder)
        .into_iter()
        .map(|case| {
            let name = name(&case, &folder);
            Trial::test(format!("render/{name}"), move || check(&case, &name))
        })
        .collect();
    trials.push(trial(
        "render: each picture has one case",
        each_picture_has_one_case,
    ));
    trials.push(trial(
        "render: a wrong pixel is named and shown",
        compare::a_wrong_pixel_is_named_and_shown,
    ));
    trials
}

/// The scenes; what they name lies in folders below, and is no case.
fn cases(folder: &Path) -> Vec<PathBuf> {
    let mut found = files(
        folder,
        &["yaml", "gltf", "glb", "json", "pbrt", "usda", "usdz"],
    );
    let depth = folder.components().count() + 2;
    found.retain(|path| path.components().count() == depth);
    found
}

fn check(case: &Path, name: &str) -> Result<(), Failed> {
    let shot = shoot::shoot(case)?;
    let path = case.with_extension("png");
    suits(&shot.png)?;
    if updates() {
        fs::write(&path, &shot.png)?;
    }
    let expected = fs::read(&path).map_err(|error| {
        format!(
            "{}: {error}; RTC_UPDATE=1 writes it, look at it then",
            path.display()
        )
    })?;
    match compare::compare(&expected, &shot.png, shot.tolerance)? {
        EffectStatus::Same => Ok(()),
        EffectStatus::Differs(worst) => {
            let panels =
                PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("render/{name}.png"));
            compare::panels(&expected, &shot.png, &panels)?;
            Err(format!(
                "{worst}\nexpected | actual | difference: {}",
                panels.display()
            )
            .into())
        }
    }
}

/// Refuses a picture that is too large to keep or shows nothing.
fn suits(png: &[u8]) -> Result<(), Failed> {
    let picture = compare::decode(png)?;
    let (width, height) = picture.dimensions();
    let colors: BTreeSet<_> = picture.pixels().map(|pixel| pixel.0).collect();
    if width > SIDE || height > SIDE || png.len() > BYTES {
        let bytes = png.len();
        return Err(format!("{width}×{height} pixels, {bytes} bytes: too large to keep").into());
    }
    if colors.len() < COLORS {
        return Err(format!("a picture of {} colours shows nothing", colors.len()).into());
    }
    Ok(())
}

fn each_picture_has_one_case() {
    let folder = root("tests/render");
    let names: Vec<_> = cases(&folder)
        .iter()
        .map(|case| name(case, &folder))
        .collect();
    let unique: BTreeSet<_> = names.iter().collect();
    assert_eq!(unique.len(), names.len(), "two cases share a picture");
    for picture in files(&folder, &["png", "options"]) {
        let is_asset = picture
            .parent()
            .is_some_and(|parent| parent.ends_with("files"));
        assert!(
            is_asset || unique.contains(&name(&picture, &folder)),
            "{} has no case",
            picture.display()
        );
    }
    assert!(names.len() >= 60, "the cases are gone: {}", names.len());
}
