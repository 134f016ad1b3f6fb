//! The text of a scene as it is laid out; scenes that are no texts of people are not.

use super::Input;
use rtc_codec as codec;
use rtc_diag as diag;
use rtc_front::course;
use rtc_front::{self as front, gltf, mesh};
use rtc_source::tree::yaml::LayoutFault;

/// Why a scene is not laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LaidOutFault {
    /// What is wrong with it is among the findings.
    Findings,
    /// It is an asset, a mesh or IR.
    NoText,
    /// It would say something else.
    Differs,
}

/// What kind of scene a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SourceKind {
    /// One that people write, YAML or JSON.
    Scene,
    /// IR.
    Ir,
    /// An asset, or a mesh.
    Other,
}

impl SourceKind {
    /// That of a file of this name and these bytes.
    #[must_use]
    pub fn of(name: &str, bytes: &[u8]) -> Self {
        let is_asset = || gltf::recognise(name, bytes) || mesh::recognise(name, bytes);
        match codec::detect_format(bytes) {
            Some(_) => Self::Ir,
            None if is_asset() => Self::Other,
            None => Self::Scene,
        }
    }
}

impl Input {
    /// The text in the layout of the house. Nothing is written.
    ///
    /// # Errors
    /// If it has none.
    pub fn lay_out(&mut self) -> Result<String, LaidOutFault> {
        let file = self.file_id().ok_or(LaidOutFault::Findings)?;
        let (name, bytes) = (self.map().name(file), self.map().bytes(file));
        if let Some(finding) = front::foreign(name, bytes) {
            self.push(finding);
            return Err(LaidOutFault::Findings);
        }
        if SourceKind::of(name, bytes) != SourceKind::Scene {
            return Err(LaidOutFault::NoText);
        }
        let mut sink = diag::Sink::default();
        let laid_out = course::lay_out(file, self.map(), &mut sink);
        for finding in sink.kept() {
            self.push(finding.clone());
        }
        laid_out.map_err(|fault| match fault {
            LayoutFault::Mistakes => LaidOutFault::Findings,
            LayoutFault::Differs => LaidOutFault::Differs,
        })
    }
}
