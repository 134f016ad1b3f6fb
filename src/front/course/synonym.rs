//! The spellings of the keys that several records share, and the keys of other programs whose
//! meaning is similar but not surely the same.

/// The keys of one value, or of a group of values.
type KeyGroup = &'static [&'static str];

/// The position of an object.
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

/// The corner of an object.
pub(super) const CORNER: [KeyGroup; 5] =
    [&["position"], &["corner"], &["pos"], &["origin"], &["O"]];

/// A radius.
pub(super) const RADIUS: [KeyGroup; 4] = [&["radius"], &["r"], &["R"], &["rad"]];

/// The normal of a flat object, or the axis of a round one.
pub(super) const AXIS: [KeyGroup; 6] = [
    &["direction"],
    &["axis"],
    &["normal"],
    &["N"],
    &["n"],
    &["dir"],
];

/// The height of a round object.
pub(super) const HEIGHT: [KeyGroup; 3] = [&["height"], &["h"], &["length"]];

/// The centres of both ends of a round object, that of its base first.
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

/// A scale factor.
pub(super) const SCALE: [KeyGroup; 4] =
    [&["scale"], &["scalefactor"], &["scaleFactor"], &["scaling"]];

/// Rotation angles about x, y and z.
pub(super) const ROTATION: [KeyGroup; 2] = [&["rotation"], &["rotate"]];

/// An axis of rotation.
pub(super) const ROTATION_AXIS: [KeyGroup; 3] = [&["axis"], &["rotationAxis"], &["rotationVector"]];

/// An angle of rotation.
pub(super) const ROTATION_ANGLE: [KeyGroup; 2] = [&["angle"], &["rotationAngle"]];

/// The position of a camera.
pub(super) const EYE: [KeyGroup; 6] = [
    &["eye"],
    &["position"],
    &["from"],
    &["lookFrom"],
    &["origin"],
    &["location"],
];

/// The target of a camera.
pub(super) const TARGET: [KeyGroup; 6] = [
    &["center"],
    &["lookAt"],
    &["to"],
    &["target"],
    &["at"],
    &["look_at"],
];

/// The width and height of the image.
pub(super) const IMAGE_SIZE: [KeyGroup; 4] =
    [&["viewSize"], &["resolution"], &["size"], &["imageSize"]];

/// The spellings of a table with the one of `key` first, as the canonical one.
///
/// # Panics
/// At compile time, if the table has no such spelling.
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

/// The spellings of a table and one more.
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

/// Keys of other programs with a meaning similar to a key of a record, and a hint for them.
struct ForeignKeys {
    /// The name of the record; empty for all.
    record: &'static str,
    keys: KeyGroup,
    advice: &'static str,
}

const FOREIGN_KEYS: &[ForeignKeys] = &[
    ForeignKeys {
        record: "",
        keys: &["diameter"],
        advice: "`radius` is half of the diameter",
    },
    ForeignKeys {
        record: "scene",
        keys: &[
            "Sphere",
            "Spheres",
            "Plane",
            "Planes",
            "Triangle",
            "Triangles",
            "Quads",
            "Boxes",
            "Box",
            "Cylinders",
            "Cones",
            "Meshes",
            "Mesh",
            "Models",
            "Shapes",
            "Primitives",
            "Geometry",
            "Entities",
            "Surfaces",
        ],
        advice: "every object is an item of the list `Objects`, with its `type`: `- type: sphere`",
    },
    ForeignKeys {
        record: "scene",
        keys: &[
            "PointLights",
            "PointLight",
            "LightSources",
            "Lamps",
            "Lamp",
            "Sun",
        ],
        advice: "every light is an item of the list `Lights`, with `position` and `color`",
    },
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
        advice: "`focalDistance` is the distance of the image, `pixelSize` the size of its pixels",
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
        advice: "pixels are square, and `viewSize` is their number across and down",
    },
    ForeignKeys {
        record: "camera",
        keys: &["focus", "focusDistance", "focalPlane", "focalPoint"],
        advice: "the plane through `center` is in focus",
    },
    ForeignKeys {
        record: "scene",
        keys: &["Materials", "Material", "Textures", "Colors"],
        advice: "materials are written in objects; mark a shared one `&red` and repeat it by \
            `*red`",
    },
    ForeignKeys {
        record: "scene",
        keys: &["Sky", "SkyColor"],
        advice: "`Background` is the colour where nothing is seen; an `Environment` is light from \
            all directions",
    },
    ForeignKeys {
        record: "`SuperSampling` map",
        keys: &["samples", "rays", "count", "size", "level", "n", "rate"],
        advice: "`factor` is the number of rays along each side of a pixel",
    },
    ForeignKeys {
        record: "`SuperSampling` map",
        keys: &["jitter", "jittered", "random", "stratified", "type", "mode"],
        advice: "`pattern` is `grid`, `jitter` or `random`",
    },
    ForeignKeys {
        record: "light",
        keys: &["power", "brightness", "strength", "energy"],
        advice: "the strength of a light is that of its `color`, which may be more than 1",
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

/// The hint for a key of another program, if it is known.
pub(super) fn foreign_key_advice(record: &str, key: &str) -> Option<&'static str> {
    let is_it = |entry: &&ForeignKeys| {
        (entry.record.is_empty() || entry.record == record)
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

    /// A single key belongs to one field; only in groups it may belong to another.
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
