//! Loads the MTL files that an OBJ names.
//!
//! `crate::mesh::mtl` parses a library. [`MtlCache`] adds its materials to the scene, each once,
//! and collects the images that they need. A material becomes a Phong material (`phong`), or a
//! `standard` material if the scene is path traced (`standard`). Textures of a `standard` material
//! that combine several images are baked after these are loaded ([`bake()`]).
//!
//! Missing libraries, images and materials are warnings: the mesh keeps the material of the scene,
//! or is grey. Statements without effect are reported once per library, with their number.

mod bake;
mod cache;
mod phong;
mod standard;

pub(super) use bake::bake;
pub(super) use cache::MtlCache;

use super::mesh::MeshFile;
use super::text_file::TextFileKind;
use super::{AssetLoader, AssetTarget, MissingAssetPolicy, PendingAsset};
use crate::mesh::SpannedName;
use crate::mesh::mtl::{MtlLibrary, is_mtl, parse};
use cache::sibling_path;
use phong::weight;
use rtc_diag::{Diagnostic, Severity, codes};
use rtc_ir::{LoweredScene, MaterialId, Mode};
use rtc_source::{FileId, FileKind, Span};

/// The file formats of MTL libraries.
pub(super) const TEXT: TextFileKind = TextFileKind {
    entity: "material",
    is_not: "no MTL",
    code: &codes::BAD_MTL,
    policy: MissingAssetPolicy::Materials,
    max_bytes: 1 << 24,
    file: FileKind {
        extensions: &["mtl"],
        begins: is_mtl,
    },
};

/// A parsed MTL library and its file.
struct LoadedLibrary {
    library: MtlLibrary,
    file: FileId,
    /// Its path relative to the searched folder.
    path: String,
}

