//! The surfaces of a scene, and the first of them that a ray meets.

use super::flat::{CertifiedTriangle, meet_disc, meet_plane, meet_triangle, raw_normal};
use super::hierarchy::BallHierarchy;
use super::patch::CertifiedPatch;
use super::placed::PlacedMesh;
use super::solid::{CertifiedSolid, CertifiedSphere};
use super::torus::CertifiedTorus;
use super::{Ball, CertifiedRay, CertifiedSurface, Formula, Meeting, Sphere, SurfaceHit, Visit};
use crate::certify::number::CertifiedNumber;
use crate::certify::reason::Doubts;
use crate::certify::vector::CertifiedVector;
use rtc_ir::{Instance, Material, Quad, Scene, Shape, Surface};
use rtc_math::{Vec3, Vector, to_u32};

/// More triangles of placed meshes are not evaluated.
const MAX_TRIANGLES: usize = 1 << 20;

/// The surfaces of a scene.
pub(in crate::certify) struct CertifiedSurfaces<'scene, N> {
    surfaces: Vec<CertifiedSurface<'scene, N>>,
    placed: Vec<PlacedMesh<N>>,
    /// The infinite ones.
    infinite: Vec<usize>,
    hierarchy: BallHierarchy,
}

/// What a ray meets first.
pub(in crate::certify) enum FirstHit<N> {
    Nothing,
    /// The index of a surface.
    Surface(usize, SurfaceHit<N>),
    /// There may be a hit with t in this range.
    Unclear([f64; 2], Doubts),
}

/// Whether a light is seen.
pub(in crate::certify) enum Visibility {
    Lit,
    Shadowed,
    Unclear(Doubts),
}

impl<'scene, N: CertifiedNumber> CertifiedSurfaces<'scene, N> {
    pub(in crate::certify) fn new(scene: &'scene Scene) -> Self {
        let mut list = SurfaceList {
            scene,
            surfaces: Vec::new(),
            placed: Vec::new(),
            triangles: 0,
        };
        let meshes = scene.mesh_boxes();
        for surface in &scene.surfaces {
            let mut points = Vec::new();
            let mut add = |corner| points.push(corner);
            surface.shape.corners_around(&meshes, &mut add);
            list.add(surface, &points);
        }
        let SurfaceList {
            surfaces, placed, ..
        } = list;
        let balls = surfaces.iter().enumerate();
        let balls = balls.filter_map(|(k, surface)| Some((to_u32(k), surface.ball?)));
        let infinite = surfaces.iter().enumerate();
        let infinite = infinite.filter(|(_, surface)| surface.ball.is_none());
        Self {
            infinite: infinite.map(|(index, _)| index).collect(),
            hierarchy: BallHierarchy::new(balls.collect()),
            surfaces,
            placed,
        }
    }

