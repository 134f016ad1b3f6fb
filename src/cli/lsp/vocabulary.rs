//! The JSON Schema of a format, queried by path.

use super::path_at::{PathStep, path_at};
use rtc_source::tree::{NodeId, SyntaxTree};
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// The key of YAML that merges the keys of another map.
pub(super) const MERGE: &str = "<<";

/// The JSON Schema of a format, queried by path.
pub(super) struct Vocabulary {
    schema: Value,
}

impl Vocabulary {
    pub(super) fn new(schema: Value) -> Self {
        Self { schema }
    }

    /// The schemas of the whole document.
    pub(super) fn root<'v>(&'v self, tree: &SyntaxTree<'_>) -> Vec<&'v Map<String, Value>> {
        self.plain(&self.schema, tree, tree.root())
    }

    /// The schemas one step below others.
    pub(super) fn below<'v>(
        &'v self,
        here: &[&'v Map<String, Value>],
        tree: &SyntaxTree<'_>,
        step: PathStep,
    ) -> Vec<&'v Map<String, Value>> {
        let found: Vec<&Value> = match step {
            PathStep::Key { key, .. } => {
                let name = tree.text(key).unwrap_or_default();
                here.iter().filter_map(|s| property(s, name)).collect()
            }
            PathStep::Item { at, .. } => here.iter().filter_map(|s| item(s, at)).collect(),
        };
        let plain = |schema| self.plain(schema, tree, step.node());
        found.into_iter().flat_map(plain).collect()
    }

    /// The schemas at the end of a path, without references.
    pub(super) fn at<'v>(
        &'v self,
        tree: &SyntaxTree<'_>,
        steps: &[PathStep],
    ) -> Vec<&'v Map<String, Value>> {
        /// The maximum number of aliases that lead to a schema.
        const MOST: usize = 4;
        self.at_or_alias(tree, steps, MOST)
    }

    /// The schemas at the end of a path. What stands under no key of the format, but is named by an
    /// alias, has those of the alias.
    fn at_or_alias<'v>(
        &'v self,
        tree: &SyntaxTree<'_>,
        steps: &[PathStep],
        most: usize,
    ) -> Vec<&'v Map<String, Value>> {
        let mut here = self.root(tree);
        let mut is_merged = false;
        for step in steps {
            // A merged map has the keys of the map that it is merged into.
            is_merged = match *step {
                PathStep::Key { key, .. } => tree.is(key, MERGE),
                PathStep::Item { .. } => is_merged,
            };
            if is_merged {
                continue;
            }
            here = self.below(&here, tree, *step);
            if here.is_empty()
                && most > 0
                && let Some(alias) = alias_of(tree, step.node())
            {
                let steps = path_at(tree, tree.span(alias).start as usize);
                here = self.at_or_alias(tree, &steps, most - 1);
            }
        }
        here
    }

    /// The keys of a map: their names and schemas, without deprecated spellings.
    pub(super) fn keys<'v>(
        &'v self,
        tree: &SyntaxTree<'_>,
        to_map: &[PathStep],
    ) -> Vec<(&'v str, &'v Value)> {
        Self::keys_of(&self.at(tree, to_map))
    }

    /// The keys of a map with some schemas.
    pub(super) fn keys_of<'v>(schemas: &[&'v Map<String, Value>]) -> Vec<(&'v str, &'v Value)> {
        let mut keys: Vec<(&str, &Value)> = Vec::new();
        for schema in schemas {
            let properties = schema.get("properties").and_then(Value::as_object);
            for (name, property) in properties.into_iter().flatten() {
                // A rule may forbid a key: its schema is `false`.
                let is_current = property.is_object() && property.get("deprecated").is_none();
                if is_current && !keys.iter().any(|(known, _)| known == name) {
                    keys.push((name, property));
                }
            }
        }
        keys
    }

    /// A schema with its references and alternatives resolved, and the parts that the kind of the
    /// node selects.
    fn plain<'v>(
        &'v self,
        schema: &'v Value,
        tree: &SyntaxTree<'_>,
        node: NodeId,
    ) -> Vec<&'v Map<String, Value>> {
        let (mut plain, mut open) = (Vec::new(), vec![schema]);
        while let Some(next) = open.pop() {
            let Some(map) = next.as_object() else {
                continue;
            };
            let target = map.get("$ref").and_then(Value::as_str);
            let target = target.and_then(|name| self.schema.pointer(name.trim_start_matches('#')));
            open.extend(target);
            let parts = ["anyOf", "oneOf", "allOf"].map(|key| map.get(key)?.as_array());
            open.extend(parts.into_iter().flatten().flatten());
            if let Some(condition) = map.get("if") {
                let part = match meets(condition, tree, node) {
                    true => "then",
                    false => "else",
                };
                open.extend(map.get(part));
            }
            plain.push(map);
        }
        plain
    }
}

