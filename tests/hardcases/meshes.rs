//! Many triangles: closed meshes leak no ray, and the hierarchy finds what brute force finds, bit for bit.

use crate::scenes::{sphere, triangle, world};
use crate::truth::{Report, cases, id, number, relative_error, vector};
use rtc::math::Vec3;
use rtc::render::{Geometry, Hit, Ray, Shear, World};
use serde_json::Value;

/// SplitMix64, so that a failure is known by seed and index.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let x = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        x ^ (x >> 31)
    }

    /// In [0, 1).
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.bits() % n as u64).unwrap()
    }

    /// In [−1, 1)³.
    pub(crate) fn cube(&mut self) -> Vec3 {
        Vec3::new(self.uniform(), self.uniform(), self.uniform()) * 2.0 - 1.0
    }
}

/// Rays of a statistical test: 10⁶ unless `RTC_RAYS` says otherwise.
fn rays() -> u64 {
    std::env::var("RTC_RAYS").ok().and_then(|count| count.parse().ok()).unwrap_or(1_000_000)
}

/// A closed mesh: vertices and triangles.
struct Mesh {
    vertices: Vec<Vec3>,
    triangles: Vec<[usize; 3]>,
}

impl Mesh {
    /// The icosahedron, each triangle split in four `level` times, on the unit sphere, rounded to f32.
    fn icosphere(level: u32) -> Self {
        let g = (1.0 + 5.0_f64.sqrt()) / 2.0;
        let corner = |k: usize| {
            let (a, b) = ([-1.0, 1.0][k & 1], [-g, g][k >> 1 & 1]);
            [Vec3::new(a, b, 0.0), Vec3::new(0.0, a, b), Vec3::new(b, 0.0, a)][k >> 2]
        };
        let vertices = (0..12).map(|k| corner(k).normalize()).collect::<Vec<_>>();
        let near = |i: usize, j: usize| vertices[i].distance(vertices[j]) < 1.2;
        let mut triangles = Vec::new();
        for (i, j, k) in (0..12).flat_map(|i| (i..12).flat_map(move |j| (j..12).map(move |k| (i, j, k)))) {
            if i < j && j < k && near(i, j) && near(j, k) && near(i, k) {
                triangles.push([i, j, k]);
            }
        }
        let mut mesh = Self { vertices, triangles };
        for _ in 0..level {
            mesh.split();
        }
        for vertex in &mut mesh.vertices {
            *vertex = vertex.normalize().as_vec3().as_dvec3();
        }
        mesh
    }

    fn split(&mut self) {
        let mut middles = std::collections::BTreeMap::new();
        let mut triangles = Vec::new();
        for [a, b, c] in std::mem::take(&mut self.triangles) {
            let mut middle = |i: usize, j: usize| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    self.vertices.push(((self.vertices[i] + self.vertices[j]) / 2.0).normalize());
                    self.vertices.len() - 1
                })
            };
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        self.triangles = triangles;
    }

    fn world(&self) -> World {
        let corners = |t: &[usize; 3]| t.map(|k| self.vertices[k].to_array());
        world(self.triangles.iter().map(|t| triangle(corners(t))))
    }
}

#[test]
fn closed_meshes_do_not_leak() {
    let mut report = Report::default();
    for case in cases("mesh_leak") {
        let input = &case["input"];
        let (scale, offset, push) = (number(&input["scale"]), vector(&input["offset"]), number(&input["displacement"]));
        let mut mesh = Mesh::icosphere(3);
        assert_eq!((mesh.vertices.len(), mesh.triangles.len()), (642, 1280));
        let mut random = Random::new(777);
        for vertex in &mut mesh.vertices {
            *vertex = *vertex * (scale * (1.0 + push * random.uniform())) + offset;
        }
        let world = mesh.world();
        let leaks = (0..rays()).filter(|k| world.nearest(&inside_ray(&mesh, &mut random, scale, offset, *k)).is_none());
        let leaks = leaks.count();
        report.line(id(&case), leaks == 0, &format!("{leaks} leaks in {} rays", rays()));
    }
    report.finish();
}

