//! Random path-traced scenes: layers, maps, alpha and lights of all kinds, each often of weight 0
//! or constant, so that rules apply.

use super::Dice;
use rtc::internals::ir::{
    self, Alpha, Environment, Filter, ImageId, Map, Material, MaterialId, Medium, Mode,
    PathSettings, Pixels, Punctual, Sampled, Scene, Standard, Texture, TextureId, Wrap,
};

use serde_json::json;

/// Textures that a map may show.
const TEXTURES: u32 = 6;

impl Dice {
    /// A path-traced scene.
    pub(in super::super) fn path_scene(&mut self) -> Scene {
        let mut scene = self.scene();
        let (images, textures) = self.path_textures();
        (scene.images, scene.textures) = (images, textures);
        let materials = 1 + self.roll(3);
        let all_unlit = self.chance(8);
        scene.materials = (0..materials)
            .map(|_| Material::Standard(Box::new(self.layered(all_unlit))))
            .collect();
        for surface in &mut scene.surfaces {
            surface.material = MaterialId(self.roll(materials));
        }
        if self.chance(5) {
            scene.surfaces.truncate(1);
        }
        scene.lights = (0..self.roll(3)).map(|_| self.path_light()).collect();
        scene.environment = self.chance(2).then(|| self.environment());
        scene.meshes.iter_mut().for_each(|mesh| self.paint(mesh));
        scene.settings.max_depth = self.pick(&[0, 1, 2, 4]);
        scene.settings.mode = Mode::Path(PathSettings {
            samples: self.pick(&[1, 3]),
            multiple_scattering: self.chance(2),
            ..PathSettings::default()
        });
        scene.camera.projection = self.pick(&[
            ir::Projection::Perspective,
            ir::Projection::Perspective,
            ir::Projection::Orthographic,
        ]);
        if self.chance(6) {
            self.light_directly(&mut scene);
        }
        self.fill(&mut scene);
        scene
    }

    /// Fills some scenes with media, clear ones too. It has its own generator, so that it does not
    /// change the other choices.
    fn fill(&self, scene: &mut Scene) {
        let mut dice = Self(self.0.rotate_left(32));
        if !dice.chance(4) {
            return;
        }
        let (absorbs, scatters) = (dice.chance(2), dice.chance(2));
        let sigma = |is_there: bool, sigma: [f64; 3]| if is_there { sigma } else { [0.0; 3] };
        let medium = Medium {
            sigma_a: sigma(absorbs, [0.1, 0.0, 0.3]),
            sigma_s: sigma(scatters, [0.5, 0.2, 0.0]),
            g: 0.3,
        };
        let mut filled = || dice.chance(2).then_some(medium);
        scene.medium = filled();
        for material in &mut scene.materials {
            if let Material::Standard(standard) = material {
                (standard.interior, standard.exterior) = (filled(), filled());
            }
        }
    }

    /// Keeps only direct light, and adds a sphere that is behind most cameras.
    fn light_directly(&mut self, scene: &mut Scene) {
        for material in &mut scene.materials {
            if let Material::Standard(standard) = material {
                (standard.emissive, standard.unlit) = ([0.0; 3], false);
            }
        }
        (scene.environment, scene.settings.max_depth) = (None, 1);
        scene.lights.truncate(1);
        if scene.lights.is_empty() {
            scene.lights.push(self.path_light());
        }
        let mirror = Standard {
            roughness: self.weight(),
            ..Standard::default()
        };
        scene.surfaces.push(ir::Surface::new(
            ir::Shape::Sphere(ir::Sphere {
                center: [self.number(3), self.number(3), 12.0],
                radius: self.length(),
                texture_from_world: None,
            }),
            MaterialId(scene.materials.len() as u32),
        ));
        scene.materials.push(Material::Standard(Box::new(mirror)));
    }

    /// Noise, constant, black, opaque, partly transparent, and white.
    fn path_textures(&mut self) -> (Vec<ir::Image>, Vec<Texture>) {
        let image = |value: &dyn Fn(u8) -> u8| ir::Image {
            name: "dice".to_owned(),
            width: 4,
            height: 4,
            kind: Pixels::Rgba8,
            pixels: (0..64).map(value).collect::<Vec<_>>().into(),
        };
        let images = vec![
            image(&|k| k.wrapping_mul(37)),
            image(&|k| [128, 100, 250, 255][usize::from(k) % 4]),
            image(&|_| 0),
            image(&|k| if k % 4 == 3 { 255 } else { k * 4 }),
            image(&|k| if k % 4 == 3 && k > 32 { 0 } else { 200 }),
            image(&|_| 255),
        ];
        let sampled = |image: u32| {
            let wrap = self.pick(&[Wrap::Repeat, Wrap::Clamp, Wrap::Mirror]);
            let filter = self.pick(&[Filter::Linear, Filter::Nearest]);
            Texture::Sampled(Sampled {
                image: ImageId(image),
                wrap: [wrap; 2],
                filter,
            })
        };
        (images, (0..TEXTURES).map(sampled).collect())
    }

