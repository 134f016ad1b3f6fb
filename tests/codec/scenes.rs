//! Scenes of every kind, for the laws: odd numbers, long and short lists and texts.

use proptest::prelude::*;
use rtc::internals::color::Tone;
use rtc::internals::ir::{
    Alpha, Ambient, Bump, Camera, Display, Environment, Filter, Gooch, Image, ImageId, Instance,
    Lens, Light, Map, Material, MaterialId, Medium, Mesh, MeshId, Mode, PathSettings, Pattern,
    Phong, Photometry, Pixels, Plane, PointLight, Procedural, Projection, Punctual, PunctualKind,
    Sampled, Scene, Settings, Shape, Sphere, Standard, StereoView, Surface, Texture, TextureId,
    Triangle, VertexColumn, Wrap,
};

use rtc::internals::math::{GradientNoise, TextureMapping, TexturePattern};

/// Boxed, as the parts of a scene are: what is made of it is too large for the stack of a test
/// otherwise.
fn number() -> BoxedStrategy<f64> {
    let odd = prop::sample::select(vec![
        0.0,
        -0.0,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        -2.2e-308,
        0.1,
        1e22,
        4.0,
    ]);
    prop_oneof![
        odd,
        any::<u64>()
            .prop_map(f64::from_bits)
            .prop_filter("finite", |x| x.is_finite())
    ]
    .boxed()
}

fn triple() -> impl Strategy<Value = [f64; 3]> {
    [number(), number(), number()]
}

fn pair() -> impl Strategy<Value = [f64; 2]> {
    [number(), number()]
}

/// A text with characters of every length, on both sides of what is long.
fn text() -> impl Strategy<Value = String> {
    prop::collection::vec(
        prop::sample::select(vec!['a', '"', 'ü', '\u{1f408}', '\0']),
        0..400,
    )
    .prop_map(|characters| characters.into_iter().collect())
}

fn image() -> impl Strategy<Value = Image> {
    let bytes = prop::collection::vec(any::<u8>(), 0..400);
    (text(), any::<[u32; 2]>(), bytes).prop_map(|(name, [width, height], pixels)| {
        let kind = if width % 2 == 0 {
            Pixels::Rgb8
        } else {
            Pixels::Rgb32f
        };
        Image {
            name,
            width,
            height,
            kind,
            pixels: pixels.into(),
        }
    })
}

/// Numbers within the range of 32-bit floats, some of them below what is normal there.
fn small<const N: usize>(vector: &[f64; N]) -> [f64; N] {
    vector.map(|number| number.clamp(-f64::from(f32::MAX), f64::from(f32::MAX)))
}

/// A mesh with columns of both precisions and lists on both sides of what is long.
fn mesh() -> impl Strategy<Value = Mesh> {
    let list = || prop::collection::vec(triple(), 0..60);
    let uvs = prop::collection::vec(pair(), 0..60);
    let triangles = prop::collection::vec(any::<[u32; 3]>(), 0..60);
    let wide = prop::collection::vec([number(), number(), number(), number()], 0..60);
    (text(), list(), list(), uvs, wide, triangles).prop_map(
        |(name, positions, normals, uvs, tangents, triangles)| {
            let (second_uvs, colors) = (
                VertexColumn::rounded(uvs.iter().map(small)),
                VertexColumn::rounded(tangents.iter().map(small)),
            );
            let has_part = positions.len() > 30;
            let (positions, normals) = (
                positions.into(),
                VertexColumn::rounded(normals.iter().map(small)),
            );
            let (uvs, tangents, triangles) = (uvs.into(), tangents.into(), triangles.into());
            Mesh {
                part: has_part.then(|| name.clone()),
                name,
                positions,
                normals,
                uvs,
                second_uvs,
                tangents,
                colors,
                triangles,
            }
        },
    )
}

fn texture() -> impl Strategy<Value = Texture> {
    let sampled = any::<u32>().prop_map(|image| Sampled {
        image: ImageId(image),
        wrap: [Wrap::Mirror, Wrap::Clamp],
        filter: if image % 2 == 0 {
            Filter::Linear
        } else {
            Filter::Nearest
        },
    });
    let image = any::<u32>().prop_map(|image| Texture::Image(ImageId(image)));
    let pattern = any::<u32>().prop_map(|seed| match seed % 4 {
        0 => TexturePattern::Checker,
        1 => TexturePattern::Stripes,
        2 => TexturePattern::Noise(GradientNoise { seed, octaves: 3 }),
        _ => TexturePattern::Worley { seed },
    });
    let procedural = (pattern, number(), number()).prop_map(|(pattern, channel, scale)| {
        Texture::Procedural(Procedural {
            pattern,
            colors: [[channel; 3], [0.0, 1.0, scale]],
            scale,
            mapping: TextureMapping::World,
        })
    });
    let sampled = sampled.prop_map(Texture::Sampled);
    prop_oneof![Just(Texture::Uv), image, sampled, procedural]
}

