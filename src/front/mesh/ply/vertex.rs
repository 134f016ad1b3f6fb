//! The vertices of a PLY, each column in the precision of its properties.

use super::super::TextParseError;
use super::super::tint::decoded;
use super::body::PlyBody;
use super::head::{PlyElement, PlyNumberType, PlyProperty};
use crate::splat::{self, Splat};
use rtc_ir::Mesh;
use rtc_math::{Vec3, VertexColumn};
use rtc_source::{Budget, Resource};

/// The values of a vertex that are kept, by the names of their properties: position, normal, both
/// sets of texture coordinates, tangent, colour as sRGB codes it, and as it is, with opacity or, as
/// Mitsuba writes it, without; the colour, opacity, size and rotation (w first) of a Gaussian
/// splat.
const VALUES: [&[&[u8]]; 36] = [
    &[b"x"],
    &[b"y"],
    &[b"z"],
    &[b"nx"],
    &[b"ny"],
    &[b"nz"],
    &[b"s", b"u", b"texture_u"],
    &[b"t", b"v", b"texture_v"],
    &[b"s1", b"u1"],
    &[b"t1", b"v1"],
    &[b"tx"],
    &[b"ty"],
    &[b"tz"],
    &[b"tw"],
    &[b"red", b"r", b"diffuse_red"],
    &[b"green", b"g", b"diffuse_green"],
    &[b"blue", b"b", b"diffuse_blue"],
    &[b"alpha", b"a", b"diffuse_alpha"],
    &[b"linear_red"],
    &[b"linear_green"],
    &[b"linear_blue"],
    &[b"linear_alpha"],
    &[b"color_0"],
    &[b"color_1"],
    &[b"color_2"],
    &[b"f_dc_0"],
    &[b"f_dc_1"],
    &[b"f_dc_2"],
    &[b"opacity"],
    &[b"scale_0"],
    &[b"scale_1"],
    &[b"scale_2"],
    &[b"rot_0"],
    &[b"rot_1"],
    &[b"rot_2"],
    &[b"rot_3"],
];

/// The values that are used together, or not at all.
const GROUPS: [std::ops::Range<usize>; 10] = [
    0..NORMAL,
    NORMAL..UV,
    UV..SECOND_UV,
    SECOND_UV..TANGENT,
    TANGENT..COLOR,
    COLOR..ALPHA,
    LINEAR_COLOR..OPAQUE_COLOR,
    OPAQUE_COLOR..SPLAT,
    SPLAT..VALUES.len(),
    // The opacity of a coded colour.
    COLOR..LINEAR_COLOR,
];

/// The offsets of values that belong together.
const NORMAL: usize = 3;
const UV: usize = 6;
const SECOND_UV: usize = 8;
const TANGENT: usize = 10;
const COLOR: usize = 14;
const ALPHA: usize = 17;
const LINEAR_COLOR: usize = 18;
const OPAQUE_COLOR: usize = 22;
const SPLAT: usize = 25;

/// The values of one vertex.
type VertexRow = [f64; VALUES.len()];

/// A column in the making; `N` values of each vertex from one on.
enum ColumnBuilder<const N: usize> {
    Absent,
    Single(usize, Vec<[f32; N]>),
    Double(usize, Vec<[f64; N]>),
}

impl<const N: usize> ColumnBuilder<N> {
    /// An empty column, in 32 bits if those hold all of its values; absent if one is missing.
    fn new(first: usize, slots: &[Option<(usize, PlyNumberType)>], count: usize) -> Self {
        let kind = |value: usize| {
            let mut slots = slots.iter().flatten();
            slots.find(|(at, _)| *at == value).map(|(_, kind)| *kind)
        };
        let kinds: Option<Vec<PlyNumberType>> = (first..first + N).map(kind).collect();
        match kinds {
            None => Self::Absent,
            Some(kinds) if kinds.iter().all(|kind| *kind == PlyNumberType::F32) => {
                Self::Single(first, Vec::with_capacity(count))
            }
            Some(_) => Self::Double(first, Vec::with_capacity(count)),
        }
    }

