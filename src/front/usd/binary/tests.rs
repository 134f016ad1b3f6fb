//! Binary layers that OpenUSD wrote are those of its texts.

use super::super::layer::StageMetadata;
use super::super::text;
use super::*;
use rtc_source::SourceMap;

/// A layer with the bytes of its file.
struct ReadLayer {
    layer: Layer,
    bytes: &'static [u8],
}

impl ReadLayer {
    fn new(bytes: &'static [u8]) -> Self {
        let file = SourceMap::default().add("layer", Vec::new());
        let budget = Budget::default();
        let layer = match is_binary(bytes) {
            true => read(file, bytes, &budget),
            false => text::read(file, bytes, &budget),
        };
        let Ok(layer) = layer else {
            panic!("a layer that is written well is not read")
        };
        Self { layer, bytes }
    }

    fn value(&self, stored: &StoredValue) -> Value {
        match stored {
            StoredValue::Read(value) => value.clone(),
            StoredValue::Packed(packed) => {
                let tables = self.layer.tables.as_ref().expect("of a binary layer");
                let value = tables.value(self.bytes, *packed, &Budget::default());
                value.expect("a value that is read")
            }
        }
    }

    fn samples(&self, property: &PropertySpec) -> Vec<(f64, Value)> {
        let packed = property.packed_samples.map(|packed| {
            let tables = self.layer.tables.as_ref().expect("of a binary layer");
            tables.samples(self.bytes, packed, &Budget::default())
        });
        let packed = packed.into_iter().flatten();
        let packed = packed.map(|(time, packed)| (time, self.value(&StoredValue::Packed(packed))));
        let read = property.samples.iter();
        let read = read.map(|(time, stored)| (*time, self.value(stored)));
        packed.chain(read).collect()
    }

    /// Everything that the layer says of a prim and those below it, a line each.
    fn lines(&self, path: &str, index: u32, lines: &mut Vec<String>) {
        let prim = self.layer.prim(index);
        let arcs = [
            &prim.inherits,
            &prim.references,
            &prim.payloads,
            &prim.specializes,
        ];
        let arcs = arcs.map(|list| {
            let items = [&list.prepended, &list.appended, &list.deleted];
            let targets = items.map(|items| {
                let target = |arc: &ArcTarget| format!("{} {} {:?}", arc.asset, arc.path, arc.time);
                items.iter().map(target).collect::<Vec<_>>()
            });
            (list.is_explicit, targets)
        });
        let PrimSpec {
            specifier,
            type_name,
            is_active,
            selections,
            ..
        } = prim;
        lines.push(format!(
            "{path}: {specifier:?} {type_name} {is_active:?} {selections:?} {arcs:?}"
        ));
        for (name, property) in &prim.properties {
            let value = property.value.as_ref().map(|stored| self.value(stored));
            let targets = property.targets.as_ref().map(|list| {
                let items = [&list.prepended, &list.appended, &list.deleted];
                (
                    list.is_explicit,
                    items.map(|items| items.iter().map(|item| &item.text).collect::<Vec<_>>()),
                )
            });
            lines.push(format!(
                "{path}.{name}: {value:?} {:?} {targets:?} {:?} {:?}",
                self.samples(property),
                property.interpolation,
                property.is_stronger_than_descendants
            ));
        }
        let mut children: Vec<_> = prim.children.iter().collect();
        children.sort_by_key(|(_, child)| (self.layer.prim(**child).rank, **child));
        for (name, child) in children {
            self.lines(&format!("{path}/{name}"), *child, lines);
        }
        for (set, variants) in &prim.variants {
            for (name, child) in variants {
                self.lines(&format!("{path}{{{set}={name}}}"), *child, lines);
            }
        }
    }

    fn all_lines(&self) -> Vec<String> {
        let StageMetadata {
            default_prim,
            up_axis,
            meters_per_unit,
            time_codes_per_second,
            frames_per_second,
            start_time_code,
            sub_layers,
        } = &self.layer.metadata;
        let up_axis = up_axis.as_ref().map(|axis| &axis.text);
        let sub_layers: Vec<_> = sub_layers
            .iter()
            .map(|below| (&below.asset.text, below.time))
            .collect();
        let mut lines = vec![format!(
            "{default_prim:?} {up_axis:?} {meters_per_unit:?} {time_codes_per_second:?} \
             {frames_per_second:?} {start_time_code:?} {sub_layers:?}"
        )];
        self.lines("", 0, &mut lines);
        lines
    }
}

macro_rules! assert_equal {
    ($name:literal) => {
        let [text, binary] = [
            include_bytes!(concat!("../../../../tests/usd/", $name, ".usda")).as_slice(),
            include_bytes!(concat!("../../../../tests/usd/", $name, ".usdc")).as_slice(),
        ]
        .map(|bytes| ReadLayer::new(bytes).all_lines());
        for (text, binary) in text.iter().zip(&binary) {
            assert_eq!(text, binary);
        }
        assert_eq!(text.len(), binary.len());
    };
}

#[test]
fn arrays_and_values_of_each_type_are_those_of_the_text() {
    assert_equal!("values");
}

#[test]
fn values_at_times_are_those_of_the_text() {
    assert_equal!("times");
}

#[test]
fn arcs_lists_and_variants_are_those_of_the_text() {
    assert_equal!("arcs");
}

#[test]
fn layers_of_the_oldest_version_are_those_of_the_text() {
    assert_equal!("old");
}

/// A count that no block of its size could hold takes no memory.
#[test]
fn a_count_is_held_against_the_packed_bytes_before_memory_is_taken() {
    let budget = Budget::default();
    // A block of one literal byte.
    let bytes = [3_u64.to_le_bytes().as_slice(), &[0, 0x10, 7]].concat();
    for count in [1 << 12, 1 << 40, usize::MAX] {
        let mut cursor = ByteCursor {
            bytes: &bytes,
            at: 0,
        };
        assert!(cursor.integers(count, 4, &budget).is_err());
    }
    assert_eq!(
        budget.remaining(Resource::Memory),
        budget.limit(Resource::Memory)
    );
}
