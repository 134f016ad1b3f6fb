//! The files that a stage names: layers, which are read once each, and pictures.

use super::layer::Layer;
use super::package::{self, UsdzError, UsdzPackage};
use super::text::LayerParseError;
use super::{Lowering, binary, text};
use crate::exchange::SpannedText;
use rtc_diag::{Code, Diagnostic, Severity, clip_path, codes};
use rtc_source::{
    FileId, FileKind, FileSearch, LimitExceeded, Loader, MissingFile, Resource, Span,
};
use std::rc::Rc;

/// The most files that are looked for.
const MAX_FILES: usize = 1 << 14;
/// The largest file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

const LAYERS: FileKind = FileKind {
    extensions: &super::EXTENSIONS,
    begins: super::begins_layer,
};

/// Where a layer comes from, and where its files are looked for.
#[derive(Clone, Debug)]
pub(super) struct LayerOrigin {
    search: Rc<FileSearch>,
    /// The package and the path in it.
    package: Option<(FileId, String)>,
}

/// A file that was found: its bytes are in the map, or not yet.
enum LayerFile {
    Found(rtc_source::FoundFile),
    InPackage(FileId, String),
}

impl LayerFile {
    /// What distinguishes a file from others.
    fn key(&self) -> String {
        match self {
            Self::Found(found) => found.path.display().to_string(),
            Self::InPackage(package, inside) => format!("{package:?}[{inside}]"),
        }
    }
}

