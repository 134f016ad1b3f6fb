//! The layers of the glTF material as rules use them. They are generated from the table of layers.

use rtc_math::Weight;
use rtc_valid::{Map, Standard};
use std::ops::Range;

/// Generates [`Layer`] from the table of layers.
macro_rules! kinds {
    ($(
        $(#[doc = $about:literal])*
        $layer:ident = $slot:ident {
            label: $name:literal, $absence:literal;
            weight: $weight:ident * $weight_map:ident [$channels:expr];
            maps: $($factor:ident * $map:ident),*;
            transmits: $transmits:literal;
        }
    )*) => {
        /// A layer of the glTF material.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Layer {
            $($(#[doc = $about])* $layer,)*
        }

        impl Layer {
            /// All layers.
            pub const ALL: [Self; [$($name),*].len()] = [$(Self::$layer),*];

            /// The name.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$layer => $name,)* }
            }

            /// The reason for its absence.
            pub(super) fn absence(self) -> &'static str {
                match self { $(Self::$layer => $absence,)* }
            }

            /// Whether it transmits light through the surface.
            #[must_use]
            pub fn transmits(self) -> bool {
                match self { $(Self::$layer => $transmits,)* }
            }

            /// Whether a material has it.
            #[must_use]
            pub fn is_in(self, material: &Standard) -> bool {
                match self { $(Self::$layer => material.$weight.is_nonzero(),)* }
            }

            /// The map that scales its weight, and the channels of the map that are used.
            pub(super) fn weight_map(self, material: &Standard) -> (Option<&Map>, Range<usize>) {
                match self { $(Self::$layer => (material.$weight_map.as_ref(), $channels),)* }
            }

            /// Removes it from a material.
            pub(super) fn remove(self, material: &mut Standard) {
                match self { $(Self::$layer => material.$weight = Weight::NOTHING,)* }
            }

            /// Visits each of its maps, with whether the map scales a nonzero factor.
            pub(super) fn each_map(
                self,
                material: &mut Standard,
                mut each: impl FnMut(&mut Option<Map>, bool),
            ) {
                match self {
                    $(Self::$layer => {
                        let is_there = material.$weight.is_nonzero();
                        $(
                            let shows = is_there && material.$factor.is_nonzero();
                            each(&mut material.$map, shows);
                        )*
                    })*
                }
            }

            /// The maps of all layers of a material.
            pub fn maps(material: &Standard) -> impl Iterator<Item = &Map> {
                let maps = [$($((material.$weight.is_nonzero(), &material.$map)),*),*];
                maps.into_iter().filter_map(|(is_there, map)| map.as_ref().filter(|_| is_there))
            }
        }
    };
}

rtc_tables::layers!(kinds);
