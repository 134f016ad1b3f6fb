//! The instruction that follows a finding: what to change in the file, one sentence for each kind
//! of mistake.

use rtc_diag::{Code, codes};

/// What to do about a finding of `code` that the validator of Khronos calls `alias`.
pub(super) fn advice(code: &Code, alias: &str) -> Option<&'static str> {
    let by_alias = BY_ALIAS.iter().find(|(kinds, _)| kinds.contains(&alias));
    let by_code = || BY_CODE.iter().find(|(kind, _)| kind.id == code.id);
    by_alias
        .map(|(_, text)| *text)
        .or_else(|| by_code().map(|(_, text)| *text))
}

/// The rows of a table: kinds and their instruction.
macro_rules! rows {
    (alias: $($($kind:ident)+ => $text:literal;)*) => {
        &[$((&[$(stringify!($kind)),+], $text)),*]
    };
    (code: $($kind:ident => $text:literal;)*) => { &[$((&codes::$kind, $text)),*] };
}

/// Kinds whose code covers several kinds of mistake.
const BY_ALIAS: &[(&[&str], &str)] = rows! { alias:
    // The container.
    GLB_INVALID_MAGIC => "export the asset as `.glb`, or name it `.gltf` if it is JSON";
    GLB_UNEXPECTED_END_OF_HEADER GLB_UNEXPECTED_END_OF_CHUNK_HEADER
        GLB_UNEXPECTED_END_OF_CHUNK_DATA =>
        "copy the whole file again, or export it again";
    GLB_LENGTH_TOO_SMALL GLB_LENGTH_MISMATCH =>
        "write the size of the whole file, in bytes, at byte 8";
    GLB_CHUNK_TOO_BIG => "correct the length of the chunk, or that of the file at byte 8";
    GLB_CHUNK_LENGTH_UNALIGNED =>
        "pad JSON with spaces and binary data with zeros, and count the padding in the length";
    GLB_EMPTY_CHUNK => "write the JSON of the asset into the chunk";
    GLB_DUPLICATE_CHUNK => "join the chunks, or remove the second";
    GLB_UNEXPECTED_FIRST_CHUNK GLB_UNEXPECTED_BIN_CHUNK =>
        "write the JSON chunk, then the binary chunk, then all others";
    GLB_EXTRA_DATA => "cut the file off after its last chunk";
    BUFFER_GLB_CHUNK_TOO_BIG => "raise `byteLength` of the buffer, or shorten the chunk";
    DATA_URI_GLB URI_GLB => "move the data into the binary chunk and remove the `uri`";
    GLB_EMPTY_BIN_CHUNK => "remove the chunk, or write the data of the buffer into it";
    // Properties.
    INVALID_INDEX => "write the position of an element in its list: a whole number, counted from 0";
    PATTERN_MISMATCH => "write a text of this form";
    VALUE_MULTIPLE_OF => "pad each element up to such a size, and write that size";
    INVALID_GL_VALUE =>
        "write a value that the component type can hold, or use a larger component type";
    ARRAY_LENGTH_NOT_IN_LIST => "write as many numbers as the property has, or export the asset again";
    ROTATION_NON_UNIT => "divide the four numbers by the length";
    CAMERA_XMAG_YMAG_ZERO =>
        "set `xmag` and `ymag` to half the width and half the height of the view";
    CAMERA_XMAG_YMAG_NEGATIVE =>
        "remove the sign, and turn the camera if the view must be mirrored";
    CAMERA_YFOV_GEQUAL_PI => "write `yfov` in radians, below π";
    CAMERA_ZFAR_LEQUAL_ZNEAR => "raise `zfar` or lower `znear`";
    KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES => "raise `outerConeAngle` or lower `innerConeAngle`";
    KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_INVALID =>
        "exchange `iridescenceThicknessMinimum` and `iridescenceThicknessMaximum`";
    KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT => "remove the variant from all mappings but one";
    ANIMATION_DUPLICATE_TARGETS => "remove one of the channels, or give it another target";
    ONE_OF_MISMATCH => "write exactly one of the two";
    UNSATISFIED_DEPENDENCY => "add what is missing, or remove what needs it";
    NODE_MATRIX_TRS => "remove the `matrix`, or remove the other three";
    KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE => "remove one of them";
    KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH =>
        "change the path, or remove `KHR_animation_pointer` from the target";
    ASSET_MIN_VERSION_GREATER_THAN_VERSION => "lower `minVersion`, or raise `version`";
    // Extensions.
    UNSUPPORTED_EXTENSION => "remove it, or express its effect without extensions";
    UNDECLARED_EXTENSION UNUSED_EXTENSION_REQUIRED => "add its name to `extensionsUsed`";
    UNEXPECTED_EXTENSION_OBJECT => "move it to an object that it extends, or remove it";
    NON_REQUIRED_EXTENSION => "copy the name from `extensionsUsed`";
    INVALID_EXTENSION_NAME_FORMAT => "write a prefix in capitals, an underscore and a name";
    UNRESERVED_EXTENSION_PREFIX => "use a prefix that Khronos has registered, such as `EXT`; if another program reads the extension, this warning can stay";
    MULTIPLE_EXTENSIONS => "remove it, or remove the other extensions of the material";
    // Files, buffers and buffer views.
    BUFFER_DATA_URI_MIME_TYPE_INVALID =>
        "replace the text between `data:` and the first `;` or `,`";
    BUFFER_MISSING_GLB_DATA => "add a binary chunk, or give the buffer a `uri`";
    BUFFER_VIEW_TOO_LONG => "correct `byteOffset` and `byteLength`, or enlarge the buffer";
    BUFFER_VIEW_TOO_BIG_BYTE_STRIDE => "write the distance between two elements in bytes";
    BUFFER_VIEW_INVALID_BYTE_STRIDE IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE
        SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE
        ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE =>
        "store the data without gaps and remove the stride";
    MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE =>
        "add the distance between two vertices in bytes, or use a buffer view for each attribute";
    BUFFER_VIEW_TARGET_OVERRIDE =>
        "correct `target`, or store each kind of data in its own buffer view";
    BUFFER_VIEW_TARGET_MISSING => "set `target` to 34962 for vertices, or to 34963 for indices";
    // Accessors.
    ACCESSOR_TOO_LONG => "lower `count`, correct `byteOffset`, or enlarge the buffer view";
    ACCESSOR_SMALL_BYTESTRIDE => "raise `byteStride` to the size of an element or more";
    ACCESSOR_OFFSET_ALIGNMENT ACCESSOR_TOTAL_OFFSET_ALIGNMENT ACCESSOR_MATRIX_ALIGNMENT
        MESH_PRIMITIVE_ACCESSOR_UNALIGNED =>
        "insert padding before the data and between its elements, and correct offset and stride";
    ACCESSOR_NORMALIZED_INVALID => "remove `normalized`, or convert the data";
    ACCESSOR_USAGE_OVERRIDE => "give each use an accessor of its own";
    ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE =>
        "lower the `count` of `sparse`, or raise that of the accessor";
    ACCESSOR_SPARSE_INDICES_NON_INCREASING =>
        "sort the indices together with their values, and keep each index once";
    ACCESSOR_SPARSE_INDEX_OOB => "write an index below the `count` of the accessor";
    MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS
        ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS =>
        "add the least and the greatest value of each component to the accessor";
    ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS =>
        "add a keyframe, or use the interpolation `LINEAR` or `STEP`";
    // Primitives.
    MESH_PRIMITIVE_INVALID_ATTRIBUTE =>
        "use a name that glTF defines, as `TEXCOORD_0`, or start it with `_`";
    MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY => "number the sets from 0 without gaps";
    MESH_PRIMITIVE_TOO_FEW_TEXCOORDS =>
        "add the attribute to the primitive, or change `texCoord` of the texture";
    MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR =>
        "add the attribute to the primitive, or remove it from the target";
    MESH_PRIMITIVE_NO_TANGENT_SPACE MESH_PRIMITIVE_GENERATED_TANGENT_SPACE =>
        "export the mesh with the attribute `TANGENT`";
    MESH_PRIMITIVE_NO_POSITION => "add the attribute, or remove the primitive";
    MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL => "add the normals, or remove the tangents";
    MESH_PRIMITIVE_INCOMPATIBLE_MODE => "add or remove vertices or indices, or change `mode`";
    ACCESSOR_INDEX_OOB => "write indices of existing vertices, counted from 0, or add the vertices";
    ACCESSOR_INDEX_PRIMITIVE_RESTART =>
        "begin another primitive here, or use a larger component type";
    ACCESSOR_INDEX_TRIANGLE_DEGENERATE => "remove these triangles";
    ACCESSOR_VECTOR3_NON_UNIT ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION =>
        "divide each of these elements by its length";
    ACCESSOR_INVALID_SIGN => "correct the fourth number of each tangent";
    ACCESSOR_NON_CLAMPED => "clamp the numbers to this range";
    // Nodes, skins and animations.
    NODE_LOOP => "remove a node of the loop from the `children` of its parent";
    NODE_PARENT_OVERRIDE => "remove the node from the `children` of one parent, or copy it";
    SCENE_NON_ROOT_NODE => "remove it from this list, and list the root of its tree if it is not listed";
    NODE_MATRIX_NON_TRS =>
        "use `translation`, `rotation` and `scale`, or apply the matrix to the vertices";
    ACCESSOR_INVALID_IBM => "write 0, 0, 0, 1 as the last row of each matrix";
    NODE_MATRIX_DEFAULT => "remove the `matrix`";
    NODE_EMPTY => "remove the node, or give it a mesh, a camera or children";
    SKIN_NO_COMMON_ROOT => "put all joints of the skin below one node";
    SKIN_SKELETON_INVALID => "write the index of a common ancestor, or remove `skeleton`";
    NODE_SKIN_NO_SCENE => "add the root of the joints to the `nodes` of the scene";
    NODE_SKIN_WITH_NON_SKINNED_MESH =>
        "add `JOINTS_0` and `WEIGHTS_0` to the mesh, or remove the skin";
    ACCESSOR_JOINTS_INDEX_OOB =>
        "write a position in the list `joints` of the skin, or add the joint";
    ACCESSOR_JOINTS_INDEX_DUPLICATE =>
        "add up its weights in one place, and set the other weight and joint to 0";
    ACCESSOR_WEIGHTS_NEGATIVE => "set the weight to 0, and scale the others to the sum 1";
    ACCESSOR_WEIGHTS_NON_NORMALIZED => "divide the weights of each vertex by their sum";
    NODE_SKINNED_MESH_WITHOUT_SKIN => "give the node a `skin`, or remove the joints and weights";
    NODE_SKINNED_MESH_NON_ROOT => "move the node to the `nodes` of the scene";
    NODE_SKINNED_MESH_LOCAL_TRANSFORMS => "remove the transform, or apply it to the joints";
    ACCESSOR_JOINTS_USED_ZERO_WEIGHT => "set the joint to 0 too";
    ANIMATION_CHANNEL_TARGET_NODE_SKIN => "animate the joints of the skin instead";
    ACCESSOR_ANIMATION_INPUT_NEGATIVE => "move the keyframes so that the first is at 0 or later";
    ACCESSOR_ANIMATION_INPUT_NON_INCREASING =>
        "sort the keyframes by time, and keep each time once";
    ANIMATION_CHANNEL_TARGET_NODE_MATRIX =>
        "replace the matrix by `translation`, `rotation` and `scale`";
    ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS =>
        "add morph targets to its mesh, or remove the channel";
    // Images and materials.
    IMAGE_MIME_TYPE_INVALID TEXTURE_INVALID_IMAGE_MIME_TYPE =>
        "correct `mimeType`, or the media type in the data URI";
    IMAGE_NON_ENABLED_MIME_TYPE =>
        "name the extension in `extensionsUsed`, or save the image as PNG or JPEG";
    IMAGE_UNRECOGNIZED_FORMAT => "save the image as PNG or JPEG";
    IMAGE_FEATURES_UNSUPPORTED =>
        "save the image as sRGB, with square pixels and without animation";
    IMAGE_NPOT_DIMENSIONS => "resize both sides to powers of two, for readers that need it";
    MATERIAL_ALPHA_CUTOFF_INVALID_MODE => "set `alphaMode` to `MASK`, or remove the cutoff";
    KHR_MATERIALS_VOLUME_NO_TRANSMISSION =>
        "add `KHR_materials_transmission`, or remove the volume";
    KHR_MATERIALS_VOLUME_DOUBLE_SIDED => "remove `doubleSided`, or remove the volume";
    KHR_MATERIALS_DISPERSION_NO_VOLUME => "add `KHR_materials_volume`, or remove the dispersion";
    KHR_MATERIALS_EMISSIVE_STRENGTH_ZERO_FACTOR => "set `emissiveFactor`, or remove the strength";
    KHR_MATERIALS_CLEARCOAT_CLEARCOAT_NORMAL_TEXTURE_TEXCOORD
        KHR_MATERIALS_ANISOTROPY_ANISOTROPY_TEXTURE_TEXCOORD =>
        "give both textures the same `texCoord`";
    KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_WITHOUT_TEXTURE =>
        "add `iridescenceThicknessTexture`, or remove the minimum";
    KHR_MATERIALS_IRIDESCENCE_THICKNESS_TEXTURE_UNUSED =>
        "change one of the two thicknesses, or remove the texture";
    // Remarks.
    NON_OBJECT_EXTRAS => "put the value into an object";
    EXTRA_PROPERTY => "remove the property, or change `type` of the light";
    UNUSED_OBJECT => "remove it, or refer to it where it is needed";
    UNUSED_MESH_WEIGHTS UNUSED_MESH_TANGENT => "remove the attribute from the primitive";
};

