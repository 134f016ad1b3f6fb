//! Examples of scenes of pbrt.

use super::ExamplePart;

const WORLD: &str = "Camera \"perspective\"\nWorldBegin\n";

pub(super) const PARTS: &[ExamplePart] = &[
    ExamplePart {
        title: "cameras",
        before: &[],
        after: "\nWorldBegin\n",
        examples: &[
            ("`perspective`", r#"Camera "perspective" "float fov" 40"#),
            (
                "`lensradius`",
                r#"Camera "perspective" "float lensradius" 0.1 "float focaldistance" 4"#,
            ),
            (
                "`screenwindow`",
                r#"Camera "perspective" "float screenwindow" [ -1 2 -1 1 ]"#,
            ),
            ("`orthographic`", r#"Camera "orthographic""#),
            ("`realistic`", r#"Camera "realistic""#),
            ("`spherical`", r#"Camera "spherical""#),
        ],
    },
    ExamplePart {
        title: "film, sampler, filter, integrator",
        before: &["Camera \"perspective\"\n"],
        after: "\nWorldBegin\n",
        examples: &[
            (
                "`rgb` with a size",
                r#"Film "rgb" "integer xresolution" 8 "integer yresolution" 8"#,
            ),
            (
                "`cropwindow`",
                r#"Film "rgb" "float cropwindow" [ 0 0.5 0 1 ]"#,
            ),
            ("`sensor`", r#"Film "rgb" "string sensor" "canon_eos_100d""#),
            ("`halton`", r#"Sampler "halton" "integer pixelsamples" 64"#),
            ("`box`", r#"PixelFilter "box""#),
            ("`gaussian`", r#"PixelFilter "gaussian""#),
            ("`path`", r#"Integrator "path" "integer maxdepth" 5"#),
            ("`volpath`", r#"Integrator "volpath""#),
            ("`bdpt`", r#"Integrator "bdpt""#),
            ("`directlighting`", r#"Integrator "directlighting""#),
        ],
    },
    ExamplePart {
        title: "shapes",
        before: &[WORLD],
        after: "\n",
        examples: &[
            ("`sphere`", r#"Shape "sphere" "float radius" 2"#),
            (
                "`sphere` with `phimax`",
                r#"Shape "sphere" "float phimax" 90"#,
            ),
            ("`disk`", r#"Shape "disk""#),
            (
                "`disk` with `innerradius`",
                r#"Shape "disk" "float innerradius" 0.5"#,
            ),
            ("`cylinder`", r#"Shape "cylinder""#),
            ("`cone`", r#"Shape "cone""#),
            (
                "`trianglemesh`",
                r#"Shape "trianglemesh" "integer indices" [ 0 1 2 ] "point3 P" [ 0 0 0 1 0 0 0 1 0 ]"#,
            ),
            ("`plymesh`", r#"Shape "plymesh" "string filename" "a.ply""#),
            (
                "`plymesh` with a displacement",
                r#"Texture "t" "float" "constant" "float value" 1
                Shape "plymesh" "string filename" "a.ply" "texture displacement" "t""#,
            ),
            (
                "`bilinearmesh`",
                r#"Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]"#,
            ),
            (
                "`bilinearmesh` with `uv`",
                r#"Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]
                "point2 uv" [ 0 0 1 0 0 1 1 1 ]"#,
            ),
            (
                "`loopsubdiv`",
                r#"Shape "loopsubdiv" "integer levels" 1 "integer indices" [ 0 1 2 0 3 1 1 3 2 2 3 0 ]
                "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ]"#,
            ),
            (
                "`curve`",
                r#"Shape "curve" "point3 P" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]"#,
            ),
            ("`alpha`, a number", r#"Shape "sphere" "float alpha" 0.5"#),
            (
                "`alpha`, a texture",
                r#"Texture "t" "float" "imagemap" "string filename" "a.png"
                Shape "sphere" "texture alpha" "t""#,
            ),
        ],
    },
    ExamplePart {
        title: "materials",
        before: &[WORLD],
        after: "\nShape \"sphere\"\n",
        examples: &[
            (
                "`diffuse`",
                r#"Material "diffuse" "rgb reflectance" [ 0.2 0.4 0.6 ]"#,
            ),
            ("`coateddiffuse`", r#"Material "coateddiffuse""#),
            (
                "`conductor` with `reflectance`",
                r#"Material "conductor" "rgb reflectance" [ 0.9 0.8 0.7 ]"#,
            ),
            (
                "`conductor` with `eta` and `k`",
                r#"Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k""#,
            ),
            ("`coatedconductor`", r#"Material "coatedconductor""#),
            ("`dielectric`", r#"Material "dielectric" "float eta" 1.5"#),
            (
                "`dielectric` with `roughness`",
                r#"Material "dielectric" "float roughness" 0.2"#,
            ),
            ("`thindielectric`", r#"Material "thindielectric""#),
            ("`diffusetransmission`", r#"Material "diffusetransmission""#),
            (
                "`mix`",
                r#"MakeNamedMaterial "a" "string type" "diffuse"
                MakeNamedMaterial "b" "string type" "conductor" "rgb reflectance" [ 0.9 0.8 0.7 ]
                Material "mix" "string materials" [ "a" "b" ] "float amount" 0.3"#,
            ),
            ("`interface`", r#"Material "interface""#),
            ("`hair`", r#"Material "hair""#),
            (
                "`measured`",
                r#"Material "measured" "string filename" "a.bsdf""#,
            ),
            ("`subsurface`", r#"Material "subsurface""#),
            (
                "`normalmap`",
                r#"Material "diffuse" "string normalmap" "a.png""#,
            ),
            (
                "`displacement`",
                r#"Texture "t" "float" "constant" "float value" 1
                Material "diffuse" "texture displacement" "t""#,
            ),
        ],
    },
    ExamplePart {
        title: "textures",
        before: &[WORLD],
        after: "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n",
        examples: &[
            (
                "`constant`",
                r#"Texture "t" "spectrum" "constant" "rgb value" [ 0.2 0.4 0.6 ]"#,
            ),
            (
                "`imagemap`",
                r#"Texture "t" "spectrum" "imagemap" "string filename" "a.png""#,
            ),
            (
                "`imagemap` with `uscale`",
                r#"Texture "t" "spectrum" "imagemap" "string filename" "a.png" "float uscale" 2"#,
            ),
            (
                "`imagemap` with `black`",
                r#"Texture "t" "spectrum" "imagemap" "string filename" "a.png" "string wrap" "black""#,
            ),
            (
                "`imagemap` with a planar mapping",
                r#"Texture "t" "spectrum" "imagemap" "string filename" "a.png"
                "string mapping" "planar" "vector3 v1" [ 1 0 0 ] "vector3 v2" [ 0 1 0 ]"#,
            ),
            ("`checkerboard`", r#"Texture "t" "spectrum" "checkerboard""#),
            (
                "`scale`",
                r#"Texture "a" "spectrum" "imagemap" "string filename" "a.png"
                Texture "t" "spectrum" "scale" "texture tex" "a" "float scale" 0.5"#,
            ),
            (
                "`mix` of colours",
                r#"Texture "t" "spectrum" "mix" "rgb tex1" [ 1 0 0 ] "rgb tex2" [ 0 1 0 ]"#,
            ),
            (
                "`mix` of textures",
                r#"Texture "a" "spectrum" "imagemap" "string filename" "a.png"
                Texture "t" "spectrum" "mix" "texture tex1" "a""#,
            ),
            ("`fbm`", r#"Texture "t" "spectrum" "fbm""#),
            ("`marble`", r#"Texture "t" "spectrum" "marble""#),
        ],
    },
    ExamplePart {
        title: "lights",
        before: &[WORLD],
        after: "\n",
        examples: &[
            ("`point`", r#"LightSource "point" "rgb I" [ 1 2 3 ]"#),
            ("`power`", r#"LightSource "point" "float power" 100"#),
            ("`spot`", r#"LightSource "spot" "float coneangle" 20"#),
            ("`distant`", r#"LightSource "distant""#),
            ("`infinite`", r#"LightSource "infinite" "rgb L" [ 1 2 3 ]"#),
            (
                "`infinite` with a map",
                r#"LightSource "infinite" "string filename" "sky.exr""#,
            ),
            (
                "`goniometric`",
                r#"LightSource "goniometric" "string filename" "sky.exr""#,
            ),
            (
                "`projection`",
                r#"LightSource "projection" "string filename" "a.png""#,
            ),
            (
                "`diffuse` on a sphere",
                r#"AreaLightSource "diffuse" "rgb L" [ 1 2 3 ] Shape "sphere""#,
            ),
            (
                "`diffuse` on a flat shape",
                r#"AreaLightSource "diffuse" "rgb L" [ 1 2 3 ] Shape "disk""#,
            ),
            (
                "`twosided`",
                r#"AreaLightSource "diffuse" "bool twosided" true Shape "disk""#,
            ),
            (
                "`diffuse` with a picture",
                r#"AreaLightSource "diffuse" "string filename" "a.png" Shape "disk""#,
            ),
            ("`blackbody`", r#"LightSource "point" "blackbody I" 4000"#),
        ],
    },
    ExamplePart {
        title: "the rest",
        before: &[WORLD],
        after: "\n",
        examples: &[
            ("`Include`", r#"Include "part.pbrt""#),
            ("`Import`", r#"Import "part.pbrt""#),
            (
                "`ObjectInstance`",
                r#"ObjectBegin "a" Shape "sphere" ObjectEnd ObjectInstance "a""#,
            ),
            (
                "`ConcatTransform`",
                r#"ConcatTransform [ 2 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ] Shape "sphere""#,
            ),
            (
                "`Attribute`",
                r#"Attribute "shape" "float radius" 2 Shape "sphere""#,
            ),
            ("`ColorSpace`", r#"ColorSpace "aces2065-1""#),
            (
                "`MediumInterface`",
                r#"MakeNamedMedium "m" "string type" "homogeneous" MediumInterface "m" """#,
            ),
            (
                "`ActiveTransform`",
                "ActiveTransform EndTime Translate 1 0 0 ActiveTransform All",
            ),
        ],
    },
];
