//! The Whitted integrator over enclosures: the formulas of the ordinary one (`rtc_render`,
//! `integrator/whitted`) in real numbers, for one camera ray.

use super::enclosure::{Enclosure, EnclosureVector};
use super::reason::Doubts;
use super::shape::{CertifiedRay, CertifiedSurface, Meeting, SurfaceHit, surfaces};
use rtc_ir::{Ambient, Gooch, Light, Material, Mode, Phong, PointLight, Scene};
use rtc_math::Vec3;

/// The most branches that are followed for a camera ray.
const MAX_BRANCHES: usize = 1 << 12;

/// A colour, one enclosure a channel.
pub(super) type Color = [Enclosure; 3];

/// A scene as enclosures see it.
pub(super) struct CertifiedScene<'scene> {
    pub(super) scene: &'scene Scene,
    surfaces: Vec<CertifiedSurface>,
    lights: Vec<&'scene PointLight>,
    /// The features that are in doubt everywhere.
    pub(super) doubts: Doubts,
}

/// The value of a camera ray.
pub(super) struct CertifiedValue {
    pub(super) color: Color,
    pub(super) doubts: Doubts,
}

/// What a ray meets first.
pub(super) enum FirstHit {
    Nothing,
    /// The index of a surface.
    Surface(usize, SurfaceHit),
    /// There may be a hit with t in this range.
    Unclear([f64; 2], Doubts),
}

/// A point seen from one side.
struct CertifiedPoint<'scene> {
    point: EnclosureVector,
    surface: usize,
    /// The geometric unit normal as declared.
    declared: EnclosureVector,
    /// The unit normal on the side of the viewer.
    normal: EnclosureVector,
    to_viewer: EnclosureVector,
    material: &'scene Phong,
}

/// A ray to follow.
struct Branch {
    ray: CertifiedRay,
    beta: Enclosure,
    bounces_left: u32,
}

/// Whether a light is seen.
enum Visibility {
    Lit,
    Shadowed,
    Unclear(Doubts),
}

impl<'scene> CertifiedScene<'scene> {
    pub(super) fn new(scene: &'scene Scene) -> Self {
        let lights = scene.lights.iter().filter_map(Light::point).collect();
        let surfaces = surfaces(scene);
        let doubts = doubts_everywhere(scene);
        Self {
            scene,
            surfaces,
            lights,
            doubts,
        }
    }

    /// The first hit of a ray: the hit certainly nearer than all that others may have.
    pub(super) fn first_hit(&self, ray: &CertifiedRay) -> FirstHit {
        let mut nearest: Option<(usize, SurfaceHit)> = None;
        let mut ranges = Vec::new();
        let mut doubts = Doubts::NONE;
        // Meet all surfaces.
        for (index, surface) in self.surfaces.iter().enumerate() {
            match surface.meet(index, ray) {
                Meeting::Misses => {}
                Meeting::Hits(hit) => {
                    ranges.push((index, [hit.t.low(), hit.t.high()], Doubts::ORDER));
                    if nearest.is_none_or(|(_, other)| hit.t.high() < other.t.high()) {
                        nearest = Some((index, hit));
                    }
                }
                Meeting::Unclear(range, why) => ranges.push((index, range, why)),
            }
        }
        // Others that may be nearer are in doubt.
        let bound = nearest.map_or(f64::INFINITY, |(_, hit)| hit.t.high());
        let own = nearest.map(|(index, _)| index);
        let mut range =
            nearest.map_or([f64::INFINITY, 0.0], |(_, hit)| [hit.t.low(), hit.t.high()]);
        for (index, [low, high], why) in ranges {
            if Some(index) != own && low <= bound {
                doubts = doubts | why;
                range = [range[0].min(low), range[1].max(high)];
            }
        }
        match nearest {
            _ if !doubts.is_empty() => FirstHit::Unclear(range, doubts),
            Some((index, hit)) => FirstHit::Surface(index, hit),
            None => FirstHit::Nothing,
        }
    }

