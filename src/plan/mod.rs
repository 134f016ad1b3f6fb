//! What the picture of a scene really needs: each effect with its verdict and the reason, and the work that is left.
//!
//! A plan changes no bit of the picture. A rule leaves out only what it proves to add exactly nothing: a term with a
//! factor of 0 whose other factors are finite (validation bounds every number by 1e60, so each local term is), a ray
//! that can meet nothing, a sample that equals its neighbour. Sums keep their order, and random numbers are keyed by
//! pixel, sample and path, so that leaving one out shifts no other.

mod effect;
mod features;
mod precision;
mod region;
mod rule;

pub use effect::{Effect, State, Verdict};
pub use features::{Features, Shapes};
pub use precision::{Loss, NEAREST, Symptom, loss};
pub use region::{Region, Sight};
pub use rule::{Rule, Rules};

use crate::math::Vec3;
use crate::valid::{Mode, Pattern, Shape, ValidScene};

/// By which arithmetic rays meet shapes; shading is always in f64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arithmetic {
    /// f64 with bounds on its errors.
    #[default]
    Robust,
    /// The formulas of textbooks in f64, with a fixed threshold.
    Plain,
    /// The same formulas in f32.
    F32,
}

/// What is left of a light.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightPlan {
    /// Whether it adds anything.
    pub kept: bool,
    /// Whether it adds more than its ambient term.
    pub direct: bool,
    /// Per surface of the scene, whether something may stand between it and the light.
    pub shadowed: Vec<bool>,
}

/// The work that a picture needs.
#[derive(Clone, Debug)]
pub struct Plan {
    /// By which arithmetic rays meet shapes.
    pub arithmetic: Arithmetic,
    /// The rules that were allowed to leave something out.
    pub rules: Rules,
    /// What the integrator must be able to do.
    pub features: Features,
    /// The shapes that rays may meet.
    pub shapes: Shapes,
    /// Per light of the scene.
    pub lights: Vec<LightPlan>,
    /// Per surface of the scene, whether a ray may meet it.
    pub surfaces: Vec<bool>,
    /// Per texture of the scene, its value if it has only one.
    pub constants: Vec<Option<Vec3>>,
    /// Bounces after the first hit that may add something.
    pub max_depth: u32,
    /// What each pixel may show.
    pub region: Region,
    /// What became of each effect, and why.
    pub verdicts: Vec<Verdict>,
}

impl Plan {
    /// Plans the picture with the rules given.
    #[must_use]
    pub fn new(scene: &ValidScene, rules: Rules) -> Self {
        let settings = scene.settings();
        let light = || LightPlan { kept: true, direct: true, shadowed: vec![true; scene.surfaces().len()] };
        Self {
            arithmetic: Arithmetic::Robust,
            rules,
            features: features(scene, rules),
            shapes: shapes(scene),
            lights: scene.lights().iter().map(|_| light()).collect(),
            surfaces: vec![true; scene.surfaces().len()],
            constants: vec![None; scene.textures().len()],
            max_depth: if let Mode::Phong | Mode::Path(_) = settings.mode { settings.max_depth } else { 0 },
            region: Region::default(),
            verdicts: Vec::new(),
        }
    }

    /// Plans the picture by an arithmetic, with all rules that add exactly nothing by it: what is proven of the shapes
    /// is proven for the robust one.
    #[must_use]
    pub fn by(arithmetic: Arithmetic, scene: &ValidScene) -> Self {
        let rules = match arithmetic {
            Arithmetic::Robust => Rules::ALL,
            Arithmetic::Plain | Arithmetic::F32 => Rules::AT_HITS,
        };
        Self { arithmetic, ..Self::new(scene, rules) }
    }

    /// Whether the picture needs an effect, of whatever entity.
    #[must_use]
    pub fn needs(&self, effect: Effect) -> bool {
        self.verdicts.iter().any(|verdict| verdict.effect == effect && verdict.state == State::Needed)
    }
}

/// What the language asks of the integrator.
fn features(scene: &ValidScene, rules: Rules) -> Features {
    let (settings, lens) = (scene.settings(), &scene.camera().lens);
    let materials = || scene.materials().iter();
    let soft = settings.light_samples.get() > 1 && scene.lights().iter().any(|light| light.radius.get() > 0.0);
    let glossy = materials().any(|material| material.glossy_samples.get() > 1);
    let several = settings.supersampling.get() > 1 || settings.pattern != Pattern::Grid;
    let with_lens = lens.radius.get() > 0.0 && lens.samples.get() > 1;
    let phong = matches!(settings.mode, Mode::Phong);
    let shades = phong || matches!(settings.mode, Mode::Gooch(_));
    let mut features = Features::NONE;
    let mut add = |feature, condition: bool| features = if condition { features.with(feature) } else { features };
    add(Features::CAMERA, several || with_lens);
    add(Features::MAPS, maps(scene));
    add(Features::LIGHT, phong);
    add(Features::HIGHLIGHT, shades);
    add(Features::GOOCH, shades && !phong);
    add(Features::SHADOW, phong && settings.shadows);
    add(Features::BOUNCE, phong && settings.max_depth > 0);
    add(Features::SAMPLED, phong && (soft || glossy));
    add(Features::NAIVE, !rules.contains_all(Rules::AT_HITS));
    features
}

fn maps(scene: &ValidScene) -> bool {
    let has_normals =
        |shape: &Shape| matches!(shape, Shape::Instance(instance) if !scene.meshes()[instance.mesh].normals.is_empty());
    scene.materials().iter().any(|material| material.maps.is_some())
        || scene.surfaces().iter().any(|surface| has_normals(&surface.shape))
}

fn shapes(scene: &ValidScene) -> Shapes {
    let is_basic = |shape: &Shape| matches!(shape, Shape::Sphere(_) | Shape::Plane(_) | Shape::Triangle(_));
    if scene.surfaces().iter().all(|surface| is_basic(&surface.shape)) { Shapes::Basic } else { Shapes::All }
}
