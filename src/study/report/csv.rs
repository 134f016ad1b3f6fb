//! The rows of a study as CSV (RFC 4180): a header line, then one line per row; errors in grey
//! levels, times in seconds.

use super::super::outcome::{Study, StudyRow};
use super::super::parameter::Parameter;

const NAMES: &str = "supersampling,aperture,lights,glossy,paths,caustics,denoise,depth,precision,own,front,judged,camera_rays,shadow_rays,mirror_rays,\
refracted_rays,seconds,seconds_low,seconds_high,ratio,ratio_low,ratio_high,rmse,rmse_low,rmse_high,relative_mse,\
max,visible,flip,delta_e,model,renders,expected_rmse,rmse_deviation";

/// All rows.
#[must_use]
pub fn csv(study: &Study) -> String {
    let lines = study.rows.iter().map(line);
    std::iter::once(NAMES.to_owned())
        .chain(lines)
        .map(|line| line + "\r\n")
        .collect()
}

fn line(row: &StudyRow) -> String {
    let StudyRow {
        setting,
        is_scene_setting,
        front,
        rays,
        seconds,
        ratio,
        errors,
        spread,
        is_resolved,
        resumed: _,
        model,
        tiles: _,
    } = row;
    let parameters = Parameter::ALL.map(|parameter| parameter.cell(setting.get(parameter)));
    let flags = [is_scene_setting, front, is_resolved].map(ToString::to_string);
    let rays =
        [rays.camera, rays.shadow, rays.mirror, rays.refracted].map(|count| count.to_string());
    let times = [seconds, ratio]
        .into_iter()
        .flat_map(|estimate| [estimate.value, estimate.low, estimate.high]);
    let errors = [
        errors.rmse,
        errors.rmse_low,
        errors.rmse_high,
        errors.relative_mse,
        errors.max,
        errors.visible,
        errors.flip,
        errors.delta_e,
        *model,
        f64::from(spread.renders),
        spread.expected,
        spread.deviation,
    ];
    // The shortest digits that read back as the same number.
    let numbers = times.chain(errors).map(|number| number.to_string());
    parameters
        .into_iter()
        .chain(flags)
        .chain(rays)
        .chain(numbers)
        .collect::<Vec<_>>()
        .join(",")
}
