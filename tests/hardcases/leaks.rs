//! Closed meshes leak no ray, not through edges and not through vertices, wherever they are and
//! however placed.

use super::mesh::Mesh;
use super::random::{Random, rays, tally};
use super::truth::{Report, cases, id, number, vector};
use rtc::internals::math::Vec3;
use rtc::internals::render::{Ray, World};

/// A scale, by how much radii are stretched, and where: those at which other systems leak.
const CONFIGURATIONS: [(&str, f64, f64, Vec3); 6] = [
    ("unit", 1.0, 0.0, Vec3::ZERO),
    ("displaced, radii 1 to 6", 1.0, 5.0, Vec3::ZERO),
    (
        "radius 2 at (148376, 1234, −223423)",
        2.0,
        0.0,
        Vec3::new(148_376.0, 1_234.0, -223_423.0),
    ),
    ("radius 1000 at 1e7", 1e3, 0.0, Vec3::splat(1e7)),
    ("radius 1e-6", 1e-6, 0.0, Vec3::ZERO),
    ("radius 1e8", 1e8, 0.0, Vec3::ZERO),
];

/// Leaks of rays that start near `center` and aim at edges and vertices by turns, every eighth
/// anywhere; `mesh` has the places of the vertices in the world.
fn leaks(name: &str, world: &World, mesh: &Mesh, center: Vec3, scale: f64) -> u64 {
    let ray = |index: u64| {
        let mut random = Random::at(1, index);
        let origin = center + random.cube() * (0.3 * scale);
        let [a, b, _] =
            mesh.triangles[random.below(mesh.triangles.len())].map(|k| mesh.vertices[k]);
        let direction = match index % 8 {
            0 => random.cube(),
            odd if odd % 2 == 1 => a - origin,
            _ => a + (b - a) * random.uniform() - origin,
        };
        Ray { origin, direction }
    };
    tally("leaks", name, rays(CONFIGURATIONS.len()), |index| {
        (1, u64::from(world.closest_hit(&ray(index)).is_none()))
    })
    .bad
}

#[test]
fn closed_meshes_do_not_leak() {
    let leaks = CONFIGURATIONS.map(|(name, scale, push, offset)| {
        let mesh = Mesh::displaced(scale, push, offset);
        leaks(
            &format!("triangles, {name}"),
            &mesh.world(),
            &mesh,
            offset,
            scale,
        )
    });
    assert_eq!(leaks, [0; 6]);
}

/// The map shears and stretches, so that no triangle keeps its form.
#[test]
fn placed_meshes_do_not_leak() {
    let leaks = CONFIGURATIONS.map(|(name, scale, push, offset)| {
        let axes = [
            Vec3::new(1.0, 0.3, -0.2),
            Vec3::new(-0.4, 0.9, 0.1),
            Vec3::new(0.2, -0.5, 1.3),
        ];
        let [x, y, z] = axes.map(|axis| axis * scale);
        let mut mesh = Mesh::displaced(1.0, push, Vec3::ZERO);
        let world = mesh.placed([x, y, z, offset]);
        for vertex in &mut mesh.vertices {
            *vertex = x * vertex.x + y * vertex.y + z * vertex.z + offset;
        }
        leaks(&format!("instance, {name}"), &world, &mesh, offset, scale)
    });
    assert_eq!(leaks, [0; 6]);
}

/// The meshes of the file of cases.
#[test]
fn meshes_of_the_cases_do_not_leak() {
    let mut report = Report::default();
    for case in cases("mesh_leak") {
        let input = &case["input"];
        let (scale, offset, push) = (
            number(&input["scale"]),
            vector(&input["offset"]),
            number(&input["displacement"]),
        );
        let mesh = Mesh::displaced(scale, push, offset);
        let leaks = leaks(id(&case), &mesh.world(), &mesh, offset, scale);
        report.line(id(&case), leaks == 0, &format!("{leaks} leaks"));
    }
    report.finish();
}
