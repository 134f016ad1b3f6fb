//! `VA`: values that are invalid, or probably unintended.
//!
//! Numbers below 100 are raised by validation, for any scene; from 100 on by the readers of texts.

super::codes! { VA:
    NOT_FINITE = "VA001", Error, "a number is not finite or too large to compute with";
    RADIUS = "VA002", Error, "a radius is not positive";
    ZERO_NORMAL = "VA003", Error, "the normal of a plane is the zero vector";
    DEGENERATE_TRIANGLE = "VA004", Warning, "a triangle has no area";
    NEGATIVE = "VA005", Error, "a weight, a colour or a radius of the lens is negative";
    NEGATIVE_EXPONENT = "VA006", Error, "the exponent of a highlight is negative";
    ZERO_COUNT = "VA007", Error, "a number of samples is 0";
    EMPTY_IMAGE = "VA008", Error, "the picture has no pixels";
    HUGE_IMAGE = "VA009", Error, "the picture has more than 16384 × 16384 pixels";
    TOO_MANY_RAYS = "VA010", Error, "the picture takes more than 2^32 rays";
    LIGHT_INSIDE = "VA011", Warning, "a light is inside a solid";
    CAMERA_BASIS = "VA012", Error, "the pixel steps of the camera are not at a right angle";
    EYE_IN_IMAGE_PLANE = "VA013", Error, "the eye lies in the image plane";
    BAD_HANDLE = "VA014", Error, "a surface refers to a material that does not exist";
    ETA = "VA015", Error, "an index of refraction is not positive";
    TOO_DEEP = "VA016", Error, "more than 1000000 bounces";
    BAD_IMAGE = "VA017", Error, "the pixels of an image do not match its size";
    BAD_MESH = "VA018", Error, "a mesh has invalid data";
    BAD_ROTATION = "VA019", Error, "a matrix is not a rotation, or has no inverse";
    BAD_FACTOR = "VA020", Error, "a value of a standard material is outside its range";
    BAD_LIGHT = "VA021", Error, "a light in physical units is not possible";
    NO_LIGHT = "VA022", Warning, "a scene that shades its surfaces has no light";
    COLOR_OF_BYTES = "VA023", Warning, "a colour looks like bytes from 0 to 255";
    SHADOW_IN_PATHS = "VA024", Warning, "`shadow: false` has no effect in path tracing";
    LOST_PARTS = "VA026", Warning, "the integrator does not show all values of a material";
    INVISIBLE = "VA030", Warning, "an object has no size";
    EYE_INSIDE = "VA031", Warning, "the eye is inside an opaque solid";
    TINY_PICTURE = "VA032", Warning, "all objects together cover only a few pixels";
    LARGE_WEIGHT = "VA033", Warning, "a weight of a material looks like a percentage";
    OPEN_MEDIUM = "VA034", Warning, "an open shape bounds a participating medium";
    UNLIKELY_VALUE = "VA035", Warning, "a value is possible, but hardly the one that is meant";
    OUT_OF_RANGE = "VA101", Error, "a number is outside the range of its key";
    NO_CAMERA = "VA102", Error, "the scene has no camera";
    TWO_CAMERAS = "VA103", Warning, "the scene has both `Camera` and `Eye`";
    EYE_IS_CENTER = "VA104", Error, "the camera looks at its own position";
    ZERO_UP = "VA105", Error, "the `up` of the camera is the zero vector";
    UP_PARALLEL = "VA106", Error, "the `up` of the camera is parallel to the view";
    FLAT_SOLID = "VA107", Error, "a box, prism or tetrahedron has no volume";
    CROSSED_QUAD = "VA108", Warning, "the edges of a quad cross";
    OTHER_UNIT = "VA109", Warning, "an angle looks as if it were in another unit";
    BAD_OPERAND = "VA110", Error, "an operand of solids has no inside, or there are too many";
}
