//! The pose: the local transforms of nodes and the morph weights of meshes, at rest or at a time of
//! an animation.

use super::super::accessor_reader::AccessorReader;
use super::super::animation::{Animation, Interpolation, Keyframes};
use super::super::channel::{AnimatedPath, AnimationChannel};
use super::super::document::Document;
use super::super::node::NodeTransform;
use super::super::pointer::{self, AnimatedProperty, AnimatedValues};
use super::super::report::AssetReport;
use super::transform::compose;
use crate::FrontOptions;
use glam::{DAffine3, DMat4};
use rtc_diag::codes;
use rtc_math::{acos, sin};
use rtc_source::Resource;
use rtc_source::tree::NodeId;
use std::collections::BTreeMap;

/// The bytes of a weight of a morph target: its value and its bits in the key.
const WEIGHT: u64 = 32;

/// The transforms and weights of all nodes.
pub(super) struct ScenePose {
    transforms: Vec<NodeTransform>,
    /// The weights of nodes, where they have their own.
    weights: BTreeMap<usize, Vec<f64>>,
    /// The properties that moved by pointers.
    pub(super) animated: AnimatedValues,
}

impl ScenePose {
    /// The transformation of a node from itself to its parent.
    pub(super) fn local(&self, node: usize) -> DAffine3 {
        match self.transforms[node] {
            NodeTransform::Matrix(matrix) => DAffine3::from_mat4(DMat4::from_cols_array(&matrix)),
            NodeTransform::Parts {
                translation,
                rotation,
                scale,
            } => compose(translation, rotation, scale),
        }
    }

    /// The weights of morph targets of a node that override those of its mesh.
    pub(super) fn weights(&self, node: usize) -> Option<&[f64]> {
        self.weights.get(&node).map(Vec::as_slice)
    }
}

/// The pose at rest.
fn rest(doc: &Document<'_>) -> ScenePose {
    let nodes = doc.nodes.iter().enumerate();
    let weights = nodes
        .filter(|(_, node)| !node.weights.is_empty())
        .map(|(index, node)| (index, node.weights.clone()));
    ScenePose {
        transforms: doc.nodes.iter().map(|node| node.transform).collect(),
        weights: weights.collect(),
        animated: AnimatedValues::new(),
    }
}

/// The pose at a time of an animation; at rest without one.
pub(super) fn pose(
    doc: &Document<'_>,
    (animation, time): (Option<&Animation>, f64),
    report: &mut AssetReport<'_, '_>,
) -> ScenePose {
    let mut pose = rest(doc);
    let Some(animation) = animation else {
        return pose;
    };
    for (channel, keys) in channels(doc, animation) {
        // A pointer animates any property.
        let pointer = channel.pointer.as_deref();
        if let Some(property) =
            pointer.and_then(|pointer| pointer::resolve(doc, report.json, pointer))
        {
            pose.animate_property(&property, (&keys, time), channel.at, report);
        }
        // Any other channel animates a node.
        let memory = keys.width() as u64 * WEIGHT;
        if channel.node.is_some()
            && channel.path == Some(AnimatedPath::Weights)
            && !report.charge(Resource::Memory, memory, channel.at, "the channel")
        {
            break;
        }
        pose.animate_node(channel, &keys, time);
    }
    pose
}

/// The pose of the nodes alone at a time of an animation.
pub(super) fn moved(doc: &Document<'_>, animation: &Animation, time: f64) -> ScenePose {
    let mut pose = rest(doc);
    for (channel, keys) in channels(doc, animation) {
        pose.animate_node(channel, &keys, time);
    }
    pose
}

/// The first and the last time of the keyframes of an animation; `None` if it has none.
pub(super) fn span(doc: &Document<'_>, animation: &Animation) -> Option<[f64; 2]> {
    let spans =
        channels(doc, animation).map(|(_, keys)| [keys.time(0), keys.time(keys.times.count - 1)]);
    spans.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])
}

/// The numbers of a pose of an animation.
pub(super) fn numbers(doc: &Document<'_>, animation: &Animation) -> usize {
    let widths = channels(doc, animation).map(|(_, keys)| keys.width());
    widths.fold(0, usize::saturating_add)
}

