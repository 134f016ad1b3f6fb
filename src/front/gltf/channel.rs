//! Animation channels: the animated property, and whether the keyframes fit it.

use super::accessor;
use super::animation::{Animation, CheckedAnimations, Interpolation};
use super::constraint::AccessorConstraint;
use super::document::Document;
use super::field::ObjectFields;
use super::layout::{ComponentType, ElementLayout};
use super::mesh::Mesh;
use super::node::NodeTransform;
use super::pointer;
use super::report::AssetReport;
use rtc_diag::codes;
use rtc_source::tree::NodeId;

/// The extension whose channels name their property by a JSON pointer.
const POINTER: &str = "KHR_animation_pointer";

/// What moves, and how.
#[derive(Debug)]
pub(super) struct AnimationChannel {
    pub(super) at: NodeId,
    pub(super) sampler: Option<usize>,
    pub(super) node: Option<usize>,
    pub(super) path: Option<AnimatedPath>,
    /// What names the property that moves, if it is no property of a node.
    pub(super) pointer: Option<String>,
}

/// The property that a channel moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum AnimatedPath {
    Translation,
    Rotation,
    Scale,
    Weights,
}

impl AnimatedPath {
    /// The path of a name.
    pub(super) fn of(name: &str) -> Option<Self> {
        Some(match name {
            "translation" => Self::Translation,
            "rotation" => Self::Rotation,
            "scale" => Self::Scale,
            "weights" => Self::Weights,
            _ => return None,
        })
    }
}

impl AnimationChannel {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        let target = fields.object("target");
        let pointer = target.filter(|target| target.is("path", "pointer"));
        let pointer = pointer.and_then(|target| target.extension(POINTER)?.text("pointer"));
        let path_of_target = || target.and_then(|target| AnimatedPath::of(&target.text("path")?));
        let node = || target.and_then(|target| target.index("node"));
        let (node, path) = match pointer.as_deref().and_then(pointer::of_node) {
            Some((node, path)) => (Some(node), Some(path)),
            None => (node(), path_of_target()),
        };
        Self {
            at: fields.at,
            sampler: fields.index("sampler"),
            node,
            path,
            pointer: pointer.filter(|_| path.is_none()),
        }
    }
}

/// A channel that moves by a pointer has the path `pointer` and names no node.
pub(super) fn check_pointers(
    doc: &Document<'_>,
    animation: &Animation,
    report: &mut AssetReport<'_, '_>,
) {
    let is_used = doc.uses(POINTER);
    for channel in &animation.channels {
        let Some(target) = ObjectFields::new(report.json, channel.at).object("target") else {
            continue;
        };
        // The path `pointer` needs its extension.
        let path = target.node("path");
        if let Some(at) = path.filter(|path| !is_used && report.json.is(*path, "pointer")) {
            let message = format!(
                "the path `pointer` needs the extension `{POINTER}`, which `extensionsUsed` does \
                not list"
            );
            let hint = "add the extension to that list, or choose another path".to_owned();
            report.add_with_hint(&codes::GLTF_CHOICE, "VALUE_NOT_IN_LIST", at, message, hint);
        }
        // With the extension, the path must be `pointer`.
        let Some(extension) = target.extension(POINTER).filter(|_| is_used) else {
            continue;
        };
        if let Some(at) = path.filter(|path| !report.json.is(*path, "pointer")) {
            let message = format!(
                "the channel has a pointer, so its path must be `pointer`, not {}",
                report.shown(at)
            );
            let alias = "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH";
            report.add(&codes::GLTF_TOGETHER, alias, at, message);
        }
        // The pointer names a property that can be animated.
        let named = channel.pointer.as_deref();
        if named.is_some_and(|named| pointer::resolve(doc, report.json, named).is_none()) {
            let message =
                "the property of the pointer is not supported, so it is not animated".to_owned();
            let hint = "point to a property that rtc animates, or remove the channel".to_owned();
            report.add_with_hint(&codes::GLTF_MATERIAL_ODD, "", extension.at, message, hint);
        }
        // It replaces the node.
        if target.has("node") {
            let message = "the channel has both a pointer and a node".to_owned();
            let alias = "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE";
            report.add(&codes::GLTF_TOGETHER, alias, extension.at, message);
        }
    }
}

