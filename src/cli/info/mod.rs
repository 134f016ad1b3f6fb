//! `rtc info`: the content of a scene, its size, and the effects that its picture requires.

mod report;

pub(super) use report::InfoReport;

use super::args::InfoArgs;
use super::reporter::Reporter;
use super::{Failure, input, output};
use indicatif::{BinaryBytes, HumanCount};
use report::{
    BoundsReport, CameraReport, ContentCounts, ContentReport, EffectReport, GltfAssetReport,
    ImageReport, PictureReport, SettingsReport,
};
use rtc_diag::clean;
use rtc_ir::{Light, Mesh, Mode, Projection, Scene, Shape};
use rtc_math::{Vec3, shortest};
use rtc_pipeline::{Input, ValidatedScene};
use rtc_plan::{Plan, Rule, RuleSet};
use serde_json::Value;
use std::collections::BTreeMap;

/// The version of the JSON form.
const SCHEMA: &str = "rtc-info/1";

/// Columns before the values of the text.
const INDENT: usize = 12;

/// Reports the contents of the scene.
pub(super) fn run(args: &InfoArgs) -> Result<(), Failure> {
    let mut reporter = Reporter::beside_result(&args.reporter);
    let mut input = input::staged(&args.file, &args.reading, &args.stage)?;
    let outcome = carry_out(args, &mut input, &mut reporter);
    reporter.finish()?;
    outcome
}

fn carry_out(args: &InfoArgs, input: &mut Input, reporter: &mut Reporter) -> Result<(), Failure> {
    // The picture is planned, not made.
    input.lift_rays();
    let asset = input.asset();
    let loaded = input.load();
    let content = loaded.as_ref().map(|own| content(&own.lowered.scene));
    let validated = loaded.and_then(|own| input.validate(own, input::fill));
    let validated = input::unless_refused(validated, input, reporter)?;
    let report = InfoReport {
        schema: SCHEMA,
        file: input.name().to_owned(),
        content: content.unwrap_or_default(),
        settings: settings(&validated),
        asset: asset.as_ref().map(GltfAssetReport::new),
    };
    let facts = serde_json::to_value(report).map_err(|error| Failure::Failed(error.to_string()))?;
    let text = match args.format.is_json() {
        true => return output::print_json(&format!("{facts:#}\n")),
        false => lines(&facts),
    };
    output::print(&text)
}

/// The content of the scene itself, without a studio or other additions.
fn content(scene: &Scene) -> ContentReport {
    // Count the entities by kind.
    let mut shapes: BTreeMap<&str, usize> = BTreeMap::new();
    let mut lights: BTreeMap<&str, usize> = BTreeMap::new();
    let mut materials: BTreeMap<&str, usize> = BTreeMap::new();
    let mut triangles = 0;
    for surface in &scene.surfaces {
        *shapes.entry(surface.shape.kind().name()).or_default() += 1;
        triangles += triangles_of(&surface.shape, &scene.meshes);
    }
    for light in &scene.lights {
        let kind = match light {
            Light::Point(_) => "course",
            Light::Punctual(light) => light.emitter.spelling().kind,
        };
        *lights.entry(kind).or_default() += 1;
    }
    for material in &scene.materials {
        let kind = material.phong().map_or("standard", |_| "phong");
        *materials.entry(kind).or_default() += 1;
    }
    // List the images and the memory of the buffers.
    let images = scene.images.iter().map(|image| ImageReport {
        name: image.name.clone(),
        width: image.width,
        height: image.height,
        bytes: image.pixels.len(),
    });
    ContentReport {
        counts: ContentCounts {
            surfaces: scene.surfaces.len(),
            triangles,
            meshes: scene.meshes.len(),
            materials: scene.materials.len(),
            textures: scene.textures.len(),
            images: scene.images.len(),
            lights: scene.lights.len(),
        },
        shapes,
        materials,
        lights,
        environment: match &scene.environment {
            None => "none",
            Some(environment) if environment.image.is_some() => "image",
            Some(_) => "color",
        },
        bounds: bounds(scene),
        mesh_bytes: scene.meshes.iter().map(mesh_bytes).sum(),
        image_bytes: scene.images.iter().map(|image| image.pixels.len()).sum(),
        images: images.collect(),
    }
}

