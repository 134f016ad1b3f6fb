//! PLY (Turk, "The PLY polygon file format", 1994), as text or binary of either byte order.
//!
//! Nothing is allocated by a count before the file was found long enough for it.

mod body;
mod head;
mod vertex;

use super::{MAX_FAULTS, Parsed, Unread, charge};
use crate::words::{Word, WordFault};
use body::PlyBody;
use head::PlyElement;
use rtc_source::{Budget, Resource};

/// True if a file that begins so is a PLY.
pub(super) fn is_head(head: &[u8]) -> bool {
    head.starts_with(b"ply\n") || head.starts_with(b"ply\r")
}

/// Reads a PLY. Of vertices it keeps positions, normals, texture coordinates, tangents and colours, of
/// faces their corners.
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
            b"vertex" => vertex::read(element, &mut body, &mut parsed.mesh, budget)?,
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
    charge(&mut parsed.mesh, budget)?;
    Ok(parsed)
}

/// The faces, each as the fan of its triangles.
fn faces(
    element: &PlyElement<'_>,
    body: &mut PlyBody<'_>,
    parsed: &mut Parsed,
    faults: &mut Vec<WordFault>,
) -> Result<(), WordFault> {
    let Parsed {
        mesh, not_drawn, ..
    } = parsed;
    let triangles: &mut Vec<[u32; 3]> = &mut mesh.triangles;
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
                    triangles.push([fan[0], fan[1], corner]);
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
                not_drawn.get_or_insert_with(first).1 += 1;
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
