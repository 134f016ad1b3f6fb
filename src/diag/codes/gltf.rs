//! `GL`: glTF assets, from the container to the contents of accessors.

super::codes! { GL:
    GLB_HEADER = "GL001", Error, "the header of a .glb file is wrong",
        ["GLB_INVALID_MAGIC", "GLB_INVALID_VERSION", "GLB_UNEXPECTED_END_OF_HEADER",
         "GLB_LENGTH_TOO_SMALL", "GLB_LENGTH_MISMATCH"];
    GLB_CHUNK = "GL002", Error, "the chunks of a .glb file are wrong",
        ["GLB_CHUNK_TOO_BIG", "GLB_CHUNK_LENGTH_UNALIGNED", "GLB_EMPTY_CHUNK",
         "GLB_DUPLICATE_CHUNK", "GLB_UNEXPECTED_END_OF_CHUNK_HEADER",
         "GLB_UNEXPECTED_END_OF_CHUNK_DATA", "GLB_UNEXPECTED_FIRST_CHUNK",
         "GLB_UNEXPECTED_BIN_CHUNK"];
    GLB_EXTRA = "GL003", Warning, "a .glb file has superfluous data",
        ["GLB_UNKNOWN_CHUNK_TYPE", "GLB_EXTRA_DATA", "BUFFER_GLB_CHUNK_TOO_BIG", "DATA_URI_GLB"];
    GLTF_NOT_JSON = "GL004", Error, "the text of a glTF asset is not JSON",
        ["INVALID_JSON"];
    GLTF_KEY_TWICE = "GL005", Error, "a JSON object has the same key twice";
    GLTF_TYPE = "GL006", Error, "a glTF property has the wrong type",
        ["TYPE_MISMATCH", "ARRAY_TYPE_MISMATCH", "INVALID_INDEX"];
    GLTF_MISSING = "GL007", Error, "a required glTF property is missing",
        ["UNDEFINED_PROPERTY"];
    GLTF_UNKNOWN = "GL008", Warning, "a glTF asset has an unknown property",
        ["UNEXPECTED_PROPERTY"];
    GLTF_EMPTY = "GL009", Error, "a list or map of a glTF asset is empty",
        ["EMPTY_ENTITY"];
    GLTF_VALUE = "GL010", Error, "a glTF value is outside its range",
        ["VALUE_NOT_IN_RANGE", "PATTERN_MISMATCH", "VALUE_MULTIPLE_OF", "INVALID_GL_VALUE",
         "ARRAY_LENGTH_NOT_IN_LIST", "ROTATION_NON_UNIT", "CAMERA_XMAG_YMAG_ZERO",
         "CAMERA_ZFAR_LEQUAL_ZNEAR", "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES",
         "KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_INVALID"];
    GLTF_CHOICE = "GL011", Warning, "a glTF value is not in the list of allowed values",
        ["VALUE_NOT_IN_LIST"];
    GLTF_DUPLICATE = "GL012", Error, "a list of a glTF asset has the same element twice",
        ["DUPLICATE_ELEMENTS", "KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT",
         "ANIMATION_DUPLICATE_TARGETS"];
    GLTF_TOGETHER = "GL013", Error, "properties of a glTF asset contradict each other",
        ["ONE_OF_MISMATCH", "UNSATISFIED_DEPENDENCY", "NODE_MATRIX_TRS",
         "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE",
         "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH"];
    GLTF_REFERENCE = "GL014", Error, "an index of a glTF asset refers to nothing",
        ["UNRESOLVED_REFERENCE"];
    GLTF_VERSION = "GL015", Error, "a glTF asset has another version than 2",
        ["UNKNOWN_ASSET_MAJOR_VERSION", "ASSET_MIN_VERSION_GREATER_THAN_VERSION"];
    GLTF_MINOR_VERSION = "GL016", Warning, "a glTF asset has a newer minor version",
        ["UNKNOWN_ASSET_MINOR_VERSION"];
    GLTF_REQUIRES = "GL017", Error, "a glTF asset requires an extension that is not supported",
        ["UNSUPPORTED_EXTENSION"];
    GLTF_IGNORES = "GL018", Note, "an extension of a glTF asset has no effect",
        ["UNSUPPORTED_EXTENSION"];
    GLTF_EXTENSION = "GL019", Error, "an extension of a glTF asset is misused",
        ["UNDECLARED_EXTENSION", "UNEXPECTED_EXTENSION_OBJECT", "UNUSED_EXTENSION_REQUIRED",
         "NON_REQUIRED_EXTENSION"];
    GLTF_EXTENSION_ODD = "GL020", Warning, "the name of a glTF extension is unusual",
        ["INVALID_EXTENSION_NAME_FORMAT", "UNRESERVED_EXTENSION_PREFIX", "MULTIPLE_EXTENSIONS"];
    GLTF_URI = "GL021", Error, "a URI of a glTF asset is not valid",
        ["INVALID_URI", "BUFFER_DATA_URI_MIME_TYPE_INVALID"];
    GLTF_OUTSIDE = "GL022", Error, "a URI of a glTF asset leaves its folder",
        ["IO_ERROR", "NON_RELATIVE_URI"];
    GLTF_NO_FILE = "GL023", Error, "a file of a glTF asset cannot be read",
        ["IO_ERROR"];
    GLTF_BUFFER = "GL024", Error, "a buffer of a glTF asset is shorter than its `byteLength`",
        ["BUFFER_BYTE_LENGTH_MISMATCH", "BUFFER_MISSING_GLB_DATA"];
    GLTF_VIEW = "GL025", Error, "a buffer view of a glTF asset is wrong",
        ["BUFFER_VIEW_TOO_LONG", "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE",
         "BUFFER_VIEW_INVALID_BYTE_STRIDE", "BUFFER_VIEW_TARGET_OVERRIDE",
         "IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE", "SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE",
         "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE",
         "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
         "ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE"];
    GLTF_ACCESSOR = "GL026", Error, "an accessor of a glTF asset is out of bounds or not aligned",
        ["ACCESSOR_TOO_LONG", "ACCESSOR_SMALL_BYTESTRIDE", "ACCESSOR_OFFSET_ALIGNMENT",
         "ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "ACCESSOR_MATRIX_ALIGNMENT",
         "ACCESSOR_NORMALIZED_INVALID", "MESH_PRIMITIVE_ACCESSOR_UNALIGNED",
         "ACCESSOR_USAGE_OVERRIDE"];
    GLTF_HUGE = "GL027", Error, "a glTF asset claims more data than it holds";
    GLTF_NOT_FINITE = "GL028", Error, "an accessor of a glTF asset holds a number that is not \
        finite",
        ["ACCESSOR_INVALID_FLOAT"];
    GLTF_BOUNDS = "GL029", Error, "the bounds of an accessor of a glTF asset are wrong",
        ["ACCESSOR_MIN_MISMATCH", "ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
         "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND"];
    GLTF_SPARSE = "GL030", Error, "a sparse accessor of a glTF asset is wrong",
        ["ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", "ACCESSOR_SPARSE_INDICES_NON_INCREASING",
         "ACCESSOR_SPARSE_INDEX_OOB"];
    GLTF_FORMAT = "GL031", Error, "an accessor of a glTF asset has the wrong format for its use",
        ["MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT",
         "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
         "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", "SKIN_IBM_INVALID_FORMAT",
         "ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT",
         "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
         "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS",
         "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS"];
    GLTF_COUNT = "GL032", Error, "counts of a glTF asset do not agree",
        ["MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT",
         "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
         "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", "MESH_INVALID_WEIGHTS_COUNT",
         "NODE_WEIGHTS_INVALID", "INVALID_IBM_ACCESSOR_COUNT",
         "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
         "ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS",
         "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH"];
    GLTF_ATTRIBUTE = "GL033", Error, "the attributes of a glTF primitive are wrong",
        ["MESH_PRIMITIVE_INVALID_ATTRIBUTE", "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
         "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
         "MESH_PRIMITIVE_NO_TANGENT_SPACE"];
    GLTF_PRIMITIVE_ODD = "GL034", Warning, "a primitive of a glTF asset shows less than it could",
        ["MESH_PRIMITIVE_NO_POSITION", "MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL",
         "MESH_PRIMITIVE_INCOMPATIBLE_MODE", "MESH_PRIMITIVE_GENERATED_TANGENT_SPACE"];
    GLTF_INDEX = "GL035", Error, "an index of a glTF primitive exceeds its vertices",
        ["ACCESSOR_INDEX_OOB", "ACCESSOR_INDEX_PRIMITIVE_RESTART"];
    GLTF_VECTOR = "GL036", Error, "a vector of a glTF asset has the wrong length",
        ["ACCESSOR_VECTOR3_NON_UNIT", "ACCESSOR_INVALID_SIGN", "ACCESSOR_NON_CLAMPED",
         "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION"];
    GLTF_NODES = "GL037", Error, "the nodes of a glTF asset do not form a tree",
        ["NODE_LOOP", "NODE_PARENT_OVERRIDE", "SCENE_NON_ROOT_NODE"];
    GLTF_MATRIX = "GL038", Error, "a matrix of a glTF asset is not allowed",
        ["NODE_MATRIX_NON_TRS", "ACCESSOR_INVALID_IBM"];
    GLTF_SKIN = "GL039", Error, "a skin of a glTF asset is wrong",
        ["SKIN_NO_COMMON_ROOT", "SKIN_SKELETON_INVALID", "NODE_SKIN_NO_SCENE",
         "NODE_SKIN_WITH_NON_SKINNED_MESH", "ACCESSOR_JOINTS_INDEX_OOB",
         "ACCESSOR_JOINTS_INDEX_DUPLICATE", "ACCESSOR_WEIGHTS_NEGATIVE",
         "ACCESSOR_WEIGHTS_NON_NORMALIZED"];
    GLTF_SKIN_ODD = "GL040", Warning, "a skin of a glTF asset is used in an unusual way",
        ["NODE_SKINNED_MESH_WITHOUT_SKIN", "NODE_SKINNED_MESH_NON_ROOT",
         "NODE_SKINNED_MESH_LOCAL_TRANSFORMS", "ACCESSOR_JOINTS_USED_ZERO_WEIGHT",
         "ANIMATION_CHANNEL_TARGET_NODE_SKIN"];
    GLTF_ANIMATION = "GL041", Error, "an animation of a glTF asset is wrong",
        ["ACCESSOR_ANIMATION_INPUT_NEGATIVE", "ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
         "ANIMATION_CHANNEL_TARGET_NODE_MATRIX", "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS"];
    GLTF_IMAGE = "GL042", Error, "an image of a glTF asset cannot be read",
        ["IMAGE_DATA_INVALID", "IMAGE_UNEXPECTED_EOS", "IMAGE_MIME_TYPE_INVALID",
         "IMAGE_NON_ENABLED_MIME_TYPE", "TEXTURE_INVALID_IMAGE_MIME_TYPE"];
    GLTF_IMAGE_ODD = "GL043", Warning, "an image of a glTF asset has unsupported features",
        ["IMAGE_UNRECOGNIZED_FORMAT", "IMAGE_FEATURES_UNSUPPORTED"];
    GLTF_HUGE_IMAGE = "GL044", Error, "an image of a glTF asset has too many pixels";
    GLTF_MATERIAL_ODD = "GL045", Warning, "a value of a glTF asset has no effect",
        ["MATERIAL_ALPHA_CUTOFF_INVALID_MODE", "KHR_MATERIALS_VOLUME_NO_TRANSMISSION",
         "KHR_MATERIALS_VOLUME_DOUBLE_SIDED", "KHR_MATERIALS_DISPERSION_NO_VOLUME",
         "KHR_MATERIALS_EMISSIVE_STRENGTH_ZERO_FACTOR",
         "KHR_MATERIALS_CLEARCOAT_CLEARCOAT_NORMAL_TEXTURE_TEXCOORD",
         "KHR_MATERIALS_ANISOTROPY_ANISOTROPY_TEXTURE_TEXCOORD", "CAMERA_YFOV_GEQUAL_PI",
         "CAMERA_XMAG_YMAG_NEGATIVE"];
    GLTF_REMARK = "GL046", Note, "a glTF asset has something unused or redundant",
        ["NODE_EMPTY", "NODE_MATRIX_DEFAULT", "NON_OBJECT_EXTRAS", "EXTRA_PROPERTY", "URI_GLB",
         "GLB_EMPTY_BIN_CHUNK", "UNUSED_OBJECT", "UNUSED_MESH_WEIGHTS", "UNUSED_MESH_TANGENT",
         "ACCESSOR_INDEX_TRIANGLE_DEGENERATE", "IMAGE_NPOT_DIMENSIONS",
         "BUFFER_VIEW_TARGET_MISSING", "KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_WITHOUT_TEXTURE",
         "KHR_MATERIALS_IRIDESCENCE_THICKNESS_TEXTURE_UNUSED"];
    GLTF_COMPRESSED = "GL047", Error, "compressed geometry of a glTF asset cannot be decompressed";
    GLTF_CHOSEN = "GL048", Error, "the scene has no camera, animation or variant of that name";
    GLTF_STILL = "GL049", Warning, "`--time` is given for a scene without animations";
    GLTF_APPROXIMATED = "GL050", Note, "the glTF file only approximates the scene";
    GLTF_OWN_WORDS = "GL051", Note, "a value is written to `extras.rtc`, because glTF cannot hold \
        it";
    GLTF_UNSAID = "GL052", Warning, "a value cannot be written to glTF and is left out";
}
