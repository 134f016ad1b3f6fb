//! The elements of Mitsuba and the plugins that are read, with their parameters by the names of
//! version 3.

use crate::plugin::{DeclaredParameter, PluginKind, parameter as p, plugin};

/// An element.
#[derive(Debug)]
pub(crate) struct Element {
    pub(crate) name: &'static str,
    /// What it is, as a sentence.
    pub(crate) about: &'static str,
    /// The elements in it, beside the parameters of its plugin.
    pub(crate) children: &'static [&'static str],
    /// The plugins that its `type` names.
    pub(crate) kind: Option<&'static PluginKind>,
}

const fn element(
    name: &'static str,
    kind: Option<&'static PluginKind>,
    children: &'static [&'static str],
    about: &'static str,
) -> Element {
    Element { name, about, children, kind }
}

/// The element of a name.
pub(crate) fn find(name: &str) -> Option<&'static Element> {
    ELEMENTS.iter().find(|element| element.name == name)
}

/// The plugins of an element.
pub(crate) fn kind(tag: &str) -> Option<&'static PluginKind> {
    match tag {
        // Colours as plugins.
        "rgb" | "srgb" | "spectrum" => Some(&TEXTURES),
        _ => find(tag)?.kind,
    }
}

/// All elements.
pub(crate) static ELEMENTS: &[Element] = &[
    element("scene", None, &["shape", "bsdf", "emitter", "sensor", "integrator", "texture", "medium", "default", "include", "alias", "path"], "A scene."),
    element("shape", Some(&SHAPES), &["bsdf", "emitter", "ref", "medium", "shape"], "A shape."),
    element("bsdf", Some(&BSDFS), &["bsdf", "texture", "ref"], "The material of a shape."),
    element("emitter", Some(&EMITTERS), &["ref"], "A light."),
    element("sensor", Some(&SENSORS), &["film", "sampler", "medium", "ref"], "A camera."),
    element("film", Some(&FILMS), &["rfilter"], "The size of the picture."),
    element("rfilter", Some(&FILTERS), &[], "The filter of pixels."),
    element("sampler", Some(&SAMPLERS), &[], "The samples of a pixel."),
    element("integrator", Some(&INTEGRATORS), &["integrator"], "How light is computed."),
    element("texture", Some(&TEXTURES), &["ref"], "A texture."),
    element("medium", Some(&MEDIA), &["phase", "ref"], "A participating medium."),
    element("phase", Some(&PHASES), &[], "How a medium scatters."),
    element("volume", Some(&VOLUMES), &[], "A value in space."),
    element("ref", None, &[], "Refers to an element by its `id`."),
    element("default", None, &[], "The value of a parameter `$name`."),
    element("include", None, &[], "Reads the elements of another file."),
    element("alias", None, &[], "Another `id` of an element."),
    element("path", None, &[], "A folder in which files are searched."),
    element("float", None, &[], "A number."),
    element("integer", None, &[], "A whole number."),
    element("boolean", None, &[], "`true` or `false`."),
    element("string", None, &[], "A text."),
    element("point", None, &[], "A point: `x`, `y` and `z`."),
    element("vector", None, &[], "A vector: `x`, `y` and `z`."),
    element("rgb", None, &[], "A colour of linear Rec. 709."),
    element("spectrum", None, &[], "A spectrum: a number, or pairs of a wavelength in nm and a value."),
    element("transform", None, &["translate", "rotate", "scale", "lookat", "matrix"], "Transforms, the first one applied first."),
    element("translate", None, &[], "Moves by `x`, `y` and `z`."),
    element("rotate", None, &[], "Rotates about an axis by an `angle` in degrees."),
    element("scale", None, &[], "Scales by `value`, or by `x`, `y` and `z`."),
    element("lookat", None, &[], "Looks from `origin` to `target`, with `up` upwards."),
    element("matrix", None, &[], "A matrix of 16 numbers, in rows."),
];

/// The types of colours, and of numbers that a texture may vary.
const COLOR: &str = "rgb spectrum texture";
const NUMBER: &str = "float texture";
const DENSITY: &str = "float rgb spectrum volume";
/// The meaning of parameters that change no picture here.
pub(crate) const NONE: &str = "Has no effect.";

