//! Assets and the set-ups of their references, for the drivers that measure: a JSON file names the
//! asset, the camera and the lights.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a measurement stops at the first surprise, and reads what it measures"
)]

use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{
    Camera, Environment, Lens, Light, LoweredScene, Mode, PathSettings as Paths, Projection,
    Punctual, PunctualKind, Scene,
};
use rtc::internals::math::{Vec3, camera_basis};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::source::SourceMap;
use rtc::internals::valid::ValidScene;
use serde_json::Value;
use std::path::Path;

/// The scene of an asset, by its file.
pub(crate) fn load(asset: &Path) -> LoweredScene {
    let (mut options, mut map, mut sink) = (
        Options::default(),
        SourceMap::default(),
        DiagnosticSink::default(),
    );
    options.front.asset_root = asset.parent().map(Path::to_path_buf);
    let file = map.add(asset.to_str().unwrap(), std::fs::read(asset).unwrap());
    pipeline::load(file, &mut map, &options, &mut sink).unwrap_or_else(|| panic!("{sink:?}"))
}

/// The scene of a set-up, by the file of that, with so many paths a pixel.
pub(crate) fn load_set_up(path: &Path, samples: u32) -> LoweredScene {
    let set_up: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let mut lowered = load(
        &path
            .parent()
            .unwrap()
            .join(set_up["asset"].as_str().unwrap()),
    );
    put_up(&mut lowered.scene, &set_up, samples);
    lowered
}

/// The scene, proven.
pub(crate) fn validate(lowered: &LoweredScene) -> ValidScene {
    let mut sink = DiagnosticSink::default();
    pipeline::validate(lowered, &Options::default(), &mut sink)
        .unwrap_or_else(|| panic!("{sink:?}"))
}

/// Camera, lights and surroundings of the set-up in place of those of the asset.
fn put_up(scene: &mut Scene, setup: &Value, samples: u32) {
    let triple = |value: &Value| [0, 1, 2].map(|k| value[k].as_f64().unwrap());
    let (camera, lights) = (&setup["camera"], &setup["lights"]);
    let size = [&setup["width"], &setup["height"]]
        .map(|side| u32::try_from(side.as_u64().unwrap()).unwrap());
    let [eye, center, up] = [&camera["position"], &camera["look_at"], &camera["up"]].map(triple);
    let distance = Vec3::from_array(center).distance(Vec3::from_array(eye));
    let half = libm::tan(camera["yfov_deg"].as_f64().unwrap().to_radians() / 2.0);
    let pixel = Vec3::from_array(up) * (2.0 * half * distance / f64::from(size[1]));
    let (right, up) = camera_basis(Vec3::from_array(eye), Vec3::from_array(center), pixel).unwrap();
    let lens = Lens {
        radius: 0.0,
        samples: 1,
    };
    let (right, up) = (right.to_array(), up.to_array());
    scene.camera = Camera {
        eye,
        center,
        right,
        up,
        size,
        lens,
        projection: Projection::Perspective,
    };
    let radiance = triple(&lights["env_radiance"]);
    scene.environment = Some(Environment {
        radiance,
        image: None,
        image_from_world: None,
    });
    let sun = |sun: &Value| {
        let emitter = PunctualKind::Sun {
            direction: triple(&sun["direction_to_light"]),
        };
        Light::Punctual(Punctual {
            emitter,
            intensity: triple(&sun["irradiance"]),
            projected: None,
        })
    };
    scene.lights = lights["suns"].as_array().unwrap().iter().map(sun).collect();
    scene.settings.mode = Mode::Path(Paths {
        samples,
        multiple_scattering: false,
        ..Paths::default()
    });
    scene.settings.max_depth = u32::try_from(setup["max_bounces"].as_u64().unwrap()).unwrap();
}