fn camera() -> impl Strategy<Value = Camera> {
    let lens = (number(), any::<u32>()).prop_map(|(radius, samples)| Lens { radius, samples });
    (
        triple(),
        triple(),
        triple(),
        triple(),
        any::<[u32; 2]>(),
        lens,
    )
        .prop_map(|(eye, center, right, up, size, lens)| {
            let projection = if size[0] % 2 == 0 {
                Projection::Perspective
            } else {
                Projection::Orthographic
            };
            Camera {
                eye,
                center,
                right,
                up,
                size,
                lens,
                projection,
            }
        })
}

fn settings() -> impl Strategy<Value = Settings> {
    let gooch = [number(), number(), number(), number()]
        .prop_map(|[b, y, alpha, beta]| Mode::Gooch(Gooch { b, y, alpha, beta }));
    let path = any::<u32>().prop_map(|samples| {
        Mode::Path(PathSettings {
            samples,
            multiple_scattering: samples % 2 == 0,
            ..PathSettings::default()
        })
    });
    let mode = prop_oneof![
        Just(Mode::Phong),
        Just(Mode::Depth),
        Just(Mode::Normal),
        gooch,
        path
    ];
    let pattern = prop::sample::select(vec![Pattern::Grid, Pattern::Jitter, Pattern::Random]);
    let ambient = prop::sample::select(vec![Ambient::PerLight, Ambient::Once]);
    let colors = (triple(), prop::option::of(triple()));
    (
        mode,
        any::<bool>(),
        any::<[u32; 3]>(),
        pattern,
        ambient,
        colors,
    )
        .prop_map(
            |(
                mode,
                shadows,
                [max_depth, supersampling, light_samples],
                pattern,
                ambient,
                (ambient_light, background),
            )| Settings {
                mode,
                shadows,
                max_depth,
                supersampling,
                pattern,
                light_samples,
                toon: false,
                ambient,
                ambient_light,
                background,
                stereo: f64::from(max_depth),
                stereo_view: if shadows {
                    StereoView::Anaglyph
                } else {
                    StereoView::SideBySide
                },
                shutter: [ambient_light[0], f64::from(supersampling)],
            },
        )
}

fn light() -> impl Strategy<Value = Light> {
    let point = (triple(), triple(), number()).prop_map(|(position, color, radius)| {
        Light::Point(PointLight {
            position,
            color,
            radius,
        })
    });
    let range = || prop::option::of(number());
    let emitter = prop_oneof![
        triple().prop_map(|direction| PunctualKind::Sun { direction }),
        (triple(), range()).prop_map(|(position, range)| PunctualKind::Point { position, range }),
        (triple(), triple(), pair(), range()).prop_map(
            |(position, direction, [inner_angle, outer_angle], range)| {
                PunctualKind::Spot {
                    position,
                    direction,
                    inner_angle,
                    outer_angle,
                    range,
                }
            }
        ),
    ];
    let list = || prop::collection::vec(number(), 0..4);
    let photometry = (list(), list(), list()).prop_map(|(vertical, horizontal, candela)| {
        Box::new(Photometry {
            name: "lamp.ies".to_owned(),
            vertical,
            horizontal,
            candela,
        })
    });
    let lamp = (triple(), triple(), triple(), photometry).prop_map(
        |(position, direction, horizontal, photometry)| PunctualKind::Photometric {
            position,
            direction,
            horizontal,
            photometry,
        },
    );
    let emitter = prop_oneof![emitter, lamp];
    let punctual = (emitter, triple()).prop_map(|(emitter, intensity)| {
        Light::Punctual(Punctual {
            emitter,
            intensity,
            projected: None,
        })
    });
    prop_oneof![point, punctual]
}

fn environment() -> impl Strategy<Value = Environment> {
    let image = prop::option::of(any::<u32>().prop_map(ImageId));
    (
        triple(),
        image,
        prop::option::of([triple(), triple(), triple()]),
    )
        .prop_map(|(radiance, image, image_from_world)| Environment {
            radiance,
            image,
            image_from_world,
        })
}

fn medium() -> impl Strategy<Value = Medium> {
    (triple(), triple(), number()).prop_map(|(sigma_a, sigma_s, g)| Medium {
        sigma_a,
        sigma_s,
        g,
    })
}

