//! Animation pointers (`KHR_animation_pointer`): the property that a pointer names, and its
//! animated value.

use super::channel::AnimatedPath;
use super::document::Document;
use rtc_source::tree::{NodeId, NodeKind, SyntaxTree};
use rtc_tables::{MATERIAL_EXTENSIONS, PropertyKind};
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// The animated values of properties, by object and key.
pub(super) type AnimatedValues = BTreeMap<(NodeId, &'static str), Vec<f64>>;

/// A property that an animation may move.
#[derive(Clone, Copy, Debug)]
pub(super) struct AnimatedProperty {
    /// The object that has it.
    pub(super) at: NodeId,
    pub(super) key: &'static str,
    /// Its number of values.
    pub(super) width: usize,
    /// The range of each number.
    range: [f64; 2],
}

impl AnimatedProperty {
    /// The property with the numbers of an animation, clamped to its range, since cubic splines may
    /// leave it; `None` if they are not finite.
    pub(super) fn kept(&self, numbers: &[f64]) -> Option<Vec<f64>> {
        let [min, max] = self.range;
        let is_finite = numbers.iter().all(|number| number.is_finite());
        is_finite.then(|| {
            numbers
                .iter()
                .map(|number| number.clamp(min, max))
                .collect()
        })
    }
}

/// A row of the table: the object with the property, its key, its number of values, their range.
type PointerRow = (&'static str, &'static str, usize, [f64; 2]);

const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
const UNIT: [f64; 2] = [0.0, 1.0];
const FACTOR: [f64; 2] = [0.0, f64::INFINITY];
const POSITIVE: [f64; 2] = [f64::MIN_POSITIVE, f64::INFINITY];

/// The maximum depth of a property that is followed.
const STEPS: usize = 6;

/// The properties that are followed, beside those of the table of extensions.
const FOLLOWED: &[PointerRow] = &[
    ("pbrMetallicRoughness", "baseColorFactor", 4, UNIT),
    ("pbrMetallicRoughness", "metallicFactor", 1, UNIT),
    ("pbrMetallicRoughness", "roughnessFactor", 1, UNIT),
    ("materials", "emissiveFactor", 3, UNIT),
    ("materials", "alphaCutoff", 1, FACTOR),
    ("normalTexture", "scale", 1, FREE),
    ("clearcoatNormalTexture", "scale", 1, FREE),
    (
        "KHR_materials_emissive_strength",
        "emissiveStrength",
        1,
        FACTOR,
    ),
    ("KHR_materials_iridescence", "iridescenceFactor", 1, UNIT),
    (
        "KHR_materials_iridescence",
        "iridescenceIor",
        1,
        [1.0, f64::INFINITY],
    ),
    (
        "KHR_materials_iridescence",
        "iridescenceThicknessMinimum",
        1,
        FACTOR,
    ),
    (
        "KHR_materials_iridescence",
        "iridescenceThicknessMaximum",
        1,
        FACTOR,
    ),
    ("KHR_texture_transform", "offset", 2, FREE),
    ("KHR_texture_transform", "rotation", 1, FREE),
    ("KHR_texture_transform", "scale", 2, FREE),
    ("perspective", "yfov", 1, POSITIVE),
    ("perspective", "aspectRatio", 1, POSITIVE),
    ("perspective", "znear", 1, FREE),
    ("perspective", "zfar", 1, FREE),
    ("orthographic", "xmag", 1, FREE),
    ("orthographic", "ymag", 1, FREE),
    ("orthographic", "znear", 1, FREE),
    ("orthographic", "zfar", 1, FREE),
    ("lights", "color", 3, UNIT),
    ("lights", "intensity", 1, FACTOR),
    ("lights", "range", 1, POSITIVE),
    ("spot", "innerConeAngle", 1, [0.0, FRAC_PI_2]),
    ("spot", "outerConeAngle", 1, [0.0, FRAC_PI_2]),
];

/// The rows of the properties of the table of extensions that are no maps.
fn of_extensions() -> impl Iterator<Item = PointerRow> {
    MATERIAL_EXTENSIONS.iter().flat_map(|(name, properties)| {
        properties.iter().filter_map(|(key, kind, _)| {
            let (width, range) = width_and_range(*kind)?;
            Some((*name, *key, width, range))
        })
    })
}

/// How many numbers a property of a kind has, and their range; none for a map.
fn width_and_range(kind: PropertyKind) -> Option<(usize, [f64; 2])> {
    Some(match kind {
        PropertyKind::Fraction => (1, UNIT),
        PropertyKind::Number => (1, FREE),
        PropertyKind::NonNegative => (1, FACTOR),
        PropertyKind::Distance => (1, POSITIVE),
        PropertyKind::Color => (3, FACTOR),
        PropertyKind::FractionColor => (3, UNIT),
        PropertyKind::Map | PropertyKind::NormalMap => return None,
    })
}

/// The node and the path that a pointer names, as channels without pointers do.
pub(super) fn of_node(pointer: &str) -> Option<(usize, AnimatedPath)> {
    let (node, key) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
    Some((node.parse().ok()?, AnimatedPath::of(key)?))
}

/// The property of a material, a camera or a light that a pointer names; none if it names another
/// one, or an object that the asset has not.
pub(super) fn resolve(
    doc: &Document<'_>,
    json: &SyntaxTree<'_>,
    pointer: &str,
) -> Option<AnimatedProperty> {
    let part = |list: &[NodeId], at: usize| list.get(at).copied();
    let split = |prefix: &str| pointer.strip_prefix(prefix)?.split_once('/');
    let index = |(at, rest): (&'_ str, _)| Some((at.parse::<usize>().ok()?, rest));
    let (part, rest, list) = if let Some((at, rest)) = split("/materials/").and_then(index) {
        (part(&doc.materials, at)?, rest, "materials")
    } else if let Some((at, rest)) = split("/cameras/").and_then(index) {
        (part(&doc.cameras, at)?, rest, "cameras")
    } else {
        let (at, rest) = split("/extensions/KHR_lights_punctual/lights/").and_then(index)?;
        (part(&doc.lights, at)?, rest, "lights")
    };
    let (path, key) = rest.rsplit_once('/').unwrap_or(("", rest));
    let steps = path.split('/').filter(|step| !step.is_empty());
    let holder = path.rsplit('/').next().filter(|step| !step.is_empty());
    let at = steps
        .take(STEPS)
        .try_fold(part, |at, step| json.get(at, step))?;
    let mut rows = FOLLOWED.iter().copied().chain(of_extensions());
    let is_row =
        |(number, name, ..): &PointerRow| *number == holder.unwrap_or(list) && *name == key;
    let (_, key, width, range) = rows.find(is_row)?;
    (json.kind(at) == NodeKind::Map).then_some(AnimatedProperty {
        at,
        key,
        width,
        range,
    })
}
