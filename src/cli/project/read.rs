//! The parser of an `rtc.toml`: each key and value, all errors with spans.

use super::super::parse;
use super::trust::ProjectTrust;
use super::{ProjectFileError, ProjectSettings};
use rtc_diag::{Code, DiagnosticLevel, LevelSubject, clip, codes, nearest};
use rtc_front::UpAxis;
use rtc_passes::CountSetting;
use rtc_source::{Limits, Resource};
use std::iter;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

/// The number of errors after which no more suggestions are computed: each costs a comparison with
/// all known names.
const MAX_SUGGESTIONS: usize = 20;

/// The keys at the top.
const KEYS: [&str; 8] = [
    "asset-root",
    "cache",
    "cache-limit",
    "exclude",
    "levels",
    "limits",
    "render",
    "up-axis",
];

type ProjectKey<'t> = Spanned<DeString<'t>>;
type Value<'t> = Spanned<DeValue<'t>>;

/// The trusted contents of an `rtc.toml` in a folder, and its errors.
pub(super) fn read(
    bytes: &[u8],
    folder: &Path,
    trust: ProjectTrust,
) -> (ProjectSettings, Vec<ProjectFileError>) {
    let mut reader = ProjectReader {
        folder,
        settings: ProjectSettings {
            is_trusted: matches!(trust, ProjectTrust::Full),
            ..ProjectSettings::default()
        },
        trust,
        faults: Vec::new(),
    };
    match std::str::from_utf8(bytes) {
        Ok(text) => reader.document(text),
        Err(error) => {
            let at = error.valid_up_to();
            reader.fault(
                at..at + 1,
                "this file is not UTF-8".to_owned(),
                "save it as UTF-8",
            );
        }
    }
    (reader.settings, reader.faults)
}

struct ProjectReader<'f> {
    folder: &'f Path,
    trust: ProjectTrust,
    settings: ProjectSettings,
    faults: Vec<ProjectFileError>,
}

