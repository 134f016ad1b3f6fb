//! Lights.

use rtc_ir::{self as ir, Photometry, PointLight, Punctual, PunctualKind};

/// A light. Colours are linear red, green and blue, each at least 0; lengths are in scene units.
///
/// A scene with a physical light (any except [`Light::plain`]) is rendered by path tracing. An area
/// light is a surface with an emissive material.
///
/// ```
/// use rtc::Light;
///
/// let lamp = Light::point([0.0, 3.0, 0.0], [40.0; 3]).range(10.0);
/// assert_eq!((lamp.kind(), lamp.position()), ("point", Some([0.0, 3.0, 0.0])));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Light(pub(super) ir::Light);

impl Light {
    /// A directional light. `direction` points to it and has any length but 0; `irradiance` is that
    /// on a surface that faces it.
    #[must_use]
    pub fn sun(direction: [f64; 3], irradiance: [f64; 3]) -> Self {
        Self::physical(PunctualKind::Sun { direction }, irradiance)
    }

    /// A point light. `intensity` is the radiant intensity, power per steradian.
    #[must_use]
    pub fn point(position: [f64; 3], intensity: [f64; 3]) -> Self {
        let range = None;
        Self::physical(PunctualKind::Point { position, range }, intensity)
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
        let emitter = PunctualKind::Spot {
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

    /// A lamp with a measured distribution (type C of LM-63): `candela` is the intensity at each of
    /// the `vertical` angles from the axis `direction`, in degrees, ascending within 0 to 180; for
    /// the first of the `horizontal` angles about it, then for the next. These ascend from 0 to 360
    /// and count from the direction `start`; only 0 is a lamp that is the same all around.
    #[must_use]
    pub fn measured(
        position: [f64; 3],
        [direction, start]: [[f64; 3]; 2],
        [vertical, horizontal]: [&[f64]; 2],
        candela: &[f64],
    ) -> Self {
        let photometry = Photometry {
            name: String::new(),
            vertical: vertical.to_vec(),
            horizontal: horizontal.to_vec(),
            candela: candela.to_vec(),
        };
        let emitter = PunctualKind::Photometric {
            position,
            direction,
            horizontal: start,
            photometry: Box::new(photometry),
        };
        Self::physical(emitter, [1.0; 3])
    }

    /// The distance at which a point or a spot light fades to 0; other lights have none.
    #[must_use]
    pub fn range(mut self, distance: f64) -> Self {
        if let ir::Light::Punctual(light) = &mut self.0
            && let PunctualKind::Point { range, .. } | PunctualKind::Spot { range, .. } =
                &mut light.emitter
        {
            *range = Some(distance);
        }
        self
    }

    /// The same light with another colour: the irradiance of a directional light, the radiant
    /// intensity of a point or a spot light, a factor of measured candelas.
    #[must_use]
    pub fn color(mut self, color: [f64; 3]) -> Self {
        match &mut self.0 {
            ir::Light::Point(light) => light.color = color,
            ir::Light::Punctual(light) => light.intensity = color,
        }
        self
    }

    /// The kind of the light, as scene texts name it: `point`, `sun`, `spot` or `ies`; or `plain`
    /// for one without falloff.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        match &self.0 {
            ir::Light::Point(_) => "plain",
            ir::Light::Punctual(light) => light.emitter.spelling().kind,
        }
    }

    /// The position; `None` for a directional light.
    #[must_use]
    pub fn position(&self) -> Option<[f64; 3]> {
        match &self.0 {
            ir::Light::Point(light) => Some(light.position),
            ir::Light::Punctual(light) => light.emitter.position(),
        }
    }

    /// The direction to a directional light, or the axis of another; `None` for a point light.
    #[must_use]
    pub fn direction(&self) -> Option<[f64; 3]> {
        match &self.0 {
            ir::Light::Point(_) => None,
            ir::Light::Punctual(light) => light.emitter.direction(),
        }
    }

    /// The colour that [`Light::color`] sets.
    #[must_use]
    pub fn intensity(&self) -> [f64; 3] {
        match &self.0 {
            ir::Light::Point(light) => light.color,
            ir::Light::Punctual(light) => light.intensity,
        }
    }

    fn physical(emitter: PunctualKind, intensity: [f64; 3]) -> Self {
        Self(ir::Light::Punctual(Punctual::new(emitter, intensity)))
    }
}
