//! What a scene says and no plugin reads: properties that it does not have, of a type that it does
//! not take, or given twice, and references to nothing.

use super::Lowering;
use super::plugins;
use super::xml::{PluginNode, Property, Value, XmlElement, XmlReader, offset};
use crate::plugin::{DeclaredParameter, Plugin};
use rtc_diag::{Diagnostic, clip, codes, nearest};
use rtc_source::{FileId, Span};
use std::collections::BTreeSet;

/// The BSDFs that take a texture by any name, or by none.
const TAKE_ANY_TEXTURE: [&str; 4] = ["mask", "blendbsdf", "bumpmap", "normalmap"];

impl Value {
    /// Its element, for a message.
    fn element(&self) -> &'static str {
        match self {
            Self::Bool(_) => "boolean",
            Self::Number(_) => "float",
            Self::String(_) => "string",
            Self::Vector(_) => "vector",
            Self::Color(_) => "rgb",
            Self::Transform(_) => "transform",
        }
    }

    /// Whether it is read as a parameter of a type.
    fn is_of(&self, kind: &str) -> bool {
        match self {
            Self::Bool(_) => kind == "boolean",
            Self::Number(_) => matches!(kind, "float" | "integer" | "rgb" | "spectrum"),
            Self::String(_) => kind == "string",
            Self::Vector(_) => matches!(kind, "point" | "vector"),
            // The luminance of a colour is a number where a texture may be one.
            Self::Color(_) => matches!(kind, "rgb" | "spectrum" | "texture"),
            Self::Transform(_) => kind == "transform",
        }
    }
}

impl<'run> Lowering<'run> {
    /// Warns of what has no effect in any element.
    pub(super) fn report_unused(&mut self, root: &'run PluginNode) {
        let mut nodes = Vec::new();
        root.visit(&mut |node| nodes.push(node));
        let mut ids = BTreeSet::new();
        for node in nodes {
            if let Some(id) = &node.id
                && !ids.insert(id.text.as_str())
            {
                let message = format!(
                    "the id `{}` is given twice: the last one counts",
                    clip(&id.text)
                );
                self.doubtful(id.span, message);
            }
            if matches!(node.tag.as_str(), "ref" | "alias") && self.shared_node(node).is_none() {
                let message = format!(
                    "there is no element with the id `{}`",
                    clip(&node.plugin.text)
                );
                let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
                self.sink
                    .push(diagnostic.at(node.plugin.span, "refers to nothing"));
            }
            self.report_unused_of(node);
        }
    }

    /// Warns of the properties and textures of an element that its plugin does not have.
    fn report_unused_of(&mut self, node: &'run PluginNode) {
        let plugin = plugins::kind(&node.tag).map(|kind| kind.find(&node.plugin.text));
        let plugin = match plugin {
            // What an unknown plugin has goes with it.
            Some(None) => return,
            Some(Some(plugin)) => Some(plugin),
            None => None,
        };
        let mut given = BTreeSet::new();
        for Property { name, value } in &node.properties {
            self.report_twice(&mut given, &name.text, name.span);
            let is_read = |known: &DeclaredParameter| known.types().any(|kind| value.is_of(kind));
            self.report_unread(
                node,
                plugin,
                (&name.text, name.span),
                (value.element(), &is_read),
            );
        }
        if node.tag != "scene" {
            self.report_misplaced(node);
        }
        if plugin.is_some_and(|plugin| TAKE_ANY_TEXTURE.contains(&plugin.name)) {
            return;
        }
        for child in &node.children {
            let target = self.shared_node(child).unwrap_or(child);
            let kind = match target.tag.as_str() {
                "texture" | "spectrum" | "rgb" | "srgb" => "texture",
                "volume" => "volume",
                _ => continue,
            };
            let is_global = node.tag == "scene" && child.tag != "ref";
            if is_global {
                continue;
            }
            let name = child.name.as_deref().unwrap_or_default();
            self.report_twice(&mut given, name, child.span);
            // A colour that others refer to is read like one given here.
            let is_constant = target.constant().is_some();
            let is_read = |known: &DeclaredParameter| {
                let mut types = known.types();
                types.any(|own| own == kind || own == "volume" || is_constant && own == "rgb")
            };
            self.report_unread(node, plugin, (name, child.span), (kind, &is_read));
        }
    }

