//! Builds a scene in code, renders it and saves the picture: `cargo run --example build
//! PICTURE.png`.

use rtc::{
    Camera, Diagnostic, Error, Filter, Light, Mesh, Options, Phong, Scene, SceneBuilder, Shape,
    Texture, Transform,
};

fn main() -> Result<(), Error> {
    let to = std::env::args().nth(1).unwrap_or_default();
    let scene = scene().map_err(Error::Invalid)?;
    scene.render(&Options::new().supersampling(3))?.save(to)
}

pub(crate) fn scene() -> Result<Scene, Vec<Diagnostic>> {
    let camera = Camera::look_at([3.0, 4.0, 9.0], [0.0, 0.9, 0.0]);
    let mut scene = SceneBuilder::new(camera.fov(32.0).size(240, 160));
    scene.shadows(true);
    scene.depth(3);
    scene.light(Light::plain([6.0, 9.0, 8.0], [0.9; 3], 0.0));
    scene.light(Light::plain([-8.0, 6.0, 4.0], [0.3, 0.3, 0.4], 0.0));

    // A chequered floor: a quad with a texture of four pixels.
    let [dark, light] = [[70, 80, 95], [225, 225, 215]];
    let pixels = [dark, light, light, dark].concat();
    let tiles = scene.texture(Texture::rgb8(2, 2, pixels).filter(Filter::Nearest));
    let floor = [
        [-6.0, 0.0, 6.0],
        [6.0, 0.0, 6.0],
        [6.0, 0.0, -6.0],
        [-6.0, 0.0, -6.0],
    ];
    scene.add(
        Shape::quad(floor),
        Phong::default().color_map(tiles).ka(0.1).kd(0.8),
    );

    // Simple shapes.
    let mirror = Phong::default()
        .color([0.9, 0.6, 0.3])
        .kd(0.3)
        .ks(0.6)
        .n(60.0);
    scene.add(Shape::sphere([-1.6, 1.0, 0.0], 1.0), mirror);
    let red = Phong::default().color([0.8, 0.15, 0.1]).ka(0.1).kd(0.7);
    scene.add(
        Shape::torus([1.5, 0.3, 1.6], [0.0, 1.0, 0.0], 0.7, 0.3),
        red,
    );

    // A mesh, placed three times.
    let pyramid = scene.mesh(pyramid());
    let green = scene.material(Phong::default().color([0.2, 0.55, 0.3]).ka(0.1).kd(0.8));
    for step in 0..3 {
        let (height, at) = (0.8 + 0.5 * f64::from(step), f64::from(step) * 1.1);
        let placed = Transform::new()
            .scale([0.5, height, 0.5])
            .rotate([0.0, 1.0, 0.0], 0.4 * at)
            .translate([0.6 + at, 0.0, -1.2]);
        scene.add(Shape::instance(pyramid, placed), green);
    }
    scene.build()
}

/// A pyramid of height 1 over a square of side 2.
fn pyramid() -> Mesh {
    let corners = [
        [-1.0, 0.0, 1.0_f32],
        [1.0, 0.0, 1.0],
        [1.0, 0.0, -1.0],
        [-1.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
    ];
    Mesh::new(&corners, &[[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
}