    fn exists(&self) -> bool {
        !matches!(self, Self::Absent)
    }

    fn push(&mut self, row: &VertexRow) {
        match self {
            Self::Absent => {}
            #[expect(clippy::cast_possible_truncation, reason = "they were 32 bits wide")]
            Self::Single(first, vectors) => {
                vectors.push(std::array::from_fn(|at| row[*first + at] as f32));
            }
            Self::Double(first, vectors) => {
                vectors.push(std::array::from_fn(|at| row[*first + at]));
            }
        }
    }

    fn finish(self) -> VertexColumn<N> {
        match self {
            Self::Absent => VertexColumn::default(),
            Self::Single(_, vectors) => vectors.into(),
            Self::Double(_, vectors) => vectors.into(),
        }
    }
}

/// The properties of vertices that are not read.
pub(super) fn unread<'e, 'a>(element: &'e PlyElement<'a>) -> Vec<&'e PlyProperty<'a>> {
    let values: Vec<_> = element.properties.iter().map(slot).collect();
    let has = |value: usize| values.iter().flatten().any(|(at, _)| *at == value);
    let is_used = |value: usize| {
        let mut groups = GROUPS.iter().filter(|group| group.contains(&value));
        groups.any(|group| group.clone().all(has))
    };
    let properties = element.properties.iter().zip(&values);
    let unread = properties.filter(|(_, value)| !value.is_some_and(|(at, _)| is_used(at)));
    unread.map(|(property, _)| property).collect()
}

/// Reads the vertices into a mesh. The splats that they are come back, if they are such.
pub(super) fn read(
    element: &PlyElement<'_>,
    body: &mut PlyBody<'_>,
    mesh: &mut Mesh,
    budget: &Budget,
) -> Result<Vec<Splat>, TextParseError> {
    let one = |fault| TextParseError::Faults(vec![fault]);
    let slots: Vec<_> = element.properties.iter().map(slot).collect();
    let has = |values: &[usize]| {
        let mut values = values.iter();
        values.all(|value| slots.iter().flatten().any(|(at, _)| at == value))
    };
    if !has(&[0, 1, 2]) {
        return Err(one(element
            .name
            .fault("the vertices have no x, y and z", "these")));
    }
    let count = element.count;
    budget.has(Resource::Vertices, count as u64)?;
    // No vertex takes more than all values would.
    let kept = slots.iter().flatten().count() + 1;
    budget.has(
        Resource::Memory,
        (8 * kept as u64).saturating_mul(count as u64),
    )?;
    let mut positions = ColumnBuilder::<3>::new(0, &slots, count);
    let mut normals = ColumnBuilder::<3>::new(NORMAL, &slots, count);
    let mut uvs = ColumnBuilder::<2>::new(UV, &slots, count);
    let mut second_uvs = ColumnBuilder::<2>::new(SECOND_UV, &slots, count);
    let mut tangents = ColumnBuilder::<4>::new(TANGENT, &slots, count);
    let mut linear = ColumnBuilder::<4>::new(LINEAR_COLOR, &slots, count);
    let is_coded = !linear.exists() && has(&[COLOR, COLOR + 1, COLOR + 2]);
    let is_opaque =
        !linear.exists() && !is_coded && has(&[OPAQUE_COLOR, OPAQUE_COLOR + 1, OPAQUE_COLOR + 2]);
    let are_splats = (SPLAT..VALUES.len()).all(|value| has(&[value]));
    if are_splats {
        budget.has(Resource::Memory, splat::MEMORY.saturating_mul(count as u64))?;
    }
    let (mut colors, mut splats) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let row = row(element, &slots, body)?;
        body.end_row();
        positions.push(&row);
        normals.push(&row);
        uvs.push(&row);
        second_uvs.push(&row);
        tangents.push(&row);
        linear.push(&row);
        colors.extend(is_coded.then(|| color(&row)));
        colors.extend(is_opaque.then(|| opaque_color(&row)));
        splats.extend(are_splats.then(|| splat_of(&row)));
    }
    mesh.positions = positions.finish();
    mesh.normals = normals.finish();
    mesh.uvs = uvs.finish();
    mesh.second_uvs = second_uvs.finish();
    mesh.tangents = tangents.finish();
    mesh.colors = if is_coded || is_opaque {
        colors.into()
    } else {
        linear.finish()
    };
    Ok(splats)
}