/// The channels of an animation that have keyframes.
fn channels<'d>(
    doc: &'d Document<'_>,
    animation: &'d Animation,
) -> impl Iterator<Item = (&'d AnimationChannel, SamplerKeyframes<'d>)> {
    animation.channels.iter().filter_map(|channel| {
        let sampler = animation.samplers.get(channel.sampler?)?;
        Some((channel, SamplerKeyframes::of(doc, sampler)?))
    })
}

/// The requested animation: by name, or else the first if there is a time.
pub(super) fn chosen<'d>(
    doc: &'d Document<'_>,
    options: &FrontOptions,
    report: &mut AssetReport<'_, '_>,
) -> Option<&'d Animation> {
    let Some(name) = &options.animation else {
        options.time?;
        if doc.animations.is_empty() {
            let [message, hint] =
                ["the asset does not move", "it has no animations"].map(str::to_owned);
            report.add_with_hint(&codes::GLTF_STILL, "", report.json.root(), message, hint);
        }
        return doc.animations.first();
    };
    let found = doc
        .animations
        .iter()
        .find(|animation| animation.name == *name);
    if found.is_none() {
        let names: Vec<String> = doc
            .animations
            .iter()
            .map(|animation| animation.name.clone())
            .collect();
        super::missing("animation", name, &names, report);
    }
    found
}

impl ScenePose {
    /// Moves a property to where it is at a time.
    fn animate_property(
        &mut self,
        property: &AnimatedProperty,
        (keys, time): (&SamplerKeyframes<'_>, f64),
        at: NodeId,
        report: &mut AssetReport<'_, '_>,
    ) {
        let AnimatedProperty {
            at: of, key, width, ..
        } = *property;
        if keys.width() != width {
            let message = format!(
                "the keyframes have {} numbers, but `{key}` needs {width}, so it does not move",
                keys.width()
            );
            let hint = "write keyframes of so many numbers".to_owned();
            return report.add_with_hint(&codes::GLTF_MATERIAL_ODD, "", at, message, hint);
        }
        let numbers = keys.sample(false, time);
        if let Some(numbers) = numbers.and_then(|numbers| property.kept(&numbers)) {
            self.animated.insert((of, key), numbers);
        }
    }

    /// Moves the node of a channel to where it is at a time.
    fn animate_node(&mut self, channel: &AnimationChannel, keys: &SamplerKeyframes<'_>, time: f64) {
        if let Some((node, path)) = channel.node.zip(channel.path)
            && let Some(value) = keys.sample(path == AnimatedPath::Rotation, time)
        {
            self.set(node, path, value);
        }
    }

    fn set(&mut self, node: usize, path: AnimatedPath, value: Vec<f64>) {
        if path == AnimatedPath::Weights {
            self.weights.insert(node, value);
            return;
        }
        let Some(NodeTransform::Parts {
            translation,
            rotation,
            scale,
        }) = self.transforms.get_mut(node)
        else {
            return;
        };
        let three = || <[f64; 3]>::try_from(&value[..]).ok();
        match path {
            AnimatedPath::Translation => *translation = three().unwrap_or(*translation),
            AnimatedPath::Scale => *scale = three().unwrap_or(*scale),
            AnimatedPath::Rotation => {
                *rotation = <[f64; 4]>::try_from(&value[..]).unwrap_or(*rotation)
            }
            AnimatedPath::Weights => {}
        }
    }
}

/// The keyframes of a sampler; only those around the time are read.
struct SamplerKeyframes<'d> {
    times: AccessorReader<'d>,
    output: AccessorReader<'d>,
    interpolation: Interpolation,
}

impl<'d> SamplerKeyframes<'d> {
    fn of(doc: &'d Document<'_>, sampler: &Keyframes) -> Option<Self> {
        let elements =
            |accessor: Option<usize>| AccessorReader::of(doc, doc.accessors.get(accessor?)?);
        let (times, output) = (elements(sampler.input)?, elements(sampler.output)?);
        Some(Self {
            times,
            output,
            interpolation: sampler.interpolation,
        })
    }

    fn is_cubic(&self) -> bool {
        self.interpolation == Interpolation::Cubic
    }

    /// The number of components of a value.
    fn width(&self) -> usize {
        let numbers = self.output.count * self.output.layout.components();
        numbers / self.times.count / if self.is_cubic() { 3 } else { 1 }
    }

    fn time(&self, key: usize) -> f64 {
        self.times.at::<1>(key)[0]
    }

