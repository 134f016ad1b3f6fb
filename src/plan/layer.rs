//! The layers of the glTF material, as the rules see them: made from the table of layers.

use rtc_math::Weight;
use rtc_valid::{Map, Standard};
use std::ops::Range;

/// The layers, from their table.
macro_rules! kinds {
    ($(
        $(#[doc = $about:literal])*
        $layer:ident = $slot:ident {
            told: $name:literal, $absence:literal;
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

            /// The name, as in the books.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$layer => $name,)* }
            }

            /// Why a scene does not ask for it.
            pub(super) fn absence(self) -> &'static str {
                match self { $(Self::$layer => $absence,)* }
            }

            /// Whether light goes through the surface by it.
            #[must_use]
            pub fn transmits(self) -> bool {
                match self { $(Self::$layer => $transmits,)* }
            }

            /// Whether a material has it.
            #[must_use]
            pub fn is_in(self, material: &Standard) -> bool {
                match self { $(Self::$layer => material.$weight.weighs(),)* }
            }

            /// The map that multiplies its weight, and the channels that count.
            pub(super) fn weight_map(self, material: &Standard) -> (Option<&Map>, Range<usize>) {
                match self { $(Self::$layer => (material.$weight_map.as_ref(), $channels),)* }
            }

            /// Takes it from a material.
            pub(super) fn remove(self, material: &mut Standard) {
                match self { $(Self::$layer => material.$weight = Weight::NOTHING,)* }
            }

            /// Gives each of its maps, and whether that multiplies more than 0.
            pub(super) fn each_map(
                self,
                material: &mut Standard,
                mut each: impl FnMut(&mut Option<Map>, bool),
            ) {
                match self {
                    $(Self::$layer => {
                        let is_there = material.$weight.weighs();
                        $(
                            let shows = is_there && material.$factor.weighs();
                            each(&mut material.$map, shows);
                        )*
                    })*
                }
            }

            /// The maps of all layers that a material has.
            pub fn maps(material: &Standard) -> impl Iterator<Item = &Map> {
                let maps = [$($((material.$weight.weighs(), &material.$map)),*),*];
                maps.into_iter().filter_map(|(is_there, map)| map.as_ref().filter(|_| is_there))
            }
        }
    };
}

rtc_tables::layers!(kinds);
