//! Random scenes of all kinds: like the other ones, and at random with path tracing, all materials
//! and lights, directions with lengths from 1e-300 to 1e300, the scene or one surface scaled by
//! 1e-58 to 1e58, and degenerate shapes.

use super::Dice;
use crate::scale::{scale_shape, scaled};
use rtc::internals::ir::{
    self, ImageId, Light, Map, Material, Mode, Scene, Shape, Standard, Texture, TextureId,
};
use rtc::internals::math::Vec3;

impl Dice {
    /// Not every scene is valid: some with mixed sizes are rejected.
    pub(in super::super) fn extreme(&mut self) -> Scene {
        let mut scene = self.scene();
        self.complete(&mut scene);
        if self.chance(3) {
            scene.settings.mode = Mode::Path(ir::PathSettings {
                samples: 1 + self.roll(3),
                multiple_scattering: self.chance(2),
                ..ir::PathSettings::default()
            });
        }
        if self.chance(8) {
            scene.camera.projection = ir::Projection::Orthographic;
        }
        for material in &mut scene.materials {
            if self.chance(3) {
                *material = Material::Standard(Box::new(self.standard()));
            }
        }
        for light in &mut scene.lights {
            if self.chance(3) {
                *light = self.punctual();
            }
        }
        self.stretch_directions(&mut scene);
        if self.chance(4) {
            self.distort(&mut scene);
        }
        if self.chance(3) {
            scene = scaled(&scene, self.scale());
            for light in &mut scene.lights {
                if let Light::Punctual(ir::Punctual { intensity, .. }) = light {
                    *intensity = intensity.map(|channel| channel.min(1e60));
                }
            }
        } else if self.chance(4) {
            let index = self.roll(u32::try_from(scene.surfaces.len()).unwrap()) as usize;
            scale_shape(&mut scene.surfaces[index].shape, self.scale());
        }
        scene
    }

    /// Adds what only path tracing uses: an environment map, and samplers for the other images.
    fn complete(&mut self, scene: &mut Scene) {
        let light: Vec<u8> = (0_u8..12)
            .flat_map(|k| (f32::from(k) * 0.3).to_le_bytes())
            .collect();
        let kind = ir::Pixels::Rgb32f;
        scene.images.push(ir::Image {
            name: "light".to_owned(),
            width: 2,
            height: 2,
            kind,
            pixels: light.into(),
        });
        if self.chance(3) {
            let image = self.chance(2).then_some(ImageId(3));
            let turned = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
            let image_from_world = self.chance(2).then_some(turned);
            let radiance = self.pick(&[[0.0; 3], [0.2, 0.4, 1.0], [3.0; 3]]);
            scene.environment = Some(ir::Environment {
                radiance,
                image,
                image_from_world,
            });
        }
        let wraps = [ir::Wrap::Repeat, ir::Wrap::Mirror, ir::Wrap::Clamp];
        for image in [0, 1] {
            let filter = self.pick(&[ir::Filter::Linear, ir::Filter::Nearest]);
            let wrap = [self.pick(&wraps), self.pick(&wraps)];
            scene.textures.push(Texture::Sampled(ir::Sampled {
                image: ImageId(image),
                wrap,
                filter,
            }));
        }
        for mesh in &mut scene.meshes {
            if self.chance(2) {
                mesh.second_uvs = vec![[0.0, 1.0], [2.0, 0.0], [1.0, 3.0], [-1.0, 0.5]].into();
                mesh.colors = vec![
                    [1.0, 0.5, 0.0, 1.0],
                    [0.0, 1.0, 1.0, 0.5],
                    [1.0; 4],
                    [0.5, 0.0, 1.0, 0.0],
                ]
                .into();
            }
            if self.chance(3) && !mesh.normals.is_empty() {
                mesh.tangents = vec![
                    [1.0, 0.0, 0.0, 1.0],
                    [1.0, 0.0, 0.0, -1.0],
                    [0.0, 1.0, 0.0, 1.0],
                    [0.0; 4],
                ]
                .into();
            }
        }
    }

