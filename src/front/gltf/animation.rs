//! Animations: channels, samplers and their keyframes.

use super::accessor::{self, Accessor};
use super::buffer::{BufferViewUsage, BufferViewUsages};
use super::channel::{self, AnimatedPath, AnimationChannel};
use super::constraint::{AccessorConstraint, AccessorConstraints};
use super::document::Document;
use super::field::ObjectFields;
use super::layout::{ComponentType, ElementLayout};
use super::report::AssetReport;
use super::usage::{AccessorUsage, AccessorUsages};
use rtc_diag::codes;
use rtc_source::tree::NodeId;
use std::collections::BTreeMap;

/// An animation.
#[derive(Debug)]
pub(super) struct Animation {
    pub(super) name: String,
    pub(super) channels: Vec<AnimationChannel>,
    pub(super) samplers: Vec<Keyframes>,
}

/// Keyframes.
#[derive(Debug)]
pub(super) struct Keyframes {
    at: NodeId,
    pub(super) input: Option<usize>,
    pub(super) output: Option<usize>,
    pub(super) interpolation: Interpolation,
}

/// The interpolation between two keyframes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interpolation {
    Linear,
    Step,
    Cubic,
}

impl Animation {
    pub(super) fn read(fields: ObjectFields<'_, '_>) -> Self {
        Self {
            name: fields.name(),
            channels: fields
                .objects("channels")
                .map(AnimationChannel::read)
                .collect(),
            samplers: fields.objects("samplers").map(Keyframes::read).collect(),
        }
    }
}

impl Keyframes {
    fn read(fields: ObjectFields<'_, '_>) -> Self {
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

/// The results of the checks of animations.
pub(super) type CheckedAnimations<'l> = (
    &'l mut BufferViewUsages,
    &'l mut AccessorUsages,
    &'l mut AccessorConstraints,
);

/// Checks all animations.
pub(super) fn check(
    doc: &Document<'_>,
    links: &mut CheckedAnimations<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    for animation in &doc.animations {
        for sampler in &animation.samplers {
            check_sampler(doc, sampler, links, report);
        }
        let mut targets: BTreeMap<(usize, AnimatedPath), usize> = BTreeMap::new();
        for (index, channel) in animation.channels.iter().enumerate() {
            channel::check(doc, animation, channel, links, report);
            let (Some(node), Some(path)) = (channel.node, channel.path) else {
                continue;
            };
            let first = *targets.entry((node, path)).or_insert(index);
            if first != index {
                let at = report.json.at_or(channel.at, "target");
                let message = format!("channel {first} already animates this target");
                report.repair(
                    &codes::GLTF_DUPLICATE,
                    "ANIMATION_DUPLICATE_TARGETS",
                    at,
                    &message,
                    "the last channel is used",
                );
            }
        }
        check_used(animation, report);
        channel::check_pointers(doc, animation, report);
    }
}

fn check_used(animation: &Animation, report: &mut AssetReport<'_, '_>) {
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
        report.add(
            &codes::GLTF_REMARK,
            "UNUSED_OBJECT",
            sampler.at,
            "this is unused: nothing refers to it",
        );
    }
}

fn check_sampler(
    doc: &Document<'_>,
    sampler: &Keyframes,
    links: &mut CheckedAnimations<'_>,
    report: &mut AssetReport<'_, '_>,
) {
    let (purposes, usages, constraints) = links;
    for (key, index, usage) in [
        ("input", sampler.input, AccessorUsage::Times),
        ("output", sampler.output, AccessorUsage::Keyframes),
    ] {
        let Some((index, accessor)) = accessor::find(doc, index, report) else {
            continue;
        };
        // Record how the sampler uses each accessor and its view.
        let at = report.json.at_or(sampler.at, key);
        usages.set(index, usage, at, report);
        purposes.set(accessor.view, BufferViewUsage::Other, at, report);
        // Keyframes are tightly packed.
        if accessor
            .view
            .and_then(|view| doc.views.get(view))
            .is_some_and(|view| view.stride.is_some())
        {
            let message = "the buffer view of keyframes must not have a `byteStride`";
            let (alias, repair) = (
                "ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE",
                "the stride is used",
            );
            report.repair(&codes::GLTF_VIEW, alias, at, message, repair);
        }
        // The input holds times, which must increase.
        if usage == AccessorUsage::Times {
            check_times(accessor, sampler, at, report);
            if accessor.layout.is_some_and(is_time) {
                constraints.add(index, AccessorConstraint::Times, at);
            }
        }
    }
}

fn is_time(layout: ElementLayout) -> bool {
    layout.components() == 1 && layout.component == ComponentType::F32 && !layout.normalized
}

fn check_times(
    accessor: &Accessor,
    sampler: &Keyframes,
    at: NodeId,
    report: &mut AssetReport<'_, '_>,
) {
    // Times are scalars in f32.
    if !accessor.layout.is_some_and(is_time) {
        let found = accessor
            .layout
            .map_or("of an unknown type".to_owned(), ElementLayout::name);
        let message = format!("the times are {found}; they must be scalar of f32");
        report.add(
            &codes::GLTF_FORMAT,
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT",
            at,
            message,
        );
    }
    // Their bounds give the duration.
    if !accessor.has_bounds() {
        report.repair(
            &codes::GLTF_FORMAT,
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS",
            at,
            "the accessor of times needs `min` and `max`",
            "they are computed",
        );
    }
    // A cubic spline needs two keyframes.
    if sampler.interpolation == Interpolation::Cubic && accessor.count == Some(1) {
        let message = "a cubic spline needs at least 2 keyframes, and this has 1".to_owned();
        report.add(
            &codes::GLTF_COUNT,
            "ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS",
            at,
            message,
        );
    }
}
