//! The directives of pbrt and the plugins that are read, with their parameters.

use crate::plugin::{DeclaredParameter, PluginKind, parameter as p, plugin};

/// A directive.
#[derive(Debug)]
pub(crate) struct Directive {
    pub(crate) name: &'static str,
    /// What it does, as a sentence.
    pub(crate) about: &'static str,
    /// The strings that follow.
    pub(crate) arguments: &'static [Argument],
    /// The plugins whose parameters follow the arguments.
    pub(crate) kind: Option<&'static PluginKind>,
}

/// A string that follows a directive.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Argument {
    /// A new name, or one of a file.
    Free,
    /// The plugin.
    Plugin,
    /// One of these words.
    Word(&'static [&'static str]),
    /// A name that the first argument of another directive made.
    MadeBy(&'static str),
}

const fn directive(
    name: &'static str,
    arguments: &'static [Argument],
    kind: Option<&'static PluginKind>,
    about: &'static str,
) -> Directive {
    Directive {
        name,
        about,
        arguments,
        kind,
    }
}

const PLUGIN: &[Argument] = &[Argument::Plugin];
const FREE: &[Argument] = &[Argument::Free];
const TEXTURE: &[Argument] = &[
    Argument::Free,
    Argument::Word(&["spectrum", "float"]),
    Argument::Plugin,
];

/// The kinds of plugins that `Attribute` gives defaults to, and their words.
pub(crate) static TARGETS: [(&str, &PluginKind); 4] = [
    ("shape", &SHAPES),
    ("light", &LIGHTS),
    ("material", &MATERIALS),
    ("texture", &TEXTURES),
];

/// The directives of versions 3 and 4.
pub(crate) static DIRECTIVES: &[Directive] = &[
    directive("Accelerator", PLUGIN, Some(&ACCELERATORS), "How rays find surfaces; has no effect."),
    directive("ActiveTransform", &[], None, "Which transforms of a motion change: `StartTime`, `EndTime`, `All`."),
    directive("AreaLightSource", PLUGIN, Some(&AREA_LIGHTS), "The light of the shapes that follow."),
    directive("Attribute", &[Argument::Word(&["shape", "light", "material", "texture"])], None, "Parameters of all plugins of a kind that follow."),
    directive("AttributeBegin", &[], None, "Saves the graphics state."),
    directive("AttributeEnd", &[], None, "Restores the graphics state."),
    directive("Camera", PLUGIN, Some(&CAMERAS), "The camera, at the current transform."),
    directive("ColorSpace", &[Argument::Word(&["srgb"])], None, "The colour space of RGB values."),
    directive("ConcatTransform", &[], None, "Multiplies the transform by a matrix of 16 numbers, in columns."),
    directive("CoordinateSystem", FREE, None, "Names the current transform."),
    directive("CoordSysTransform", &[Argument::MadeBy("CoordinateSystem")], None, "Makes a named transform the current one."),
    directive("Film", PLUGIN, Some(&FILMS), "The size of the picture and its exposure."),
    directive("Identity", &[], None, "Makes the transform the identity."),
    directive("Import", FREE, None, "Reads a file; its graphics state ends with it."),
    directive("Include", FREE, None, "Reads a file as if it stood here."),
    directive("Integrator", PLUGIN, Some(&INTEGRATORS), "How light is computed."),
    directive("LightSource", PLUGIN, Some(&LIGHTS), "A light."),
    directive("LookAt", &[], None, "The eye, a point it looks at, and the direction up: 9 numbers."),
    directive("MakeNamedMaterial", FREE, Some(&MATERIALS), "A material with a name; `type` is its plugin."),
    directive("MakeNamedMedium", FREE, Some(&MEDIA), "A participating medium with a name; `type` is its plugin."),
    directive("Material", PLUGIN, Some(&MATERIALS), "The material of the shapes that follow."),
    directive("MediumInterface", &[Argument::MadeBy("MakeNamedMedium"); 2], None, "The media inside and outside of the shapes that follow."),
    directive("NamedMaterial", &[Argument::MadeBy("MakeNamedMaterial")], None, "Makes a named material the current one."),
    directive("ObjectBegin", FREE, None, "Begins an object that instances show."),
    directive("ObjectEnd", &[], None, "Ends an object."),
    directive("ObjectInstance", &[Argument::MadeBy("ObjectBegin")], None, "Shows an object at the current transform."),
    directive("Option", &[], None, "An option; has no effect."),
    directive("PixelFilter", PLUGIN, Some(&FILTERS), "The filter of pixels."),
    directive("ReverseOrientation", &[], None, "Turns the normals of the shapes that follow."),
    directive("Rotate", &[], None, "Rotates: an angle in degrees and an axis."),
    directive("Sampler", PLUGIN, Some(&SAMPLERS), "The samples of a pixel."),
    directive("Scale", &[], None, "Scales along x, y and z."),
    directive("Shape", PLUGIN, Some(&SHAPES), "A shape at the current transform."),
    directive("SurfaceIntegrator", PLUGIN, Some(&INTEGRATORS), "How light is computed, in version 3."),
    directive("Texture", TEXTURE, Some(&TEXTURES), "A texture: its name, its type and its plugin."),
    directive("Transform", &[], None, "Makes a matrix of 16 numbers, in columns, the transform."),
    directive("TransformBegin", &[], None, "Saves the transform."),
    directive("TransformEnd", &[], None, "Restores the transform."),
    directive("TransformTimes", &[], None, "The start and the end of a motion."),
    directive("Translate", &[], None, "Moves along x, y and z."),
    directive("VolumeIntegrator", FREE, None, "How light in media is computed; has no effect."),
    directive("WorldBegin", &[], None, "Begins the world, after the camera."),
    directive("WorldEnd", &[], None, "Ends the world, in version 3."),
    directive("Renderer", FREE, None, "The renderer; has no effect."),
];

