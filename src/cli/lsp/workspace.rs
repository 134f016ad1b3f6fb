//! The texts that an editor has open: what happens to them, and telling what is found in them.

use super::super::args::Reading;
use super::findings::{self, FileFindings};
use super::open_text::OpenText;
use super::text::Columns;
use super::way::Vocabulary;
use crate::codec;
use crate::front::course;
use crate::pipeline::SourceKind;
use lsp_server::{Message, Notification};
use lsp_types::notification::{self, Notification as _};
use lsp_types::{
    Diagnostic, DidChangeTextDocumentParams, DidCloseTextDocumentParams, DidOpenTextDocumentParams,
    PublishDiagnosticsParams, Uri,
};
use serde::de::DeserializeOwned;
use serde_json::Value;

/// The texts that are open, and what is needed to answer questions about them.
pub(super) struct Workspace {
    pub(super) reading: Reading,
    pub(super) columns: Columns,
    documents: Vec<OpenText>,
    scenes: Vocabulary,
    ir: Vocabulary,
    nothing: Vocabulary,
}

impl Workspace {
    /// An empty one; texts are read so.
    pub(super) fn new(reading: Reading) -> Self {
        Self {
            reading,
            columns: Columns::Utf16,
            documents: Vec::new(),
            scenes: Vocabulary::new(course::schema()),
            ir: Vocabulary::new(codec::schema()),
            nothing: Vocabulary::new(Value::Null),
        }
    }

    /// Has columns counted so.
    pub(super) fn count_columns(&mut self, columns: Columns) {
        self.columns = columns;
    }

    /// A text that is open.
    pub(super) fn document(&self, uri: &Uri) -> Option<&OpenText> {
        self.documents.iter().find(|own| own.uri == *uri)
    }

    /// A text that is open, to be changed.
    pub(super) fn document_mut(&mut self, uri: &Uri) -> Option<&mut OpenText> {
        self.documents.iter_mut().find(|own| own.uri == *uri)
    }

    /// The words of a text's format.
    pub(super) fn vocabulary(&self, document: &OpenText) -> &Vocabulary {
        match document.kind() {
            SourceKind::Scene => &self.scenes,
            SourceKind::Ir => &self.ir,
            SourceKind::Other => &self.nothing,
        }
    }

    /// Takes note of what happened in the editor, and returns what there is to tell; what is not as it
    /// should be is passed over.
    pub(super) fn note(&mut self, own: Notification) -> Vec<Message> {
        let Notification { method, params } = own;
        match method.as_str() {
            notification::DidOpenTextDocument::METHOD => self.open(params),
            notification::DidChangeTextDocument::METHOD => self.change(params),
            notification::DidCloseTextDocument::METHOD => {
                let closed: Option<DidCloseTextDocumentParams> = read(params);
                return closed.map_or_else(Vec::new, |own| self.close(&own.text_document.uri));
            }
            // Other files may have changed with one that was saved.
            notification::DidSaveTextDocument::METHOD
            | notification::DidChangeWatchedFiles::METHOD => {
                self.documents.iter_mut().for_each(OpenText::forget);
            }
            _ => {}
        }
        Vec::new()
    }

    fn open(&mut self, params: Value) {
        let Some(DidOpenTextDocumentParams { text_document: own }) = read(params) else {
            return;
        };
        let document = OpenText::new(own.uri, own.version, own.text);
        // What was told of it before stays known, to be taken back.
        let before = self.document_mut(&document.uri);
        match before {
            Some(before) => before.replace(document),
            None => self.documents.push(document),
        }
    }

    fn change(&mut self, params: Value) {
        let columns = self.columns;
        let Some(DidChangeTextDocumentParams {
            text_document,
            content_changes,
        }) = read(params)
        else {
            return;
        };
        if let Some(document) = self.document_mut(&text_document.uri) {
            document.change(text_document.version, content_changes, columns);
        }
    }

    /// Closes a text and takes back what was found in it.
    fn close(&mut self, uri: &Uri) -> Vec<Message> {
        let Some(at) = self.documents.iter().position(|own| own.uri == *uri) else {
            return Vec::new();
        };
        let gone = self.documents.remove(at);
        let files = gone.told.into_iter().map(|(file, _)| file);
        self.published(files.collect())
    }

    /// Checks a text that was changed, and returns what there is to tell; none if all are checked.
    pub(super) fn check_next(&mut self) -> Option<Vec<Message>> {
        let (reading, columns) = (&self.reading, self.columns);
        let waits = |own: &&mut OpenText| own.checked.is_none();
        let document = self.documents.iter_mut().find(waits)?;
        document.check(reading);
        let found = findings::diagnostics(document, columns);
        let before = std::mem::replace(&mut document.told, found);
        let mut files: Vec<Uri> = before.into_iter().map(|(file, _)| file).collect();
        files.extend(document.told.iter().map(|(file, _)| file.clone()));
        Some(self.published(files))
    }

    /// All that is found in some files, in whatever text it shows.
    fn published(&self, mut files: Vec<Uri>) -> Vec<Message> {
        files.sort_by(|a, b| a.as_str().cmp(b.as_str()));
        files.dedup();
        let publish = |file: Uri| {
            let mut all: Vec<Diagnostic> = Vec::new();
            let told = self.documents.iter().flat_map(|own| &own.told);
            let of_file = told.filter(|(own, _): &&FileFindings| *own == file);
            for diagnostic in of_file.flat_map(|(_, list)| list) {
                if !all.contains(diagnostic) {
                    all.push(diagnostic.clone());
                }
            }
            let version = self.document(&file).map(|own| own.version);
            let params = PublishDiagnosticsParams::new(file, all, version);
            let method = notification::PublishDiagnostics::METHOD.to_owned();
            Message::Notification(Notification::new(method, params))
        };
        files.into_iter().map(publish).collect()
    }
}

fn read<P: DeserializeOwned>(params: Value) -> Option<P> {
    serde_json::from_value(params).ok()
}
