//! One layer: the prims and properties that a file says something of, before composition.

use crate::exchange::SpannedText;
use rtc_source::{FileId, Span};
use std::collections::{BTreeMap, BTreeSet};

/// The deepest nesting of prims in a layer, and the longest path to one.
pub(super) const MAX_DEPTH: usize = 128;

/// How a layer speaks of a prim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Specifier {
    Def,
    #[default]
    Over,
    Class,
}

/// A value: numbers of any shape in one list, or words.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// `None`: the attribute has no value.
    Blocked,
    Numbers(Vec<f64>),
    /// Strings, tokens, assets and paths.
    Texts(Vec<String>),
}

/// A value as its file stores it.
#[derive(Clone, Debug)]
pub(super) enum StoredValue {
    Read(Value),
    /// Where a binary file stores it.
    Packed(u64),
}

/// The edits of a list.
#[derive(Clone, Debug)]
pub(super) struct ListOp<T> {
    pub(super) is_explicit: bool,
    /// The whole list, if it is explicit.
    pub(super) prepended: Vec<T>,
    pub(super) appended: Vec<T>,
    pub(super) deleted: Vec<T>,
}

impl<T> Default for ListOp<T> {
    fn default() -> Self {
        Self {
            is_explicit: false,
            prepended: Vec::new(),
            appended: Vec::new(),
            deleted: Vec::new(),
        }
    }
}

/// What distinguishes the items of a list.
pub(super) trait ListKey {
    fn key(&self) -> (&str, &str);
}

impl ListKey for SpannedText {
    fn key(&self) -> (&str, &str) {
        (&self.text, "")
    }
}

impl<T: ListKey + Clone> ListOp<T> {
    /// Adds the items of the keyword before the statement: `prepend`, `append`, `add`, `delete`, or
    /// none.
    pub(super) fn edit(&mut self, keyword: &str, items: Vec<T>) {
        match keyword {
            "" => {
                self.is_explicit = true;
                self.prepended = items;
            }
            "prepend" => self.prepended = items,
            "append" | "add" => self.appended = items,
            "delete" => self.deleted = items,
            _ => {}
        }
    }

    /// The list after the edits.
    pub(super) fn apply(&self, list: &mut Vec<T>) {
        if self.is_explicit {
            list.clone_from(&self.prepended);
            return;
        }
        let all = [&self.prepended, &self.appended, &self.deleted];
        if all.iter().all(|items| items.is_empty()) {
            return;
        }
        let edited: BTreeSet<_> = all.into_iter().flatten().map(ListKey::key).collect();
        let rest = std::mem::take(list).into_iter();
        let rest = rest.filter(|item| !edited.contains(&item.key()));
        list.extend(self.prepended.iter().cloned());
        list.extend(rest);
        list.extend(self.appended.iter().cloned());
    }
}

/// The target of a reference, a payload, an inherit or a specialize.
#[derive(Clone, Debug)]
pub(super) struct ArcTarget {
    /// The file, empty for the same layers.
    pub(super) asset: String,
    /// The prim, empty for the default one of the file.
    pub(super) path: String,
    pub(super) time: LayerOffset,
    pub(super) span: Span,
}

impl ArcTarget {
    /// A prim of the same layers.
    pub(super) fn internal(SpannedText { text: path, span }: SpannedText) -> Self {
        Self {
            asset: String::new(),
            path,
            time: LayerOffset::default(),
            span,
        }
    }
}

impl ListKey for ArcTarget {
    fn key(&self) -> (&str, &str) {
        (&self.asset, &self.path)
    }
}

/// The map from the time of a layer to that of the one that refers to it: `offset + scale·t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LayerOffset {
    pub(super) offset: f64,
    pub(super) scale: f64,
}

impl Default for LayerOffset {
    fn default() -> Self {
        Self {
            offset: 0.0,
            scale: 1.0,
        }
    }
}

impl LayerOffset {
    /// The map of a layer behind this one.
    pub(super) fn after(self, inner: Self) -> Self {
        Self {
            offset: self.offset + self.scale * inner.offset,
            scale: self.scale * inner.scale,
        }
    }

    /// The time in the layer.
    pub(super) fn local(self, time: f64) -> f64 {
        let local = (time - self.offset) / self.scale;
        if local.is_finite() { local } else { time }
    }
}

/// The four kinds of arcs between prims, by their strength; variants stand behind inherits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum ArcKind {
    Root,
    Inherit,
    Variant,
    Reference,
    Payload,
    Specialize,
}

