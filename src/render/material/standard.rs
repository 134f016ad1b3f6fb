//! The material of glTF where a ray meets it: factors times maps, the frame of shading, and what of
//! it emits or is absent.

use crate::math::{Basis, Vec3, cos, ln, sin};
use crate::render::bsdf::{Anisotropy, Clearcoat, Iridescence, Sheen, Standard, dispersed};
use crate::render::ray::Interaction;
use crate::render::shape::instance::{Asked, Details};
use crate::render::texture::sampled::{Content, Places, look_up};
use crate::valid::{Alpha, Map, Proof, Standard as Material};

/// A material of the scene with what a surface says of one point.
pub(in crate::render) struct Point<'world> {
    scene: &'world Proof,
    pub(in crate::render) material: &'world Material,
    places: Places,
    /// The colour at the point, that of the corners included, and alpha.
    base: [f64; 4],
}

/// The frame of shading at a point: the unit normal, and the directions along which maps grow.
pub(in crate::render) struct Frame {
    /// Right-handed, as the BSDF wants it.
    basis: Basis,
    /// −1 where maps grow against the bitangent.
    side: f64,
}

/// What a material needs to know of a surface.
pub(in crate::render) fn asked(material: &Material) -> Asked {
    let turns = material.anisotropy > 0.0
        || material.normal_map.is_some()
        || material.clearcoat_normal_map.is_some();
    Asked {
        uv: material.maps().next().is_some(),
        tangent: turns,
    }
}

impl<'world> Point<'world> {
    pub(in crate::render) fn new(scene: &'world Proof, material: usize, details: &Details) -> Self {
        let material = &scene.standards()[material];
        let places = [details.uv, details.second_uv];
        let mut point = Self {
            scene,
            material,
            places,
            base: material.base_color,
        };
        let texture = point.show(material.base_color_map.as_ref(), Content::Color);
        let corners = details.color.unwrap_or([1.0; 4]);
        let base = |k: usize| material.base_color[k] * texture[k] * corners[k];
        point.base = [base(0), base(1), base(2), base(3)];
        point
    }

    /// The first texture coordinates.
    pub(in crate::render) fn uv(&self) -> Option<[f64; 2]> {
        self.places[0]
    }

    /// What a map shows; ones where there is none.
    #[inline]
    fn show(&self, map: Option<&Map>, content: Content) -> [f64; 4] {
        map.and_then(|map| look_up(self.scene, map, &self.places, content))
            .unwrap_or([1.0; 4])
    }

    fn linear(&self, map: Option<&Map>) -> [f64; 4] {
        self.show(map, Content::Linear)
    }

    fn color(&self, map: Option<&Map>) -> Vec3 {
        let [r, g, b, _] = self.show(map, Content::Color);
        Vec3::new(r, g, b)
    }

    /// The share of the surface that is there.
    pub(in crate::render) fn coverage(&self) -> f64 {
        match self.material.alpha {
            Alpha::Opaque => 1.0,
            Alpha::Mask(cutoff) => f64::from(u8::from(self.base[3] >= cutoff)),
            Alpha::Blend => self.base[3].clamp(0.0, 1.0),
        }
    }

    /// The colour, each channel at most 1.
    pub(in crate::render) fn base_color(&self) -> Vec3 {
        let [r, g, b, _] = self.base;
        Vec3::new(r, g, b).min(Vec3::ONE)
    }

    /// The radiance it sends out by itself.
    pub(in crate::render) fn emission(&self) -> Vec3 {
        let emissive = Vec3::from_array(self.material.emissive);
        if emissive == Vec3::ZERO {
            emissive
        } else {
            emissive * self.color(self.material.emissive_map.as_ref())
        }
    }