const TO_WORLD: &[DeclaredParameter] = &[p("to_world", "transform", "The transform to the world.")];
const ANY_SHAPE: &[DeclaredParameter] = &[
    p("to_world", "transform", "The transform to the world."),
    p("flip_normals", "boolean", "Whether the normals are turned round."),
    p("interior", "medium", "The medium inside."),
    p("exterior", "medium", "The medium outside."),
];
const MESH: &[DeclaredParameter] = &[
    p("filename", "string", "The file."),
    p("face_normals", "boolean", "Whether it is flat between its edges."),
    p("collapse", "boolean", NONE),
    p("load_materials", "boolean", NONE),
];
const FLIP_UV: &[DeclaredParameter] = &[p("flip_tex_coords", "boolean", "Whether v points down in the file.")];
const RADIUS: &[DeclaredParameter] = &[p("radius", "float", "The radius.")];

pub(crate) static SHAPES: PluginKind = PluginKind {
    plugins: &[
        plugin("sphere", "A sphere.", &[&[p("center", "point", "The centre.")], RADIUS, ANY_SHAPE]),
        plugin("rectangle", "A square from −1 to 1 across z.", &[ANY_SHAPE]),
        plugin("cube", "A cube from −1 to 1.", &[ANY_SHAPE]),
        plugin("disk", "A disc of the radius 1 across z.", &[ANY_SHAPE]),
        plugin("cylinder", "A cylinder, open at both ends.", &[&[
            p("p0", "point", "The middle of one end."),
            p("p1", "point", "The middle of the other end."),
        ], RADIUS, ANY_SHAPE]),
        plugin("obj", "The mesh of an OBJ file.", &[MESH, FLIP_UV, ANY_SHAPE]),
        plugin("ply", "The mesh of a PLY file.", &[MESH, FLIP_UV, ANY_SHAPE]),
        plugin("serialized", "A mesh of a file of Mitsuba.", &[MESH, FLIP_UV, &[
            p("shape_index", "integer", "Which mesh of the file, from 0."),
        ], ANY_SHAPE]),
        plugin("shapegroup", "Shapes that instances show.", &[]),
        plugin("instance", "Shows a group of shapes.", &[TO_WORLD]),
    ],
    replaced: &[],
};

const REFLECTANCE: &[DeclaredParameter] = &[p("reflectance", COLOR, "The reflectance.")];
const DIFFUSE: &[DeclaredParameter] = &[p("diffuse_reflectance", COLOR, "The reflectance of the base.")];
const SPECULAR: &[DeclaredParameter] = &[p("specular_reflectance", COLOR, "A factor of the mirror image; left out of glass.")];
const TRANSMITTANCE: &[DeclaredParameter] = &[p("transmittance", COLOR, "A factor of the light that passes through.")];
const IOR: &[DeclaredParameter] = &[
    p("int_ior", "float string", "The index of refraction inside, or a name such as `bk7`."),
    p("ext_ior", "float string", "The index of refraction outside, or a name such as `air`."),
];
const GLASS: &[DeclaredParameter] = &[p("specular_transmittance", COLOR, "A factor of the light that passes through.")];
const METAL: &[DeclaredParameter] = &[
    p("material", "string", "The metal, such as `Au`; `none` is a mirror."),
    p("eta", "rgb spectrum", "The index of refraction."),
    p("k", "rgb spectrum", "The absorption."),
];
const FACETS: &[DeclaredParameter] = &[
    p("alpha", NUMBER, "The width α of the microfacets; 0.1 by default."),
    p("alpha_u", NUMBER, "The width along u."),
    p("alpha_v", NUMBER, "The width along v."),
    p("distribution", "string", "`ggx` or `beckmann`, which is the default."),
    p("sample_visible", "boolean", NONE),
];
/// They turn the polarization, of which light has none here.
const POLARIZATION: &[DeclaredParameter] = &[
    p("theta", NUMBER, NONE),
    p("delta", NUMBER, NONE),
    p("polarizing", "boolean", NONE),
    p("left_handed", "boolean", NONE),
];
const NONLINEAR: &[DeclaredParameter] = &[p("nonlinear", "boolean", "Whether light between the base and the boundary takes its colour each time.")];
const PRINCIPLED: &[DeclaredParameter] = &[
    p("base_color", COLOR, "The base colour."),
    p("roughness", NUMBER, "The roughness, from 0 to 1."),
    p("anisotropic", "float", "The anisotropy, from 0 to 1."),
    p("sheen", "float", "The strength of the sheen, from 0 to 1."),
    p("spec_trans", NUMBER, "The share of light that glass lets through, from 0 to 1."),
    p("eta", "float", "The index of refraction."),
    p("diffuse_reflectance_sampling_rate", "float", NONE),
    p("main_specular_sampling_rate", "float", NONE),
    p("clearcoat_sampling_rate", "float", NONE),
    p("spec_refl_sampling_rate", "float", NONE),
    p("spec_trans_sampling_rate", "float", NONE),
    p("diff_trans_sampling_rate", "float", NONE),
];

