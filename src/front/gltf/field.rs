//! Typed access to the properties of a JSON object. A property that is absent or invalid is `None`;
//! the schema has reported it.

use super::pointer::AnimatedValues;
use rtc_source::tree::{NodeId, NodeKind, SyntaxTree};

/// The object at a node.
#[derive(Clone, Copy)]
pub(super) struct ObjectFields<'t, 's> {
    pub(super) json: &'t SyntaxTree<'s>,
    pub(super) at: NodeId,
    /// Animated values, which replace the numbers of the file.
    animated: Option<&'t AnimatedValues>,
}

impl<'t, 's> ObjectFields<'t, 's> {
    pub(super) fn new(json: &'t SyntaxTree<'s>, at: NodeId) -> Self {
        let animated = None;
        Self { json, at, animated }
    }

    /// The same object with animated values.
    pub(super) fn animated(self, animated: &'t AnimatedValues) -> Self {
        let animated = Some(animated).filter(|animated| !animated.is_empty());
        Self { animated, ..self }
    }

    /// The animated value of `key`.
    fn animated_value(&self, key: &str) -> Option<&'t [f64]> {
        let mut values = self.animated?.range((self.at, "")..);
        let values = values.by_ref().take_while(|((at, _), _)| *at == self.at);
        let mut values = values.filter(|((_, name), _)| *name == key);
        values.next().map(|(_, numbers)| numbers.as_slice())
    }

    pub(super) fn node(&self, key: &str) -> Option<NodeId> {
        self.json.get(self.at, key)
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.node(key).is_some()
    }

    /// The object at `key`.
    pub(super) fn object(&self, key: &str) -> Option<Self> {
        let at = self
            .node(key)
            .filter(|at| self.json.kind(*at) == NodeKind::Map)?;
        Some(Self { at, ..*self })
    }

    /// The object of an extension.
    pub(super) fn extension(&self, name: &str) -> Option<Self> {
        self.object("extensions")?.object(name)
    }

    /// The object `extras.rtc`, which `rtc` writes.
    pub(super) fn rtc_extras(&self) -> Option<Self> {
        self.object("extras")?.object("rtc")
    }

    /// The objects of the list at `key`.
    pub(super) fn objects(&self, key: &str) -> impl Iterator<Item = Self> + use<'t, 's> {
        let (json, list, animated) = (self.json, self.node(key), self.animated);
        let list = list.filter(|list| json.kind(*list) == NodeKind::List);
        list.into_iter()
            .flat_map(|list| json.items(list))
            .map(move |at| Self { json, at, animated })
    }

    pub(super) fn integer(&self, key: &str) -> Option<u64> {
        self.json.integer(self.node(key)?)
    }

    /// An index or a size.
    pub(super) fn index(&self, key: &str) -> Option<usize> {
        self.integer(key)
            .and_then(|number| usize::try_from(number).ok())
    }

    /// A count, which is below 2^32.
    pub(super) fn count_or(&self, key: &str, default: u32) -> u32 {
        let count = self.integer(key).map(u32::try_from);
        count.and_then(Result::ok).unwrap_or(default)
    }

    pub(super) fn indices(&self, key: &str) -> Vec<usize> {
        let items = self.json.list(self.at, key);
        items
            .filter_map(|item| usize::try_from(self.json.integer(item)?).ok())
            .collect()
    }

    /// A finite number.
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        if let Some([number]) = self.animated_value(key) {
            return Some(*number);
        }
        self.json
            .number(self.node(key)?)
            .filter(|number| number.is_finite())
    }

    pub(super) fn number_or(&self, key: &str, default: f64) -> f64 {
        self.number(key).unwrap_or(default)
    }

    /// A list of finite numbers, whatever their number.
    pub(super) fn numbers(&self, key: &str) -> Option<Vec<f64>> {
        if let Some(numbers) = self.animated_value(key) {
            return Some(numbers.to_vec());
        }
        let list = self
            .node(key)
            .filter(|list| self.json.kind(*list) == NodeKind::List)?;
        self.json
            .items(list)
            .map(|item| self.json.number(item).filter(|number| number.is_finite()))
            .collect()
    }

    /// A list of exactly `N` finite numbers.
    pub(super) fn vector<const N: usize>(&self, key: &str) -> Option<[f64; N]> {
        self.numbers(key)?.try_into().ok()
    }

    pub(super) fn vector_or<const N: usize>(&self, key: &str, default: [f64; N]) -> [f64; N] {
        self.vector(key).unwrap_or(default)
    }

    pub(super) fn boolean(&self, key: &str) -> bool {
        self.node(key)
            .and_then(|node| self.json.boolean(node))
            .unwrap_or_default()
    }

    pub(super) fn text(&self, key: &str) -> Option<String> {
        self.json.text(self.node(key)?).map(str::to_owned)
    }

    /// True if the string at `key` is this text.
    pub(super) fn is(&self, key: &str, text: &str) -> bool {
        self.node(key).is_some_and(|node| self.json.is(node, text))
    }

    pub(super) fn name(&self) -> String {
        self.text("name").unwrap_or_default()
    }
}
