//! Checks of single values: each takes a number and returns one with a guaranteed range, or reports
//! a diagnostic at its position.

use rtc_diag::codes::{self, Code};
use rtc_diag::{Diagnostic, DiagnosticSink, Severity};
use rtc_ir::{EntityField, EntityKind, SourceSpans, ValuePath};
use rtc_math::{Id, NonNegative, Positive, Vec3, shortest, unit_scale};
use rtc_source::Limits;
use std::num::NonZeroU32;

/// Options of the validation.
#[derive(Clone, Copy, Debug, Default)]
pub struct ValidationOptions {
    /// The limits on the pixels and the rays of the picture.
    pub limits: Limits,
}

/// The largest absolute value of a coordinate. The sphere test computes fourth powers of lengths,
/// and these stay finite.
pub const LARGEST: f64 = 1e60;

/// The smallest nonzero length: its fourth power is still a normal number.
pub(super) const SMALLEST: f64 = 1e-60;

/// What surfaces are checked against: the number of entities, the exclusive bound of indices, and
/// the shutter.
pub(super) struct EntityCounts {
    pub(super) textures: usize,
    pub(super) meshes: usize,
    pub(super) materials: usize,
    /// When it opens and closes.
    pub(super) shutter: [f64; 2],
}

/// The state of one validation.
pub(super) struct Checker<'run> {
    source_spans: &'run SourceSpans,
    sink: &'run mut DiagnosticSink,
    errors: bool,
}

impl<'run> Checker<'run> {
    pub(super) fn new(source_spans: &'run SourceSpans, sink: &'run mut DiagnosticSink) -> Self {
        Self {
            source_spans,
            sink,
            errors: false,
        }
    }

    pub(super) fn is_clean(&self) -> bool {
        !self.errors
    }

    /// Whether this validation or an earlier stage found an error.
    pub(super) fn has_errors(&self) -> bool {
        self.sink.has_errors()
    }

    /// Reports a diagnostic at a value.
    pub(super) fn report(&mut self, path: ValuePath, label: &str, diagnostic: Diagnostic) {
        self.errors |= diagnostic.severity == Severity::Error;
        self.sink.push(
            diagnostic
                .at(self.source_spans.span(path), label)
                .pointer(path.to_string()),
        );
    }

    /// The span of a value, for secondary labels and replacements.
    pub(super) fn span(&self, path: ValuePath) -> Option<rtc_source::Span> {
        self.source_spans.span(path)
    }

    /// Reports a diagnostic about all entities of a kind, of which there are none. Its span is the
    /// one that the first entity would have.
    pub(super) fn report_all(
        &mut self,
        entity: EntityKind,
        pointer: &str,
        label: &str,
        diagnostic: Diagnostic,
    ) {
        let span = self
            .source_spans
            .span(ValuePath::new(entity, 0, EntityField::Whole));
        self.sink.push(diagnostic.at(span, label).pointer(pointer));
    }

    /// Validates all entities; `None` if any is invalid. All errors are reported.
    pub(super) fn all<T, V>(
        &mut self,
        entities: &[T],
        mut one: impl FnMut(&T, usize, &mut Self) -> Option<V>,
    ) -> Option<Vec<V>> {
        let mut valid = Vec::with_capacity(entities.len());
        for (index, entity) in entities.iter().enumerate() {
            valid.extend(one(entity, index, self));
        }
        (valid.len() == entities.len()).then_some(valid)
    }

