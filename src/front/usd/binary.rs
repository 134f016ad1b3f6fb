//! Binary layers (`.usdc`, the "crate" files of Pixar's `pxr/usd/usd/crateFile.cpp`), versions 0.4
//! to 0.12.
//!
//! Sections hold tables of tokens, fields and paths; values lie anywhere in the file, packed as
//! [`super::packed`] says.

use super::layer::{
    ArcTarget, Layer, LayerOffset, ListOp, MAX_DEPTH, PrimSpec, PropertySpec, Specifier,
    StoredValue, SubLayer, Value,
};
use super::packed::{
    ByteCursor, CUT, CrateTables, PAYLOAD, PAYLOAD_ITEM, PathEntry, TOKEN, charge, kind,
};
use super::text::LayerParseError;
use crate::exchange::SpannedText;
use rtc_source::{Budget, FileId, Resource, Span};
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// The memory that is charged for each field of a spec.
const FIELD: u64 = 8;

const MAGIC: &[u8] = b"PXR-USDC";
/// The memory of a path and a prim, in bytes, rounded up.
const PATH: u64 = 64;
const PRIM: u64 = 1024;

const BAD: LayerParseError =
    LayerParseError::Damaged("a table or a value has an index out of range");

pub(super) fn is_binary(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Reads a layer.
///
/// # Errors
/// If it is damaged, or exceeds a limit.
pub(super) fn read(file: FileId, bytes: &[u8], budget: &Budget) -> Result<Layer, LayerParseError> {
    // The header holds the version and the position of the table of contents.
    let header = bytes.get(..88).ok_or(CUT)?;
    let version = (header[8], header[9]);
    if version < (0, 4) || version.0 > 0 {
        return Err(LayerParseError::Damaged(
            "its version is not one of 0.4 to 0.12",
        ));
    }
    let mut contents = ByteCursor { bytes, at: 16 };
    let start = contents.u64().ok_or(CUT)?;
    let mut contents = ByteCursor::new(bytes, start).ok_or(CUT)?;
    // The table of contents lists the sections.
    let mut sections = BTreeMap::new();
    for _ in 0..contents.count(32).ok_or(CUT)? {
        let name = contents.take(16).ok_or(CUT)?;
        let (start, _) = (contents.u64().ok_or(CUT)?, contents.u64().ok_or(CUT)?);
        sections.insert(name, start);
    }
    let section = |name: &[u8]| {
        let found = sections.iter().find(|(key, _)| {
            key.strip_prefix(name)
                .is_some_and(|rest| rest.iter().all(|byte| *byte == 0))
        });
        found
            .and_then(|(_, start)| ByteCursor::new(bytes, *start))
            .ok_or(CUT)
    };
    // Read tokens, strings and paths.
    let tokens = tokens(section(b"TOKENS")?, budget)?;
    let mut cursor = section(b"STRINGS")?;
    let count = cursor.count(4).ok_or(CUT)?;
    charge(budget, 4 * count as u64)?;
    let strings = (0..count)
        .map(|_| cursor.u32())
        .collect::<Option<Vec<_>>>()
        .ok_or(CUT)?;
    let paths = paths(section(b"PATHS")?, tokens.len(), budget)?;
    let tables = CrateTables {
        version,
        tokens,
        strings,
        paths,
        exceeded: OnceCell::new(),
    };
    // Read the fields and the sets of fields.
    let mut fields = section(b"FIELDS")?;
    let count = fields.count(0).ok_or(CUT)?;
    let names = fields.indices(count, budget)?;
    let packed = fields.count(1).ok_or(CUT)?;
    let size = count.checked_mul(8).ok_or(CUT)?;
    let values = fields.unpack(packed, size..=size, budget)?;
    let values = values
        .as_chunks::<8>()
        .0
        .iter()
        .map(|bytes| u64::from_le_bytes(*bytes));
    let fields: Vec<(u32, u64)> = names.into_iter().zip(values).collect();
    let mut sets = section(b"FIELDSETS")?;
    let count = sets.count(0).ok_or(CUT)?;
    let sets = sets.indices(count, budget)?;
    // Read the specs: a path, a set of fields and a kind.
    let mut specs = section(b"SPECS")?;
    let count = specs.count(0).ok_or(CUT)?;
    let columns = [(); 3].map(|()| specs.indices(count, budget));
    let [paths, starts, kinds] = columns;
    let (paths, starts, kinds) = (paths?, starts?, kinds?);
    // Assemble prims and properties from the specs.
    let mut assembly = LayerAssembly {
        bytes,
        budget,
        layer: Layer::new(file),
        tables: &tables,
        places: BTreeMap::new(),
        orders: Vec::new(),
    };
    for ((path, start), kind) in paths.into_iter().zip(starts).zip(kinds) {
        let set = sets.get(start as usize..).ok_or(BAD)?;
        let length = set.iter().take_while(|field| **field != u32::MAX).count();
        // Specs may share a long set, which is walked for each.
        charge(budget, FIELD * length as u64)?;
        let set = set[..length].iter();
        let set = set.map(|field| fields.get(*field as usize).copied());
        assembly.spec(path, kind, set)?;
    }
    let mut layer = assembly.ordered()?;
    layer.tables = Some(tables);
    Ok(layer)
}

fn tokens(mut cursor: ByteCursor<'_>, budget: &Budget) -> Result<Vec<String>, LayerParseError> {
    let count = cursor.count(0).ok_or(CUT)?;
    let size = usize::try_from(cursor.u64().ok_or(CUT)?).map_err(|_| CUT)?;
    let packed = cursor.count(1).ok_or(CUT)?;
    let text = cursor.unpack(packed, size..=size, budget)?;
    charge(
        budget,
        TOKEN * text.iter().filter(|byte| **byte == 0).count() as u64,
    )?;
    let tokens = text.split(|byte| *byte == 0).take(count);
    Ok(tokens
        .map(|token| String::from_utf8_lossy(token).into_owned())
        .collect())
}

/// The tree of paths, in the order of its branches: a path has a child if its jump is −1 or above
/// 0, and a sibling if it is 0, the next one, or above, so far on.
fn paths(
    mut cursor: ByteCursor<'_>,
    tokens: usize,
    budget: &Budget,
) -> Result<Vec<PathEntry>, LayerParseError> {
    // The empty path has an index, and no place in the tree.
    let total = cursor.count(0).ok_or(CUT)?;
    let count = cursor.count(0).ok_or(CUT)?;
    let columns = [(); 3].map(|()| cursor.integers(count, 4, budget));
    let [indices, names, jumps] = columns;
    let (indices, names, jumps) = (indices?, names?, jumps?);
    charge(budget, PATH.saturating_mul(total as u64))?;
    let mut paths = vec![PathEntry::default(); total];
    // The places that are read next, with their parents.
    let mut pending = vec![(0_usize, None)];
    let mut seen = 0;
    while let Some((mut at, mut parent)) = pending.pop() {
        loop {
            seen += 1;
            if at >= count || seen > count {
                return if count == 0 { Ok(paths) } else { Err(BAD) };
            }
            let index = u32::try_from(indices[at])
                .ok()
                .filter(|index| (*index as usize) < total);
            let index = index.ok_or(BAD)?;
            let depth = match parent {
                Some(parent) => paths[parent as usize].depth + 1,
                None => 0,
            };
            if usize::from(depth) > 2 * MAX_DEPTH {
                return Err(LayerParseError::Damaged("its prims are nested too deep"));
            }
            let name = u32::try_from(names[at].unsigned_abs()).map_err(|_| BAD)?;
            if parent.is_some() && name as usize >= tokens {
                return Err(BAD);
            }
            let is_property = names[at] < 0;
            paths[index as usize] = PathEntry {
                parent,
                name,
                is_property,
                depth,
            };
            let jump = jumps[at];
            let (has_child, has_sibling) = (jump > 0 || jump == -1, jump >= 0);
            if has_child && has_sibling {
                let sibling = at
                    .checked_add(usize::try_from(jump).unwrap_or(0))
                    .ok_or(BAD)?;
                pending.push((sibling, parent));
            }
            if has_child {
                parent = Some(index);
            } else if !has_sibling {
                break;
            }
            at += 1;
        }
    }
    Ok(paths)
}

/// The prims and properties of a layer while they are put together.
struct LayerAssembly<'a> {
    bytes: &'a [u8],
    budget: &'a Budget,
    layer: Layer,
    tables: &'a CrateTables,
    /// The prim of each path.
    places: BTreeMap<u32, u32>,
    /// The names of the children of prims, in order.
    orders: Vec<(u32, Vec<String>)>,
}