/// The splat that a vertex is.
fn splat_of(row: &VertexRow) -> Splat {
    let three = |first: usize| [row[first], row[first + 1], row[first + 2]];
    let [w, x, y, z] = [7, 8, 9, 10].map(|at: usize| row[SPLAT + at]);
    Splat {
        center: Vec3::from_array(three(0)),
        rotation: [x, y, z, w],
        log_scale: three(SPLAT + 4),
        opacity: splat::logistic(row[SPLAT + 3]),
        color: splat::harmonic_color(three(SPLAT)),
    }
}

/// The value that a property is, and its type.
fn slot(property: &PlyProperty<'_>) -> Option<(usize, PlyNumberType)> {
    let mut values = VALUES.iter();
    let at = values.position(|names| names.contains(&property.name.bytes));
    let at = at.filter(|_| property.length.is_none())?;
    Some((at, property.kind))
}

/// The values of the next vertex; without an alpha it is opaque.
fn row(
    element: &PlyElement<'_>,
    slots: &[Option<(usize, PlyNumberType)>],
    body: &mut PlyBody<'_>,
) -> Result<VertexRow, TextParseError> {
    let one = |fault| TextParseError::Faults(vec![fault]);
    let mut row = [0.0; VALUES.len()];
    row[ALPHA] = 1.0;
    for (property, slot) in element.properties.iter().zip(slots) {
        let Some((slot, kind)) = slot else {
            body.skip(property, element).map_err(one)?;
            continue;
        };
        let number = body.number(*kind, element).map_err(one)?;
        if !number.is_finite() {
            return Err(one(body.fault("a number is not finite", "of this vertex")));
        }
        if (LINEAR_COLOR..SPLAT).contains(slot) && number < 0.0 {
            return Err(one(body.fault("a colour is negative", "of this vertex")));
        }
        let is_coded = (COLOR..LINEAR_COLOR).contains(slot);
        row[*slot] = if is_coded {
            kind.fraction(number)
        } else {
            number
        };
    }
    Ok(row)
}

/// The colour of a vertex, which is coded as sRGB does.
fn color(row: &VertexRow) -> [f32; 4] {
    let [r, g, b] = [row[COLOR], row[COLOR + 1], row[COLOR + 2]].map(decoded);
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounded to what the IR stores"
    )]
    [r, g, b, row[ALPHA] as f32]
}

/// The linear colour of a vertex without opacity.
fn opaque_color(row: &VertexRow) -> [f32; 4] {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounded to what the IR stores"
    )]
    let channel = |channel: usize| row[OPAQUE_COLOR + channel] as f32;
    [channel(0), channel(1), channel(2), 1.0]
}

/// A channel of the colour of a face.
pub(super) struct FaceChannel {
    /// Red, green, blue or opacity, from 0.
    pub(super) index: usize,
    pub(super) kind: PlyNumberType,
    /// Whether it is linear and not coded as sRGB.
    pub(super) is_linear: bool,
}

/// The channel of a colour that a property is.
pub(super) fn channel(property: &PlyProperty<'_>) -> Option<FaceChannel> {
    let (at, kind) = slot(property).filter(|(at, _)| *at < SPLAT)?;
    let is_linear = at >= OPAQUE_COLOR;
    let first = if is_linear { OPAQUE_COLOR } else { COLOR };
    let index = at.checked_sub(first).filter(|channel| *channel < 4)?;
    Some(FaceChannel {
        index,
        kind,
        is_linear,
    })
}
