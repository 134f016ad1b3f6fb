//! Formats the text of a scene; other kinds of scenes are rejected.

use super::Input;
use rtc_codec as codec;
use rtc_diag as diag;
use rtc_front::course;
use rtc_front::{self as front, gltf, mesh, mitsuba, pbrt};
use rtc_source::tree::yaml::LayoutFault;

/// Why a scene is not formatted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LayoutError {
    /// It has errors, which are among the diagnostics.
    Findings,
    /// It is an asset, a mesh or IR.
    NoText,
    /// The text has no top-level key of a scene.
    NoScene,
    /// The result would differ.
    Differs,
}

/// The kind of a scene file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceKind {
    /// A text of the course, YAML or JSON.
    Scene,
    /// IR.
    Ir,
    /// An asset, a mesh, or a scene of another renderer.
    Other,
}

impl SourceKind {
    /// The kind of a file with this name and content.
    #[must_use]
    pub fn of(name: &str, bytes: &[u8]) -> Self {
        let is_asset = || {
            gltf::is_gltf(name, bytes)
                || mesh::is_mesh_file(name, bytes)
                || mitsuba::is_mitsuba(bytes)
                || pbrt::is_pbrt(name, bytes)
        };
        match codec::detect_format(bytes) {
            Some(_) => Self::Ir,
            None if is_asset() => Self::Other,
            None => Self::Scene,
        }
    }
}

/// Whether a file with this name and content is a scene, or is meant as one. A text of the course
/// that is broken still is, as long as it has a top-level key of the format. A text of pbrt that
/// other files include is none.
#[must_use]
pub fn is_scene(name: &str, bytes: &[u8]) -> bool {
    if pbrt::is_pbrt(name, bytes) {
        return pbrt::is_whole(bytes);
    }
    SourceKind::of(name, bytes) != SourceKind::Scene || course::is_scene_text(bytes)
}

impl Input {
    /// The formatted text. Nothing is written.
    ///
    /// # Errors
    /// If it can't be formatted.
    pub fn lay_out(&mut self) -> Result<String, LayoutError> {
        let file = self.file_id().ok_or(LayoutError::Findings)?;
        let (name, bytes) = (self.map().name(file), self.map().bytes(file));
        if let Some(diagnostic) = front::foreign(name, bytes) {
            self.push(diagnostic);
            return Err(LayoutError::Findings);
        }
        if SourceKind::of(name, bytes) != SourceKind::Scene {
            return Err(LayoutError::NoText);
        }
        if !course::is_scene_text(bytes) {
            return Err(LayoutError::NoScene);
        }
        let mut sink = diag::Sink::default();
        let laid_out = course::lay_out(file, self.map(), &mut sink);
        for diagnostic in sink.kept() {
            self.push(diagnostic.clone());
        }
        laid_out.map_err(|error| match error {
            LayoutFault::Mistakes => LayoutError::Findings,
            LayoutFault::Differs => LayoutError::Differs,
        })
    }
}