impl ArcKind {
    /// The keyword of the arc in a text of USD.
    pub(super) fn keyword(self) -> &'static str {
        match self {
            Self::Root => "root",
            Self::Inherit => "inherits",
            Self::Variant => "variantSets",
            Self::Reference => "references",
            Self::Payload => "payload",
            Self::Specialize => "specializes",
        }
    }
}

/// An attribute or a relationship.
#[derive(Clone, Debug, Default)]
pub(super) struct PropertySpec {
    pub(super) value: Option<StoredValue>,
    /// The values at times, in order.
    pub(super) samples: Vec<(f64, StoredValue)>,
    /// The times and values of a binary file.
    pub(super) packed_samples: Option<u64>,
    /// The targets of a relationship, or the connections of an attribute.
    pub(super) targets: Option<ListOp<SpannedText>>,
    pub(super) interpolation: Option<String>,
    /// Whether a binding of a material comes before those of the prims below.
    pub(super) is_stronger_than_descendants: Option<bool>,
    pub(super) span: Option<Span>,
}

impl PropertySpec {
    /// Takes a word of the metadata.
    pub(super) fn describe(&mut self, key: &str, word: String) {
        match key {
            "interpolation" => self.interpolation = Some(word),
            "bindMaterialAs" => {
                self.is_stronger_than_descendants = Some(word == "strongerThanDescendants");
            }
            _ => {}
        }
    }
}

/// What a layer says of a prim.
#[derive(Debug)]
pub(super) struct PrimSpec {
    pub(super) specifier: Specifier,
    pub(super) type_name: String,
    pub(super) span: Span,
    pub(super) is_active: Option<bool>,
    pub(super) inherits: ListOp<ArcTarget>,
    pub(super) references: ListOp<ArcTarget>,
    pub(super) payloads: ListOp<ArcTarget>,
    pub(super) specializes: ListOp<ArcTarget>,
    pub(super) selections: BTreeMap<String, String>,
    pub(super) has_clips: bool,
    pub(super) has_relocates: bool,
    pub(super) properties: BTreeMap<String, Box<PropertySpec>>,
    /// Its place among its siblings, if that is not the one in the file.
    pub(super) rank: usize,
    pub(super) children: BTreeMap<String, u32>,
    /// The variants of each set.
    pub(super) variants: BTreeMap<String, BTreeMap<String, u32>>,
}

impl PrimSpec {
    pub(super) fn new(span: Span) -> Self {
        Self {
            specifier: Specifier::Over,
            type_name: String::new(),
            span,
            is_active: None,
            inherits: ListOp::default(),
            references: ListOp::default(),
            payloads: ListOp::default(),
            specializes: ListOp::default(),
            selections: BTreeMap::new(),
            has_clips: false,
            has_relocates: false,
            properties: BTreeMap::new(),
            rank: 0,
            children: BTreeMap::new(),
            variants: BTreeMap::new(),
        }
    }
}

/// A layer beneath another one.
#[derive(Clone, Debug)]
pub(super) struct SubLayer {
    pub(super) asset: SpannedText,
    pub(super) time: LayerOffset,
}

/// What a layer says of the stage.
#[derive(Debug, Default)]
pub(super) struct StageMetadata {
    pub(super) default_prim: Option<String>,
    pub(super) up_axis: Option<SpannedText>,
    pub(super) meters_per_unit: Option<f64>,
    pub(super) time_codes_per_second: Option<f64>,
    /// The rate of the time codes where none is given.
    pub(super) frames_per_second: Option<f64>,
    pub(super) start_time_code: Option<f64>,
    pub(super) sub_layers: Vec<SubLayer>,
}

/// A layer. Its first prim is the root of all.
#[derive(Debug)]
pub(super) struct Layer {
    pub(super) file: FileId,
    pub(super) metadata: StageMetadata,
    pub(super) prims: Vec<PrimSpec>,
    /// The tables of a binary file.
    pub(super) tables: Option<super::packed::CrateTables>,
}

impl Layer {
    pub(super) fn new(file: FileId) -> Self {
        Self {
            file,
            metadata: StageMetadata::default(),
            prims: vec![PrimSpec::new(Span::new(file, 0, 0))],
            tables: None,
        }
    }

    /// The prim at an index that the layer itself has given.
    pub(super) fn prim(&self, index: u32) -> &PrimSpec {
        &self.prims[index as usize]
    }

    pub(super) fn prim_mut(&mut self, index: u32) -> &mut PrimSpec {
        &mut self.prims[index as usize]
    }

    /// Adds a prim, which has no parent so far.
    pub(super) fn add(&mut self, prim: PrimSpec) -> u32 {
        self.prims.push(prim);
        u32::try_from(self.prims.len() - 1).unwrap_or(0)
    }
}