    /// The value of a camera ray, in the mode of the scene.
    pub(super) fn radiance(&self, ray: CertifiedRay) -> CertifiedValue {
        let mut sum = [Enclosure::ZERO; 3];
        let mut doubts = Doubts::NONE;
        let bounces_left = match self.scene.settings.mode {
            Mode::Phong => self.scene.settings.max_depth,
            Mode::Depth | Mode::Normal | Mode::Gooch(_) | Mode::Path(_) => 0,
        };
        let mut pending = vec![Branch {
            ray,
            beta: Enclosure::ONE,
            bounces_left,
        }];
        let mut followed = 0;
        while let Some(branch) = pending.pop() {
            followed += 1;
            // Find the first hit; without one, any light may come.
            let (index, hit) = match self.first_hit(&branch.ray) {
                FirstHit::Nothing => continue,
                FirstHit::Surface(index, hit) if followed <= MAX_BRANCHES => (index, hit),
                FirstHit::Surface(..) => {
                    sum = any_light(sum);
                    doubts = doubts | Doubts::BRANCHES;
                    break;
                }
                FirstHit::Unclear(_, why) => {
                    sum = any_light(sum);
                    doubts = doubts | why;
                    continue;
                }
            };
            let point = match self.point(&branch.ray, index, hit) {
                Ok(point) => point,
                Err(why) => {
                    sum = any_light(sum);
                    doubts = doubts | why;
                    continue;
                }
            };
            // Add the local shading, and follow the reflected and refracted rays.
            let local = self.local(&point);
            doubts = doubts | local.doubts;
            sum = plus(sum, times(local.color, branch.beta));
            if let Err(why) = self.branch(&branch, &point, &mut pending) {
                sum = any_light(sum);
                doubts = doubts | why;
            }
        }
        CertifiedValue { color: sum, doubts }
    }

