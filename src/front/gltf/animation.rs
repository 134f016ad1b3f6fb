//! Animations: channels that move nodes over time, and the keyframes that they go through.

use super::accessor::{self, Accessor, Component, Layout};
use super::buffer::{Purpose, Purposes};
use super::contents::{Demand, Demands};
use super::document::Document;
use super::field::Fields;
use super::json::NodeId;
use super::mesh::Mesh;
use super::node::Transform;
use super::report::Report;
use super::usage::{Usage, Usages};
use crate::diag::codes;
use std::collections::BTreeMap;

/// An animation.
#[derive(Debug)]
pub(super) struct Animation {
    pub(super) name: String,
    pub(super) channels: Vec<Channel>,
    pub(super) samplers: Vec<Sampler>,
}

/// What moves, and how.
#[derive(Debug)]
pub(super) struct Channel {
    pub(super) at: NodeId,
    pub(super) sampler: Option<usize>,
    pub(super) node: Option<usize>,
    pub(super) path: Option<Path>,
}

/// The property that a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Path {
    Translation,
    Rotation,
    Scale,
    Weights,
}

/// Keyframes.
#[derive(Debug)]
pub(super) struct Sampler {
    at: NodeId,
    pub(super) input: Option<usize>,
    pub(super) output: Option<usize>,
    pub(super) interpolation: Interpolation,
}

/// What lies between two keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interpolation {
    Linear,
    Step,
    Cubic,
}

impl Animation {
    pub(super) fn read(fields: Fields<'_, '_>) -> Self {
        Self {
            name: fields.name(),
            channels: fields.objects("channels").map(Channel::read).collect(),
            samplers: fields.objects("samplers").map(Sampler::read).collect(),
        }
    }
}

impl Channel {
    fn read(fields: Fields<'_, '_>) -> Self {
        let target = fields.object("target");
        let path = target.and_then(|target| match target.text("path")?.as_str() {
            "translation" => Some(Path::Translation),
            "rotation" => Some(Path::Rotation),
            "scale" => Some(Path::Scale),
            "weights" => Some(Path::Weights),
            _ => None,
        });
        let node = target.and_then(|target| target.index("node"));
        Self {
            at: fields.at,
            sampler: fields.index("sampler"),
            node,
            path,
        }
    }
}

impl Sampler {
    fn read(fields: Fields<'_, '_>) -> Self {
        let interpolation = match fields.text("interpolation").as_deref() {
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::Cubic,
            _ => Interpolation::Linear,
        };
        Self {
            at: fields.at,
            input: fields.index("input"),
            output: fields.index("output"),
            interpolation,
        }
    }
}

/// What the checks of animations gather.
pub(super) type Links<'l> = (&'l mut Purposes, &'l mut Usages, &'l mut Demands);

/// Checks all animations.
pub(super) fn check(doc: &Document<'_>, links: &mut Links<'_>, report: &mut Report<'_, '_>) {
    for animation in &doc.animations {
        for sampler in &animation.samplers {
            check_sampler(doc, sampler, links, report);
        }
        let mut targets: BTreeMap<(usize, Path), usize> = BTreeMap::new();
        for (index, channel) in animation.channels.iter().enumerate() {
            check_channel(doc, animation, channel, links, report);
            let (Some(node), Some(path)) = (channel.node, channel.path) else {
                continue;
            };
            let first = *targets.entry((node, path)).or_insert(index);
            if first != index {
                let at = report.json.at_or(channel.at, "target");
                let message = format!("channel {first} moves the same");
                report.say(
                    &codes::GLTF_DUPLICATE,
                    "ANIMATION_DUPLICATE_TARGETS",
                    at,
                    message,
                );
            }
        }
        check_used(animation, report);
        check_pointers(doc, animation, report);
    }
}

fn check_used(animation: &Animation, report: &mut Report<'_, '_>) {
    let mut used = vec![false; animation.samplers.len()];
    for sampler in animation
        .channels
        .iter()
        .filter_map(|channel| channel.sampler)
    {
        if let Some(used) = used.get_mut(sampler) {
            *used = true;
        }
    }
    for (sampler, _) in animation
        .samplers
        .iter()
        .zip(used)
        .filter(|(_, used)| !used)
    {
        report.say(
            &codes::GLTF_REMARK,
            "UNUSED_OBJECT",
            sampler.at,
            "nothing refers to this",
        );
    }
}

