//! Composition: which layers speak of a prim, and which of them is stronger.
//!
//! The order is that of OpenUSD ("LIVRPS"): a layer stack itself, then what it inherits, its
//! variants, references, payloads and what it specializes, each with all of its own arcs. A
//! [`PrimNode`] is a place in a layer stack; the child of a composed prim is the child of each of
//! its nodes, with the arcs that it adds. Specializes are weak within their node only, and classes
//! are not inherited across references.

use super::Lowering;
use super::layer::{
    ArcKind, ArcTarget, LayerOffset, ListKey, ListOp, MAX_DEPTH, PrimSpec, Specifier,
};
use super::packed::TOKEN;
use crate::exchange::SpannedText;
use rtc_diag::{clip_path, codes};
use rtc_source::{LimitExceeded, Resource, Span};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// The longest chain of arcs.
const MAX_ARCS: usize = 48;
/// The most layers of a stack.
const MAX_LAYERS: usize = 1 << 10;
/// The nodes of the budget that a node of composition counts as, beside one for each of its specs.
const NODE: u64 = 3;
/// The nodes that following an arc, or choosing a variant, counts as.
const ARC: u64 = 8;
/// So many specs that choose variants count as a node of the budget.
const SELECTIONS: u64 = 16;
/// The most nodes that speak of one prim.
const MAX_NODES: u64 = 1 << 15;

/// A layer with those beneath it, the strongest first.
pub(super) struct LayerStack {
    layers: Vec<(usize, LayerOffset)>,
}

/// A place in a layer stack that speaks of a prim.
struct PrimNode {
    stack: usize,
    path: Rc<str>,
    /// The layer and its prim, the strongest first.
    specs: Vec<(usize, u32, LayerOffset)>,
    kind: ArcKind,
    /// How deep in the tree of prims the arc stands that leads here.
    depth: usize,
    /// The target of the arc, and the prim that has it, in the paths of the node above.
    from: Rc<str>,
    to: Rc<str>,
    time: LayerOffset,
    children: Vec<PrimNode>,
}

/// How paths of a layer become paths of the stage.
#[derive(Debug)]
struct PathMap {
    from: Rc<str>,
    to: Rc<str>,
    above: Option<Rc<Self>>,
}

/// What one layer says of a prim.
pub(super) struct Opinion {
    pub(super) layer: usize,
    pub(super) prim: u32,
    pub(super) time: LayerOffset,
    /// Whether it is that of a class which the prim inherits.
    is_inherited: bool,
    paths: Option<Rc<PathMap>>,
}

/// A composed prim.
pub(super) struct ComposedPrim {
    pub(super) path: String,
    node: PrimNode,
    /// The strongest first.
    pub(super) opinions: Vec<Opinion>,
}

/// The arcs of one kind of a prim.
type ArcList = fn(&PrimSpec) -> &ListOp<ArcTarget>;

/// The layers and their prims that choose variants, the strongest first.
type VariantSelections = Vec<(usize, u32)>;

impl Opinion {
    /// A path of the layer as one of the stage.
    fn path(&self, path: &str) -> String {
        let mut path = path.to_owned();
        let mut map = self.paths.as_ref();
        while let Some(PathMap { from, to, above }) = map.map(Rc::as_ref) {
            let rest = path.strip_prefix(&**from);
            let rest = rest.filter(|rest| rest.is_empty() || rest.starts_with(['/', '.']));
            if let Some(rest) = rest {
                path = format!("{to}{rest}");
            }
            map = above.as_ref();
        }
        path
    }
}

impl ComposedPrim {
    /// What distinguishes its content from that of other prims.
    pub(super) fn key(&self) -> Vec<(usize, u32)> {
        self.opinions
            .iter()
            .map(|opinion| (opinion.layer, opinion.prim))
            .collect()
    }

    pub(super) fn name(&self) -> &str {
        self.path.rsplit('/').next().unwrap_or("")
    }
}