/// Checks a channel with its sampler and its node.
pub(super) fn check(
    doc: &Document<'_>,
    animation: &Animation,
    channel: &AnimationChannel,
    links: &mut CheckedAnimations<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    // Check what the channel animates.
    check_target(doc, channel, report);
    // Find its sampler.
    let Some(index) = channel.sampler else { return };
    let at = report.json.at_or(channel.at, "sampler");
    let Some(sampler) = animation.samplers.get(index) else {
        if !animation.samplers.is_empty() {
            let message = format!("the animation has no sampler {index}");
            report.add(&codes::GLTF_REFERENCE, "UNRESOLVED_REFERENCE", at, message);
        }
        return;
    };
    let output = accessor::find(doc, sampler.output, report);
    let (Some((output, accessor)), Some(path)) = (output, channel.path) else {
        return;
    };
    // Rotations are unit quaternions; the tangents of a cubic spline are not.
    if path == AnimatedPath::Rotation {
        let constraint = match sampler.interpolation {
            Interpolation::Cubic => AccessorConstraint::CubicRotations,
            Interpolation::Linear | Interpolation::Step => AccessorConstraint::Rotations,
        };
        links.2.add(output, constraint, at);
    }
    // The path allows certain element types.
    if !accessor.layout.is_some_and(|layout| allows(path, layout)) {
        let found = accessor
            .layout
            .map_or("of an unknown type".to_owned(), ElementLayout::name);
        let message = format!("the keyframes are {found}, which this path does not accept");
        report.add(
            &codes::GLTF_FORMAT,
            "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
            at,
            message,
        );
    }
    // There is one keyframe per time, or three for a cubic spline.
    let times = sampler.input.and_then(|input| doc.accessors.get(input));
    let times = times.and_then(|times| times.count);
    if let (Some(times), Some(count)) = (times, accessor.count) {
        let keyframes = expected(doc, channel, (path, sampler.interpolation), times);
        check_count((count, keyframes, times), at, report);
    }
}

/// The number of elements of a channel's keyframes, for the given number of times.
fn expected(
    doc: &Document<'_>,
    channel: &AnimationChannel,
    (path, interpolation): (AnimatedPath, Interpolation),
    times: usize,
) -> usize {
    let targets = if path == AnimatedPath::Weights {
        mesh(doc, channel).map_or(0, Mesh::targets)
    } else {
        1
    };
    let parts = match interpolation {
        Interpolation::Cubic => 3,
        Interpolation::Linear | Interpolation::Step => 1,
    };
    times.saturating_mul(targets).saturating_mul(parts)
}

fn check_count(
    (count, expected, times): (usize, usize, usize),
    at: NodeId,
    report: &mut AssetReport<'_, '_>,
) {
    if expected != 0 && expected != count {
        let message = format!("{count} keyframes, and {expected} are expected for {times} times");
        report.add(
            &codes::GLTF_COUNT,
            "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
            at,
            message,
        );
    }
}

fn mesh<'d>(doc: &'d Document<'_>, channel: &AnimationChannel) -> Option<&'d Mesh> {
    doc.meshes.get(doc.nodes.get(channel.node?)?.mesh?)
}

/// True if the keyframes of a path may have this format (glTF 2.0, section 3.11).
fn allows(path: AnimatedPath, layout: ElementLayout) -> bool {
    let ElementLayout {
        component,
        columns,
        rows,
        normalized,
    } = layout;
    let is_float = component == ComponentType::F32 && !normalized;
    let is_fraction = normalized && component.size() < 4;
    let is = |wanted| columns == 1 && rows == wanted;
    match path {
        AnimatedPath::Translation | AnimatedPath::Scale => is(3) && is_float,
        AnimatedPath::Rotation => is(4) && (is_float || is_fraction),
        AnimatedPath::Weights => is(1) && (is_float || is_fraction),
    }
}

fn check_target(doc: &Document<'_>, channel: &AnimationChannel, report: &mut AssetReport<'_, '_>) {
    // Find the animated node.
    let node = channel
        .node
        .and_then(|node| doc.nodes.get(node))
        .filter(|node| report.is_part(node.at));
    let Some(node) = node else { return };
    let at = report.json.at_or(channel.at, "target");
    // The node must have the animated property, and the animation an effect.
    match channel.path {
        Some(AnimatedPath::Translation | AnimatedPath::Rotation | AnimatedPath::Scale) => {
            if matches!(node.transform, NodeTransform::Matrix(_)) {
                let message = "the node has a `matrix`, so it cannot be animated".to_owned();
                report.add(
                    &codes::GLTF_ANIMATION,
                    "ANIMATION_CHANNEL_TARGET_NODE_MATRIX",
                    at,
                    message,
                );
            }
            if node.skin.is_some() {
                let message =
                    "the node has a skin, so animating the node does not move the mesh".to_owned();
                report.add(
                    &codes::GLTF_SKIN_ODD,
                    "ANIMATION_CHANNEL_TARGET_NODE_SKIN",
                    at,
                    message,
                );
            }
        }
        Some(AnimatedPath::Weights) if mesh(doc, channel).map_or(0, Mesh::targets) == 0 => {
            let message = "the node has no morph targets, so it cannot have weights".to_owned();
            report.add(
                &codes::GLTF_ANIMATION,
                "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS",
                at,
                message,
            );
        }
        Some(AnimatedPath::Weights) | None => {}
    }
}