/// The types of colours, of numbers that a texture may vary, and of emitted light.
const COLOR: &str = "rgb spectrum texture";
const NUMBER: &str = "float texture";
const LIGHT: &str = "rgb spectrum blackbody";
/// The meaning of parameters that change no picture here.
const NONE: &str = "Has no effect.";
const OLD: &str = "An older name.";

const NO_PARAMETERS: &[&[DeclaredParameter]] = &[];

const ANY_SHAPE: &[DeclaredParameter] = &[
    p("alpha", NUMBER, "The opacity; a texture cuts holes."),
    p("shadowalpha", NUMBER, NONE),
];
const RADIUS: &[DeclaredParameter] = &[p("radius", "float", "The radius.")];
const PHI_MAX: &[DeclaredParameter] = &[p("phimax", "float", "How far the shape turns about z, in degrees; 360 is a whole turn.")];
const Z_RANGE: &[DeclaredParameter] = &[
    p("zmin", "float", "The lower end along z."),
    p("zmax", "float", "The upper end along z."),
];
const HEIGHT: &[DeclaredParameter] = &[p("height", "float", "The height along z.")];
const VERTICES: &[DeclaredParameter] = &[
    p("P", "point3", "The positions of the vertices."),
    p("indices", "integer", "The vertices of each face."),
];
const VERTEX_VALUES: &[DeclaredParameter] = &[
    p("N", "normal3", "The normals of the vertices."),
    p("uv", "point2", "The texture coordinates of the vertices."),
    p("faceIndices", "integer", NONE),
];
const DEGENERATE: &[DeclaredParameter] = &[p("discarddegenerateUVs", "bool", NONE)];