impl Lowering<'_> {
    pub(super) fn spec(&self, opinion: &Opinion) -> &PrimSpec {
        self.layers[opinion.layer].prim(opinion.prim)
    }

    /// The stack of a layer.
    fn stack(&mut self, layer: usize) -> usize {
        if let Some(known) = self.stack_of.get(&layer) {
            return *known;
        }
        let mut layers = Vec::new();
        self.stack_layers(layer, LayerOffset::default(), &mut Vec::new(), &mut layers);
        self.stacks.push(Rc::new(LayerStack { layers }));
        self.stack_of.insert(layer, self.stacks.len() - 1);
        self.stacks.len() - 1
    }

    fn stack_layers(
        &mut self,
        layer: usize,
        time: LayerOffset,
        open: &mut Vec<usize>,
        found: &mut Vec<(usize, LayerOffset)>,
    ) {
        found.push((layer, time));
        open.push(layer);
        for sub in self.layers[layer].metadata.sub_layers.clone() {
            let Some(below) = self.open_layer(&sub.asset, layer) else {
                continue;
            };
            let reason = if open.contains(&below) {
                "the sublayer includes itself".to_owned()
            } else if found.iter().any(|(known, _)| *known == below) {
                // Further down it says nothing new.
                continue;
            } else if open.len() >= MAX_ARCS {
                format!("sublayers are nested more than {MAX_ARCS} deep")
            } else if found.len() >= MAX_LAYERS {
                format!("the stage has more than {MAX_LAYERS} sublayers")
            } else {
                self.stack_layers(below, time.after(sub.time), open, found);
                continue;
            };
            let message = format!("{reason}: this one is left out");
            self.report(&codes::USD_ARC, sub.asset.span, message);
        }
        open.pop();
    }

    /// The root of the prims of a layer stack.
    fn root_node(&self, stack: usize) -> PrimNode {
        let layers = self.stacks[stack].layers.iter();
        PrimNode {
            stack,
            path: "".into(),
            specs: layers.map(|(layer, time)| (*layer, 0, *time)).collect(),
            kind: ArcKind::Root,
            depth: 0,
            from: "".into(),
            to: "".into(),
            time: LayerOffset::default(),
            children: Vec::new(),
        }
    }

    /// The root of the stage.
    pub(super) fn pseudo_root(&mut self, layer: usize) -> ComposedPrim {
        let stack = self.stack(layer);
        self.composed(String::new(), self.root_node(stack))
    }

    fn composed(&self, path: String, node: PrimNode) -> ComposedPrim {
        let mut opinions = Vec::new();
        flatten(&node, (None, LayerOffset::default(), false), &mut opinions);
        ComposedPrim {
            path,
            node,
            opinions,
        }
    }

    /// The names of the children of a prim; those of weaker layers come first.
    pub(super) fn child_names(&self, prim: &ComposedPrim) -> Vec<String> {
        let (mut names, mut seen) = (Vec::new(), BTreeSet::new());
        for opinion in prim.opinions.iter().rev() {
            let mut children: Vec<_> = self.spec(opinion).children.iter().collect();
            children
                .sort_by_key(|(_, index)| (self.layers[opinion.layer].prim(**index).rank, **index));
            for (name, _) in children {
                if seen.insert(name) {
                    names.push(name.clone());
                }
            }
        }
        names
    }

    /// A child of a prim, composed.
    pub(super) fn child(&mut self, prim: &ComposedPrim, name: &str) -> Option<ComposedPrim> {
        self.nodes = 0;
        let mut node = self.step(&prim.node, name)?;
        self.expand(&mut node, &[], 0);
        Some(self.composed(format!("{}/{name}", prim.path), node))
    }

    /// The prim at a path of the stage.
    pub(super) fn prim_at(&mut self, path: &str) -> Option<Rc<ComposedPrim>> {
        if let Some(known) = self.prims.get(path) {
            return known.clone();
        }
        let (above, name) = path.rsplit_once('/')?;
        // No prim is so deep, whatever a relationship says.
        if path.matches('/').count() > super::MAX_DEPTH {
            return None;
        }
        let found = match above {
            "" => self.root.clone(),
            above => self.prim_at(above),
        };
        let found = found
            .and_then(|parent| self.child(&parent, name))
            .map(Rc::new);
        let bytes = 1024 + 2 * path.len() as u64;
        self.charge(Resource::Memory, bytes, self.root_span)?;
        self.prims.insert(path.to_owned(), found.clone());
        found
    }

    /// The child of each place of a node.
    fn step(&mut self, node: &PrimNode, name: &str) -> Option<PrimNode> {
        let specs = node.specs.iter().filter_map(|(layer, prim, time)| {
            let child = self.layers[*layer].prim(*prim).children.get(name)?;
            Some((*layer, *child, *time))
        });
        let specs: Vec<_> = specs.collect();
        let children = node.children.iter();
        let children: Vec<PrimNode> = children
            .filter_map(|child| self.step(child, name))
            .collect();
        if specs.is_empty() && children.is_empty() {
            return None;
        }
        self.charge_node(specs.len())?;
        Some(PrimNode {
            stack: node.stack,
            path: format!("{}/{name}", node.path).into(),
            specs,
            kind: node.kind,
            depth: node.depth,
            from: Rc::clone(&node.from),
            to: Rc::clone(&node.to),
            time: node.time,
            children,
        })
    }

    /// Charges a node of some specs. `None` if the budget is used up, or a prim has too many.
    fn charge_node(&mut self, specs: usize) -> Option<()> {
        self.nodes += 1;
        if self.nodes > MAX_NODES {
            let fault = LimitExceeded {
                resource: Resource::Nodes,
                total: self.nodes,
                limit: MAX_NODES,
            };
            self.exhaust(fault, self.root_span);
            return None;
        }
        self.charge(Resource::Nodes, NODE + specs as u64, self.root_span)
    }

    /// Charges a walk through selections.
    fn charge_selections(&self, known: &[(usize, u32)]) -> Option<()> {
        let nodes = known.len() as u64 / SELECTIONS;
        self.charge(Resource::Nodes, nodes, self.root_span)
    }

    /// The prim at a path of a layer stack; `selections` are those of stronger layers.
    fn prim_index(
        &mut self,
        stack: usize,
        path: &str,
        selections: &[(usize, u32)],
        arcs: usize,
    ) -> Option<PrimNode> {
        let mut node = self.root_node(stack);
        let names: Vec<&str> = path.split('/').filter(|name| !name.is_empty()).collect();
        if names.len() > MAX_DEPTH {
            return None;
        }
        for (index, name) in names.iter().enumerate() {
            node = self.step(&node, name)?;
            let is_last = index + 1 == names.len();
            self.expand(&mut node, if is_last { selections } else { &[] }, arcs);
        }
        Some(node)
    }

    /// Adds the arcs that the places of a node have.
    fn expand(&mut self, node: &mut PrimNode, selections: &[(usize, u32)], arcs: usize) {
        if self.is_exhausted() || self.charge_selections(selections).is_none() {
            return;
        }
        let mut known: VariantSelections = selections.to_vec();
        self.selections(node, &mut known);
        for child in &mut node.children {
            self.expand(child, &known, arcs);
            self.all_selections(child, &mut known);
        }
        let lists: [(ArcKind, ArcList); 4] = [
            (ArcKind::Inherit, |spec| &spec.inherits),
            (ArcKind::Reference, |spec| &spec.references),
            (ArcKind::Payload, |spec| &spec.payloads),
            (ArcKind::Specialize, |spec| &spec.specializes),
        ];
        for (kind, list) in lists {
            for (target, from) in self.arc_targets(node, list) {
                if let Some(child) = self.follow(node, kind, &target, (from, arcs), &known) {
                    self.all_selections(&child, &mut known);
                    node.children.push(child);
                }
            }
        }
        self.variants(node, &mut known, arcs);
        node.children
            .sort_by_key(|child| (child.kind, usize::MAX - child.depth));
    }

    /// The targets of a list, with the layer that names each.
    fn arc_targets(&self, node: &PrimNode, list: ArcList) -> Vec<(ArcTarget, usize)> {
        let mut targets: Vec<ArcTarget> = Vec::new();
        let mut layer_origins = BTreeMap::new();
        for (layer, prim, time) in node.specs.iter().rev() {
            let list = list(self.layers[*layer].prim(*prim));
            for target in list.prepended.iter().chain(&list.appended) {
                let (asset, path) = target.key();
                layer_origins.insert((asset.to_owned(), path.to_owned()), (*layer, *time));
            }
            list.apply(&mut targets);
        }
        let with_origin = |mut target: ArcTarget| {
            let key = (target.asset.clone(), target.path.clone());
            let (layer, time) = layer_origins.get(&key).copied()?;
            target.time = time.after(target.time);
            Some((target, layer))
        };
        targets.into_iter().filter_map(with_origin).collect()
    }

    /// The node that an arc leads to, which the layer `from` names behind so many others; `None`
    /// if it leads nowhere, which is reported.
    fn follow(
        &mut self,
        node: &PrimNode,
        kind: ArcKind,
        target: &ArcTarget,
        (from, arcs): (usize, usize),
        known: &[(usize, u32)],
    ) -> Option<PrimNode> {
        let (stack, layer) = match target.asset.as_str() {
            "" => (node.stack, None),
            asset => {
                let asset = SpannedText {
                    text: asset.to_owned(),
                    span: target.span,
                };
                let layer = self.open_layer(&asset, from)?;
                (self.stack(layer), Some(layer))
            }
        };
        let default = || {
            let layer = layer.unwrap_or(self.stacks[stack].layers[0].0);
            let name = self.layers[layer].metadata.default_prim.as_ref()?;
            Some(format!("/{}", name.trim_start_matches('/')))
        };
        let path = match target.path.as_str() {
            "" => default(),
            path => Some(path.to_owned()),
        };
        let Some(path) = path else {
            let why = "its file has no `defaultPrim`, and it names no prim";
            return self.nowhere((node, kind), target.span, why);
        };
        let is_within = |inner: &str| {
            inner
                .strip_prefix(path.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
        };
        let place = (stack, path.clone());
        let is_cycle =
            stack == node.stack && is_within(&node.path) || self.open_arcs.contains(&place);
        if is_cycle {
            return self.nowhere((node, kind), target.span, "it leads back to its own prim");
        }
        if arcs >= MAX_ARCS {
            let why = format!("more than {MAX_ARCS} arcs lead from one to the next");
            return self.nowhere((node, kind), target.span, &why);
        }
        self.charge(Resource::Nodes, ARC, self.root_span)?;
        self.open_arcs.push(place);
        let found = self.prim_index(stack, &path, known, arcs + 1);
        self.open_arcs.pop();
        let Some(mut found) = found else {
            // A class that no layer defines may be inherited; it adds nothing.
            let may_be_missing = matches!(kind, ArcKind::Inherit | ArcKind::Specialize);
            if self.is_exhausted() || may_be_missing {
                return None;
            }
            let message = format!("there is no prim `{}`", clip_path(&path));
            return self.nowhere((node, kind), target.span, &message);
        };
        found.kind = kind;
        found.depth = node.path.matches('/').count();
        found.from = path.into();
        found.to = Rc::clone(&node.path);
        found.time = target.time;
        Some(found)
    }

    /// Reports an arc that is left out.
    fn nowhere(
        &mut self,
        (node, kind): (&PrimNode, ArcKind),
        span: Span,
        why: &str,
    ) -> Option<PrimNode> {
        let (arc, prim) = (kind.keyword(), clip_path(&node.path));
        let message = format!("`{arc}` of the prim `{prim}` is left out: {why}");
        if self
            .reported
            .insert((span.file, span.start, message.clone()))
        {
            self.report(&codes::USD_ARC, span, message);
        }
        None
    }

    /// Adds the chosen variant of each set.
    fn variants(&mut self, node: &mut PrimNode, known: &mut VariantSelections, arcs: usize) {
        // Collect the variant sets of all specs of the prim.
        let mut sets = BTreeSet::new();
        for (layer, prim, _) in &node.specs {
            let variants = &self.layers[*layer].prim(*prim).variants;
            sets.extend(variants.keys().cloned());
        }
        if arcs >= MAX_ARCS {
            return;
        }
        for set in sets {
            // The selection of the user comes before that of the layers.
            let wanted = self.options.variant.as_deref();
            let wanted = wanted.and_then(|wanted| wanted.split_once('='));
            let wanted = wanted.filter(|(wanted, _)| *wanted == set);
            let wanted = wanted.map(|(_, variant)| variant.to_owned());
            self.used_variant |= wanted.is_some();
            let chosen = || {
                let mut specs = known
                    .iter()
                    .map(|(layer, prim)| self.layers[*layer].prim(*prim));
                specs.find_map(|spec| spec.selections.get(&set).cloned())
            };
            let Some(choice) = wanted.or_else(chosen) else {
                continue;
            };
            if self.charge_selections(known).is_none() {
                return;
            }
            // Collect the specs of the chosen variant.
            let specs = node.specs.iter().filter_map(|(layer, prim, time)| {
                let variants = self.layers[*layer].prim(*prim).variants.get(&set)?;
                Some((*layer, *variants.get(&choice)?, *time))
            });
            let specs: Vec<_> = specs.collect();
            let charged = self.charge(Resource::Nodes, ARC, self.root_span);
            if specs.is_empty()
                || charged
                    .and_then(|()| self.charge_node(specs.len()))
                    .is_none()
            {
                continue;
            }
            // Compose them as a child with its own arcs.
            let mut variant = PrimNode {
                stack: node.stack,
                path: Rc::clone(&node.path),
                specs,
                kind: ArcKind::Variant,
                depth: node.path.matches('/').count(),
                from: "".into(),
                to: "".into(),
                time: LayerOffset::default(),
                children: Vec::new(),
            };
            self.expand(&mut variant, known, arcs + 1);
            self.all_selections(&variant, known);
            node.children.push(variant);
        }
    }

    /// The selections of the layers of a node.
    fn selections(&self, node: &PrimNode, known: &mut VariantSelections) {
        let specs = node.specs.iter().map(|(layer, prim, _)| (*layer, *prim));
        known.extend(
            specs.filter(|(layer, prim)| !self.layers[*layer].prim(*prim).selections.is_empty()),
        );
    }

    fn all_selections(&self, node: &PrimNode, known: &mut VariantSelections) {
        self.selections(node, known);
        for child in &node.children {
            self.all_selections(child, known);
        }
    }

    /// Whether a prim is drawn at all: it is defined, active and no class.
    pub(super) fn is_defined(&self, prim: &ComposedPrim) -> bool {
        let mut specifiers = prim.opinions.iter().filter_map(|opinion| {
            match (self.spec(opinion).specifier, opinion.is_inherited) {
                (Specifier::Over, _) | (Specifier::Class, true) => None,
                (specifier, _) => Some(specifier),
            }
        });
        let mut active = prim
            .opinions
            .iter()
            .filter_map(|opinion| self.spec(opinion).is_active);
        specifiers.next() == Some(Specifier::Def) && active.next().unwrap_or(true)
    }

    pub(super) fn type_name(&self, prim: &ComposedPrim) -> &str {
        let mut names = prim
            .opinions
            .iter()
            .map(|opinion| self.spec(opinion).type_name.as_str());
        names.find(|name| !name.is_empty()).unwrap_or("")
    }

    pub(super) fn span_of(&self, prim: &ComposedPrim) -> Span {
        let first = prim.opinions.first().map(|opinion| self.spec(opinion).span);
        first.unwrap_or(self.root_span)
    }

    /// The targets of a relationship, or the connections of an attribute, as paths of the stage.
    pub(super) fn targets(&self, prim: &ComposedPrim, name: &str) -> Vec<String> {
        let mut targets: Vec<SpannedText> = Vec::new();
        for opinion in prim.opinions.iter().rev() {
            let property = self.spec(opinion).properties.get(name);
            let Some(list) = property.and_then(|property| property.targets.as_ref()) else {
                continue;
            };
            // Every prim that inherits a list of targets maps it anew.
            let all = [&list.prepended, &list.appended, &list.deleted];
            let count = all.iter().map(|items| items.len() as u64).sum::<u64>();
            if self
                .charge(Resource::Memory, TOKEN * count, self.root_span)
                .is_none()
            {
                return Vec::new();
            }
            let map = |items: &Vec<SpannedText>| {
                let map = |item: &SpannedText| SpannedText {
                    text: opinion.path(&item.text),
                    span: item.span,
                };
                items.iter().map(map).collect()
            };
            let mapped = ListOp {
                is_explicit: list.is_explicit,
                prepended: map(&list.prepended),
                appended: map(&list.appended),
                deleted: map(&list.deleted),
            };
            mapped.apply(&mut targets);
        }
        targets.into_iter().map(|target| target.text).collect()
    }
}

/// The opinions of a node and those behind its arcs, the strongest first.
fn flatten(
    node: &PrimNode,
    (above, time, is_inherited): (Option<&Rc<PathMap>>, LayerOffset, bool),
    found: &mut Vec<Opinion>,
) {
    let time = time.after(node.time);
    let is_inherited = is_inherited || matches!(node.kind, ArcKind::Inherit | ArcKind::Specialize);
    let paths = match node.from.is_empty() {
        true => above.cloned(),
        false => Some(Rc::new(PathMap {
            from: Rc::clone(&node.from),
            to: Rc::clone(&node.to),
            above: above.cloned(),
        })),
    };
    for (layer, prim, own) in &node.specs {
        found.push(Opinion {
            layer: *layer,
            prim: *prim,
            time: time.after(*own),
            is_inherited,
            paths: paths.clone(),
        });
    }
    for child in &node.children {
        flatten(child, (paths.as_ref(), time, is_inherited), found);
    }
}