/// The first alias of a node.
fn alias_of(tree: &SyntaxTree<'_>, node: NodeId) -> Option<NodeId> {
    let mut nodes = tree.nodes();
    nodes.find(|own| *own != node && tree.target(*own) == node)
}

/// The schema of a key; case is ignored, as the readers do.
fn property<'v>(schema: &'v Map<String, Value>, name: &str) -> Option<&'v Value> {
    let properties = schema.get("properties")?.as_object()?;
    let similar = || {
        let mut all = properties.iter();
        all.find(|(known, _)| known.eq_ignore_ascii_case(name))
    };
    properties
        .get(name)
        .or_else(|| similar().map(|(_, property)| property))
}

/// The schema of an item of a list.
fn item(schema: &Map<String, Value>, at: usize) -> Option<&Value> {
    let first = schema.get("prefixItems").and_then(|all| all.get(at));
    first.or_else(|| schema.get("items"))
}

/// Whether a node meets a condition. Of JSON Schema this knows what the conditions of the formats
/// use; words match in any case.
fn meets(condition: &Value, tree: &SyntaxTree<'_>, node: NodeId) -> bool {
    let Some(condition) = condition.as_object() else {
        return true;
    };
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let is_word = |word: &Value| {
        let (word, own) = (word.as_str(), tree.text(node));
        word.zip(own)
            .is_some_and(|(word, own)| own.eq_ignore_ascii_case(word))
    };
    condition
        .iter()
        .all(|(keyword, value)| match keyword.as_str() {
            "type" => value != "object" || tree.is_map(node),
            "required" => list(value).iter().all(|key| {
                let key = key.as_str().unwrap_or_default();
                value_of(tree, node, key).is_some()
            }),
            "properties" => value.as_object().is_none_or(|properties| {
                properties.iter().all(|(key, schema)| {
                    value_of(tree, node, key).is_none_or(|own| meets(schema, tree, own))
                })
            }),
            "anyOf" => list(value).iter().any(|own| meets(own, tree, node)),
            "enum" => list(value).iter().any(is_word),
            "const" => is_word(value),
            // The same words in any case, which `enum` beside it compares so already.
            "pattern" => false,
            _ => true,
        })
}

/// The value of a key of a map, or of the maps that it merges.
fn value_of(tree: &SyntaxTree<'_>, map: NodeId, key: &str) -> Option<NodeId> {
    let (mut open, mut seen) = (vec![map], BTreeSet::new());
    while let Some(map) = open.pop() {
        if !seen.insert(tree.target(map)) {
            continue;
        }
        if let Some(value) = tree.get(map, key) {
            return Some(value);
        }
        for (own, value) in tree.pairs(map) {
            match tree.text(own) {
                Some(MERGE) if tree.is_list(value) => open.extend(tree.items(value)),
                Some(MERGE) => open.push(value),
                Some(text) if text.eq_ignore_ascii_case(key) => return Some(value),
                Some(_) | None => {}
            }
        }
    }
    None
}
