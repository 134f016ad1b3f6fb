//! What is made of findings by those who read them: kept silent, warnings, errors.

use super::{Code, Severity, codes, nearest};
use std::collections::BTreeMap;

/// What is made of a finding that is no error by itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FindingLevel {
    /// Nothing: it is not told.
    Allow,
    /// A warning.
    Warn,
    /// An error.
    Deny,
}

impl FindingLevel {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Allow, Self::Warn, Self::Deny];

    /// As it is asked for.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Allow => "allow",
            Self::Warn => "warn",
            Self::Deny => "deny",
        }
    }
}

/// What a level is set for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LevelSubject {
    /// The findings of a code.
    Code(&'static Code),
    /// All warnings whose code has no level of its own.
    Warnings,
}

impl LevelSubject {
    /// The subject of this name: `warnings`, or a code in any case.
    ///
    /// # Errors
    /// If there is none, in words, with the one that may be meant.
    pub fn parse(word: &str) -> Result<Self, String> {
        if word == "warnings" {
            return Ok(Self::Warnings);
        }
        if let Some(code) = codes::find(word) {
            return Ok(Self::Code(code));
        }
        let known = codes::all().map(|code| code.id).chain(["warnings"]);
        Err(match nearest(word, known) {
            Some(near) => format!("there is no such code; did you mean `{near}`?"),
            None => "there is no such code; `rtc explain --all` lists them".to_owned(),
        })
    }
}

/// The levels that were asked for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FindingLevels {
    codes: BTreeMap<&'static str, FindingLevel>,
    warnings: Option<FindingLevel>,
}

impl FindingLevels {
    /// Sets a level.
    ///
    /// # Errors
    /// In words, if it would make less of an error, or another one is set for the same.
    pub fn set(&mut self, subject: LevelSubject, level: FindingLevel) -> Result<(), String> {
        let (name, before) = match subject {
            LevelSubject::Code(code)
                if code.severity == Severity::Error && level != FindingLevel::Deny =>
            {
                return Err(format!(
                    "`{code}` is an error, which can't be made less; `rtc explain {code}` tells how it is mended"
                ));
            }
            LevelSubject::Code(code) => (code.id, self.codes.insert(code.id, level)),
            LevelSubject::Warnings => ("warnings", self.warnings.replace(level)),
        };
        match before.filter(|before| *before != level) {
            None => Ok(()),
            Some(before) => Err(format!(
                "`{name}` can't be both `{}` and `{}`",
                before.name(),
                level.name()
            )),
        }
    }

    /// Sets all that are in another one, whatever was set before.
    pub fn override_by(&mut self, other: Self) {
        self.codes.extend(other.codes);
        self.warnings = other.warnings.or(self.warnings);
    }

    /// The severity of a finding; none if it is not to be told. An error stays one.
    #[must_use]
    pub fn of(&self, code: &Code, severity: Severity) -> Option<Severity> {
        let of_all = self.warnings.filter(|_| severity == Severity::Warning);
        match self.codes.get(code.id).copied().or(of_all) {
            _ if severity == Severity::Error => Some(severity),
            None => Some(severity),
            Some(FindingLevel::Allow) => None,
            Some(FindingLevel::Warn) => Some(Severity::Warning),
            Some(FindingLevel::Deny) => Some(Severity::Error),
        }
    }
}
