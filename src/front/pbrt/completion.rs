//! What an editor proposes at a place of a pbrt text, which may be incomplete there.

use super::plugins::{Argument, DIRECTIVES, Directive, TARGETS};
pub(crate) use super::token::token;
use super::token::{PbrtToken, PbrtTokenKind};
use crate::plugin::{Completion, DeclaredParameter, Plugin, PluginKind, Proposal};
use std::collections::BTreeSet;
use std::ops::Range;

/// The directives that make names for others.
const MAKERS: [&str; 5] = [
    "MakeNamedMaterial",
    "Texture",
    "ObjectBegin",
    "MakeNamedMedium",
    "CoordinateSystem",
];

/// The parameters whose strings are names of materials.
const MATERIAL_NAMES: [&str; 3] = ["materials", "namedmaterial1", "namedmaterial2"];

/// What a string after a directive is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum StringRole {
    /// The argument of this index.
    Argument(usize),
    /// The type and the name of a parameter.
    Head,
    /// A value of the parameter before.
    Value,
}

/// A directive and the strings that follow.
#[derive(Default)]
struct Statement<'t> {
    directive: Option<&'static Directive>,
    strings: Vec<(StringRole, Range<usize>, &'t str)>,
    is_in_list: bool,
    wants_value: bool,
}

impl<'t> Statement<'t> {
    fn of(name: &str) -> Self {
        Self {
            directive: DIRECTIVES.iter().find(|known| known.name == name),
            ..Self::default()
        }
    }

    /// Adds a token.
    fn push(&mut self, token: PbrtToken, text: &'t str) {
        match token.kind {
            PbrtTokenKind::Open => self.is_in_list = true,
            PbrtTokenKind::Close => (self.is_in_list, self.wants_value) = (false, false),
            PbrtTokenKind::Word => self.wants_value &= self.is_in_list,
            PbrtTokenKind::Quoted | PbrtTokenKind::Unterminated => {
                let arguments = self.directive.map_or(0, |own| own.arguments.len());
                let role = match self.strings.len() {
                    index if index < arguments => StringRole::Argument(index),
                    _ if self.wants_value => StringRole::Value,
                    _ => StringRole::Head,
                };
                self.wants_value = match role {
                    StringRole::Argument(_) => false,
                    StringRole::Head => true,
                    StringRole::Value => self.is_in_list,
                };
                self.strings.push((role, token.range(), text));
            }
        }
    }

    fn argument(&self, index: usize) -> Option<&'t str> {
        let (role, _, text) = self.strings.get(index)?;
        matches!(role, StringRole::Argument(_)).then_some(text)
    }

    /// The string of the parameter `type`.
    fn kind_of_named(&self) -> Option<&'t str> {
        let head = |(role, _, text): &(StringRole, Range<usize>, &str)| {
            *role == StringRole::Head && *text == "string type"
        };
        let at = self.strings.iter().position(head)?;
        let (role, _, text) = self.strings.get(at + 1)?;
        (*role == StringRole::Value).then_some(text)
    }

    /// The parameters of the plugin.
    fn parameters(&self) -> Vec<&'static DeclaredParameter> {
        let Some(directive) = self.directive else {
            return Vec::new();
        };
        let Some(kind) = directive.kind else {
            let mut targets = TARGETS.iter();
            let target = targets.find(|(word, _)| self.argument(0) == Some(*word));
            return target.map_or_else(Vec::new, |(_, kind)| kind.parameters());
        };
        let plugin = directive
            .arguments
            .iter()
            .position(|argument| matches!(argument, Argument::Plugin));
        let plugin = plugin.map_or_else(|| self.kind_of_named(), |at| self.argument(at));
        let plugin = plugin.and_then(|name| kind.find(name));
        match (plugin, directive.arguments.last()) {
            (Some(plugin), _) => Plugin::parameters(plugin).collect(),
            // The type comes first.
            (None, Some(Argument::Free)) => kind.parameters(),
            (None, _) => Vec::new(),
        }
    }
}

/// The statement at a byte of a text, and the names of all.
struct ScannedText<'t> {
    here: Statement<'t>,
    /// The word at the byte.
    word: Option<Range<usize>>,
    /// The end of the last token before the byte.
    last: usize,
    /// The directives that make names, and the names.
    names: Vec<(&'static str, &'t str)>,
}