pub(crate) static BSDFS: PluginKind = PluginKind {
    plugins: &[
        plugin("diffuse", "A matte surface.", &[REFLECTANCE]),
        plugin("dielectric", "Glass and water.", &[IOR, GLASS, SPECULAR]),
        plugin("roughdielectric", "Rough glass.", &[FACETS, IOR, GLASS, SPECULAR]),
        plugin("thindielectric", "A thin pane of glass.", &[IOR, GLASS, SPECULAR]),
        plugin("conductor", "A metal, or a mirror.", &[METAL, SPECULAR]),
        plugin("roughconductor", "A rough metal.", &[METAL, FACETS, SPECULAR]),
        plugin("plastic", "A matte base under a smooth boundary.", &[DIFFUSE, SPECULAR, IOR, NONLINEAR]),
        plugin("roughplastic", "A matte base under a rough boundary.", &[DIFFUSE, SPECULAR, FACETS, IOR, NONLINEAR]),
        plugin("pplastic", "A matte base under a rough boundary, with polarization.", &[DIFFUSE, SPECULAR, FACETS, IOR]),
        plugin("principled", "Disney's principled material.", &[PRINCIPLED, &[
            p("metallic", NUMBER, "How much of it is a metal, from 0 to 1."),
            p("specular", "float", "The strength of the mirror image, from 0 to 1."),
            p("clearcoat", "float", "The strength of the clear coat, from 0 to 1."),
            p("clearcoat_gloss", "float", "How smooth the clear coat is, from 0 to 1."),
        ]]),
        plugin("principledthin", "Disney's principled material of a thin sheet.", &[PRINCIPLED, &[
            p("diff_trans", NUMBER, "The share of diffuse light that passes through, from 0 to 2."),
        ]]),
        plugin("twosided", "The BSDF inside, on both sides.", &[]),
        plugin("mask", "The BSDF inside, with an opacity.", &[&[p("opacity", NUMBER, "The opacity, from 0 to 1.")]]),
        plugin("normalmap", "The BSDF inside, with a normal map.", &[&[p("normalmap", "texture", "The normal map.")]]),
        plugin("bumpmap", "The BSDF inside, with a texture of heights.", &[&[p("scale", "float", "A factor of the heights.")]]),
        plugin("blendbsdf", "A blend of the two BSDFs inside.", &[&[p("weight", NUMBER, "The share of the second one, from 0 to 1.")]]),
        plugin("null", "No surface: light passes through.", &[]),
        plugin("polarizer", "A filter that lets half of the light through.", &[TRANSMITTANCE, POLARIZATION]),
        plugin("retarder", "A filter that turns the polarization.", &[TRANSMITTANCE, POLARIZATION]),
        plugin("circular", "A filter that lets half of the light through.", &[TRANSMITTANCE, POLARIZATION]),
        plugin("roughdiffuse", "A matte surface, in version 0.", &[REFLECTANCE, &[
            p("alpha", NUMBER, "The roughness, which is left out."),
            p("use_fast_approx", "boolean", NONE),
        ]]),
        plugin("lambertian", "A matte surface, in version 0.", &[REFLECTANCE]),
    ],
    replaced: &["phong", "ward"],
};