    /// What is scattered; `channel` is the colour that a dispersed path has been left with.
    pub(in crate::render) fn standard(
        &self,
        frame: &Frame,
        clearcoat: Vec3,
        channel: Option<usize>,
        multiple: bool,
    ) -> Standard {
        let m = self.material;
        let ior = match channel {
            Some(channel) if m.dispersion > 0.0 => dispersed(m.ior, m.dispersion)[channel],
            _ => m.ior,
        };
        let [_, g, b, _] = self.linear(m.metallic_roughness_map.as_ref());
        let mut standard = Standard {
            base_color: self.base_color(),
            metallic: m.metallic * b,
            roughness: m.roughness * g,
            ior,
            specular: m.specular * self.linear(m.specular_map.as_ref())[3],
            specular_color: Vec3::from_array(m.specular_color)
                * self.color(m.specular_color_map.as_ref()),
            transmission: m.transmission * self.linear(m.transmission_map.as_ref())[0],
            thin_walled: !self.bounds_a_volume(),
            anisotropy: None,
            clearcoat: None,
            sheen: None,
            iridescence: None,
            multiple_scattering: multiple,
        };
        if let Some([red, green, blue, glossiness]) = m.specular_glossiness {
            // An infinite index reflects the colour given.
            let [r, g, b, a] = self.show(m.specular_glossiness_map.as_ref(), Content::Color);
            standard.specular_color = Vec3::new(red * r, green * g, blue * b);
            standard.roughness = (1.0 - glossiness * a).clamp(0.0, 1.0);
            (standard.metallic, standard.ior, standard.specular) = (0.0, 0.0, 1.0);
        }
        self.add_layers(&mut standard, frame, clearcoat);
        standard
    }

    fn add_layers(&self, standard: &mut Standard, frame: &Frame, clearcoat: Vec3) {
        let m = self.material;
        if m.clearcoat > 0.0 {
            let factor = m.clearcoat * self.linear(m.clearcoat_map.as_ref())[0];
            let roughness =
                m.clearcoat_roughness * self.linear(m.clearcoat_roughness_map.as_ref())[1];
            standard.clearcoat = Some(Clearcoat {
                factor,
                roughness,
                normal: frame.to_local(clearcoat),
            });
        }
        if m.sheen_color != [0.0; 3] {
            let color = Vec3::from_array(m.sheen_color) * self.color(m.sheen_color_map.as_ref());
            let roughness = m.sheen_roughness * self.linear(m.sheen_roughness_map.as_ref())[3];
            standard.sheen = Some(Sheen { color, roughness });
        }
        if m.anisotropy > 0.0 {
            standard.anisotropy = Some(self.anisotropy(frame.side));
        }
        if m.iridescence > 0.0 {
            let factor = m.iridescence * self.linear(m.iridescence_map.as_ref())[0];
            let [least, greatest] = m.iridescence_thickness;
            let thickness =
                least + (greatest - least) * self.linear(m.iridescence_thickness_map.as_ref())[1];
            standard.iridescence = Some(Iridescence {
                factor,
                ior: m.iridescence_ior,
                thickness,
            });
        }
    }

    fn anisotropy(&self, side: f64) -> Anisotropy {
        let m = self.material;
        let map = m
            .anisotropy_map
            .as_ref()
            .and_then(|map| look_up(self.scene, map, &self.places, Content::Linear));
        let [r, g, share, _] = map.unwrap_or([1.0, 0.5, 1.0, 1.0]);
        let along = Vec3::new(r * 2.0 - 1.0, g * 2.0 - 1.0, 0.0).normalize_or(Vec3::X);
        let (c, s) = (cos(m.anisotropy_rotation), sin(m.anisotropy_rotation));
        let direction = [
            c * along.x - s * along.y,
            (s * along.x + c * along.y) * side,
        ];
        Anisotropy {
            strength: m.anisotropy * share,
            direction,
        }
    }

    /// Whether there is a medium behind the surface.
    pub(in crate::render) fn bounds_a_volume(&self) -> bool {
        self.material.thickness > 0.0
    }