impl<'t> ScannedText<'t> {
    fn new(text: &'t str, offset: usize) -> Self {
        let mut scanned = Self {
            here: Statement::default(),
            word: None,
            last: 0,
            names: Vec::new(),
        };
        let (mut current, mut at, mut is_found) = (Statement::default(), 0, false);
        while let Some(token) = token(text.as_bytes(), at) {
            let range = token.range();
            let own = text.get(range.clone()).unwrap_or_default();
            let is_word = token.kind == PbrtTokenKind::Word;
            at = range.end + usize::from(token.kind == PbrtTokenKind::Quoted);
            if is_word && range.start <= offset && offset <= range.end {
                scanned.word = Some(range.clone());
            }
            let is_directive = is_word && own.starts_with(|c: char| c.is_ascii_uppercase());
            if is_directive {
                if range.start > offset && !is_found {
                    is_found = true;
                    scanned.here = std::mem::take(&mut current);
                }
                current = Statement::of(own);
            } else {
                current.push(token, own);
            }
            if at <= offset {
                scanned.last = at;
            }
            let made = current.directive.map(|own| own.name);
            let made = made.filter(|name| current.strings.len() == 1 && MAKERS.contains(name));
            if let (Some(maker), Some(name)) = (made, current.argument(0)) {
                let made = (maker, name);
                if scanned.names.last() != Some(&made) {
                    scanned.names.push(made);
                }
            }
        }
        if !is_found {
            scanned.here = current;
        }
        scanned
    }

    fn made_by(&self, maker: &str) -> Vec<Proposal> {
        let mut known = BTreeSet::new();
        let made = self.names.iter().filter(|(own, _)| *own == maker);
        let names = made
            .map(|(_, name)| *name)
            .filter(|name| known.insert(*name));
        names.map(Proposal::name).collect()
    }

    /// What may stand in a string of the statement.
    fn proposals(&self, index: usize) -> Vec<Proposal> {
        let Some(directive) = self.here.directive else {
            return Vec::new();
        };
        match self.here.strings[index].0 {
            StringRole::Argument(at) => match directive.arguments[at] {
                Argument::Free => Vec::new(),
                Argument::Plugin => directive.kind.map_or_else(Vec::new, PluginKind::proposals),
                Argument::Word(words) => words.iter().map(|word| Proposal::name(word)).collect(),
                Argument::MadeBy(maker) => self.made_by(maker),
            },
            StringRole::Head => self.heads(index),
            StringRole::Value => self.values(directive, index),
        }
    }

    /// The types and names of parameters that the statement lacks.
    fn heads(&self, index: usize) -> Vec<Proposal> {
        let name = |head: &'_ str| head.split_ascii_whitespace().nth(1).map(str::to_owned);
        let strings = self.here.strings.iter().enumerate();
        let heads = strings.filter(|(at, (role, ..))| *at != index && *role == StringRole::Head);
        let given: Vec<_> = heads.filter_map(|(_, (_, _, head))| name(head)).collect();
        let parameters = self.here.parameters().into_iter();
        parameters
            .filter(|parameter| !given.iter().any(|given| given == parameter.name))
            .flat_map(|parameter| {
                let text = |kind: &str| format!("{kind} {}", parameter.name);
                parameter
                    .types()
                    .map(move |kind| parameter.proposal(text(kind)))
            })
            .collect()
    }

    /// The values of a parameter.
    fn values(&self, directive: &Directive, index: usize) -> Vec<Proposal> {
        let strings = self.here.strings.get(..index).unwrap_or_default();
        let head = strings.iter().rfind(|(role, ..)| *role == StringRole::Head);
        let mut head = head
            .map_or("", |(_, _, head)| head)
            .split_ascii_whitespace();
        match (head.next(), head.next(), directive.kind) {
            (Some("texture"), ..) => self.made_by("Texture"),
            (Some("bool"), ..) => ["true", "false"].map(Proposal::name).into(),
            (_, Some("type"), Some(kind)) => kind.proposals(),
            (_, Some(name), _) if MATERIAL_NAMES.contains(&name) => {
                self.made_by("MakeNamedMaterial")
            }
            _ => Vec::new(),
        }
    }
}

/// What may stand at a byte of a text; `None` where nothing is proposed.
pub(crate) fn completion(text: &str, offset: usize) -> Option<Completion> {
    let scanned = ScannedText::new(text, offset);
    // Within a string, of which the rest after white space may be another token.
    let mut strings = scanned.here.strings.iter();
    let inside = |range: &Range<usize>| range.start <= offset && offset <= range.end;
    if let Some(index) = strings.position(|(_, range, _)| inside(range)) {
        let range = scanned.here.strings[index].1.clone();
        let trimmed = text.get(range.clone())?.trim_end().len();
        return Some(Completion {
            replaced: range.start..(range.start + trimmed).max(offset),
            proposals: scanned.proposals(index),
        });
    }
    // A directive begins a line, or with a capital; not in a comment.
    let replaced = scanned.word.clone().unwrap_or(offset..offset);
    let before = text.get(..replaced.start)?;
    let gap = before.get(scanned.last.min(replaced.start)..)?;
    let is_comment = gap.rsplit('\n').next()?.contains('#');
    let begins_line = before.rsplit('\n').next()?.trim().is_empty();
    let is_capital = text
        .get(replaced.clone())?
        .starts_with(|c: char| c.is_ascii_uppercase());
    ((begins_line || is_capital) && !is_comment).then(|| Completion {
        replaced,
        proposals: DIRECTIVES
            .iter()
            .map(|own| Proposal::keyword(own.name, own.about))
            .collect(),
    })
}
