//! Transforms: the stack of operations of a prim (`UsdGeomXformable`).

use super::Lowering;
use super::stage::ComposedPrim;
use crate::exchange::transform::AffineTransform;
use rtc_diag::{clip_path, codes};
use rtc_math::Vec3;
use rtc_source::Resource;

/// The nodes of the budget that an operation counts as.
const OPERATION: u64 = 2;

impl Lowering<'_> {
    /// The map from a prim to its parent, and whether it forgets those above.
    pub(super) fn local(&mut self, prim: &ComposedPrim) -> (AffineTransform, bool) {
        let (mut all, mut resets) = (AffineTransform::IDENTITY, false);
        let order = self.texts(prim, "xformOpOrder").unwrap_or_default();
        // Every prim that inherits a stack computes it anew.
        let nodes = OPERATION * order.len() as u64;
        let charged = self.charge(Resource::Nodes, nodes, self.root_span);
        for name in order.into_iter().filter(|_| charged.is_some()) {
            if name == "!resetXformStack!" {
                (all, resets) = (AffineTransform::IDENTITY, true);
                continue;
            }
            let inverted = name.strip_prefix("!invert!");
            let operation = self.operation(prim, inverted.unwrap_or(&name));
            let operation = match inverted {
                Some(_) => operation.and_then(|operation| operation.inverse()),
                None => operation,
            };
            match operation {
                Some(operation) => all = all.after(&operation),
                None => {
                    let span = self.property_span(prim, "xformOpOrder");
                    let path = clip_path(&prim.path).into_owned();
                    let name = clip_path(&name);
                    let message = format!("`{name}` of `{path}` is no transform: it is left out");
                    self.report(&codes::USD_UNSUPPORTED, span, message);
                }
            }
        }
        (all, resets)
    }

    /// One operation; an attribute without a value does nothing.
    fn operation(&self, prim: &ComposedPrim, name: &str) -> Option<AffineTransform> {
        let kind = name.strip_prefix("xformOp:")?.split(':').next()?;
        let Some(numbers) = self.numbers(prim, name) else {
            return Some(AffineTransform::IDENTITY);
        };
        let (axes, angle) = (["X", "Y", "Z"], numbers.first().copied()?);
        let along = |axis: usize, value: f64, rest: f64| {
            let mut vector = [rest; 3];
            vector[axis] = value;
            vector
        };
        let three = || -> Option<[f64; 3]> { numbers.get(..3)?.try_into().ok() };
        let transform = match kind {
            "translate" => AffineTransform::translation(three()?),
            "scale" => AffineTransform::scale(three()?),
            "orient" => turned(numbers.get(..4)?.try_into().ok()?)?,
            "transform" => {
                let row = |at: usize| Some(Vec3::from_slice(numbers.get(4 * at..4 * at + 3)?));
                AffineTransform([row(0)?, row(1)?, row(2)?, row(3)?])
            }
            _ => {
                if let Some(rest) = kind.strip_prefix("translate") {
                    let axis = axes.iter().position(|axis| *axis == rest)?;
                    AffineTransform::translation(along(axis, angle, 0.0))
                } else if let Some(rest) = kind.strip_prefix("scale") {
                    let axis = axes.iter().position(|axis| *axis == rest)?;
                    AffineTransform::scale(along(axis, angle, 1.0))
                } else {
                    // `rotateXYZ` turns about x first.
                    let order = kind.strip_prefix("rotate")?;
                    let mut all = AffineTransform::IDENTITY;
                    for letter in order.chars() {
                        let axis = "XYZ".find(letter)?;
                        let angle = *numbers.get(if order.len() == 1 { 0 } else { axis })?;
                        let turn = AffineTransform::rotation(along(axis, 1.0, 0.0), angle)?;
                        all = turn.after(&all);
                    }
                    all
                }
            }
        };
        transform
            .0
            .iter()
            .all(|column| column.is_finite())
            .then_some(transform)
    }
}

/// The turn by a quaternion, its real part first; `None` if it is zero.
pub(super) fn turned(quaternion: [f64; 4]) -> Option<AffineTransform> {
    let length = quaternion
        .iter()
        .map(|part| part * part)
        .sum::<f64>()
        .sqrt();
    if length <= 0.0 || !length.is_finite() {
        return None;
    }
    let [w, x, y, z] = quaternion.map(|part| part / length);
    let column = |a: f64, b: f64, c: f64| Vec3::new(a, b, c);
    Some(AffineTransform([
        column(
            1.0 - 2.0 * (y * y + z * z),
            2.0 * (x * y + w * z),
            2.0 * (x * z - w * y),
        ),
        column(
            2.0 * (x * y - w * z),
            1.0 - 2.0 * (x * x + z * z),
            2.0 * (y * z + w * x),
        ),
        column(
            2.0 * (x * z + w * y),
            2.0 * (y * z - w * x),
            1.0 - 2.0 * (x * x + y * y),
        ),
        Vec3::ZERO,
    ]))
}
