//! Scenes as files in memory, for other programs.

use super::{Input, ValidatedScene};
use rtc_codec::{self as codec, Encoding};
use rtc_emit as emit;
use std::collections::BTreeMap;
use std::path::Path;

/// A format in which a scene is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportFormat {
    /// The IR as text.
    Ir,
    /// The IR in its container.
    IrBinary,
    /// The canonical spelling of a scene text.
    Text,
    /// glTF in one file.
    Glb,
    /// glTF with files beside it.
    Gltf,
    /// A Mitsuba scene.
    Mitsuba,
    /// A pbrt-v4 scene.
    Pbrt,
    /// A POV-Ray scene.
    Pov,
}

/// The extensions of files, each with its format.
const EXTENSIONS: [(&str, ExportFormat); 9] = [
    ("json", ExportFormat::Ir),
    ("rtir", ExportFormat::IrBinary),
    ("yaml", ExportFormat::Text),
    ("yml", ExportFormat::Text),
    ("glb", ExportFormat::Glb),
    ("gltf", ExportFormat::Gltf),
    ("xml", ExportFormat::Mitsuba),
    ("pbrt", ExportFormat::Pbrt),
    ("pov", ExportFormat::Pov),
];

impl ExportFormat {
    /// The format of a file, by the extension of its name.
    #[must_use]
    pub fn of(name: &str) -> Option<Self> {
        let extension = Path::new(name).extension()?.to_str()?;
        let known = EXTENSIONS.iter().find(|(known, _)| *known == extension);
        known.map(|(_, format)| *format)
    }

    /// The extensions of all formats, as a phrase.
    #[must_use]
    pub fn extensions() -> String {
        let names: Vec<_> = EXTENSIONS
            .iter()
            .map(|(name, _)| format!(".{name}"))
            .collect();
        let (last, first) = names.split_last().expect("there are formats");
        format!("{} or {last}", first.join(", "))
    }

    /// Whether another renderer reads the format: the light that `rtc render` adds to a scene is
    /// written, too.
    #[must_use]
    pub fn is_of_renderer(self) -> bool {
        matches!(self, Self::Mitsuba | Self::Pbrt | Self::Pov)
    }
}

/// A scene as a file, with the files that it names.
#[derive(Clone, Debug, Default)]
pub struct ExportedFiles {
    /// The bytes of the file.
    pub bytes: Vec<u8>,
    /// The other files, by their paths from its folder, with `/`.
    pub files: BTreeMap<String, Vec<u8>>,
}

/// The name of the folder for the files of a scene, beside its file at `path`; `None` without a
/// file name.
#[must_use]
pub fn sidecar_folder(path: &Path) -> Option<String> {
    let stem = path.file_stem()?.to_string_lossy();
    let allowed = |letter: char| letter.is_alphanumeric() || "-_. ".contains(letter);
    let stem: String = stem
        .chars()
        .map(|letter| if allowed(letter) { letter } else { '_' })
        .collect();
    Some(format!("{stem}.files"))
}

impl Input {
    /// Writes the scene in a format, with the files that it names in `folder`. `None` if it can't
    /// be exported, with an error diagnostic.
    ///
    /// # Errors
    /// Why a scene text or the IR can't express it.
    pub fn write_scene(
        &mut self,
        validated: &ValidatedScene,
        format: ExportFormat,
        folder: &str,
    ) -> Result<Option<ExportedFiles>, String> {
        let (lowered, scene) = (&validated.lowered, &validated.lowered.scene);
        // IR and text of other renderers are one file.
        let alone = |bytes| ExportedFiles {
            bytes,
            files: BTreeMap::new(),
        };
        let encoded = |encoding| {
            let bytes = codec::encode(encoding, scene);
            let bytes = bytes.map_err(|codec::NonFiniteNumber| "a number is not finite".to_owned());
            bytes.map(|bytes| Some(alone(bytes)))
        };
        match format {
            ExportFormat::Ir => encoded(Encoding::Json),
            ExportFormat::IrBinary => encoded(Encoding::Binary),
            // The course format has images and meshes beside it.
            ExportFormat::Text => {
                let written = match self.has_original_files(lowered) {
                    true => emit::course::emit_with_files(scene, Some(folder)),
                    false => emit::course::emit_elsewhere(scene, folder),
                }?;
                let file =
                    |file: emit::course::SidecarFile<'_>| Ok((file.name.clone(), file.bytes()?));
                Ok(Some(ExportedFiles {
                    bytes: written.text.into_bytes(),
                    files: written
                        .files
                        .into_iter()
                        .map(file)
                        .collect::<Result<_, String>>()?,
                }))
            }
            // Only the text form of glTF has files beside it.
            ExportFormat::Glb | ExportFormat::Gltf => {
                let folder = (format == ExportFormat::Gltf).then_some(folder);
                let Some(asset) = self.gltf(lowered, None, folder) else {
                    return Ok(None);
                };
                let mut bytes = Vec::new();
                let written = asset.write(&mut bytes);
                written.map_err(|error| error.to_string())?;
                let files = asset.files();
                let files = files.map(|(name, bytes)| (name.to_owned(), bytes.to_vec()));
                Ok(Some(ExportedFiles {
                    bytes,
                    files: files.collect(),
                }))
            }
            ExportFormat::Mitsuba | ExportFormat::Pbrt | ExportFormat::Pov => {
                let exported = self.export(lowered, format, Some(folder));
                Ok(exported.map(|exported| ExportedFiles {
                    bytes: exported.text.into_bytes(),
                    files: exported.files,
                }))
            }
        }
    }
}
