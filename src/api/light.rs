//! Lights that a caller adds to a scene.

use rtc_ir::{self as ir, Emitter, PointLight, Punctual};

/// A light. Colours are linear red, green and blue, each at least 0; lengths are those of the scene.
///
/// A scene with a physical light, which is every one but [`Light::plain`], is shown by the light
/// along all its paths.
#[derive(Clone, Debug, PartialEq)]
pub struct Light(pub(super) ir::Light);

impl Light {
    /// From infinitely far away: `direction` leads to it and has any length but 0, `irradiance` is
    /// that on a surface that faces it.
    #[must_use]
    pub fn sun(direction: [f64; 3], irradiance: [f64; 3]) -> Self {
        Self::physical(Emitter::Sun { direction }, irradiance)
    }

    /// From a point into all directions; `intensity` is power per steradian.
    #[must_use]
    pub fn point(position: [f64; 3], intensity: [f64; 3]) -> Self {
        let range = None;
        Self::physical(Emitter::Point { position, range }, intensity)
    }

    /// From a point towards `direction`: of full `intensity` within the angle `inner`, fading to
    /// none at `outer`, both in radians from the direction, `outer` at most π/2.
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

    /// A light of the course: from a point, or with a radius above 0 from the sphere around it, with
    /// the same strength at any distance.
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
