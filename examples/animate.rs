//! A film of a scene that is built in code: `cargo run --example animate FOLDER` writes its frames.
//! `ffmpeg -i FOLDER/%02d.png film.mp4` joins them.

use rtc::{
    Camera, Diagnostic, Error, Light, ObjectId, Options, Phong, Scene, SceneBuilder, Shape, Texture,
};
use std::path::Path;

const FRAMES: u32 = 24;

fn main() -> Result<(), Error> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".to_owned());
    film(Path::new(&folder), &Options::new())
}

pub(crate) fn film(folder: &Path, options: &Options) -> Result<(), Error> {
    let (scene, ball) = scene().map_err(Error::Invalid)?;
    // A copy shares what does not change, so each frame may have its own.
    for frame in 0..FRAMES {
        let mut scene = scene.clone();
        let turn = f64::from(frame) / f64::from(FRAMES);
        scene
            .edit(|scene| bounce(scene, ball, turn))
            .map_err(Error::Invalid)?;
        scene
            .render(options)?
            .save(folder.join(format!("{frame:02}.png")))?;
    }
    Ok(())
}

/// The scene, and the ball that moves in it.
fn scene() -> Result<(Scene, ObjectId), Vec<Diagnostic>> {
    let camera = Camera::look_at([0.0, 2.0, 9.0], [0.0, 1.2, 0.0]);
    let mut scene = SceneBuilder::new(camera.fov(30.0).size(160, 120));
    scene.shadows(true);
    scene.supersampling(2);
    scene.light(Light::plain([4.0, 8.0, 6.0], [1.0; 3], 0.0));
    let tiles = Texture::checker([[0.85; 3], [0.35, 0.45, 0.55]], 1.0).in_world();
    let tiles = scene.texture(tiles);
    let floor = Shape::plane([0.0; 3], [0.0, 1.0, 0.0]);
    scene.add(floor, Phong::default().color_map(tiles).ka(0.2).kd(0.8));
    let red = Phong::default()
        .color([0.9, 0.2, 0.1])
        .ka(0.2)
        .kd(0.7)
        .ks(0.3)
        .n(30.0);
    let ball = scene.add(Shape::sphere([0.0, 1.0, 0.0], 0.6), red);
    Ok((scene.build()?, ball))
}

/// Moves the ball: it rises and falls again, and is flat where it touches the floor.
fn bounce(scene: &mut SceneBuilder, ball: ObjectId, turn: f64) {
    let fall = (turn * 2.0 - 1.0) * (turn * 2.0 - 1.0);
    let close = fall * fall * fall * fall;
    let flat = 1.0 - 0.35 * close * close * close;
    let (radius, wide) = (0.6 * flat, 0.6 / flat.sqrt());
    let center = [0.0, radius + 1.6 * (1.0 - fall), 0.0];
    let axes = [[wide, 0.0, 0.0], [0.0, radius, 0.0], [0.0, 0.0, wide]];
    scene.set_shape(ball, Shape::ellipsoid(center, axes));
}
