//! The Whitted integrator over sets of numbers: the formulas of the ordinary one (`rtc_render`,
//! `integrator/whitted`) in real numbers, for one camera ray.

use super::branch::CertifiedBranch;
use super::number::CertifiedNumber;
use super::reason::Doubts;
use super::sampling::{CertifiedKey, spiral_turns};
use super::shape::{CertifiedRay, CertifiedSurfaces, FirstHit, RayStart, SurfaceHit, Visibility};
use super::texture::look_up;
use super::vector::CertifiedVector;
use rtc_ir::{Ambient, Gooch, Light, Mode, Phong, PointLight, Scene};
use rtc_math::{Vec3, Vector};

/// The most branches that are followed for a camera ray.
const MAX_BRANCHES: usize = 1 << 14;

/// A colour, one number a channel.
pub(super) type Color<N> = [N; 3];

/// A scene as certified rays see it.
pub(super) struct CertifiedScene<'scene, N> {
    pub(super) scene: &'scene Scene,
    pub(super) surfaces: CertifiedSurfaces<'scene, N>,
    lights: Vec<&'scene PointLight>,
}

/// A colour, and what is in doubt about it.
pub(super) struct CertifiedValue<N> {
    pub(super) color: Color<N>,
    pub(super) doubts: Doubts,
}

/// A point seen from one side.
pub(super) struct CertifiedPoint<'scene, N> {
    point: Vector<N>,
    surface: usize,
    part: u8,
    /// The geometric unit normal as declared, and on the side of the viewer.
    pub(super) declared: Vector<N>,
    pub(super) geometric: Vector<N>,
    /// Whether the viewer is on the side of the declared normal.
    pub(super) is_front: bool,
    /// The unit shading normal on the side of the viewer.
    pub(super) normal: Vector<N>,
    /// Whether it differs from the geometric one.
    pub(super) has_shading_normal: bool,
    pub(super) to_viewer: Vector<N>,
    pub(super) material: &'scene Phong,
    /// C and ks at this point.
    color: Color<N>,
    pub(super) ks: N,
    pub(super) key: CertifiedKey,
}

impl<'scene, N: CertifiedNumber> CertifiedScene<'scene, N> {
    pub(super) fn new(scene: &'scene Scene) -> Self {
        Self {
            scene,
            surfaces: CertifiedSurfaces::new(scene),
            lights: scene.lights.iter().filter_map(Light::point).collect(),
        }
    }

    /// The value of a camera ray, in the mode of the scene.
    pub(super) fn radiance(&self, ray: CertifiedRay<N>, key: CertifiedKey) -> CertifiedValue<N> {
        let mut sum = [N::ZERO; 3];
        let mut doubts = Doubts::NONE;
        let bounces_left = match self.scene.settings.mode {
            Mode::Phong => self.scene.settings.max_depth,
            Mode::Depth | Mode::Normal | Mode::Gooch(_) | Mode::Path(_) => 0,
        };
        let mut pending = Vec::new();
        let mut next = Some(CertifiedBranch {
            ray,
            beta: N::ONE,
            bounces_left,
            key,
        });
        let mut followed = 0;
        while let Some(branch) = next.take().or_else(|| pending.pop()) {
            followed += 1;
            if followed > MAX_BRANCHES {
                sum = any_light(sum);
                doubts = doubts | Doubts::BRANCHES;
                break;
            }
            match self.followed(&branch, &mut pending) {
                Ok(None) => {}
                Ok(Some(local)) => {
                    doubts = doubts | local.doubts;
                    sum = plus(sum, local.color);
                }
                // Without a certain hit, any light may come.
                Err(why) => {
                    sum = any_light(sum);
                    doubts = doubts | why;
                }
            }
        }
        CertifiedValue { color: sum, doubts }
    }