    /// The point of a hit, with its normal turned towards the viewer.
    fn point(
        &self,
        ray: &CertifiedRay,
        surface: usize,
        hit: SurfaceHit,
    ) -> Result<CertifiedPoint<'scene>, Doubts> {
        let index = self.surfaces[surface].material;
        let material = self.scene.materials.get(index).and_then(Material::phong);
        let material = material.ok_or(Doubts::unsupported("a standard material"))?;
        if material.has_texture() && !matches!(self.scene.settings.mode, Mode::Depth) {
            return Err(Doubts::unsupported("textures"));
        }
        let slope = ray.direction.dot(hit.normal);
        let normal = if slope.is_positive() {
            -hit.normal
        } else if slope.is_negative() {
            hit.normal
        } else {
            return Err(Doubts::SILHOUETTE);
        };
        Ok(CertifiedPoint {
            point: ray.at(hit.t),
            surface,
            declared: hit.normal,
            normal,
            to_viewer: -ray.direction,
            material,
        })
    }

    /// The local shading, in the mode of the scene.
    fn local(&self, point: &CertifiedPoint<'_>) -> CertifiedValue {
        let color = match &self.scene.settings.mode {
            Mode::Phong | Mode::Path(_) => return self.phong(point),
            Mode::Gooch(parameters) => self.gooch(point, parameters),
            Mode::Normal | Mode::Depth => {
                let half = Enclosure::point(0.5);
                point.normal.0.map(|x| (x + Enclosure::ONE) * half)
            }
        };
        let doubts = Doubts::NONE;
        CertifiedValue { color, doubts }
    }

    /// `Σ c_l·[ka·C + vis·(kd·C·max(0, N·L) + ks·max(0, R·V)ⁿ)]`, or the ambient term once.
    fn phong(&self, point: &CertifiedPoint<'_>) -> CertifiedValue {
        let material = point.material;
        let settings = &self.scene.settings;
        let ambient = times(colored(material.color), Enclosure::point(material.ka));
        let is_once = settings.ambient == Ambient::Once;
        let (mut sum, ambient) = if is_once {
            let once = product(colored(settings.ambient_light), ambient);
            (once, [Enclosure::ZERO; 3])
        } else {
            ([Enclosure::ZERO; 3], ambient)
        };
        let mut doubts = Doubts::NONE;
        for light in &self.lights {
            let is_soft = light.radius > 0.0 && settings.light_samples > 1;
            let direct = if is_soft {
                let doubts = Doubts::unsupported("soft light");
                self.unlit_or(self.shading(point, light).color, doubts)
            } else {
                self.direct(point, light)
            };
            let is_black = light.color == [0.0; 3];
            if !is_black {
                doubts = doubts | direct.doubts;
            }
            let term = plus(ambient, direct.color);
            sum = plus(sum, product(colored(light.color), term));
        }
        CertifiedValue { color: sum, doubts }
    }

    /// A term of a soft light: anything from nothing to all that the material may reflect.
    fn unlit_or(&self, term: Color, doubts: Doubts) -> CertifiedValue {
        let is_black = term.iter().all(|channel| channel.is_zero());
        if is_black {
            return CertifiedValue {
                color: term,
                doubts: Doubts::NONE,
            };
        }
        CertifiedValue {
            color: [Enclosure::NONNEGATIVE; 3],
            doubts,
        }
    }

    /// `kd·C·max(0, N·L) + ks·max(0, R·V)ⁿ`, with shadows as the scene has them.
    fn direct(&self, point: &CertifiedPoint<'_>, light: &PointLight) -> CertifiedValue {
        let CertifiedShading {
            color,
            n_dot_l,
            to_light,
            distance,
        } = self.shading(point, light);
        let dark = CertifiedValue {
            color: [Enclosure::ZERO; 3],
            doubts: Doubts::NONE,
        };
        let is_black = color.iter().all(|channel| channel.is_zero());
        if is_black || (self.scene.settings.shadows && n_dot_l.high() <= 0.0) {
            return dark;
        }
        let lit = CertifiedValue {
            color,
            doubts: Doubts::NONE,
        };
        if !self.scene.settings.shadows {
            return lit;
        }
        // Where it does not face the light for certain, or is not seen for certain, take both.
        let both = |doubts| CertifiedValue {
            color: color.map(|channel| channel.hull(Enclosure::ZERO)),
            doubts,
        };
        if !n_dot_l.is_positive() {
            return both(Doubts::SHADOW);
        }
        match self.visibility(point, to_light, distance) {
            Visibility::Lit => lit,
            Visibility::Shadowed => dark,
            Visibility::Unclear(why) => both(why),
        }
    }

    /// The terms of a light without its shadows.
    fn shading(&self, point: &CertifiedPoint<'_>, light: &PointLight) -> CertifiedShading {
        let offset = EnclosureVector::point(Vec3::from_array(light.position)) - point.point;
        let (to_light, distance) = (offset.normalized(), offset.length());
        let n_dot_l = point.normal.dot(to_light);
        let two = Enclosure::point(2.0);
        let r_dot_v = (point.normal * (two * n_dot_l) - to_light).dot(point.to_viewer);
        let Phong {
            color, kd, ks, n, ..
        } = *point.material;
        let diffuse = Enclosure::point(kd) * n_dot_l.clamp(0.0, 1.0);
        let highlight = Enclosure::point(ks) * r_dot_v.highlight(n);
        let color = colored(color).map(|channel| channel * diffuse + highlight);
        CertifiedShading {
            color,
            n_dot_l,
            to_light,
            distance,
        }
    }

    /// Whether a light at a distance is seen.
    fn visibility(
        &self,
        point: &CertifiedPoint<'_>,
        to_light: EnclosureVector,
        distance: Enclosure,
    ) -> Visibility {
        let ray = point.ray(to_light);
        let mut doubts = Doubts::NONE;
        for (index, surface) in self.surfaces.iter().enumerate() {
            if surface.casts_no_shadow {
                continue;
            }
            match surface.meet(index, &ray) {
                Meeting::Misses => {}
                Meeting::Hits(hit) if hit.t.is_below(distance) => return Visibility::Shadowed,
                Meeting::Hits(hit) if distance.is_below(hit.t) => {}
                Meeting::Hits(_) => doubts = doubts | Doubts::SHADOW,
                Meeting::Unclear([low, _], why) => {
                    if low <= distance.high() {
                        let border = why.is_rounding();
                        doubts = doubts | if border { Doubts::SHADOW } else { why };
                    }
                }
            }
        }
        match doubts.is_empty() {
            true => Visibility::Lit,
            false => Visibility::Unclear(doubts),
        }
    }

    /// Gooch's model in the course's form: `Σ cool·(1 − N·L)/2 + warm·(1 + N·L)/2 +
    /// ks·max(0, R·V)ⁿ·c_l`.
    fn gooch(&self, point: &CertifiedPoint<'_>, parameters: &Gooch) -> Color {
        let Phong { color, kd, ks, .. } = *point.material;
        let Gooch { b, y, alpha, beta } = *parameters;
        let number = Enclosure::point;
        let mut sum = [Enclosure::ZERO; 3];
        for light in &self.lights {
            let CertifiedShading {
                n_dot_l, to_light, ..
            } = self.shading(point, light);
            let c = colored(light.color);
            let tone = times(product(c, colored(color)), number(kd));
            let cool = plus([0.0, 0.0, b].map(number), times(tone, number(alpha)));
            let warm = plus([y, y, 0.0].map(number), times(tone, number(beta)));
            let half = number(0.5);
            sum = plus(sum, times(cool, half * (Enclosure::ONE - n_dot_l)));
            sum = plus(sum, times(warm, half * (Enclosure::ONE + n_dot_l)));
            let reflected = point.normal * (number(2.0) * n_dot_l) - to_light;
            let highlight = reflected.dot(point.to_viewer).highlight(point.material.n);
            sum = plus(sum, times(c, number(ks) * highlight));
        }
        sum
    }

    /// Adds the reflected and the refracted ray to the pending ones.
    fn branch(
        &self,
        branch: &Branch,
        point: &CertifiedPoint<'_>,
        pending: &mut Vec<Branch>,
    ) -> Result<(), Doubts> {
        if branch.bounces_left == 0 {
            return Ok(());
        }
        let direction = -point.to_viewer;
        let material = point.material;
        let refracted = transmit(direction, point)?;
        let kt = Enclosure::point(material.kt);
        let reflected_part = match refracted {
            Some(_) => reflected_part(direction, point),
            None => Enclosure::ONE,
        };
        // Push the mirror direction, d − 2·(d·n)·n.
        let kr = Enclosure::point(material.mirror_weight());
        let mut push = |direction: EnclosureVector, weight: Enclosure| {
            let beta = branch.beta * weight;
            if !beta.is_zero() {
                pending.push(Branch {
                    ray: point.ray(direction),
                    beta,
                    bounces_left: branch.bounces_left - 1,
                });
            }
        };
        let weight = kr + kt * reflected_part;
        if material.glossy_samples > 1 && !weight.is_zero() {
            return Err(Doubts::unsupported("glossy reflection"));
        }
        let two = Enclosure::point(2.0);
        let mirror = direction - point.normal * (two * direction.dot(point.normal));
        push(mirror, weight);
        if let Some(refracted) = refracted {
            push(refracted, kt * (Enclosure::ONE - reflected_part));
        }
        Ok(())
    }
}

