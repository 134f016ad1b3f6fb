//! Evaluates an arithmetic expression that a file has instead of a number, as `1/3`, `2*0.6` or
//! `-pi/4`, so that a hint can propose its value.

use std::f64::consts::PI;

/// The longest expression that is evaluated, in bytes.
const MAX_LENGTH: usize = 64;

/// The value of an expression, if it is finite. A number without an operator is no expression.
///
/// Dijkstra's shunting-yard algorithm: operators and values wait on two stacks.
pub(super) fn evaluate(text: &str) -> Option<f64> {
    if text.len() > MAX_LENGTH || !text.contains(['+', '-', '*', '/', '^', '(', 'p', 'π', 's']) {
        return None;
    }
    let mut yard = ShuntingYard::default();
    let mut remaining = text.trim_start();
    let mut after_value = false;
    while let Some(sign) = remaining.chars().next() {
        let mut next = remaining.get(sign.len_utf8()..)?;
        match (sign, after_value) {
            ('(', false) => yard.operators.push(Operator::Open),
            (')', true) => yard.close()?,
            ('-', false) => yard.operators.push(Operator::Negate),
            ('+', false) => {}
            (_, false) if remaining.starts_with("sqrt(") => {
                yard.operators.push(Operator::Root);
                next = remaining.strip_prefix("sqrt")?;
            }
            (_, false) => {
                let (value, after) = value(remaining)?;
                yard.values.push(value);
                (next, after_value) = (after, true);
            }
            (_, true) => {
                let (operator, after) = operator(remaining)?;
                yard.push(operator)?;
                (next, after_value) = (after, false);
            }
        }
        remaining = next.trim_start();
    }
    yard.finish()
        .filter(|result| result.is_finite() && after_value)
}

/// A number without a sign, or π.
fn value(text: &str) -> Option<(f64, &str)> {
    for name in ["M_PI", "math.pi", "pi", "PI", "π"] {
        if let Some(remaining) = text.strip_prefix(name) {
            return Some((PI, remaining));
        }
    }
    let end = text.find(|c: char| !c.is_ascii_digit() && c != '.');
    let (number, remaining) = text.split_at(end.unwrap_or(text.len()));
    Some((number.parse().ok()?, remaining))
}

fn operator(text: &str) -> Option<(Operator, &str)> {
    let operators = [
        ("**", Operator::Power),
        ("^", Operator::Power),
        ("+", Operator::Add),
        ("-", Operator::Subtract),
        ("*", Operator::Multiply),
        ("/", Operator::Divide),
    ];
    let mut found = operators.into_iter();
    found.find_map(|(sign, operator)| Some((operator, text.strip_prefix(sign)?)))
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Operator {
    Open,
    Root,
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

impl Operator {
    /// The operator of higher precedence is applied first.
    fn precedence(self) -> u8 {
        match self {
            Self::Open => 0,
            Self::Add | Self::Subtract => 1,
            Self::Multiply | Self::Divide => 2,
            Self::Negate => 3,
            Self::Power => 4,
            Self::Root => 5,
        }
    }
}

#[derive(Default)]
struct ShuntingYard {
    values: Vec<f64>,
    operators: Vec<Operator>,
}

impl ShuntingYard {
    /// Pushes a binary operator, after applying all stacked operators that bind more tightly, or
    /// equally: only powers are right-associative.
    fn push(&mut self, operator: Operator) -> Option<()> {
        let goes_first = |operators: Operator| {
            operators.precedence() > operator.precedence()
                || (operators.precedence() == operator.precedence() && operator != Operator::Power)
        };
        while self.operators.last().is_some_and(|last| goes_first(*last)) {
            self.apply()?;
        }
        self.operators.push(operator);
        Some(())
    }

    /// Applies all operators up to the last open bracket and removes it.
    fn close(&mut self) -> Option<()> {
        while *self.operators.last()? != Operator::Open {
            self.apply()?;
        }
        self.operators.pop();
        Some(())
    }

    /// Applies the last operator to the last values.
    fn apply(&mut self) -> Option<()> {
        let operator = self.operators.pop()?;
        let last = self.values.pop()?;
        let result = match operator {
            Operator::Open => return None,
            Operator::Root => last.sqrt(),
            Operator::Negate => -last,
            Operator::Add => self.values.pop()? + last,
            Operator::Subtract => self.values.pop()? - last,
            Operator::Multiply => self.values.pop()? * last,
            Operator::Divide => self.values.pop()? / last,
            Operator::Power => rtc_math::pow(self.values.pop()?, last),
        };
        self.values.push(result);
        Some(())
    }

    fn finish(mut self) -> Option<f64> {
        while !self.operators.is_empty() {
            self.apply()?;
        }
        let result = self.values.pop()?;
        self.values.is_empty().then_some(result)
    }
}

#[cfg(test)]
mod tests {
    use super::evaluate;

    #[test]
    fn calculations_come_to_what_they_say() {
        for (text, expected) in [
            ("1/3", 1.0 / 3.0),
            ("2*0.6", 1.2),
            ("1 - 2 - 3", -4.0),
            ("2 * (1 + 3) / 4", 2.0),
            ("-2^2", -4.0),
            ("2**3**2", 512.0),
            ("-pi/4", -std::f64::consts::FRAC_PI_4),
            ("sqrt(2*8)", 4.0),
            ("3 * -2", -6.0),
        ] {
            assert_eq!(evaluate(text), Some(expected), "{text}");
        }
        for text in [
            "", "-", "1/0", "1 2", "(1", "1)", "()", "2*", "a/b", "1-", "spam", "p", "1//2",
        ] {
            assert_eq!(evaluate(text), None, "{text}");
        }
    }
}
