//! The XML of a Mitsuba scene as a tree of plugins with their properties.

use super::bounds;
use super::value;
use crate::exchange::{SpannedText, transform::AffineTransform};
use crate::{FrontOptions, over_limit};
use roxmltree::{Document, ParsingOptions};
use rtc_diag::{Diagnostic, DiagnosticSink, clip, clip_words, codes};
use rtc_source::{FileId, FileKind, FileSearch, LimitExceeded, Loader, Resource, SourceMap, Span};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// The deepest nesting of elements and of included files.
const MAX_DEPTH: usize = 64;
/// The largest number of included files.
const MAX_FILES: usize = 256;
/// The most folders of `<path>`: each is searched for each file.
const MAX_FOLDERS: usize = 32;
/// The longest attribute after its parameters are replaced, in bytes.
const MAX_ATTRIBUTE: usize = 1 << 20;
/// The memory of an element, in bytes, rounded up.
const ELEMENT_BYTES: u64 = 768;
/// The memory of a document for each byte of its text, at most: an element of four bytes is a node
/// of 96, in a list that grows by doubling.
const DOCUMENT_BYTES: u64 = 24;
/// The largest included file, in bytes.
const MAX_BYTES: u64 = 1 << 28;

/// Included scenes.
const SCENES: FileKind = FileKind {
    extensions: &["xml"],
    begins: |head| String::from_utf8_lossy(head).trim_start().starts_with('<'),
};

/// An element that creates a plugin, or a reference to one (`ref`, whose plugin is the id; an
/// `alias` gives its target the name too).
#[derive(Clone, Debug)]
pub(super) struct PluginNode {
    /// `shape`, `bsdf`, `emitter`, …
    pub(super) tag: String,
    /// The `type`.
    pub(super) plugin: SpannedText,
    /// The `id`.
    pub(super) id: Option<SpannedText>,
    /// The `name`, which is the role of the element in its parent.
    pub(super) name: Option<String>,
    pub(super) properties: Vec<Property>,
    pub(super) children: Vec<PluginNode>,
    pub(super) span: Span,
    /// The major version of its file.
    pub(super) version: u32,
}

/// A property of a plugin.
#[derive(Clone, Debug)]
pub(super) struct Property {
    pub(super) name: SpannedText,
    pub(super) value: Value,
}

/// The value of a property.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Bool(bool),
    Number(f64),
    String(SpannedText),
    Vector([f64; 3]),
    Color([f64; 3]),
    Transform(AffineTransform),
}

impl PluginNode {
    /// Visits the node and all below it.
    pub(super) fn visit<'n>(&'n self, visit: &mut dyn FnMut(&'n Self)) {
        visit(self);
        for child in &self.children {
            child.visit(visit);
        }
    }

    /// Adds a texture; one that is constant becomes a property, unless others refer to it.
    fn add_spectrum(&mut self, texture: Self) {
        let constant = texture.constant().filter(|_| texture.id.is_none());
        match (constant, &texture.name) {
            (Some(color), Some(name)) => self.properties.push(Property {
                name: SpannedText {
                    text: name.clone(),
                    span: texture.span,
                },
                value: Value::Color(color),
            }),
            _ => self.children.push(texture),
        }
    }

    pub(super) fn get(&self, name: &str) -> Option<&Value> {
        let mut properties = self.properties.iter();
        properties
            .find(|property| property.name.text == name)
            .map(|property| &property.value)
    }