/// A ray from inside, by turns in a random direction, at an edge, and at a vertex.
fn inside_ray(mesh: &Mesh, random: &mut Random, scale: f64, offset: Vec3, k: u64) -> Ray {
    let origin = offset + random.cube() * (0.3 * scale);
    let [a, b, _] = mesh.triangles[random.below(mesh.triangles.len())].map(|k| mesh.vertices[k]);
    let direction = match k % 3 {
        0 => random.cube(),
        1 => a + (b - a) * random.uniform() - origin,
        _ => a - origin,
    };
    Ray { origin, direction }
}

#[test]
fn rays_through_shared_edges_hit() {
    let mut report = Report::default();
    for case in cases("mesh_any") {
        let corner = |k: &Value| vector(&case["input"]["vertices"][k.as_str().unwrap().parse::<usize>().unwrap()]);
        let corners = |t: &Value| [0, 1, 2].map(|k| corner(&t[k]).to_array());
        let triangles = case["input"]["triangles"].as_array().unwrap();
        let world = world(triangles.iter().map(|t| triangle(corners(t))));
        for (k, ray) in case["input"]["rays"].as_array().unwrap().iter().enumerate() {
            let hit = world.nearest(&Ray { origin: vector(&ray["o"]), direction: vector(&ray["d"]) });
            let first = case["expect"].get("prim").and_then(|prim| prim[k].as_str()?.parse::<usize>().ok());
            let error = hit.map_or(f64::INFINITY, |hit| relative_error(hit.t, &case["expect"]["t"][k]));
            let right_one = first.is_none_or(|first| hit.is_some_and(|hit| hit.surface == first));
            let passed = error <= number(&case["tol"]["t_u"]) && right_one;
            report.line(&format!("{}.{k}", id(&case)), passed, &format!("t {error:.2} u"));
        }
    }
    report.finish();
}

fn brute_force(world: &World, ray: &Ray) -> Option<Hit> {
    let shear = Shear::new(ray);
    let hits = world.surfaces.iter().enumerate().filter_map(|(surface, s)| {
        s.shape.intersect(ray, &shear, f64::INFINITY).map(|(t, part)| Hit { t, surface, part })
    });
    hits.reduce(|best, hit| if hit.t < best.t { hit } else { best })
}

#[test]
fn the_hierarchy_finds_what_brute_force_finds() {
    let mut random = Random::new(4242);
    let icosphere = Mesh::icosphere(2).world();
    let slivers = world((0..300).map(|_| {
        let (a, b) = (random.cube(), random.cube());
        triangle([a, b, (a + b) / 2.0 + random.cube() * 1e-9].map(|v| v.to_array()))
    }));
    let grid = world(
        (0..16)
            .flat_map(|x| (0..16).map(move |z| (f64::from(x) / 8.0 - 1.0, f64::from(z) / 8.0 - 1.0)))
            .map(|(x, z)| triangle([[x, 0.0, z], [x + 0.125, 0.0, z], [x, 0.0, z + 0.125]])),
    );
    let sizes = world((0..200).map(|k| {
        let size = if k % 2 == 0 { 1e-6 } else { 1e6 };
        sphere((random.cube() * if k % 2 == 0 { 1.0 } else { 3e6 }).to_array(), size * (0.1 + random.uniform()))
    }));
    for (name, world) in [("icosphere", icosphere), ("slivers", slivers), ("grid", grid), ("sizes", sizes)] {
        for k in 0..20_000 {
            let (origin, target) = (random.cube() * 2.0, random.cube());
            let mut direction = target - origin;
            if k % 3 == 0 {
                direction[k % 2] = 0.0;
            }
            let ray = Ray { origin, direction };
            assert_eq!(world.nearest(&ray), brute_force(&world, &ray), "{name}, ray {k}: {ray:?}");
        }
    }
}