/// The terms of a light at a point.
struct CertifiedShading {
    color: Color,
    n_dot_l: Enclosure,
    to_light: EnclosureVector,
    distance: Enclosure,
}

impl CertifiedPoint<'_> {
    /// The ray from here.
    fn ray(&self, direction: EnclosureVector) -> CertifiedRay {
        let from = Some((self.surface, self.declared));
        CertifiedRay::new(self.point, direction, from)
    }
}

/// Snell's law: the unit direction beyond the surface; `None` for a surface that transmits nothing,
/// or for total reflection.
fn transmit(
    direction: EnclosureVector,
    point: &CertifiedPoint<'_>,
) -> Result<Option<EnclosureVector>, Doubts> {
    let Phong { kt, ior, .. } = *point.material;
    if kt == 0.0 {
        return Ok(None);
    }
    let ior = Enclosure::point(ior);
    let enters = point.normal == point.declared;
    let (from, to) = if enters {
        (Enclosure::ONE, ior)
    } else {
        (ior, Enclosure::ONE)
    };
    let sine = from * direction.cross(point.normal).length();
    let square = (to - sine) * (to + sine);
    if square.is_negative() {
        return Ok(None);
    }
    if !square.is_positive() {
        return Err(Doubts::CRITICAL_ANGLE);
    }
    let along = direction - point.normal * direction.dot(point.normal);
    // The length of the sum is the index beyond.
    let refracted = along * from - point.normal * square.sqrt();
    Ok(Some(EnclosureVector(refracted.0.map(|x| x / to))))
}

/// The part of kt that is reflected: Schlick's approximation of Fresnel's equations, by the angle
/// on the side of the ray.
fn reflected_part(direction: EnclosureVector, point: &CertifiedPoint<'_>) -> Enclosure {
    let Phong { ior, fresnel, .. } = *point.material;
    if !fresnel || ior == 1.0 {
        return Enclosure::ZERO;
    }
    let (ior, one) = (Enclosure::point(ior), Enclosure::ONE);
    let along_normal = ((ior - one) / (ior + one)).square();
    // The normal faces the ray.
    let cosine = -direction.dot(point.normal);
    let x = (one - cosine).clamp(0.0, 1.0);
    along_normal + (one - along_normal) * x.square().square() * x
}

/// What is unsupported in the whole picture.
fn doubts_everywhere(scene: &Scene) -> Doubts {
    let settings = &scene.settings;
    let is_depth = matches!(settings.mode, Mode::Depth);
    let has_pattern = settings.pattern != rtc_ir::Pattern::Grid && !is_depth;
    let cases = [
        (has_pattern, "random sub-samples"),
        (settings.toon, "toon shading"),
        (settings.stereo != 0.0, "stereo"),
        (settings.background.is_some(), "a background colour"),
        (
            scene.lights.iter().any(|light| light.point().is_none()),
            "lights with falloff",
        ),
        (matches!(settings.mode, Mode::Path(_)), "path tracing"),
        (scene.environment.is_some(), "an environment"),
    ];
    let found = cases.into_iter().filter(|(is_there, _)| *is_there);
    found.fold(Doubts::NONE, |doubts, (_, name)| {
        doubts | Doubts::unsupported(name)
    })
}

fn colored(color: [f64; 3]) -> Color {
    color.map(Enclosure::point)
}

fn times(color: Color, factor: Enclosure) -> Color {
    color.map(|channel| channel * factor)
}

fn product([a, b, c]: Color, [x, y, z]: Color) -> Color {
    [a * x, b * y, c * z]
}

/// The sum of two colours.
pub(super) fn plus([a, b, c]: Color, [x, y, z]: Color) -> Color {
    [a + x, b + y, c + z]
}

/// The sum of a colour and any light.
fn any_light(color: Color) -> Color {
    plus(color, [Enclosure::NONNEGATIVE; 3])
}