/// A channel that moves by a pointer has the path `pointer` and names no node.
fn check_pointers(doc: &Document<'_>, animation: &Animation, report: &mut Report<'_, '_>) {
    const NAME: &str = "KHR_animation_pointer";
    let is_used = doc.uses(NAME);
    for channel in &animation.channels {
        let Some(target) = Fields::new(report.json, channel.at).object("target") else {
            continue;
        };
        let path = target.node("path");
        if let Some(at) = path.filter(|path| !is_used && report.json.is(*path, "pointer")) {
            let message =
                format!("the path `pointer` is one of `{NAME}`, which the asset does not use");
            report.say(&codes::GLTF_CHOICE, "VALUE_NOT_IN_LIST", at, message);
        }
        let Some(pointer) = target.extension(NAME).filter(|_| is_used) else {
            continue;
        };
        if let Some(at) = path.filter(|path| !report.json.is(*path, "pointer")) {
            let message = format!(
                "the channel has a pointer, and its path is {}, not `pointer`",
                report.shown(at)
            );
            let alias = "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH";
            report.say(&codes::GLTF_TOGETHER, alias, at, message);
        }
        let message = "what the pointer names does not move".to_owned();
        report.say(
            &codes::GLTF_IGNORES,
            "INCOMPLETE_EXTENSION_SUPPORT",
            pointer.at,
            message,
        );
        if target.has("node") {
            let message = "the channel has a pointer and a node".to_owned();
            let alias = "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE";
            report.say(&codes::GLTF_TOGETHER, alias, pointer.at, message);
        }
    }
}

fn check_sampler(
    doc: &Document<'_>,
    sampler: &Sampler,
    links: &mut Links<'_>,
    report: &mut Report<'_, '_>,
) {
    let (purposes, usages, demands) = links;
    for (key, index, usage) in [
        ("input", sampler.input, Usage::Times),
        ("output", sampler.output, Usage::Keyframes),
    ] {
        let Some((index, accessor)) = accessor::find(doc, index, report) else {
            continue;
        };
        let at = report.json.at_or(sampler.at, key);
        usages.set(index, usage, at, report);
        purposes.set(accessor.view, Purpose::Other, at, report);
        if accessor
            .view
            .and_then(|view| doc.views.get(view))
            .is_some_and(|view| view.stride.is_some())
        {
            let message = "the view of keyframes has a stride".to_owned();
            report.say(
                &codes::GLTF_VIEW,
                "ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE",
                at,
                message,
            );
        }
        if usage == Usage::Times {
            check_times(accessor, sampler, at, report);
            if accessor.layout.is_some_and(is_time) {
                demands.add(index, Demand::Times, at);
            }
        }
    }
}

fn is_time(layout: Layout) -> bool {
    layout.components() == 1 && layout.component == Component::F32 && !layout.normalized
}

fn check_times(accessor: &Accessor, sampler: &Sampler, at: NodeId, report: &mut Report<'_, '_>) {
    if !accessor.layout.is_some_and(is_time) {
        let found = accessor
            .layout
            .map_or("of no known type".to_owned(), Layout::name);
        let message = format!("times are {found}, not scalar of f32");
        report.say(
            &codes::GLTF_FORMAT,
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT",
            at,
            message,
        );
    }
    if !accessor.has_bounds() {
        let message = "times come without `min` and `max`".to_owned();
        report.say(
            &codes::GLTF_FORMAT,
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS",
            at,
            message,
        );
    }
    if sampler.interpolation == Interpolation::Cubic && accessor.count == Some(1) {
        let message = "a cubic spline has at least 2 keyframes, and this has 1".to_owned();
        report.say(
            &codes::GLTF_COUNT,
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS",
            at,
            message,
        );
    }
}

