//! The checks of single values: each takes a number and returns a number with a range, or reports a
//! finding at its place.

use rtc_diag::codes::{self, Code};
use rtc_diag::{Diagnostic, Severity, Sink};
use rtc_ir::{EntityKind, Field, SourceSpans, ValuePath};
use rtc_math::{NonNegative, Positive, Vec3, shortest, unit_scale};
use std::num::NonZeroU32;

/// The largest absolute value of a coordinate: the sphere test takes fourth powers of lengths, and
/// they stay finite.
pub const LARGEST: f64 = 1e60;

/// The smallest length other than 0: its fourth power is still a normal number.
pub(super) const SMALLEST: f64 = 1e-60;

/// How many entities handles may refer to.
pub(super) struct EntityCounts {
    pub(super) textures: usize,
    pub(super) meshes: usize,
    pub(super) materials: usize,
}

/// One run of the checks.
pub(super) struct Check<'run> {
    source_spans: &'run SourceSpans,
    sink: &'run mut Sink,
    errors: bool,
}

impl<'run> Check<'run> {
    pub(super) fn new(source_spans: &'run SourceSpans, sink: &'run mut Sink) -> Self {
        Self {
            source_spans,
            sink,
            errors: false,
        }
    }

    pub(super) fn is_clean(&self) -> bool {
        !self.errors
    }

    /// Whether this check or what came before it found an error.
    pub(super) fn has_errors(&self) -> bool {
        self.sink.has_errors()
    }

    /// Reports a finding at a place.
    pub(super) fn report(&mut self, place: ValuePath, label: &str, finding: Diagnostic) {
        self.errors |= finding.severity == Severity::Error;
        self.sink.push(
            finding
                .at(self.source_spans.span(place), label)
                .pointer(place.to_string()),
        );
    }

    /// Where the value was written, for secondary labels and replacements.
    pub(super) fn span(&self, place: ValuePath) -> Option<rtc_source::Span> {
        self.source_spans.span(place)
    }

    /// Reports a finding about all entities of a noun, of which there are none: its place is that
    /// which the first one would have.
    pub(super) fn report_all(
        &mut self,
        entity: EntityKind,
        pointer: &str,
        label: &str,
        finding: Diagnostic,
    ) {
        let span = self.source_spans.span(place(entity, 0, Field::Whole));
        self.sink.push(finding.at(span, label).pointer(pointer));
    }

    /// Proves all entities; `None` if any failed. All failures are reported.
    pub(super) fn all<T, V>(
        &mut self,
        entities: &[T],
        mut one: impl FnMut(&T, usize, &mut Self) -> Option<V>,
    ) -> Option<Vec<V>> {
        let mut proven = Vec::with_capacity(entities.len());
        for (index, entity) in entities.iter().enumerate() {
            proven.extend(one(entity, index, self));
        }
        (proven.len() == entities.len()).then_some(proven)
    }

    /// Proves an optional value: the outer `None` is an error, the inner one an absent value.
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

    /// A handle to one of `count` entities.
    pub(super) fn handle(
        &mut self,
        id: u32,
        count: usize,
        entity: &str,
        place: ValuePath,
    ) -> Option<usize> {
        let found = usize::try_from(id).ok().filter(|id| *id < count);
        if found.is_none() {
            let message = format!("{entity} {id} does not exist: the scene has {count}");
            self.report(place, "", Diagnostic::new(&codes::BAD_HANDLE, message));
        }
        found
    }

    /// A direction: a finite vector other than zero. Its length has no meaning. The result is scaled
    /// by a power of two so that its largest component is in [1, 2): its squares neither overflow nor
    /// underflow.
    pub(super) fn direction(
        &mut self,
        value: [f64; 3],
        name: &str,
        place: ValuePath,
    ) -> Option<Vec3> {
        let direction = self.finite_vector(value, place)?;
        let scaled = unit_scale(direction).map(|(scaled, _)| scaled);
        if scaled.is_none() {
            let finding = Diagnostic::new(
                &codes::ZERO_NORMAL,
                format!("the {name} is the zero vector"),
            );
            self.report(place, "it has no direction", finding);
        }
        scaled
    }

