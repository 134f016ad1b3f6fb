//! The microfacets of rough BSDFs, also of those whose roughness is a checkerboard.

use super::Lowering;
use super::bsdf::rows;
use super::xml::PluginNode;
use crate::exchange::checkerboard::checkerboard;
use rtc_color::luminance;
use rtc_ir::{EntityKind, Map, Standard};
use rtc_math::Microfacets;
use std::f64::consts::FRAC_PI_2;

/// The microfacets of a BSDF.
pub(super) struct Facets {
    model: Microfacets,
    /// The widths along u and v, on both colours of a checkerboard.
    widths: [Widths; 2],
    /// The rows of the map from the surface to squares, if both differ.
    squares: Option<[[f64; 3]; 2]>,
}

/// The widths α along u and v.
#[derive(Clone, Copy, PartialEq)]
struct Widths([f64; 2]);

impl Widths {
    /// The standard material has the lesser width everywhere, and in one direction
    /// α + (1 − α)·strength² (`KHR_materials_anisotropy`).
    fn strength(self) -> f64 {
        let Self([u, v]) = self;
        let (least, most) = (u.min(v), u.max(v));
        match least < 1.0 {
            true => ((most - least) / (1.0 - least)).sqrt(),
            false => 0.0,
        }
    }

    /// √α of the lesser width.
    fn roughness(self) -> f64 {
        let Self([u, v]) = self;
        u.min(v).sqrt()
    }

    /// Whether v has the greater width.
    fn is_along_v(self) -> bool {
        let Self([u, v]) = self;
        u < v
    }
}

impl Facets {
    /// No roughness.
    const SMOOTH: Self = Self {
        model: Microfacets::Ggx,
        widths: [Widths([0.0; 2]); 2],
        squares: None,
    };
}

impl<'run> Lowering<'run> {
    /// A material with the microfacets of a BSDF.
    pub(super) fn with_facets(
        &mut self,
        node: &'run PluginNode,
        flip: bool,
        base: Standard,
    ) -> Standard {
        let Facets {
            model,
            widths: [first, second],
            squares,
        } = self.facets(node, flip);
        // One width everywhere.
        let plain = Standard {
            roughness: first.roughness(),
            microfacets: model,
            anisotropy: first.strength(),
            anisotropy_rotation: if first.is_along_v() { FRAC_PI_2 } else { 0.0 },
            ..base
        };
        let Some(squares) = squares.filter(|_| first != second) else {
            return plain;
        };
        // Or that of the squares, as fractions of the greatest.
        let both = [first, second];
        let share = |part: f64, whole: f64| if whole > 0.0 { part / whole } else { 0.0 };
        let roughness = first.roughness().max(second.roughness());
        let strength = first.strength().max(second.strength());
        let shades = both.map(|widths| [1.0, share(widths.roughness(), roughness), 1.0]);
        let turns = both.map(|widths| {
            let strength = share(widths.strength(), strength);
            match widths.is_along_v() {
                true => [0.5, 1.0, strength],
                false => [1.0, 0.5, strength],
            }
        });
        Standard {
            roughness,
            metallic_roughness_map: self.squares(node, shades, squares),
            anisotropy: strength,
            anisotropy_rotation: 0.0,
            anisotropy_map: match strength > 0.0 {
                true => self.squares(node, turns, squares),
                false => None,
            },
            ..plain
        }
    }

    /// The map of a checkerboard, unless both its colours are white.
    fn squares(
        &mut self,
        node: &PluginNode,
        colors: [[f64; 3]; 2],
        rows: [[f64; 3]; 2],
    ) -> Option<Map> {
        if colors == [[1.0; 3]; 2] {
            return None;
        }
        let index = self.scene.textures.len();
        self.record(EntityKind::Texture, index, node.span);
        Some(checkerboard(colors, rows, &mut self.scene))
    }

    fn facets(&mut self, node: &'run PluginNode, flip: bool) -> Facets {
        if !matches!(
            node.plugin.text.as_str(),
            "roughconductor" | "roughdielectric" | "roughplastic" | "pplastic"
        ) {
            return Facets::SMOOTH;
        }
        let distribution = node.string("distribution");
        let model = match distribution.map(|name| name.text.as_str()) {
            Some("ggx") => Microfacets::SeparableGgx,
            _ => Microfacets::Beckmann,
        };
        // Read the widths, of which each may be a checkerboard.
        let has = |name: &str| node.get(name).is_some() || node.child(name).is_some();
        let [of_u, of_v] = ["alpha_u", "alpha_v"].map(|name| {
            let name = if has(name) { name } else { "alpha" };
            self.width(node, name, flip)
        });
        let ((u, of_u), (v, of_v)) = (of_u, of_v);
        if of_u.zip(of_v).is_some_and(|(u, v)| u != v) {
            let message = "`alpha_v` has the squares of `alpha_u`";
            self.approximate(node.plugin.span, message);
        }
        Facets {
            model,
            widths: [0, 1].map(|k: usize| Widths([u[k], v[k]])),
            squares: of_u.or(of_v),
        }
    }

    /// A width on both colours of a checkerboard, and the rows of its map.
    fn width(
        &mut self,
        node: &'run PluginNode,
        name: &str,
        flip: bool,
    ) -> ([f64; 2], Option<[[f64; 3]; 2]>) {
        /// The width without a property.
        const DEFAULT: f64 = 0.1;
        let texture = node.child(name).and_then(|child| self.resolve(child));
        match texture {
            None => {
                let width = node.color(name).map_or(DEFAULT, luminance).clamp(0.0, 1.0);
                ([width; 2], None)
            }
            Some(texture) if texture.plugin.text == "checkerboard" => {
                let grey = |name: &str, default: f64| {
                    let color = texture.color(name).unwrap_or([default; 3]);
                    color[1].clamp(0.0, 1.0)
                };
                let widths = [grey("color0", 0.4), grey("color1", 0.2)];
                let squares = rows(texture, flip).map(|row| row.map(|number| 2.0 * number));
                (widths, Some(squares))
            }
            Some(_) => {
                let message = format!("a texture of `{name}` is left out");
                self.approximate(node.plugin.span, message);
                ([DEFAULT; 2], None)
            }
        }
    }
}