    pub(super) fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// A count: a number that is rounded and not negative.
    pub(super) fn count(&self, name: &str) -> Option<u32> {
        let number = self.number(name)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates"
        )]
        Some(number.round() as u32)
    }

    pub(super) fn flag(&self, name: &str) -> Option<bool> {
        match self.get(name)? {
            Value::Bool(flag) => Some(*flag),
            _ => None,
        }
    }

    pub(super) fn string(&self, name: &str) -> Option<&SpannedText> {
        match self.get(name)? {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    pub(super) fn vector(&self, name: &str) -> Option<[f64; 3]> {
        match self.get(name)? {
            Value::Vector(vector) => Some(*vector),
            _ => None,
        }
    }

    /// A colour; a number is grey.
    pub(super) fn color(&self, name: &str) -> Option<[f64; 3]> {
        match self.get(name)? {
            Value::Color(color) => Some(*color),
            Value::Number(number) => Some([*number; 3]),
            _ => None,
        }
    }

    /// The transform `to_world`, or another one.
    pub(super) fn transform(&self, name: &str) -> AffineTransform {
        match self.get(name) {
            Some(Value::Transform(transform)) => *transform,
            _ => AffineTransform::IDENTITY,
        }
    }

    /// The child that is used for `name`.
    pub(super) fn child(&self, name: &str) -> Option<&Self> {
        let mut children = self.children.iter();
        children.find(|child| child.name.as_deref() == Some(name))
    }
}

/// Reads a scene.
pub(super) fn read(
    file: FileId,
    map: &mut SourceMap,
    options: &FrontOptions,
    sink: &mut DiagnosticSink,
) -> Option<PluginNode> {
    let folder = map.folder(file);
    let search = FileSearch::new(folder, options.asset_root.as_deref())
        .with_parent(folder, options.home.as_deref());
    let mut reader = XmlReader {
        map,
        sink,
        search,
        defaults: options.define.clone(),
        used: BTreeSet::new(),
        version: 3,
        depth: 0,
        files: 0,
        has_unset: false,
        is_exhausted: false,
        folders: 0,
        included: BTreeMap::new(),
    };
    let root = reader.file(file)?;
    for name in options.define.keys() {
        if !reader.used.contains(name) {
            let message = format!("the scene has no parameter `${}`", clip(name));
            let diagnostic = Diagnostic::new(&codes::MITSUBA_IGNORED, message);
            let label = "its value of the command line has no effect";
            reader.sink.push(diagnostic.at(root.span, label));
        }
    }
    Some(root)
}

/// The state of reading: one for a scene and the files that it includes.
pub(super) struct XmlReader<'run> {
    map: &'run mut SourceMap,
    pub(super) sink: &'run mut DiagnosticSink,
    search: FileSearch,
    /// The parameters `$name` and their values.
    defaults: BTreeMap<String, String>,
    /// The parameters that an attribute refers to.
    used: BTreeSet<String>,
    /// The major version of the file.
    pub(super) version: u32,
    /// The number of open files.
    depth: usize,
    /// The number of included files.
    files: usize,
    /// Whether the last attribute has a parameter without a value.
    has_unset: bool,
    /// Whether the budget is exceeded, which is reported once.
    is_exhausted: bool,
    /// The number of folders of `<path>`.
    folders: usize,
    /// The included files.
    included: BTreeMap<PathBuf, FileId>,
}

/// An element of the document in one file.
pub(super) type XmlElement<'d, 'i> = roxmltree::Node<'d, 'i>;

