//! Shows a scene in another light: `cargo run --example custom_light SCENE PICTURE.png`.

use rtc::{Error, Light, Options, Scene, Severity};

fn main() -> Result<(), Error> {
    let [from, to] = [1, 2].map(|at| std::env::args().nth(at).unwrap_or_default());
    let evening = Light::sun([1.0, 0.4, 0.6], [3.0, 1.6, 0.8]);
    relight(&from, &to, evening)
}

pub(crate) fn relight(from: &str, to: &str, light: Light) -> Result<(), Error> {
    let mut scene = Scene::open(from)?;
    scene.remove_lights();
    scene.add_light(light);
    // A fault of the light is found like one of the text.
    let mut findings = scene.check();
    findings.retain(|finding| finding.severity == Severity::Error);
    if !findings.is_empty() {
        return Err(Error::Invalid(findings));
    }
    let options = Options::new().size(160, 120).samples(16);
    scene
        .render(&options.environment([0.1, 0.15, 0.3]))?
        .save(to)
}