impl LayerAssembly<'_> {
    /// The layer, its prims in their order, unless one of its values exceeded a limit.
    fn ordered(self) -> Result<Layer, LayerParseError> {
        if let Some(fault) = self.tables.exceeded.get() {
            return Err(LayerParseError::Limit(*fault));
        }
        let Self {
            mut layer, orders, ..
        } = self;
        for (prim, names) in orders {
            for (rank, name) in names.into_iter().enumerate() {
                if let Some(child) = layer.prim(prim).children.get(&name).copied() {
                    layer.prim_mut(child).rank = rank;
                }
            }
        }
        Ok(layer)
    }

    /// The prim of a path, made with those above it if it is not there.
    fn place(&mut self, path: u32) -> Result<u32, LayerParseError> {
        let mut missing = Vec::new();
        let mut at = path;
        let mut prim = loop {
            if let Some(known) = self.places.get(&at) {
                break *known;
            }
            let entry = self.tables.paths.get(at as usize).ok_or(BAD)?;
            let Some(parent) = entry.parent else { break 0 };
            if missing.len() > 2 * MAX_DEPTH {
                return Err(BAD);
            }
            missing.push(at);
            at = parent;
        };
        for path in missing.into_iter().rev() {
            charge(self.budget, PRIM)?;
            self.budget
                .charge(Resource::Nodes, 1)
                .map_err(LayerParseError::Limit)?;
            let name = self.tables.name(path).ok_or(BAD)?;
            let span = Span::new(self.layer.file, 0, 0);
            let index = self.layer.add(PrimSpec::new(span));
            let parent = self.layer.prim_mut(prim);
            // A variant is written as `{set=name}`, and the set itself as `{set=}`.
            let selection = name
                .strip_prefix('{')
                .and_then(|rest| rest.strip_suffix('}'));
            match selection.and_then(|selection| selection.split_once('=')) {
                Some((set, variant)) => {
                    let variants = parent.variants.entry(set.to_owned()).or_default();
                    variants.insert(variant.to_owned(), index);
                }
                None => drop(parent.children.insert(name.to_owned(), index)),
            }
            self.places.insert(path, index);
            prim = index;
        }
        Ok(prim)
    }

    fn spec(
        &mut self,
        path: u32,
        kind: u32,
        fields: impl Iterator<Item = Option<(u32, u64)>>,
    ) -> Result<(), LayerParseError> {
        const ATTRIBUTE: u32 = 1;
        const PRIM_SPEC: u32 = 6;
        const ROOT: u32 = 7;
        const RELATIONSHIP: u32 = 8;
        const VARIANT: u32 = 10;
        // Store the fields in the property, prim or stage of the path.
        let entry = *self.tables.paths.get(path as usize).ok_or(BAD)?;
        match kind {
            ATTRIBUTE | RELATIONSHIP => {
                let prim = self.place(entry.parent.ok_or(BAD)?)?;
                charge(self.budget, 3 * PRIM / 4)?;
                let mut property = PropertySpec::default();
                for field in fields {
                    let (name, value) = field.ok_or(BAD)?;
                    self.property_field(&mut property, name, value);
                }
                let name = self.tables.name(path).ok_or(BAD)?.to_owned();
                self.layer
                    .prim_mut(prim)
                    .properties
                    .insert(name, Box::new(property));
            }
            PRIM_SPEC | VARIANT => {
                let prim = self.place(path)?;
                for field in fields {
                    let (name, value) = field.ok_or(BAD)?;
                    self.prim_field(prim, name, value);
                }
            }
            ROOT => {
                for field in fields {
                    let (name, value) = field.ok_or(BAD)?;
                    self.stage_field(name, value);
                }
            }
            _ => {}
        }
        Ok(())
    }

    fn value(&self, packed: u64) -> Option<Value> {
        self.tables.value(self.bytes, packed, self.budget)
    }

    fn word(&self, packed: u64) -> Option<String> {
        match self.value(packed)? {
            Value::Texts(mut texts) => texts.pop(),
            Value::Blocked | Value::Numbers(_) => None,
        }
    }

    fn number(&self, packed: u64) -> Option<f64> {
        match self.value(packed)? {
            Value::Numbers(numbers) => numbers.first().copied(),
            Value::Blocked | Value::Texts(_) => None,
        }
    }

    fn list<T>(
        &self,
        packed: u64,
        item: impl Fn(&mut ByteCursor<'_>) -> Option<T>,
    ) -> Option<ListOp<T>> {
        let mut cursor = ByteCursor::new(self.bytes, packed & PAYLOAD)?;
        let header = cursor.u8()?;
        let mut list = ListOp {
            is_explicit: header & 1 != 0,
            ..ListOp::default()
        };
        // The bits of the explicit, added, prepended, appended and deleted items, in file order.
        for bit in [2, 4, 32, 64, 8] {
            if header & bit != 0 {
                let items = (0..cursor.count(4)?).map(|_| {
                    self.budget.charge(Resource::Memory, TOKEN).ok()?;
                    item(&mut cursor)
                });
                let items = items.collect::<Option<Vec<T>>>()?;
                match bit {
                    8 => list.deleted = items,
                    2 | 32 => list.prepended = items,
                    _ => list.appended.extend(items),
                }
            }
        }
        Some(list)
    }

    fn path_text(&self, cursor: &mut ByteCursor<'_>) -> Option<SpannedText> {
        let text = self.tables.path(cursor.u32()?)?;
        let span = Span::new(self.layer.file, 0, 0);
        Some(SpannedText { text, span })
    }

    /// The target of a reference or a payload.
    fn target(&self, cursor: &mut ByteCursor<'_>, is_reference: bool) -> Option<ArcTarget> {
        let asset = self.tables.string(cursor.u32()?)?.to_owned();
        let SpannedText { text: path, span } = self.path_text(cursor)?;
        let mut time = LayerOffset::default();
        if is_reference || self.tables.version >= (0, 8) {
            time = LayerOffset {
                offset: cursor.f64()?,
                scale: cursor.f64()?,
            };
        }
        // The custom data of a reference is a dictionary.
        for _ in 0..if is_reference { cursor.count(12)? } else { 0 } {
            cursor.u32()?;
            let value = cursor.jump()?;
            cursor.at = cursor.at.max(value.at.checked_add(8)?);
        }
        let path = if path == "/" { String::new() } else { path };
        Some(ArcTarget {
            asset,
            path,
            time,
            span,
        })
    }

    fn property_field(&self, property: &mut PropertySpec, name: u32, value: u64) {
        match self.tables.token(name).unwrap_or("") {
            "default" => property.value = Some(StoredValue::Packed(value)),
            "timeSamples" => property.packed_samples = Some(value),
            "connectionPaths" | "targetPaths" => {
                property.targets = self.list(value, |cursor| self.path_text(cursor));
            }
            key @ ("interpolation" | "bindMaterialAs") => {
                if let Some(word) = self.word(value) {
                    property.describe(key, word);
                }
            }
            _ => {}
        }
    }

    fn prim_field(&mut self, prim: u32, name: u32, value: u64) {
        // Decode the value by the name of the field.
        let paths = |assembly: &Self| {
            let list = assembly.list(value, |cursor| {
                Some(ArcTarget::internal(assembly.path_text(cursor)?))
            });
            list.unwrap_or_default()
        };
        let name = self.tables.token(name).unwrap_or("");
        match name {
            "specifier" => {
                self.layer.prim_mut(prim).specifier = match value & PAYLOAD {
                    0 => Specifier::Def,
                    2 => Specifier::Class,
                    _ => Specifier::Over,
                };
            }
            "typeName" => {
                let word = self.word(value).unwrap_or_default();
                self.layer.prim_mut(prim).type_name = word;
            }
            "active" => self.layer.prim_mut(prim).is_active = self.number(value).map(|n| n != 0.0),
            "references" => {
                let list = self.list(value, |cursor| self.target(cursor, true));
                self.layer.prim_mut(prim).references = list.unwrap_or_default();
            }
            "payload" => {
                let list = match kind(value) {
                    Some(PAYLOAD_ITEM) => {
                        let cursor = ByteCursor::new(self.bytes, value & PAYLOAD);
                        let item = cursor.and_then(|mut cursor| self.target(&mut cursor, false));
                        let mut list = ListOp::default();
                        list.edit("", item.into_iter().collect());
                        Some(list)
                    }
                    _ => self.list(value, |cursor| self.target(cursor, false)),
                };
                self.layer.prim_mut(prim).payloads = list.unwrap_or_default();
            }
            "inheritPaths" => self.layer.prim_mut(prim).inherits = paths(self),
            "specializes" => self.layer.prim_mut(prim).specializes = paths(self),
            "variantSelection" => {
                let selections = self.selections(value).unwrap_or_default();
                self.layer.prim_mut(prim).selections = selections;
            }
            "primChildren" => self.order(prim, value),
            "clips" => self.layer.prim_mut(prim).has_clips = true,
            "relocates" => self.layer.prim_mut(prim).has_relocates = true,
            _ => {}
        }
    }

    fn order(&mut self, prim: u32, value: u64) {
        if let Some(Value::Texts(names)) = self.value(value) {
            self.orders.push((prim, names));
        }
    }

    fn selections(&self, value: u64) -> Option<BTreeMap<String, String>> {
        let mut cursor = ByteCursor::new(self.bytes, value & PAYLOAD)?;
        let count = cursor.count(8)?;
        let pair = |_| {
            self.budget.charge(Resource::Memory, 2 * TOKEN).ok()?;
            let set = self.tables.string(cursor.u32()?)?.to_owned();
            Some((set, self.tables.string(cursor.u32()?)?.to_owned()))
        };
        (0..count).map(pair).collect()
    }

    fn stage_field(&mut self, name: u32, value: u64) {
        let span = Span::new(self.layer.file, 0, 0);
        match self.tables.token(name).unwrap_or("") {
            "primChildren" => self.order(0, value),
            "defaultPrim" => self.layer.metadata.default_prim = self.word(value),
            "upAxis" => {
                let text = self.word(value);
                self.layer.metadata.up_axis = text.map(|text| SpannedText { text, span });
            }
            "metersPerUnit" => self.layer.metadata.meters_per_unit = self.number(value),
            "timeCodesPerSecond" => {
                self.layer.metadata.time_codes_per_second = self.number(value);
            }
            "framesPerSecond" => self.layer.metadata.frames_per_second = self.number(value),
            "relocates" | "layerRelocates" => self.layer.prim_mut(0).has_relocates = true,
            "startTimeCode" => self.layer.metadata.start_time_code = self.number(value),
            "subLayers" => {
                let Some(Value::Texts(texts)) = self.value(value) else {
                    return;
                };
                let layers = texts.into_iter().map(|text| SubLayer {
                    asset: SpannedText { text, span },
                    time: LayerOffset::default(),
                });
                let mut layers: Vec<SubLayer> = layers.collect();
                std::mem::swap(&mut layers, &mut self.layer.metadata.sub_layers);
                // The offsets came before.
                for (layer, known) in self.layer.metadata.sub_layers.iter_mut().zip(layers) {
                    layer.time = known.time;
                }
            }
            "subLayerOffsets" => {
                let Some(mut cursor) = ByteCursor::new(self.bytes, value & PAYLOAD) else {
                    return;
                };
                for index in 0..cursor.count(16).unwrap_or(0) {
                    let (Some(offset), Some(scale)) = (cursor.f64(), cursor.f64()) else {
                        return;
                    };
                    let layers = &mut self.layer.metadata.sub_layers;
                    if layers.len() <= index {
                        if charge(self.budget, TOKEN).is_err() {
                            return;
                        }
                        let asset = SpannedText {
                            text: String::new(),
                            span,
                        };
                        layers.push(SubLayer {
                            asset,
                            time: LayerOffset::default(),
                        });
                    }
                    layers[index].time = LayerOffset { offset, scale };
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests;