impl XmlReader<'_> {
    fn file(&mut self, file: FileId) -> Option<PluginNode> {
        // The file must be UTF-8 without a DTD.
        let Some(text) = self.map.text(file).map(str::to_owned) else {
            let message = "the scene is not UTF-8 text";
            let span = Span::new(file, 0, 0);
            self.sink
                .push(Diagnostic::new(&codes::NOT_UTF8, message).at(span, ""));
            return None;
        };
        if let Some((at, message)) = bounds::excess(&text) {
            let at = offset(at);
            let diagnostic = Diagnostic::new(&codes::MITSUBA_XML, message);
            self.sink
                .push(diagnostic.at(Span::new(file, at, at), "here"));
            return None;
        }
        // The document takes memory beside the elements that are kept.
        let document = DOCUMENT_BYTES * text.len() as u64;
        if let Err(fault) = self.map.budget().has(Resource::Memory, document) {
            self.exhaust(&fault, Span::new(file, 0, 0));
            return None;
        }
        let limit = self.map.budget().remaining(Resource::Nodes);
        let options = ParsingOptions {
            allow_dtd: false,
            nodes_limit: u32::try_from(limit).unwrap_or(u32::MAX),
            ..ParsingOptions::default()
        };
        let document = match Document::parse_with_options(&text, options) {
            Ok(document) => document,
            Err(error) => {
                self.not_xml(file, &text, &error);
                return None;
            }
        };
        // Charge the elements before they are read.
        let nodes = document.descendants().count() as u64;
        let budget = self.map.budget();
        let charged = budget
            .charge(Resource::Nodes, nodes)
            .and_then(|()| budget.charge(Resource::Memory, nodes * ELEMENT_BYTES));
        if let Err(fault) = charged {
            self.exhaust(&fault, Span::new(file, 0, 0));
            return None;
        }
        // The root element is a scene of a known version.
        let root = document.root_element();
        if !root.has_tag_name(super::ROOT) {
            let message = format!("the root element is `<{}>`", clip(root.tag_name().name()));
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
            self.sink
                .push(diagnostic.at(span(file, &root), "a scene is a `<scene>`"));
            return None;
        }
        let version = root.attribute("version").unwrap_or("3.0.0");
        self.version = version
            .split('.')
            .next()
            .and_then(|major| major.parse().ok())
            .unwrap_or(3);
        self.unknown_attributes(file, root);
        Some(self.node(file, root, 0))
    }

    /// Reports the first mistake of the syntax.
    fn not_xml(&mut self, file: FileId, text: &str, error: &roxmltree::Error) {
        let position = error.pos();
        let line_start: usize = text
            .split_inclusive('\n')
            .take(position.row.saturating_sub(1) as usize)
            .map(str::len)
            .sum();
        let line = text[line_start..].lines().next().unwrap_or_default();
        let column: usize = line
            .chars()
            .take(position.col.saturating_sub(1) as usize)
            .map(char::len_utf8)
            .sum();
        let at = offset(line_start + column);
        let message = format!("the text is not XML: {}", clip_words(&error.to_string()));
        let diagnostic = Diagnostic::new(&codes::MITSUBA_XML, message);
        self.sink
            .push(diagnostic.at(Span::new(file, at, at), "here"));
    }

    /// An element and all below it.
    fn node(&mut self, file: FileId, element: XmlElement<'_, '_>, depth: usize) -> PluginNode {
        let tag = current_tag(element.tag_name().name());
        let element_span = span(file, &element);
        let attribute = |reader: &mut Self, name: &str| reader.attribute(file, element, name);
        let plugin = match tag {
            "ref" => attribute(self, "id"),
            _ => attribute(self, "type"),
        };
        let mut node = PluginNode {
            tag: tag.to_owned(),
            plugin: plugin.unwrap_or(SpannedText {
                text: String::new(),
                span: element_span,
            }),
            id: (tag != "ref").then(|| attribute(self, "id")).flatten(),
            name: attribute(self, "name").map(|name| self.property_name(&name.text)),
            properties: Vec::new(),
            children: Vec::new(),
            version: self.version,
            span: element_span,
        };
        if depth >= MAX_DEPTH {
            let message = format!("elements are nested more than {MAX_DEPTH} deep");
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
            self.sink.push(diagnostic.at(element_span, ""));
            return node;
        }
        for child in element.children().filter(XmlElement::is_element) {
            match child.tag_name().name() {
                "default" => self.default_value(file, child),
                "include" => node.children.extend(self.include(file, child)),
                "alias" => node.children.extend(self.alias(file, child)),
                "path" => node.children.extend(self.search_path(file, child)),
                "ref" | "shape" | "bsdf" | "emitter" | "luminaire" | "sensor" | "camera"
                | "integrator" | "film" | "sampler" | "rfilter" | "medium" | "phase" | "volume"
                | "subsurface" => {
                    node.children.push(self.node(file, child, depth + 1));
                }
                "texture" => node.add_spectrum(self.node(file, child, depth + 1)),
                "spectrum" | "rgb" | "srgb" if child.has_attribute("type") => {
                    node.add_spectrum(self.node(file, child, depth + 1));
                }
                _ => node.properties.extend(self.property(file, child)),
            }
        }
        node
    }

    fn exhaust(&mut self, fault: &LimitExceeded, span: Span) {
        if !self.is_exhausted {
            self.sink.push(over_limit("the scene", fault).at(span, ""));
        }
        self.is_exhausted = true;
    }

    /// `<path value="…">`: a folder that is searched for files, as the plugin of its node.
    fn search_path(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Option<PluginNode> {
        let Some(value) = self.attribute(file, element, "value") else {
            self.missing(file, element, "`value`");
            return None;
        };
        self.folders += 1;
        if self.folders > MAX_FOLDERS {
            let message = format!("more than {MAX_FOLDERS} folders are searched");
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
            self.sink.push(diagnostic.at(value.span, "this one is not"));
            return None;
        }
        Some(PluginNode {
            tag: "path".to_owned(),
            plugin: value,
            id: None,
            name: None,
            properties: Vec::new(),
            children: Vec::new(),
            span: span(file, &element),
            version: self.version,
        })
    }

    /// `<alias id="…" as="…">`: another id for an element.
    fn alias(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Option<PluginNode> {
        let id = self.attribute(file, element, "id");
        let name = self.attribute(file, element, "as");
        let (Some(plugin), Some(name)) = (id, name) else {
            self.missing(file, element, "`id` and `as`");
            return None;
        };
        Some(PluginNode {
            tag: "alias".to_owned(),
            plugin,
            id: Some(name),
            name: None,
            properties: Vec::new(),
            children: Vec::new(),
            span: span(file, &element),
            version: self.version,
        })
    }

    fn default_value(&mut self, file: FileId, element: XmlElement<'_, '_>) {
        let (Some(name), Some(value)) = (element.attribute("name"), element.attribute("value"))
        else {
            return self.missing(file, element, "`name` and `value`");
        };
        // The first value counts: a scene that includes a file sets the parameters of that file.
        self.defaults
            .entry(name.to_owned())
            .or_insert_with(|| value.to_owned());
    }

    /// The children of an included file.
    fn include(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Vec<PluginNode> {
        let Some(path) = self.attribute(file, element, "filename") else {
            self.missing(file, element, "`filename`");
            return Vec::new();
        };
        // The number and the depth of included files are bounded.
        if self.is_exhausted {
            return Vec::new();
        }
        self.files += 1;
        if self.depth >= MAX_DEPTH || self.files > MAX_FILES {
            let message = format!(
                "more than {MAX_FILES} files are included, or they are nested more than \
                 {MAX_DEPTH} deep"
            );
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
            self.sink.push(diagnostic.at(path.span, ""));
            return Vec::new();
        }
        // Read it as part of this scene.
        let Some(included) = self.included_file(&path) else {
            return Vec::new();
        };
        let version = self.version;
        self.depth += 1;
        let root = self.file(included);
        self.depth -= 1;
        self.version = version;
        root.map(|mut root| std::mem::take(&mut root.children))
            .unwrap_or_default()
    }

    /// An included file, which is read the first time.
    fn included_file(&mut self, path: &SpannedText) -> Option<FileId> {
        let Ok(found) = self.search.find(&path.text, &SCENES) else {
            let message = format!("there is no file `{}`", clip(&path.text));
            let diagnostic = Diagnostic::new(&codes::FILE_NOT_FOUND, message);
            self.sink.push(diagnostic.at(path.span, "included here"));
            return None;
        };
        if let Some(known) = self.included.get(&found.path) {
            return Some(*known);
        }
        match Loader.found(&found, MAX_BYTES, self.map) {
            Ok(bytes) => {
                let file = self.map.add_found(&found, bytes);
                self.included.insert(found.path, file);
                Some(file)
            }
            Err(error) => {
                let message = format!("can't read `{}`: {error}", found.shown.display());
                let diagnostic = Diagnostic::new(&codes::CANNOT_READ, message);
                self.sink.push(diagnostic.at(path.span, "included here"));
                None
            }
        }
    }

    /// An attribute with its parameters replaced.
    pub(super) fn attribute(
        &mut self,
        file: FileId,
        element: XmlElement<'_, '_>,
        name: &str,
    ) -> Option<SpannedText> {
        // An attribute without parameters is used as it stands.
        let attribute = element.attribute_node(name)?;
        let range = attribute.range_value();
        let span = Span::new(file, offset(range.start), offset(range.end));
        let text = attribute.value();
        if !text.contains('$') {
            let text = text.to_owned();
            return Some(SpannedText { text, span });
        }
        // Replace each parameter by its value.
        let mut filled = String::new();
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            filled.push_str(&rest[..at]);
            let after = &rest[at + 1..];
            let end = after.find(|c: char| !(c.is_alphanumeric() || c == '_'));
            let parameter = &after[..end.unwrap_or(after.len())];
            self.used.insert(parameter.to_owned());
            match self.defaults.get(parameter) {
                Some(value) if filled.len() + value.len() > MAX_ATTRIBUTE => {
                    let message = format!("an attribute has more than {MAX_ATTRIBUTE} bytes");
                    let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
                    self.sink.push(diagnostic.at(span, "expanded here"));
                    self.has_unset = true;
                    return None;
                }
                Some(value) => filled.push_str(value),
                None => {
                    let message = format!("the parameter `${}` has no value", clip(parameter));
                    let diagnostic = Diagnostic::new(&codes::MITSUBA_IGNORED, message);
                    let hint =
                        "give it one by `<default name=\"…\" value=\"…\"/>`, or by `-D NAME=VALUE`";
                    let label = "this attribute is ignored";
                    self.sink.push(diagnostic.at(span, label).hint(hint));
                    self.has_unset = true;
                    return None;
                }
            }
            rest = &after[parameter.len()..];
        }
        filled.push_str(rest);
        // Charge the expanded text.
        let budget = self.map.budget();
        if let Err(fault) = budget.charge(Resource::Memory, 2 * filled.len() as u64) {
            self.exhaust(&fault, span);
            self.has_unset = true;
            return None;
        }
        Some(SpannedText { text: filled, span })
    }

    /// A name as version 3 spells it: `toWorld` is `to_world`.
    fn property_name(&self, name: &str) -> String {
        if self.version >= 2 {
            return name.to_owned();
        }
        let mut converted = String::new();
        let mut was_lower = false;
        for c in name.chars() {
            if c.is_uppercase() && was_lower {
                converted.push('_');
            }
            was_lower = c.is_lowercase() || c.is_numeric();
            converted.extend(c.to_lowercase());
        }
        match converted.as_str() {
            "diffuse_ambient" => "reflectance".to_owned(),
            _ => converted,
        }
    }

    /// A property such as `<float name="…" value="…"/>`.
    fn property(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Option<Property> {
        let kind = element.tag_name().name();
        let Some(name) = self.attribute(file, element, "name") else {
            self.missing(file, element, "`name`");
            return None;
        };
        let name = SpannedText {
            text: self.property_name(&name.text),
            span: name.span,
        };
        let value = match kind {
            "transform" | "animation" => Some(Value::Transform(self.transform(file, element))),
            "point" | "vector" => self.vector(file, element).map(Value::Vector),
            _ => self.value(file, element, kind),
        }?;
        let value = match value {
            Value::Color(color) => Value::Color(self.bounded(element, &name, color)),
            Value::Number(number) => match is_reflectance(&name.text) {
                true => Value::Number(self.bounded(element, &name, [number; 3])[0]),
                false => value,
            },
            value => value,
        };
        Some(Property { name, value })
    }

    /// A colour of a surface between 0 and 1: what is beyond is told.
    fn bounded(
        &mut self,
        element: XmlElement<'_, '_>,
        name: &SpannedText,
        color: [f64; 3],
    ) -> [f64; 3] {
        let parent = element.parent().map(|parent| parent.tag_name().name());
        let is_rgb = matches!(element.tag_name().name(), "rgb" | "srgb");
        let is_bounded = parent == Some("bsdf") && is_rgb && !matches!(&*name.text, "eta" | "k")
            || is_reflectance(&name.text);
        let clamped = color.map(|channel| channel.clamp(0.0, 1.0));
        if !is_bounded || is_emitted(element) || clamped == color {
            return color;
        }
        let message = format!(
            "`{}` of a surface is between 0 and 1: the nearest is shown",
            clip(&name.text)
        );
        let diagnostic = Diagnostic::new(&codes::MITSUBA_DOUBTFUL, message);
        self.sink.push(diagnostic.at(name.span, ""));
        clamped
    }

    /// The value of a property with one attribute.
    fn value(&mut self, file: FileId, element: XmlElement<'_, '_>, kind: &str) -> Option<Value> {
        // Find the text of the value.
        let attribute = match kind {
            "spectrum" if element.has_attribute("filename") => "filename",
            _ => "value",
        };
        let Some(text) = self.attribute(file, element, attribute) else {
            self.missing(file, element, "`value`");
            return None;
        };
        // Parse it by the type of the element.
        let parsed = match kind {
            "float" | "integer" => value::number(&text.text).map(Value::Number),
            "boolean" => match text.text.as_str() {
                "true" => Some(Value::Bool(true)),
                "false" => Some(Value::Bool(false)),
                _ => None,
            },
            "string" => return Some(Value::String(text)),
            "rgb" => value::rgb(&text.text).map(Value::Color),
            "srgb" => {
                value::rgb(&text.text).map(|rgb| Value::Color(rgb.map(rtc_color::srgb_decoded)))
            }
            "spectrum" if attribute == "filename" => None,
            "spectrum" => value::spectrum(&text.text, is_emitted(element)).map(Value::Color),
            "blackbody" => None,
            _ => {
                let message = format!("`<{}>` has no meaning here", clip(kind));
                let diagnostic = Diagnostic::new(&codes::MITSUBA_IGNORED, message);
                self.sink.push(diagnostic.at(span(file, &element), ""));
                return None;
            }
        };
        // Report a value of another type.
        if parsed.is_none() {
            let message = match kind {
                "blackbody" => "blackbody spectra are not supported".to_owned(),
                "spectrum" if attribute == "filename" => {
                    "spectra in files are not supported".to_owned()
                }
                _ => format!("`{}` is not a value of a `<{kind}>`", clip(&text.text)),
            };
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
            self.sink.push(diagnostic.at(text.span, ""));
        }
        parsed
    }

    /// A point or vector: `value="x, y, z"`, or `x`, `y` and `z`.
    fn vector(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Option<[f64; 3]> {
        self.components(file, element, 0.0)
    }

    /// Three numbers; those of `x`, `y` and `z` that are missing are `default`.
    pub(super) fn components(
        &mut self,
        file: FileId,
        element: XmlElement<'_, '_>,
        default: f64,
    ) -> Option<[f64; 3]> {
        if let Some(text) = self.attribute(file, element, "value") {
            let vector = value::vector(&text.text);
            if vector.is_none() {
                self.not_numbers(&text);
            }
            return vector;
        }
        let mut vector = [default; 3];
        for (axis, name) in vector.iter_mut().zip(["x", "y", "z"]) {
            if let Some(text) = self.attribute(file, element, name) {
                match value::number(&text.text) {
                    Some(number) => *axis = number,
                    None => self.not_numbers(&text),
                }
            }
        }
        Some(vector)
    }

    pub(super) fn not_numbers(&mut self, text: &SpannedText) {
        let message = format!("`{}` has the wrong numbers", clip(&text.text));
        let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
        self.sink.push(diagnostic.at(text.span, ""));
    }

    pub(super) fn missing(&mut self, file: FileId, element: XmlElement<'_, '_>, what: &str) {
        // The parameter without a value was reported.
        if std::mem::take(&mut self.has_unset) {
            return;
        }
        let name = element.tag_name().name();
        let message = format!("`<{}>` lacks {what}", clip(name));
        let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
        self.sink.push(diagnostic.at(span(file, &element), ""));
    }
}

/// The span of the start of an element: its tag name.
pub(super) fn span(file: FileId, element: &XmlElement<'_, '_>) -> Span {
    let start = element.range().start;
    let end = start + 1 + element.tag_name().name().len();
    Span::new(file, offset(start), offset(end))
}

/// Whether an element is within an emitter.
fn is_emitted(element: XmlElement<'_, '_>) -> bool {
    let mut outer = element.ancestors();
    outer.any(|outer| current_tag(outer.tag_name().name()) == "emitter")
}

/// Whether a property is a share of light that a surface gives back or lets through.
fn is_reflectance(name: &str) -> bool {
    name.ends_with("reflectance") || name.ends_with("transmittance") || name == "base_color"
}

pub(super) fn offset(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

/// The name of an element in version 3. In version 0.5 every texture was a `<texture>`, and the
/// sensor and the emitters had other names.
pub(super) fn current_tag(name: &str) -> &str {
    match name {
        "camera" => "sensor",
        "luminaire" => "emitter",
        name => name,
    }
}