    /// Warns of elements that have no effect in another one, and of a second one where one counts.
    fn report_misplaced(&mut self, node: &'run PluginNode) {
        /// The elements of which one counts.
        const SINGLE: [&str; 6] = ["bsdf", "emitter", "film", "sampler", "rfilter", "phase"];
        let known = plugins::find(&node.tag).map_or(&[][..], |element| element.children);
        let mut seen = BTreeSet::new();
        for child in &node.children {
            let tag = self.shared_node(child).unwrap_or(child).tag.as_str();
            let is_value = matches!(
                tag,
                "texture" | "spectrum" | "rgb" | "srgb" | "volume" | "ref"
            );
            if !is_value && !known.contains(&tag) {
                self.ignored_element(child);
            } else if SINGLE.contains(&tag) && node.tag != "bsdf" && !seen.insert(tag) {
                self.doubtful(child.span, format!("a second `<{tag}>` has no effect here"));
            }
        }
    }

    fn report_twice<'n>(&mut self, given: &mut BTreeSet<&'n str>, name: &'n str, span: Span) {
        if !given.insert(name) {
            let message = format!("`{}` is given twice: the first one counts", clip(name));
            self.doubtful(span, message);
        }
    }

    /// Warns of a parameter that the plugin does not have, or does not read from such an element.
    fn report_unread(
        &mut self,
        node: &PluginNode,
        plugin: Option<&'static Plugin>,
        (name, span): (&str, Span),
        (element, is_read): (&str, &dyn Fn(&DeclaredParameter) -> bool),
    ) {
        let parameters = || plugin.into_iter().flat_map(Plugin::parameters);
        let known = parameters().find(|known| known.name == name);
        if known.is_some_and(is_read) {
            return;
        }
        let own = match node.plugin.text.as_str() {
            "" => format!("`<{}>`", node.tag),
            plugin => format!("the {} `{}`", node.tag, clip(plugin)),
        };
        let name = clip(name);
        let message = match known {
            Some(_) => format!("`{name}` of {own} is no `<{element}>`: it has no effect"),
            None if name.is_empty() => {
                format!("a `<{element}>` without a name has no effect in {own}")
            }
            None => format!("`{name}` of {own} has no effect"),
        };
        let mut diagnostic = Diagnostic::new(&codes::MITSUBA_IGNORED, message).at(span, "");
        if let Some(known) = known {
            let types: Vec<_> = known.types().map(|kind| format!("`<{kind}>`")).collect();
            diagnostic = diagnostic.hint(format!("it is written as {}", types.join(" or ")));
        } else if let Some(near) = nearest(&name, parameters().map(|known| known.name)) {
            diagnostic = diagnostic.hint(format!("did you mean `{near}`?"));
        }
        self.sink.push(diagnostic);
    }
}

impl XmlReader<'_> {
    /// Warns of the attributes that an element does not have.
    pub(super) fn unknown_attributes(&mut self, file: FileId, root: XmlElement<'_, '_>) {
        for element in root.descendants().filter(XmlElement::is_element) {
            let tag = element.tag_name().name();
            let known = attributes(tag);
            for attribute in element.attributes() {
                if known.contains(&attribute.name()) {
                    continue;
                }
                let range = attribute.range_qname();
                let span = Span::new(file, offset(range.start), offset(range.end));
                let name = clip(attribute.name());
                let message = format!("`{name}` of `<{}>` has no effect", clip(tag));
                let mut diagnostic = Diagnostic::new(&codes::MITSUBA_IGNORED, message).at(span, "");
                if let Some(near) = nearest(attribute.name(), known.iter().copied()) {
                    diagnostic = diagnostic.hint(format!("did you mean `{near}`?"));
                }
                self.sink.push(diagnostic);
            }
        }
    }
}

/// The attributes of an element.
fn attributes(tag: &str) -> &'static [&'static str] {
    match tag {
        "scene" => &["version"],
        "default" => &["name", "value"],
        "include" => &["filename"],
        "alias" => &["id", "as"],
        "path" => &["value"],
        "translate" | "scale" => &["x", "y", "z", "value"],
        "rotate" => &["x", "y", "z", "value", "angle"],
        "lookat" | "lookAt" => &["origin", "target", "up"],
        "matrix" => &["value"],
        "point" | "vector" => &["name", "value", "x", "y", "z"],
        "transform" => &["name", "time", "id"],
        "ref" => &["name", "id"],
        // An intent says whether light is emitted, which its place says, too.
        "spectrum" => &["name", "value", "type", "id", "filename", "intent"],
        "rgb" | "srgb" => &["name", "value", "type", "id", "intent"],
        "blackbody" => &["name", "temperature", "scale"],
        "float" | "integer" | "boolean" | "string" => &["name", "value", "id"],
        _ => &["type", "id", "name"],
    }
}