    /// The coefficient of absorption of the medium inside, per unit of length.
    pub(in crate::render) fn absorption(&self) -> Vec3 {
        let Some(distance) = self.material.attenuation_distance else {
            return Vec3::ZERO;
        };
        // −ln of the least positive number stands for black.
        Vec3::from_array(self.material.attenuation_color)
            .map(|c| -ln(c.max(f64::MIN_POSITIVE)) / distance)
    }

    /// The frame with the normal map applied, and the normal of the clearcoat.
    pub(in crate::render) fn frame(
        &self,
        at: &Interaction,
        details: &Details,
        wo: Vec3,
    ) -> (Frame, Vec3) {
        // The winding says which side is outside, and the normals of some meshes were made against
        // it.
        let normal = details
            .normal
            .map_or(at.normal, |n| if n.dot(at.normal) < 0.0 { -n } else { n });
        let m = self.material;
        let mapped = |map: &Option<Map>, scale: f64| {
            let normal = map
                .as_ref()
                .map_or(normal, |map| self.mapped(map, scale, normal, details));
            bent(normal, at.normal, wo)
        };
        let shading = mapped(&m.normal_map, m.normal_scale);
        let has_coat = m.clearcoat > 0.0;
        let coat = if has_coat {
            mapped(&m.clearcoat_normal_map, m.clearcoat_normal_scale)
        } else {
            shading
        };
        (
            Frame {
                basis: basis(shading, details.tangent, 1.0),
                side: details.side,
            },
            coat,
        )
    }

    /// The normal that a map gives.
    fn mapped(&self, map: &Map, scale: f64, normal: Vec3, details: &Details) -> Vec3 {
        let shown = look_up(self.scene, map, &self.places, Content::Linear);
        let Some([x, y, z, _]) = shown else {
            return normal;
        };
        let local = Vec3::new(
            (x * 2.0 - 1.0) * scale,
            (y * 2.0 - 1.0) * scale,
            z * 2.0 - 1.0,
        );
        basis(normal, details.tangent, details.side)
            .to_world(local)
            .normalize_or(normal)
    }
}

impl Frame {
    pub(in crate::render) fn to_local(&self, w: Vec3) -> Vec3 {
        self.basis.to_local(w)
    }

    pub(in crate::render) fn to_world(&self, w: Vec3) -> Vec3 {
        self.basis.to_world(w)
    }
}

/// The frame around a normal, its tangent that of a surface as far as there is one.
fn basis(normal: Vec3, tangent: Option<Vec3>, side: f64) -> Basis {
    let tangent = tangent
        .map(|t| t - normal * normal.dot(t))
        .and_then(Vec3::try_normalize);
    tangent.map_or_else(
        || Basis::around(normal),
        |tangent| Basis {
            tangent,
            bitangent: normal.cross(tangent) * side,
            normal,
        },
    )
}

/// A shading normal that mirrors the viewer to above the surface: one that leans too far is bent
/// until it does, so that what is shiny turns no blacker than its horizon (Keller et al., "The Iray
/// light transport simulation and rendering system", 2017, has a like rule).
fn bent(shading: Vec3, geometric: Vec3, wo: Vec3) -> Vec3 {
    /// How far above the horizon, as a sine, and as a share of what the geometric normal gives.
    const LEAST: f64 = 0.01;
    const SHARE: f64 = 0.9;
    let side = 1.0_f64.copysign(wo.dot(geometric));
    let (n, above) = (shading * side, geometric * side);
    let mirrored = n * (2.0 * n.dot(wo)) - wo;
    let (height, least) = (mirrored.dot(above), LEAST.min(SHARE * wo.dot(above)));
    if height >= least {
        return shading;
    }
    // The normal halfway between the viewer and the direction raised.
    let raised = (mirrored + above * (least - height)).normalize_or_zero();
    (wo + raised).normalize_or(above) * side
}
