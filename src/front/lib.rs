//! Front ends: the languages that people and tools write, lowered to the IR. One folder a
//! language.
//!
//! * [`course`]: the scene format of the course, YAML or JSON, with the files that a scene names.
//! * [`gltf`]: glTF 2.0 assets with their extensions.
//! * [`mesh`]: OBJ, OFF, STL, PLY and XYZ files. They are inputs themselves, or parts of a scene.
//! * [`mitsuba`]: scenes of Mitsuba, XML.
//! * [`pbrt`]: scenes of pbrt, versions 3 and 4.
//! * [`usd`]: stages of USD, as text, binary or package.
//!
//! All front ends share the modules beside them: [`pixels`] decodes images within the budget,
//! `glyph` gives points and lines a shape, `words` splits text files into words with spans, and
//! [`foreign()`] explains files of other formats.
//!
//! Each front end takes a `FileId` of the source map, [`FrontOptions`] and a sink, and returns an
//! `rtc_ir::LoweredScene`: the scene with the span of every value. Callers may rely on this:
//!
//! * Mistakes of the user are never `Err`. They are pushed into the sink, all in one run; `None`
//!   means that at least one error was reported.
//! * Units, colour spaces and defaults are resolved. The IR has no notion of the source language.
//! * Values are finite or reported. Ranges are left to the validator, which checks every scene.
//! * Input is not trusted: sizes are charged to the budget of the source map before memory is
//!   allocated, and nothing panics on malformed bytes.

pub mod course;
mod exchange;
mod foreign;
pub mod gltf;
mod glyph;
mod hull;
pub mod mesh;
pub mod mitsuba;
pub mod pbrt;
pub mod pixels;
mod plugin;
mod splat;
mod support;
pub mod usd;
mod words;

pub use foreign::foreign;
pub use plugin::{Completion, Proposal, ProposalKind};
pub use support::{ForeignFormat, SupportLevel, SupportRow, page as support_page};

use rtc_diag::{Diagnostic, codes};
use rtc_math::Vec3;
use rtc_source::LimitExceeded;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The axis that points up in a file. A scene has y upwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpAxis {
    /// Y, as in glTF.
    Y,
    /// Z, as in most programs of engineering: x stays, and −y points to the front.
    Z,
}

impl UpAxis {
    /// The axes of the file in the scene: exact, without a rounding error.
    pub(crate) fn scene_from_file(self) -> [Vec3; 3] {
        match self {
            Self::Y => Vec3::AXES,
            Self::Z => [Vec3::X, -Vec3::Z, Vec3::Y],
        }
    }
}

/// Options of all front ends.
#[derive(Clone, Debug, Default)]
pub struct FrontOptions {
    /// Unknown keys are errors.
    pub strict: bool,
    /// Mistakes with one sensible repair are repaired with a warning.
    pub lenient: bool,
    /// A further folder that is searched for the files that a scene names.
    pub asset_root: Option<PathBuf>,
    /// The home folder of the user. It is not searched as the parent of a scene's folder.
    pub home: Option<PathBuf>,
    /// The time of an animation of glTF or USD, in seconds; the rest pose, or the start, by
    /// default.
    pub time: Option<f64>,
    /// The name of the glTF animation; the first by default.
    pub animation: Option<String>,
    /// The name of the glTF material variant, or `SET=NAME` for a variant of USD.
    pub variant: Option<String>,
    /// The camera of glTF or USD, by its name, the name of its node or its path, or its index. The
    /// default is the first camera that sees a surface, of USD the first one.
    pub camera: Option<String>,
    /// The diameter of points in pixels of a picture of 512 rows that shows all, above 0; by the
    /// density of the points by default.
    pub point_size: Option<f64>,
    /// The axis that points up in a mesh file or a glTF asset that is read as the scene.
    pub up_axis: Option<UpAxis>,
    /// Values of the parameters (`$name`) of a Mitsuba scene, by name; they come before the scene's
    /// own `<default>`.
    pub define: BTreeMap<String, String>,
    /// The number of threads that decode images of a glTF asset; 0 for one per core.
    pub threads: usize,
}

impl FrontOptions {
    /// Those of mesh files.
    pub(crate) fn mesh(&self) -> mesh::MeshOptions {
        mesh::MeshOptions {
            is_lenient: self.lenient,
            point_size: self.point_size,
        }
    }
}

/// Whether a file with this extension is a scene, when folders are searched for scenes.
#[must_use]
pub fn is_scene_name(name: &str) -> bool {
    const OTHERS: [&str; 12] = [
        "yaml", "yml", "json", "gltf", "glb", "rtir", "xml", "pbrt", "usd", "usda", "usdc", "usdz",
    ];
    let name = match name.to_lowercase().strip_suffix(".pbrt.gz") {
        Some(_) => "x.pbrt",
        None => name,
    };
    let extension = name.rsplit_once('.').map(|(_, last)| last.to_lowercase());
    extension.is_some_and(|extension| {
        let is = |known: &&str| *known == extension;
        OTHERS.iter().any(is) || mesh::EXTENSIONS.iter().any(is)
    })
}

/// Whether a file with this extension is a scene text, when folders are searched for texts to
/// format.
#[must_use]
pub fn is_scene_text_name(name: &str) -> bool {
    let extension = name.rsplit_once('.').map(|(_, last)| last.to_lowercase());
    extension.is_some_and(|extension| matches!(extension.as_str(), "yaml" | "yml"))
}

/// The diagnostic that a file exceeds the budget.
fn over_limit(what: &str, fault: &LimitExceeded) -> Diagnostic {
    Diagnostic::new(
        &codes::OVER_LIMIT,
        format!("{what} exceeds a limit: {fault}"),
    )
    .hint(fault.hint())
}
