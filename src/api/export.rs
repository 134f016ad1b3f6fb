//! Scenes as files of other programs.

use super::scene::SceneRun;
use super::{Diagnostic, Error, Options, Scene};
use rtc_pipeline::{ExportFormat, ExportedFiles, RenderObserver, sidecar_folder};
use std::path::Path;

/// A scene as a file, with the files that it names; [`Scene::export`] makes it.
///
/// ```
/// use rtc::{Camera, Phong, Scene, SceneBuilder, Shape};
///
/// let mut builder = SceneBuilder::new(Camera::look_at([0.0, 0.0, 6.0], [0.0; 3]));
/// builder.add(Shape::sphere([0.0; 3], 1.0), Phong::default());
/// let scene = builder.build().unwrap();
/// let export = scene.export("ball.yaml")?;
/// let file = (export.name().to_owned(), export.bytes().to_vec());
/// let again = Scene::from_files("ball.yaml", [file])?;
/// assert_eq!(again.tree().unwrap().objects().len(), 1);
/// # Ok::<(), rtc::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Export {
    name: String,
    written: ExportedFiles,
    diagnostics: Vec<Diagnostic>,
}

impl Scene {
    /// The scene as a file of this name, whose extension is the format: `.json` (the IR as text),
    /// `.rtir` (the IR), `.yaml`, `.glb`, `.gltf`, `.xml` (Mitsuba), `.pbrt` or `.pov`. The bytes
    /// are those of `rtc compile`.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the scene has errors or the format lacks something of it,
    /// [`Error::Refused`] if there is no format of this extension.
    pub fn export(&self, name: &str) -> Result<Export, Error> {
        self.run().export(name)
    }
}

impl SceneRun<'_> {
    fn export(mut self, name: &str) -> Result<Export, Error> {
        let refused = |reason: &str| Error::Refused(format!("`{name}` can't be written: {reason}"));
        let format = ExportFormat::of(name).ok_or_else(|| {
            refused(&format!(
                "its extension is not {}",
                ExportFormat::extensions()
            ))
        })?;
        let folder = sidecar_folder(Path::new(name)).ok_or_else(|| refused("it has no name"))?;
        // Other renderers get the scene without its exposure, which need not be measured then.
        let options = match format.is_of_renderer() {
            true => Options::new().exposure(0.0),
            false => Options::new(),
        };
        let mut setup = options.setup()?;
        let mut subject = self.validate(&options, &mut setup)?;
        // What is written has the light of its picture, and where rtc reads them its display
        // settings.
        let observer = RenderObserver {
            on_step: &|_| (),
            is_stopped: &|| false,
        };
        let lit = setup.light(&mut subject, &mut self.input, &observer);
        lit.map_err(|error| self.error(error))?;
        if !format.is_of_renderer() {
            subject.validated.lowered.scene.display = setup.look.as_display();
        }
        let written = self.input.write_scene(&subject.validated, format, &folder);
        let written = written.map_err(|reason| refused(&reason))?;
        let diagnostics = self.diagnostics();
        match written {
            Some(written) => Ok(Export {
                name: name.to_owned(),
                written,
                diagnostics,
            }),
            None => Err(Error::Invalid(diagnostics)),
        }
    }
}

impl Export {
    /// The name of the file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The bytes of the file.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.written.bytes
    }

    /// The other files, by their paths from the folder of the file, with `/`.
    pub fn files(&self) -> impl Iterator<Item = (&str, &[u8])> {
        let files = self.written.files.iter();
        files.map(|(name, bytes)| (name.as_str(), bytes.as_slice()))
    }

    /// The approximated and missing parts of the file, besides warnings and notes about the scene.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// Writes the file in a folder, after the files that it names.
    ///
    /// # Errors
    /// [`Error::Unwritable`] if writing fails.
    #[cfg(not(target_family = "wasm"))]
    pub fn save(&self, folder: impl AsRef<Path>) -> Result<(), Error> {
        let folder = folder.as_ref();
        let save = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            let parent = path.parent().unwrap_or(folder);
            let made = std::fs::create_dir_all(parent);
            let written = made.and_then(|()| rtc_pipeline::AtomicFile::save(&path, bytes));
            written.map_err(|error| Error::Unwritable { path, error })
        };
        for (name, bytes) in self.files() {
            save(name, bytes)?;
        }
        save(&self.name, self.bytes())
    }
}
