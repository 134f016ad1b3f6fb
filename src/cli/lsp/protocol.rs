//! The messages of the Language Server Protocol 3.17, by its names; of each message only the fields
//! that are used here.

use super::uri::DocumentUri;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// A line and a column in it, from 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) struct Position {
    pub(super) line: u32,
    pub(super) character: u32,
}

impl Position {
    pub(super) fn new(line: u32, character: u32) -> Self {
        Self { line, character }
    }
}

/// A half-open range of positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Range {
    pub(super) start: Position,
    pub(super) end: Position,
}

impl Range {
    pub(super) fn new(start: Position, end: Position) -> Self {
        Self { start, end }
    }
}

/// A range in a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct Location {
    pub(super) uri: DocumentUri,
    pub(super) range: Range,
}

impl Location {
    pub(super) fn new(uri: DocumentUri, range: Range) -> Self {
        Self { uri, range }
    }
}

/// The units of columns.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct PositionEncodingKind(Cow<'static, str>);

impl PositionEncodingKind {
    pub(super) const UTF8: Self = Self(Cow::Borrowed("utf-8"));
    pub(super) const UTF16: Self = Self(Cow::Borrowed("utf-16"));
}

/// How an editor sends changes.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct TextDocumentSyncKind(u8);

impl TextDocumentSyncKind {
    pub(super) const INCREMENTAL: Self = Self(2);
}

/// Identifies a text.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct TextDocumentIdentifier {
    pub(super) uri: DocumentUri,
}

/// Identifies a version of a text.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct VersionedTextDocumentIdentifier {
    pub(super) uri: DocumentUri,
    pub(super) version: i32,
}

/// A text that is opened.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct TextDocumentItem {
    pub(super) uri: DocumentUri,
    pub(super) version: i32,
    pub(super) text: String,
}

/// A text is opened.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct DidOpenTextDocumentParams {
    pub(super) text_document: TextDocumentItem,
}

/// A text was changed, change by change.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct DidChangeTextDocumentParams {
    pub(super) text_document: VersionedTextDocumentIdentifier,
    pub(super) content_changes: Vec<TextDocumentContentChangeEvent>,
}

/// The new text of a range, or of the whole document.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct TextDocumentContentChangeEvent {
    pub(super) range: Option<Range>,
    pub(super) text: String,
}

/// Parameters of messages about a whole text: close, format, outline, colours.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextDocumentParams {
    pub(super) text_document: TextDocumentIdentifier,
}

/// A request about a position: hover, completion or definition.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextDocumentPositionParams {
    pub(super) text_document: TextDocumentIdentifier,
    pub(super) position: Position,
}

/// A request for the hints or the tokens in a range.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct RangeParams {
    pub(super) text_document: TextDocumentIdentifier,
    pub(super) range: Range,
}

/// A request for the places of a name.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ReferenceParams {
    pub(super) text_document: TextDocumentIdentifier,
    pub(super) position: Position,
    pub(super) context: ReferenceContext,
}

/// Whether the place that gives the name is asked for, too.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct ReferenceContext {
    pub(super) include_declaration: bool,
}

/// A request for another name.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct RenameParams {
    pub(super) text_document: TextDocumentIdentifier,
    pub(super) position: Position,
    pub(super) new_name: String,
}

/// A request for the ranges around some positions.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SelectionRangeParams {
    pub(super) text_document: TextDocumentIdentifier,
    pub(super) positions: Vec<Position>,
}

/// A request for the diagnostics of a document, unless they are those of an earlier answer.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct DocumentDiagnosticParams {
    pub(super) text_document: TextDocumentIdentifier,
    pub(super) previous_result_id: Option<String>,
}

/// A request for the fixes in a range.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct CodeActionParams {
    pub(super) text_document: TextDocumentIdentifier,
    pub(super) range: Range,
    pub(super) context: CodeActionContext,
}

/// The requested kinds of fixes; `None` for all.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct CodeActionContext {
    pub(super) only: Option<Vec<CodeActionKind>>,
}

/// A colour that is to be written.
#[derive(Clone, Debug, Deserialize)]
pub(super) struct ColorPresentationParams {
    pub(super) color: EditorColor,
}

/// The diagnostics of a file; `version` is that of its document, if open.
#[derive(Clone, Debug, Serialize)]
pub(super) struct PublishDiagnosticsParams {
    pub(super) uri: DocumentUri,
    pub(super) diagnostics: Vec<EditorDiagnostic>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) version: Option<i32>,
}

/// Something that is found.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct EditorDiagnostic {
    pub(super) range: Range,
    pub(super) severity: DiagnosticSeverity,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) code: Option<&'static str>,
    pub(super) source: &'static str,
    pub(super) message: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) related_information: Option<Vec<DiagnosticRelatedInformation>>,
}

/// How grave it is.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct DiagnosticSeverity(u8);

impl DiagnosticSeverity {
    pub(super) const ERROR: Self = Self(1);
    pub(super) const WARNING: Self = Self(2);
    pub(super) const HINT: Self = Self(4);
}

/// What else has to do with it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct DiagnosticRelatedInformation {
    pub(super) location: Location,
    pub(super) message: String,
}

/// A fix that an editor offers.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct CodeAction {
    pub(super) title: String,
    pub(super) kind: CodeActionKind,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) diagnostics: Option<Vec<EditorDiagnostic>>,
    pub(super) edit: WorkspaceEdit,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) is_preferred: Option<bool>,
}

