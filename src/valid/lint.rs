//! Lints for values that are valid but probably unintended: no light in a scene of lit surfaces,
//! colours that look like bytes, weights that look like percentages, pixels larger than the
//! objects.

use super::check::Checker;
use super::inside::{self, Solids};
use super::medium;
use rtc_diag::{Diagnostic, Severity, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, ValuePath};
use rtc_math::{Vec3, atan2, shortest};
use rtc_source::Span;
use std::f64::consts::PI;

/// Runs the lints on a scene without errors. With errors, parts of the scene may be missing.
pub(super) fn lints(scene: &ir::Scene, solids: &Solids<'_>, check: &mut Checker<'_>) {
    if check.has_errors() {
        return;
    }
    no_light(scene, check);
    black_lights(scene, check);
    shadows_of_paths(scene, check);
    tiny_picture(scene, check);
    one_eye(scene, check);
    anaglyph(scene, check);
    motion(scene, check);
    inside::eye(solids, check);
    unsupported_features(scene, check);
    medium::open_shapes(scene, check);
    // A bubble in glass has an index below 1.
    let mut materials = scene.materials.iter().filter_map(ir::Material::phong);
    let has_glass = materials.any(|phong| phong.kt > 0.0 && phong.ior > 1.0);
    for (index, material) in scene.materials.iter().enumerate() {
        let Some(phong) = material.phong() else {
            continue;
        };
        if phong.color_map.is_none() && looks_like_bytes(phong.color, 2.0) {
            bytes(phong.color, EntityKind::Material, index, check);
        }
        weights(phong, index, check);
        if !has_glass {
            glass(phong, index, check);
        }
        highlight(phong, index, check);
    }
    for (index, light) in scene.lights.iter().enumerate() {
        let Some(light) = light.point() else { continue };
        if looks_like_bytes(light.color, BRIGHT) {
            bytes(light.color, EntityKind::Light, index, check);
        }
    }
}

/// A light may have a colour of 10; a value of at least this is more likely a byte.
const BRIGHT: f64 = 100.0;

/// Whether the channels of a colour are integers up to 255, the largest of them at least `least`.
fn looks_like_bytes(color: [f64; 3], least: f64) -> bool {
    let is_byte = |channel: &f64| channel.fract() == 0.0 && (0.0..=255.0).contains(channel);
    color.iter().all(is_byte) && color.iter().any(|channel| *channel >= least)
}

fn bytes(color: [f64; 3], entity: EntityKind, index: usize, check: &mut Checker<'_>) {
    let [r, g, b] = color.map(|channel| (channel / 255.0 * 1000.0).round() / 1000.0);
    let diagnostic = Diagnostic::new(
        &codes::COLOR_OF_BYTES,
        "a colour looks like bytes from 0 to 255",
    );
    let diagnostic = diagnostic.hint(format!("1 is full strength: `[{r}, {g}, {b}]`"));
    check.report(
        ValuePath::new(entity, index, EntityField::Color),
        "far brighter than white",
        diagnostic,
    );
}

/// A weight of 5 may be intended; a value of at least this is more likely a percentage.
const PERCENT: f64 = 10.0;

/// Warns of weights that look like percentages.
fn weights(phong: &ir::Phong, index: usize, check: &mut Checker<'_>) {
    for (key, weight, field) in [
        ("ka", phong.ka, EntityField::Ka),
        ("kd", phong.kd, EntityField::Kd),
        ("ks", phong.ks, EntityField::Ks),
        ("kr", phong.kr.unwrap_or(0.0), EntityField::Kr),
        ("kt", phong.kt, EntityField::Kt),
    ] {
        if weight < PERCENT {
            continue;
        }
        let message = format!("a `{key}` of {} looks like a percentage", shortest(weight));
        let hint = format!(
            "1 is all of the light: `{key}: {}`",
            shortest(weight / 100.0)
        );
        check.report(
            ValuePath::new(EntityKind::Material, index, field),
            "its brightness, relative to the surfaces it illuminates",
            Diagnostic::new(&codes::LARGE_WEIGHT, message).hint(hint),
        );
    }
}