    fn punctual(&mut self) -> Light {
        let range = self.pick(&[None, Some(6.0), Some(30.0)]);
        let (position, direction) = (self.point(6), self.axis());
        let emitter = self.emitter(position, direction, range);
        Light::Punctual(ir::Punctual {
            emitter,
            intensity: self.pick(&[[0.0; 3], [3.0, 2.0, 1.0], [40.0; 3]]),
            projected: None,
        })
    }

    /// A map of six textures.
    fn sampled(&mut self) -> Option<Map> {
        let map = Map {
            texture: TextureId(self.roll(6)),
            set: self.roll(2),
            texture_from_surface: None,
        };
        let turned = Some([[0.0, 2.0, 0.3], [-2.0, 0.0, 0.0]]);
        self.chance(8).then(|| Map {
            texture_from_surface: if self.chance(3) { turned } else { None },
            ..map
        })
    }

    /// A number of [0, 1], most often 0.
    fn share(&mut self) -> f64 {
        self.pick(&[0.0, 0.0, 0.0, 0.3, 1.0])
    }

    fn standard(&mut self) -> Standard {
        let thickness = self.pick(&[0.0, 0.0, 1.0]);
        Standard {
            base_color: self.pick(&[
                [1.0; 4],
                [0.9, 0.5, 0.1, 1.0],
                [0.2, 0.7, 0.4, 0.5],
                [0.0; 4],
            ]),
            base_color_map: self.sampled(),
            metallic: self.pick(&[0.0, 0.0, 0.5, 1.0]),
            roughness: self.pick(&[0.0, 0.3, 1.0]),
            metallic_roughness_map: self.sampled(),
            specular_glossiness: self.chance(8).then_some([0.5, 0.4, 0.2, 0.7]),
            specular_glossiness_map: self.sampled(),
            emissive: self.pick(&[[0.0; 3], [0.0; 3], [2.0, 1.0, 0.0]]),
            emissive_map: self.sampled(),
            normal_map: self.sampled(),
            normal_scale: self.pick(&[1.0, -2.0]),
            alpha: self.pick(&[
                ir::Alpha::Opaque,
                ir::Alpha::Opaque,
                ir::Alpha::Mask(0.5),
                ir::Alpha::Blend,
            ]),
            double_sided: self.chance(2),
            unlit: self.chance(8),
            ior: self.pick(&[0.0, 1.0, 1.5, 2.4]),
            dispersion: self.pick(&[0.0, 0.0, 1.0]),
            specular: self.pick(&[1.0, 1.0, 0.0, 0.5]),
            specular_map: self.sampled(),
            specular_color: self.pick(&[[1.0; 3], [2.0, 0.0, 1.0]]),
            specular_color_map: self.sampled(),
            transmission: self.share(),
            transmission_map: self.sampled(),
            thickness,
            thickness_map: self.sampled(),
            attenuation_distance: self.pick(&[None, Some(0.5)]),
            attenuation_color: self.pick(&[[1.0; 3], [0.2, 0.8, 1.0]]),
            clearcoat: self.share(),
            clearcoat_map: self.sampled(),
            clearcoat_roughness: self.share(),
            clearcoat_roughness_map: self.sampled(),
            clearcoat_normal_map: self.sampled(),
            sheen_color: self.pick(&[[0.0; 3], [0.0; 3], [0.3, 0.6, 1.0]]),
            sheen_color_map: self.sampled(),
            sheen_roughness: self.share(),
            sheen_roughness_map: self.sampled(),
            anisotropy: self.share(),
            anisotropy_rotation: self.pick(&[0.0, 1.0]),
            anisotropy_map: self.sampled(),
            iridescence: self.share(),
            iridescence_map: self.sampled(),
            iridescence_thickness_map: self.sampled(),
            ..Standard::default()
        }
    }

