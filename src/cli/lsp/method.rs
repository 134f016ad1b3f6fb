//! The names of the requests and notifications that are known here.

pub(super) const CODE_ACTION: &str = "textDocument/codeAction";
pub(super) const CODE_LENS: &str = "textDocument/codeLens";
pub(super) const COLOR_PRESENTATION: &str = "textDocument/colorPresentation";
pub(super) const COMPLETION: &str = "textDocument/completion";
pub(super) const DEFINITION: &str = "textDocument/definition";
pub(super) const DIAGNOSTIC: &str = "textDocument/diagnostic";
pub(super) const DOCUMENT_COLOR: &str = "textDocument/documentColor";
pub(super) const DOCUMENT_LINK: &str = "textDocument/documentLink";
pub(super) const DOCUMENT_SYMBOL: &str = "textDocument/documentSymbol";
pub(super) const EXECUTE_COMMAND: &str = "workspace/executeCommand";
pub(super) const FOLDING_RANGE: &str = "textDocument/foldingRange";
pub(super) const FORMATTING: &str = "textDocument/formatting";
pub(super) const HOVER: &str = "textDocument/hover";
pub(super) const INLAY_HINT: &str = "textDocument/inlayHint";
pub(super) const PREPARE_RENAME: &str = "textDocument/prepareRename";
pub(super) const REFERENCES: &str = "textDocument/references";
pub(super) const RENAME: &str = "textDocument/rename";
pub(super) const SELECTION_RANGE: &str = "textDocument/selectionRange";
pub(super) const SEMANTIC_TOKENS: &str = "textDocument/semanticTokens/full";
pub(super) const SEMANTIC_TOKENS_RANGE: &str = "textDocument/semanticTokens/range";

pub(super) const DID_OPEN: &str = "textDocument/didOpen";
pub(super) const DID_CHANGE: &str = "textDocument/didChange";
pub(super) const DID_CLOSE: &str = "textDocument/didClose";
pub(super) const DID_SAVE: &str = "textDocument/didSave";
pub(super) const DID_CHANGE_WATCHED_FILES: &str = "workspace/didChangeWatchedFiles";
pub(super) const PUBLISH_DIAGNOSTICS: &str = "textDocument/publishDiagnostics";
pub(super) const DIAGNOSTIC_REFRESH: &str = "workspace/diagnostic/refresh";
pub(super) const SHOW_DOCUMENT: &str = "window/showDocument";
pub(super) const SHOW_MESSAGE: &str = "window/showMessage";