    fn path_map(&mut self) -> Option<Map> {
        let texture_from_surface = self.chance(3).then(|| {
            [
                [self.length(), 0.0, self.number(2)],
                [0.0, 0.1, self.number(1)],
            ]
        });
        self.chance(4).then(|| Map {
            texture: TextureId(self.roll(TEXTURES)),
            set: u32::from(self.chance(4)),
            texture_from_surface,
        })
    }

    fn weight(&mut self) -> f64 {
        self.pick(&[0.0, 0.0, 0.5, 1.0])
    }

    fn layered(&mut self, unlit: bool) -> Standard {
        Standard {
            base_color: self.pick(&[
                [0.0, 0.0, 0.0, 1.0],
                [0.8, 0.6, 0.4, 1.0],
                [1.0, 1.0, 1.0, 0.5],
            ]),
            base_color_map: self.path_map(),
            metallic: self.weight(),
            roughness: self.weight(),
            metallic_roughness_map: self.path_map(),
            emissive: self.pick(&[[0.0; 3], [0.0; 3], [2.0, 1.0, 0.5]]),
            emissive_map: self.path_map(),
            normal_map: self.path_map(),
            alpha: self.pick(&[Alpha::Opaque, Alpha::Opaque, Alpha::Mask(0.5), Alpha::Blend]),
            double_sided: self.chance(2),
            unlit: unlit || self.chance(8),
            ior: self.pick(&[1.0, 1.5]),
            dispersion: self.pick(&[0.0, 0.0, 0.3]),
            specular: self.weight(),
            specular_map: self.path_map(),
            transmission: self.pick(&[0.0, 0.0, 1.0]),
            transmission_map: self.path_map(),
            thickness: self.weight(),
            attenuation_distance: self.pick(&[None, Some(0.5)]),
            attenuation_color: [0.9, 0.5, 0.2],
            ..self.layers()
        }
    }

    fn layers(&mut self) -> Standard {
        Standard {
            clearcoat: self.pick(&[0.0, 0.0, 1.0]),
            clearcoat_map: self.path_map(),
            clearcoat_roughness: self.weight(),
            clearcoat_normal_map: self.path_map(),
            sheen_color: self.pick(&[[0.0; 3], [0.0; 3], [0.5, 0.2, 0.9]]),
            sheen_color_map: self.path_map(),
            sheen_roughness: self.weight(),
            anisotropy: self.pick(&[0.0, 0.0, 0.7]),
            anisotropy_map: self.path_map(),
            iridescence: self.pick(&[0.0, 0.0, 1.0]),
            iridescence_map: self.path_map(),
            ..self.unnamed()
        }
    }

    /// A material with random factors, colours and maps, so that those that no scene above names
    /// are also covered. It has its own generator, so that a new parameter does not change the
    /// other choices.
    fn unnamed(&self) -> Standard {
        let mut dice = Self(!self.0);
        let mut material = serde_json::to_value(Standard::default()).unwrap();
        let schema = schemars::schema_for!(Standard);
        for (name, property) in schema.get("properties").unwrap().as_object().unwrap() {
            let default = property["default"].as_f64();
            let value = match property["type"].as_str() {
                Some("array") if property["maxItems"] == 3 => {
                    json!(dice.pick(&[[0.0; 3], [0.5, 0.2, 0.9], [1.0; 3]]))
                }
                Some("number") if default.is_none() => json!(dice.weight()),
                None if name.ends_with("Map") => json!(dice.path_map()),
                Some(_) | None => continue,
            };
            material[name] = value;
        }
        serde_json::from_value(material).unwrap()
    }

    fn path_light(&mut self) -> ir::Light {
        let position = [self.number(3), self.number(3), 6.0];
        let range = self.pick(&[None, None, Some(0.5), Some(20.0)]);
        let direction = [0.0, self.pick(&[0.0, 1.0]), self.pick(&[-1.0, 1.0])];
        let emitter = self.emitter(position, direction, range);
        let intensity = self.pick(&[[0.0; 3], [3.0, 2.0, 4.0], [20.0; 3]]);
        ir::Light::Punctual(Punctual {
            emitter,
            intensity,
            projected: None,
        })
    }

    fn environment(&mut self) -> Environment {
        Environment {
            radiance: self.pick(&[[0.0; 3], [0.5, 0.7, 1.0], [1.0; 3]]),
            image: self.chance(3).then(|| ImageId(self.roll(TEXTURES))),
            image_from_world: None,
        }
    }

    /// Vertex colours, and a second set of texture coordinates.
    fn paint(&mut self, mesh: &mut ir::Mesh) {
        if self.chance(4) {
            mesh.colors = vec![
                [1.0, 0.5, 0.2, 1.0],
                [1.0; 4],
                [0.2, 0.4, 0.6, 0.9],
                [1.0; 4],
            ]
            .into();
        }
        if self.chance(4) {
            mesh.second_uvs = vec![[0.3, 0.3], [0.4, 0.3], [0.4, 0.4], [0.3, 0.4]].into();
        }
    }
}
