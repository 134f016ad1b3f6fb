//! Levels of diagnostics: `--allow`, `--warn` and `--deny` for a code or for all warnings.

use super::{Code, Severity, codes, nearest};
use std::collections::BTreeMap;

/// The level of a diagnostic that is not an error by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiagnosticLevel {
    /// It is not reported.
    Allow,
    /// A warning.
    Warn,
    /// An error.
    Deny,
}

impl DiagnosticLevel {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Allow, Self::Warn, Self::Deny];

    /// The name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Allow => "allow",
            Self::Warn => "warn",
            Self::Deny => "deny",
        }
    }
}

/// The subject of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelSubject {
    /// The diagnostics of one code.
    Code(&'static Code),
    /// All warnings whose code has no level of its own.
    Warnings,
}

impl LevelSubject {
    /// The subject of this name: `warnings`, or a code in any case.
    #[must_use]
    pub fn find(word: &str) -> Option<Self> {
        match word {
            "warnings" => Some(Self::Warnings),
            _ => codes::find(word).map(Self::Code),
        }
    }

    /// As [`LevelSubject::find`].
    ///
    /// # Errors
    /// A message if there is none, with the closest name.
    pub fn parse(word: &str) -> Result<Self, String> {
        if let Some(subject) = Self::find(word) {
            return Ok(subject);
        }
        let known = codes::all().map(|code| code.id).chain(["warnings"]);
        Err(match nearest(word, known) {
            Some(near) => format!("there is no such code; did you mean `{near}`?"),
            None => "there is no such code; `rtc explain --all` lists them".to_owned(),
        })
    }
}

/// The levels that the command line and the project file set.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DiagnosticLevels {
    codes: BTreeMap<&'static str, DiagnosticLevel>,
    warnings: Option<DiagnosticLevel>,
}

impl DiagnosticLevels {
    /// Sets a level.
    ///
    /// # Errors
    /// A message if the code is an error and the level is lower, or if the subject has another
    /// level.
    pub fn set(&mut self, subject: LevelSubject, level: DiagnosticLevel) -> Result<(), String> {
        let (name, before) = match subject {
            LevelSubject::Code(code)
                if code.severity == Severity::Error && level != DiagnosticLevel::Deny =>
            {
                return Err(format!(
                    "`{code}` is an error, which cannot be lowered; `rtc explain {code}` shows \
                    how to fix it"
                ));
            }
            LevelSubject::Code(code) => (code.id, self.codes.insert(code.id, level)),
            LevelSubject::Warnings => ("warnings", self.warnings.replace(level)),
        };
        match before.filter(|before| *before != level) {
            None => Ok(()),
            Some(before) => Err(format!(
                "`{name}` cannot be both `{}` and `{}`",
                before.name(),
                level.name()
            )),
        }
    }

    /// Takes over all levels of another set; they replace earlier ones.
    pub fn override_by(&mut self, other: Self) {
        self.codes.extend(other.codes);
        self.warnings = other.warnings.or(self.warnings);
    }

    /// The severity of a diagnostic, `None` if it is not reported. An error stays an error.
    #[must_use]
    pub fn of(&self, code: &Code, severity: Severity) -> Option<Severity> {
        let of_all = self.warnings.filter(|_| severity == Severity::Warning);
        match self.codes.get(code.id).copied().or(of_all) {
            _ if severity == Severity::Error => Some(severity),
            None => Some(severity),
            Some(DiagnosticLevel::Allow) => None,
            Some(DiagnosticLevel::Warn) => Some(Severity::Warning),
            Some(DiagnosticLevel::Deny) => Some(Severity::Error),
        }
    }
}