    /// One of them.
    pub(in crate::certify) fn surface(&self, index: usize) -> &CertifiedSurface<'scene, N> {
        &self.surfaces[index]
    }

    /// The first hit of a ray: the hit certainly nearer than all that others may have.
    pub(in crate::certify) fn first_hit(&self, ray: &CertifiedRay<N>) -> FirstHit<N> {
        let mut contest = HitContest {
            nearest: None,
            second: None,
            unclear: None,
        };
        let mut visit = |index: usize| {
            self.meet(index, ray, &mut |meeting| match meeting {
                Meeting::Hits(hit) => contest.add(index, hit),
                Meeting::Unclear(range, why) => contest.doubt(range, why),
            });
            contest.bound()
        };
        for index in &self.infinite {
            visit(*index);
        }
        self.hierarchy.visit(ray, f64::INFINITY, &mut visit);
        contest.winner()
    }

    /// Whether a light at a distance is seen.
    pub(in crate::certify) fn visibility(&self, ray: &CertifiedRay<N>, distance: N) -> Visibility {
        let (mut doubts, mut is_hidden) = (Doubts::NONE, false);
        let far = distance.high();
        let mut visit = |index: usize| {
            if self.surfaces[index].casts_no_shadow {
                return far;
            }
            self.meet(index, ray, &mut |meeting| match meeting {
                Meeting::Hits(hit) if hit.t.is_below(distance) => is_hidden = true,
                Meeting::Hits(hit) if distance.is_below(hit.t) => {}
                Meeting::Hits(_) => doubts = doubts | Doubts::SHADOW,
                Meeting::Unclear([low, _], why) if low <= far => {
                    let border = why.is_rounding();
                    doubts = doubts | if border { Doubts::SHADOW } else { why };
                }
                Meeting::Unclear(..) => {}
            });
            // Nothing more is asked of what is hidden.
            if is_hidden { f64::NEG_INFINITY } else { far }
        };
        let seen = self.infinite.iter().all(|index| visit(*index) > 0.0);
        if seen {
            self.hierarchy.visit(ray, far, &mut visit);
        }
        match (is_hidden, doubts.is_empty()) {
            (true, _) => Visibility::Shadowed,
            (false, true) => Visibility::Lit,
            (false, false) => Visibility::Unclear(doubts),
        }
    }

    /// Visits where a ray meets a surface in front of its origin.
    fn meet(&self, index: usize, ray: &CertifiedRay<N>, visit: Visit<'_, N>) {
        let surface = &self.surfaces[index];
        // Skip what is certainly far off.
        let all = [0.0, f64::INFINITY];
        let range = surface.ball.map_or(Some(all), |ball| ray.range_in(&ball));
        let Some(range) = range else { return };
        // Apply the formula.
        let start = ray.start.as_ref();
        let start = start.filter(|start| start.surface == index);
        let flat = match &surface.formula {
            Formula::Sphere(sphere) => {
                return match start {
                    Some(start) => sphere.leave(ray, start, visit),
                    None => sphere.meet(ray, range, visit),
                };
            }
            Formula::Patch(patch) => return patch.meet(ray, range, start.is_some(), visit),
            Formula::Solid(solid) => return solid.meet(ray, range, start, visit),
            Formula::Torus(torus) => return torus.meet(ray, start, visit),
            Formula::Unsupported(name) => {
                return visit(Meeting::Unclear(range, Doubts::unsupported(name)));
            }
            // A ray from a plane does not meet it again.
            Formula::Plane { .. } | Formula::Triangle(_) | Formula::Disc { .. }
                if start.is_some() =>
            {
                None
            }
            Formula::Plane { center, normal } => {
                let [center, normal] = [*center, *normal].map(Vector::point);
                meet_plane(center, normal, ray, range)
            }
            Formula::Triangle(triangle) => {
                meet_triangle(triangle.vertices(&self.placed), ray, range)
            }
            Formula::Disc {
                center,
                normal,
                radius,
            } => {
                let plane = [*center, *normal].map(Vector::point);
                meet_disc(plane, N::point(*radius), ray, range)
            }
        };
        if let Some(meeting) = flat {
            visit(meeting);
        }
    }

    /// The geometric unit normal at a hit: outward for a solid, else as declared.
    pub(in crate::certify) fn normal(
        &self,
        index: usize,
        ray: &CertifiedRay<N>,
        hit: &SurfaceHit<N>,
    ) -> Vector<N> {
        match &self.surfaces[index].formula {
            Formula::Sphere(sphere) => sphere.normal(ray, hit.t),
            Formula::Plane { normal, .. } | Formula::Disc { normal, .. } => {
                Vector::point(*normal).normalized()
            }
            Formula::Triangle(triangle) => triangle.raw_normal(&self.placed).normalized(),
            Formula::Patch(patch) => {
                let place = hit.patch.unwrap_or([N::ALL; 2]);
                patch.raw_normal(place).normalized()
            }
            Formula::Solid(solid) => solid.normal(ray, hit),
            Formula::Torus(torus) => torus.normal(ray, hit.t),
            Formula::Unsupported(_) => Vector::from([N::ALL; 3]),
        }
    }

    /// The shading normal of a point, if it differs from the geometric one.
    pub(in crate::certify) fn shading_normal(
        &self,
        index: usize,
        point: Vector<N>,
    ) -> Option<Vector<N>> {
        match &self.surfaces[index].formula {
            Formula::Triangle(triangle) => triangle.shading_normal(&self.placed, point),
            Formula::Sphere(_)
            | Formula::Plane { .. }
            | Formula::Patch(_)
            | Formula::Disc { .. }
            | Formula::Solid(_)
            | Formula::Torus(_)
            | Formula::Unsupported(_) => None,
        }
    }

    /// The texture coordinates of a point with its geometric normal, if it has any.
    pub(in crate::certify) fn uv(
        &self,
        index: usize,
        hit: &SurfaceHit<N>,
        [point, normal]: [Vector<N>; 2],
    ) -> Result<Option<[N; 2]>, Doubts> {
        match &self.surfaces[index].formula {
            Formula::Sphere(sphere) => sphere.uv(normal).map(Some),
            Formula::Triangle(triangle) => Ok(triangle.uv(&self.placed, point)),
            Formula::Patch(_) => Ok(hit.patch),
            Formula::Solid(solid) => solid.uv(point),
            Formula::Plane { .. }
            | Formula::Disc { .. }
            | Formula::Torus(_)
            | Formula::Unsupported(_) => Ok(None),
        }
    }
}

