//! Random scenes: each effect is present, absent, or has weight 0; positions are on a coarse grid,
//! so that surfaces touch, align and coincide.

mod extreme;
mod light;
mod paths;

use rtc::internals::ir::{self, ImageId, MaterialId, MeshId, Scene, Texture, TextureId};
use rtc::internals::math::{GAMMA, Vec3, mix, view_basis};

/// A seeded random number generator.
pub(super) struct Dice(u64);

impl Dice {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed ^ 0x5DEE_CE66_D1CE_4E5B)
    }

    pub(super) fn roll(&mut self, sides: u32) -> u32 {
        let bits = mix(self.0);
        self.0 = self.0.wrapping_add(GAMMA);
        u32::try_from((bits >> 33) % u64::from(sides)).unwrap()
    }

    fn chance(&mut self, sides: u32) -> bool {
        self.roll(sides) == 0
    }

    pub(super) fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.roll(u32::try_from(choices.len()).unwrap()) as usize]
    }

    /// A number on a grid of halves, or off it.
    fn number(&mut self, size: u32) -> f64 {
        let number = f64::from(self.roll(4 * size + 1)) / 2.0 - f64::from(size);
        if self.chance(3) {
            number + f64::from(self.roll(1000)) * 1e-3
        } else {
            number
        }
    }

    fn point(&mut self, size: u32) -> [f64; 3] {
        [self.number(size), self.number(size), self.number(size)]
    }

    fn axis(&mut self) -> [f64; 3] {
        if self.chance(2) {
            return self.pick(&[
                [0.0, 1.0, 0.0],
                [0.0, 0.0, 1.0],
                [1.0, 0.0, 0.0],
                [0.0, -1.0, 0.0],
                [0.0, 0.0, -1.0],
            ]);
        }
        let [x, y, z] = self.point(2);
        if [x, y, z] == [0.0; 3] {
            [0.0, 1.0, 0.0]
        } else {
            [x, y, z]
        }
    }

    fn length(&mut self) -> f64 {
        self.pick(&[0.25, 0.5, 1.0, 1.5, 3.0])
    }

    pub(super) fn scene(&mut self) -> Scene {
        let surfaces = 1 + self.roll(5);
        let lights = self.roll(4);
        let materials = 1 + self.roll(3);
        let (images, textures) = self.textures();
        let mut scene = Scene {
            camera: self.camera(),
            settings: self.settings(),
            lights: (0..lights).map(|_| self.light()).collect(),
            images,
            textures,
            meshes: vec![self.mesh(), self.mesh()],
            materials: (0..materials)
                .map(|_| ir::Material::Phong(self.phong()))
                .collect(),
            surfaces: (0..surfaces)
                .map(|_| ir::Surface::new(self.shape(), MaterialId(self.roll(materials))))
                .collect(),
            names: Vec::new(),
            environment: None,
            medium: None,
            display: ir::Display::default(),
            trees: Vec::new(),
        };
        for surface in &mut scene.surfaces {
            surface.casts_no_shadow = self.chance(5);
        }
        scene.settings.toon = self.chance(6);
        if self.chance(4) {
            scene.settings.ambient = ir::Ambient::Once;
        }
        scene
    }

    fn camera(&mut self) -> ir::Camera {
        let eye = if self.chance(4) {
            self.point(3)
        } else {
            [self.number(2), self.number(2), 8.0]
        };
        let mut center = if self.chance(4) {
            self.point(2)
        } else {
            [0.0, 0.0, 0.0]
        };
        if center == eye {
            center[0] += 1.0;
        }
        let gaze = Vec3::from_array(center) - Vec3::from_array(eye);
        let up = if gaze.x == 0.0 && gaze.z == 0.0 {
            Vec3::Z
        } else {
            Vec3::Y
        };
        let (right, up) = view_basis(gaze, up * self.pick(&[0.1, 0.5, 1.0])).unwrap();
        let lens = ir::Lens {
            radius: self.pick(&[0.0, 0.0, 0.0, 0.5]),
            samples: 1 + self.roll(3),
        };
        let (center, right, up) = (center, right.to_array(), up.to_array());
        ir::Camera {
            eye,
            center,
            right,
            up,
            size: [11, 9],
            lens,
            projection: ir::Projection::Perspective,
        }
    }

    fn settings(&mut self) -> ir::Settings {
        let gooch = ir::Gooch {
            b: 0.55,
            y: 0.3,
            alpha: 0.25,
            beta: self.pick(&[0.0, 0.5]),
        };
        let mode = match self.roll(8) {
            0 => ir::Mode::Depth,
            1 => ir::Mode::Normal,
            2 => ir::Mode::Gooch(gooch),
            _ => ir::Mode::Phong,
        };
        ir::Settings {
            mode,
            shadows: !self.chance(4),
            max_depth: self.pick(&[0, 1, 2, 3]),
            supersampling: self.pick(&[1, 2, 2, 3]),
            pattern: self.pick(&[
                ir::Pattern::Grid,
                ir::Pattern::Grid,
                ir::Pattern::Jitter,
                ir::Pattern::Random,
            ]),
            light_samples: self.pick(&[1, 1, 3]),
            ..ir::Settings::default()
        }
    }

    fn light(&mut self) -> ir::Light {
        let color = self.pick(&[[0.0; 3], [1.0; 3], [1.0, 0.0, 0.5], [0.3, 0.7, 0.2]]);
        let size = self.pick(&[4, 12]);
        ir::Light::Point(ir::PointLight {
            position: self.point(size),
            color,
            radius: self.pick(&[0.0, 0.0, 0.5]),
        })
    }

    fn textures(&mut self) -> (Vec<ir::Image>, Vec<Texture>) {
        let image = |value: &dyn Fn(u8) -> u8| {
            let pixels = (0..12).map(value).collect();
            let (kind, pixels) = (ir::Pixels::Rgb8, pixels);
            ir::Image {
                name: "dice".to_owned(),
                width: 2,
                height: 2,
                kind,
                pixels,
            }
        };
        let images = vec![
            image(&|k| 20 * k),
            image(&|k| [90, 180, 30][usize::from(k) % 3]),
            image(&|_| 0),
        ];
        let image = |k| Texture::Image(ImageId(k));
        (images, vec![image(0), image(1), image(2), Texture::Uv])
    }

    fn map(&mut self) -> Option<TextureId> {
        self.chance(4).then(|| TextureId(self.roll(4)))
    }

    fn phong(&mut self) -> ir::Phong {
        let bump = self.map().map(|texture| ir::Bump {
            texture,
            height: 0.5,
        });
        let phong = ir::Phong {
            color: self.pick(&[[0.0; 3], [1.0, 0.5, 0.2], [0.2, 0.9, 0.7], [1.0; 3]]),
            ka: self.pick(&[0.0, 0.2]),
            kd: self.pick(&[0.0, 0.7]),
            ks: self.pick(&[0.0, 0.0, 0.5]),
            kr: None,
            n: self.pick(&[0.0, 1.0, 8.0]),
            kt: self.pick(&[0.0, 0.0, 0.0, 0.6]),
            fresnel: false,
            ior: self.pick(&[1.0, 1.5]),
            glossy_samples: self.pick(&[1, 1, 2]),
            color_map: self.map(),
            specular_map: self.map(),
            normal_map: self.map(),
            bump,
        };
        let fresnel = phong.kt > 0.0 && phong.n == 8.0;
        phong.fresnel(fresnel)
    }

    /// A tent over the unit square.
    fn mesh(&mut self) -> ir::Mesh {
        let normal = self.pick(&[None, Some([0.0, 0.0, 1.0]), Some([0.0, 0.6, 0.8])]);
        let tilt = self.chance(2);
        let normals = normal.map_or(Vec::new(), |normal| {
            let other = if tilt { [0.6, 0.0, 0.8] } else { normal };
            vec![normal, normal, other, other]
        });
        let uvs = if self.chance(2) {
            vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        } else {
            Vec::new()
        };
        ir::Mesh {
            name: "tent".to_owned(),
            positions: vec![
                [-1.0, -1.0, 0.0],
                [1.0, -1.0, 0.5],
                [1.0, 1.0, 0.0],
                [-1.0, 1.0, 0.5],
            ]
            .into(),
            normals: normals.into(),
            uvs: uvs.into(),
            triangles: vec![[0, 1, 2], [0, 2, 3]].into(),
            ..ir::Mesh::default()
        }
    }

    fn shape(&mut self) -> ir::Shape {
        match self.roll(11) {
            0..=2 => ir::Shape::Sphere(ir::Sphere {
                center: self.point(3),
                radius: self.length(),
                texture_from_world: None,
            }),
            3 => ir::Shape::Plane(ir::Plane {
                center: self.point(4),
                normal: self.axis(),
            }),
            4 => {
                let vertices = [self.point(3), self.point(3), self.point(3)];
                let uvs = self
                    .chance(2)
                    .then_some([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
                ir::Shape::Triangle(ir::Triangle { vertices, uvs })
            }
            5 => self.quad(),
            6 => ir::Shape::Disc(ir::Disc {
                center: self.point(3),
                normal: self.axis(),
                radius: self.length(),
            }),
            7 => {
                let (base, axis, height) = (self.point(3), self.axis(), self.length());
                ir::Shape::Cylinder(ir::Cylinder {
                    base,
                    axis,
                    height,
                    radius: self.length(),
                })
            }
            8 => ir::Shape::Cone(ir::Cone {
                base: self.point(3),
                up: self.axis(),
                radius: self.length(),
            }),
            9 => {
                let (center, axis) = (self.point(3), self.axis());
                ir::Shape::Torus(ir::Torus {
                    center,
                    axis,
                    major: self.length(),
                    minor: self.length() * 0.5,
                })
            }
            _ => {
                let world_from_object = [
                    [1.0, 0.0, 0.0],
                    [0.0, 1.5, 0.5],
                    [0.0, -0.5, 1.0],
                    self.point(3),
                ];
                ir::Shape::Instance(ir::Instance {
                    mesh: MeshId(self.roll(2)),
                    world_from_object,
                })
            }
        }
    }

    /// A parallelogram, or four corners anywhere.
    fn quad(&mut self) -> ir::Shape {
        let [a, b, d] = [self.point(3), self.point(3), self.point(3)];
        let c = if self.chance(3) {
            self.point(3)
        } else {
            [0, 1, 2].map(|k| b[k] + d[k] - a[k])
        };
        ir::Shape::Quad(ir::Quad {
            vertices: [a, b, c, d],
        })
    }
}
