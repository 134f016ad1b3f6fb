//! What an editor proposes at a place of a Mitsuba scene, which may be incomplete there.

use super::plugins::{ELEMENTS, Element, SHAPES, find, kind};
use super::xml::current_tag;
use crate::plugin::{Completion, DeclaredParameter, PluginKind, Proposal};
use std::ops::Range;

/// The types of parameters that are elements with a plugin, to which a `<ref>` may lead.
const REFERRED: [&str; 3] = ["texture", "medium", "volume"];

/// The most elements that an end tag may close.
const MAX_DEPTH: usize = 64;

/// A start or end tag, closed or not.
struct XmlTag<'t> {
    name: Range<usize>,
    /// The attributes: names, and the bytes of values.
    attributes: Vec<(&'t str, Range<usize>)>,
    /// Behind its `>`, or where the next tag begins.
    end: usize,
    is_end_tag: bool,
    is_empty: bool,
    is_closed: bool,
}

/// An element that is not closed yet.
struct OpenElement<'t> {
    tag: &'t str,
    plugin: Option<&'t str>,
    version: Option<&'t str>,
    /// The names of the parameters before.
    given: Vec<&'t str>,
}

/// The text of a scene, read up to some byte.
struct XmlScanner<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> XmlScanner<'t> {
    fn rest(&self) -> &'t str {
        self.text.get(self.at..).unwrap_or_default()
    }

    /// The bytes up to a character, which are passed.
    fn until(&mut self, is_end: impl Fn(char) -> bool) -> Range<usize> {
        let start = self.at;
        self.at += self.rest().find(is_end).unwrap_or(self.rest().len());
        start..self.at
    }

    /// Passes a text that stands here.
    fn take(&mut self, known: &str) -> bool {
        let is_here = self.rest().starts_with(known);
        self.at += if is_here { known.len() } else { 0 };
        is_here
    }

    /// The tag of the next `<`; comments and declarations are passed.
    fn next_tag(&mut self) -> Option<XmlTag<'t>> {
        const PASSED: [(&str, &str); 3] = [("<!--", "-->"), ("<?", "?>"), ("<!", ">")];
        loop {
            self.until(|c| c == '<');
            let mut passed = PASSED.iter();
            let Some((_, end)) = passed.find(|(start, _)| self.take(start)) else {
                return self.take("<").then(|| self.tag());
            };
            let length = self.rest().find(end).map(|at| at + end.len());
            self.at += length.unwrap_or(self.rest().len());
        }
    }

    /// A tag behind its `<`. It ends at the next one if it is not closed.
    fn tag(&mut self) -> XmlTag<'t> {
        let is_end_tag = self.take("/");
        let mut tag = XmlTag {
            name: self.until(ends_name),
            attributes: Vec::new(),
            end: self.at,
            is_end_tag,
            is_empty: false,
            is_closed: false,
        };
        loop {
            self.until(|c| !c.is_whitespace());
            match self.rest().chars().next() {
                None | Some('<') => break,
                Some('>') => {
                    tag.is_closed = self.take(">");
                    break;
                }
                Some('/') => tag.is_empty = self.take("/"),
                Some('=' | '"' | '\'') => self.at += 1,
                Some(_) => {
                    let name = self.until(ends_name);
                    tag.attributes.extend(self.value(name));
                }
            }
        }
        tag.end = self.at;
        tag
    }

    /// The value that follows the name of an attribute. One without a second quote ends at a tag.
    fn value(&mut self, name: Range<usize>) -> Option<(&'t str, Range<usize>)> {
        self.until(|c| !c.is_whitespace() && c != '=');
        let quote = self.rest().chars().next();
        let quote = quote.filter(|quote| matches!(quote, '"' | '\''))?;
        self.at += 1;
        let value = self.until(|c| c == quote || c == '<');
        if self.rest().starts_with(quote) {
            self.at += 1;
        }
        Some((self.text.get(name)?, value))
    }
}

/// The elements around a byte, the tag that it is in, and the ids of the whole text.
struct ScannedScene<'t> {
    text: &'t str,
    open: Vec<OpenElement<'t>>,
    here: Option<XmlTag<'t>>,
    ids: Vec<&'t str>,
}

impl<'t> ScannedScene<'t> {
    fn new(text: &'t str, offset: usize) -> Self {
        let mut scanner = XmlScanner { text, at: 0 };
        let (mut open, mut ids) = (Vec::new(), Vec::new());
        let (mut here, mut is_found) = (None, false);
        while let Some(tag) = scanner.next_tag() {
            let own = |tag: &XmlTag<'t>, name| attribute(text, tag, name);
            let name = text.get(tag.name.clone()).unwrap_or_default();
            ids.extend(own(&tag, "id").filter(|_| name != "ref" && name != "alias"));
            let is_inside = tag.name.start <= offset
                && (offset < tag.end || offset == tag.end && !tag.is_closed);
            is_found |= is_inside || tag.name.start > offset;
            if is_inside {
                here = Some(tag);
            } else if !is_found {
                enter(&mut open, text, &tag);
            }
        }
        Self {
            text,
            open,
            here,
            ids,
        }
    }

