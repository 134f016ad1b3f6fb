//! PLY (Turk, "The PLY polygon file format", 1994), as text or binary of either byte order.
//!
//! Nothing is allocated by a count before the file was found long enough for it.

mod body;
mod head;

use super::{MAX_FAULTS, Parsed, ParsedMesh, Unread};
use crate::color::srgb_decoded;
use crate::front::words::{Word, WordFault};
use crate::source::{Budget, Resource};
use body::PlyBody;
use head::{PlyElement, PlyProperty};

/// True if a file that begins so is a PLY.
pub(super) fn is_head(head: &[u8]) -> bool {
    head.starts_with(b"ply\n") || head.starts_with(b"ply\r")
}

/// Reads a PLY. Of vertices it keeps positions, normals, texture coordinates and colours, of faces
/// their corners.
pub(super) fn parse(bytes: &[u8], budget: &Budget) -> Result<Parsed, Unread> {
    let one = |fault| Unread::Faults(vec![fault]);
    let (elements, form, start) = head::read(bytes).map_err(one)?;
    let mut body = PlyBody::new(bytes, start, form);
    let (mut parsed, mut faults) = (Parsed::default(), Vec::new());
    for element in &elements {
        if !body.has_room(element) {
            return Err(one(element.is_cut_off()));
        }
        match element.name.bytes {
            b"vertex" => vertices(element, &mut body, &mut parsed.mesh, budget)?,
            // Any number of nothing.
            _ if element.properties.is_empty() => {}
            b"face" => {
                let corner = element.properties.iter().find(|own| own.is_corners());
                let size = corner.map_or(1, |corner| body.least(corner.kind));
                // An index becomes a triangle of twelve bytes, in a list that grows by doubling.
                let at_most = 24 * body.left() / size;
                budget.has(Resource::Memory, at_most as u64)?;
                faces(element, &mut body, &mut parsed, &mut faults).map_err(one)?;
            }
            b"tristrips" => {
                let message = "strips of triangles are not read";
                return Err(one(element.name.fault(message, "export faces")));
            }
            _ => skip(element, &mut body).map_err(one)?,
        }
    }
    let count = parsed.mesh.positions.len();
    let corners = parsed.mesh.triangles.iter().flatten();
    if faults.is_empty() && corners.into_iter().any(|corner| *corner as usize >= count) {
        let message =
            format!("a face refers to a vertex that is not there; there are {count}, from 0");
        faults.push(Word::START.fault(message, "in this file"));
    }
    if !faults.is_empty() {
        return Err(Unread::Faults(faults));
    }
    parsed.mesh.charge(budget)?;
    Ok(parsed)
}

/// The values of a vertex that are kept, by the names of their properties.
const VALUES: [&[&[u8]]; 12] = [
    &[b"x"],
    &[b"y"],
    &[b"z"],
    &[b"nx"],
    &[b"ny"],
    &[b"nz"],
    &[b"s", b"u", b"texture_u"],
    &[b"t", b"v", b"texture_v"],
    &[b"red", b"r", b"diffuse_red"],
    &[b"green", b"g", b"diffuse_green"],
    &[b"blue", b"b", b"diffuse_blue"],
    &[b"alpha", b"a", b"diffuse_alpha"],
];

fn vertices(
    element: &PlyElement<'_>,
    body: &mut PlyBody<'_>,
    mesh: &mut ParsedMesh,
    budget: &Budget,
) -> Result<(), Unread> {
    let one = |fault| Unread::Faults(vec![fault]);
    let slot = |property: &PlyProperty<'_>| {
        let mut values = VALUES.iter();
        let at = values.position(|names| names.contains(&property.name.bytes));
        at.filter(|_| property.length.is_none())
    };
    let slots: Vec<_> = element.properties.iter().map(slot).collect();
    let has = |values: &[usize]| values.iter().all(|value| slots.contains(&Some(*value)));
    if !has(&[0, 1, 2]) {
        return Err(one(element
            .name
            .fault("the vertices have no x, y and z", "these")));
    }
    let (has_normals, has_uvs, has_colors) = (has(&[3, 4, 5]), has(&[6, 7]), has(&[8, 9, 10]));
    let vertex = 24
        + 24 * usize::from(has_normals)
        + 16 * usize::from(has_uvs)
        + 32 * usize::from(has_colors);
    budget.has(Resource::Vertices, element.count as u64)?;
    budget.has(
        Resource::Memory,
        (vertex as u64).saturating_mul(element.count as u64),
    )?;
    mesh.positions.reserve_exact(element.count);
    for _ in 0..element.count {
        let mut values = [0.0; 12];
        values[11] = 1.0;
        for (property, slot) in element.properties.iter().zip(&slots) {
            match slot {
                Some(slot) => {
                    let number = body.number(property.kind, element).map_err(one)?;
                    let is_color = *slot > 7;
                    values[*slot] = if is_color {
                        property.kind.fraction(number)
                    } else {
                        number
                    };
                    if !number.is_finite() {
                        return Err(one(body.fault("a number is not finite", "of this vertex")));
                    }
                }
                None => body.skip(property, element).map_err(one)?,
            }
        }
        let [x, y, z, nx, ny, nz, u, v, r, g, b, alpha] = values;
        mesh.positions.push([x, y, z]);
        mesh.normals.extend(has_normals.then_some([nx, ny, nz]));
        mesh.uvs.extend(has_uvs.then_some([u, v]));
        let [r, g, b] = [r, g, b].map(srgb_decoded);
        mesh.colors.extend(has_colors.then_some([r, g, b, alpha]));
    }
    Ok(())
}

/// The faces, each as the fan of its triangles.
fn faces(
    element: &PlyElement<'_>,
    body: &mut PlyBody<'_>,
    parsed: &mut Parsed,
    faults: &mut Vec<WordFault>,
) -> Result<(), WordFault> {
    for _ in 0..element.count {
        for property in &element.properties {
            let Some(length) = property.length.filter(|_| property.is_corners()) else {
                body.skip(property, element)?;
                continue;
            };
            let corners = body.count(length, element)?;
            let mut fan = [0; 2];
            for at in 0..corners {
                let number = body.number(property.kind, element)?;
                let Some(corner) = whole(number) else {
                    faults
                        .push(body.fault("a face refers to a vertex by no number from 0", "here"));
                    if faults.len() >= MAX_FAULTS {
                        return Ok(());
                    }
                    continue;
                };
                if at > 1 {
                    parsed.mesh.triangles.push([fan[0], fan[1], corner]);
                }
                fan[usize::from(at > 0)] = corner;
            }
            if corners < 3 {
                let first = || {
                    (
                        element
                            .name
                            .fault("faces need three corners", "one of these"),
                        0,
                    )
                };
                parsed.not_drawn.get_or_insert_with(first).1 += 1;
            }
        }
    }
    Ok(())
}

fn skip(element: &PlyElement<'_>, body: &mut PlyBody<'_>) -> Result<(), WordFault> {
    for _ in 0..element.count {
        for property in &element.properties {
            body.skip(property, element)?;
        }
    }
    Ok(())
}

/// A number that is an index.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole and in range"
)]
fn whole(number: f64) -> Option<u32> {
    let is_whole = number.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&number);
    is_whole.then_some(number as u32)
}