const UV: &[DeclaredParameter] = &[
    p("to_uv", "transform", "The transform of the texture coordinates."),
    p("uscale", "float", "A factor of u, in version 0."),
    p("vscale", "float", "A factor of v, in version 0."),
    p("uoffset", "float", "What is added to u, in version 0."),
    p("voffset", "float", "What is added to v, in version 0."),
];
const VALUE: &[DeclaredParameter] = &[p("value", "float rgb spectrum", "The value.")];

pub(crate) static TEXTURES: PluginKind = PluginKind {
    plugins: &[
        plugin("bitmap", "A picture.", &[&[
            p("filename", "string", "The picture."),
            p("wrap_mode", "string", "What is around the picture: `repeat`, `mirror` or `clamp`."),
            p("filter_type", "string", "`bilinear` or `nearest`."),
            p("raw", "boolean", "Whether its numbers are linear, and no colours."),
            p("format", "string", NONE),
            p("accel", "boolean", NONE),
            p("cache", "boolean", NONE),
            p("max_anisotropy", "float", NONE),
        ], UV]),
        plugin("checkerboard", "Squares of two colours.", &[&[
            p("color0", "rgb spectrum float", "One colour; 0.4 by default."),
            p("color1", "rgb spectrum float", "The other colour; 0.2 by default."),
        ], UV]),
        plugin("mesh_attribute", "The colours of a mesh.", &[&[
            p("name", "string", "`vertex_color` or `face_color`."),
            p("scale", "float", "A factor."),
        ]]),
        plugin("uniform", "One value.", &[VALUE]),
        plugin("srgb", "One colour.", &[&[p("color", "rgb", "The colour.")], VALUE]),
        plugin("d65", "Daylight, which is white.", &[&[
            p("color", "rgb", "A colour that it takes."),
            p("scale", "float", "A factor."),
        ]]),
    ],
    replaced: &[],
};

const WEIGHT: &[DeclaredParameter] = &[p("sampling_weight", "float", NONE)];
const INTENSITY: &[DeclaredParameter] = &[p("intensity", "rgb spectrum", "The intensity.")];
const FOV: &[DeclaredParameter] = &[
    p("fov", "float", "The angle of view, in degrees."),
    p("fov_axis", "string", "The axis of the angle: `x`, `y`, `diagonal`, `smaller` or `larger`."),
];
const SKY: &[DeclaredParameter] = &[
    p("turbidity", "float", "The turbidity of the air, from 1 to 10."),
    p("albedo", "rgb spectrum", "The reflectance of the ground."),
    p("sun_direction", "vector", "The direction to the sun."),
    p("sky_scale", "float", "A factor of the light of the sky."),
    p("sun_scale", "float", "A factor of the light of the sun."),
    p("scale", "float", "A factor of both."),
    p("sun_aperture", "float", "The angle across the sun, in degrees; a wider one is shown as a point."),
    p("sun_radius_scale", "float", "A factor of the radius of the sun, in version 0."),
    p("year", "integer", "The year."),
    p("month", "integer", "The month, from 1."),
    p("day", "integer", "The day, from 1."),
    p("hour", "float", "The hour."),
    p("minute", "float", "The minute."),
    p("second", "float", "The second."),
    p("timezone", "float", "The hours from UTC."),
    p("latitude", "float", "The latitude, in degrees."),
    p("longitude", "float", "The longitude, in degrees."),
    p("resolution", "integer", NONE),
    p("complex_sun", "boolean", NONE),
];

