//! A document that is open in an editor, and its diagnostics.

use super::super::Failure;
use super::super::args::ReadArgs;
use super::super::input;
use super::super::project::Project;
use super::diagnostics::FileDiagnostics;
use super::place;
use super::protocol::TextDocumentContentChangeEvent;
use super::text::{Columns, LineTable, TextLines};
use super::uri::DocumentUri;
use ropey::Rope;
use rtc_diag::{Diagnostic, Severity};
use rtc_front::course;
use rtc_ir::LoweredScene;
use rtc_pipeline::{Input, Options, SourceKind};
use rtc_source::tree::yaml::{self, ReplacedBytes};
use rtc_source::tree::{DetachedTree, SyntaxTree};
use rtc_source::{EditedFiles, FileId, SourceMap};
use std::cell::OnceCell;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The message of an internal error.
pub(super) const FAULT: &str = "internal error of rtc; please report it";

/// A text that an editor has open.
pub(super) struct OpenText {
    pub(super) uri: DocumentUri,
    pub(super) path: PathBuf,
    pub(super) version: i32,
    /// Shared with the others that name it.
    pub(super) text: Arc<String>,
    /// The tree of the text and its lines, once they are asked for.
    parsed: OnceCell<Option<ParsedText>>,
    lines: OnceCell<(Columns, Arc<LineTable>)>,
    /// The other open documents; they replace the files that this one names.
    pub(super) others: EditedFiles,
    /// The diagnostics of the current version; `None` until it is checked.
    pub(super) checked: Option<CheckedText>,
    /// The diagnostics last found, by file, and the count of checks that found them.
    pub(super) reported: Vec<FileDiagnostics>,
    pub(super) checks: u64,
    /// Whether it is to be checked again although the editor did not change it.
    pub(super) is_stale: bool,
    /// Whether it is a scene, or was one before it was changed: editors send all YAML and JSON,
    /// most of which belongs to other programs.
    is_scene: bool,
}

/// The tree of a text of YAML or JSON.
struct ParsedText {
    tree: Arc<DetachedTree>,
    /// Whether it was parsed without a mistake.
    is_clean: bool,
}

/// The result of a check.
pub(super) enum CheckedText {
    /// What `rtc check` finds.
    Read(Box<CheckedScene>),
    /// It could not be checked, for this reason.
    Failed(String),
    /// It is the text of another program.
    Other,
}

/// A scene that was checked.
pub(super) struct CheckedScene {
    input: Input,
    /// The scene, if the document has no errors.
    pub(super) lowered: Option<LoweredScene>,
    /// Errors and warnings, in the order of the text.
    pub(super) diagnostics: Vec<Diagnostic>,
}

impl CheckedScene {
    pub(super) fn map(&self) -> &SourceMap {
        self.input.map()
    }

    /// Whether the file at a path was read for it.
    pub(super) fn has_read(&self, path: &Path) -> bool {
        self.input.has_read(path)
    }

    /// The file of the text itself.
    pub(super) fn file(&self) -> Option<FileId> {
        self.input.file_id()
    }

    /// Whether a file is the text itself.
    pub(super) fn is_own(&self, file: FileId) -> bool {
        self.input.file_id() == Some(file)
    }
}

impl OpenText {
    pub(super) fn new(uri: DocumentUri, version: i32, text: String) -> Self {
        let mut document = Self {
            path: place::path(&uri),
            uri,
            version,
            text: Arc::new(text),
            parsed: OnceCell::new(),
            lines: OnceCell::new(),
            others: EditedFiles::default(),
            checked: None,
            reported: Vec::new(),
            checks: 0,
            is_stale: false,
            is_scene: false,
        };
        document.is_scene = document.looks_like_scene();
        document
    }

    /// The same document, opened again.
    pub(super) fn replace(&mut self, other: Self) {
        let reported = std::mem::take(&mut self.reported);
        let checks = self.checks;
        *self = Self {
            reported,
            checks,
            ..other
        };
    }

    /// Has it checked again.
    pub(super) fn forget(&mut self) {
        self.checked = None;
        self.is_stale = true;
    }

    /// What kind of text it is.
    pub(super) fn kind(&self) -> SourceKind {
        SourceKind::of(&self.path.to_string_lossy(), self.text.as_bytes())
    }

    fn looks_like_scene(&self) -> bool {
        self.kind() != SourceKind::Scene || course::is_scene_text(self.text.as_bytes())
    }

    /// Whether it is a scene or may become one: it has no key yet.
    pub(super) fn may_be_scene(&self) -> bool {
        let mut lines = self.text.lines().map(str::trim_start);
        let is_begun = |line: &str| line.contains(':') || line.starts_with(['-', '[', '{']);
        self.is_scene || lines.all(|line| line.starts_with('#') || !is_begun(line))
    }