pub(crate) static SHAPES: PluginKind = PluginKind {
    plugins: &[
        plugin("sphere", "A sphere about the origin, or a part of it.", &[RADIUS, Z_RANGE, PHI_MAX, ANY_SHAPE]),
        plugin("disk", "A disc across z, or a ring.", &[RADIUS, HEIGHT, &[
            p("innerradius", "float", "The radius of the hole."),
        ], PHI_MAX, ANY_SHAPE]),
        plugin("cylinder", "A cylinder about z, open at both ends.", &[RADIUS, Z_RANGE, PHI_MAX, ANY_SHAPE]),
        plugin("trianglemesh", "Triangles with common vertices.", &[VERTICES, VERTEX_VALUES, DEGENERATE, &[
            p("S", "vector3", NONE),
            p("st", "point2", OLD),
        ], ANY_SHAPE]),
        plugin("plymesh", "The mesh of a PLY file.", &[&[
            p("filename", "string", "The file."),
            p("displacement", "texture", "A displacement, which is left out."),
            p("edgelength", "float", NONE),
        ], DEGENERATE, ANY_SHAPE]),
        plugin("bilinearmesh", "Bilinear patches with common vertices.", &[VERTICES, VERTEX_VALUES, &[
            p("emissionfilename", "string", "The picture of an area light, which is left out."),
        ], ANY_SHAPE]),
        plugin("loopsubdiv", "A mesh that Loop's rule subdivides.", &[VERTICES, &[
            p("levels", "integer", "How often it is subdivided; 3 by default."),
            p("nlevels", "integer", OLD),
            p("scheme", "string", NONE),
        ], ANY_SHAPE]),
        plugin("cone", "A cone about z.", &[RADIUS, HEIGHT, PHI_MAX, ANY_SHAPE]),
        plugin("paraboloid", "A paraboloid about z.", &[RADIUS, Z_RANGE, PHI_MAX, ANY_SHAPE]),
        plugin("hyperboloid", "A line that turns about z.", &[&[
            p("p1", "point3", "One end of the line."),
            p("p2", "point3", "The other end of the line."),
        ], PHI_MAX, ANY_SHAPE]),
    ],
    replaced: &[],
};

const ANY_MATERIAL: &[DeclaredParameter] = &[
    p("displacement", NUMBER, "A texture of heights."),
    p("normalmap", "string", "The picture of a normal map."),
    p("bumpmap", NUMBER, OLD),
    p("type", "string", "The plugin of a named material."),
];
const TYPE: &[DeclaredParameter] = &[p("type", "string", "The plugin of a named material.")];
const ROUGH: &[DeclaredParameter] = &[
    p("roughness", NUMBER, "The roughness in all directions; 0 is smooth."),
    p("uroughness", NUMBER, "The roughness along u."),
    p("vroughness", NUMBER, "The roughness along v."),
];
const REMAP: &[DeclaredParameter] = &[p("remaproughness", "bool", "Whether the width of microfacets is the root of the roughness; true by default.")];
const REFLECTANCE: &[DeclaredParameter] = &[p("reflectance", COLOR, "The reflectance.")];
const KD: &[DeclaredParameter] = &[p("Kd", COLOR, "The diffuse reflectance.")];
const KS: &[DeclaredParameter] = &[p("Ks", COLOR, "The specular reflectance.")];
const KR: &[DeclaredParameter] = &[p("Kr", COLOR, "The reflectance of the mirror image.")];
const KT: &[DeclaredParameter] = &[p("Kt", COLOR, "The transmittance.")];
const INDEX: &[DeclaredParameter] = &[
    p("eta", "float spectrum", "The index of refraction."),
    p("index", "float", OLD),
];
const METAL: &[DeclaredParameter] = &[
    p("eta", "spectrum rgb", "The index of refraction, as `metal-Cu-eta`."),
    p("k", "spectrum rgb", "The absorption, as `metal-Cu-k`."),
];
const LAYERS: &[DeclaredParameter] = &[
    p("thickness", "float", NONE),
    p("maxdepth", "integer", NONE),
    p("nsamples", "integer", NONE),
    p("albedo", COLOR, NONE),
    p("g", "float", NONE),
];

