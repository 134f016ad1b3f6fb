//! Passes: a scene in, the same scene changed out, before it is proven. What one run asks for that
//! the scene does not say itself: other settings, another view, other light, the studio, a ground.

mod emission;
mod framing;
mod ground;
mod overrides;
mod settings;
mod studio;
mod view_and_light;

pub use emission::emissive_surfaces;
pub use framing::{Framing, Orbit};
pub use overrides::Overrides;
pub use settings::set;
pub use studio::fill;
pub use view_and_light::{
    AppliedViewAndLight, EnvironmentOverride, FillLight, IntegratorChoice, SceneKind, StudioChoice,
    Sun, View, ViewAndLight, add_light, remove_lights,
};
