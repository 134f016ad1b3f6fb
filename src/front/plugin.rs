//! The plugins of pbrt and Mitsuba with their parameters, as tables that the readers and editors
//! share, and what an editor proposes at a place of a text.

use std::ops::Range;

/// A parameter of a plugin.
#[derive(Debug)]
pub(crate) struct DeclaredParameter {
    pub(crate) name: &'static str,
    /// The types that it may be written with, between spaces.
    types: &'static str,
    /// What it means, with its unit, as a sentence.
    about: &'static str,
}

/// A plugin that is read.
#[derive(Debug)]
pub(crate) struct Plugin {
    pub(crate) name: &'static str,
    /// What it is, as a sentence.
    about: &'static str,
    /// Its parameters: lists, of which some are those of several plugins.
    parameters: &'static [&'static [DeclaredParameter]],
}

/// The plugins of a kind, such as shapes.
#[derive(Debug)]
pub(crate) struct PluginKind {
    /// Those that are read.
    pub(crate) plugins: &'static [Plugin],
    /// Names that the reader replaces by something else, with a warning. Nobody proposes them.
    pub(crate) replaced: &'static [&'static str],
}

/// The name that [`PluginKind::known`] gives to an unknown one.
const UNKNOWN: &str = "?";

/// A parameter with its types, between spaces, and its meaning.
pub(crate) const fn parameter(
    name: &'static str,
    types: &'static str,
    about: &'static str,
) -> DeclaredParameter {
    DeclaredParameter { name, types, about }
}

/// A plugin with its meaning.
pub(crate) const fn plugin(
    name: &'static str,
    about: &'static str,
    parameters: &'static [&'static [DeclaredParameter]],
) -> Plugin {
    Plugin {
        name,
        about,
        parameters,
    }
}

impl DeclaredParameter {
    pub(crate) fn types(&self) -> impl Iterator<Item = &'static str> + Clone {
        self.types.split_ascii_whitespace()
    }

    /// The proposal to write it as `text`.
    pub(crate) fn proposal(&self, text: String) -> Proposal {
        Proposal::new(text, ProposalKind::Parameter, self.about)
    }
}

impl Plugin {
    pub(crate) fn parameters(&self) -> impl Iterator<Item = &'static DeclaredParameter> {
        self.parameters.iter().copied().flatten()
    }
}

impl PluginKind {
    /// A plugin that is read.
    pub(crate) fn find(&self, name: &str) -> Option<&'static Plugin> {
        self.plugins.iter().find(|plugin| plugin.name == name)
    }

    /// The name, if the table has it, and else one that no plugin has: the reader takes only names
    /// of the table.
    pub(crate) fn known(&self, name: &str) -> &'static str {
        let replaced = self.replaced.iter().copied();
        let mut names = self.names().chain(replaced);
        names.find(|known| *known == name).unwrap_or(UNKNOWN)
    }

    /// Whether the parameters of a plugin have these names; of an unknown one they have any.
    pub(crate) fn has_all(&self, plugin: &str, names: &[&str]) -> bool {
        self.find(plugin).is_none() || names.iter().all(|name| self.has(plugin, name))
    }

    /// Whether a plugin has a parameter of this name.
    pub(crate) fn has(&self, plugin: &str, name: &str) -> bool {
        let plugin = self.find(plugin);
        plugin.is_some_and(|plugin| plugin.parameters().any(|known| known.name == name))
    }

    /// The names of those that are read.
    pub(crate) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.plugins.iter().map(|plugin| plugin.name)
    }

    /// The parameters of all plugins, each name once.
    pub(crate) fn parameters(&self) -> Vec<&'static DeclaredParameter> {
        let mut found: Vec<&DeclaredParameter> = Vec::new();
        for parameter in self.plugins.iter().flat_map(Plugin::parameters) {
            if !found.iter().any(|known| known.name == parameter.name) {
                found.push(parameter);
            }
        }
        found
    }

    pub(crate) fn proposals(&self) -> Vec<Proposal> {
        let plugins = self.plugins.iter();
        let proposal =
            |own: &Plugin| Proposal::new(own.name.to_owned(), ProposalKind::Plugin, own.about);
        plugins.map(proposal).collect()
    }
}

/// What an editor proposes at a place.
#[derive(Clone, Debug)]
pub struct Completion {
    /// The bytes that a proposal replaces.
    pub replaced: Range<usize>,
    /// The proposals, the usual ones first.
    pub proposals: Vec<Proposal>,
}

/// A text that may stand at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Proposal {
    /// The text.
    pub text: String,
    /// What it is.
    pub kind: ProposalKind,
    /// What it means, as a sentence; empty for names of the scene.
    pub about: &'static str,
}

/// What a proposed text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProposalKind {
    /// A directive or an element.
    Keyword,
    /// The name of a plugin.
    Plugin,
    /// A parameter; of pbrt with its type.
    Parameter,
    /// A value or the name of something in the scene.
    Name,
}

impl Proposal {
    pub(crate) fn new(text: String, kind: ProposalKind, about: &'static str) -> Self {
        Self { text, kind, about }
    }

    /// A directive or an element.
    pub(crate) fn keyword(text: &str, about: &'static str) -> Self {
        Self::new(text.to_owned(), ProposalKind::Keyword, about)
    }

    /// The name of something in the scene.
    pub(crate) fn name(text: &str) -> Self {
        Self::new(text.to_owned(), ProposalKind::Name, "")
    }

    /// Whether it is what a text says; a parameter may have another type and
    /// spelling.
    fn is(&self, written: &str) -> bool {
        // Version 0 of Mitsuba has `intIOR` for `int_ior`.
        let name = |text: &str| {
            let name = text.rsplit(' ').next().unwrap_or_default();
            name.replace('_', "").to_lowercase()
        };
        match self.kind {
            ProposalKind::Parameter => name(&self.text) == name(written),
            ProposalKind::Keyword | ProposalKind::Plugin | ProposalKind::Name => {
                self.text == written
            }
        }
    }
}

impl Completion {
    /// The proposal that stands already there.
    #[must_use]
    pub fn written(&self, text: &str) -> Option<&Proposal> {
        let written = text.get(self.replaced.clone())?;
        self.proposals.iter().find(|own| own.is(written))
    }
}