/// A kind of fixes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct CodeActionKind(Cow<'static, str>);

impl CodeActionKind {
    pub(super) const QUICKFIX: Self = Self(Cow::Borrowed("quickfix"));
    pub(super) const SOURCE: Self = Self(Cow::Borrowed("source"));
    pub(super) const SOURCE_FIX_ALL: Self = Self(Cow::Borrowed("source.fixAll"));
}

/// Edits, by files.
#[derive(Clone, Debug, Serialize)]
pub(super) struct WorkspaceEdit {
    pub(super) changes: BTreeMap<DocumentUri, Vec<TextEdit>>,
}

/// The new text of a range.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct TextEdit {
    pub(super) range: Range,
    pub(super) new_text: String,
}

impl TextEdit {
    pub(super) fn new(range: Range, new_text: String) -> Self {
        Self { range, new_text }
    }
}

/// The hover text.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Hover {
    pub(super) contents: MarkupContent,
    pub(super) range: Range,
}

/// A text with marks.
#[derive(Clone, Debug, Serialize)]
pub(super) struct MarkupContent {
    pub(super) kind: MarkupKind,
    pub(super) value: String,
}

/// The markup of a text.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum MarkupKind {
    /// In Markdown.
    Markdown,
}

/// A completion.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct CompletionItem {
    pub(super) label: String,
    pub(super) kind: CompletionItemKind,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) detail: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) documentation: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) insert_text: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) insert_text_format: Option<InsertTextFormat>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) sort_text: Option<String>,
    /// What the editor changes, instead of the word under the cursor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) text_edit: Option<TextEdit>,
}

impl CompletionItem {
    /// A completion without further fields.
    pub(super) fn new(label: String, kind: CompletionItemKind) -> Self {
        Self {
            label,
            kind,
            detail: None,
            documentation: None,
            insert_text: None,
            insert_text_format: None,
            sort_text: None,
            text_edit: None,
        }
    }
}

/// The kind of a completion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) struct CompletionItemKind(u8);

impl CompletionItemKind {
    pub(super) const PROPERTY: Self = Self(10);
    pub(super) const VALUE: Self = Self(12);
    pub(super) const KEYWORD: Self = Self(14);
    pub(super) const SNIPPET: Self = Self(15);
    pub(super) const FILE: Self = Self(17);
    pub(super) const REFERENCE: Self = Self(18);
}

/// The syntax of the inserted text.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) struct InsertTextFormat(u8);

impl InsertTextFormat {
    pub(super) const PLAIN_TEXT: Self = Self(1);
    /// With tab stops.
    pub(super) const SNIPPET: Self = Self(2);
}

/// A part of a text that has a name; `selection_range` is that of the name.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct DocumentSymbol {
    pub(super) name: String,
    pub(super) kind: SymbolKind,
    pub(super) range: Range,
    pub(super) selection_range: Range,
    pub(super) children: Vec<Self>,
}

/// The kind of a symbol.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct SymbolKind(u8);

impl SymbolKind {
    pub(super) const PROPERTY: Self = Self(7);
    pub(super) const OBJECT: Self = Self(19);
}

/// A colour, from 0 to 1.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct EditorColor {
    pub(super) red: f32,
    pub(super) green: f32,
    pub(super) blue: f32,
    pub(super) alpha: f32,
}

/// A colour in a text.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ColorInformation {
    pub(super) range: Range,
    pub(super) color: EditorColor,
}

/// The spelling of a colour.
#[derive(Clone, Debug, Serialize)]
pub(super) struct ColorPresentation {
    pub(super) label: String,
}

/// An inlay hint: text that the editor shows without inserting it.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct InlayHint {
    pub(super) position: Position,
    pub(super) label: String,
    pub(super) padding_left: bool,
}

/// The diagnostics of a document, or that they are those of an earlier answer.
#[derive(Clone, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(super) enum DocumentDiagnosticReport {
    /// All of them.
    #[serde(rename_all = "camelCase")]
    Full {
        result_id: String,
        items: Vec<EditorDiagnostic>,
    },
    /// Those of the answer with this id.
    #[serde(rename_all = "camelCase")]
    Unchanged { result_id: String },
}

/// Lines that can be folded.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct FoldingRange {
    pub(super) start_line: u32,
    pub(super) end_line: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) kind: Option<&'static str>,
}

/// A range, and the one around it.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SelectionRange {
    pub(super) range: Range,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) parent: Option<Box<Self>>,
}

/// A link to a file.
#[derive(Clone, Debug, Serialize)]
pub(super) struct DocumentLink {
    pub(super) range: Range,
    pub(super) target: DocumentUri,
}

/// A command above a range.
#[derive(Clone, Debug, Serialize)]
pub(super) struct CodeLens {
    pub(super) range: Range,
    pub(super) command: EditorCommand,
}

/// A command that an editor sends back when it is chosen.
#[derive(Clone, Debug, Serialize)]
pub(super) struct EditorCommand {
    pub(super) title: String,
    pub(super) command: &'static str,
    pub(super) arguments: Vec<DocumentUri>,
}

/// Semantic tokens, five numbers each.
#[derive(Clone, Debug, Serialize)]
pub(super) struct SemanticTokens {
    pub(super) data: Vec<u32>,
}
