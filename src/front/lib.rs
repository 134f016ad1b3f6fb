//! Front ends: what people and tools write, lowered to the IR. One folder a language: the course's
//! YAML, glTF, mesh files; and pixel files, decoded within the budget for all of them.

pub mod course;
mod foreign;
pub mod gltf;
mod glyph;
pub mod mesh;
pub mod pixels;
mod words;

pub use foreign::foreign;

use rtc_diag::{Diagnostic, codes};
use rtc_source::Exceeded;
use std::path::PathBuf;

/// What a front end lets pass, and where it may look.
#[derive(Clone, Debug, Default)]
pub struct FrontOptions {
    /// Unknown keys are errors.
    pub strict: bool,
    /// Mistakes with one sensible repair are repaired, with a warning that says what was done.
    pub lenient: bool,
    /// A folder beside that of the scene below which files named by the scene may lie.
    pub asset_root: Option<PathBuf>,
    /// The home of the user, which lends no files to the scenes in its folders.
    pub home: Option<PathBuf>,
    /// Of a glTF asset: the moment at which it is shown, in seconds; at rest without.
    pub time: Option<f64>,
    /// Of a glTF asset: the animation that the moment is of; without, the first.
    pub animation: Option<String>,
    /// Of a glTF asset: the variant of its materials.
    pub variant: Option<String>,
    /// Of a glTF asset: the camera, by its name, that of its node, or its index; the first one
    /// that shows anything without.
    pub camera: Option<String>,
    /// How many threads decode the images of a glTF asset, 0 for one per core.
    pub threads: usize,
}

/// Whether a file of this name is taken for a scene where files are looked for: by its extension.
#[must_use]
pub fn is_scene_name(name: &str) -> bool {
    const OTHERS: [&str; 6] = ["yaml", "yml", "json", "gltf", "glb", "rtir"];
    let extension = name.rsplit_once('.').map(|(_, last)| last.to_lowercase());
    extension.is_some_and(|extension| {
        let is = |known: &&str| *known == extension;
        OTHERS.iter().any(is) || mesh::EXTENSIONS.iter().any(is)
    })
}

/// Whether a file of this name is taken for a scene text where files are looked for to lay out.
#[must_use]
pub fn is_scene_text_name(name: &str) -> bool {
    let extension = name.rsplit_once('.').map(|(_, last)| last.to_lowercase());
    extension.is_some_and(|extension| matches!(extension.as_str(), "yaml" | "yml"))
}

/// A file asks for more than the budget has.
fn over_limit(what: &str, fault: &Exceeded) -> Diagnostic {
    Diagnostic::new(
        &codes::OVER_LIMIT,
        format!("{what} asks for too much: {fault}"),
    )
    .hint(fault.hint())
}