    /// Validates an optional value: the outer `None` is an error, the inner one an absent value.
    #[expect(
        clippy::option_option,
        reason = "an error and an absence are two things"
    )]
    pub(super) fn optional<T, V>(
        &mut self,
        value: Option<&T>,
        one: impl FnOnce(&mut Self, &T) -> Option<V>,
    ) -> Option<Option<V>> {
        match value {
            Some(value) => one(self, value).map(Some),
            None => Some(None),
        }
    }

    /// The id of one of `count` entities.
    pub(super) fn handle<K>(
        &mut self,
        id: u32,
        count: usize,
        entity: &str,
        path: ValuePath,
    ) -> Option<Id<K>> {
        let found = usize::try_from(id).ok().filter(|id| *id < count);
        if found.is_none() {
            let message = format!("{entity} {id} does not exist: the scene has {count}");
            self.report(path, "", Diagnostic::new(&codes::BAD_HANDLE, message));
        }
        found.map(Id::new)
    }

    /// A direction: a finite nonzero vector. Its length has no meaning. The result is scaled by a
    /// power of two so that its largest component is in [1, 2): its squares neither overflow nor
    /// underflow.
    pub(super) fn direction(
        &mut self,
        value: [f64; 3],
        name: &str,
        path: ValuePath,
    ) -> Option<Vec3> {
        let direction = self.finite_vector(value, path)?;
        let scaled = unit_scale(direction).map(|(scaled, _)| scaled);
        if scaled.is_none() {
            let diagnostic = Diagnostic::new(
                &codes::ZERO_NORMAL,
                format!("the {name} is the zero vector"),
            );
            self.report(path, "it has no direction", diagnostic);
        }
        scaled
    }

    /// A finite number with an absolute value of at most 1e60.
    pub(super) fn number(&mut self, value: f64, path: ValuePath) -> Option<f64> {
        if value.abs() <= LARGEST {
            return Some(value);
        }
        let what = if value.is_finite() {
            "is too large to compute with"
        } else {
            "is not a finite number"
        };
        let diagnostic = Diagnostic::new(&codes::NOT_FINITE, format!("`{value:e}` {what}"));
        self.report(
            path,
            "",
            diagnostic.hint("numbers of a scene must be finite and at most 1e60 in absolute value"),
        );
        None
    }

    /// A point or vector of such numbers; at most one diagnostic for all three.
    pub(super) fn vector(&mut self, value: [f64; 3], path: ValuePath) -> Option<Vec3> {
        let too_large = |component: &f64| component.is_nan() || component.abs() > LARGEST;
        match value.into_iter().find(too_large) {
            Some(component) => self.number(component, path).map(|_| Vec3::ZERO),
            None => Some(Vec3::from_array(value)),
        }
    }

    /// A vector of finite numbers without a limit on its length: only its direction is used.
    pub(super) fn finite_vector(&mut self, value: [f64; 3], path: ValuePath) -> Option<Vec3> {
        match value.into_iter().find(|component| !component.is_finite()) {
            Some(component) => self.number(component, path).map(|_| Vec3::ZERO),
            None => Some(Vec3::from_array(value)),
        }
    }

    /// An exponent: finite and at least 0.
    pub(super) fn exponent(&mut self, value: f64, path: ValuePath) -> Option<NonNegative> {
        if !value.is_finite() {
            return self.number(value, path).and_then(NonNegative::new);
        }
        let valid = NonNegative::new(value);
        if valid.is_none() {
            let diagnostic = Diagnostic::new(
                &codes::NEGATIVE_EXPONENT,
                format!("the exponent `n` is negative: `{}`", shortest(value)),
            );
            self.report(
                path,
                "must be at least 0",
                diagnostic.hint("1 is a dull highlight, 64 a sharp one"),
            );
        }
        valid
    }

    /// A number of at least 0.
    pub(super) fn non_negative(
        &mut self,
        value: f64,
        name: &str,
        path: ValuePath,
    ) -> Option<NonNegative> {
        let number = self.number(value, path)?;
        let valid = NonNegative::new(number);
        if valid.is_none() {
            let diagnostic = Diagnostic::new(
                &codes::NEGATIVE,
                format!("`{name}` is negative: `{}`", shortest(value)),
            );
            self.report(
                path,
                "must be at least 0",
                diagnostic.hint(format!("use `{name}: 0`")),
            );
        }
        valid
    }

    /// A length above 0, of at least 1e-60.
    pub(super) fn length(
        &mut self,
        value: f64,
        path: ValuePath,
        code: &'static Code,
        name: &str,
    ) -> Option<Positive> {
        let number = self.number(value, path)?;
        if number >= SMALLEST {
            return Positive::new(number);
        }
        let what = if number > 0.0 {
            "is too small to compute with"
        } else {
            "is not above 0"
        };
        self.report(
            path,
            "must be above 0",
            Diagnostic::new(code, format!("the {name} `{}` {what}", shortest(value))),
        );
        None
    }

    /// A colour: each channel at least 0.
    pub(super) fn color(&mut self, value: [f64; 3], path: ValuePath) -> Option<Vec3> {
        let color = self.vector(value, path)?;
        if color.min_element() < 0.0 {
            let message = format!(
                "a colour has a negative channel: `{}`",
                shortest(color.min_element())
            );
            self.report(
                path,
                "each channel must be at least 0",
                Diagnostic::new(&codes::NEGATIVE, message),
            );
            return None;
        }
        Some(color.abs())
    }

    /// A count of at least 1.
    pub(super) fn count(&mut self, value: u32, name: &str, path: ValuePath) -> Option<NonZeroU32> {
        let valid = NonZeroU32::new(value);
        if valid.is_none() {
            let diagnostic = Diagnostic::new(&codes::ZERO_COUNT, format!("`{name}` is 0"));
            self.report(
                path,
                "must be at least 1",
                diagnostic.guess("use at least one sample", self.span(path), "1"),
            );
        }
        valid
    }
}