fn display() -> impl Strategy<Value = Display> {
    let tones = vec![Tone::None, Tone::Srgb, Tone::Agx, Tone::PbrNeutral];
    let tone = prop::option::of(prop::sample::select(tones));
    (number(), tone).prop_map(|(exposure, tone)| Display { exposure, tone })
}

/// Materials of glTF with some of the fields other than their defaults.
fn standard() -> impl Strategy<Value = Material> {
    let map = (
        any::<u32>(),
        0..2_u32,
        prop::option::of([triple(), triple()]),
    )
        .prop_map(|(texture, set, texture_from_surface)| Map {
            texture: TextureId(texture),
            set,
            texture_from_surface,
        });
    let alpha = prop_oneof![
        Just(Alpha::Opaque),
        number().prop_map(Alpha::Mask),
        Just(Alpha::Blend)
    ];
    (
        text(),
        triple(),
        prop::option::of(map),
        alpha,
        any::<bool>(),
    )
        .prop_map(
            |(name, [metallic, ior, clearcoat], normal_map, alpha, double_sided)| {
                Material::Standard(Box::new(Standard {
                    name,
                    metallic,
                    ior,
                    clearcoat,
                    normal_map,
                    alpha,
                    double_sided,
                    ..Standard::default()
                }))
            },
        )
}

fn material() -> impl Strategy<Value = Material> {
    prop_oneof![phong(), standard()]
}

fn phong() -> impl Strategy<Value = Material> {
    let map = || prop::option::of(any::<u32>().prop_map(TextureId));
    let bump = prop::option::of((any::<u32>(), number())).prop_map(|bump| {
        bump.map(|(texture, height)| Bump {
            texture: TextureId(texture),
            height,
        })
    });
    (
        triple(),
        triple(),
        triple(),
        any::<u32>(),
        [map(), map(), map()],
        bump,
    )
        .prop_map(
            |(
                color,
                [ka, kd, ks],
                [n, kt, eta],
                glossy_samples,
                [color_map, specular_map, normal_map],
                bump,
            )| {
                Material::Phong(Phong {
                    color,
                    ka,
                    kd,
                    ks,
                    kr: (glossy_samples % 2 == 0).then_some(kd),
                    n,
                    kt,
                    fresnel: glossy_samples % 3 == 0,
                    ior: eta,
                    glossy_samples,
                    color_map,
                    specular_map,
                    normal_map,
                    bump,
                })
            },
        )
}

fn surface() -> impl Strategy<Value = Surface> {
    let shape = prop_oneof![
        (
            triple(),
            number(),
            prop::option::of([triple(), triple(), triple()])
        )
            .prop_map(
                |(center, radius, texture_from_world)| Shape::Sphere(Sphere {
                    center,
                    radius,
                    texture_from_world
                })
            ),
        (triple(), triple()).prop_map(|(center, normal)| Shape::Plane(Plane { center, normal })),
        (
            [triple(), triple(), triple()],
            prop::option::of([pair(), pair(), pair()])
        )
            .prop_map(|(vertices, uvs)| Shape::Triangle(Triangle { vertices, uvs })),
        (any::<u32>(), [triple(), triple(), triple(), triple()]).prop_map(
            |(mesh, world_from_object)| {
                Shape::Instance(Instance {
                    mesh: MeshId(mesh),
                    world_from_object,
                })
            }
        ),
    ];
    (shape, any::<u32>(), any::<bool>(), triple()).prop_map(
        |(shape, material, casts_no_shadow, velocity)| Surface {
            shape,
            material: MaterialId(material),
            casts_no_shadow,
            velocity: velocity.into(),
        },
    )
}

prop_compose! {
    pub(crate) fn scene()(
        camera in camera().boxed(),
        settings in settings().boxed(),
        lights in prop::collection::vec(light(), 0..4).boxed(),
        images in prop::collection::vec(image(), 0..3).boxed(),
        textures in prop::collection::vec(texture(), 0..3).boxed(),
        meshes in prop::collection::vec(mesh(), 0..3).boxed(),
        materials in prop::collection::vec(material(), 0..4).boxed(),
        surfaces in prop::collection::vec(surface(), 0..9).boxed(),
        names in prop::collection::vec(text(), 0..4).boxed(),
        environment in prop::option::of(environment()).boxed(),
        medium in prop::option::of(medium()).boxed(),
        display in display().boxed(),
    ) -> Scene {
        Scene {
            camera, settings, lights, images, textures, meshes, materials, surfaces, names, environment, medium, display,
            trees: Vec::new(),
        }
    }
}
