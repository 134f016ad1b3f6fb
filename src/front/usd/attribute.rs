//! The values of attributes at the time of the picture: the strongest layer that has one counts.

use super::layer::{PropertySpec, StoredValue, Value};
use super::packed::TOKEN;
use super::stage::{ComposedPrim, Opinion};
use super::{Lowering, PrimState};
use crate::exchange::SpannedText;
use rtc_source::{Resource, Span};
use std::ops::Bound;

/// How values between two samples are found.
#[derive(Clone, Copy, PartialEq)]
enum SampleInterpolation {
    /// The earlier one holds.
    Held,
    Linear,
}

/// The values of a primvar, or of normals, and to what each belongs.
#[derive(Clone, Debug)]
pub(super) struct Primvar {
    pub(super) values: Vec<f64>,
    pub(super) interpolation: String,
    /// The value of each place, if they are shared.
    pub(super) indices: Vec<usize>,
    pub(super) span: Span,
}

impl Lowering<'_> {
    fn stored(&self, opinion: &Opinion, stored: &StoredValue) -> Option<Value> {
        match stored {
            StoredValue::Read(value) => {
                // The copy is charged, as values of binary files are.
                let bytes = match value {
                    Value::Blocked => 0,
                    Value::Numbers(numbers) => 8 * numbers.len() as u64,
                    Value::Texts(texts) => TOKEN * texts.len() as u64,
                };
                self.charge(Resource::Memory, bytes, self.root_span)?;
                Some(value.clone())
            }
            StoredValue::Packed(packed) => {
                let layer = &self.layers[opinion.layer];
                let tables = layer.tables.as_ref()?;
                let value = tables.value(self.map.bytes(layer.file), *packed, self.map.budget());
                match (&value, tables.exceeded.get()) {
                    (_, Some(fault)) => self.exhaust(*fault, self.root_span),
                    (None, None) => {
                        self.unread.get_or_init(|| layer.file);
                    }
                    (Some(_), None) => {}
                }
                value
            }
        }
    }

    /// The value of a property at the time of the picture.
    fn sampled(
        &self,
        opinion: &Opinion,
        property: &PropertySpec,
        between: SampleInterpolation,
    ) -> Option<Value> {
        // Decode the time samples of a binary layer.
        let unpacked = property.packed_samples.and_then(|packed| {
            let layer = &self.layers[opinion.layer];
            let bytes = self.map.bytes(layer.file);
            let samples = layer
                .tables
                .as_ref()?
                .samples(bytes, packed, self.map.budget());
            let samples = samples
                .into_iter()
                .map(|(time, packed)| (time, StoredValue::Packed(packed)));
            Some(samples.collect::<Vec<_>>())
        });
        let samples = unpacked.as_ref().unwrap_or(&property.samples);
        if samples.is_empty() {
            return self.stored(opinion, property.value.as_ref()?);
        }
        // Find the samples around the time.
        let time = opinion.time.local(self.time);
        let after = samples.partition_point(|(sample, _)| *sample <= time);
        let (start, first) = &samples[after.saturating_sub(1)];
        let value = self.stored(opinion, first)?;
        let (Some((end, next)), true) = (samples.get(after), after > 0) else {
            return Some(value);
        };
        // Interpolate numbers between them.
        let Value::Numbers(mut numbers) = value else {
            return Some(value);
        };
        if between == SampleInterpolation::Linear
            && let Some(Value::Numbers(next)) = self.stored(opinion, next)
            && next.len() == numbers.len()
        {
            let share = (time - start) / (end - start);
            for (number, next) in numbers.iter_mut().zip(next) {
                *number += (next - *number) * share;
            }
        }
        Some(Value::Numbers(numbers))
    }

    fn value(
        &self,
        prim: &ComposedPrim,
        name: &str,
        between: SampleInterpolation,
    ) -> Option<Value> {
        for opinion in &prim.opinions {
            let Some(property) = self.spec(opinion).properties.get(name) else {
                continue;
            };
            match self.sampled(opinion, property, between) {
                Some(Value::Blocked) => return None,
                Some(value) => return Some(value),
                None => {}
            }
        }
        None
    }

    fn numbers_of(
        &self,
        prim: &ComposedPrim,
        name: &str,
        between: SampleInterpolation,
    ) -> Option<Vec<f64>> {
        match self.value(prim, name, between)? {
            Value::Numbers(numbers) => Some(numbers),
            Value::Blocked | Value::Texts(_) => None,
        }
    }

    /// Numbers that change evenly between samples.
    pub(super) fn numbers(&self, prim: &ComposedPrim, name: &str) -> Option<Vec<f64>> {
        self.numbers_of(prim, name, SampleInterpolation::Linear)
    }

    pub(super) fn number(&self, prim: &ComposedPrim, name: &str) -> Option<f64> {
        self.numbers(prim, name)?
            .first()
            .copied()
            .filter(|number| number.is_finite())
    }

    /// As many numbers as the type says; `None` for fewer.
    pub(super) fn vector<const N: usize>(
        &self,
        prim: &ComposedPrim,
        name: &str,
    ) -> Option<[f64; N]> {
        let numbers = self.numbers(prim, name)?;
        let vector: [f64; N] = numbers.get(..N)?.try_into().ok()?;
        vector
            .iter()
            .all(|number| number.is_finite())
            .then_some(vector)
    }

    /// Counts and indices; what is none becomes one that is out of all ranges.
    pub(super) fn indices(&self, prim: &ComposedPrim, name: &str) -> Option<Vec<usize>> {
        let numbers = self.numbers_of(prim, name, SampleInterpolation::Held)?;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates, and negative numbers are found"
        )]
        let index = |number: f64| {
            if number >= 0.0 {
                number as usize
            } else {
                usize::MAX
            }
        };
        Some(numbers.into_iter().map(index).collect())
    }

    pub(super) fn flag(&self, prim: &ComposedPrim, name: &str) -> Option<bool> {
        let numbers = self.numbers_of(prim, name, SampleInterpolation::Held)?;
        numbers.first().map(|number| *number != 0.0)
    }

    pub(super) fn texts(&self, prim: &ComposedPrim, name: &str) -> Option<Vec<String>> {
        match self.value(prim, name, SampleInterpolation::Held)? {
            Value::Texts(texts) => Some(texts),
            // A list without items could be one of numbers.
            Value::Numbers(numbers) => numbers.is_empty().then(Vec::new),
            Value::Blocked => None,
        }
    }

    pub(super) fn text(&self, prim: &ComposedPrim, name: &str) -> Option<String> {
        self.texts(prim, name)?.into_iter().next()
    }

    /// A path of a file, and the layer that names it.
    pub(super) fn asset(&self, prim: &ComposedPrim, name: &str) -> Option<(SpannedText, usize)> {
        let text = self.text(prim, name)?;
        let opinion = prim.opinions.iter().find(|opinion| {
            let property = self.spec(opinion).properties.get(name);
            property.is_some_and(|p| {
                p.value.is_some() || !p.samples.is_empty() || p.packed_samples.is_some()
            })
        })?;
        let span = self.property_span(prim, name);
        Some((SpannedText { text, span }, opinion.layer))
    }

    pub(super) fn property_span(&self, prim: &ComposedPrim, name: &str) -> Span {
        let mut spans = prim
            .opinions
            .iter()
            .filter_map(|opinion| self.spec(opinion).properties.get(name)?.span);
        spans.next().unwrap_or_else(|| self.span_of(prim))
    }

    /// Whether a layer gives the attribute a value or a connection.
    pub(super) fn has(&self, prim: &ComposedPrim, name: &str) -> bool {
        prim.opinions
            .iter()
            .any(|opinion| self.spec(opinion).properties.contains_key(name))
    }

    /// Whether a layer says something of a property whose name begins so.
    pub(super) fn has_some(&self, prim: &ComposedPrim, beginning: &str) -> bool {
        prim.opinions.iter().any(|opinion| {
            let properties = &self.spec(opinion).properties;
            let mut later =
                properties.range::<str, _>((Bound::Included(beginning), Bound::Unbounded));
            later
                .next()
                .is_some_and(|(name, _)| name.starts_with(beginning))
        })
    }

    /// Whether an instancer gives each instance primvars of its own.
    pub(super) fn varies_by_instance(&self, prim: &ComposedPrim) -> bool {
        prim.opinions.iter().any(|opinion| {
            let properties = self.spec(opinion).properties.iter();
            let mut primvars = properties.filter(|(name, _)| name.starts_with("primvars:"));
            primvars.any(|(_, property)| {
                let interpolation = property.interpolation.as_deref();
                interpolation.is_some_and(|interpolation| interpolation != "constant")
            })
        })
    }

    /// The prim and the output that an input is connected to.
    pub(super) fn connection(&self, prim: &ComposedPrim, name: &str) -> Option<(String, String)> {
        let target = self.targets(prim, name).into_iter().next()?;
        let (path, output) = target.rsplit_once('.')?;
        Some((path.to_owned(), output.to_owned()))
    }

    /// The values of a primvar with numbers of `width`, all of its indices in range.
    pub(super) fn primvar(&self, prim: &ComposedPrim, name: &str, width: usize) -> Option<Primvar> {
        let values = self.numbers(prim, name)?;
        let count = values.len() / width;
        if count == 0 {
            return None;
        }
        let indices = self
            .indices(prim, &format!("{name}:indices"))
            .unwrap_or_default();
        if indices.iter().any(|index| *index >= count) {
            return None;
        }
        let mut words = prim.opinions.iter().filter_map(|opinion| {
            self.spec(opinion)
                .properties
                .get(name)?
                .interpolation
                .clone()
        });
        // Normals belong to vertices, and primvars to the whole, if nothing else is said.
        let default = if name == "normals" {
            "vertex"
        } else {
            "constant"
        };
        let interpolation = words.next().unwrap_or_else(|| default.to_owned());
        let span = self.property_span(prim, name);
        Some(Primvar {
            values,
            interpolation,
            indices,
            span,
        })
    }

    /// The constant primvar that a prim has, from itself or the nearest one above.
    pub(super) fn constant_primvar<const N: usize>(
        &self,
        state: &PrimState,
        name: &str,
    ) -> Option<[f64; N]> {
        let mut scope = state.primvars.as_ref();
        while let Some(at) = scope {
            if let Some(primvar) = self.primvar(&at.prim, name, N) {
                // One that varies hides those above.
                return (primvar.interpolation == "constant").then(|| primvar.at(0));
            }
            scope = at.above.as_ref();
        }
        None
    }
}

impl Primvar {
    /// How many places have a value.
    pub(super) fn len(&self, width: usize) -> usize {
        match self.indices.is_empty() {
            true => self.values.len() / width,
            false => self.indices.len(),
        }
    }

    /// The value of a place; the last one is that of all places beyond.
    pub(super) fn at<const N: usize>(&self, place: usize) -> [f64; N] {
        let place = place.min(self.len(N).saturating_sub(1));
        let index = self.indices.get(place).copied().unwrap_or(place);
        let value = self.values.get(index * N..index * N + N);
        value
            .and_then(|value| value.try_into().ok())
            .unwrap_or([0.0; N])
    }
}
