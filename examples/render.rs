//! Says what is wrong with a scene, and renders it: `cargo run --example render SCENE PICTURE.png`.

#![expect(clippy::print_stderr, reason = "it speaks to the one who runs it")]

use rtc::{Error, Options, Scene};

fn main() -> Result<(), Error> {
    let [from, to] = [1, 2].map(|at| std::env::args().nth(at).unwrap_or_default());
    render(&from, &to)
}

pub(crate) fn render(from: &str, to: &str) -> Result<(), Error> {
    let scene = Scene::open(from)?;
    for finding in scene.check() {
        eprintln!("{finding}\n");
    }
    scene.render(&Options::new().size(160, 120))?.save(to)
}
