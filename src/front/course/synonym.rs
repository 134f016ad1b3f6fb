//! The one table of the keys that several records have, with all the names that people give them;
//! and the keys of other programs that mean something like one of ours, but not surely the same.

/// The keys under which one value stands, or a group of values.
type KeyGroup = &'static [&'static str];

/// A point that says where something is.
pub(super) const POSITION: [KeyGroup; 8] = [
    &["position"],
    &["center"],
    &["centre"],
    &["pos"],
    &["origin"],
    &["location"],
    &["point"],
    &["O"],
];

/// A corner that says where something is.
pub(super) const CORNER: [KeyGroup; 5] =
    [&["position"], &["corner"], &["pos"], &["origin"], &["O"]];

/// A radius.
pub(super) const RADIUS: [KeyGroup; 4] = [&["radius"], &["r"], &["R"], &["rad"]];

/// The direction at right angles to something flat, or along the axis of something round.
pub(super) const AXIS: [KeyGroup; 6] = [
    &["direction"],
    &["axis"],
    &["normal"],
    &["N"],
    &["n"],
    &["dir"],
];

/// From the base of something round to its top.
pub(super) const HEIGHT: [KeyGroup; 3] = [&["height"], &["h"], &["length"]];

/// The middles of both ends of something round, that of its base first.
pub(super) const ENDS: [KeyGroup; 12] = [
    &["p1", "p2"],
    &["center1", "center2"],
    &["end1", "end2"],
    &["point1", "point2"],
    &["position1", "position2"],
    &["p0", "p1"],
    &["a", "b"],
    &["A", "B"],
    &["start", "end"],
    &["bottom", "top"],
    &["base", "top"],
    &["base", "apex"],
];

/// The file of a mesh or an asset.
pub(super) const FILE: [KeyGroup; 13] = [
    &["file"],
    &["filename"],
    &["fileName"],
    &["path"],
    &["modelPath"],
    &["name"],
    &["object"],
    &["model"],
    &["mesh"],
    &["modelFile"],
    &["objFile"],
    &["source"],
    &["src"],
];

/// How many times larger something is.
pub(super) const SCALE: [KeyGroup; 4] =
    [&["scale"], &["scalefactor"], &["scaleFactor"], &["scaling"]];

/// Angles by which something is turned about x, y and z.
pub(super) const ROTATION: [KeyGroup; 2] = [&["rotation"], &["rotate"]];

/// What something is turned about.
pub(super) const ROTATION_AXIS: [KeyGroup; 3] = [&["axis"], &["rotationAxis"], &["rotationVector"]];

/// By how much something is turned about that.
pub(super) const ROTATION_ANGLE: [KeyGroup; 2] = [&["angle"], &["rotationAngle"]];

/// Where a camera stands.
pub(super) const EYE: [KeyGroup; 6] = [
    &["eye"],
    &["position"],
    &["from"],
    &["lookFrom"],
    &["origin"],
    &["location"],
];

/// What a camera looks at.
pub(super) const TARGET: [KeyGroup; 6] = [
    &["center"],
    &["lookAt"],
    &["to"],
    &["target"],
    &["at"],
    &["look_at"],
];

/// Width and height of the picture.
pub(super) const IMAGE_SIZE: [KeyGroup; 4] =
    [&["viewSize"], &["resolution"], &["size"], &["imageSize"]];

/// The rows of a table with that of one key in front: the canonical one of a record.
///
/// # Panics
/// If the table has no such row, when it is compiled.
pub(super) const fn with_canonical<const N: usize>(
    mut rows: [KeyGroup; N],
    key: &str,
) -> [KeyGroup; N] {
    let mut at = 0;
    while !is_same(rows[at][0], key) {
        at += 1;
    }
    let found = rows[at];
    while at > 0 {
        rows[at] = rows[at - 1];
        at -= 1;
    }
    rows[0] = found;
    rows
}

/// The rows of a table and one more.
pub(super) const fn with_last<const N: usize, const M: usize>(
    rows: [KeyGroup; N],
    last: KeyGroup,
) -> [KeyGroup; M] {
    let mut all = [last; M];
    let mut at = 0;
    while at < N {
        all[at] = rows[at];
        at += 1;
    }
    all
}

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

