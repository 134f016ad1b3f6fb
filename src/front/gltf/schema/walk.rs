//! The walk over the JSON of an asset: each object against its table, each extension where it may stand.

use super::core::ROOT;
use super::{Key, Object, POOLS, Pool, extension};
use crate::diag::codes;
use crate::front::gltf::json::{Kind, NodeId};
use crate::front::gltf::report::{Report, shown};
use std::collections::BTreeSet;

/// Checks the shape of the whole asset, and that its references lead somewhere.
pub(in super::super) fn walk(report: &mut Report<'_, '_>) {
    let root = report.json.root();
    if report.json.kind(root) != Kind::Map {
        let kind = report.json.kind(root).name();
        return report.say(
            &codes::GLTF_TYPE,
            "TYPE_MISMATCH",
            root,
            format!("an asset is an object, and this is {kind}"),
        );
    }
    let texts = |key| {
        let list = report.json.list(root, key);
        list.filter_map(|item| report.json.text(item)).map(std::borrow::Cow::into_owned).collect::<BTreeSet<_>>()
    };
    let declared = texts("extensionsUsed");
    let counts = POOLS.map(|(_, way)| {
        let list = report.json.at(root, way).filter(|list| report.json.kind(*list) == Kind::List);
        list.map_or(0, |list| report.json.items(list).count())
    });
    let used = counts.map(|count| vec![false; count]);
    let mut walk = Walk { report, declared, counts, used, open: vec![(root, &ROOT)] };
    while let Some((node, object)) = walk.open.pop() {
        walk.object(node, object);
    }
    walk.tell_unused();
}

pub(super) struct Walk<'w, 'r, 's> {
    pub(super) report: &'w mut Report<'r, 's>,
    /// The extensions in `extensionsUsed`.
    declared: BTreeSet<String>,
    /// How many there are in each pool.
    counts: [usize; POOLS.len()],
    /// Which of them something refers to.
    used: [Vec<bool>; POOLS.len()],
    /// Objects that are still to be checked.
    pub(super) open: Vec<(NodeId, &'static Object)>,
}

impl Walk<'_, '_, '_> {
    fn object(&mut self, node: NodeId, object: &'static Object) {
        let json = self.report.json;
        let mut seen: u32 = 0;
        for (name, value) in json.pairs(node) {
            if json.is(name, "extensions") {
                self.extensions(value, object);
            } else if json.is(name, "extras") {
                self.extras(value);
            } else if let Some(at) = object.keys.iter().position(|key| json.is(name, key.name)) {
                seen |= 1 << at;
                self.value(value, &object.keys[at].value, object.keys[at].name);
            } else {
                self.unknown(name, object);
            }
        }
        for (at, Key { name, value: _, required }) in object.keys.iter().enumerate() {
            if *required && seen & (1 << at) == 0 {
                let message = format!("the {} has no `{name}`", object.name);
                self.report.say(&codes::GLTF_MISSING, "UNDEFINED_PROPERTY", node, message);
            }
        }
    }

    fn unknown(&mut self, name: NodeId, object: &'static Object) {
        let written = self.report.json.text(name).unwrap_or_default();
        let message = format!("the {} has no property `{}`", object.name, shown(&written));
        self.report.say(&codes::GLTF_UNKNOWN, "UNEXPECTED_PROPERTY", name, message);
    }

    fn extras(&mut self, value: NodeId) {
        if self.report.json.kind(value) != Kind::Map {
            let message = "extras are best an object".to_owned();
            self.report.say(&codes::GLTF_REMARK, "NON_OBJECT_EXTRAS", value, message);
        }
    }

    fn extensions(&mut self, node: NodeId, owner: &'static Object) {
        let json = self.report.json;
        if !self.expect(node, Kind::Map, "extensions") {
            return;
        }
        for (key, value) in json.pairs(node) {
            let name = json.text(key).unwrap_or_default();
            if !self.declared.contains(&*name) {
                let message = format!("the extension `{}` is not listed in `extensionsUsed`", shown(&name));
                self.report.say(&codes::GLTF_EXTENSION, "UNDECLARED_EXTENSION", value, message);
                continue;
            }
            let Some(extension) = extension::find(&name) else { continue };
            match extension.places.iter().find(|(place, _)| *place == owner.name) {
                Some((_, object)) => {
                    if self.expect(value, Kind::Map, &name) {
                        self.open.push((value, object));
                    }
                }
                None => {
                    let message = format!("the extension `{name}` means nothing in a {}", owner.name);
                    self.report.say(&codes::GLTF_EXTENSION, "UNEXPECTED_EXTENSION_OBJECT", value, message);
                }
            }
        }
    }

    /// True if the node is of the kind; else that is reported.
    pub(super) fn expect(&mut self, node: NodeId, kind: Kind, name: &str) -> bool {
        let found = self.report.json.kind(node);
        if found != kind {
            let message = format!("`{}` is {}, not {}", shown(name), found.name(), kind.name());
            self.report.say(&codes::GLTF_TYPE, "TYPE_MISMATCH", node, message);
        }
        found == kind
    }

    /// Follows the reference at `node` to the `index` in `pool`.
    pub(super) fn follow(&mut self, node: NodeId, pool: Pool, index: u64) {
        let Some(at) = POOLS.iter().position(|(own, _)| *own == pool) else { return };
        let way = POOLS[at].1;
        let json = self.report.json;
        if let ["extensions", extension, _] = way
            && json.at(json.root(), &way[..2]).is_none()
        {
            let message = format!("this refers to `{extension}` of the asset, which has none");
            let holder = json.parent(node);
            return self.report.say(&codes::GLTF_TOGETHER, "UNSATISFIED_DEPENDENCY", holder, message);
        }
        let (count, pool) = (self.counts[at], way[way.len() - 1]);
        match usize::try_from(index).ok().and_then(|index| self.used[at].get_mut(index)) {
            Some(used) => *used = true,
            None => {
                let message = format!("there is no {index} in `{pool}`, which {}", count_words(count));
                self.report.say(&codes::GLTF_REFERENCE, "UNRESOLVED_REFERENCE", node, message);
            }
        }
    }

    /// Notes what nothing refers to: it costs space and has no effect.
    fn tell_unused(&mut self) {
        let json = self.report.json;
        for ((pool, way), used) in POOLS.iter().zip(&self.used) {
            if matches!(pool, Pool::Nodes | Pool::Scenes | Pool::Lights | Pool::Variants) {
                continue;
            }
            for (node, _) in json.list(json.root(), way[0]).zip(used).filter(|(_, used)| !**used) {
                self.report.say(&codes::GLTF_REMARK, "UNUSED_OBJECT", node, "nothing refers to this");
            }
        }
    }
}

fn count_words(count: usize) -> String {
    match count {
        0 => "is empty or absent".to_owned(),
        1 => "holds only 0".to_owned(),
        count => format!("ends at {}", count - 1),
    }
}