    /// A finite number with an absolute value of at most 1e60.
    pub(super) fn number(&mut self, value: f64, place: ValuePath) -> Option<f64> {
        if value.abs() <= LARGEST {
            return Some(value);
        }
        let what = if value.is_finite() {
            "is too large to compute with"
        } else {
            "is not a finite number"
        };
        let finding = Diagnostic::new(&codes::NOT_FINITE, format!("`{value:e}` {what}"));
        self.report(
            place,
            "",
            finding.hint("numbers of a scene must be finite and at most 1e60 in absolute value"),
        );
        None
    }

    /// A point or vector of such numbers. Its three numbers have one finding.
    pub(super) fn vector(&mut self, value: [f64; 3], place: ValuePath) -> Option<Vec3> {
        let too_large = |component: &f64| component.is_nan() || component.abs() > LARGEST;
        match value.into_iter().find(too_large) {
            Some(culprit) => self.number(culprit, place).map(|_| Vec3::ZERO),
            None => Some(Vec3::from_array(value)),
        }
    }

    /// A vector of finite numbers without a limit on its length: only its direction is used.
    pub(super) fn finite_vector(&mut self, value: [f64; 3], place: ValuePath) -> Option<Vec3> {
        match value.into_iter().find(|component| !component.is_finite()) {
            Some(culprit) => self.number(culprit, place).map(|_| Vec3::ZERO),
            None => Some(Vec3::from_array(value)),
        }
    }

    /// An exponent: finite and at least 0.
    pub(super) fn exponent(&mut self, value: f64, place: ValuePath) -> Option<NonNegative> {
        if !value.is_finite() {
            return self.number(value, place).and_then(NonNegative::new);
        }
        let proven = NonNegative::new(value);
        if proven.is_none() {
            let finding = Diagnostic::new(
                &codes::NEGATIVE_EXPONENT,
                format!("the exponent `n` is negative: `{}`", shortest(value)),
            );
            self.report(
                place,
                "must be at least 0",
                finding.hint("1 is a dull highlight, 64 a sharp one"),
            );
        }
        proven
    }

    /// A number of at least 0.
    pub(super) fn non_negative(
        &mut self,
        value: f64,
        name: &str,
        place: ValuePath,
    ) -> Option<NonNegative> {
        let number = self.number(value, place)?;
        let proven = NonNegative::new(number);
        if proven.is_none() {
            let finding = Diagnostic::new(
                &codes::NEGATIVE,
                format!("`{name}` is negative: `{}`", shortest(value)),
            );
            self.report(
                place,
                "must be at least 0",
                finding.hint(format!("use `{name}: 0`")),
            );
        }
        proven
    }

    /// A length above 0, of at least 1e-60.
    pub(super) fn length(
        &mut self,
        value: f64,
        place: ValuePath,
        code: &'static Code,
        name: &str,
    ) -> Option<Positive> {
        let number = self.number(value, place)?;
        if number >= SMALLEST {
            return Positive::new(number);
        }
        let what = if number > 0.0 {
            "is too small to compute with"
        } else {
            "is not above 0"
        };
        self.report(
            place,
            "must be above 0",
            Diagnostic::new(code, format!("the {name} `{}` {what}", shortest(value))),
        );
        None
    }

    /// A colour: each channel at least 0.
    pub(super) fn color(&mut self, value: [f64; 3], place: ValuePath) -> Option<Vec3> {
        let color = self.vector(value, place)?;
        if color.min_element() < 0.0 {
            let message = format!(
                "a colour has a negative channel: `{}`",
                shortest(color.min_element())
            );
            self.report(
                place,
                "each channel must be at least 0",
                Diagnostic::new(&codes::NEGATIVE, message),
            );
            return None;
        }
        Some(color.abs())
    }

    /// A count of at least 1.
    pub(super) fn count(&mut self, value: u32, name: &str, place: ValuePath) -> Option<NonZeroU32> {
        let proven = NonZeroU32::new(value);
        if proven.is_none() {
            let finding = Diagnostic::new(&codes::ZERO_COUNT, format!("`{name}` is 0"));
            self.report(
                place,
                "must be at least 1",
                finding.guess("use at least one sample", self.span(place), "1"),
            );
        }
        proven
    }
}

/// The place of a field of a light, material or surface.
pub(super) fn place(entity: EntityKind, index: usize, field: Field) -> ValuePath {
    ValuePath::new(entity, index, field)
}