pub(crate) static MATERIALS: PluginKind = PluginKind {
    plugins: &[
        plugin("diffuse", "A matte surface.", &[REFLECTANCE, ANY_MATERIAL]),
        plugin("coateddiffuse", "A matte surface under a clear coat.", &[REFLECTANCE, ROUGH, REMAP, INDEX, LAYERS, ANY_MATERIAL]),
        plugin("conductor", "A metal.", &[METAL, REFLECTANCE, ROUGH, REMAP, ANY_MATERIAL, &[p("Kr", COLOR, NONE)]]),
        plugin("coatedconductor", "A metal under a clear coat.", &[&[
            p("conductor.eta", "spectrum rgb", "The index of refraction of the metal, as `metal-Cu-eta`."),
            p("conductor.k", "spectrum rgb", "The absorption of the metal, as `metal-Cu-k`."),
            p("conductor.roughness", NUMBER, "The roughness of the metal."),
            p("conductor.uroughness", NUMBER, "The roughness of the metal along u."),
            p("conductor.vroughness", NUMBER, "The roughness of the metal along v."),
            p("interface.roughness", NUMBER, "The roughness of the coat."),
            p("interface.uroughness", NUMBER, "The roughness of the coat along u."),
            p("interface.vroughness", NUMBER, "The roughness of the coat along v."),
            p("interface.eta", "float spectrum", NONE),
        ], REFLECTANCE, REMAP, LAYERS, ANY_MATERIAL]),
        plugin("dielectric", "Glass and water.", &[INDEX, ROUGH, REMAP, ANY_MATERIAL]),
        plugin("thindielectric", "A thin pane of glass.", &[INDEX, ROUGH, REMAP, ANY_MATERIAL]),
        plugin("diffusetransmission", "A matte sheet that light passes through.", &[REFLECTANCE, &[
            p("transmittance", COLOR, "The share of light that passes through."),
            p("scale", "float", "A factor of both shares."),
        ], ANY_MATERIAL]),
        plugin("mix", "Two materials in one.", &[&[
            p("materials", "string", "The names of the two materials."),
            p("amount", NUMBER, "The share of the second one."),
            p("namedmaterial1", "string", OLD),
            p("namedmaterial2", "string", OLD),
        ], ANY_MATERIAL]),
        plugin("interface", "No surface: light passes through.", &[TYPE]),
        plugin("none", "No surface, in version 3.", &[TYPE]),
        plugin("matte", "A matte surface, in version 3.", &[KD, &[
            p("sigma", NUMBER, "The roughness, which is left out."),
        ], ANY_MATERIAL]),
        plugin("mirror", "A mirror, in version 3.", &[KR, ANY_MATERIAL]),
        plugin("metal", "A metal, in version 3.", &[METAL, ROUGH, REMAP, REFLECTANCE, ANY_MATERIAL, &[p("Kr", COLOR, NONE)]]),
        plugin("plastic", "Plastic, in version 3.", &[KD, KS, ROUGH, REMAP, ANY_MATERIAL]),
        plugin("uber", "Plastic with a mirror and opacity, in version 3.", &[KD, KS, KR, KT, ROUGH, REMAP, INDEX, &[
            p("opacity", COLOR, "The opacity."),
        ], ANY_MATERIAL]),
        plugin("substrate", "A matte surface under a glossy one, in version 3.", &[KD, KS, ROUGH, REMAP, ANY_MATERIAL]),
        plugin("glass", "Glass, in version 3.", &[KR, KT, INDEX, ROUGH, REMAP, ANY_MATERIAL]),
        plugin("translucent", "A matte sheet that light passes through, in version 3.", &[KD, &[
            p("Ks", COLOR, NONE),
            p("reflect", COLOR, "The share of light that is reflected."),
            p("transmit", COLOR, "The share of light that passes through."),
            p("roughness", NUMBER, NONE),
            p("remaproughness", "bool", NONE),
        ], ANY_MATERIAL]),
        plugin("disney", "Disney's principled material.", &[&[
            p("color", COLOR, "The base colour."),
            p("metallic", NUMBER, "How much of it is a metal, from 0 to 1."),
            p("roughness", NUMBER, "The roughness, from 0 to 1."),
            p("clearcoat", NUMBER, "The strength of the clear coat, from 0 to 1."),
            p("clearcoatgloss", NUMBER, "How smooth the clear coat is, from 0 to 1."),
            p("anisotropic", NUMBER, "The anisotropy, from 0 to 1."),
            p("sheen", NUMBER, "The strength of the sheen, from 0 to 1."),
            p("spectrans", NUMBER, "The share of light that glass lets through, from 0 to 1."),
            p("difftrans", NUMBER, "The share of diffuse light that passes through, from 0 to 2."),
        ], INDEX, ANY_MATERIAL]),
    ],
    replaced: &["", "subsurface", "kdsubsurface", "hair", "measured", "fourier"],
};

