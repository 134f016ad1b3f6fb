//! Examples of scenes of Mitsuba.

use super::ExamplePart;

/// The start of a scene with a sensor.
const SEEN: &str = concat!(
    r#"<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm">"#,
    r#"<rfilter type="box"/></film></sensor>"#,
);

pub(super) const PARTS: &[ExamplePart] = &[
    ExamplePart {
        title: "shapes",
        before: &[SEEN],
        after: "</scene>",
        examples: &[
            ("`sphere`", r#"<shape type="sphere"/>"#),
            ("`disk`", r#"<shape type="disk"/>"#),
            ("`rectangle`", r#"<shape type="rectangle"/>"#),
            ("`cube`", r#"<shape type="cube"/>"#),
            ("`cylinder`", r#"<shape type="cylinder"/>"#),
            (
                "`obj`",
                r#"<shape type="obj"><string name="filename" value="a.obj"/></shape>"#,
            ),
            (
                "`ply`",
                r#"<shape type="ply"><string name="filename" value="a.ply"/></shape>"#,
            ),
            (
                "`serialized`",
                r#"<shape type="serialized"><string name="filename" value="a.serialized"/></shape>"#,
            ),
            (
                "`shapegroup`, `instance`",
                r#"<shape type="shapegroup" id="g"><shape type="cube"/></shape>
                <shape type="instance"><ref id="g"/></shape>"#,
            ),
            (
                "`merge`",
                r#"<shape type="merge"><shape type="cube"/></shape>"#,
            ),
            ("`linearcurve`", r#"<shape type="linearcurve"/>"#),
            ("`sdfgrid`", r#"<shape type="sdfgrid"/>"#),
        ],
    },
    ExamplePart {
        title: "BSDFs",
        before: &[SEEN, r#"<shape type="sphere">"#],
        after: "</shape></scene>",
        examples: &[
            ("`diffuse`", r#"<bsdf type="diffuse"/>"#),
            ("`roughdiffuse`", r#"<bsdf type="roughdiffuse"/>"#),
            (
                "`conductor`",
                r#"<bsdf type="conductor"><string name="material" value="Au"/></bsdf>"#,
            ),
            (
                "`conductor` of `none`",
                r#"<bsdf type="conductor"><string name="material" value="none"/></bsdf>"#,
            ),
            (
                "`roughconductor`",
                r#"<bsdf type="roughconductor"><string name="material" value="Cu"/>
                <string name="distribution" value="ggx"/></bsdf>"#,
            ),
            ("`dielectric`", r#"<bsdf type="dielectric"/>"#),
            ("`thindielectric`", r#"<bsdf type="thindielectric"/>"#),
            (
                "`roughdielectric`, GGX",
                r#"<bsdf type="roughdielectric"><string name="distribution" value="ggx"/></bsdf>"#,
            ),
            (
                "`roughdielectric`, Beckmann",
                r#"<bsdf type="roughdielectric">
                <string name="distribution" value="beckmann"/></bsdf>"#,
            ),
            ("`plastic`", r#"<bsdf type="plastic"/>"#),
            ("`roughplastic`", r#"<bsdf type="roughplastic"/>"#),
            ("`principled`", r#"<bsdf type="principled"/>"#),
            ("`principledthin`", r#"<bsdf type="principledthin"/>"#),
            (
                "`twosided`",
                r#"<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>"#,
            ),
            (
                "`mask`",
                r#"<bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="diffuse"/></bsdf>"#,
            ),
            (
                "`blendbsdf`",
                r#"<bsdf type="blendbsdf"><float name="weight" value="0.5"/>
                <bsdf type="diffuse"/><bsdf type="plastic"/></bsdf>"#,
            ),
            (
                "`normalmap`",
                r#"<bsdf type="normalmap"><texture name="normalmap" type="bitmap">
                <boolean name="raw" value="true"/><string name="filename" value="a.png"/></texture>
                <bsdf type="diffuse"/></bsdf>"#,
            ),
            (
                "`bumpmap`",
                r#"<bsdf type="bumpmap"><texture name="arbitrary" type="bitmap">
                <string name="filename" value="a.png"/></texture><bsdf type="diffuse"/></bsdf>"#,
            ),
            ("`null`", r#"<bsdf type="null"/>"#),
            ("`phong`", r#"<bsdf type="phong"/>"#),
            ("`hair`", r#"<bsdf type="hair"/>"#),
            ("`measured`", r#"<bsdf type="measured"/>"#),
            ("`polarizer`", r#"<bsdf type="polarizer"/>"#),
            ("`retarder`", r#"<bsdf type="retarder"/>"#),
            ("`pplastic`", r#"<bsdf type="pplastic"/>"#),
        ],
    },
    ExamplePart {
        title: "textures",
        before: &[SEEN, r#"<shape type="rectangle"><bsdf type="diffuse">"#],
        after: "</bsdf></shape></scene>",
        examples: &[
            (
                "`bitmap`",
                r#"<texture name="reflectance" type="bitmap">
                <string name="filename" value="a.png"/></texture>"#,
            ),
            (
                "`bitmap` with `to_uv`",
                r#"<texture name="reflectance" type="bitmap">
                <string name="filename" value="a.png"/>
                <transform name="to_uv"><scale value="2"/></transform></texture>"#,
            ),
            (
                "`bitmap`, mirrored and nearest",
                r#"<texture name="reflectance" type="bitmap">
                <string name="filename" value="a.png"/><string name="wrap_mode" value="mirror"/>
                <string name="filter_type" value="nearest"/></texture>"#,
            ),
            (
                "`checkerboard`",
                r#"<texture name="reflectance" type="checkerboard"/>"#,
            ),
            (
                "`mesh_attribute`",
                r#"<texture name="reflectance" type="mesh_attribute">
                <string name="name" value="vertex_color"/></texture>"#,
            ),
            ("`volume`", r#"<texture name="reflectance" type="volume"/>"#),
            (
                "`rgb`",
                r#"<rgb name="reflectance" value="0.2, 0.4, 0.6"/>"#,
            ),
            (
                "`spectrum` of pairs",
                r#"<spectrum name="reflectance" value="400:0.2, 700:0.6"/>"#,
            ),
        ],
    },
    ExamplePart {
        title: "emitters",
        before: &[SEEN],
        after: "</scene>",
        examples: &[
            (
                "`area`",
                r#"<shape type="sphere"><emitter type="area"><rgb name="radiance" value="2"/>
                </emitter></shape>"#,
            ),
            (
                "`area` with a texture",
                r#"<shape type="rectangle"><emitter type="area"><texture name="radiance" type="bitmap">
                <string name="filename" value="a.png"/></texture></emitter></shape>"#,
            ),
            ("`constant`", r#"<emitter type="constant"/>"#),
            (
                "`envmap`",
                r#"<emitter type="envmap"><string name="filename" value="sky.exr"/></emitter>"#,
            ),
            ("`point`", r#"<emitter type="point"/>"#),
            ("`directional`", r#"<emitter type="directional"/>"#),
            ("`spot`", r#"<emitter type="spot"/>"#),
            (
                "`spot` with a texture",
                r#"<emitter type="spot"><texture name="texture" type="bitmap">
                <string name="filename" value="a.png"/></texture></emitter>"#,
            ),
            ("`sunsky`", r#"<emitter type="sunsky"/>"#),
            ("`projector`", r#"<emitter type="projector"/>"#),
            ("`directionalarea`", r#"<emitter type="directionalarea"/>"#),
        ],
    },
    ExamplePart {
        title: "sensors",
        before: &[r#"<scene version="3.0.0"><sensor type=""#],
        after: r#"</sensor></scene>"#,
        examples: &[
            (
                "`perspective`",
                r#"perspective"><float name="fov" value="30"/>
                <film type="hdrfilm"><rfilter type="box"/></film>"#,
            ),
            (
                "`principal_point_offset_x`",
                r#"perspective"><float name="principal_point_offset_x" value="0.1"/>
                <film type="hdrfilm"><rfilter type="box"/></film>"#,
            ),
            (
                "`thinlens`",
                r#"thinlens"><float name="aperture_radius" value="0.1"/>
                <film type="hdrfilm"><rfilter type="box"/></film>"#,
            ),
            (
                "`orthographic`",
                r#"orthographic"><film type="hdrfilm"><rfilter type="box"/></film>"#,
            ),
            (
                "`radiancemeter`",
                r#"radiancemeter"><film type="hdrfilm"><rfilter type="box"/></film>"#,
            ),
            (
                "`crop_width`",
                r#"perspective"><film type="hdrfilm"><integer name="crop_width" value="9"/>
                <rfilter type="box"/></film>"#,
            ),
            (
                "`gaussian`",
                r#"perspective"><film type="hdrfilm"><rfilter type="gaussian"/></film>"#,
            ),
            (
                "`tent`",
                r#"perspective"><film type="hdrfilm"><rfilter type="tent"/></film>"#,
            ),
        ],
    },
    ExamplePart {
        title: "integrators",
        before: &[SEEN, r#"<integrator type=""#],
        after: r#""/></scene>"#,
        examples: &[
            ("`path`", "path"),
            ("`direct`", "direct"),
            ("`volpath`", "volpath"),
            ("`aov`", "aov"),
            ("`depth`", "depth"),
            ("`ptracer`", "ptracer"),
        ],
    },
    ExamplePart {
        title: "the rest",
        before: &[SEEN],
        after: "</scene>",
        examples: &[
            (
                "`<default>`",
                r#"<default name="r" value="2"/>
                <shape type="sphere"><float name="radius" value="$r"/></shape>"#,
            ),
            ("`<include>`", r#"<include filename="part.xml"/>"#),
            (
                "`<ref>`",
                r#"<bsdf type="diffuse" id="a"/><shape type="sphere"><ref id="a"/></shape>"#,
            ),
            (
                "`medium`",
                r#"<medium type="homogeneous" id="m"/>
                <shape type="sphere"><ref name="interior" id="m"/></shape>"#,
            ),
        ],
    },
];