/// Keys of a record that mean something like one of its own, and how that is written here.
struct ForeignKeys {
    /// What the record is called.
    record: &'static str,
    keys: KeyGroup,
    advice: &'static str,
}

const FOREIGN_KEYS: &[ForeignKeys] = &[
    ForeignKeys {
        record: "camera",
        keys: &["direction", "dir", "forward", "gaze", "look", "view"],
        advice: "a camera looks at a point: `center` is the `eye` and the direction added",
    },
    ForeignKeys {
        record: "camera",
        keys: &[
            "distance",
            "focalLength",
            "viewDistance",
            "screenDistance",
            "d",
        ],
        advice: "the distance from the eye to an image is `focalDistance`, the size of its pixels `pixelSize`",
    },
    ForeignKeys {
        record: "camera",
        keys: &[
            "fieldOfView",
            "viewAngle",
            "angle",
            "hfov",
            "fovx",
            "xfov",
            "zoom",
        ],
        advice: "`fov` is the angle in degrees from the bottom of the picture to its top",
    },
    ForeignKeys {
        record: "camera",
        keys: &["aperture", "lens", "lensRadius", "fstop", "lensSize"],
        advice: "`apertureRadius` is the radius of the lens in scene units",
    },
    ForeignKeys {
        record: "camera",
        keys: &["aspect", "aspectRatio", "ratio"],
        advice: "pixels are square, and `viewSize` says how many there are across and down",
    },
    ForeignKeys {
        record: "camera",
        keys: &["focus", "focusDistance", "focalPlane", "focalPoint"],
        advice: "what lies in the plane through `center` is in focus",
    },
    ForeignKeys {
        record: "scene",
        keys: &["Materials", "Material", "Textures", "Colors"],
        advice: "materials stand in their objects; one that several have is marked `&red` at the first and named `*red` at the others",
    },
    ForeignKeys {
        record: "scene",
        keys: &[
            "Background",
            "BackgroundColor",
            "Sky",
            "SkyColor",
            "AmbientLight",
        ],
        advice: "what no object hides is black; light from all around is an `Environment`, which paths show",
    },
    ForeignKeys {
        record: "light",
        keys: &["power", "brightness", "strength", "energy"],
        advice: "the strength of a light is that of its `color`, which may be more than 1",
    },
    ForeignKeys {
        record: "material",
        keys: &[
            "reflect",
            "reflection",
            "reflectivity",
            "reflectance",
            "mirror",
            "kr",
        ],
        advice: "`ks` is the weight of the highlight and of the mirror image alike",
    },
    ForeignKeys {
        record: "material",
        keys: &["emission", "emissive", "emit", "glow"],
        advice: "a surface that shines is a material of `type: standard`, with `emissive`",
    },
    ForeignKeys {
        record: "material",
        keys: &[
            "transparency",
            "transmission",
            "opacity",
            "alpha",
            "transparent",
        ],
        advice: "the weight of the light that passes through is `kt`",
    },
];

/// How a key that a record does not know is written here, if it means something like one of its
/// own.
pub(super) fn foreign_key_advice(record: &str, key: &str) -> Option<&'static str> {
    let is_it = |entry: &&ForeignKeys| {
        entry.record == record
            && entry
                .keys
                .iter()
                .any(|other| other.eq_ignore_ascii_case(key))
    };
    FOREIGN_KEYS.iter().find(is_it).map(|entry| entry.advice)
}

#[cfg(test)]
mod tests {
    use super::super::object::KINDS;
    use std::collections::BTreeSet;

    /// A key of its own says one thing in a record: only in a group it may say another.
    #[test]
    fn no_key_names_two_fields() {
        for kind in KINDS {
            let mut known = BTreeSet::new();
            let rows = kind.record.fields.iter().flat_map(|field| field.spellings);
            for row in rows.filter(|row| row.len() == 1) {
                assert!(known.insert(row[0]), "{} of {}", row[0], kind.names[0]);
            }
        }
    }
}
