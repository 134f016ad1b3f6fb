//! The position of a byte in the tree: the keys and items that lead to it, and the schema of each.

use rtc_source::tree::{NodeId, SyntaxTree};
use serde_json::{Map, Value};

/// A step from a list or a map to an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PathStep {
    /// The value of a key.
    Key {
        map: NodeId,
        key: NodeId,
        value: NodeId,
    },
    /// An item of a list.
    Item { at: usize, item: NodeId },
}

impl PathStep {
    /// The node after the step.
    pub(super) fn node(self) -> NodeId {
        match self {
            Self::Key { value, .. } => value,
            Self::Item { item, .. } => item,
        }
    }
}

/// The steps from the root to the node at a byte.
pub(super) fn path_at(tree: &SyntaxTree<'_>, offset: usize) -> Vec<PathStep> {
    let holds = |id: NodeId| {
        let span = tree.span(id);
        (span.start as usize..=span.end as usize).contains(&offset)
    };
    let (mut steps, mut here) = (Vec::new(), tree.root());
    loop {
        // The value of an alias is written elsewhere.
        let is_alias = tree.target(here) != here;
        let key = tree
            .pairs(here)
            .find(|(key, value)| !is_alias && (holds(*key) || holds(*value)));
        let item = || tree.items(here).enumerate().find(|(_, item)| holds(*item));
        let (step, next) = match key {
            Some((key, value)) => (
                PathStep::Key {
                    map: here,
                    key,
                    value,
                },
                value,
            ),
            None if tree.is_list(here) && !is_alias => match item() {
                Some((at, item)) => (PathStep::Item { at, item }, item),
                None => return steps,
            },
            None => return steps,
        };
        steps.push(step);
        here = next;
    }
}

/// The JSON Schema of a format, queried by path.
pub(super) struct Vocabulary {
    schema: Value,
}

impl Vocabulary {
    pub(super) fn new(schema: Value) -> Self {
        Self { schema }
    }

    /// The schemas at the end of a path, without references.
    pub(super) fn at<'v>(
        &'v self,
        tree: &SyntaxTree<'_>,
        steps: &[PathStep],
    ) -> Vec<&'v Map<String, Value>> {
        let mut here = self.plain(&self.schema, tree, tree.root());
        for step in steps {
            let found: Vec<&Value> = match *step {
                PathStep::Key { key, .. } => {
                    let name = tree.text(key).unwrap_or_default();
                    here.iter()
                        .filter_map(|s| s.get("properties")?.get(name))
                        .collect()
                }
                PathStep::Item { at, .. } => here
                    .iter()
                    .filter_map(|s| {
                        s.get("prefixItems")
                            .and_then(|all| all.get(at))
                            .or(s.get("items"))
                    })
                    .collect(),
            };
            here = found
                .into_iter()
                .flat_map(|schema| self.plain(schema, tree, step.node()))
                .collect();
        }
        here
    }

    /// The keys of a map: their names and schemas, without deprecated spellings.
    pub(super) fn keys<'v>(
        &'v self,
        tree: &SyntaxTree<'_>,
        to_map: &[PathStep],
    ) -> Vec<(&'v str, &'v Value)> {
        let mut keys: Vec<(&str, &Value)> = Vec::new();
        for schema in self.at(tree, to_map) {
            let properties = schema.get("properties").and_then(Value::as_object);
            for (name, property) in properties.into_iter().flatten() {
                let is_old = property.get("deprecated").is_some();
                if !is_old && !keys.iter().any(|(known, _)| known == name) {
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
            let alternatives = ["anyOf", "oneOf"].map(|key| map.get(key).and_then(Value::as_array));
            open.extend(alternatives.into_iter().flatten().flatten());
            for rule in map
                .get("allOf")
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
            {
                let is_for_all = rule.get("if").is_none();
                open.extend(is_for_all.then_some(rule));
                open.extend(rule.get("then").filter(|_| is_meant(rule, tree, node)));
            }
            plain.push(map);
        }
        plain
    }
}

/// Whether a value of a map selects a rule.
fn is_meant(rule: &Value, tree: &SyntaxTree<'_>, node: NodeId) -> bool {
    let conditions = rule.pointer("/if/properties").and_then(Value::as_object);
    conditions.is_some_and(|conditions| {
        conditions.iter().all(|(key, value)| {
            let word = value.get("const").and_then(Value::as_str);
            let own = tree.get(node, key).and_then(|own| tree.text(own));
            word.is_some() && word == own
        })
    })
}
