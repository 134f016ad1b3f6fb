//! The ground of an asset in the studio: a disc that receives its shadow and fades out towards
//! its edge.

use super::studio::smooth;
use rtc_ir::{
    Alpha, Instance, Material, MaterialId, Mesh, MeshId, Scene, Shape, Standard, Surface,
};
use rtc_math::{Vec3, cos, sin};
use std::f64::consts::TAU;

/// Its radius, and the radius within which it is opaque, in half diagonals of the subject.
const RADIUS: f64 = 4.0;
const OPAQUE_RADIUS: f64 = 1.0;
/// Its distance below the subject, as a fraction of the half diagonal, so that no face lies in its
/// plane.
const GAP: f64 = 1e-3;
/// The number of its rings of triangles, and of the vertices of a ring.
const RINGS: u32 = 12;
const CORNERS: u32 = 48;

/// Adds a ground of a reflectance under a box, if that has an extent; returns the index of its
/// surface. It is visible from above only.
pub(super) fn add_ground(
    scene: &mut Scene,
    [low, high]: [Vec3; 2],
    reflectance: f64,
) -> Option<usize> {
    let middle = low + (high - low) / 2.0;
    let half = Vec3::new(high.x - low.x, 0.0, high.z - low.z).length() / 2.0;
    // A subject without depth may have a shadow as long as it is high.
    let half = half.max((high.y - low.y) / 2.0);
    if !(middle.is_finite() && half > 0.0) {
        return None;
    }
    let center = Vec3::new(middle.x, low.y - GAP * half, middle.z);
    let (mesh, material) = (scene.meshes.len(), scene.materials.len());
    let [Ok(mesh), Ok(material)] = [mesh, material].map(u32::try_from) else {
        return None;
    };
    scene.meshes.push(disc());
    scene.materials.push(Material::Standard(Box::new(Standard {
        name: "ground".to_owned(),
        base_color: [reflectance, reflectance, reflectance, 1.0],
        metallic: 0.0,
        alpha: Alpha::Blend,
        ..Standard::default()
    })));
    let size = RADIUS * half;
    scene.surfaces.push(Surface::new(
        Shape::Instance(Instance {
            mesh: MeshId(mesh),
            world_from_object: [
                [size, 0.0, 0.0],
                [0.0, size, 0.0],
                [0.0, 0.0, size],
                center.to_array(),
            ],
        }),
        MaterialId(material),
    ));
    Some(scene.surfaces.len() - 1)
}

/// A disc of radius 1 around the origin that faces +y; its alpha decreases to 0 at its edge.
fn disc() -> Mesh {
    let ring = |ring: u32| {
        let radius = f64::from(ring) / f64::from(RINGS);
        (0..CORNERS).map(move |corner| {
            let turn = TAU * f64::from(corner) / f64::from(CORNERS);
            (radius, [radius * sin(turn), 0.0, radius * cos(turn)])
        })
    };
    let corners: Vec<_> = (1..=RINGS).flat_map(ring).collect();
    let index = |ring: u32, corner: u32| 1 + (ring - 1) * CORNERS + corner % CORNERS;
    let inner = (0..CORNERS).map(|corner| [0, index(1, corner), index(1, corner + 1)]);
    let outer = (1..RINGS).flat_map(|ring| {
        (0..CORNERS).flat_map(move |corner| {
            let [a, b] = [corner, corner + 1].map(|corner| index(ring, corner));
            let [c, d] = [corner, corner + 1].map(|corner| index(ring + 1, corner));
            [[a, c, d], [a, d, b]]
        })
    });
    let middle = std::iter::once((0.0, [0.0; 3]));
    let all: Vec<_> = middle.chain(corners).collect();
    Mesh {
        positions: all.iter().map(|(_, place)| *place).collect(),
        colors: all
            .iter()
            .map(|(radius, _)| [1.0, 1.0, 1.0, alpha(*radius)])
            .collect(),
        triangles: inner.chain(outer).collect::<Vec<_>>().into(),
        ..Mesh::default()
    }
}

/// The alpha of the ground at a fraction of its radius: 1 in the middle, 0 at the edge, a
/// smoothstep between.
fn alpha(radius: f64) -> f64 {
    smooth((1.0 - radius) / (1.0 - OPAQUE_RADIUS / RADIUS))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ground_faces_up_and_fades() {
        let disc = disc();
        let mut area = 0.0;
        for triangle in disc.triangles.iter() {
            let [a, b, c] =
                triangle.map(|corner| Vec3::from_array(disc.positions.at(corner as usize)));
            let cross = (b - a).cross(c - a);
            assert!(cross.y > 0.0, "{triangle:?}");
            area += cross.y / 2.0;
        }
        assert!((area - TAU / 2.0).abs() < 0.02, "{area}");
        let alphas = || disc.colors.iter().map(|[.., alpha]| alpha);
        assert!(alphas().zip(alphas().skip(1)).all(|(a, b)| a >= b));
        assert_eq!((alphas().next(), alphas().last()), (Some(1.0), Some(0.0)));
    }
}
