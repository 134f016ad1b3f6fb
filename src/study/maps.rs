//! Maps of a picture: the rays and the error of each pixel, in the scene's setting and in the
//! recommended one.

use super::advice;
use super::difference::heat_map;
use super::metrics::LEVELS;
use super::outcome::{Study, StudyRow};
use super::setting::Setting;
use super::subject::{Stopped, StudySubject};
use rtc_image::Image;

/// The rays of each pixel of the whole picture in a setting, row by row; 0 outside the rendered
/// tiles.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PixelRays {
    setting: Setting,
    rays: Vec<u64>,
}

/// A map with the size of the whole picture.
pub struct StudyMap {
    /// The file name without extension, for example `rays-own`.
    pub name: String,
    /// The caption.
    pub label: String,
    /// The unit of its values.
    pub unit: &'static str,
    /// The value of the brightest colour; the darkest is 0, and the scale is linear. Both settings
    /// have the same scale.
    pub most: f64,
    /// The picture: hatched grey outside the rendered tiles.
    pub image: Image,
}

/// Counts the rays of each pixel in the mapped settings.
pub(super) fn count(study: &Study, subject: &StudySubject<'_>) -> Result<Vec<PixelRays>, Stopped> {
    let count = |(_, row): (_, &StudyRow)| {
        let setting = row.setting;
        let rays = subject.rays_of_pixels(setting)?;
        Ok(PixelRays { setting, rays })
    };
    mapped(study).into_iter().map(count).collect()
}

/// The mapped rows with their names.
fn mapped(study: &Study) -> Vec<(&'static str, &StudyRow)> {
    let own = study.scene_row().map(|row| ("own", row));
    let best = advice::recommended(study).filter(|row| !row.is_scene_setting);
    own.into_iter()
        .chain(best.map(|row| ("recommended", row)))
        .collect()
}

/// The maps of a study; empty if the study was read from a file.
#[must_use]
pub fn maps(study: &Study) -> Vec<StudyMap> {
    let rows = mapped(study);
    let rays = rows.iter().filter_map(|(_, row)| {
        let mut mapped = study.mapped.iter();
        mapped.find(|map| map.setting == row.setting)
    });
    let rays: Vec<Vec<f64>> = rays
        .map(|map| map.rays.iter().map(|rays| *rays as f64).collect())
        .collect();
    if rays.is_empty() {
        return Vec::new();
    }
    let errors: Vec<_> = rows.iter().map(|(_, row)| errors(study, row)).collect();
    let kinds = [
        ("rays", "Rays of each pixel", "rays", rays),
        ("error", "Error of each pixel", "grey levels", errors),
    ];
    let mut maps = Vec::new();
    for (kind, title, unit, values) in kinds {
        let most = upper_limit(study, &values);
        for ((which, row), values) in rows.iter().zip(values) {
            let setting = row.setting.label(&study.used());
            maps.push(StudyMap {
                name: format!("{kind}-{which}"),
                label: format!("{title}, {which} setting: {setting}"),
                unit,
                most,
                image: image(study, &values, most),
            });
        }
    }
    maps
}

/// The error of each pixel, the root mean square of its channels in grey levels; 0 outside the
/// rendered tiles.
fn errors(study: &Study, row: &StudyRow) -> Vec<f64> {
    let [width, height] = study.part.size.map(|side| side as usize);
    let mut values = vec![0.0; width * height];
    for ((area, test), reference_tiles) in study
        .areas
        .iter()
        .zip(&row.tiles)
        .zip(&study.reference_tiles)
    {
        let pairs = test.pixels.iter().zip(&reference_tiles.pixels).enumerate();
        for (index, (x, r)) in pairs {
            let (column, line) = (index % test.width as usize, index / test.width as usize);
            let index = (area.y as usize + line) * width + area.x as usize + column;
            let squares = x.iter().zip(r).map(|(x, r)| (x - r) * (x - r));
            values[index] = (squares.sum::<f64>() / 3.0).sqrt() * LEVELS;
        }
    }
    values
}

/// Whether each pixel was rendered.
fn rendered_pixels(study: &Study) -> Vec<bool> {
    let [width, height] = study.part.size.map(|side| side as usize);
    let mut rendered_pixels = vec![false; width * height];
    for area in &study.areas {
        for line in area.y..area.y + area.height {
            let start = line as usize * width + area.x as usize;
            rendered_pixels[start..start + area.width as usize].fill(true);
        }
    }
    rendered_pixels
}

/// The upper end of the scale: the smallest of 1, 2, 5, 10 …, or of their tenths and hundredths,
/// that is not exceeded by 99 % of the pixels of all maps.
fn upper_limit(study: &Study, maps: &[Vec<f64>]) -> f64 {
    const FRACTION: f64 = 0.99;
    let rendered_pixels = rendered_pixels(study);
    let values = maps.iter().flat_map(|map| map.iter().zip(&rendered_pixels));
    let mut values: Vec<_> = values
        .filter(|(_, rendered_pixels)| **rendered_pixels)
        .map(|(value, _)| *value)
        .collect();
    values.sort_unstable_by(f64::total_cmp);
    let index = (FRACTION * values.len() as f64) as usize;
    let value = values.get(index).or(values.last()).copied().unwrap_or(0.0);
    let mut unit = 0.01;
    loop {
        let steps = [1.0, 2.0, 5.0].map(|step| step * unit);
        if let Some(step) = steps.into_iter().find(|step| *step >= value) {
            return step;
        }
        unit *= 10.0;
    }
}

/// The heat map of values from 0 to `most`, hatched grey outside the rendered tiles.
fn image(study: &Study, values: &[f64], most: f64) -> Image {
    const HATCH: [f64; 2] = [0.35, 0.45];
    let fractions: Vec<_> = values.iter().map(|value| value / most).collect();
    let mut image = heat_map(study.part.size, &fractions);
    let width = image.width as usize;
    for (index, rendered_pixels) in rendered_pixels(study).into_iter().enumerate() {
        if !rendered_pixels {
            let stripe = (index % width + index / width) / 4 % 2;
            image.pixels[index] = [HATCH[stripe]; 3];
        }
    }
    image
}
