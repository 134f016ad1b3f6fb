//! The laws of `tests/laws.rs` for the scenes of the course, and that of the layout for those that
//! people published for it.

use super::scenes::{COURSE, each};
use crate::scene_laws::{
    is_the_same_in_any_order, is_the_same_laid_out, makes_the_same_picture_times, powers,
};
use crate::small::scenes_in;
use crate::suite::shared;
use libtest_mimic::Trial;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    let mut trials = each("laws: scale", COURSE, &["yaml"], is_the_same_at_any_scale);
    trials.extend(each(
        "laws: order",
        COURSE,
        &["yaml"],
        is_the_same_in_any_order,
    ));
    for folder in [COURSE, "wild", "wild-2"] {
        trials.extend(each(
            "laws: layout",
            folder,
            &["yaml", "yml"],
            is_the_same_laid_out,
        ));
    }
    trials
}

/// Each scene has its share of the powers, all of which occur.
fn is_the_same_at_any_scale(path: &Path) {
    let scenes = scenes_in(&shared(COURSE).unwrap());
    let index = scenes.iter().position(|scene| scene == path).unwrap();
    makes_the_same_picture_times(path, powers(scenes.len(), index));
}
