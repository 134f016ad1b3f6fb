//! The texture coordinate sets of a mesh that its material uses. The IR has two; glTF has any
//! number.

use rtc_ir::{Map, Standard};
use std::collections::BTreeSet;

/// The numbers in `TEXCOORD_n` of the sets that the IR calls 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct TexCoordSets([u32; 2]);

impl Default for TexCoordSets {
    fn default() -> Self {
        Self([0, 1])
    }
}

impl TexCoordSets {
    /// Chooses the sets of a material whose maps have glTF set numbers, and renumbers the maps as
    /// in the IR. Also returns the first set that did not fit; its maps use set 0 of the IR.
    pub(super) fn choose(material: &mut Standard) -> (Self, Option<u32>) {
        let used_sets: BTreeSet<u32> = material.maps().map(|map| map.set).collect();
        if used_sets.iter().all(|set| *set < 2) {
            return (Self::default(), None);
        }
        let mut used_sets = used_sets.into_iter();
        let first = used_sets.next().unwrap_or(0);
        let sets = Self([first, used_sets.next().unwrap_or(first)]);
        for Map { set, .. } in material.maps_mut() {
            *set = u32::from(*set != sets.0[0] && *set == sets.0[1]);
        }
        (sets, used_sets.next())
    }

    /// The names of the attributes.
    pub(super) fn names(self) -> [String; 2] {
        self.0.map(|set| format!("TEXCOORD_{set}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rtc_ir::TextureId;

    #[test]
    fn two_sets_of_any_number_are_kept() {
        let map = |set| {
            Some(Map {
                texture: TextureId(0),
                set,
                texture_from_surface: None,
            })
        };
        let sets = |color, emissive, normal| {
            let mut material = Standard {
                base_color_map: map(color),
                emissive_map: map(emissive),
                normal_map: map(normal),
                ..Standard::default()
            };
            let chosen = TexCoordSets::choose(&mut material);
            (chosen, material.maps().map(|map| map.set).collect())
        };
        let kept = |sets| (TexCoordSets(sets), None);
        assert_eq!(sets(1, 1, 0), (kept([0, 1]), vec![1, 1, 0]));
        assert_eq!(sets(5, 2, 2), (kept([2, 5]), vec![1, 0, 0]));
        assert_eq!(sets(3, 3, 3), (kept([3, 3]), vec![0, 0, 0]));
        let lost = (TexCoordSets([0, 2]), Some(4));
        assert_eq!(sets(0, 2, 4), (lost, vec![0, 1, 0]));
    }
}