/// Warns of an index of refraction that no glass has.
fn glass(phong: &ir::Phong, index: usize, check: &mut Checker<'_>) {
    if phong.kt > 0.0 && phong.ior < 1.0 {
        let inverse = shortest((100.0 / phong.ior).round() / 100.0);
        let message = format!(
            "an index of refraction of {} is below that of air",
            shortest(phong.ior)
        );
        let hint = format!(
            "it is the index inside over that outside, for instance 1.5 for glass; the other way \
             round this is {inverse}"
        );
        check.report(
            ValuePath::new(EntityKind::Material, index, EntityField::Ior),
            "the light is bent as on leaving glass",
            Diagnostic::new(&codes::UNLIKELY_VALUE, message).hint(hint),
        );
    }
}

/// Warns of a highlight that is everywhere.
fn highlight(phong: &ir::Phong, index: usize, check: &mut Checker<'_>) {
    if phong.ks > 0.0 && phong.n == 0.0 {
        let message = "a highlight with the exponent 0 is as bright everywhere";
        let hint = "a larger `n` makes it smaller and sharper, for instance 20; `ks: 0` is no \
                    highlight";
        check.report(
            ValuePath::new(EntityKind::Material, index, EntityField::N),
            "it whitens the whole surface",
            Diagnostic::new(&codes::UNLIKELY_VALUE, message).hint(hint),
        );
    }
}

/// Warns of the lights that are black, if their scene shades its surfaces.
fn black_lights(scene: &ir::Scene, check: &mut Checker<'_>) {
    let is_lit = matches!(
        scene.settings.mode,
        ir::Mode::Phong | ir::Mode::Gooch(_) | ir::Mode::Path(_)
    );
    for (index, light) in scene.lights.iter().enumerate() {
        let is_black = light.point().is_some_and(|light| light.color == [0.0; 3]);
        if is_lit && is_black {
            let message = "a black light has no effect";
            let hint = "white is `[1, 1, 1]`; to turn a light off, remove it";
            check.report(
                ValuePath::new(EntityKind::Light, index, EntityField::Color),
                "no light",
                Diagnostic::new(&codes::UNLIKELY_VALUE, message).hint(hint),
            );
        }
    }
}

/// The fraction of the picture below which a circle around all objects is probably the mistake of
/// the camera.
const SMALL_FRACTION: f64 = 0.01;

/// The fraction of the picture's height that all objects take with the suggested `up`.
const FILLED: f64 = 0.75;

/// Warns if pixels are so large that the objects together cover a few of them.
fn tiny_picture(scene: &ir::Scene, check: &mut Checker<'_>) {
    // Only a camera with `up` in the text can be too far away by mistake.
    let (Some(_), Some(sphere)) = (written(EntityField::Up, check), scene.bounding_sphere()) else {
        return;
    };
    // Size of all objects in pixels.
    let camera = &scene.camera;
    let [eye, center, step] = [camera.eye, camera.center, camera.up].map(Vec3::from_array);
    let distance = eye.distance(sphere.center);
    let scale = |distance: f64| match camera.projection {
        ir::Projection::Perspective => eye.distance(center) / distance,
        ir::Projection::Orthographic => 1.0,
    };
    let across = 2.0 * sphere.radius * scale(distance);
    let pixels = across / step.length();
    let [width, height] = camera.size.map(f64::from);
    let side = width.min(height);
    // A circle around each ball is smaller than one around all corners of its box.
    let disc = |(ball, radius): (Vec3, f64)| {
        let radius = radius * scale(eye.distance(ball)) / step.length();
        PI * radius * radius
    };
    let covered = match balls(scene) {
        Some(balls) => balls
            .map(disc)
            .sum::<f64>()
            .min(disc((sphere.center, sphere.radius))),
        None => disc((sphere.center, sphere.radius)),
    };
    let is_tiny = covered < SMALL_FRACTION * width * height;
    if distance <= sphere.radius || !is_tiny || pixels.is_nan() {
        return;
    }
    let message = format!(
        "all objects together are {} of the picture",
        match pixels {
            ..1.0 => "less than a pixel".to_owned(),
            ..2.0 => "a pixel".to_owned(),
            _ => format!("{pixels:.0} pixels"),
        }
    );
    let diagnostic = Diagnostic::new(&codes::TINY_PICTURE, message);
    report_tiny(diagnostic, camera, across / (FILLED * side), check);
}