fn check_channel(
    doc: &Document<'_>,
    animation: &Animation,
    channel: &Channel,
    links: &mut Links<'_>,
    report: &mut Report<'_, '_>,
) {
    check_target(doc, channel, report);
    let Some(index) = channel.sampler else { return };
    let at = report.json.at_or(channel.at, "sampler");
    let Some(sampler) = animation.samplers.get(index) else {
        if !animation.samplers.is_empty() {
            let message = format!("the animation has no sampler {index}");
            report.say(&codes::GLTF_REFERENCE, "UNRESOLVED_REFERENCE", at, message);
        }
        return;
    };
    let output = accessor::find(doc, sampler.output, report);
    let (Some((output, accessor)), Some(path)) = (output, channel.path) else {
        return;
    };
    let is_cubic = sampler.interpolation == Interpolation::Cubic;
    if path == Path::Rotation {
        links.2.add(
            output,
            if is_cubic {
                Demand::CubicRotations
            } else {
                Demand::Rotations
            },
            at,
        );
    }
    if !accessor.layout.is_some_and(|layout| allows(path, layout)) {
        let found = accessor
            .layout
            .map_or("of no known type".to_owned(), Layout::name);
        let message = format!("the keyframes are {found}, which this path does not take");
        report.say(
            &codes::GLTF_FORMAT,
            "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
            at,
            message,
        );
    }
    let times = sampler
        .input
        .and_then(|input| doc.accessors.get(input)?.count);
    let (Some(times), Some(count)) = (times, accessor.count) else {
        return;
    };
    let targets = if path == Path::Weights {
        mesh(doc, channel).map_or(0, Mesh::targets)
    } else {
        1
    };
    let expected = times
        .saturating_mul(targets)
        .saturating_mul(if is_cubic { 3 } else { 1 });
    if expected != 0 && expected != count {
        let message = format!("{count} keyframes, and {expected} are expected for {times} times");
        report.say(
            &codes::GLTF_COUNT,
            "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
            at,
            message,
        );
    }
}

fn mesh<'d>(doc: &'d Document<'_>, channel: &Channel) -> Option<&'d Mesh> {
    doc.meshes.get(doc.nodes.get(channel.node?)?.mesh?)
}

/// True if the keyframes of a path may have this format (glTF 2.0, section 3.11).
fn allows(path: Path, layout: Layout) -> bool {
    let Layout {
        component,
        columns,
        rows,
        normalized,
    } = layout;
    let is_float = component == Component::F32 && !normalized;
    let is_fraction = normalized && component.size() < 4;
    let is = |wanted| columns == 1 && rows == wanted;
    match path {
        Path::Translation | Path::Scale => is(3) && is_float,
        Path::Rotation => is(4) && (is_float || is_fraction),
        Path::Weights => is(1) && (is_float || is_fraction),
    }
}

fn check_target(doc: &Document<'_>, channel: &Channel, report: &mut Report<'_, '_>) {
    let node = channel
        .node
        .and_then(|node| doc.nodes.get(node))
        .filter(|node| report.is_part(node.at));
    let Some(node) = node else { return };
    let at = report.json.at_or(channel.at, "target");
    match channel.path {
        Some(Path::Translation | Path::Rotation | Path::Scale) => {
            if matches!(node.transform, Transform::Matrix(_)) {
                let message = "the node has a matrix, which can't be moved".to_owned();
                report.say(
                    &codes::GLTF_ANIMATION,
                    "ANIMATION_CHANNEL_TARGET_NODE_MATRIX",
                    at,
                    message,
                );
            }
            if node.skin.is_some() {
                let message =
                    "the node has a skin, and moving it does not move the mesh".to_owned();
                report.say(
                    &codes::GLTF_SKIN_ODD,
                    "ANIMATION_CHANNEL_TARGET_NODE_SKIN",
                    at,
                    message,
                );
            }
        }
        Some(Path::Weights) if mesh(doc, channel).map_or(0, Mesh::targets) == 0 => {
            let message = "the node has no morph targets that weights could move".to_owned();
            report.say(
                &codes::GLTF_ANIMATION,
                "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS",
                at,
                message,
            );
        }
        Some(Path::Weights) | None => {}
    }
}
