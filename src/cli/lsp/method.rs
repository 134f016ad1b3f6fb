//! The names of the requests and notifications that are known here.

pub(super) const CODE_ACTION: &str = "textDocument/codeAction";
pub(super) const COLOR_PRESENTATION: &str = "textDocument/colorPresentation";
pub(super) const COMPLETION: &str = "textDocument/completion";
pub(super) const DEFINITION: &str = "textDocument/definition";
pub(super) const DOCUMENT_COLOR: &str = "textDocument/documentColor";
pub(super) const DOCUMENT_SYMBOL: &str = "textDocument/documentSymbol";
pub(super) const FORMATTING: &str = "textDocument/formatting";
pub(super) const HOVER: &str = "textDocument/hover";
pub(super) const INLAY_HINT: &str = "textDocument/inlayHint";

pub(super) const DID_OPEN: &str = "textDocument/didOpen";
pub(super) const DID_CHANGE: &str = "textDocument/didChange";
pub(super) const DID_CLOSE: &str = "textDocument/didClose";
pub(super) const DID_SAVE: &str = "textDocument/didSave";
pub(super) const DID_CHANGE_WATCHED_FILES: &str = "workspace/didChangeWatchedFiles";
pub(super) const PUBLISH_DIAGNOSTICS: &str = "textDocument/publishDiagnostics";