/// The span of a value of the camera that is in the text.
fn written(field: EntityField, check: &Checker<'_>) -> Option<Span> {
    // A value that is not has the span of its entity.
    let at = |field| check.span(ValuePath::new(EntityKind::Camera, 0, field));
    at(field).filter(|span| Some(*span) != at(EntityField::Whole))
}

/// Reports a tiny picture at what gives the size of a pixel, and suggests the one with which the
/// objects fill the picture.
fn report_tiny(diagnostic: Diagnostic, camera: &ir::Camera, pixel: f64, check: &mut Checker<'_>) {
    let path = |field| ValuePath::new(EntityKind::Camera, 0, field);
    let [right, up, fov, size] = [
        EntityField::Right,
        EntityField::Up,
        EntityField::Fov,
        EntityField::PixelSize,
    ]
    .map(|field| written(field, check));
    let short = |value| shortest(two_digits(value));
    if fov.is_some() {
        let half = pixel * f64::from(camera.size[1]) / 2.0;
        let degrees = short(2.0 * atan2(half, camera.distance()).to_degrees());
        let diagnostic = diagnostic.hint(format!("`fov: {degrees}` fills the picture with them"));
        check.report(path(EntityField::Fov), "the field of view", diagnostic);
    } else if size.is_some() {
        let size = short(pixel);
        let diagnostic =
            diagnostic.hint(format!("`pixelSize: {size}` fills the picture with them"));
        let label = "gives the size of a pixel";
        check.report(path(EntityField::PixelSize), label, diagnostic);
    } else if right != up {
        let diagnostic = diagnostic.hint("write a shorter `right` and a shorter `up`");
        let label = "the step from a pixel to the next";
        check.report(path(EntityField::Right), label, diagnostic);
    } else if let Some(span) = up {
        let suggestion = (camera.upright() * pixel).to_array().map(two_digits);
        let suggestion = format!("[{}]", suggestion.map(shortest).join(", "));
        let diagnostic = diagnostic
            .guess("write a shorter one", span, suggestion)
            .hint("or give the angle that the picture spans, as `fov: 45`");
        let label = "its length is the size of a pixel";
        check.report(path(EntityField::Up), label, diagnostic);
    }
}

/// The centres and radii of the objects, if all that are bounded are balls.
fn balls(scene: &ir::Scene) -> Option<impl Iterator<Item = (Vec3, f64)>> {
    let ball = |surface: &ir::Surface| {
        if let ir::Shape::Sphere(sphere) = &surface.shape {
            return Some(Some((Vec3::from_array(sphere.center), sphere.radius)));
        }
        matches!(surface.shape, ir::Shape::Plane(_)).then_some(None)
    };
    let balls: Option<Vec<_>> = scene.surfaces.iter().map(ball).collect();
    balls.map(|balls| balls.into_iter().flatten())
}

/// A number rounded to two digits.
fn two_digits(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value) + 0.0
}

/// Warns about lit surfaces without a light: the picture is black.
fn no_light(scene: &ir::Scene, check: &mut Checker<'_>) {
    let ir::Scene {
        settings,
        lights,
        surfaces,
        ..
    } = scene;
    let is_lit = matches!(settings.mode, ir::Mode::Phong | ir::Mode::Gooch(_));
    let has_own_light = settings.mode == ir::Mode::Phong && settings.ambient == ir::Ambient::Once;
    if is_lit && !has_own_light && lights.is_empty() && !surfaces.is_empty() {
        let diagnostic = Diagnostic::new(
            &codes::NO_LIGHT,
            "the scene has no light, so the picture is black",
        )
        .hint("write a light as `Lights: [{position: [0, 0, 0], color: [1, 1, 1]}]`");
        check.report_all(EntityKind::Light, "/lights", "no light here", diagnostic);
    }
}

