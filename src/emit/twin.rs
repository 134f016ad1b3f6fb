//! A scene as another renderer reads it: what every writer of such files needs.

use super::told::Told;
use rtc_diag::codes;
use rtc_ir::{EntityKind, Field, Material, Scene, Shape, ShapeKind, ValuePath};
use rtc_math::shortest;
use rtc_source::{Budget, Resource};
use std::collections::{BTreeMap, BTreeSet};

/// A scene for another renderer.
#[derive(Debug)]
pub struct ExportedScene {
    /// The scene file.
    pub text: String,
    /// The files that it names, by their paths from its folder, with `/`.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Told<'_> {
    /// Tells of a part of the scene that the other renderer has no exact twin for.
    pub(super) fn no_twin(&mut self, message: &str, place: ValuePath) {
        self.tell(&codes::NO_TWIN, message, place);
    }

    /// Charges the bytes of a mesh in a file; `None` if that is too much, which is told.
    pub(super) fn charge(&mut self, bytes: u64, budget: &Budget, place: ValuePath) -> Option<()> {
        let charged = budget.charge(Resource::Memory, bytes);
        charged
            .map_err(|fault| {
                let message = format!("the mesh takes too much as a file: {fault}");
                self.refuse(&codes::OVER_LIMIT, &message, place);
            })
            .ok()
    }
}

/// The materials that surfaces have, with their indices and places.
pub(super) fn worn(scene: &Scene) -> impl Iterator<Item = (usize, &Material, ValuePath)> {
    let worn = scene.surfaces.iter().map(|own| own.material.0 as usize);
    let worn: BTreeSet<_> = worn.collect();
    let place = |index| ValuePath::new(EntityKind::Material, index, Field::Whole);
    let material = move |index| Some((index, scene.materials.get(index)?, place(index)));
    worn.into_iter().filter_map(material)
}

/// Numbers, each the shortest that reads back, with something between them; −0 as 0.
pub(super) fn joined(numbers: impl IntoIterator<Item = f64>, between: &str) -> String {
    let shown: Vec<_> = numbers
        .into_iter()
        .map(|number| shortest(number + 0.0))
        .collect();
    shown.join(between)
}

/// What a shape is called that has no twin: of quadrilaterals only those that are not flat have none.
pub(super) fn word(shape: &Shape) -> &'static str {
    if shape.kind() == ShapeKind::Quad {
        return "bilinear patch";
    }
    shape.kind().name()
}

/// What is told of several parts of one thing, as words in a row.
pub(super) fn listed(parts: &[&str]) -> String {
    match parts {
        [] => String::new(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