const TWO_TEXTURES: &[DeclaredParameter] = &[
    p("tex1", "rgb spectrum float texture", "The first one."),
    p("tex2", "rgb spectrum float texture", "The second one."),
];
const MAPPING: &[DeclaredParameter] = &[
    p("mapping", "string", "`uv`; others show the mean of the texture."),
    p("uscale", "float", "A factor of u."),
    p("vscale", "float", "A factor of v."),
    p("udelta", "float", "What is added to u."),
    p("vdelta", "float", "What is added to v."),
    p("v1", "vector3", NONE),
    p("v2", "vector3", NONE),
];

pub(crate) static TEXTURES: PluginKind = PluginKind {
    plugins: &[
        plugin("imagemap", "A picture.", &[&[
            p("filename", "string", "The picture."),
            p("wrap", "string", "What is around the picture: `repeat` or `clamp`."),
            p("filter", "string", "`bilinear`, or `point` for the nearest texel."),
            p("encoding", "string", "The encoding of 8-bit pictures: `sRGB` or `linear`."),
            p("scale", "float", "A factor of the texels."),
            p("invert", "bool", "Whether a texel t counts as 1 − t."),
            p("gamma", "bool", OLD),
            p("trilinear", "bool", NONE),
            p("maxanisotropy", "float", NONE),
            p("noiseaware", "bool", NONE),
        ], MAPPING]),
        plugin("checkerboard", "Squares of two colours.", &[TWO_TEXTURES, &[
            p("dimension", "integer", "2; one in space, 3, is shown as its mean."),
            p("aamode", "string", NONE),
        ], MAPPING]),
        plugin("constant", "One value.", &[&[
            p("value", "rgb spectrum float", "The value."),
        ]]),
        plugin("scale", "The product of two textures.", &[&[
            p("tex", "texture rgb spectrum float", "The texture."),
            p("scale", "float texture", "The factor."),
        ], TWO_TEXTURES]),
        plugin("mix", "A mix of two textures.", &[TWO_TEXTURES, &[
            p("amount", NUMBER, "The share of the second one."),
        ]]),
    ],
    replaced: &[],
};

const ANY_LIGHT: &[DeclaredParameter] = &[
    p("scale", "float", "A factor of the light."),
    p("samples", "integer", NONE),
    p("nsamples", "integer", NONE),
];
const INTENSITY: &[DeclaredParameter] = &[
    p("I", LIGHT, "The intensity."),
    p("power", "float", "The power of all its light, in watts."),
    p("from", "point3", "The position."),
];
const RADIANCE: &[DeclaredParameter] = &[p("L", LIGHT, "The radiance.")];
const TO: &[DeclaredParameter] = &[p("to", "point3", "The point that it shines at.")];
const ENVIRONMENT: &[DeclaredParameter] = &[
    p("filename", "string", "The picture of all directions."),
    p("mapname", "string", OLD),
    p("portal", "point3", "The corners of a portal, which is left out."),
];
const ILLUMINANCE: &[DeclaredParameter] = &[p("illuminance", "float", "The illuminance, in lux.")];

