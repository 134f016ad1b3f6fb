//! OBJ files that others wrote: what `tobj` reads of them, our reader reads too, and says the same.

use super::scenes::each;
use crate::obj_oracle::compared;
use libtest_mimic::Trial;
use std::path::Path;

pub(crate) fn trials() -> Vec<Trial> {
    let folders = [
        "course/scenes",
        "public-scenes",
        "wild",
        "wild-2",
        "round-3/mesh",
    ];
    let files = folders
        .iter()
        .flat_map(|folder| each("objs", folder, &["obj"], is_read_alike));
    files.collect()
}

fn is_read_alike(path: &Path) {
    compared(&std::fs::read(path).unwrap());
}