impl ProjectReader<'_> {
    fn document(&mut self, text: &str) {
        let (table, errors) = DeTable::parse_recoverable(text);
        for error in errors {
            let message = format!("this is no TOML: {}", error.message().replace('\n', ", "));
            self.fault(error.span().unwrap_or(0..0), message, "");
        }
        for (key, value) in table.get_ref() {
            match key.get_ref().as_ref() {
                "asset-root" => self.asset_root(value),
                "cache" => self.cache(value),
                "cache-limit" => self.cache_limit(value),
                "exclude" => self.exclude(value),
                "levels" => self.section(key, value, Self::level),
                "limits" => self.section(key, value, Self::limit),
                "render" => self.section(key, value, Self::render),
                "up-axis" => self.up_axis(value),
                _ => self.unknown(key, &KEYS),
            }
        }
    }

    fn section(
        &mut self,
        key: &ProjectKey<'_>,
        value: &Value<'_>,
        each: fn(&mut Self, &ProjectKey<'_>, &Value<'_>),
    ) {
        let Some(table) = value.get_ref().as_table() else {
            let name = key.get_ref();
            let hint = format!("write `[{name}]` on a line of its own, and its keys below");
            return self.fault(value.span(), format!("`{name}` is a table"), &hint);
        };
        table.iter().for_each(|(key, value)| each(self, key, value));
    }

    fn asset_root(&mut self, value: &Value<'_>) {
        let expected = "`asset-root` is a folder, in that of this file or below";
        let found = value.get_ref().as_str().and_then(|name| {
            let folder: PathBuf = self.folder.join(name).canonicalize().ok()?;
            (folder.is_dir() && folder.starts_with(self.folder)).then_some(folder)
        });
        match found {
            Some(folder) if self.is_lent(&folder) => self.settings.asset_root = Some(folder),
            Some(_) => self.untrusted(
                value.span(),
                "`asset-root` is left out: it is not in the folder of the scene",
            ),
            None => self.fault(
                value.span(),
                expected.to_owned(),
                "write it as `\"assets\"`",
            ),
        }
    }

    /// A cache of somebody else may hold wrong pictures, and files are written there.
    fn cache(&mut self, value: &Value<'_>) {
        match value.get_ref().as_str() {
            Some(name) if self.settings.is_trusted => {
                self.settings.cache = Some(self.folder.join(name));
            }
            Some(_) => self.untrusted(value.span(), "`cache` is left out"),
            None => self.fault(
                value.span(),
                "`cache` is a folder".to_owned(),
                "write it as `\".cache\"`",
            ),
        }
    }

    fn cache_limit(&mut self, value: &Value<'_>) {
        let limit = written(value.get_ref());
        self.settings.cache_limit = limit.and_then(|text| parse::bytes(&text).ok());
        if self.settings.cache_limit.is_none() {
            let message = "`cache-limit` is a number of bytes, which a unit may follow".to_owned();
            self.fault(value.span(), message, "write it as `\"2GiB\"`");
        }
    }

    fn exclude(&mut self, value: &Value<'_>) {
        let list = value.get_ref().as_array();
        let patterns = list.map(|list| list.iter().map(|own| own.get_ref().as_str()));
        let patterns = patterns.and_then(|own| own.map(|own| own.map(str::to_owned)).collect());
        match patterns {
            Some(patterns) => self.settings.exclude = patterns,
            None => self.fault(
                value.span(),
                "`exclude` is a list of patterns, as in a `.gitignore`".to_owned(),
                "write it as `[\"old/\", \"*.part.yaml\"]`",
            ),
        }
    }

    fn up_axis(&mut self, value: &Value<'_>) {
        self.settings.up_axis = match value.get_ref().as_str() {
            Some("y") => Some(UpAxis::Y),
            Some("z") => Some(UpAxis::Z),
            _ => {
                let message = "`up-axis` is `\"y\"` or `\"z\"`".to_owned();
                return self.fault(value.span(), message, "");
            }
        };
    }

    fn level(&mut self, key: &ProjectKey<'_>, value: &Value<'_>) {
        let name = key.get_ref().as_ref();
        let subject = match self.is_advising() {
            true => LevelSubject::parse(name),
            false => LevelSubject::find(name).ok_or_else(|| "there is no such code".to_owned()),
        };
        let subject = match subject {
            Ok(subject) => subject,
            Err(reason) => {
                return self.fault(key.span(), format!("`{}`: {reason}", clip(name)), "");
            }
        };
        let word = value.get_ref().as_str();
        let level = DiagnosticLevel::ALL
            .into_iter()
            .find(|level| word == Some(level.name()));
        let set = match level {
            Some(level) => self.settings.levels.set(subject, level),
            None => Err("a level is `\"allow\"`, `\"warn\"` or `\"deny\"`".to_owned()),
        };
        if let Err(reason) = set {
            self.fault(value.span(), reason, "");
        }
    }

    fn limit(&mut self, key: &ProjectKey<'_>, value: &Value<'_>) {
        let name = key.get_ref().as_ref();
        if Resource::all().all(|resource| resource.name() != name) {
            let names: Vec<_> = Resource::all().map(Resource::name).collect();
            return self.unknown(key, &names);
        }
        let limit = written(value.get_ref()).ok_or_else(String::new);
        match limit.and_then(|number| parse::limit(&format!("{name}={number}"))) {
            Ok(limit) => {
                let is_raised = limit.1 > Limits::default().of(limit.0, 0);
                if is_raised && !self.settings.is_trusted {
                    let message = format!("`{name}` is not raised, only lowered");
                    self.untrusted(value.span(), &message);
                }
                self.settings.limits.push(limit);
            }
            Err(_) => {
                let message = format!("`{name}` is a number, which a unit may follow");
                self.fault(value.span(), message, "write it as 5000000 or `\"2GiB\"`");
            }
        }
    }

    fn render(&mut self, key: &ProjectKey<'_>, value: &Value<'_>) {
        let name = key.get_ref().as_ref();
        let render = &mut self.settings.render;
        if name == "size" {
            render.size = written(value.get_ref()).and_then(|text| parse::size(&text).ok());
            if render.size.is_none() {
                let message = "`size` is the width and height of the picture".to_owned();
                self.fault(value.span(), message, "write it as `\"640x480\"` or 512");
            }
            return;
        }
        let Some(count) = CountSetting::ALL.iter().find(|count| count.name == name) else {
            let names = CountSetting::ALL.iter().map(|count| count.name);
            return self.unknown(key, &iter::once("size").chain(names).collect::<Vec<_>>());
        };
        let number = whole(value.get_ref()).and_then(|number| u32::try_from(number).ok());
        let number = number.filter(|number| *number >= count.least);
        *(count.of)(render) = number;
        if number.is_none() {
            let message = format!("`{name}` is a whole number, at least {}", count.least);
            self.fault(value.span(), message, "");
        }
    }

    fn unknown(&mut self, key: &ProjectKey<'_>, known: &[&str]) {
        let name = key.get_ref().as_ref();
        let known_names = known.iter().copied().filter(|_| self.is_advising());
        let suggestion = nearest(name, known_names);
        let hint = match suggestion {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("the keys here are {}", known.join(", ")),
        };
        self.faults.push(ProjectFileError {
            code: &codes::SETTINGS_UNKNOWN,
            at: key.span(),
            message: format!("unknown key `{}`", clip(name)),
            hint: Some(hint),
            suggestion: suggestion.map(str::to_owned),
        });
    }

    /// Whether suggestions are still made.
    fn is_advising(&self) -> bool {
        self.faults.len() < MAX_SUGGESTIONS
    }

    /// Whether the scene may name the files in a folder.
    fn is_lent(&self, folder: &Path) -> bool {
        match &self.trust {
            ProjectTrust::Full => true,
            ProjectTrust::Within(own) => folder.starts_with(own),
        }
    }

    /// Reports keys that only a trusted file may have.
    fn untrusted(&mut self, at: Range<usize>, message: &str) {
        self.faults.push(ProjectFileError {
            code: &codes::SETTINGS_UNTRUSTED,
            at,
            message: format!("{message}, for this file is not trusted"),
            hint: Some("`--trust-project` trusts it if you do".to_owned()),
            suggestion: None,
        });
    }

    fn fault(&mut self, at: Range<usize>, message: String, hint: &str) {
        let code: &'static Code = &codes::SETTINGS_WRONG;
        self.faults.push(ProjectFileError {
            code,
            at,
            message,
            hint: Some(hint.to_owned()).filter(|hint| !hint.is_empty()),
            suggestion: None,
        });
    }
}

