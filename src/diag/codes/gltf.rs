//! `GL`: glTF assets, from the container to what is in the accessors.

super::codes! { GL:
    GLB_HEADER = "GL001", Error, "the header of a .glb file is not sound",
        "A .glb file starts with twelve bytes: the letters glTF, the version 2 and the length of the whole file. The \
         file is no .glb, or a copy or download was cut off. Export or copy it again. With `--lenient` the JSON of a .gltf \
         that is named .glb is read, with a warning.",
        ["GLB_INVALID_MAGIC", "GLB_INVALID_VERSION", "GLB_UNEXPECTED_END_OF_HEADER", "GLB_LENGTH_TOO_SMALL",
         "GLB_LENGTH_MISMATCH"];
    GLB_CHUNK = "GL002", Error, "the chunks of a .glb file are not sound",
        "After its header a .glb file holds chunks: first one of JSON, then at most one of binary data, each with its \
         length, a multiple of four, in front. The file was cut off, or its exporter has a fault. With `--lenient` lengths that are \
         no multiple of four are a warning.",
        ["GLB_CHUNK_TOO_BIG", "GLB_CHUNK_LENGTH_UNALIGNED", "GLB_EMPTY_CHUNK", "GLB_DUPLICATE_CHUNK",
         "GLB_UNEXPECTED_END_OF_CHUNK_HEADER", "GLB_UNEXPECTED_END_OF_CHUNK_DATA", "GLB_UNEXPECTED_FIRST_CHUNK",
         "GLB_UNEXPECTED_BIN_CHUNK"];
    GLB_EXTRA = "GL003", Warning, "a .glb file holds more than it says",
        "Chunks of unknown type and what follows the last chunk are ignored, and so is an embedded file given as a \
         data URI where a chunk would do.",
        ["GLB_UNKNOWN_CHUNK_TYPE", "GLB_EXTRA_DATA", "BUFFER_GLB_CHUNK_TOO_BIG", "DATA_URI_GLB"];
    GLTF_NOT_JSON = "GL004", Error, "the text of a glTF asset is not JSON",
        "The text of a glTF asset is JSON (RFC 8259) in UTF-8 without a byte order mark. The label stands at the first \
         byte that can't be. Values lie in each other at most 512 deep. With `--lenient` a byte order mark is passed over, with \
         a warning.",
        ["INVALID_JSON"];
    GLTF_KEY_TWICE = "GL005", Error, "a key stands twice in one JSON object",
        "Only one of the two could count, and readers of JSON do not agree on which. glTF forbids it. With `--lenient` it is a warning where both say the same.";
    GLTF_TYPE = "GL006", Error, "a value of a glTF asset has another type than its property",
        "The type of each property is laid down in the glTF 2.0 specification; the message says which it is. The \
         property is treated as absent.",
        ["TYPE_MISMATCH", "ARRAY_TYPE_MISMATCH", "INVALID_INDEX"];
    GLTF_MISSING = "GL007", Error, "a required property of a glTF asset is missing",
        "The glTF 2.0 specification requires the property, so no reader can know what was meant.",
        ["UNDEFINED_PROPERTY"];
    GLTF_UNKNOWN = "GL008", Warning, "a glTF asset has a property that means nothing",
        "The specification knows no such property here. It is ignored; most often it is misspelt, or belongs into \
         `extras`. With `--strict` it is an error.",
        ["UNEXPECTED_PROPERTY"];
    GLTF_EMPTY = "GL009", Error, "a list or map of a glTF asset is empty",
        "glTF leaves a property out rather than have it empty. Remove it. With `--lenient` it is taken as absent, with a \
         warning.",
        ["EMPTY_ENTITY"];
    GLTF_VALUE = "GL010", Error, "a value of a glTF asset is out of its range",
        "The specification gives the range, the pattern or the length of the value; the message names it. With `--lenient` \
         strides that are no multiple of four are followed, with a warning.",
        ["VALUE_NOT_IN_RANGE", "PATTERN_MISMATCH", "VALUE_MULTIPLE_OF", "INVALID_GL_VALUE", "ARRAY_LENGTH_NOT_IN_LIST",
         "ROTATION_NON_UNIT", "CAMERA_XMAG_YMAG_ZERO", "CAMERA_ZFAR_LEQUAL_ZNEAR",
         "KHR_LIGHTS_PUNCTUAL_LIGHT_SPOT_ANGLES", "KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_INVALID"];
    GLTF_CHOICE = "GL011", Warning, "a value of a glTF asset is unknown",
        "The property takes one of a few values, which the message lists. Another one is treated as absent: a newer \
         version or an extension may define it.",
        ["VALUE_NOT_IN_LIST"];
    GLTF_DUPLICATE = "GL012", Error, "a list of a glTF asset holds an element twice",
        "The elements of the list must differ: one thing can't be there, be moved or be named twice. Remove one of them. \
         With `--lenient` the last of two channels that move the same counts, with a warning.",
        ["DUPLICATE_ELEMENTS", "KHR_MATERIALS_VARIANTS_NON_UNIQUE_VARIANT", "ANIMATION_DUPLICATE_TARGETS"];
    GLTF_TOGETHER = "GL013", Error, "properties of a glTF asset don't go together",
        "Some properties exclude each other, others need another one beside them; the message says which. With `--lenient` an \
         offset without a view is passed over, with a warning.",
        ["ONE_OF_MISMATCH", "UNSATISFIED_DEPENDENCY", "NODE_MATRIX_TRS",
         "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_NODE", "KHR_ANIMATION_POINTER_ANIMATION_CHANNEL_TARGET_PATH"];
    GLTF_REFERENCE = "GL014", Error, "a reference of a glTF asset leads nowhere",
        "Parts of a glTF asset refer to each other by their index, from 0. There is no part with this index.",
        ["UNRESOLVED_REFERENCE"];
    GLTF_VERSION = "GL015", Error, "a glTF asset has another version than 2",
        "This rtc reads glTF 2.x. Export the asset again, or convert glTF 1.0 with `gltf-pipeline -i old.gltf -o new.glb`.",
        ["UNKNOWN_ASSET_MAJOR_VERSION", "ASSET_MIN_VERSION_GREATER_THAN_VERSION"];
    GLTF_MINOR_VERSION = "GL016", Warning, "a glTF asset has a newer minor version than is known",
        "Minor versions only add what readers may ignore, so the asset is read as glTF 2.0.",
        ["UNKNOWN_ASSET_MINOR_VERSION"];
    GLTF_REQUIRES = "GL017", Error, "a glTF asset requires an extension that is not supported",
        "An extension that is required changes the asset so much that it means nothing without, so it is refused \
         rather than shown wrongly. Export it without that extension.",
        ["UNSUPPORTED_EXTENSION"];
    GLTF_IGNORES = "GL018", Note, "an extension of a glTF asset has no effect",
        "The asset can do without the extension, and does.",
        ["UNSUPPORTED_EXTENSION"];
    GLTF_EXTENSION = "GL019", Error, "an extension of a glTF asset is misused",
        "Each extension that is used is listed in `extensionsUsed`, those that an asset can't do without also in \
         `extensionsRequired`, and each has the places where it may stand. With `--lenient` one that is not listed is taken as \
         listed, with a warning.",
        ["UNDECLARED_EXTENSION", "UNEXPECTED_EXTENSION_OBJECT", "UNUSED_EXTENSION_REQUIRED", "NON_REQUIRED_EXTENSION"];
    GLTF_EXTENSION_ODD = "GL020", Warning, "an extension of a glTF asset is used oddly",
        "Names of extensions have a registered prefix, an underscore and a name; some extensions don't go together.",
        ["INVALID_EXTENSION_NAME_FORMAT", "UNRESERVED_EXTENSION_PREFIX", "MULTIPLE_EXTENSIONS"];
    GLTF_URI = "GL021", Error, "a URI of a glTF asset is not valid",
        "A URI is a relative path, or a data URI: `data:`, a media type, `;base64`, a comma and Base64. With `--lenient` white \
         space in Base64 is passed over, backslashes are slashes, and the bytes of a buffer count whatever their media type, \
         each with a warning.",
        ["INVALID_URI", "BUFFER_DATA_URI_MIME_TYPE_INVALID"];
    GLTF_OUTSIDE = "GL022", Error, "a URI of a glTF asset leads out of its folder",
        "An asset may come from anywhere, so it may not read any file: only those below its own folder, those below \
         the folder given by `--asset-root`, and pictures in the folder above its own. Other paths through `..` or from the \
         root, in whatever disguise, and addresses of other machines are not followed. Put the file beside the asset.",
        ["IO_ERROR", "NON_RELATIVE_URI"];
    GLTF_NO_FILE = "GL023", Error, "a file of a glTF asset can't be read",
        "The file that a URI names is not where it says. Files of an asset move together with it.",
        ["IO_ERROR"];
    GLTF_BUFFER = "GL024", Error, "a buffer of a glTF asset is shorter than it says",
        "The file, the chunk or the data URI holds fewer bytes than `byteLength`. It was cut off, or is another one.",
        ["BUFFER_BYTE_LENGTH_MISMATCH", "BUFFER_MISSING_GLB_DATA"];
    GLTF_VIEW = "GL025", Error, "a buffer view of a glTF asset is not sound",
        "A buffer view is a stretch of a buffer. It must lie within, serve one purpose only, and has a stride only if \
         it holds the attributes of vertices. With `--lenient` attributes that share a view without a stride are each \
         taken as packed, and a view serves what uses it whatever its target, with a warning.",
        ["BUFFER_VIEW_TOO_LONG", "BUFFER_VIEW_TOO_BIG_BYTE_STRIDE", "BUFFER_VIEW_INVALID_BYTE_STRIDE",
         "BUFFER_VIEW_TARGET_OVERRIDE", "IMAGE_BUFFER_VIEW_WITH_BYTESTRIDE", "SKIN_IBM_ACCESSOR_WITH_BYTESTRIDE",
         "MESH_PRIMITIVE_INDICES_ACCESSOR_WITH_BYTESTRIDE", "MESH_PRIMITIVE_ACCESSOR_WITHOUT_BYTESTRIDE",
         "ANIMATION_SAMPLER_ACCESSOR_WITH_BYTESTRIDE"];
    GLTF_ACCESSOR = "GL026", Error, "an accessor of a glTF asset is not sound",
        "An accessor is a view of elements of one type. They must lie within their buffer view and be aligned to their \
         components, vertices to four bytes. With `--lenient` they are read wherever they lie, with a warning.",
        ["ACCESSOR_TOO_LONG", "ACCESSOR_SMALL_BYTESTRIDE", "ACCESSOR_OFFSET_ALIGNMENT",
         "ACCESSOR_TOTAL_OFFSET_ALIGNMENT", "ACCESSOR_MATRIX_ALIGNMENT", "ACCESSOR_NORMALIZED_INVALID",
         "MESH_PRIMITIVE_ACCESSOR_UNALIGNED", "ACCESSOR_USAGE_OVERRIDE"];
    GLTF_HUGE = "GL027", Error, "a glTF asset claims more than it holds",
        "A small file can ask for much memory or time: accessors without data, or many over the same data. What an \
         asset claims must stay in proportion to its size.";
    GLTF_NOT_FINITE = "GL028", Error, "an accessor of a glTF asset holds a number that is not finite",
        "NaN and infinity mean nothing as a position, direction, time or weight. The message names the first. \
         With `--lenient` it is a warning where no index names such an element.",
        ["ACCESSOR_INVALID_FLOAT"];
    GLTF_BOUNDS = "GL029", Error, "the bounds of an accessor of a glTF asset are wrong",
        "`min` and `max` are the least and the greatest value of each component, exactly. With `--lenient` the values \
         count and the bounds don't, with a warning.",
        ["ACCESSOR_MIN_MISMATCH", "ACCESSOR_MAX_MISMATCH", "ACCESSOR_ELEMENT_OUT_OF_MIN_BOUND",
         "ACCESSOR_ELEMENT_OUT_OF_MAX_BOUND"];
    GLTF_SPARSE = "GL030", Error, "a sparse accessor of a glTF asset is not sound",
        "Its indices rise strictly and are below the number of elements.",
        ["ACCESSOR_SPARSE_COUNT_OUT_OF_RANGE", "ACCESSOR_SPARSE_INDICES_NON_INCREASING", "ACCESSOR_SPARSE_INDEX_OOB"];
    GLTF_FORMAT = "GL031", Error, "an accessor of a glTF asset has the wrong format for its use",
        "The specification lists the element and component types for each use; the message names them. With \
         `--lenient` bounds that are missing are computed, with a warning.",
        ["MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_INVALID_FORMAT", "MESH_PRIMITIVE_ATTRIBUTES_ACCESSOR_UNSIGNED_INT",
         "MESH_PRIMITIVE_INDICES_ACCESSOR_INVALID_FORMAT", "SKIN_IBM_INVALID_FORMAT",
         "ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT", "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT",
         "MESH_PRIMITIVE_POSITION_ACCESSOR_WITHOUT_BOUNDS", "ANIMATION_SAMPLER_INPUT_ACCESSOR_WITHOUT_BOUNDS"];
    GLTF_COUNT = "GL032", Error, "counts of a glTF asset don't agree",
        "Attributes of a primitive are as many as its vertices, keyframes as many as their times, weights as many as \
         morph targets, and matrices as many as joints.",
        ["MESH_PRIMITIVE_UNEQUAL_ACCESSOR_COUNT", "MESH_PRIMITIVE_MORPH_TARGET_INVALID_ATTRIBUTE_COUNT",
         "MESH_PRIMITIVES_UNEQUAL_TARGETS_COUNT", "MESH_INVALID_WEIGHTS_COUNT", "NODE_WEIGHTS_INVALID",
         "INVALID_IBM_ACCESSOR_COUNT", "ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT",
         "ANIMATION_SAMPLER_INPUT_ACCESSOR_TOO_FEW_ELEMENTS", "MESH_PRIMITIVE_JOINTS_WEIGHTS_MISMATCH"];
    GLTF_ATTRIBUTE = "GL033", Error, "the attributes of a primitive of a glTF asset are not sound",
        "Names of attributes are those of the specification or start with an underscore; sets are numbered from 0 \
         without gaps; a material finds the texture coordinates and tangents it asks for, and a morph target what it \
         moves.",
        ["MESH_PRIMITIVE_INVALID_ATTRIBUTE", "MESH_PRIMITIVE_INDEXED_SEMANTIC_CONTINUITY",
         "MESH_PRIMITIVE_TOO_FEW_TEXCOORDS", "MESH_PRIMITIVE_MORPH_TARGET_NO_BASE_ACCESSOR",
         "MESH_PRIMITIVE_NO_TANGENT_SPACE"];
    GLTF_PRIMITIVE_ODD = "GL034", Warning, "a primitive of a glTF asset shows less than it could",
        "Without positions nothing shows, without normals tangents mean nothing, vertices that fill no whole triangle \
         are left over, and tangents that a normal map lacks are made up, which not \
         all readers do alike.",
        ["MESH_PRIMITIVE_NO_POSITION", "MESH_PRIMITIVE_TANGENT_WITHOUT_NORMAL", "MESH_PRIMITIVE_INCOMPATIBLE_MODE",
         "MESH_PRIMITIVE_GENERATED_TANGENT_SPACE"];
    GLTF_INDEX = "GL035", Error, "an index of a primitive of a glTF asset leads beyond its vertices",
        "Indices count the vertices from 0. The greatest number of their type restarts a primitive on some hardware \
         and may not be used.",
        ["ACCESSOR_INDEX_OOB", "ACCESSOR_INDEX_PRIMITIVE_RESTART"];
    GLTF_VECTOR = "GL036", Error, "a vector of a glTF asset is not of the length it should have",
        "Normals, tangents and rotations have length 1, handedness is 1 or -1, colours lie between 0 and 1. With \
         `--lenient` they are taken as they are, with a warning.",
        ["ACCESSOR_VECTOR3_NON_UNIT", "ACCESSOR_INVALID_SIGN", "ACCESSOR_NON_CLAMPED",
         "ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION"];
    GLTF_NODES = "GL037", Error, "the nodes of a glTF asset form no tree",
        "A node has at most one parent, is not below itself, and a scene lists roots only. With `--lenient` a root that \
         has a parent is shown where its parent puts it, with a warning.",
        ["NODE_LOOP", "NODE_PARENT_OVERRIDE", "SCENE_NON_ROOT_NODE"];
    GLTF_MATRIX = "GL038", Error, "a matrix of a glTF asset is not allowed by glTF",
        "The matrix of a node keeps space three-dimensional, and its last row, like that of an inverse bind matrix, is \
         0, 0, 0, 1. With `--lenient` the last row is taken as that, with a warning.",
        ["NODE_MATRIX_NON_TRS", "ACCESSOR_INVALID_IBM"];
    GLTF_SKIN = "GL039", Error, "a skin of a glTF asset is not sound",
        "The joints of a skin hang on one root, in the scene of the mesh that they move, and the weights of a vertex \
         sum to 1 over different joints. With `--lenient` a `skeleton` that is not above all joints is passed over, with a \
         warning.",
        ["SKIN_NO_COMMON_ROOT", "SKIN_SKELETON_INVALID", "NODE_SKIN_NO_SCENE", "NODE_SKIN_WITH_NON_SKINNED_MESH",
         "ACCESSOR_JOINTS_INDEX_OOB", "ACCESSOR_JOINTS_INDEX_DUPLICATE", "ACCESSOR_WEIGHTS_NEGATIVE",
         "ACCESSOR_WEIGHTS_NON_NORMALIZED"];
    GLTF_SKIN_ODD = "GL040", Warning, "a skin of a glTF asset is used oddly",
        "A skinned mesh is placed by its joints alone: transformations of its own node have no effect, and without a \
         skin it stands unposed.",
        ["NODE_SKINNED_MESH_WITHOUT_SKIN", "NODE_SKINNED_MESH_NON_ROOT", "NODE_SKINNED_MESH_LOCAL_TRANSFORMS",
         "ACCESSOR_JOINTS_USED_ZERO_WEIGHT", "ANIMATION_CHANNEL_TARGET_NODE_SKIN"];
    GLTF_ANIMATION = "GL041", Error, "an animation of a glTF asset is not sound",
        "Times start at 0 or later and rise; a node with a matrix can't be moved, and weights need morph targets.",
        ["ACCESSOR_ANIMATION_INPUT_NEGATIVE", "ACCESSOR_ANIMATION_INPUT_NON_INCREASING",
         "ANIMATION_CHANNEL_TARGET_NODE_MATRIX", "ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS"];
    GLTF_IMAGE = "GL042", Error, "an image of a glTF asset can't be read",
        "Images are PNG or JPEG, or WebP with its extension, and are what their media type says. A damaged image shows \
         itself by the words of its decoder. With `--lenient` its bytes count where they are not what the type says, and a \
         WebP is read without its extension, with a warning.",
        ["IMAGE_DATA_INVALID", "IMAGE_UNEXPECTED_EOS", "IMAGE_MIME_TYPE_INVALID", "IMAGE_NON_ENABLED_MIME_TYPE",
         "TEXTURE_INVALID_IMAGE_MIME_TYPE"];
    GLTF_IMAGE_ODD = "GL043", Warning, "an image of a glTF asset has features that are not supported",
        "It is neither PNG nor JPEG nor WebP, or has what is not followed: colours of its own, pixels that are no squares, \
         an animation. A texture without an image shows its factor alone.",
        ["IMAGE_UNRECOGNIZED_FORMAT", "IMAGE_FEATURES_UNSUPPORTED"];
    GLTF_HUGE_IMAGE = "GL044", Error, "an image of a glTF asset has too many pixels",
        "A small file can ask for much memory, so the size is looked at before an image is decoded: at most 16384 × \
         16384 pixels, and 1 GiB while it is decoded. Scale the picture down.";
    GLTF_MATERIAL_ODD = "GL045", Warning, "a value of a glTF asset has no effect where it stands",
        "An alpha cutoff needs the mode MASK, a volume needs light that enters it, dispersion a volume, an emissive \
         strength something that emits, and a camera opens less than half a turn. Extensions of materials that are not \
         drawn have no effect either, nor channels whose pointer names what is not followed.",
        ["MATERIAL_ALPHA_CUTOFF_INVALID_MODE", "KHR_MATERIALS_VOLUME_NO_TRANSMISSION",
         "KHR_MATERIALS_VOLUME_DOUBLE_SIDED", "KHR_MATERIALS_DISPERSION_NO_VOLUME",
         "KHR_MATERIALS_EMISSIVE_STRENGTH_ZERO_FACTOR",
         "KHR_MATERIALS_CLEARCOAT_CLEARCOAT_NORMAL_TEXTURE_TEXCOORD",
         "KHR_MATERIALS_ANISOTROPY_ANISOTROPY_TEXTURE_TEXCOORD", "CAMERA_YFOV_GEQUAL_PI",
         "CAMERA_XMAG_YMAG_NEGATIVE"];
    GLTF_REMARK = "GL046", Note, "a glTF asset could be leaner or cleaner",
        "Nothing is wrong, but something is unused, empty, superfluous, or said in an unusual way.",
        ["NODE_EMPTY", "NODE_MATRIX_DEFAULT", "NON_OBJECT_EXTRAS", "EXTRA_PROPERTY", "URI_GLB", "GLB_EMPTY_BIN_CHUNK",
         "UNUSED_OBJECT", "UNUSED_MESH_WEIGHTS", "UNUSED_MESH_TANGENT", "ACCESSOR_INDEX_TRIANGLE_DEGENERATE",
         "IMAGE_NPOT_DIMENSIONS", "BUFFER_VIEW_TARGET_MISSING",
         "KHR_MATERIALS_IRIDESCENCE_THICKNESS_RANGE_WITHOUT_TEXTURE",
         "KHR_MATERIALS_IRIDESCENCE_THICKNESS_TEXTURE_UNUSED"];
    GLTF_COMPRESSED = "GL047", Error, "compressed geometry of a glTF asset can't be decompressed",
        "The data of `KHR_draco_mesh_compression` or `EXT_meshopt_compression` is damaged, or is not what the accessors \
         say. Compress the asset again.";
    GLTF_CHOSEN = "GL048", Error, "a scene has nothing of that name",
        "The command line names a camera, an animation or a variant of the materials that the scene has not. The message \
         lists those that it has; scenes other than glTF assets have one camera, without a name.";
    GLTF_STILL = "GL049", Warning, "a scene without animations is asked for a time",
        "`--time` shows what the first animation of a glTF asset, or the one that `--animation` names, makes of it then. The \
         scene has none, so it is the same at all times.";
    GLTF_NEARLY = "GL050", Note, "what is written as glTF comes near what the scene says",
        "`rtc compile -o scene.glb` writes meshes for curved shapes, squares for planes, 32-bit floats for what is finer, \
         and for Phong's model the metallic-roughness material that comes nearest. `--tolerance` says how far a mesh may be \
         from its shape.";
    GLTF_OWN_WORDS = "GL051", Note, "glTF has no words for a value, so it stands in `extras.rtc`",
        "glTF says nothing of lenses, of cameras that look past the middle of their picture, of lights without falloff, of \
         Phong's weights, of what surrounds a scene, or of how a picture is made. `rtc compile -o scene.glb` writes such \
         values into `extras.rtc` of the part they belong to, the picture of the surroundings among images or accessors. rtc \
         reads them back; other programs show the scene without them.";
    GLTF_UNSAID = "GL052", Warning, "glTF has no words for a value, and it is left out",
        "`rtc compile -o scene.glb` has no place for the value, not even in `extras.rtc`: a texture that is sheared, \
         numbers beyond the range of 32-bit floats. Without a place for its geometry a scene is not written at all.";
}
