//! `rtc new`: writes a first scene, with comments, from a template.

use super::Failure;
use super::args::{NewArgs, TemplateArg};
use super::interrupt::Interrupt;
use super::output::{Output, is_stdout};
use rtc_source::SourceMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The model of the glTF template.
const MODEL: &str = include_str!("model.gltf");

/// Writes the scene, and the model of the glTF template beside it. No file is overwritten.
pub(super) fn run(args: &NewArgs) -> Result<(), Failure> {
    let scene = match args.template {
        TemplateArg::Course => include_str!("course.yaml"),
        TemplateArg::Path => include_str!("path.yaml"),
        TemplateArg::Gltf => include_str!("gltf.yaml"),
        TemplateArg::Turntable => include_str!("turntable.yaml"),
    };
    let name = args.file.file_name().unwrap_or(OsStr::new("scene.yaml"));
    let name = match is_stdout(&args.file) {
        true => "scene.yaml".into(),
        false => name.to_string_lossy(),
    };
    let model = (args.template == TemplateArg::Gltf).then(|| model_path(&args.file));
    let scene = scene.replace("{file}", &name);
    let scene = match &model {
        Some(path) => scene.replace(
            "{model}",
            &path.file_name().unwrap_or_default().to_string_lossy(),
        ),
        None => scene,
    };
    let mut files = vec![(args.file.clone(), scene.as_str())];
    files.extend(model.map(|path| (path, MODEL)));
    if let Some((path, _)) = files.iter().find(|(path, _)| exists(path)) {
        let path = path.display();
        return Err(Failure::Failed(format!(
            "`{path}` exists, and is not overwritten"
        )));
    }
    let interrupt = Interrupt::listen()?;
    // The model first: without it the scene would name a file that does not exist.
    for (path, text) in files.iter().rev() {
        let output = Output::open_unless_read(path, &SourceMap::default())?;
        output.commit(text.as_bytes(), &interrupt)?;
    }
    Ok(())
}

fn exists(path: &Path) -> bool {
    !is_stdout(path) && path.symlink_metadata().is_ok()
}

/// The model beside a scene.
fn model_path(scene: &Path) -> PathBuf {
    match is_stdout(scene) {
        true => PathBuf::from("model.gltf"),
        false => scene.with_extension("gltf"),
    }
}