/// Warns about surfaces without shadows in a path-traced scene, where every surface casts one.
fn shadows_of_paths(scene: &ir::Scene, check: &mut Checker<'_>) {
    let ir::Scene {
        settings, surfaces, ..
    } = scene;
    let first = surfaces.iter().position(|surface| surface.casts_no_shadow);
    if let (ir::Mode::Path(_), Some(index)) = (&settings.mode, first) {
        let diagnostic = Diagnostic::new(
            &codes::SHADOW_IN_PATHS,
            "path tracing ignores `shadow: false`",
        )
        .hint("`RenderMode: phong` honours `shadow: false`");
        check.report(
            ValuePath::new(EntityKind::Surface, index, EntityField::Whole),
            "casts a shadow",
            diagnostic,
        );
    }
}

/// Warns about two eyes of an orthographic camera.
fn one_eye(scene: &ir::Scene, check: &mut Checker<'_>) {
    let is_parallel = scene.camera.projection == ir::Projection::Orthographic;
    if is_parallel && scene.settings.stereo > 0.0 {
        let message = "`stereo` has no effect: the rays of an orthographic camera are parallel";
        let diagnostic = Diagnostic::new(&codes::NO_EFFECT, message).severity(Severity::Warning);
        let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Stereo);
        let hint = "only a `perspective` camera has two eyes";
        check.report(
            path,
            "one eye sees the whole picture",
            diagnostic.hint(hint),
        );
    }
}

/// Warns about a velocity or a shutter without effect.
fn motion(scene: &ir::Scene, check: &mut Checker<'_>) {
    let is_moving = |surface: &ir::Surface| surface.velocity.get() != [0.0; 3];
    let first = scene.surfaces.iter().position(is_moving);
    let [open, close] = scene.settings.shutter;
    if close < open {
        let message = format!("the shutter opens at `{open}` and closes at `{close}`, before that");
        let diagnostic = Diagnostic::new(&codes::OUT_OF_RANGE, message).severity(Severity::Warning);
        let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Shutter);
        check.report(path, "the times are exchanged", diagnostic);
    }
    let shutter = ValuePath::new(EntityKind::Settings, 0, EntityField::Shutter);
    let (path, message, label) = match first {
        None if scene.settings.shutter == ir::Settings::default().shutter => return,
        None => (
            shutter,
            "`shutter` has no effect: nothing has a `velocity`",
            "",
        ),
        Some(index) => {
            let path = ValuePath::new(EntityKind::Surface, index, EntityField::Velocity);
            if open == 0.0 && close == 0.0 {
                (
                    path,
                    "`velocity` has no effect: the shutter opens and closes at 0",
                    "",
                )
            } else if scene.settings.mode == ir::Mode::Depth && open != close {
                let message = "distances are not blurred: they are those when the shutter opens";
                (path, message, "it moves")
            } else {
                return;
            }
        }
    };
    let diagnostic = Diagnostic::new(&codes::NO_EFFECT, message).severity(Severity::Warning);
    check.report(path, label, diagnostic);
}

/// Warns about what an anaglyph lacks.
fn anaglyph(scene: &ir::Scene, check: &mut Checker<'_>) {
    let settings = &scene.settings;
    if settings.stereo == 0.0 || settings.stereo_view == ir::StereoView::SideBySide {
        return;
    }
    let mut warn = |message, label, hint: &str| {
        let path = ValuePath::new(EntityKind::Settings, 0, EntityField::Stereo);
        let diagnostic = Diagnostic::new(&codes::NO_EFFECT, message).severity(Severity::Warning);
        check.report(path, label, diagnostic.hint(hint));
    };
    if let ir::Mode::Depth = settings.mode {
        warn(
            "an anaglyph shows no distances: they have no colours",
            "the left eye alone sees the picture",
            "`stereoView: sideBySide` shows the distances from both eyes",
        );
    } else if settings.background.is_some() {
        warn(
            "`Background` has no effect where one eye sees a surface and the other does not",
            "an anaglyph of two eyes",
            "a large surface or an `Environment` is a background for each eye",
        );
    }
}

