//! Formats the text of a scene; other kinds of scenes are rejected.

use super::Input;
use rtc_codec as codec;
use rtc_diag as diag;
use rtc_front::course;
use rtc_front::{self as front, gltf, mesh, mitsuba, pbrt, usd};
use rtc_source::tree::yaml::FormatTextFault;

/// Why the text of a scene can't be formatted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormatTextError {
    /// It has errors, which were reported as diagnostics.
    Reported,
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
    Ir(codec::Encoding),
    /// A glTF asset.
    Gltf,
    /// A mesh file.
    Mesh,
    /// A scene of Mitsuba.
    Mitsuba,
    /// A scene of pbrt.
    Pbrt,
    /// A stage of USD.
    Usd,
}

impl SourceKind {
    /// The kind of a file with this name and content.
    #[must_use]
    pub fn of(name: &str, bytes: &[u8]) -> Self {
        match codec::detect_format(bytes) {
            Some(encoding) => Self::Ir(encoding),
            None if gltf::is_gltf(name, bytes) => Self::Gltf,
            None if mesh::is_mesh_file(name, bytes) => Self::Mesh,
            None if mitsuba::is_mitsuba(bytes) => Self::Mitsuba,
            None if usd::is_usd(name, bytes) => Self::Usd,
            None if pbrt::is_pbrt(name, bytes) => Self::Pbrt,
            None => Self::Scene,
        }
    }

    /// Whether it is shown as an asset is: glTF, a mesh, or USD.
    pub(crate) fn is_asset(self) -> bool {
        matches!(self, Self::Gltf | Self::Mesh | Self::Usd)
    }
}

/// Whether a file with this name and content is a scene, or is meant as one. A text of the course
/// that is broken still is, as long as it has a top-level key of the format. A text of pbrt that
/// other files include is none.
#[must_use]
pub fn is_scene(name: &str, bytes: &[u8]) -> bool {
    match SourceKind::of(name, bytes) {
        SourceKind::Scene => course::is_scene_text(bytes),
        SourceKind::Pbrt => pbrt::is_whole(bytes),
        SourceKind::Ir(_)
        | SourceKind::Gltf
        | SourceKind::Mesh
        | SourceKind::Mitsuba
        | SourceKind::Usd => true,
    }
}

impl Input {
    /// The formatted text. Nothing is written.
    ///
    /// # Errors
    /// If it can't be formatted.
    pub fn format_text(&mut self) -> Result<String, FormatTextError> {
        let file = self.file_id().ok_or(FormatTextError::Reported)?;
        let (name, bytes) = (self.map().name(file), self.map().bytes(file));
        if let Some(diagnostic) = front::foreign(name, bytes) {
            self.push(diagnostic);
            return Err(FormatTextError::Reported);
        }
        if SourceKind::of(name, bytes) != SourceKind::Scene {
            return Err(FormatTextError::NoText);
        }
        if !course::is_scene_text(bytes) {
            return Err(FormatTextError::NoScene);
        }
        let mut sink = diag::DiagnosticSink::default();
        let formatted = course::format_text(file, self.map(), &mut sink);
        for diagnostic in sink.kept() {
            self.push(diagnostic.clone());
        }
        formatted.map_err(|error| match error {
            FormatTextFault::Mistakes => FormatTextError::Reported,
            FormatTextFault::Differs => FormatTextError::Differs,
        })
    }
}