pub(crate) static LIGHTS: PluginKind = PluginKind {
    plugins: &[
        plugin("point", "A point that shines into all directions.", &[INTENSITY, ANY_LIGHT]),
        plugin("spot", "A cone of light.", &[INTENSITY, TO, &[
            p("coneangle", "float", "The angle of the cone from its axis, in degrees."),
            p("conedeltaangle", "float", "The width of its soft edge, in degrees."),
        ], ANY_LIGHT]),
        plugin("distant", "Parallel light, as of the sun.", &[RADIANCE, &[
            p("from", "point3", "A point that the light comes from."),
        ], TO, ILLUMINANCE, ANY_LIGHT]),
        plugin("infinite", "Light from all around.", &[RADIANCE, ENVIRONMENT, ILLUMINANCE, ANY_LIGHT]),
        plugin("exinfinite", "Light from all around, in version 3.", &[RADIANCE, ENVIRONMENT, ILLUMINANCE, ANY_LIGHT]),
    ],
    replaced: &["goniometric", "projection"],
};

const AREA_LIGHT: &[DeclaredParameter] = &[
    p("power", "float", "The power of all its light, in watts."),
    p("twosided", "bool", "Whether both sides shine."),
    p("filename", "string", "The picture of the light, which is left out."),
];

pub(crate) static AREA_LIGHTS: PluginKind = PluginKind {
    plugins: &[
        plugin("diffuse", "A surface that shines.", &[RADIANCE, AREA_LIGHT, ANY_LIGHT]),
        plugin("area", "A surface that shines, in version 3.", &[RADIANCE, AREA_LIGHT, ANY_LIGHT]),
    ],
    replaced: &[],
};

const ANY_CAMERA: &[DeclaredParameter] = &[
    p("screenwindow", "float", "The bounds of the screen: left, right, bottom, top."),
    p("frameaspectratio", "float", "The width of the screen over its height."),
    p("shutteropen", "float", "The time at which the shutter opens."),
    p("shutterclose", "float", "The time at which the shutter closes."),
];

pub(crate) static CAMERAS: PluginKind = PluginKind {
    plugins: &[
        plugin("perspective", "A perspective camera, with a lens if it has a radius.", &[&[
            p("fov", "float", "The angle of view across the shorter side, in degrees."),
            p("lensradius", "float", "The radius of the lens."),
            p("focaldistance", "float", "The distance that is in focus."),
            p("halffov", "float", "Half of the angle of view, in degrees."),
        ], ANY_CAMERA]),
        plugin("orthographic", "A camera of parallel rays.", &[ANY_CAMERA]),
    ],
    replaced: &[],
};

const FILM: &[DeclaredParameter] = &[
    p("xresolution", "integer", "The width in pixels."),
    p("yresolution", "integer", "The height in pixels."),
    p("filename", "string", NONE),
    p("cropwindow", "float", "The part that is shown: x0, x1, y0, y1 from 0 to 1."),
    p("pixelbounds", "integer", "The part that is shown: x0, x1, y0, y1 in pixels."),
    p("iso", "float", "The sensitivity of the sensor; 100 by default."),
    p("scale", "float", "A factor of all light."),
    p("sensor", "string", "`cie1931`, which replaces others."),
    p("diagonal", "float", NONE),
    p("savefp16", "bool", NONE),
    p("maxsampleluminance", "float", "The most luminance of a sample, which is left out."),
    p("maxcomponentvalue", "float", "The most of a channel of a sample, which is left out."),
];

pub(crate) static FILMS: PluginKind = PluginKind {
    plugins: &[
        plugin("rgb", "A picture of RGB.", &[FILM]),
        plugin("gbuffer", "A picture of RGB; its layers are left out.", &[FILM]),
        plugin("spectral", "A picture of RGB; its spectra are left out.", &[FILM]),
        plugin("image", "A picture, in version 3.", &[FILM]),
    ],
    replaced: &[],
};

const SAMPLER: &[DeclaredParameter] = &[
    p("pixelsamples", "integer", "The samples of a pixel."),
    p("seed", "integer", NONE),
    p("randomization", "string", NONE),
    p("jitter", "bool", NONE),
    p("dimensions", "integer", NONE),
    p("scramble", "bool", NONE),
    p("samplepixelcenter", "bool", NONE),
];