    /// The parameters of the plugin around: of one that is not known, those of all.
    fn parameters(&self) -> Vec<&'static DeclaredParameter> {
        let Some(parent) = self.open.last() else {
            return Vec::new();
        };
        let Some(kind) = kind(parent.tag) else {
            return Vec::new();
        };
        match parent.plugin.and_then(|name| kind.find(name)) {
            Some(plugin) => plugin.parameters().collect(),
            None => kind.parameters(),
        }
    }

    /// The elements that may stand here: the fixed ones, and the types of parameters.
    fn elements(&self) -> Vec<Proposal> {
        let parent = self.open.last();
        let around = parent.and_then(|parent| Some((parent, find(parent.tag)?.children)));
        let Some((parent, children)) = around else {
            // Before the root.
            return ELEMENTS.first().map(proposal).into_iter().collect();
        };
        let leaf = parent.plugin.filter(|name| *name != "shapegroup");
        let is_group = leaf.and_then(|name| SHAPES.find(name)).is_none();
        let fixed = children
            .iter()
            .filter(|name| **name != "shape" || parent.tag == "scene" || is_group);
        let mut names: Vec<&str> = fixed.copied().collect();
        let parameters = self.parameters().into_iter();
        for name in parameters.flat_map(DeclaredParameter::types) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        names.into_iter().filter_map(find).map(proposal).collect()
    }

    /// The parameters that the plugin around lacks, of a type.
    fn lacking(&self, tag: &str) -> Vec<Proposal> {
        let Some(parent) = self.open.last() else {
            return Vec::new();
        };
        let version = self.open.first().and_then(|scene| scene.version);
        let is_old = version.is_some_and(|version| version.starts_with("0."));
        let fits = |own: &&DeclaredParameter| {
            own.types()
                .any(|kind| kind == tag || tag == "ref" && REFERRED.contains(&kind))
        };
        let parameters = self.parameters().into_iter().filter(fits);
        let texts = parameters.map(|own| match is_old {
            true => own.proposal(camel_case(own.name)),
            false => own.proposal(own.name.to_owned()),
        });
        texts
            .filter(|own| !parent.given.contains(&own.text.as_str()))
            .collect()
    }

    /// The values of an attribute.
    fn values(&self, tag: &str, attribute: &str) -> Vec<Proposal> {
        match (tag, attribute) {
            ("ref" | "alias", "id") => self.ids.iter().map(|id| Proposal::name(id)).collect(),
            ("boolean", "value") => ["true", "false"].map(Proposal::name).into(),
            (_, "name") => self.lacking(tag),
            (_, "type") => kind(tag).map_or_else(Vec::new, PluginKind::proposals),
            _ => Vec::new(),
        }
    }

    /// What may stand at a byte within the tag.
    fn completion(&self, offset: usize) -> Option<Completion> {
        let tag = self.here.as_ref()?;
        let name = self.text.get(tag.name.clone())?;
        if offset <= tag.name.end {
            let ended = self.open.last().filter(|_| tag.is_end_tag);
            let ended = ended.map(|open| vec![Proposal::keyword(open.tag, "")]);
            return Some(Completion {
                replaced: tag.name.clone(),
                proposals: ended.unwrap_or_else(|| self.elements()),
            });
        }
        let mut attributes = tag.attributes.iter();
        let inside = |range: &Range<usize>| range.start <= offset && offset <= range.end;
        let (attribute, range) = attributes.find(|(_, range)| inside(range))?;
        // Of a value without its second quote the word under the cursor.
        let value = self.text.get(range.clone())?;
        let end = range.start + value.find(ends_name).unwrap_or(value.len());
        Some(Completion {
            replaced: range.start..end.max(offset),
            proposals: self.values(name, attribute),
        })
    }
}

/// Whether a character ends a name or a word.
fn ends_name(c: char) -> bool {
    c.is_whitespace() || "=<>/\"'".contains(c)
}

/// Enters an element, or leaves those that end.
fn enter<'t>(open: &mut Vec<OpenElement<'t>>, text: &'t str, tag: &XmlTag<'t>) {
    let name = current_tag(text.get(tag.name.clone()).unwrap_or_default());
    if tag.is_end_tag {
        let deepest = open.len().saturating_sub(MAX_DEPTH);
        let last = open
            .iter()
            .skip(deepest)
            .rposition(|element| element.tag == name);
        return open.truncate(last.map_or(open.len(), |at| deepest + at));
    }
    let own = |name| attribute(text, tag, name);
    if let Some(parent) = open.last_mut() {
        parent.given.extend(own("name"));
    }
    let holds = |element: &Element| element.kind.is_some() || !element.children.is_empty();
    let is_left_open = tag.is_closed || find(name).is_some_and(holds);
    if !tag.is_empty && is_left_open {
        open.push(OpenElement {
            tag: name,
            plugin: own("type"),
            version: own("version"),
            given: Vec::new(),
        });
    }
}

fn attribute<'t>(text: &'t str, tag: &XmlTag<'t>, name: &str) -> Option<&'t str> {
    let mut attributes = tag.attributes.iter();
    let (_, range) = attributes.find(|(own, _)| *own == name)?;
    text.get(range.clone())
}

fn proposal(element: &Element) -> Proposal {
    Proposal::keyword(element.name, element.about)
}

/// A name as version 0 spells it: `to_world` is `toWorld`, and `int_ior` is `intIOR`.
fn camel_case(name: &str) -> String {
    let words = name
        .split('_')
        .enumerate()
        .map(|(at, word)| match (at, word) {
            (0, word) => word.to_owned(),
            (_, "ior") => "IOR".to_owned(),
            (_, word) => {
                let (first, rest) = word.split_at(word.len().min(1));
                first.to_ascii_uppercase() + rest
            }
        });
    words.collect()
}

/// What may stand at a byte of a text; `None` where nothing is proposed.
pub(crate) fn completion(text: &str, offset: usize) -> Option<Completion> {
    ScannedScene::new(text, offset).completion(offset)
}
