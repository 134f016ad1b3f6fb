//! Passes: a scene in, the same scene changed out, before it is proven. What one run asks for that
//! the scene does not say itself: other settings, another view, other light, the studio, a ground.

mod framing;
mod ground;
mod lit;
mod overrides;
mod settings;
mod stage;
mod studio;

pub use framing::{Framing, Orbit};
pub use lit::glowing;
pub use overrides::Overrides;
pub use settings::set;
pub use stage::{
    EnvironmentOverride, FillLight, IntegratorChoice, SceneKind, StagedScene, StudioChoice, Sun,
    View, ViewAndLight, add_light, remove_lights,
};
pub use studio::fill;