    /// Gives directions, whose length has no meaning, another one, or bends them by a component
    /// that vanishes beside them.
    fn stretch_directions(&mut self, scene: &mut Scene) {
        for surface in &mut scene.surfaces {
            if let Some(direction) = direction(&mut surface.shape) {
                *direction = self.lambda_root(*direction);
            }
        }
        for light in &mut scene.lights {
            if let Light::Punctual(ir::Punctual { emitter, .. }) = light {
                emitter.transform(|point| point, |direction| self.lambda_root(direction), 1.0);
            }
        }
        for mesh in scene
            .meshes
            .iter_mut()
            .filter(|mesh| !mesh.normals.is_empty())
        {
            let length = self.pick(&[1.0, 1.0, 1e-300, 1e-170, 1e170, 1e300]);
            mesh.normals = mesh
                .normals
                .iter()
                .map(|normal| normal.map(|component| component * length))
                .collect();
        }
    }

    fn lambda_root(&mut self, mut direction: [f64; 3]) -> [f64; 3] {
        if self.chance(2) {
            let length = self.pick(&[1e-300, 1e-200, 1e-161, 1e-155, 1e155, 1e161, 1e200, 1e300]);
            direction = direction.map(|component| component * length);
        }
        if self.chance(8) {
            direction[0] += Vec3::from_array(direction).abs().max_element() * 1e-162;
        }
        direction
    }

    /// Makes one shape thin, flat or long, or moves the eye far away.
    fn distort(&mut self, scene: &mut Scene) {
        let factor = self.power(20);
        let index = self.roll(u32::try_from(scene.surfaces.len()).unwrap()) as usize;
        if self.chance(6) {
            scene.camera.eye = scene
                .camera
                .eye
                .map(|component| component * factor.max(1.0));
            return;
        }
        self.distort_shape(&mut scene.surfaces[index].shape, factor);
    }

    fn distort_shape(&mut self, shape: &mut Shape, factor: f64) {
        if let Shape::Sphere(ir::Sphere { radius, .. }) | Shape::Disc(ir::Disc { radius, .. }) =
            shape
        {
            *radius *= factor;
        } else if let Shape::Plane(ir::Plane { center, .. }) = shape {
            center[self.roll(3) as usize] *= factor;
        } else if let Shape::Triangle(ir::Triangle { vertices, .. }) = shape {
            vertices[0][self.roll(3) as usize] *= factor;
        } else if let Shape::Quad(ir::Quad { vertices }) = shape {
            vertices[self.roll(4) as usize][self.roll(3) as usize] *= factor;
        } else if let Shape::Cylinder(ir::Cylinder { height, radius, .. }) = shape {
            *(if self.chance(2) { height } else { radius }) *= factor;
        } else if let Shape::Cone(ir::Cone { up, radius, .. }) = shape {
            *radius *= factor;
            *up = up.map(|component| {
                if self.chance(2) {
                    component / factor
                } else {
                    component
                }
            });
        } else if let Shape::Torus(ir::Torus { major, minor, .. }) = shape {
            *(if self.chance(2) { major } else { minor }) *= factor;
        } else if let Shape::Instance(ir::Instance {
            world_from_object, ..
        }) = shape
        {
            let column = &mut world_from_object[self.roll(4) as usize];
            *column = column.map(|component| component * factor);
        }
    }

    /// Any scale that a scene can have.
    fn scale(&mut self) -> f64 {
        self.power(58)
    }

    /// A power of ten, from 10^-most to 10^most.
    fn power(&mut self, most: u32) -> f64 {
        format!("1e{}", i64::from(self.roll(2 * most + 1)) - i64::from(most))
            .parse()
            .unwrap()
    }
}

/// The direction of a shape whose length is not used.
fn direction(shape: &mut Shape) -> Option<&mut [f64; 3]> {
    if let Shape::Plane(ir::Plane { normal, .. }) | Shape::Disc(ir::Disc { normal, .. }) = shape {
        Some(normal)
    } else if let Shape::Cylinder(ir::Cylinder { axis, .. })
    | Shape::Torus(ir::Torus { axis, .. }) = shape
    {
        Some(axis)
    } else {
        None
    }
}