pub(crate) static EMITTERS: PluginKind = PluginKind {
    plugins: &[
        plugin("area", "The light of a shape.", &[&[p("radiance", COLOR, "The radiance.")], WEIGHT]),
        plugin("constant", "Light of one colour from all around.", &[&[p("radiance", "rgb spectrum", "The radiance.")], TO_WORLD, WEIGHT]),
        plugin("envmap", "Light from all around, by a picture.", &[&[
            p("filename", "string", "The picture of all directions."),
            p("scale", "float", "A factor of the light."),
            p("mis_compensation", "boolean", NONE),
            p("cache", "boolean", NONE),
        ], TO_WORLD, WEIGHT]),
        plugin("point", "A point that shines into all directions.", &[&[p("position", "point", "The position.")], INTENSITY, TO_WORLD, WEIGHT]),
        plugin("directional", "Parallel light, as of the sun.", &[&[
            p("direction", "vector", "The direction in which it shines."),
            p("irradiance", "rgb spectrum", "The irradiance."),
        ], TO_WORLD, WEIGHT]),
        plugin("spot", "A cone of light along z.", &[INTENSITY, &[
            p("cutoff_angle", "float", "The angle of the cone from its axis, in degrees."),
            p("beam_width", "float", "The angle of full light from the axis, in degrees."),
            p("texture", "texture", "A picture that it projects."),
        ], TO_WORLD, WEIGHT]),
        plugin("projector", "A picture that is projected along z.", &[&[
            p("irradiance", COLOR, "The picture."),
            p("scale", "float", "A factor of the light."),
        ], FOV, TO_WORLD, WEIGHT]),
        plugin("sunsky", "The sun and the sky.", &[SKY, TO_WORLD, WEIGHT]),
        plugin("sky", "The sky.", &[SKY, TO_WORLD, WEIGHT]),
        plugin("sun", "The sun.", &[SKY, TO_WORLD, WEIGHT]),
    ],
    replaced: &[],
};

const ANY_SENSOR: &[DeclaredParameter] = &[
    p("to_world", "transform", "The transform to the world; it looks along z."),
    p("near_clip", "float", "What is nearer is hidden in Mitsuba; it is shown."),
    p("far_clip", "float", "What is farther is hidden in Mitsuba; it is shown."),
    p("shutter_open", "float", NONE),
    p("shutter_close", "float", NONE),
];
const VIEW: &[DeclaredParameter] = &[
    p("fov", "float", "The angle of view, in degrees."),
    p("fov_axis", "string", "The axis of the angle: `x`, `y`, `diagonal`, `smaller` or `larger`."),
    p("focal_length", "string", "The focal length of 35 mm film, as `50mm`."),
    p("focus_distance", "float", "The distance that is in focus."),
];

pub(crate) static SENSORS: PluginKind = PluginKind {
    plugins: &[
        plugin("perspective", "A perspective camera.", &[VIEW, &[
            p("principal_point_offset_x", "float", "The offset of the middle, in widths of the picture."),
            p("principal_point_offset_y", "float", "The offset of the middle, in heights of the picture."),
        ], ANY_SENSOR]),
        plugin("thinlens", "A perspective camera with a lens.", &[VIEW, &[
            p("aperture_radius", "float", "The radius of the lens."),
        ], ANY_SENSOR]),
        plugin("orthographic", "A camera of parallel rays.", &[ANY_SENSOR]),
    ],
    replaced: &[],
};

const SIZE: &[DeclaredParameter] = &[
    p("width", "integer", "The width in pixels."),
    p("height", "integer", "The height in pixels."),
    p("crop_offset_x", "integer", "The first column that is shown."),
    p("crop_offset_y", "integer", "The first row that is shown."),
    p("crop_width", "integer", "The columns that are shown."),
    p("crop_height", "integer", "The rows that are shown."),
    p("file_format", "string", NONE),
    p("pixel_format", "string", NONE),
    p("component_format", "string", NONE),
    p("sample_border", "boolean", NONE),
    p("compensate", "boolean", NONE),
    p("high_quality_edges", "boolean", NONE),
    p("banner", "boolean", NONE),
    p("attach_log", "boolean", NONE),
];

/// The reader takes any film and any sampler.
pub(crate) static FILMS: PluginKind = PluginKind {
    plugins: &[
        plugin("hdrfilm", "A picture.", &[SIZE]),
        plugin("ldrfilm", "A picture of 8 bits, in version 0.", &[SIZE]),
        plugin("specfilm", "A picture; its spectra are left out.", &[SIZE]),
    ],
    replaced: &[],
};

const COUNT: &[DeclaredParameter] = &[
    p("sample_count", "integer", "The samples of a pixel."),
    p("seed", "integer", NONE),
    p("jitter", "boolean", NONE),
    p("dimension", "integer", NONE),
    p("scramble", "integer boolean", NONE),
];

pub(crate) static SAMPLERS: PluginKind = PluginKind {
    plugins: &[
        plugin("independent", "Random points.", &[COUNT]),
        plugin("stratified", "Points in the cells of a grid.", &[COUNT]),
        plugin("multijitter", "Multi-jittered points.", &[COUNT]),
        plugin("orthogonal", "Points of an orthogonal array.", &[COUNT]),
        plugin("ldsampler", "A (0, 2)-sequence.", &[COUNT]),
    ],
    replaced: &[],
};

