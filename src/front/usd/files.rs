//! The files that a stage names: layers, which are read once each, and pictures.

use super::layer::Layer;
use super::package::{self, UsdzError, UsdzPackage};
use super::text::LayerParseError;
use super::{Lowering, binary, text};
use crate::exchange::SpannedText;
use crate::over_limit;
use rtc_diag::{Code, Diagnostic, Severity, clip_path, codes};
use rtc_source::{FileId, FileKind, FileSearch, Loader, Resource, Span};
use std::rc::Rc;

/// The most files that are looked for.
const MAX_FILES: usize = 1 << 14;
/// The largest file that is read, in bytes.
const MAX_BYTES: u64 = 1 << 30;

const LAYERS: FileKind = FileKind {
    extensions: &["usd", "usda", "usdc", "usdz"],
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
        let root = self.open_file(file, origin, key, span, Severity::Error)?;
        if let Some(path) = path {
            let key = path.display().to_string();
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
        // A file of a package is named by brackets: `a.usdz[b.usda]`.
        let (outer, inner) = match path.text.strip_suffix(']').and_then(|t| t.split_once('[')) {
            Some((outer, inner)) => (outer, Some(inner)),
            None => (path.text.as_str(), None),
        };
        let text = SpannedText {
            text: outer.to_owned(),
            span: path.span,
        };
        let origin = self.layer_origins[from].clone();
        let place = self.locate(&text, &origin, &LAYERS, INSTEAD)?;
        let mut key = match &place {
            LayerFile::Found(found) => found.path.display().to_string(),
            LayerFile::InPackage(file, path) => format!("{}[{path}]", self.map.name(*file)),
        };
        if let Some(inner) = inner {
            key = format!("{key}[{inner}]");
        }
        if let Some(known) = self.layer_keys.get(&key) {
            return *known;
        }
        let layer = self.open_place(place, &text, origin, inner, &key);
        self.layer_keys.insert(key, layer);
        layer
    }

    fn open_place(
        &mut self,
        place: LayerFile,
        text: &SpannedText,
        mut origin: LayerOrigin,
        inner: Option<&str>,
        key: &str,
    ) -> Option<usize> {
        const INSTEAD: &str = "what it holds is left out";
        let bytes = self.bytes_of(&place, text, INSTEAD)?;
        let file = match &place {
            LayerFile::Found(found) => {
                let file = self.map.add_found(found, bytes);
                origin = self.origin_of(file);
                file
            }
            LayerFile::InPackage(package, path) => {
                origin.package = Some((*package, path.clone()));
                self.map.add(key.to_owned(), bytes)
            }
        };
        if let Some(inner) = inner {
            let package = self.package(file, text.span, Severity::Warning)?;
            let range = package.file(inner)?;
            let bytes = self.copied(file, range, text.span)?;
            let layer = self.map.add(key.to_owned(), bytes);
            origin.package = Some((file, inner.to_owned()));
            return self.read_layer(layer, origin, text.span);
        }
        self.open_file(file, origin, key.to_owned(), text.span, Severity::Warning)
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

    /// A file as a layer; of a package its first file.
    fn open_file(
        &mut self,
        file: FileId,
        mut origin: LayerOrigin,
        key: String,
        span: Span,
        severity: Severity,
    ) -> Option<usize> {
        let bytes = self.map.bytes(file);
        if !super::begins_layer(bytes) {
            let name = clip_path(self.map.name(file)).into_owned();
            let message = format!("`{name}` is no layer of USD: what it holds is left out");
            self.report(&codes::USD_UNSUPPORTED, span, message);
            return None;
        }
        if !package::is_package(bytes) {
            return self.read_layer(file, origin, span);
        }
        let package = self.package(file, span, severity)?;
        let first = package.first.clone();
        let range = package.file(&first)?;
        let bytes = self.copied(file, range, span)?;
        origin.package = Some((file, first.clone()));
        let layer = self.map.add(format!("{key}[{first}]"), bytes);
        self.read_layer(layer, origin, span)
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
                self.exhaust(&fault, span);
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
                self.exhaust(&fault, span);
                None
            }
        }
    }

    fn add_layer(&mut self, layer: Layer, origin: LayerOrigin) -> usize {
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
        if self.lookups >= MAX_FILES {
            if self.lookups == MAX_FILES {
                let message =
                    format!("more than {MAX_FILES} files are named: the rest is left out");
                self.report(&codes::USD_UNSUPPORTED, path.span, message);
            }
            self.lookups = MAX_FILES + 1;
            return None;
        }
        self.lookups += 1;
        if let Some((file, from)) = &origin.package {
            let inside = package::joined(from, &path.text);
            let package = self.packages.get(file).cloned().flatten();
            if package.is_some_and(|package| package.file(&inside).is_some()) {
                return Some(LayerFile::InPackage(*file, inside));
            }
        } else if let Ok(found) = origin.search.find(&path.text, kind) {
            return Some(LayerFile::Found(found));
        }
        let message = format!("there is no file `{}`", clip_path(&path.text));
        self.without(
            Diagnostic::new(&codes::FILE_NOT_FOUND, message),
            path.span,
            instead,
        );
        None
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
        let bytes = self.bytes_of(&place, path, instead)?;
        if matches!(place, LayerFile::Found(_)) {
            self.map.budget().read(bytes.len());
        }
        Some(bytes)
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

    /// Charges the budget. If it is used up, that is reported once and nothing more is read.
    pub(super) fn charge(&mut self, resource: Resource, amount: u64, span: Span) -> Option<()> {
        let charged = self.map.budget().charge(resource, amount);
        charged.map_err(|fault| self.exhaust(&fault, span)).ok()
    }

    pub(super) fn exhaust(&mut self, fault: &rtc_source::LimitExceeded, span: Span) {
        if !self.is_exhausted {
            self.sink.push(over_limit("the stage", fault).at(span, ""));
        }
        self.is_exhausted = true;
    }
}
