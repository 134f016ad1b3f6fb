//! Requests of an editor and their answers.

use super::open_text::OpenText;
use super::protocol::{
    CodeAction, CodeActionParams, ColorPresentationParams, DocumentDiagnosticParams, RangeParams,
    ReferenceParams, RenameParams, SelectionRangeParams, SemanticTokens, TextDocumentParams,
    TextDocumentPositionParams, TextEdit, WorkspaceEdit,
};
use super::uri::DocumentUri;
use super::vocabulary::Vocabulary;
use super::workspace::Workspace;
use super::{
    anchor, completion, diagnostics, folding, foreign, hover, inlay, lens, links, method, outline,
    semantic,
};
use lsp_server::{ErrorCode, Request, RequestId, Response};
use rtc_pipeline::Input;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

impl Workspace {
    /// The answer to a request.
    pub(super) fn answer(&mut self, request: Request) -> Response {
        let Request { id, method, params } = request;
        match method.as_str() {
            method::CODE_ACTION => reply(id, params, |params| self.actions(&params)),
            method::FORMATTING => reply(id, params, |params: TextDocumentParams| {
                self.formatted(&params.text_document.uri)
            }),
            method::HOVER => reply(id, params, |at: TextDocumentPositionParams| {
                let (document, schema) = self.known(&at.text_document.uri)?;
                hover::hover(document, at.position, schema, self.columns)
            }),
            method::COMPLETION => reply(id, params, |at: TextDocumentPositionParams| {
                let (document, schema) = self.known(&at.text_document.uri)?;
                let (columns, form) = (self.columns, self.snippet_form);
                let place = at.position;
                Some(match foreign::format(document.kind()) {
                    Some(format) => foreign::completions(document, place, format, columns),
                    None => completion::completions(document, place, schema, columns, form),
                })
            }),
            method::DEFINITION => reply(id, params, |at: TextDocumentPositionParams| {
                let (document, schema) = self.known(&at.text_document.uri)?;
                outline::definition(document, at.position, schema, self.columns)
            }),
            _ => self.answer_of_names(id, &method, params),
        }
    }

    /// The response to a request about the names and the structure of a document.
    fn answer_of_names(&mut self, id: RequestId, method: &str, params: Value) -> Response {
        let columns = self.columns;
        match method {
            method::REFERENCES => reply(id, params, |params: ReferenceParams| {
                let document = self.scene(&params.text_document.uri)?;
                let has_anchor = params.context.include_declaration;
                anchor::references(document, params.position, has_anchor, columns)
            }),
            method::PREPARE_RENAME => reply(id, params, |at: TextDocumentPositionParams| {
                let document = self.scene(&at.text_document.uri)?;
                anchor::name_range(document, at.position, columns)
            }),
            method::RENAME => self.renamed(id, params),
            method::FOLDING_RANGE => reply(id, params, |params: TextDocumentParams| {
                let document = self.scene(&params.text_document.uri)?;
                Some(folding::folding(document, columns))
            }),
            method::SELECTION_RANGE => reply(id, params, |params: SelectionRangeParams| {
                let document = self.scene(&params.text_document.uri)?;
                Some(folding::selections(document, &params.positions, columns))
            }),
            method::DOCUMENT_LINK => reply(id, params, |params: TextDocumentParams| {
                let (document, schema) = self.known(&params.text_document.uri)?;
                Some(links::links(document, schema, columns))
            }),
            method::CODE_LENS => reply(id, params, |params: TextDocumentParams| {
                Some(lens::lenses(self.scene(&params.text_document.uri)?))
            }),
            method::SEMANTIC_TOKENS => reply(id, params, |params: TextDocumentParams| {
                let (document, schema) = self.known(&params.text_document.uri)?;
                let all = 0..document.text.len();
                let data = semantic::tokens(document, &all, schema, columns);
                Some(SemanticTokens { data })
            }),
            method::SEMANTIC_TOKENS_RANGE => reply(id, params, |params: RangeParams| {
                let (document, schema) = self.known(&params.text_document.uri)?;
                let lines = document.lines(columns);
                let bytes = lines.offset(params.range.start)..lines.offset(params.range.end);
                let data = semantic::tokens(document, &bytes, schema, columns);
                Some(SemanticTokens { data })
            }),
            method::DIAGNOSTIC => reply(id, params, |params: DocumentDiagnosticParams| {
                self.report(&params)
            }),
            _ => self.answer_of_whole(id, method, params),
        }
    }

