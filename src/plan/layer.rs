//! The layers of the glTF material as rules use them.

use rtc_math::Weight;
use rtc_valid::{Map, Standard};
use std::ops::Range;

/// A layer of the glTF material: a lobe beside those of its base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Layer {
    /// `KHR_materials_clearcoat`.
    Clearcoat,
    /// `KHR_materials_sheen`.
    Sheen,
    /// `KHR_materials_anisotropy`.
    Anisotropy,
    /// `KHR_materials_iridescence`.
    Iridescence,
    /// `KHR_materials_diffuse_transmission`.
    DiffuseTransmission,
}

/// What is known of a layer.
struct LayerRow {
    name: &'static str,
    /// The reason for its absence.
    absence: &'static str,
    /// Whether a material has it.
    is_in: fn(&Standard) -> bool,
    /// Removes it from a material.
    remove: fn(&mut Standard),
    /// The map that scales its weight.
    weight_map: fn(&Standard) -> Option<&Map>,
    /// The channels of that map that are used.
    channels: Range<usize>,
}

impl Layer {
    /// All layers.
    pub const ALL: [Self; 5] = [
        Self::Clearcoat,
        Self::Sheen,
        Self::Anisotropy,
        Self::Iridescence,
        Self::DiffuseTransmission,
    ];

    fn row(self) -> LayerRow {
        match self {
            Self::Clearcoat => LayerRow {
                name: "clearcoat",
                absence: "no material has a clearcoat",
                is_in: |m| m.clearcoat.is_nonzero(),
                remove: |m| m.clearcoat = Weight::NOTHING,
                weight_map: |m| m.clearcoat_map.as_ref(),
                channels: 0..1,
            },
            Self::Sheen => LayerRow {
                name: "sheen",
                absence: "no material has sheen",
                is_in: |m| m.sheen_color.is_nonzero(),
                remove: |m| m.sheen_color = Weight::NOTHING,
                weight_map: |m| m.sheen_color_map.as_ref(),
                channels: 0..3,
            },
            Self::Anisotropy => LayerRow {
                name: "anisotropy",
                absence: "no material is anisotropic",
                is_in: |m| m.anisotropy.is_nonzero(),
                remove: |m| m.anisotropy = Weight::NOTHING,
                weight_map: |m| m.anisotropy_map.as_ref(),
                channels: 2..3,
            },
            Self::Iridescence => LayerRow {
                name: "iridescence",
                absence: "no material is iridescent",
                is_in: |m| m.iridescence.is_nonzero(),
                remove: |m| m.iridescence = Weight::NOTHING,
                weight_map: |m| m.iridescence_map.as_ref(),
                channels: 0..1,
            },
            Self::DiffuseTransmission => LayerRow {
                name: "translucency",
                absence: "no material is translucent",
                is_in: |m| m.diffuse_transmission.is_nonzero(),
                remove: |m| m.diffuse_transmission = Weight::NOTHING,
                weight_map: |m| m.diffuse_transmission_map.as_ref(),
                channels: 3..4,
            },
        }
    }

    /// The name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// The reason for its absence.
    pub(super) fn absence(self) -> &'static str {
        self.row().absence
    }

    /// Whether it transmits light through the surface.
    #[must_use]
    pub fn transmits(self) -> bool {
        self == Self::DiffuseTransmission
    }

    /// Whether a material has it.
    #[must_use]
    pub fn is_in(self, material: &Standard) -> bool {
        (self.row().is_in)(material)
    }

    /// The map that scales its weight, and the channels of the map that are used.
    pub(super) fn weight_map(self, material: &Standard) -> (Option<&Map>, Range<usize>) {
        let row = self.row();
        ((row.weight_map)(material), row.channels)
    }

    /// Removes it from a material.
    pub(super) fn remove(self, material: &mut Standard) {
        (self.row().remove)(material);
    }

    /// Visits each of its maps, with whether the map scales a nonzero factor.
    pub(super) fn each_map(self, m: &mut Standard, mut each: impl FnMut(&mut Option<Map>, bool)) {
        let is_there = self.is_in(m);
        let maps = match self {
            Self::Clearcoat => vec![
                (&mut m.clearcoat_map, true),
                (
                    &mut m.clearcoat_roughness_map,
                    m.clearcoat_roughness.is_nonzero(),
                ),
            ],
            Self::Sheen => vec![
                (&mut m.sheen_color_map, true),
                (&mut m.sheen_roughness_map, m.sheen_roughness.is_nonzero()),
            ],
            Self::Anisotropy => vec![(&mut m.anisotropy_map, true)],
            Self::Iridescence => vec![
                (&mut m.iridescence_map, true),
                (&mut m.iridescence_thickness_map, true),
            ],
            Self::DiffuseTransmission => vec![
                (&mut m.diffuse_transmission_map, true),
                (
                    &mut m.diffuse_transmission_color_map,
                    m.diffuse_transmission_color.is_nonzero(),
                ),
            ],
        };
        for (map, is_scaled) in maps {
            each(map, is_there && is_scaled);
        }
    }

    /// The maps of all layers of a material.
    pub fn maps(m: &Standard) -> impl Iterator<Item = &Map> {
        let maps = [
            (Self::Clearcoat, &m.clearcoat_map),
            (Self::Clearcoat, &m.clearcoat_roughness_map),
            (Self::Sheen, &m.sheen_color_map),
            (Self::Sheen, &m.sheen_roughness_map),
            (Self::Anisotropy, &m.anisotropy_map),
            (Self::Iridescence, &m.iridescence_map),
            (Self::Iridescence, &m.iridescence_thickness_map),
            (Self::DiffuseTransmission, &m.diffuse_transmission_map),
            (Self::DiffuseTransmission, &m.diffuse_transmission_color_map),
        ];
        let maps = maps.into_iter().filter(|(layer, _)| layer.is_in(m));
        maps.filter_map(|(_, map)| map.as_ref())
    }
}
