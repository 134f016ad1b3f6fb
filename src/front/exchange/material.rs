//! Materials that several readers make.

use rtc_ir::Standard;

/// A base colour without transparency, within the range of the IR.
pub(crate) fn opaque([r, g, b]: [f64; 3]) -> [f64; 4] {
    [r, g, b, 1.0].map(|channel: f64| channel.clamp(0.0, 1.0))
}

/// A Lambertian surface with two sides.
pub(crate) fn matte(color: [f64; 3]) -> Standard {
    Standard {
        base_color: opaque(color),
        metallic: 0.0,
        roughness: 1.0,
        specular: 0.0,
        double_sided: true,
        ..Standard::default()
    }
}