/// A whole number, written to the base of ten.
fn whole(value: &DeValue<'_>) -> Option<u64> {
    let integer = value.as_integer().filter(|integer| integer.radix() == 10)?;
    integer.as_str().replace('_', "").parse().ok()
}

/// A number or text, as the command line would have it.
fn written(value: &DeValue<'_>) -> Option<String> {
    let number = whole(value).map(|number| number.to_string());
    number.or_else(|| value.as_str().map(str::to_owned))
}

#[cfg(test)]
mod tests {
    use super::{MAX_SUGGESTIONS, ProjectTrust, read};
    use std::fmt::Write as _;
    use std::path::Path;

    #[test]
    fn suggestions_are_made_for_the_first_errors_alone() {
        for count in [50, 100, 200] {
            let mut text = "shadowss = 1\n[levels]\n".to_owned();
            for k in 0..count {
                writeln!(text, "VA0{:02}X{k} = \"warn\"\nsizee{k} = 1", k % 30).unwrap();
            }
            text += "VA022 = \"deny\"\n";
            let (settings, faults) = read(text.as_bytes(), Path::new(""), ProjectTrust::Full);
            let is_advised = |hint: &String| hint.contains("did you mean");
            let advised = faults
                .iter()
                .filter(|fault| is_advised(&fault.message) || fault.hint.iter().any(is_advised));
            assert!(advised.count() <= MAX_SUGGESTIONS);
            assert_eq!(faults.len(), 2 * count + 1);
            assert_ne!(settings.levels, rtc_diag::DiagnosticLevels::default());
        }
    }
}