/// Codes of one kind of mistake, and the rest of the others.
static BY_CODE: &[(&Code, &str)] = rows! { code:
    GLB_HEADER => "export the asset as glTF 2.0";
    GLB_EXTRA => "remove the chunk, unless another program needs it";
    GLTF_NOT_JSON => "complete or correct the JSON: UTF-8, all brackets closed, no comments, no trailing commas";
    GLTF_KEY_TWICE => "remove one of the two";
    GLTF_TYPE => "write a value of that type, or remove it if it is optional";
    GLTF_MISSING => "add the property: it has no default";
    GLTF_UNKNOWN => "correct its spelling, move it into `extras`, or remove it";
    GLTF_EMPTY => "add an element, or remove the property if it is optional";
    GLTF_VALUE => "write such a value, or remove the property if it is optional";
    GLTF_CHOICE => "write one of these values";
    GLTF_DUPLICATE => "remove the second";
    GLTF_REFERENCE => "write the index of an existing object, counted from 0, or add the object";
    GLTF_VERSION => "export the asset as glTF 2.0";
    GLTF_MINOR_VERSION => "export the asset as glTF 2.0, if something is missing in the picture";
    GLTF_IGNORES => "remove the coarser levels, if no other program needs them";
    GLTF_URI =>
        "escape a file name with `%` and two digits, and write data as Base64 without spaces";
    GLTF_NO_FILE => "name a file that exists and that you may read";
    GLTF_BUFFER => "lower `byteLength`, or restore the missing bytes";
    GLTF_ACCESSOR => "correct `width`, or the number of elements";
    GLTF_HUGE => "lower `count`, or let fewer accessors read the same bytes";
    GLTF_NOT_FINITE => "replace these elements by finite numbers";
    GLTF_BOUNDS => "write the least and the greatest value of the elements";
    GLTF_FORMAT => "convert the data, and change `type` and `componentType` with it";
    GLTF_COUNT => "add or remove elements until the counts agree";
    GLTF_IMAGE => "save the image again as PNG or JPEG";
    GLTF_HUGE_IMAGE => "make the image smaller";
    GLTF_COMPRESSED => "compress the geometry again, or export it without compression";
};

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of findings that do not come from a file, or whose advice is made where they are.
    fn is_elsewhere(code: &Code, alias: &str) -> bool {
        code.id >= "GL048" || matches!(alias, "IO_ERROR" | "NON_RELATIVE_URI")
    }

    #[test]
    fn each_kind_of_mistake_has_advice() {
        for code in codes::GL {
            for alias in code.aliases {
                let found = advice(code, alias).is_some();
                assert!(found || is_elsewhere(code, alias), "{code} {alias}");
            }
        }
    }

    #[test]
    fn each_row_is_of_a_known_kind_and_each_kind_has_one_row() {
        let rows = BY_ALIAS.iter().flat_map(|(kinds, _)| kinds.iter());
        let mut seen = std::collections::BTreeSet::new();
        for alias in rows {
            let known = codes::GL.iter().any(|code| code.aliases.contains(alias));
            assert!(known && seen.insert(alias), "{alias}");
        }
    }
}