    /// The local shading where a branch ends, weighted; adds the branches from there.
    fn followed(
        &self,
        branch: &CertifiedBranch<N>,
        pending: &mut Vec<CertifiedBranch<N>>,
    ) -> Result<Option<CertifiedValue<N>>, Doubts> {
        let (index, hit) = match self.surfaces.first_hit(&branch.ray) {
            FirstHit::Nothing => return Ok(None),
            FirstHit::Surface(index, hit) => (index, hit),
            FirstHit::Unclear(_, why) => return Err(why),
        };
        let point = self.point(branch, index, &hit)?;
        let local = self.local(&point);
        self.branch(branch, &point, pending)?;
        Ok(Some(CertifiedValue {
            color: times(local.color, branch.beta),
            doubts: local.doubts,
        }))
    }

    /// The point of a hit, with its normals turned towards the viewer.
    fn point(
        &self,
        branch: &CertifiedBranch<N>,
        surface: usize,
        hit: &SurfaceHit<N>,
    ) -> Result<CertifiedPoint<'scene, N>, Doubts> {
        let ray = &branch.ray;
        let material = self.surfaces.surface(surface).material;
        let material = material.ok_or(Doubts::unsupported("a standard material"))?;
        // Turn the normals.
        let declared = self.surfaces.normal(surface, ray, hit);
        let slope = ray.direction.dot(declared);
        if !slope.has_sign() {
            return Err(Doubts::SILHOUETTE);
        }
        let is_front = slope.is_negative();
        let turned = |normal: Vector<N>| if is_front { normal } else { -normal };
        let point = ray.at(hit.t);
        let shading = self.surfaces.shading_normal(surface, point);
        // Look the textures up.
        let maps = self.maps(material, (surface, hit), [point, declared])?;
        Ok(CertifiedPoint {
            point,
            surface,
            part: hit.part,
            declared,
            geometric: turned(declared),
            is_front,
            normal: turned(shading.unwrap_or(declared)),
            has_shading_normal: shading.is_some(),
            to_viewer: -ray.direction,
            material,
            color: maps.0,
            ks: maps.1,
            key: branch.key,
        })
    }

    /// C and ks at a point with its normal, by the maps of its material.
    fn maps(
        &self,
        material: &Phong,
        (surface, hit): (usize, &SurfaceHit<N>),
        place: [Vector<N>; 2],
    ) -> Result<(Color<N>, N), Doubts> {
        let own = (colored(material.color), N::point(material.ks));
        if !material.has_texture() {
            return Ok(own);
        }
        if material.normal_map.is_some() || material.bump.is_some() {
            return Err(Doubts::unsupported("normal maps"));
        }
        // A normal has no colour.
        if matches!(self.scene.settings.mode, Mode::Normal) {
            return Ok(own);
        }
        let Some(uv) = self.surfaces.uv(surface, hit, place)? else {
            return Ok(own);
        };
        let value = |map| look_up(self.scene, map, uv);
        let color = material.color_map.map(value).transpose()?;
        let specular = material.specular_map.map(value).transpose()?;
        let scale = specular.map_or(N::ONE, |[red, ..]| red.clamp(0.0, f64::MAX));
        Ok((color.unwrap_or(own.0), own.1 * scale))
    }

    /// The local shading, in the mode of the scene.
    fn local(&self, point: &CertifiedPoint<'_, N>) -> CertifiedValue<N> {
        let color = match &self.scene.settings.mode {
            Mode::Phong | Mode::Path(_) => return self.phong(point),
            Mode::Gooch(parameters) => self.gooch(point, parameters),
            Mode::Normal | Mode::Depth => {
                let half = N::point(0.5);
                point.normal.map(|x| (x + N::ONE) * half).into_array()
            }
        };
        CertifiedValue::certain(color)
    }

    /// `Σ c_l·[ka·C + vis·(kd·C·max(0, N·L) + ks·max(0, R·V)ⁿ)]`, or the ambient term once.
    fn phong(&self, point: &CertifiedPoint<'_, N>) -> CertifiedValue<N> {
        let settings = &self.scene.settings;
        let ambient = times(point.color, N::point(point.material.ka));
        let is_once = settings.ambient == Ambient::Once;
        let (mut sum, ambient) = if is_once {
            let once = product(colored(settings.ambient_light), ambient);
            (once, [N::ZERO; 3])
        } else {
            ([N::ZERO; 3], ambient)
        };
        let mut doubts = Doubts::NONE;
        for (index, light) in self.lights.iter().enumerate() {
            let is_soft = light.radius > 0.0 && settings.light_samples > 1;
            let direct = match is_soft {
                true => self.soft(point, light, point.key.child(index as u64)),
                false => self.direct(point, vector(light.position)),
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

    /// The mean over the points of a soft light: a spiral on the disc that it shows.
    fn soft(
        &self,
        point: &CertifiedPoint<'_, N>,
        light: &PointLight,
        key: CertifiedKey,
    ) -> CertifiedValue<N> {
        /// The dimension of the rotation of the spiral.
        const ROTATION: u64 = 2;
        let center = vector(light.position);
        let towards = (center - point.point).normalized();
        // Without a frame, any part of the light may be seen.
        let Some([across, upward]) = frame(towards) else {
            let lit = self.shading(point, center).color;
            let is_black = lit.iter().all(|channel| channel.is_zero());
            return CertifiedValue {
                color: [if is_black { N::ZERO } else { N::NONNEGATIVE }; 3],
                doubts: if is_black { Doubts::NONE } else { Doubts::SEAM },
            };
        };
        let count = N::point(f64::from(self.scene.settings.light_samples));
        let radius = N::point(light.radius);
        let rotation = key.bits(ROTATION);
        let (mut sum, mut doubts) = ([N::ZERO; 3], Doubts::NONE);
        for k in 0..self.scene.settings.light_samples {
            let r = radius * (N::point(f64::from(k) + 0.5) / count).sqrt();
            let [x, y] = N::cos_sin(spiral_turns(k, rotation));
            let value = self.direct(point, center + across * (r * x) + upward * (r * y));
            sum = plus(sum, value.color);
            doubts = doubts | value.doubts;
        }
        CertifiedValue {
            color: sum.map(|channel| channel / count),
            doubts,
        }
    }

    /// `kd·C·max(0, N·L) + ks·max(0, R·V)ⁿ`, with shadows as the scene has them.
    fn direct(&self, point: &CertifiedPoint<'_, N>, light: Vector<N>) -> CertifiedValue<N> {
        let CertifiedShading {
            color,
            n_dot_l,
            to_light,
            distance,
        } = self.shading(point, light);
        let dark = || CertifiedValue::certain([N::ZERO; 3]);
        let is_black = color.iter().all(|channel| channel.is_zero());
        if is_black {
            return dark();
        }
        if !self.scene.settings.shadows {
            return CertifiedValue::certain(color);
        }
        // Both normals must face the light.
        let geometric = match point.has_shading_normal {
            true => point.geometric.dot(to_light),
            false => n_dot_l,
        };
        let slopes = [n_dot_l, geometric];
        let is_turned = |slope: N| slope.is_negative() || slope.is_zero();
        if slopes.into_iter().any(is_turned) {
            return dark();
        }
        // Where they do not for certain, or it is not seen for certain, take both.
        let both = |doubts| CertifiedValue {
            color: color.map(|channel| channel.hull(N::ZERO)),
            doubts,
        };
        if !slopes.into_iter().all(N::is_positive) {
            return both(Doubts::SHADOW);
        }
        match self.surfaces.visibility(&point.ray(to_light), distance) {
            Visibility::Lit => CertifiedValue::certain(color),
            Visibility::Shadowed => dark(),
            Visibility::Unclear(why) => both(why),
        }
    }

    /// The terms of a light without its shadows.
    fn shading(&self, point: &CertifiedPoint<'_, N>, light: Vector<N>) -> CertifiedShading<N> {
        let offset = light - point.point;
        let distance = offset.length();
        let to_light = offset.map(|x| (x / distance).clamp(-1.0, 1.0));
        let n_dot_l = point.normal.dot(to_light);
        let diffuse = N::point(point.material.kd) * n_dot_l.clamp(0.0, 1.0);
        let highlight = match point.ks.is_zero() {
            true => N::ZERO,
            false => point.ks * highlight(point, to_light, n_dot_l),
        };
        CertifiedShading {
            color: point.color.map(|channel| channel * diffuse + highlight),
            n_dot_l,
            to_light,
            distance,
        }
    }

    /// Gooch's model in the course's form: `Σ cool·(1 − N·L)/2 + warm·(1 + N·L)/2 +
    /// ks·max(0, R·V)ⁿ·c_l`.
    fn gooch(&self, point: &CertifiedPoint<'_, N>, parameters: &Gooch) -> Color<N> {
        let Gooch { b, y, alpha, beta } = *parameters;
        let number = N::point;
        let mut sum = [N::ZERO; 3];
        for light in &self.lights {
            let to_light = (vector(light.position) - point.point).normalized();
            let n_dot_l = point.normal.dot(to_light);
            let c = colored(light.color);
            let tone = times(product(c, point.color), number(point.material.kd));
            let cool = plus([0.0, 0.0, b].map(number), times(tone, number(alpha)));
            let warm = plus([y, y, 0.0].map(number), times(tone, number(beta)));
            let half = number(0.5);
            sum = plus(sum, times(cool, half * (N::ONE - n_dot_l)));
            sum = plus(sum, times(warm, half * (N::ONE + n_dot_l)));
            let highlight = highlight(point, to_light, n_dot_l);
            sum = plus(sum, times(c, point.ks * highlight));
        }
        sum
    }
}

/// max(0, R·V)ⁿ.
fn highlight<N: CertifiedNumber>(
    point: &CertifiedPoint<'_, N>,
    to_light: Vector<N>,
    n_dot_l: N,
) -> N {
    let reflected = point.normal * (N::point(2.0) * n_dot_l) - to_light;
    let r_dot_v = reflected.dot(point.to_viewer);
    r_dot_v.power(N::point(point.material.n))
}

/// The terms of a light at a point.
struct CertifiedShading<N> {
    color: Color<N>,
    n_dot_l: N,
    to_light: Vector<N>,
    distance: N,
}

impl<N: CertifiedNumber> CertifiedValue<N> {
    fn certain(color: Color<N>) -> Self {
        let doubts = Doubts::NONE;
        Self { color, doubts }
    }
}

impl<N: CertifiedNumber> CertifiedPoint<'_, N> {
    /// The ray from here.
    pub(super) fn ray(&self, direction: Vector<N>) -> CertifiedRay<N> {
        let start = RayStart {
            surface: self.surface,
            part: self.part,
            normal: self.declared,
        };
        CertifiedRay::new(self.point, direction, Some(start))
    }
}

/// Two unit vectors at right angles to a unit vector (Duff et al., "Building an orthonormal basis,
/// revisited", JCGT 6, 2017); `None` near the plane where they jump.
pub(super) fn frame<N: CertifiedNumber>(Vector { x, y, z }: Vector<N>) -> Option<[Vector<N>; 2]> {
    if !z.has_sign() {
        return None;
    }
    let sign = if z.is_positive() { N::ONE } else { -N::ONE };
    let a = -N::ONE / (sign + z);
    let b = x * y * a;
    Some([
        Vector::from([N::ONE + sign * x.square() * a, sign * b, -sign * x]),
        Vector::from([b, sign + y.square() * a, -y]),
    ])
}

fn vector<N: CertifiedNumber>(position: [f64; 3]) -> Vector<N> {
    Vector::point(Vec3::from_array(position))
}

fn colored<N: CertifiedNumber>(color: [f64; 3]) -> Color<N> {
    color.map(N::point)
}

pub(super) fn times<N: CertifiedNumber>(color: Color<N>, factor: N) -> Color<N> {
    color.map(|channel| channel * factor)
}

fn product<N: CertifiedNumber>([a, b, c]: Color<N>, [x, y, z]: Color<N>) -> Color<N> {
    [a * x, b * y, c * z]
}

/// The sum of two colours.
pub(super) fn plus<N: CertifiedNumber>([a, b, c]: Color<N>, [x, y, z]: Color<N>) -> Color<N> {
    [a + x, b + y, c + z]
}

/// The sum of a colour and any light.
fn any_light<N: CertifiedNumber>(color: Color<N>) -> Color<N> {
    plus(color, [N::NONNEGATIVE; 3])
}
