//! The traversal of the JSON of an asset: each object is checked against its table, each extension
//! against the objects that may carry it.

use super::core::ROOT;
use super::{IndexTarget, ObjectSchema, PropertySchema, TARGETS, extension, rtc_extras};
use crate::gltf::report::{AssetReport, shown};
use rtc_diag::codes;
use rtc_source::tree::{NodeId, NodeKind};
use std::collections::BTreeSet;

/// The properties of an asset that decide how others are checked.
const HEADER: [&str; 3] = ["asset", "extensionsUsed", "extensionsRequired"];

/// Checks the shape of the whole asset, and that its references lead somewhere; only of its header
/// if the rest `is_known` not.
pub(crate) fn traverse(is_known: bool, report: &mut AssetReport<'_, '_>) -> BTreeSet<String> {
    let root = report.json.root();
    if report.json.kind(root) != NodeKind::Map {
        let kind = report.json.kind(root).name();
        let message = format!("an asset must be an object, not {kind}");
        let hint = "write one object, with the property `asset` in it".to_owned();
        report.add_with_hint(&codes::GLTF_TYPE, "TYPE_MISMATCH", root, message, hint);
        return BTreeSet::new();
    }
    let json = report.json;
    // Only declared extensions are checked.
    let declared = json
        .list(root, "extensionsUsed")
        .filter_map(|item| json.text(item));
    let declared = declared.map(str::to_owned).collect();
    // Mark each item of the root arrays as unused until a reference is found.
    let slot = |item| {
        if json.kind(item) == NodeKind::Map {
            ListElement::Unused
        } else {
            ListElement::NoPart
        }
    };
    let slots = TARGETS.map(|(_, path)| {
        let list = json
            .at(root, path)
            .filter(|list| json.kind(*list) == NodeKind::List);
        list.map_or_else(Vec::new, |list| json.items(list).map(slot).collect())
    });
    let present = TARGETS.map(|(_, path)| path.len() == 1 || json.at(root, &path[..2]).is_some());
    // Visit the objects of the document with an explicit stack.
    let mut traverse = SchemaWalk {
        report,
        declared,
        slots,
        present,
        is_known,
        open: vec![(root, &ROOT)],
    };
    while let Some((node, object)) = traverse.open.pop() {
        traverse.object(node, object);
    }
    // Report items that nothing refers to.
    if is_known {
        traverse.report_unused();
    }
    traverse.declared
}

/// An element of a list of parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ListElement {
    Unused,
    Used,
    /// It is no object, so nothing can refer to it.
    NoPart,
}

pub(super) struct SchemaWalk<'w, 'r, 's> {
    pub(super) report: &'w mut AssetReport<'r, 's>,
    /// The extensions in `extensionsUsed`; with `--lenient`, also missing ones.
    declared: BTreeSet<String>,
    /// The length of each array that indices refer to.
    slots: [Vec<ListElement>; TARGETS.len()],
    /// The asset has the extension that contains the array, if any.
    present: [bool; TARGETS.len()],
    /// The asset is glTF 2; else only its header is checked.
    is_known: bool,
    /// Objects that are still to be checked.
    pub(super) open: Vec<(NodeId, &'static ObjectSchema)>,
}