/// The hits of a ray so far.
struct HitContest<N> {
    nearest: Option<(usize, SurfaceHit<N>)>,
    /// The least t of the other hits.
    second: Option<N>,
    /// The range of t of what is unclear, and the reason of that with the least t.
    unclear: Option<([f64; 2], Doubts)>,
}

impl<N: CertifiedNumber> HitContest<N> {
    /// Adds a hit.
    fn add(&mut self, index: usize, hit: SurfaceHit<N>) {
        let Some((_, nearest)) = self.nearest else {
            self.nearest = Some((index, hit));
            return;
        };
        let is_nearer = hit.t.is_below(nearest.t)
            || (!nearest.t.is_below(hit.t) && hit.t.high() < nearest.t.high());
        let other = if is_nearer { nearest.t } else { hit.t };
        if is_nearer {
            self.nearest = Some((index, hit));
        }
        self.second = Some(match self.second {
            Some(second) if second.is_below(other) => second,
            Some(second) if !other.is_below(second) => second.hull(other),
            _ => other,
        });
    }

    /// Adds what may be a hit.
    fn doubt(&mut self, [low, high]: [f64; 2], why: Doubts) {
        let (range, why) = match self.unclear {
            None => ([low, high], why),
            Some(([least, most], _)) if low < least => ([low, most.max(high)], why),
            Some(([least, most], first)) => ([least, most.max(high)], first),
        };
        self.unclear = Some((range, why));
    }

    /// No hit with a larger t matters.
    fn bound(&self) -> f64 {
        self.nearest.map_or(f64::INFINITY, |(_, hit)| hit.t.high())
    }

    /// The first hit, unless others may be nearer.
    fn winner(self) -> FirstHit<N> {
        let Some((index, hit)) = self.nearest else {
            return match self.unclear {
                Some((range, why)) => FirstHit::Unclear(range, why),
                None => FirstHit::Nothing,
            };
        };
        let [low, high] = [hit.t.low(), hit.t.high()];
        let rival = self.unclear.filter(|([least, _], _)| *least <= high);
        let tied = self.second.filter(|second| !hit.t.is_below(*second));
        match (rival, tied) {
            (Some(([least, _], why)), _) => FirstHit::Unclear([least.min(low), high], why),
            (None, Some(second)) => FirstHit::Unclear([second.low().min(low), high], Doubts::ORDER),
            (None, None) => FirstHit::Surface(index, hit),
        }
    }
}

/// The surfaces found so far.
struct SurfaceList<'scene, N> {
    scene: &'scene Scene,
    surfaces: Vec<CertifiedSurface<'scene, N>>,
    placed: Vec<PlacedMesh<N>>,
    /// Those of placed meshes.
    triangles: usize,
}

impl<'scene, N: CertifiedNumber> SurfaceList<'scene, N> {
    /// Adds a surface inside the hull of points.
    fn add(&mut self, surface: &'scene Surface, points: &[Vec3]) {
        let vector = Vec3::from_array;
        let around = Ball::around(points);
        let name = surface.shape.kind().name();
        let (formula, ball) = match &surface.shape {
            Shape::Sphere(sphere) => {
                let ball = Ball {
                    center: vector(sphere.center),
                    radius: sphere.radius,
                };
                (sphere_formula(sphere), Some(ball))
            }
            Shape::Plane(plane) => {
                let [center, normal] = [plane.center, plane.normal].map(vector);
                (Formula::Plane { center, normal }, None)
            }
            Shape::Triangle(triangle) => {
                let vertices = triangle.vertices.map(vector);
                let own = CertifiedTriangle::Own(vertices, triangle.uvs);
                (self.proper(own), Ball::around(&vertices))
            }
            Shape::Quad(quad) => return self.add_quad(surface, quad, around),
            Shape::Disc(disc) => {
                let [center, normal] = [disc.center, disc.normal].map(vector);
                let radius = disc.radius;
                let formula = Formula::Disc {
                    center,
                    normal,
                    radius,
                };
                (formula, Some(Ball { center, radius }))
            }
            Shape::Cylinder(shape) => (solid(CertifiedSolid::cylinder(shape)), around),
            Shape::Cone(shape) => (solid(CertifiedSolid::cone(shape)), around),
            Shape::Paraboloid(shape) => (solid(CertifiedSolid::paraboloid(shape)), around),
            Shape::InfiniteCylinder(shape) => (solid(CertifiedSolid::infinite(shape)), None),
            Shape::Ellipsoid(shape) => {
                let formula = CertifiedSolid::ellipsoid(shape).map(solid);
                (formula.unwrap_or(Formula::Unsupported(name)), around)
            }
            Shape::Torus(shape) => {
                let torus = Box::new(CertifiedTorus::new(shape));
                (Formula::Torus(torus), around)
            }
            Shape::Instance(instance) => return self.add_mesh(surface, instance, around),
            Shape::Csg(_) => (Formula::Unsupported(name), around),
        };
        self.push(surface, formula, ball);
    }

