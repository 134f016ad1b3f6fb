//! Passes: transformations of the IR before validation. Each takes a scene and changes it as one
//! run requests; the result is a scene like any other.
//!
//! - [`Overrides`]: numbers that replace those of the scene: picture size, sample counts, depth.
//! - [`set`]: one setting, by its name in the text form of the IR.
//! - [`ViewAndLight`]: camera, integrator, environment and lights of one run. It applies, in this
//!   order: the view ([`Framing`] or an explicit camera), the lights, the environment, the
//!   integrator, the studio, and the ground.
//! - [`Framing`]: a camera that shows the whole scene from an [`OrbitAngles`] direction.
//! - [`studio`](fill): an environment map for scenes without light, and the ground under an asset.
//! - [`emissive_surfaces`]: which surfaces emit light.
//!
//! Passes know neither files nor the command line, and they do not validate: scenes may still have
//! invalid indices or numbers, so every access is checked. A pass that replaces lights or the
//! camera also removes their source spans, so that later diagnostics do not point at replaced
//! values.

mod emission;
mod framing;
mod ground;
mod overrides;
mod settings;
mod studio;
mod view_and_light;

pub use emission::emissive_surfaces;
pub use framing::{Framing, OrbitAngles};
pub use overrides::{CountSetting, Overrides};
pub use settings::set;
pub use studio::{StudioSet, fill};
pub use view_and_light::{
    AppliedViewAndLight, EnvironmentOverride, FillLight, IntegratorChoice, SceneKind, StudioChoice,
    SunLight, View, ViewAndLight, add_light, remove_lights, use_path_integrator,
};
