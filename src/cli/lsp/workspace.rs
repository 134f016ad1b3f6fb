//! The open documents of an editor: their changes, and the publication of their diagnostics.

use super::super::args::ReadArgs;
use super::diagnostics::{self, FileDiagnostics};
use super::method;
use super::open_text::OpenText;
use super::protocol::{
    DidChangeTextDocumentParams, DidOpenTextDocumentParams, DocumentDiagnosticParams,
    DocumentDiagnosticReport, EditorDiagnostic, InsertTextFormat, Position,
    PublishDiagnosticsParams, TextDocumentParams,
};
use super::text::Columns;
use super::uri::DocumentUri;
use super::vocabulary::Vocabulary;
use lsp_server::{Message, Notification, Request, RequestId};
use rtc_codec as codec;
use rtc_front::{course, gltf};
use rtc_pipeline::SourceKind;
use rtc_source::EditedFiles;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// The open documents, with the state needed for responses.
pub(super) struct Workspace {
    pub(super) reading: ReadArgs,
    pub(super) columns: Columns,
    /// The form of whole objects in completions that the editor knows.
    pub(super) snippet_form: InsertTextFormat,
    /// Whether the editor asks for the diagnostics of open documents, so that they are not sent.
    pulls: bool,
    /// Whether the editor can be told to ask again.
    refreshes: bool,
    documents: Vec<OpenText>,
    scenes: Vocabulary,
    ir: Vocabulary,
    gltf: Vocabulary,
    nothing: Vocabulary,
}

impl Workspace {
    /// An empty one; texts are read so.
    pub(super) fn new(reading: ReadArgs) -> Self {
        Self {
            reading,
            columns: Columns::Utf16,
            snippet_form: InsertTextFormat::PLAIN_TEXT,
            pulls: false,
            refreshes: false,
            documents: Vec::new(),
            scenes: Vocabulary::new(course::schema()),
            ir: Vocabulary::new(codec::schema()),
            gltf: Vocabulary::new(gltf::schema()),
            nothing: Vocabulary::new(Value::Null),
        }
    }

    /// Adapts to what an editor offers in `initialize`; returns the units of columns.
    pub(super) fn adapt(&mut self, params: &Value) -> Columns {
        let offered = params.pointer("/capabilities/general/positionEncodings");
        let offered = offered.and_then(|own| Vec::deserialize(own).ok());
        self.columns = Columns::of(&offered.unwrap_or_default());
        let item = "/capabilities/textDocument/completion/completionItem/snippetSupport";
        if params.pointer(item) == Some(&Value::Bool(true)) {
            self.snippet_form = InsertTextFormat::SNIPPET;
        }
        let pull = params.pointer("/capabilities/textDocument/diagnostic");
        self.pulls = pull.is_some();
        let refresh = params.pointer("/capabilities/workspace/diagnostics/refreshSupport");
        self.refreshes = refresh == Some(&Value::Bool(true));
        self.columns
    }

    /// A text that is open.
    pub(super) fn document(&self, uri: &DocumentUri) -> Option<&OpenText> {
        self.documents.iter().find(|document| document.uri == *uri)
    }

    /// A text that is open, to be changed.
    pub(super) fn document_mut(&mut self, uri: &DocumentUri) -> Option<&mut OpenText> {
        self.documents
            .iter_mut()
            .find(|document| document.uri == *uri)
    }

    /// The schema of the format of a document.
    pub(super) fn vocabulary(&self, document: &OpenText) -> &Vocabulary {
        match document.kind() {
            SourceKind::Scene => &self.scenes,
            SourceKind::Ir(_) => &self.ir,
            SourceKind::Gltf if document.text.trim_start().starts_with('{') => &self.gltf,
            SourceKind::Gltf
            | SourceKind::Mesh
            | SourceKind::Mitsuba
            | SourceKind::Pbrt
            | SourceKind::Usd => &self.nothing,
        }
    }

    /// Applies a notification of the editor, and returns the messages to send; invalid ones are
    /// ignored.
    pub(super) fn note(&mut self, notification: Notification) -> Vec<Message> {
        let Notification { method, params } = notification;
        match method.as_str() {
            method::DID_OPEN => self.open(params),
            method::DID_CHANGE => self.change(params),
            method::DID_CLOSE => {
                let closed: Option<TextDocumentParams> = read(params);
                return closed
                    .map_or_else(Vec::new, |params| self.close(&params.text_document.uri));
            }
            // Other files may have changed with one that was saved.
            method::DID_SAVE | method::DID_CHANGE_WATCHED_FILES => {
                self.documents.iter_mut().for_each(OpenText::forget);
            }
            _ => {}
        }
        Vec::new()
    }

