//! Writes CSG solids, as objects within objects.

use super::{MaterialNames, SceneWriter};
use crate::export::part_of;
use rtc_ir::{Csg, Scene, Surface};
use rtc_math::SetStep;
use std::fmt::Write as _;

/// An operand, or an operation over others. Operations that are the first operand of the same one
/// are merged with it.
enum CsgNode {
    Operand(usize),
    Operation(SetStep, Vec<CsgNode>),
}

impl CsgNode {
    /// The tree of an expression.
    fn of(steps: &[SetStep]) -> Option<Self> {
        let (mut stack, mut operands) = (Vec::new(), 0..);
        for step in steps {
            if *step == SetStep::Operand {
                stack.push(Self::Operand(operands.next()?));
                continue;
            }
            let (b, a) = (stack.pop()?, stack.pop()?);
            stack.push(match a {
                Self::Operation(operation, mut nodes) if operation == *step => {
                    nodes.push(b);
                    Self::Operation(operation, nodes)
                }
                a @ (Self::Operand(_) | Self::Operation(..)) => Self::Operation(*step, vec![a, b]),
            });
        }
        stack.pop()
    }
}

/// The inputs for writing operands.
struct OperandSurfaces<'a, 's> {
    csg: &'s Csg,
    parts: &'s [Surface],
    scene: &'s Scene,
    materials: &'a mut MaterialNames,
}

impl<'s> SceneWriter<'s> {
    /// Writes a CSG solid whose surfaces are parts of its boundary.
    pub(super) fn csg(
        &mut self,
        csg: &'s Csg,
        parts: &'s [Surface],
        scene: &'s Scene,
        materials: &mut MaterialNames,
    ) -> Result<(), String> {
        let node = match CsgNode::of(&csg.steps).ok_or("the operations over solids do not fit")? {
            // A solid on its own is a union of one.
            node @ CsgNode::Operand(_) => CsgNode::Operation(SetStep::Union, vec![node]),
            node @ CsgNode::Operation(..) => node,
        };
        let mut operands = OperandSurfaces {
            csg,
            parts,
            scene,
            materials,
        };
        self.node(&node, 0, &mut operands)
    }

    fn node(
        &mut self,
        node: &CsgNode,
        indent: usize,
        operands: &mut OperandSurfaces<'_, 's>,
    ) -> Result<(), String> {
        match node {
            CsgNode::Operand(index) => self.operand(*index, indent, operands),
            CsgNode::Operation(operation, nodes) => {
                let word = match operation {
                    SetStep::Operand | SetStep::Union => "union",
                    SetStep::Intersection => "intersection",
                    SetStep::Difference => "difference",
                };
                self.line(indent + 2, &format!("- type: {word}"));
                self.line(indent + 4, "of:");
                let mut nodes = nodes.iter();
                nodes.try_for_each(|node| self.node(node, indent + 4, operands))
            }
        }
    }

    /// Writes an operand as an object, then moves its lines to the right.
    fn operand(
        &mut self,
        index: usize,
        indent: usize,
        operands: &mut OperandSurfaces<'_, 's>,
    ) -> Result<(), String> {
        let start = self.text.len();
        let solid = operands.csg.operands.get(index);
        let part = part_of(operands.parts, index);
        let (Some(solid), Some(part)) = (solid, part) else {
            return Err("an operand of a CSG solid has no surface".to_owned());
        };
        self.shape(&solid.shape(), operands.scene)?;
        self.surface_look(part, operands.scene, operands.materials)?;
        for line in self.text.split_off(start).lines() {
            writeln!(self.text, "{:indent$}{line}", "")
                .expect("a string takes all that is written to it");
        }
        Ok(())
    }
}