impl MeshFile {
    /// The libraries that the mesh file names and that exist.
    fn libraries<'a>(
        &'a self,
        loader: &'a AssetLoader<'_>,
    ) -> impl Iterator<Item = (PendingAsset, &'a SpannedName)> {
        let pending = |named: &SpannedName| PendingAsset {
            target: AssetTarget::Materials,
            path: sibling_path(&self.path, &named.text),
            span: Some(named.at.span(self.file)),
        };
        let named = self
            .material_use
            .libraries
            .iter()
            .map(move |named| (pending(named), named));
        named.filter(|(pending, _)| loader.search.find(&pending.path, &TEXT.file).is_ok())
    }

    /// Whether the mesh file has a texture or uses materials of an existing library.
    pub(super) fn has_library(&self, loader: &AssetLoader<'_>) -> bool {
        let names_any = || self.material_use.names_any();
        self.texture.is_some() || (names_any() && self.libraries(loader).next().is_some())
    }

    /// The material in the scene for each `usemtl` name; `None` if there is none at all.
    pub(super) fn materials(
        &self,
        cache: &mut MtlCache,
        lowered: &mut LoweredScene,
        loader: &mut AssetLoader<'_>,
    ) -> Option<Vec<Option<MaterialId>>> {
        if let Some(texture) = &self.texture {
            return Some(vec![Some(cache.add_textured(self, texture, lowered))]);
        }
        if !self.material_use.names_any() {
            return None;
        }
        // Load the libraries.
        let libraries = self.read_libraries(loader);
        if libraries.is_empty() {
            return None;
        }
        // Add the materials that the faces use.
        let mut materials = Vec::with_capacity(self.material_use.materials.len());
        let mut unknown: Option<(&SpannedName, usize)> = None;
        for named in &self.material_use.materials {
            let definition = libraries
                .iter()
                .find_map(|loaded| Some((loaded, loaded.library.materials.get(&named.text)?)));
            if definition.is_none() && !named.text.is_empty() {
                unknown.get_or_insert((named, 0)).1 += 1;
            }
            materials
                .push(definition.map(|(loaded, material)| cache.add(loaded, material, lowered)));
        }
        // Report undefined materials.
        if let Some((first, count)) = unknown {
            let more = match count {
                1 => String::new(),
                _ => format!(", nor {} more that faces ask for", count - 1),
            };
            let message = format!("the MTL has no material `{}`{more}", first.text);
            let diagnostic = Diagnostic::new(&codes::BAD_MTL, message);
            loader
                .sink
                .push(diagnostic.at(first.at.span(self.file), "faces have no material"));
        }
        cache.report(loader.sink);
        self.report_mirrors(&libraries, lowered, loader);
        materials.iter().any(Option::is_some).then_some(materials)
    }

    fn read_libraries(&self, loader: &mut AssetLoader<'_>) -> Vec<LoadedLibrary> {
        let pending_assets: Vec<_> = self.libraries(loader).map(|(pending, _)| pending).collect();
        if let (true, Some(named)) = (
            pending_assets.is_empty(),
            self.material_use.libraries.first(),
        ) {
            let message = format!(
                "there is no file `{}`; {}",
                named.text,
                MissingAssetPolicy::Materials.consequence()
            );
            let diagnostic = Diagnostic::new(&codes::BAD_MTL, message);
            loader
                .sink
                .push(diagnostic.at(named.at.span(self.file), "not found"));
        }
        let mut libraries = Vec::new();
        for pending in pending_assets {
            let Some(found) = loader.find(&pending, MissingAssetPolicy::Materials) else {
                continue;
            };
            let path = loader.search.path_to(&found).unwrap_or_default();
            if let Some((file, library)) = loader.read_text(&found, &pending, &TEXT, parse) {
                report(&library, file, loader);
                libraries.push(LoadedLibrary {
                    library,
                    file,
                    path,
                });
            }
        }
        libraries
    }

    /// Reports once that `Ks` acts as a mirror here although `illum` requests a highlight only.
    fn report_mirrors(
        &self,
        libraries: &[LoadedLibrary],
        lowered: &LoweredScene,
        loader: &mut AssetLoader<'_>,
    ) {
        let settings = &lowered.scene.settings;
        if settings.max_depth == 0 || settings.mode != Mode::Phong {
            return;
        }
        let definition = |loaded: &LoadedLibrary| -> Option<Span> {
            let is_used = |named: &&SpannedName| loaded.library.materials.contains_key(&named.text);
            let used = self.material_use.materials.iter().filter(is_used);
            let mut mirrors = used.filter_map(|named| {
                let material = loaded.library.materials.get(&named.text)?;
                let is_mirror = material.model.as_ref().is_some_and(|model| model.value > 2);
                let specular = material.specular.as_ref()?;
                (!is_mirror && weight(material) > 0.0).then(|| specular.at.span(loaded.file))
            });
            mirrors.next()
        };
        if let Some(span) = libraries.iter().find_map(definition) {
            let note = Diagnostic::new(
                &codes::KEY_READ_DIFFERENTLY,
                "the `Ks` of an MTL is a mirror too",
            );
            let note = note.severity(Severity::Note);
            loader.sink.push(
                note.at(span, "only a highlight in some programs")
                    .hint("`MaxRecursionDepth: 0` turns mirrors off"),
            );
        }
    }
}

/// Reports the errors and unsupported statements of a library.
fn report(library: &MtlLibrary, file: FileId, loader: &mut AssetLoader<'_>) {
    let MtlLibrary {
        materials: _,
        faults,
        not_shown,
    } = library;
    for fault in faults {
        let diagnostic = Diagnostic::new(&codes::BAD_MTL, fault.message.as_str());
        loader
            .sink
            .push(diagnostic.at(fault.span(file), fault.label.as_str()));
    }
    if let Some((first, count)) = not_shown {
        let message = match count {
            1 => format!("a statement of the MTL has no effect: {}", first.message),
            _ => format!(
                "{count} statements of the MTL have no effect: {}",
                first.message
            ),
        };
        let diagnostic = Diagnostic::new(&codes::BAD_MTL, message);
        loader
            .sink
            .push(diagnostic.at(first.span(file), first.label.as_str()));
    }
}