/// The triangles that a surface shows.
fn triangles_of(shape: &Shape, meshes: &[Mesh]) -> usize {
    if let Shape::Instance(instance) = shape {
        let mesh = meshes.get(instance.mesh.0 as usize);
        return mesh.map_or(0, |mesh| mesh.triangles.len());
    }
    usize::from(matches!(shape, Shape::Triangle(_)))
}

/// The bytes of the numbers of a mesh.
fn mesh_bytes(mesh: &Mesh) -> usize {
    let corners = size_of::<[u32; 3]>() * mesh.triangles.len();
    mesh.positions.bytes()
        + mesh.normals.bytes()
        + mesh.uvs.bytes()
        + mesh.second_uvs.bytes()
        + mesh.tangents.bytes()
        + mesh.colors.bytes()
        + corners
}

/// The bounding box of all bounded shapes; `None` if there is none.
fn bounds(scene: &Scene) -> Option<BoundsReport> {
    let boxes = scene.mesh_boxes();
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for surface in &scene.surfaces {
        let shape = &surface.shape;
        shape.corners_around(&boxes, &mut |at| (low, high) = (low.min(at), high.max(at)));
    }
    // Adding 0 turns −0 into 0.
    let point = |at: Vec3| (at + Vec3::ZERO).to_array();
    (low.is_finite() && high.is_finite()).then(|| BoundsReport {
        low: point(low),
        high: point(high),
    })
}

/// The settings of the picture, and the effects that it requires.
fn settings(validated: &ValidatedScene) -> SettingsReport {
    let Scene {
        camera, settings, ..
    } = &validated.lowered.scene;
    // Find the mode and the samples per pixel.
    let (mode, samples) = match &settings.mode {
        Mode::Phong => ("phong", None),
        Mode::Depth => ("zbuffer", None),
        Mode::Normal => ("normal", None),
        Mode::Gooch(_) => ("gooch", None),
        Mode::Path(path) => ("path", Some(path.samples)),
    };
    let grid = u64::from(settings.supersampling).pow(2);
    // Plan the picture for the status of each effect.
    let plan = Plan::new(&validated.scene, RuleSet::ALL);
    let statuses = plan.statuses.iter().filter(|status| status.of.is_none());
    let effects = statuses.map(|status| EffectReport {
        effect: status.effect.name(),
        status: status.state.name(),
        rule: status.rule.map(Rule::name),
        reason: status.reason.to_string(),
    });
    SettingsReport {
        picture: PictureReport {
            width: camera.size[0],
            height: camera.size[1],
            mode,
            samples_per_pixel: samples.map_or(grid, u64::from),
            max_depth: settings.max_depth,
        },
        camera: CameraReport {
            eye: camera.eye,
            center: camera.center,
            projection: match camera.projection {
                Projection::Perspective => "perspective",
                Projection::Orthographic => "orthographic",
            },
            yfov: camera.yfov(),
        },
        effects: effects.collect(),
    }
}

