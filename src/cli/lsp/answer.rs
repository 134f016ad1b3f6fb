//! Requests of an editor and their answers.

use super::open_text::OpenText;
use super::protocol::{
    CodeAction, CodeActionParams, ColorPresentationParams, InlayHintParams, TextDocumentParams,
    TextDocumentPositionParams, TextEdit,
};
use super::uri::DocumentUri;
use super::vocabulary::Vocabulary;
use super::workspace::Workspace;
use super::{completion, diagnostics, hover, method, outline};
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
                let items = completion::completions(document, at.position, schema, self.columns);
                Some(items)
            }),
            method::DEFINITION => reply(id, params, |at: TextDocumentPositionParams| {
                let (document, schema) = self.known(&at.text_document.uri)?;
                outline::definition(document, at.position, schema, self.columns)
            }),
            _ => self.answer_of_whole(id, &method, params),
        }
    }

    /// The response to a request about a document.
    fn answer_of_whole(&self, id: RequestId, method: &str, params: Value) -> Response {
        match method {
            method::DOCUMENT_SYMBOL => reply(id, params, |params: TextDocumentParams| {
                let document = self.document(&params.text_document.uri)?;
                Some(outline::symbols(document, self.columns))
            }),
            method::DOCUMENT_COLOR => reply(id, params, |params: TextDocumentParams| {
                let document = self.document(&params.text_document.uri);
                // The protocol has no null here.
                Some(document.map_or_else(Vec::new, |own| outline::colors(own, self.columns)))
            }),
            method::COLOR_PRESENTATION => reply(id, params, |params: ColorPresentationParams| {
                Some(outline::presentation(params.color))
            }),
            method::INLAY_HINT => reply(id, params, |params: InlayHintParams| {
                let (document, schema) = self.known(&params.text_document.uri)?;
                Some(outline::hints(document, params.range, schema, self.columns))
            }),
            _ => {
                let schema = format!("`{method}` is not known here");
                Response::new_err(id, ErrorCode::MethodNotFound as i32, schema)
            }
        }
    }

    /// An open document, and the schema of its format.
    fn known(&self, uri: &DocumentUri) -> Option<(&OpenText, &Vocabulary)> {
        let document = self.document(uri)?;
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
        let document = self.document(uri)?;
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