    /// The number of keyframes up to a time.
    fn until(&self, time: f64) -> usize {
        let (mut low, mut high) = (0, self.times.count);
        while low < high {
            let middle = low.midpoint(high);
            if self.time(middle) <= time {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }

    /// A keyframe; of a cubic one, its part: the tangent before it, the value, or the tangent after
    /// it.
    fn key(&self, index: usize, part: usize) -> Option<Vec<f64>> {
        let (width, components) = (self.width(), self.output.layout.components());
        let at = if self.is_cubic() {
            3 * index + part
        } else {
            index
        } * width;
        let elements = at / components..(at + width).div_ceil(components);
        let numbers =
            elements.flat_map(|element| self.output.at::<16>(element).into_iter().take(components));
        (at + width <= self.output.count * components)
            .then(|| numbers.skip(at % components).take(width).collect())
    }

    /// The value at a time; constant before the first and after the last keyframe.
    fn sample(&self, is_rotation: bool, time: f64) -> Option<Vec<f64>> {
        let next = self.until(time);
        let (a, b) = (next.saturating_sub(1), next.min(self.times.count - 1));
        let span = self.time(b) - self.time(a);
        let share = if a == b || span <= 0.0 {
            0.0
        } else {
            ((time - self.time(a)) / span).clamp(0.0, 1.0)
        };
        let middle = usize::from(self.is_cubic());
        let (from, to) = (self.key(a, middle)?, self.key(b, middle)?);
        Some(match self.interpolation {
            Interpolation::Step => from,
            Interpolation::Linear if is_rotation => slerp(&from, &to, share),
            Interpolation::Linear => from
                .iter()
                .zip(&to)
                .map(|(a, b)| a + (b - a) * share)
                .collect(),
            Interpolation::Cubic => {
                let (leaving, arriving) = (self.key(a, 2)?, self.key(b, 0)?);
                hermite([&from, &leaving, &to, &arriving], span, share)
            }
        })
    }
}

/// The cubic through two values with their tangents (glTF 2.0, appendix C.5).
fn hermite([from, leaving, to, arriving]: [&[f64]; 4], span: f64, t: f64) -> Vec<f64> {
    let (t2, t3) = (t * t, t * t * t);
    let weights = [
        2.0 * t3 - 3.0 * t2 + 1.0,
        span * (t3 - 2.0 * t2 + t),
        3.0 * t2 - 2.0 * t3,
        span * (t3 - t2),
    ];
    let part = |at: usize| {
        let parts = [from[at], leaving[at], to[at], arriving[at]];
        parts
            .iter()
            .zip(weights)
            .map(|(part, weight)| part * weight)
            .sum()
    };
    (0..from.len()).map(part).collect()
}

/// The rotation on the shorter way from one to another (glTF 2.0, appendix C.4).
fn slerp(from: &[f64], to: &[f64], t: f64) -> Vec<f64> {
    let cosine: f64 = from.iter().zip(to).map(|(a, b)| a * b).sum();
    let angle = acos(cosine.abs().min(1.0));
    let sine = sin(angle);
    let (a, b) = if sine > 1e-6 {
        (sin(angle * (1.0 - t)) / sine, sin(angle * t) / sine)
    } else {
        (1.0 - t, t)
    };
    let b = if cosine < 0.0 { -b } else { b };
    from.iter()
        .zip(to)
        .map(|(from, to)| a * from + b * to)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotations_take_the_shorter_way() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        let quarter = slerp(&[0.0, 0.0, 0.0, 1.0], &[0.0, 0.0, -half, -half], 0.5);
        let eighth = std::f64::consts::FRAC_PI_8;
        assert!(
            (quarter[2] - sin(eighth)).abs() < 1e-15
                && (quarter[3] - rtc_math::cos(eighth)).abs() < 1e-15
        );
    }

    #[test]
    fn a_cubic_goes_through_its_ends_with_its_tangents() {
        let at = |t| hermite([&[1.0], &[2.0], &[3.0], &[-1.0]], 0.5, t)[0];
        assert!((at(0.0) - 1.0).abs() < 1e-15 && (at(1.0) - 3.0).abs() < 1e-15);
        let slope = (at(1e-6) - at(0.0)) / (1e-6 * 0.5);
        assert!((slope - 2.0).abs() < 1e-4, "{slope}");
    }
}
