//! What stands upright on a base: how its base and its top are given.

use crate::course::decode::{Numbers, Spanned};
use crate::course::number::Positive;
use crate::course::record::FieldOutcome;
use crate::course::value::{Point, Vector};
use rtc_math::{Vec3, unit};

/// The values that may say it.
pub(super) struct AxisKeys<'o> {
    pub(super) position: &'o FieldOutcome<Spanned<Point>>,
    pub(super) up: &'o FieldOutcome<Spanned<Vector>>,
    pub(super) direction: &'o FieldOutcome<Spanned<Vector>>,
    pub(super) height: &'o FieldOutcome<Spanned<Positive>>,
    pub(super) ends: &'o FieldOutcome<[Spanned<Point>; 2]>,
}

impl AxisKeys<'_> {
    /// The middle of the base, and the way from it to the top.
    pub(super) fn base_and_up(&self) -> Option<(Numbers, Numbers)> {
        let Self {
            position,
            up,
            direction,
            height,
            ends,
        } = self;
        match (position, up, direction, height, ends) {
            (.., FieldOutcome::Read([base, top])) => {
                let up = Vec3::from_array(top.value.0) - Vec3::from_array(base.value.0);
                Some((base.map(|point| point.0), top.map(|_| up.to_array())))
            }
            (FieldOutcome::Read(base), FieldOutcome::Read(up), ..) => {
                Some((base.map(|point| point.0), up.map(|vector| vector.0)))
            }
            (
                FieldOutcome::Read(base),
                _,
                FieldOutcome::Read(direction),
                FieldOutcome::Read(height),
                _,
            ) => {
                // A direction of length 0 is left for the proof to refuse.
                let along = unit(Vec3::from_array(direction.value.0)).unwrap_or(Vec3::ZERO);
                let up = (along * height.value.0).to_array();
                Some((base.map(|point| point.0), direction.map(|_| up)))
            }
            _ => None,
        }
    }
}