    fn open(&mut self, params: Value) {
        let Some(DidOpenTextDocumentParams { text_document }) = read(params) else {
            return;
        };
        let document = OpenText::new(text_document.uri, text_document.version, text_document.text);
        let path = document.path.clone();
        // The diagnostics sent before stay recorded, to be cleared later.
        let before = self.document_mut(&document.uri);
        match before {
            Some(before) => before.replace(document),
            None => self.documents.push(document),
        }
        self.touch(&path);
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
            let path = document.path.clone();
            self.touch(&path);
        }
    }

    /// Has the texts checked again for which a file was read that has another text now.
    fn touch(&mut self, path: &Path) {
        let documents = self.documents.iter_mut();
        documents
            .filter(|document| {
                document.path != path && document.scene().is_some_and(|it| it.has_read(path))
            })
            .for_each(OpenText::forget);
    }

    /// Gives a text that waits to be checked the others, as they are.
    fn hand_others(&mut self, at: usize) {
        let others = self
            .documents
            .iter()
            .enumerate()
            .filter(|(file, _)| *file != at);
        let others =
            others.map(|(_, document)| (document.path.clone(), Arc::clone(&document.text)));
        let others = EditedFiles::new(others);
        if let Some(document) = self.documents.get_mut(at) {
            document.others = others;
        }
    }

    /// A text that is open, checked as it is.
    pub(super) fn checked(&mut self, uri: &DocumentUri) -> Option<&OpenText> {
        let at = self
            .documents
            .iter()
            .position(|document| document.uri == *uri)?;
        self.check(at);
        self.documents.get(at)
    }

    fn check(&mut self, at: usize) {
        let is_waiting = |document: &OpenText| document.checked.is_none();
        if self.documents.get(at).is_some_and(is_waiting) {
            self.hand_others(at);
            if let Some(document) = self.documents.get_mut(at) {
                document.check(&self.reading);
            }
        }
    }

    /// Closes a document and clears its diagnostics.
    fn close(&mut self, uri: &DocumentUri) -> Vec<Message> {
        let Some(at) = self
            .documents
            .iter()
            .position(|document| document.uri == *uri)
        else {
            return Vec::new();
        };
        let gone = self.documents.remove(at);
        self.touch(&gone.path);
        let files = gone.reported.into_iter().map(|(file, _)| file);
        self.published(files.collect())
    }

    /// Checks a changed document, and returns the messages to send; `None` if all are checked.
    pub(super) fn check_next(&mut self) -> Option<Vec<Message>> {
        let at = self
            .documents
            .iter()
            .position(|document| document.checked.is_none())?;
        let was_stale = self.documents[at].is_stale;
        let mut files = self.renew(at);
        if !self.pulls {
            return Some(self.published(files));
        }
        files.retain(|file| self.document(file).is_none());
        let mut messages = self.published(files);
        if was_stale && self.refreshes {
            let id = RequestId::from("refresh".to_owned());
            let method = method::DIAGNOSTIC_REFRESH.to_owned();
            messages.push(Request::new(id, method, Value::Null).into());
        }
        Some(messages)
    }

    /// Checks a document unless it is checked, and returns the files with diagnostics of it, before
    /// or now.
    fn renew(&mut self, at: usize) -> Vec<DocumentUri> {
        let columns = self.columns;
        let is_checked = self.documents[at].checked.is_some();
        self.check(at);
        let document = &mut self.documents[at];
        document.is_stale = false;
        if is_checked {
            return Vec::new();
        }
        document.checks += 1;
        let found = diagnostics::diagnostics(document, columns);
        let before = std::mem::replace(&mut document.reported, found);
        let mut files: Vec<DocumentUri> = before.into_iter().map(|(file, _)| file).collect();
        files.extend(document.reported.iter().map(|(file, _)| file.clone()));
        files
    }

    /// The diagnostics of a document that an editor asks for.
    pub(super) fn report(
        &mut self,
        params: &DocumentDiagnosticParams,
    ) -> Option<DocumentDiagnosticReport> {
        let DocumentDiagnosticParams {
            text_document,
            previous_result_id,
        } = params;
        // Those of other documents may stand in this one.
        for at in 0..self.documents.len() {
            drop(self.renew(at));
        }
        let checks = self.documents.iter().map(|own| own.checks);
        let checks: Vec<String> = checks.map(|count| count.to_string()).collect();
        let result_id = checks.join(".");
        let is_known = previous_result_id.as_ref() == Some(&result_id);
        self.document(&text_document.uri)?;
        Some(match is_known {
            true => DocumentDiagnosticReport::Unchanged { result_id },
            false => DocumentDiagnosticReport::Full {
                items: self.of_file(&text_document.uri),
                result_id,
            },
        })
    }

    /// The diagnostics in a file, from any document.
    fn of_file(&self, file: &DocumentUri) -> Vec<EditorDiagnostic> {
        let (mut all, mut known) = (Vec::new(), BTreeSet::new());
        let reported = self.documents.iter().flat_map(|own| &own.reported);
        let of_file = reported.filter(|(path, _): &&FileDiagnostics| path == file);
        for diagnostic in of_file.flat_map(|(_, list)| list) {
            // A file and the scenes that name it may report the same diagnostic.
            if known.insert(identity(diagnostic)) {
                all.push(diagnostic.clone());
            }
        }
        all
    }

    /// All diagnostics in some files, from any document.
    fn published(&self, mut files: Vec<DocumentUri>) -> Vec<Message> {
        files.sort_unstable_by(|a, b| a.as_str().cmp(b.as_str()));
        files.dedup();
        let publish = |file: DocumentUri| {
            let version = self.document(&file).map(|document| document.version);
            let params = PublishDiagnosticsParams {
                diagnostics: self.of_file(&file),
                uri: file,
                version,
            };
            let method = method::PUBLISH_DIAGNOSTICS.to_owned();
            Message::Notification(Notification::new(method, params))
        };
        files.into_iter().map(publish).collect()
    }
}

/// The identity of a diagnostic.
fn identity(diagnostic: &EditorDiagnostic) -> (Position, Position, Option<&str>, &str) {
    (
        diagnostic.range.start,
        diagnostic.range.end,
        diagnostic.code,
        &diagnostic.message,
    )
}

fn read<P: DeserializeOwned>(params: Value) -> Option<P> {
    serde_json::from_value(params).ok()
}