/// Warns about material features that the integrator does not support.
fn unsupported_features(scene: &ir::Scene, check: &mut Checker<'_>) {
    let is_traced = matches!(scene.settings.mode, ir::Mode::Path(_));
    if !is_traced && !matches!(scene.settings.mode, ir::Mode::Phong | ir::Mode::Gooch(_)) {
        return;
    }
    if !is_traced && scene.medium.is_some() {
        let message = "the medium around the camera does not show in this `RenderMode`";
        let hint = "path tracing shows it: `RenderMode: path`, or `--integrator path`";
        let diagnostic = Diagnostic::new(&codes::LOST_PARTS, message).hint(hint);
        let path = ValuePath::new(EntityKind::Medium, 0, EntityField::Whole);
        check.report(path, "it is left out", diagnostic);
    }
    let mut is_used = vec![false; scene.materials.len()];
    for surface in &scene.surfaces {
        if let Some(is_used) = is_used.get_mut(surface.material.0 as usize) {
            *is_used = true;
        }
    }
    report_blends(scene, &is_used, is_traced, check);
    for (index, material) in scene.materials.iter().enumerate() {
        let (message, hint) = match material {
            _ if !is_used[index] => continue,
            ir::Material::Phong(phong) if is_traced && has_hidden_maps(phong) => (
                "paths don't show the height field of a material, nor a map of its `ks`",
                "a `normalMap` shows in both",
            ),
            ir::Material::Standard(standard) if !is_traced && is_more_than_phong(standard) => (
                "only the colour and the roughness of a `standard` material show in this \
                 `RenderMode`",
                "path tracing shows all of it: `RenderMode: path`, or `--integrator path`",
            ),
            ir::Material::Phong(_) | ir::Material::Standard(_) => continue,
        };
        let diagnostic = Diagnostic::new(&codes::LOST_PARTS, message).hint(hint);
        let label = "its other properties are ignored";
        check.report(
            ValuePath::new(EntityKind::Material, index, EntityField::Whole),
            label,
            diagnostic,
        );
    }
}

/// Warns about blends that the integrator shows as one of their materials.
fn report_blends(scene: &ir::Scene, is_used: &[bool], is_traced: bool, check: &mut Checker<'_>) {
    for (index, material) in scene.materials.iter().enumerate() {
        let is_blend = match material {
            ir::Material::Phong(_) => false,
            ir::Material::Standard(standard) => standard.blend_with.is_some(),
        };
        if is_traced || !is_blend || !is_used[index] {
            continue;
        }
        let message =
            "a blend of materials shows the one of the larger weight in this `RenderMode`";
        let hint = "path tracing shows both: `RenderMode: path`, or `--integrator path`";
        let diagnostic = Diagnostic::new(&codes::LOST_PARTS, message).hint(hint);
        let path = ValuePath::new(EntityKind::Material, index, EntityField::Whole);
        check.report(path, "its other material is left out", diagnostic);
    }
}

/// Whether a Phong material has maps that its path-traced equivalent lacks.
fn has_hidden_maps(phong: &ir::Phong) -> bool {
    let bends = phong.bump.is_some() && phong.normal_map.is_none();
    bends || (phong.specular_map.is_some() && phong.ks > 0.0)
}

/// Whether a glTF material has features that the Phong model lacks.
fn is_more_than_phong(standard: &ir::Standard) -> bool {
    let layers = [
        standard.transmission,
        standard.clearcoat,
        standard.iridescence,
        standard.anisotropy,
        standard.diffuse_transmission,
    ];
    let colors = [standard.emissive, standard.sheen_color];
    standard.maps().next().is_some()
        || standard.interior.is_some()
        || standard.exterior.is_some()
        || layers.iter().any(|weight| *weight > 0.0)
        || colors.iter().flatten().any(|channel| *channel > 0.0)
        || standard.alpha != ir::Alpha::Opaque
        || standard.unlit
}
