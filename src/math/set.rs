//! Expressions of sets in postfix order, and their value at a point.

use arbitrary::Arbitrary;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The largest number of operands of an expression: a bit of a `u64` for each.
pub const MAX_SET_OPERANDS: usize = 64;

/// A step of an expression of sets in postfix order, over a stack of sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, Arbitrary)]
#[serde(rename_all = "camelCase")]
pub enum SetStep {
    /// Pushes the next operand.
    Operand,
    /// Replaces the two sets on top by their union.
    Union,
    /// Replaces the two sets on top by their intersection.
    Intersection,
    /// Replaces the two sets on top by the lower one without the upper one.
    Difference,
}

/// Whether the steps take this number of operands, at most [`MAX_SET_OPERANDS`], and leave one set.
#[must_use]
pub fn is_set_expression(steps: &[SetStep], operands: usize) -> bool {
    let mut depth = 0_usize;
    let mut taken = 0;
    for step in steps {
        match step {
            SetStep::Operand => (depth, taken) = (depth + 1, taken + 1),
            SetStep::Union | SetStep::Intersection | SetStep::Difference if depth < 2 => {
                return false;
            }
            SetStep::Union | SetStep::Intersection | SetStep::Difference => depth -= 1,
        }
    }
    depth == 1 && taken == operands && operands <= MAX_SET_OPERANDS
}

/// Whether a point is in the set, by a bit for each operand that it is in.
#[must_use]
pub fn evaluate_set(steps: &[SetStep], inside: u64) -> bool {
    // The stack is one machine word, with its top at the lowest bit.
    let (mut stack, mut rest) = (0_u64, inside);
    for step in steps {
        if *step == SetStep::Operand {
            stack = stack << 1 | rest & 1;
            rest >>= 1;
            continue;
        }
        let (top, below) = (stack & 1, stack >> 1 & 1);
        let value = match step {
            SetStep::Operand | SetStep::Union => below | top,
            SetStep::Intersection => below & top,
            SetStep::Difference => below & !top,
        };
        stack = stack >> 2 << 1 | value;
    }
    stack & 1 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use SetStep::{Difference, Intersection, Operand, Union};

    #[test]
    fn an_expression_has_the_value_of_its_operations() {
        // (a − b) ∪ (c ∩ d).
        let steps = [
            Operand,
            Operand,
            Difference,
            Operand,
            Operand,
            Intersection,
            Union,
        ];
        assert!(is_set_expression(&steps, 4));
        for inside in 0..16_u64 {
            let [a, b, c, d] = [0, 1, 2, 3].map(|bit| inside >> bit & 1 == 1);
            assert_eq!(evaluate_set(&steps, inside), (a && !b) || (c && d));
        }
    }

    #[test]
    fn what_leaves_no_set_or_two_is_no_expression() {
        for steps in [&[][..], &[Operand, Operand], &[Operand, Union], &[Union]] {
            assert!(!is_set_expression(steps, 1) && !is_set_expression(steps, 2));
        }
        assert!(!is_set_expression(&[Operand], 2));
    }
}