/// The reader takes any sampler: they differ in their noise alone.
pub(crate) static SAMPLERS: PluginKind = PluginKind {
    plugins: &[
        plugin("zsobol", "Sobol's points in the order of a Morton curve.", &[SAMPLER]),
        plugin("halton", "Halton's points.", &[SAMPLER]),
        plugin("independent", "Random points.", &[SAMPLER]),
        plugin("paddedsobol", "Sobol's points, padded.", &[SAMPLER]),
        plugin("pmj02bn", "Multi-jittered points with blue noise.", &[SAMPLER]),
        plugin("sobol", "Sobol's points.", &[SAMPLER]),
        plugin("stratified", "Points in the cells of a grid.", &[&[
            p("xsamples", "integer", "The cells along x."),
            p("ysamples", "integer", "The cells along y."),
        ], SAMPLER]),
        plugin("random", "Random points, in version 3.", &[SAMPLER]),
        plugin("02sequence", "A (0, 2)-sequence, in version 3.", &[SAMPLER]),
        plugin("lowdiscrepancy", "A (0, 2)-sequence, in version 3.", &[SAMPLER]),
        plugin("maxmindist", "Points far from each other, in version 3.", &[SAMPLER]),
    ],
    replaced: &[],
};

const DEPTH: &[DeclaredParameter] = &[p("maxdepth", "integer", "The most bounces of a path; 5 by default.")];

pub(crate) static INTEGRATORS: PluginKind = PluginKind {
    plugins: &[
        plugin("volpath", "Path tracing with participating media.", &[DEPTH]),
        plugin("path", "Path tracing.", &[DEPTH]),
        plugin("simplepath", "Path tracing.", &[DEPTH]),
        plugin("directlighting", "Direct light; all light is shown.", &[DEPTH]),
        plugin("whitted", "Direct light and mirrors; all light is shown.", &[DEPTH]),
    ],
    replaced: &[
        "bdpt", "mlt", "sppm", "lightpath", "photonmap", "exphotonmap", "igi", "irradiancecache",
    ],
};

const WIDTHS: &[DeclaredParameter] = &[
    p("xradius", "float", "The radius along x, in pixels."),
    p("yradius", "float", "The radius along y, in pixels."),
    p("xwidth", "float", "The radius along x, in version 3."),
    p("ywidth", "float", "The radius along y, in version 3."),
];

pub(crate) static FILTERS: PluginKind = PluginKind {
    plugins: &[
        plugin("gaussian", "A Gaussian.", &[WIDTHS, &[
            p("sigma", "float", "Its standard deviation, in pixels."),
            p("alpha", "float", "Its falloff, in version 3."),
        ]]),
        plugin("box", "The mean.", &[WIDTHS]),
        plugin("triangle", "A tent.", &[WIDTHS]),
        plugin("mitchell", "The filter of Mitchell and Netravali.", &[WIDTHS, &[
            p("B", "float", "Its parameter B; 1/3 by default."),
            p("C", "float", "Its parameter C; 1/3 by default."),
        ]]),
        plugin("sinc", "A windowed sinc.", &[WIDTHS, &[
            p("tau", "float", "The lobes of its window."),
        ]]),
    ],
    replaced: &[],
};

pub(crate) static MEDIA: PluginKind = PluginKind {
    plugins: &[plugin("homogeneous", "A medium of one density.", &[&[
        p("sigma_a", "rgb spectrum", "The coefficient of absorption."),
        p("sigma_s", "rgb spectrum", "The coefficient of scattering."),
        p("scale", "float", "A factor of both."),
        p("g", "float", "The mean cosine of scattering, from −1 to 1."),
        p("type", "string", "The plugin."),
        p("preset", "string", "A measured medium, which the default replaces."),
        p("Le", "rgb spectrum", "The light that it emits, which is left out."),
        p("Lescale", "float", "A factor of that light."),
    ]])],
    replaced: &[],
};

pub(crate) static ACCELERATORS: PluginKind = PluginKind {
    plugins: &[
        plugin("bvh", "A bounding volume hierarchy.", NO_PARAMETERS),
        plugin("kdtree", "A k-d tree.", NO_PARAMETERS),
    ],
    replaced: &[],
};