    /// The response to a request to rename an anchor.
    fn renamed(&self, id: RequestId, params: Value) -> Response {
        let invalid = ErrorCode::InvalidParams as i32;
        let params: RenameParams = match serde_json::from_value(params) {
            Ok(params) => params,
            Err(error) => return Response::new_err(id, invalid, error.to_string()),
        };
        let RenameParams {
            text_document,
            position,
            new_name,
        } = params;
        let renamed = self.scene(&text_document.uri).map_or(Ok(None), |own| {
            anchor::rename(own, position, &new_name, self.columns)
        });
        match renamed {
            Ok(edits) => {
                let change = edits.map(|edits| WorkspaceEdit {
                    changes: [(text_document.uri, edits)].into(),
                });
                Response::new_ok(id, change)
            }
            Err(error_text) => Response::new_err(id, invalid, error_text),
        }
    }

    /// The response to a request about a document.
    fn answer_of_whole(&self, id: RequestId, method: &str, params: Value) -> Response {
        match method {
            method::DOCUMENT_SYMBOL => reply(id, params, |params: TextDocumentParams| {
                let document = self.scene(&params.text_document.uri)?;
                Some(outline::symbols(document, self.columns))
            }),
            method::DOCUMENT_COLOR => reply(id, params, |params: TextDocumentParams| {
                let document = self.scene(&params.text_document.uri);
                // The protocol has no null here.
                Some(document.map_or_else(Vec::new, |own| outline::colors(own, self.columns)))
            }),
            method::COLOR_PRESENTATION => reply(id, params, |params: ColorPresentationParams| {
                Some(outline::presentation(params.color))
            }),
            method::INLAY_HINT => reply(id, params, |params: RangeParams| {
                let (document, schema) = self.known(&params.text_document.uri)?;
                Some(inlay::hints(document, params.range, schema, self.columns))
            }),
            _ => {
                let schema = format!("`{method}` is not known here");
                Response::new_err(id, ErrorCode::MethodNotFound as i32, schema)
            }
        }
    }

    /// An open document, unless it belongs to another program.
    fn scene(&self, uri: &DocumentUri) -> Option<&OpenText> {
        self.document(uri)
            .filter(|document| document.may_be_scene())
    }

    /// An open document, and the schema of its format.
    fn known(&self, uri: &DocumentUri) -> Option<(&OpenText, &Vocabulary)> {
        let document = self.scene(uri)?;
        Some((document, self.vocabulary(document)))
    }

    /// The fixes of the diagnostics in a range.
    fn actions(&mut self, params: &CodeActionParams) -> Option<Vec<CodeAction>> {
        let (reading, columns) = (self.reading.clone(), self.columns);
        let document = self.checked(&params.text_document.uri)?;
        let only = params.context.only.as_deref();
        Some(diagnostics::actions(
            document,
            params.range,
            only,
            &reading,
            columns,
        ))
    }

    /// The document as `rtc fmt` formats it.
    fn formatted(&self, uri: &DocumentUri) -> Option<Vec<TextEdit>> {
        let document = self.scene(uri)?;
        let (options, _) = document.options(&self.reading).ok()?;
        let bytes = document.text.as_bytes().to_vec();
        let formatted = Input::edited(&document.path, bytes, options).format_text();
        let text = formatted.ok()?;
        let whole = document.lines(self.columns).range(0, document.text.len());
        let is_same = text == *document.text;
        let edit = (!is_same).then(|| TextEdit::new(whole, text));
        Some(edit.into_iter().collect())
    }
}

/// The response computed from valid parameters.
fn reply<P: DeserializeOwned, R: Serialize>(
    id: RequestId,
    params: Value,
    answer: impl FnOnce(P) -> Option<R>,
) -> Response {
    match serde_json::from_value(params) {
        Ok(params) => Response::new_ok(id, answer(params)),
        Err(error) => Response::new_err(id, ErrorCode::InvalidParams as i32, error.to_string()),
    }
}