/// The facts as aligned lines.
fn lines(facts: &Value) -> String {
    let mut lines = FactLines(String::new());
    let count = |value: &Value| HumanCount(value.as_u64().unwrap_or(0)).to_string();
    let bytes = |value: &Value| BinaryBytes(value.as_u64().unwrap_or(0)).to_string();
    let (counts, picture) = (&facts["counts"], &facts["picture"]);
    let samples = count(&picture["samplesPerPixel"]);
    let size = format!("{}×{}", picture["width"], picture["height"]);
    lines.put("file", &word(&facts["file"]));
    let mode = word(&picture["mode"]);
    let of = format!(
        "{size}, {mode}, samples a pixel: {samples}, depth {}",
        picture["maxDepth"]
    );
    lines.put("picture", &of);
    let camera = &facts["camera"];
    let projection = word(&camera["projection"]);
    let (eye, center) = (point(&camera["eye"]), point(&camera["center"]));
    lines.put("camera", &format!("{projection}, from {eye} to {center}"));
    let shapes = each(&facts["shapes"]);
    lines.put(
        "surfaces",
        &format!("{}{shapes}", count(&counts["surfaces"])),
    );
    lines.put("triangles", &count(&counts["triangles"]));
    let (low, high) = (&facts["bounds"]["low"], &facts["bounds"]["high"]);
    if !low.is_null() {
        lines.put("bounds", &format!("{} to {}", point(low), point(high)));
    }
    let meshes = bytes(&facts["meshBytes"]);
    lines.put("meshes", &format!("{}, {meshes}", count(&counts["meshes"])));
    let materials = each(&facts["materials"]);
    lines.put(
        "materials",
        &format!("{}{materials}", count(&counts["materials"])),
    );
    lines.put("textures", &count(&counts["textures"]));
    let images = bytes(&facts["imageBytes"]);
    lines.put("images", &format!("{}, {images}", count(&counts["images"])));
    let lights = each(&facts["lights"]);
    lines.put("lights", &format!("{}{lights}", count(&counts["lights"])));
    lines.put("environment", &word(&facts["environment"]));
    asset_lines(&facts["asset"], &mut lines);
    for state in ["needed", "pruned", "absent"] {
        let rows = facts["effects"].as_array().into_iter().flatten();
        // The status of an effect has the key `verdict` in JSON.
        let rows = rows.filter(|row| row["verdict"] == state);
        let names: Vec<_> = rows.map(|row| word(&row["effect"])).collect();
        if !names.is_empty() {
            lines.put(state, &names.join(", "));
        }
    }
    lines.0
}

fn asset_lines(asset: &Value, lines: &mut FactLines) {
    if asset.is_null() {
        return;
    }
    let (version, generator) = (word(&asset["version"]), word(&asset["generator"]));
    lines.put("glTF", format!("{version} {generator}").trim_end());
    lines.put("contents", each(&asset["counts"]).trim_start_matches(": "));
    for (key, list) in [
        ("extensions", "extensionsUsed"),
        ("required", "extensionsRequired"),
        ("variants", "variants"),
    ] {
        let names = asset[list].as_array().into_iter().flatten();
        let names: Vec<_> = names.map(word).collect();
        if !names.is_empty() {
            lines.put(key, &names.join(", "));
        }
    }
    for own in asset["animations"].as_array().into_iter().flatten() {
        let seconds = shortest(own["seconds"].as_f64().unwrap_or(0.0));
        let name = word(&own["name"]);
        let name = if name.is_empty() { "-" } else { &name };
        lines.put(
            "animation",
            &format!("{name}, {seconds} s, channels: {}", own["channels"]),
        );
    }
}

/// Lines of a name and a value each.
struct FactLines(String);

impl FactLines {
    fn put(&mut self, name: &str, value: &str) {
        self.0 += &format!("{name:<INDENT$}{}\n", clean(value));
    }
}

fn word(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The counts of a map that are not 0, after a colon.
fn each(counts: &Value) -> String {
    let counts = counts.as_object().into_iter().flatten();
    let counts = counts.filter(|(_, count)| count.as_u64() != Some(0));
    let parts: Vec<_> = counts
        .map(|(kind, count)| format!("{kind} {count}"))
        .collect();
    match parts.is_empty() {
        true => String::new(),
        false => format!(": {}", parts.join(", ")),
    }
}

fn point(value: &Value) -> String {
    let numbers = value.as_array().into_iter().flatten();
    let numbers: Vec<_> = numbers
        .map(|number| shortest((number.as_f64().unwrap_or(0.0) * 1e3).round() / 1e3))
        .collect();
    format!("[{}]", numbers.join(", "))
}