const FILTER_RADIUS: &[DeclaredParameter] = &[p("radius", "float", "The radius, in pixels.")];

pub(crate) static FILTERS: PluginKind = PluginKind {
    plugins: &[
        plugin("gaussian", "A Gaussian.", &[&[p("stddev", "float", "Its standard deviation, in pixels.")]]),
        plugin("box", "The mean.", &[FILTER_RADIUS]),
        plugin("tent", "A tent.", &[FILTER_RADIUS]),
        plugin("mitchell", "The filter of Mitchell and Netravali.", &[&[
            p("A", "float", "Its first parameter; 1/3 by default."),
            p("B", "float", "Its second parameter; 1/3 by default. In version 0 the first one."),
            p("C", "float", "Its second parameter, in version 0."),
        ]]),
        plugin("catmullrom", "The filter of Catmull and Rom.", &[]),
        plugin("lanczos", "A windowed sinc.", &[&[p("lobes", "float", "The lobes of its window.")]]),
    ],
    replaced: &[],
};

const HIDING: &[DeclaredParameter] = &[
    p("hide_emitters", "boolean", "Whether the camera sees no lights; it sees them."),
    p("block_size", "integer", NONE),
    p("samples_per_pass", "integer", NONE),
    p("timeout", "float", NONE),
];
const DEPTH: &[DeclaredParameter] = &[
    p("max_depth", "integer", "The most edges of a path; −1 for any number."),
    p("rr_depth", "integer", NONE),
    p("strict_normals", "boolean", NONE),
];

pub(crate) static INTEGRATORS: PluginKind = PluginKind {
    plugins: &[
        plugin("path", "Path tracing.", &[DEPTH, HIDING]),
        plugin("volpath", "Path tracing with participating media.", &[DEPTH, HIDING]),
        plugin("direct", "Direct light.", &[HIDING, &[
            p("shading_samples", "integer", NONE),
            p("emitter_samples", "integer", NONE),
            p("bsdf_samples", "integer", NONE),
        ]]),
        plugin("volpathmis", "Path tracing with participating media.", &[DEPTH, HIDING]),
        plugin("prb", "Path tracing.", &[DEPTH, HIDING]),
        plugin("volpath_simple", "Path tracing with participating media, in version 0.", &[DEPTH, HIDING]),
    ],
    replaced: &["moment", "aov", "stokes"],
};

const MEDIUM: &[DeclaredParameter] = &[
    p("albedo", DENSITY, "The share of light that is scattered; 0.75 by default."),
    p("sigma_t", DENSITY, "The coefficient of extinction; 1 by default."),
    p("scale", "float", "A factor of the coefficients."),
    p("density", DENSITY, "The coefficient of extinction, in version 0."),
    p("sigma_a", "rgb spectrum", "The coefficient of absorption, in version 0."),
    p("sigma_s", "rgb spectrum", "The coefficient of scattering, in version 0."),
    p("material", "string", "A measured medium, which the default replaces."),
    p("sample_emitters", "boolean", NONE),
    p("has_spectral_extinction", "boolean", NONE),
    p("majorant_resolution_factor", "integer", NONE),
    p("majorant_factor", "float", NONE),
];

pub(crate) static MEDIA: PluginKind = PluginKind {
    plugins: &[
        plugin("homogeneous", "A medium of one density.", &[MEDIUM]),
        plugin("heterogeneous", "A medium whose volumes are constant.", &[MEDIUM]),
    ],
    replaced: &[],
};

pub(crate) static PHASES: PluginKind = PluginKind {
    plugins: &[
        plugin("isotropic", "Equal into all directions.", &[]),
        plugin("hg", "The phase function of Henyey and Greenstein.", &[&[
            p("g", "float", "The mean cosine, from −1 to 1; 0.8 by default."),
        ]]),
    ],
    replaced: &[],
};

pub(crate) static VOLUMES: PluginKind = PluginKind {
    plugins: &[plugin("constvolume", "One value.", &[VALUE])],
    replaced: &["gridvolume"],
};