    /// The same after changes, each of the text that the one before has left.
    pub(super) fn change(
        &mut self,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
        columns: Columns,
    ) {
        let mut rope = Rope::from_str(&self.text);
        // A single change inside an object leaves most of the tree as it is.
        let mut only = None;
        let is_single = changes.len() == 1;
        for change in changes {
            match change.range {
                None => rope = Rope::from_str(&change.text),
                Some(range) => {
                    let start = columns.letter(&rope, range.start);
                    let end = columns.letter(&rope, range.end).max(start);
                    only = is_single.then(|| ReplacedBytes {
                        replaced: rope.char_to_byte(start)..rope.char_to_byte(end),
                        inserted: change.text.len(),
                    });
                    rope.remove(start..end);
                    rope.insert(start, &change.text);
                }
            }
        }
        self.text = Arc::new(rope.into());
        self.is_scene = self.is_scene || self.looks_like_scene();
        let before = self.parsed.take().flatten();
        let spliced = only.zip(before.filter(|parsed| parsed.is_clean));
        let spliced = spliced
            .and_then(|(change, before)| yaml::splice(&before.tree, &change, &self.text))
            .map(|tree| ParsedText {
                tree: Arc::new(tree),
                is_clean: true,
            });
        self.parsed = spliced.map_or_else(OnceCell::new, |parsed| OnceCell::from(Some(parsed)));
        self.lines = OnceCell::new();
        (self.version, self.checked) = (version, None);
    }

    pub(super) fn lines(&self, columns: Columns) -> TextLines<'_> {
        let table = || Arc::new(LineTable::of(&self.text, columns));
        let (known, kept) = self.lines.get_or_init(|| (columns, table()));
        let table = match *known == columns {
            true => Arc::clone(kept),
            false => table(),
        };
        TextLines::with(&self.text, columns, table)
    }

    /// The result of the check, if it could run.
    pub(super) fn scene(&self) -> Option<&CheckedScene> {
        match self.checked.as_ref()? {
            CheckedText::Read(scene) => Some(scene.as_ref()),
            CheckedText::Failed(_) | CheckedText::Other => None,
        }
    }

    /// Checks the document under the path of its file, as `rtc check` does, unless it is checked.
    pub(super) fn check(&mut self, reading: &ReadArgs) {
        if self.checked.is_some() {
            return;
        }
        if !self.is_scene {
            self.checked = Some(CheckedText::Other);
            return;
        }
        let check = AssertUnwindSafe(|| self.checked_anew(reading));
        let checked = match panic::catch_unwind(check) {
            Ok(Ok(scene)) => CheckedText::Read(Box::new(scene)),
            Ok(Err(Failure::Failed(message) | Failure::Input(message))) => {
                CheckedText::Failed(message)
            }
            Ok(Err(_)) => CheckedText::Failed("the scene can't be checked".to_owned()),
            Err(_) => CheckedText::Failed(FAULT.to_owned()),
        };
        self.checked = Some(checked);
    }

    fn checked_anew(&self, reading: &ReadArgs) -> Result<CheckedScene, Failure> {
        let (options, project) = self.options(reading)?;
        let bytes = self.text.as_bytes().to_vec();
        let is_text = self.kind() == SourceKind::Scene;
        let parsed = self.parsed().filter(|parsed| is_text && parsed.is_clean);
        let mut input = match parsed {
            Some(parsed) => Input::parsed(&self.path, bytes, Arc::clone(&parsed.tree), options),
            None => Input::edited(&self.path, bytes, options),
        };
        if let Some(project) = project {
            project.report_diagnostics(&mut input);
        }
        let loaded = input.load();
        let validated = loaded.and_then(|loaded| input.validate(loaded, |_, _| ()));
        let lowered = validated.map(|validated| {
            let mut lowered = validated.lowered;
            // Values that may be large are not shown.
            (lowered.scene.meshes, lowered.scene.images) = (Vec::new(), Vec::new());
            lowered
        });
        let mut sink = input.take_diagnostics();
        sink.sort();
        let kept = sink.kept().iter();
        let diagnostics = kept.filter(|diagnostic| diagnostic.severity != Severity::Note);
        Ok(CheckedScene {
            diagnostics: diagnostics.cloned().collect(),
            input,
            lowered,
        })
    }

    /// The options for reading the document.
    pub(super) fn options(
        &self,
        reading: &ReadArgs,
    ) -> Result<(Options, Option<Project>), Failure> {
        let project = Project::of(&self.path, reading)?;
        let options = Options {
            edited: self.others.clone(),
            ..input::options(reading, project.as_ref())?
        };
        Ok((options, project))
    }

    /// The text as a tree, if it is one of YAML or JSON without mistakes that prevent one.
    pub(super) fn tree(&self) -> Option<SyntaxTree<'_>> {
        let parsed = self.parsed()?;
        Some(parsed.tree.attach(own_file(), &self.text))
    }

    fn parsed(&self) -> Option<&ParsedText> {
        let parse = || {
            let mut mistakes = 0;
            let tree = yaml::parse(own_file(), self.text.as_bytes(), &mut |_| mistakes += 1)?;
            Some(ParsedText {
                tree: Arc::new(tree.detach()),
                is_clean: mistakes == 0,
            })
        };
        self.parsed.get_or_init(parse).as_ref()
    }
}

/// A text as a tree.
pub(super) fn tree(text: &str) -> Option<SyntaxTree<'_>> {
    yaml::parse(own_file(), text.as_bytes(), &mut |_| ())
}

/// The only file of an empty map.
fn own_file() -> FileId {
    SourceMap::default().add("", Vec::new())
}
