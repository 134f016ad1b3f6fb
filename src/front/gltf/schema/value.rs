//! The check of one property value against its table.

use super::traverse::SchemaWalk;
use super::{IndexTarget, NumberRange, Value};
use rtc_diag::codes;
use rtc_source::tree::{NodeId, NodeKind};
use std::collections::BTreeSet;

impl SchemaWalk<'_, '_, '_> {
    /// Checks the value of the property `name`; nested values are deferred.
    pub(super) fn value(&mut self, node: NodeId, value: &'static Value, name: &str) {
        match value {
            Value::Boolean => drop(self.expect(node, NodeKind::Bool, name)),
            Value::Text => drop(self.expect(node, NodeKind::Text, name)),
            Value::Keyword(words) => self.keyword(node, words, name),
            Value::Version => self.pattern(node, is_version, "a version, as `2.0`", name),
            Value::Pointer => self.pattern(node, is_pointer, "a JSON pointer, as `/nodes/0`", name),
            Value::Integer(min, max) => self.bounded_integer(node, *min, *max, name),
            Value::Choice(choices) => self.choice(node, choices, name),
            Value::Number(bounds) => self.number(node, *bounds, name),
            // An accessor is checked with its bounds, once its type is known.
            Value::PerComponent => {}
            Value::Numbers(lengths, bounds) => self.numbers(node, lengths, *bounds, name),
            Value::Texts => self.texts(node, name),
            Value::Index(target) => {
                if let Some(index) = self.index(node, name) {
                    self.follow(node, *target, index);
                }
            }
            Value::Indices(target) => self.indices(node, *target, name),
            Value::Attributes => self.attributes(node, name),
            Value::Targets => {
                for item in self.items(node, name) {
                    if self.element(item, NodeKind::Map, name) {
                        self.attributes(item, name);
                    }
                }
            }
            Value::One(object) => {
                if self.expect(node, NodeKind::Map, name) {
                    self.open.push((node, object));
                }
            }
            Value::Many(object) => {
                let is_root = self.report.json.parent(node) == self.report.json.root();
                for item in self.items(node, name) {
                    let is_object = if is_root {
                        self.expect(item, NodeKind::Map, name)
                    } else {
                        self.element(item, NodeKind::Map, name)
                    };
                    if is_object {
                        self.open.push((item, object));
                    }
                }
            }
        }
    }

    fn indices(&mut self, node: NodeId, target: IndexTarget, name: &str) {
        let mut seen = BTreeSet::new();
        for item in self.items(node, name) {
            let Some(index) = self.item_index(item, name) else {
                continue;
            };
            if !seen.insert(index) {
                let message = format!("`{name}` lists {index} twice");
                let alias = "DUPLICATE_ELEMENTS";
                self.report
                    .add(&codes::GLTF_DUPLICATE, alias, item, message);
            }
            self.follow(item, target, index);
        }
    }

    /// The items of a list.
    fn list(&mut self, node: NodeId, name: &str) -> Vec<NodeId> {
        if self.expect(node, NodeKind::List, name) {
            self.report.json.items(node).collect()
        } else {
            Vec::new()
        }
    }

    /// The items of a list that is not empty.
    fn items(&mut self, node: NodeId, name: &str) -> Vec<NodeId> {
        let items = self.list(node, name);
        if self.report.json.kind(node) == NodeKind::List {
            self.not_empty(node, items.len(), name);
        }
        items
    }

    fn not_empty(&mut self, node: NodeId, count: usize, name: &str) {
        if count == 0 {
            self.report.repair(
                &codes::GLTF_EMPTY,
                "EMPTY_ENTITY",
                node,
                &format!("`{name}` is empty"),
                "it is treated as absent",
            );
        }
    }

    fn keyword(&mut self, node: NodeId, words: &[&str], name: &str) {
        if self.expect(node, NodeKind::Text, name)
            && !words
                .iter()
                .any(|keyword| self.report.json.is(node, keyword))
        {
            let message = format!(
                "`{name}` is {}; it must be one of {}",
                self.report.shown(node),
                words.join(", ")
            );
            self.report
                .add(&codes::GLTF_CHOICE, "VALUE_NOT_IN_LIST", node, message);
        }
    }

    fn pattern(&mut self, node: NodeId, fits: fn(&str) -> bool, what: &str, name: &str) {
        if self.expect(node, NodeKind::Text, name)
            && !fits(self.report.json.text(node).unwrap_or_default())
        {
            let message = format!("`{name}` is {}; it must be {what}", self.report.shown(node));
            self.report
                .add(&codes::GLTF_VALUE, "PATTERN_MISMATCH", node, message);
        }
    }

    /// The whole number at `node`, if it is one; negative ones are not.
    fn integer(&mut self, node: NodeId, name: &str) -> Option<Option<u64>> {
        if !self.expect(node, NodeKind::Number, name) {
            return None;
        }
        let number = self.report.json.number(node)?;
        if number.fract() != 0.0 {
            let message = format!(
                "`{name}` is {}; it must be a whole number",
                self.report.shown(node)
            );
            self.report
                .add(&codes::GLTF_TYPE, "TYPE_MISMATCH", node, message);
            return None;
        }
        Some(self.report.json.integer(node))
    }

    fn bounded_integer(&mut self, node: NodeId, min: u64, max: u64, name: &str) {
        let Some(number) = self.integer(node, name) else {
            return;
        };
        if !number.is_some_and(|number| (min..=max).contains(&number)) {
            let least = format!("`{name}` is {}; it must be {min}", self.report.shown(node));
            let message = if max < 1 << 53 && max > 1 << 32 {
                format!("{least} or more")
            } else {
                format!("{least} to {max}")
            };
            self.report
                .add(&codes::GLTF_VALUE, "VALUE_NOT_IN_RANGE", node, message);
        }
    }

    fn choice(&mut self, node: NodeId, choices: &[u64], name: &str) {
        let Some(number) = self.integer(node, name) else {
            return;
        };
        if !number.is_some_and(|number| choices.contains(&number)) {
            let choices: Vec<String> = choices.iter().map(u64::to_string).collect();
            let message = format!(
                "`{name}` is {}; it must be one of {}",
                self.report.shown(node),
                choices.join(", ")
            );
            self.report
                .add(&codes::GLTF_CHOICE, "VALUE_NOT_IN_LIST", node, message);
        }
    }

    fn index(&mut self, node: NodeId, name: &str) -> Option<u64> {
        let number = self.integer(node, name)?;
        if number.is_none() {
            let message = format!(
                "`{name}` is {}; it must be an index",
                self.report.shown(node)
            );
            self.report
                .add(&codes::GLTF_TYPE, "INVALID_INDEX", node, message);
        }
        number
    }

    /// The index that an element of a list or map of indices is.
    fn item_index(&mut self, node: NodeId, name: &str) -> Option<u64> {
        let number = self.report.json.integer(node);
        if number.is_none() {
            let message = format!(
                "`{name}` contains {}, which is not an index",
                self.report.shown(node)
            );
            self.report
                .add(&codes::GLTF_TYPE, "INVALID_INDEX", node, message);
        }
        number
    }

    fn number(&mut self, node: NodeId, bounds: NumberRange, name: &str) {
        if self.expect(node, NodeKind::Number, name) {
            self.bounded(node, bounds, name);
        }
    }

    fn bounded(&mut self, node: NodeId, bounds: NumberRange, name: &str) {
        let NumberRange { min, max, above } = bounds;
        let Some(number) = self.report.json.number(node) else {
            return;
        };
        let inside =
            number.is_finite() && number <= max && if above { number > min } else { number >= min };
        if !inside {
            let range = match (above, max.is_finite()) {
                (_, true) => format!("{min} to {max}"),
                (true, false) => format!("above {min}"),
                (false, false) if min.is_finite() => format!("{min} or more"),
                (false, false) => "finite".to_owned(),
            };
            let message = format!(
                "`{name}` is {}; it must be {range}",
                self.report.shown(node)
            );
            self.report
                .add(&codes::GLTF_VALUE, "VALUE_NOT_IN_RANGE", node, message);
        }
    }

    fn numbers(&mut self, node: NodeId, lengths: &[usize], bounds: NumberRange, name: &str) {
        if !self.expect(node, NodeKind::List, name) {
            return;
        }
        let items: Vec<NodeId> = self.report.json.items(node).collect();
        if items.is_empty() || lengths.is_empty() {
            self.not_empty(node, items.len(), name);
        } else if !lengths.contains(&items.len()) {
            let lengths: Vec<String> = lengths.iter().map(usize::to_string).collect();
            let message = format!(
                "`{name}` has {} numbers; it must have {}",
                items.len(),
                lengths.join(" or ")
            );
            self.report.add(
                &codes::GLTF_VALUE,
                "ARRAY_LENGTH_NOT_IN_LIST",
                node,
                message,
            );
        }
        for item in items {
            if self.element(item, NodeKind::Number, name) {
                self.bounded(item, bounds, name);
            }
        }
    }

    /// True if an element of a list is of the kind; else that is reported.
    fn element(&mut self, node: NodeId, kind: NodeKind, name: &str) -> bool {
        let found = self.report.json.kind(node);
        if found != kind {
            let message = format!(
                "an element of `{name}` is {}; it must be {}",
                found.name(),
                kind.name()
            );
            self.report
                .add(&codes::GLTF_TYPE, "ARRAY_TYPE_MISMATCH", node, message);
        }
        found == kind
    }

    fn texts(&mut self, node: NodeId, name: &str) {
        let mut seen = BTreeSet::new();
        for item in self.items(node, name) {
            if self.element(item, NodeKind::Text, name)
                && let Some(text) = self.report.json.text(item)
                && !seen.insert(text)
            {
                let message = format!("`{name}` lists {} twice", self.report.shown(item));
                self.report
                    .add(&codes::GLTF_DUPLICATE, "DUPLICATE_ELEMENTS", item, message);
            }
        }
    }

    fn attributes(&mut self, node: NodeId, name: &str) {
        if !self.expect(node, NodeKind::Map, name) {
            return;
        }
        let json = self.report.json;
        let is_draco = json.at(json.parent(node), &["bufferView"]).is_some();
        let mut count = 0;
        for (key, value) in json.pairs(node) {
            count += 1;
            let attribute = json.text(key).unwrap_or_default();
            if let Some(index) = self.item_index(value, attribute)
                && !is_draco
            {
                self.follow(value, super::IndexTarget::Accessors, index);
            }
        }
        self.not_empty(node, count, name);
    }
}

fn is_version(text: &str) -> bool {
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    text.split_once('.')
        .is_some_and(|(major, minor)| is_number(major) && is_number(minor))
}

/// RFC 6901.
fn is_pointer(text: &str) -> bool {
    let escapes = text
        .split('~')
        .skip(1)
        .all(|rest| rest.starts_with(['0', '1']));
    (text.is_empty() || text.starts_with('/')) && escapes
}