    fn push(&mut self, surface: &Surface, formula: Formula<'scene, N>, ball: Option<Ball>) {
        let material = self.scene.materials.get(surface.material.0 as usize);
        self.surfaces.push(CertifiedSurface {
            formula,
            ball,
            material: material.and_then(Material::phong),
            casts_no_shadow: surface.casts_no_shadow,
        });
    }

    /// A triangle whose normal certainly has a length.
    fn proper(&self, triangle: CertifiedTriangle<'scene>) -> Formula<'scene, N> {
        let normal = triangle.raw_normal(&self.placed);
        match normal.length().is_positive() {
            true => Formula::Triangle(triangle),
            false => Formula::Unsupported("triangle"),
        }
    }

    /// Adds a patch, or the halves of a quadrilateral that the renderer sees as flat.
    fn add_quad(&mut self, surface: &'scene Surface, quad: &Quad, around: Option<Ball>) {
        let vertices = quad.vertices.map(Vec3::from_array);
        if !rtc_math::is_flat(vertices) {
            return self.push(surface, Formula::Patch(CertifiedPatch(vertices)), around);
        }
        let Some(split) = split::<N>(vertices) else {
            return self.push(surface, Formula::Unsupported("quad"), around);
        };
        const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        for half in split {
            let corners = half.map(|k| vertices[k]);
            let own = CertifiedTriangle::Own(corners, Some(half.map(|k| CORNERS[k])));
            let formula = self.proper(own);
            self.push(surface, formula, Ball::around(&corners));
        }
    }

    /// Adds the triangles of a placed mesh.
    fn add_mesh(&mut self, surface: &'scene Surface, instance: &Instance, around: Option<Ball>) {
        let scene = self.scene;
        let mesh = scene.meshes.get(instance.mesh.0 as usize);
        let placed = PlacedMesh::new(instance);
        let (Some(mesh), Some(placed)) = (mesh, placed) else {
            return self.push(surface, Formula::Unsupported("instance"), around);
        };
        self.triangles += mesh.triangles.len();
        if self.triangles > MAX_TRIANGLES {
            return self.push(surface, Formula::Unsupported("instance"), around);
        }
        let index = self.placed.len();
        self.placed.push(placed);
        for corners in mesh.triangles.iter() {
            let triangle = CertifiedTriangle::Placed(mesh, *corners, index);
            let vertices = triangle.vertices(&self.placed).map(|v| v.middle().0);
            let formula = self.proper(triangle);
            self.push(surface, formula, Ball::around(&vertices));
        }
    }
}

fn sphere_formula<N>(sphere: &Sphere) -> Formula<'_, N> {
    Formula::Sphere(CertifiedSphere {
        center: Vec3::from_array(sphere.center),
        radius: sphere.radius,
        texture_from_world: sphere.texture_from_world.as_ref(),
    })
}

fn solid<'scene, N>(solid: CertifiedSolid<N>) -> Formula<'scene, N> {
    Formula::Solid(Box::new(solid))
}

/// The corners of the halves of a flat quadrilateral, split along the inner diagonal; `None` if it
/// is not clear which one that is.
fn split<N: CertifiedNumber>(vertices: [Vec3; 4]) -> Option<[[usize; 3]; 2]> {
    let normal = |half: [usize; 3]| raw_normal(half.map(|k| Vector::<N>::point(vertices[k])));
    let along = |[a, b]: [[usize; 3]; 2]| normal(a).dot(normal(b));
    let splits = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
    let first = along(splits[0]);
    if first.is_positive() {
        Some(splits[0])
    } else if first.is_negative() && along(splits[1]).is_positive() {
        Some(splits[1])
    } else {
        None
    }
}