impl SchemaWalk<'_, '_, '_> {
    fn object(&mut self, node: NodeId, object: &'static ObjectSchema) {
        let json = self.report.json;
        let mut seen: u32 = 0;
        let is_header = !self.is_known && node == json.root();
        for (name, value) in json.pairs(node) {
            let known = object.keys.iter().position(|key| json.is(name, key.name));
            let is_common = json.is(name, "extensions") || json.is(name, "extras");
            if is_header
                && (known.is_some() || is_common)
                && !HEADER.iter().any(|key| json.is(name, key))
            {
                continue;
            }
            if json.is(name, "extensions") {
                self.extensions(value, object);
            } else if json.is(name, "extras") {
                self.extras(value, object);
            } else if let Some(at) = known {
                seen |= u32::from(json.kind(value) != NodeKind::Null) << at;
                self.value(value, &object.keys[at].value, object.keys[at].name);
            } else {
                self.unknown(name, object);
            }
        }
        self.missing(node, object, seen);
    }

    /// Reports the properties that an object needs and has not; `seen` has a bit for each that it
    /// has.
    fn missing(&mut self, node: NodeId, object: &'static ObjectSchema, seen: u32) {
        for (
            at,
            PropertySchema {
                name,
                value: _,
                required,
            },
        ) in object.keys.iter().enumerate()
        {
            if *required && seen & (1 << at) == 0 {
                let message = format!("the {} has no `{name}`", object.name);
                self.report
                    .add(&codes::GLTF_MISSING, "UNDEFINED_PROPERTY", node, message);
            }
        }
    }

    fn unknown(&mut self, name: NodeId, object: &'static ObjectSchema) {
        let written = self.report.json.text(name).unwrap_or_default();
        let message = format!(
            "the {} has an unknown property `{}`",
            object.name,
            shown(written)
        );
        self.report
            .add(&codes::GLTF_UNKNOWN, "UNEXPECTED_PROPERTY", name, message);
    }

    /// Extras may be anything, except for those of rtc itself.
    fn extras(&mut self, value: NodeId, owner: &'static ObjectSchema) {
        let rtc = self.report.json.get(value, "rtc");
        if let Some((node, object)) = rtc.zip(rtc_extras::find(owner.name))
            && self.expect(node, NodeKind::Map, "rtc")
        {
            self.open.push((node, object));
        }
        if ![NodeKind::Map, NodeKind::Null].contains(&self.report.json.kind(value)) {
            let message = "`extras` should be an object".to_owned();
            self.report
                .add(&codes::GLTF_REMARK, "NON_OBJECT_EXTRAS", value, message);
        }
    }

    fn extensions(&mut self, node: NodeId, owner: &'static ObjectSchema) {
        let json = self.report.json;
        if !self.expect(node, NodeKind::Map, "extensions") {
            return;
        }
        for (key, value) in json.pairs(node) {
            let name = json.text(key).unwrap_or_default();
            let is_object = self.expect(value, NodeKind::Map, name);
            // An extension must be declared in the root object.
            if !self.declared.contains(name) {
                let message = format!(
                    "the extension `{}` is not listed in `extensionsUsed`",
                    shown(name)
                );
                let (alias, repair) = ("UNDECLARED_EXTENSION", "it is treated as listed");
                self.report
                    .repair(&codes::GLTF_EXTENSION, alias, value, &message, repair);
                if !self.report.is_lenient() {
                    continue;
                }
                self.declared.insert(name.to_owned());
            }
            // Extensions that rtc does not know are ignored.
            let Some(extension) = extension::find(name) else {
                continue;
            };
            // A known one is checked as an object of its owner.
            let place = extension
                .places
                .iter()
                .find(|(place, _)| *place == owner.name);
            if place.is_some() {
                self.has_root(name, value, owner);
            }
            match place {
                Some((_, object)) if is_object => self.open.push((value, object)),
                Some((_, object)) => self.missing(value, object, 0),
                None => {
                    let message =
                        format!("the extension `{name}` has no meaning in a {}", owner.name);
                    self.report.add(
                        &codes::GLTF_EXTENSION,
                        "UNEXPECTED_EXTENSION_OBJECT",
                        value,
                        message,
                    );
                }
            }
        }
    }

    /// The extension of an object refers to that of the asset, if it has properties there.
    fn has_root(&mut self, name: &str, value: NodeId, owner: &ObjectSchema) {
        let target = TARGETS
            .iter()
            .position(|(_, path)| path.len() > 1 && path[1] == name);
        if owner.name != ROOT.name && target.is_some_and(|target| !self.present[target]) {
            let message = format!("this refers to `{name}` of the asset, which is missing");
            self.report.add(
                &codes::GLTF_TOGETHER,
                "UNSATISFIED_DEPENDENCY",
                value,
                message,
            );
        }
    }

    /// True if the node is of the kind; else that is reported.
    pub(super) fn expect(&mut self, node: NodeId, kind: NodeKind, name: &str) -> bool {
        let found = self.report.json.kind(node);
        if found != kind {
            let message = format!(
                "`{}` is {}; it must be {}",
                shown(name),
                found.name(),
                kind.name()
            );
            self.report
                .add(&codes::GLTF_TYPE, "TYPE_MISMATCH", node, message);
        }
        found == kind
    }

    /// Follows the reference at `node` to the `index` in `target`.
    pub(super) fn follow(&mut self, node: NodeId, target: IndexTarget, index: u64) {
        // Find the root array that the index refers to.
        let Some(at) = TARGETS.iter().position(|(entry, _)| *entry == target) else {
            return;
        };
        let path = TARGETS[at].1;
        if !self.present[at] {
            return;
        }
        let (count, target) = (self.slots[at].len(), path[path.len() - 1]);
        // Mark the item as used, or report that it does not exist.
        match usize::try_from(index)
            .ok()
            .and_then(|index| self.slots[at].get_mut(index))
        {
            Some(slot @ (ListElement::Unused | ListElement::Used)) => *slot = ListElement::Used,
            Some(ListElement::NoPart) => {
                let message =
                    format!("`/{target}/{index}` is not an object, so nothing can refer to it");
                self.report.add(
                    &codes::GLTF_REFERENCE,
                    "UNRESOLVED_REFERENCE",
                    node,
                    message,
                );
            }
            None => {
                let message = format!(
                    "index {index} is out of range: `{target}` {}",
                    count_words(count)
                );
                self.report.add(
                    &codes::GLTF_REFERENCE,
                    "UNRESOLVED_REFERENCE",
                    node,
                    message,
                );
            }
        }
    }

    /// Reports entities that nothing refers to: they cost space and have no effect.
    fn report_unused(&mut self) {
        let json = self.report.json;
        for ((target, path), slots) in TARGETS.iter().zip(&self.slots) {
            if matches!(
                target,
                IndexTarget::Nodes
                    | IndexTarget::Scenes
                    | IndexTarget::Lights
                    | IndexTarget::Variants
            ) {
                continue;
            }
            let unused = |(_, slot): &(NodeId, &ListElement)| **slot == ListElement::Unused;
            for (node, _) in json.list(json.root(), path[0]).zip(slots).filter(unused) {
                self.report.add(
                    &codes::GLTF_REMARK,
                    "UNUSED_OBJECT",
                    node,
                    "this is unused: nothing refers to it",
                );
            }
        }
    }
}

fn count_words(count: usize) -> String {
    match count {
        0 => "is empty or absent".to_owned(),
        1 => "has only element 0".to_owned(),
        count => format!("ends with element {}", count - 1),
    }
}
