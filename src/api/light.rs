//! Lights that a caller adds to a scene.

use rtc_ir::{self as ir, Emitter, PointLight, Punctual};

/// A light. Colours are linear red, green and blue, each at least 0; lengths are in scene units.
///
/// A scene with a physical light (any except [`Light::plain`]) is rendered by path tracing.
#[derive(Clone, Debug, PartialEq)]
pub struct Light(pub(super) ir::Light);

impl Light {
    /// A directional light. `direction` points to it and has any length but 0; `irradiance` is that
    /// on a surface that faces it.
    #[must_use]
    pub fn sun(direction: [f64; 3], irradiance: [f64; 3]) -> Self {
        Self::physical(Emitter::Sun { direction }, irradiance)
    }

    /// A point light. `intensity` is the radiant intensity, power per steradian.
    #[must_use]
    pub fn point(position: [f64; 3], intensity: [f64; 3]) -> Self {
        let range = None;
        Self::physical(Emitter::Point { position, range }, intensity)
    }

    /// A spot light with axis `direction`: full `intensity` within the angle `inner` from the axis,
    /// falling to 0 at `outer`. Both are in radians, `outer` is at most π/2.
    #[must_use]
    pub fn spot(
        position: [f64; 3],
        direction: [f64; 3],
        [inner, outer]: [f64; 2],
        intensity: [f64; 3],
    ) -> Self {
        let emitter = Emitter::Spot {
            position,
            direction,
            inner_angle: inner,
            outer_angle: outer,
            range: None,
        };
        Self::physical(emitter, intensity)
    }

    /// A light of the course, without falloff: a point light, or with a radius above 0 a spherical
    /// light.
    #[must_use]
    pub fn plain(position: [f64; 3], color: [f64; 3], radius: f64) -> Self {
        Self(ir::Light::Point(PointLight {
            position,
            color,
            radius,
        }))
    }

    fn physical(emitter: Emitter, intensity: [f64; 3]) -> Self {
        Self(ir::Light::Punctual(Punctual { emitter, intensity }))
    }
}