impl Lowering<'_> {
    /// The layer of the stage itself, with the folders that the user allows.
    pub(super) fn open_root(&mut self, file: FileId) -> Option<usize> {
        let options = self.options;
        let folder = self.map.folder(file);
        let search = FileSearch::new(folder, options.asset_root.as_deref())
            .with_parent(folder, options.home.as_deref());
        let origin = LayerOrigin {
            search: Rc::new(search),
            package: None,
        };
        let span = Span::new(file, 0, 0);
        let key = self.map.name(file).to_owned();
        let name = std::path::Path::new(&key).file_name();
        let path = folder
            .zip(name)
            .map(|(folder, name)| folder.path().join(name));
        let path = path.map(|path| path.display().to_string());
        if let Some(key) = &path {
            self.loaded.insert(key.clone(), Some(file));
        }
        let root = self.open_file(file, origin, span, Severity::Error)?;
        if let Some(key) = path {
            self.layer_keys.insert(key, Some(root));
        }
        Some(root)
    }

    /// The layer that another one names; `None` without it, which is reported.
    pub(super) fn open_layer(&mut self, path: &SpannedText, from: usize) -> Option<usize> {
        let name = (from, path.text.clone());
        if let Some(known) = self.named_layers.get(&name) {
            return *known;
        }
        let layer = self.find_layer(path, from);
        self.named_layers.insert(name, layer);
        layer
    }

    fn find_layer(&mut self, path: &SpannedText, from: usize) -> Option<usize> {
        const INSTEAD: &str = "what it holds is left out";
        let origin = self.layer_origins[from].clone();
        let place = self.locate(path, &origin, &LAYERS, INSTEAD)?;
        let key = place.key();
        if let Some(known) = self.layer_keys.get(&key) {
            return *known;
        }
        let file = self.loaded(&place, path, INSTEAD);
        let layer = file.and_then(|file| {
            let origin = match place {
                LayerFile::Found(_) => self.origin_of(file),
                LayerFile::InPackage(package, inside) => LayerOrigin {
                    package: Some((package, inside)),
                    ..origin
                },
            };
            self.open_file(file, origin, path.span, Severity::Warning)
        });
        self.layer_keys.insert(key, layer);
        layer
    }

    /// The file of the map with the bytes of a place, which are read once.
    fn loaded(&mut self, place: &LayerFile, path: &SpannedText, instead: &str) -> Option<FileId> {
        let key = place.key();
        if let Some(known) = self.loaded.get(&key) {
            return *known;
        }
        let bytes = self.bytes_of(place, path, instead);
        let file = bytes.map(|bytes| match place {
            LayerFile::Found(found) => self.map.add_found(found, bytes),
            LayerFile::InPackage(package, inside) => {
                let name = format!("{}[{inside}]", self.map.name(*package));
                self.map.add_unpacked(name, bytes)
            }
        });
        self.loaded.insert(key, file);
        file
    }

    /// The folders of a layer that was found: its own, and those of the stage.
    fn origin_of(&self, file: FileId) -> LayerOrigin {
        let root = self.map.folder(self.root_file);
        let allowed = match &self.options.asset_root {
            Some(folder) => Some(folder.clone()),
            None => root.map(rtc_source::Folder::path),
        };
        let search = FileSearch::new(self.map.folder(file), allowed.as_deref());
        LayerOrigin {
            search: Rc::new(search),
            package: None,
        }
    }

    /// A file as a layer; of a package its first file, which may be a package itself.
    fn open_file(
        &mut self,
        mut file: FileId,
        mut origin: LayerOrigin,
        span: Span,
        severity: Severity,
    ) -> Option<usize> {
        while package::is_package(self.map.bytes(file)) {
            let first = self.package(file, span, severity)?.first.clone();
            let path = SpannedText {
                text: first.clone(),
                span,
            };
            let place = LayerFile::InPackage(file, first.clone());
            origin.package = Some((file, first));
            file = self.loaded(&place, &path, "")?;
        }
        if !super::begins_layer(self.map.bytes(file)) {
            let name = self.map.name(file);
            let name = clip_path(name.rsplit('/').next().unwrap_or(name));
            let message = format!("`{name}` does not begin as a layer of USD does");
            let diagnostic = Diagnostic::new(&codes::USD_SYNTAX, message)
                .hint("the first line of a text is `#usda 1.0`");
            self.sink.push(diagnostic.severity(severity).at(span, ""));
            return None;
        }
        self.read_layer(file, origin, span)
    }

    fn package(&mut self, file: FileId, span: Span, severity: Severity) -> Option<Rc<UsdzPackage>> {
        if let Some(known) = self.packages.get(&file) {
            return known.clone();
        }
        let read = UsdzPackage::read(self.map.bytes(file), self.map.budget());
        let name = clip_path(self.map.name(file)).into_owned();
        let package = match read {
            Ok(package) => Some(Rc::new(package)),
            Err(UsdzError::Damaged(why)) => {
                let message = format!("the package `{name}` cannot be read: {why}");
                let diagnostic = Diagnostic::new(&codes::USD_DAMAGED, message);
                self.sink.push(diagnostic.severity(severity).at(span, ""));
                None
            }
            Err(UsdzError::Limit(fault)) => {
                self.exhaust(fault, span);
                None
            }
        };
        self.packages.insert(file, package.clone());
        package
    }

    /// A copy of a part of a file, whose memory is charged.
    fn copied(
        &mut self,
        file: FileId,
        range: std::ops::Range<usize>,
        span: Span,
    ) -> Option<Vec<u8>> {
        self.charge(Resource::Memory, range.len() as u64, span)?;
        self.map.bytes(file).get(range).map(<[u8]>::to_vec)
    }

    fn read_layer(&mut self, file: FileId, origin: LayerOrigin, span: Span) -> Option<usize> {
        let (bytes, budget) = (self.map.bytes(file), self.map.budget());
        let read = match binary::is_binary(bytes) {
            true => binary::read(file, bytes, budget),
            false => text::read(file, bytes, budget),
        };
        match read {
            Ok(layer) => Some(self.add_layer(layer, origin)),
            Err(LayerParseError::Mistakes(mistakes)) => {
                for (span, message) in mistakes {
                    self.report(&codes::USD_SYNTAX, span, message);
                }
                None
            }
            Err(LayerParseError::Damaged(why)) => {
                let name = clip_path(self.map.name(file)).into_owned();
                let message = format!("the layer `{name}` cannot be read: {why}");
                self.report(&codes::USD_DAMAGED, span, message);
                None
            }
            Err(LayerParseError::Limit(fault)) => {
                self.exhaust(fault, span);
                None
            }
        }
    }

    fn add_layer(&mut self, layer: Layer, origin: LayerOrigin) -> usize {
        if layer.prim(0).has_relocates {
            let span = layer.prim(0).span;
            let message = "the relocation of the layer is not supported: prims stay where they are";
            self.report(&codes::USD_UNSUPPORTED, span, message);
        }
        self.layers.push(Rc::new(layer));
        self.layer_origins.push(origin);
        self.layers.len() - 1
    }

    /// Finds a file of a kind; without it a warning says what is used `instead`.
    fn locate(
        &mut self,
        path: &SpannedText,
        origin: &LayerOrigin,
        kind: &FileKind,
        instead: &str,
    ) -> Option<LayerFile> {
        // A file of a package is named by brackets: `a.usdz[b.usda]`.
        let mut origin = origin.clone();
        let mut text = path.text.as_str();
        while let Some((outer, inner)) = package::bracketed(text) {
            let outer = SpannedText {
                text: outer.to_owned(),
                span: path.span,
            };
            let place = self.locate_in(&outer, &origin, &LAYERS, instead)?;
            let file = self.loaded(&place, &outer, instead)?;
            self.package(file, path.span, Severity::Warning)?;
            origin.package = Some((file, String::new()));
            text = inner;
        }
        let inner = SpannedText {
            text: text.to_owned(),
            span: path.span,
        };
        self.locate_in(&inner, &origin, kind, instead)
    }

    /// Finds a file in one folder or package.
    fn locate_in(
        &mut self,
        path: &SpannedText,
        origin: &LayerOrigin,
        kind: &FileKind,
        instead: &str,
    ) -> Option<LayerFile> {
        let name = clip_path(&path.text);
        let diagnostic = match self.find(&path.text, origin, kind, path.span)? {
            Ok(place) => return Some(place),
            Err(MissingFile::Outside(_)) => {
                let message = format!("`{name}` leaves the folder of the stage");
                let hint = "permit the folder of its files with `--asset-root FOLDER`";
                Diagnostic::new(&codes::FILE_OUTSIDE, message).hint(hint)
            }
            Err(MissingFile::NoFolder | MissingFile::Absent(_)) => {
                Diagnostic::new(&codes::FILE_NOT_FOUND, format!("there is no file `{name}`"))
            }
        };
        self.without(diagnostic, path.span, instead);
        None
    }

    /// Looks for a file in one folder or package; `None` if too many were looked for, which is
    /// reported.
    fn find(
        &mut self,
        path: &str,
        origin: &LayerOrigin,
        kind: &FileKind,
        span: Span,
    ) -> Option<Result<LayerFile, MissingFile>> {
        if self.lookups >= MAX_FILES {
            if self.lookups == MAX_FILES {
                let message =
                    format!("more than {MAX_FILES} files are named: the rest is left out");
                self.report(&codes::USD_UNSUPPORTED, span, message);
            }
            self.lookups = MAX_FILES + 1;
            return None;
        }
        self.lookups += 1;
        let Some((file, from)) = &origin.package else {
            return Some(origin.search.find(path, kind).map(LayerFile::Found));
        };
        let inside = package::joined(from, path);
        let package = self.packages.get(file).cloned().flatten();
        let is_there = package.is_some_and(|package| package.file(&inside).is_some());
        Some(match is_there {
            true => Ok(LayerFile::InPackage(*file, inside)),
            false => Err(MissingFile::Absent(Vec::new())),
        })
    }

    /// Whether there is a file of a kind that a layer may name.
    pub(super) fn exists(&mut self, path: &SpannedText, from: usize, kind: &FileKind) -> bool {
        let origin = self.layer_origins[from].clone();
        let found = self.find(&path.text, &origin, kind, path.span);
        matches!(found, Some(Ok(_)))
    }

    fn bytes_of(
        &mut self,
        place: &LayerFile,
        path: &SpannedText,
        instead: &str,
    ) -> Option<Vec<u8>> {
        match place {
            LayerFile::InPackage(file, inside) => {
                let package = self.packages.get(file).cloned().flatten()?;
                self.copied(*file, package.file(inside)?, path.span)
            }
            LayerFile::Found(found) => {
                let read = Loader.found(found, MAX_BYTES, self.map);
                if let Err(error) = &read {
                    let message = format!("can't read `{}`: {error}", clip_path(&path.text));
                    let diagnostic = Diagnostic::new(&codes::CANNOT_READ, message);
                    self.without(diagnostic, path.span, instead);
                }
                read.ok()
            }
        }
    }

    /// The bytes of a file of another kind that a layer names.
    pub(super) fn file(
        &mut self,
        path: &SpannedText,
        from: usize,
        kind: &FileKind,
        instead: &str,
    ) -> Option<Vec<u8>> {
        let origin = self.layer_origins[from].clone();
        let place = self.locate(path, &origin, kind, instead)?;
        self.bytes_of(&place, path, instead)
    }

    /// Reports a file without which the picture is made: a warning that says how.
    pub(super) fn without(&mut self, mut diagnostic: Diagnostic, span: Span, instead: &str) {
        diagnostic.message = format!("{}: {instead}", diagnostic.message);
        self.sink.push(
            diagnostic
                .severity(Severity::Warning)
                .at(span, "named here"),
        );
    }

    /// Reports at a place.
    pub(super) fn report(&mut self, code: &'static Code, span: Span, message: impl Into<String>) {
        self.sink.push(Diagnostic::new(code, message).at(span, ""));
    }

    /// Charges the budget. If it is used up, that is reported in the end and nothing more is read.
    pub(super) fn charge(&self, resource: Resource, amount: u64, span: Span) -> Option<()> {
        let charged = self.map.budget().charge(resource, amount);
        charged.map_err(|fault| self.exhaust(fault, span)).ok()
    }

    pub(super) fn exhaust(&self, fault: LimitExceeded, span: Span) {
        self.exceeded.get_or_init(|| (fault, span));
    }
}
