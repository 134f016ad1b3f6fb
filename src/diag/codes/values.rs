//! `VA`: values that mean nothing, or surely not what was meant.
//!
//! Numbers below 100 are those the proof finds, on any scene; from 100 on they are found in texts.

super::codes! { VA:
    NOT_FINITE = "VA001", Error, "a number is not finite or too large to compute with",
        "Every number of a scene must be finite, and lengths and coordinates must keep their squares within what a \
         64-bit float holds: at most 1e60 in absolute value. An overflow would show as black or white pixels far from its cause.";
    RADIUS = "VA002", Error, "a radius is not above 0",
        "A sphere needs a radius above 0, and of at least 1e-60 so that its powers can be computed. A negative radius \
         is most often a sign in the wrong place.";
    ZERO_NORMAL = "VA003", Error, "the normal of a plane is the zero vector",
        "A plane is a point and a normal; only the direction of the normal counts, but it must have one.";
    DEGENERATE_TRIANGLE = "VA004", Warning, "a triangle has no area",
        "The three corners are in line or fall together, so no ray can hit the triangle. It is left out of the picture. \
         Exporters leave such triangles behind where vertices were merged.";
    NEGATIVE = "VA005", Error, "a weight, colour or radius of the lens is negative",
        "Colours, the weights ka, kd, ks and refract, and the radius of the aperture are at least 0. Colours of lights \
         and surfaces may exceed 1.";
    NEGATIVE_EXPONENT = "VA006", Error, "the exponent of a highlight is negative",
        "The exponent `n` of Phong's highlight is at least 0. A negative one would make the highlight infinite where it \
         should be dark.";
    ZERO_COUNT = "VA007", Error, "a number of samples is 0",
        "The supersampling factor, `apertureSamples` and `glossySamples` are at least 1: with 0 a pixel would be the \
         mean of nothing.";
    EMPTY_IMAGE = "VA008", Error, "the image has no pixels",
        "Width and height of the image are at least 1.";
    HUGE_IMAGE = "VA009", Error, "the image has more than 16384 × 16384 pixels",
        "A picture of that size takes gigabytes. It is most often a slip of the keyboard; if it is meant, \
         `--allow-huge` lifts the limit.";
    TOO_MANY_RAYS = "VA010", Error, "the picture takes more than 2^32 samples",
        "Pixels × supersampling² × aperture samples, or paths a pixel, times the points of a soft light, is what a \
         picture takes even if no ray goes on from what it meets. More than 2^32 take hours. `--limit rays=…` sets \
         another limit, `--allow-huge` lifts it.";
    LIGHT_INSIDE = "VA011", Warning, "a light stands inside a solid",
        "With shadows on, the solid hides the light from all that is outside, glass too. A light is not told of that \
         stands in the same solid as the eye, as a lamp in a room. Most often the lamp should stand beside the object, or \
         the object is to have `shadow: false`.";
    CAMERA_BASIS = "VA012", Error, "the steps between the camera's pixels are no basis",
        "A camera of the IR, and one of a scene with the key `right`, has two steps, `right` and `up`, from a pixel to \
         its neighbours. Neither may be shorter than 1e-60, and they must be at a right angle to within 1e-9.";
    EYE_IN_IMAGE_PLANE = "VA013", Error, "the eye lies in the image plane",
        "Rays go from the eye through the points of the image plane. An eye inside that plane sees the image edge-on, \
         and every ray would run inside the plane.";
    BAD_HANDLE = "VA014", Error, "a surface refers to a material that does not exist",
        "Surfaces refer to materials by index, from 0. Only a damaged or hand-made IR file gets here.";
    ETA = "VA015", Error, "an index of refraction is not above 0",
        "The index of refraction is that of the inside over that of the outside: glass in air has about 1.5, water \
         1.33, and 1 does not bend light.";
    TOO_DEEP = "VA016", Error, "more than 1000000 bounces",
        "`MaxRecursionDepth` is how many mirror or refraction bounces follow the first hit. Most scenes need fewer than \
         10, a box of mirrors a few hundred.";
    BAD_IMAGE = "VA017", Error, "an image has not the pixels it should have",
        "An image of the IR is width × height pixels of three, four or twelve bytes. Only a damaged or hand-made IR file \
         gets here.";
    BAD_MESH = "VA018", Error, "a mesh is not sound",
        "Every vertex, normal and texture coordinate of a mesh is finite, normals and texture coordinates are as many as \
         vertices or none, and triangles refer to vertices that exist. The message names the first culprit, counted \
         from 0. Export the mesh again, or remove the vertex.";
    BAD_ROTATION = "VA019", Error, "a matrix is not a rotation, or flattens",
        "The texture of a sphere is turned by a rotation, and a mesh is placed by a map that keeps its volume: three axes \
         that span space, none of them zero.";
    BAD_FACTOR = "VA020", Error, "a number of a glTF material is outside its range",
        "The specification of glTF gives each factor of a material a range: colours, metallic, roughness and most \
         weights lie in [0, 1], indices of refraction are at least 1. Maps use one of two sets of texture coordinates.";
    BAD_LIGHT = "VA021", Error, "a light in physical units is not sound",
        "Intensities are not negative, directions are not zero, ranges are above 0, and the angles of a spot light are \
         0 ≤ inner < outer ≤ π/2.";
    NO_LIGHT = "VA022", Warning, "a scene of lit surfaces has no light",
        "Ambient light belongs to the lights too, so without one every surface is black. Add a light, or ask for another \
         `RenderMode`: `normal` and `zbuffer` need none.";
    COLOR_OF_BYTES = "VA023", Warning, "a colour looks like bytes from 0 to 255",
        "Colours are from 0 to 1, and more is brighter than white. A surface of whole numbers above 1, or a light of whole \
         numbers from 100 to 255, was most likely written in bytes. Divide each channel by 255.";
    SHADOW_IN_PATHS = "VA024", Warning, "an object without a shadow stands in a scene of paths",
        "`shadow: false` is followed by `RenderMode: phong`. Paths find light by chance as well as by aim, and an object \
         that stops one of the two would give light twice or never, so there it casts its shadow.";
    LOST_PARTS = "VA026", Warning, "a material says more than the integrator shows",
        "Paths show of Phong's model no height field (`bumpMap`) and no map of `ks`; Phong's model shows of a `standard` material \
         its colour and how rough it is, without its maps, its light and its layers. The hint says which integrator shows them.";
    INVISIBLE = "VA030", Warning, "an object has no size",
        "A radius, or the size of a box or a mesh, is 0, so no ray can hit the object. It is left out of the picture. Some \
         files switch objects off in this way.";
    EYE_INSIDE = "VA031", Warning, "the eye stands inside a solid that hides all else",
        "Every ray starts inside of a solid without glass, and all other objects are outside, so none of them is seen. Move \
         the eye, or the object.";
    TINY_PICTURE = "VA032", Warning, "all objects together are a few pixels of the picture",
        "The length of a camera's `up` is the size of a pixel in the plane through `center`. Many programs take only its \
         direction, and files written for them have an `up` of length 1, which often makes the picture far too wide. Write \
         the length that is meant, or `fov`.";
    LARGE_WEIGHT = "VA033", Warning, "a weight of a material looks like a percentage",
        "The weights `ka`, `kd`, `ks` and `kt` are shares of light, most often from 0 to 1: with a `kd` of 70 a surface is 70 \
         times as bright as white. Divide percentages by 100.";
    OUT_OF_RANGE = "VA101", Error, "a number is outside the range of its key",
        "The message says which values the key takes: counts are not negative and below 2^32, the sides of an image are at \
         most 65535 pixels.";
    NO_CAMERA = "VA102", Error, "the scene has no camera",
        "A scene needs a `Camera` with `eye`, `center`, `up` and `viewSize`. Old files have `Eye: [x, y, z]`, which \
         looks at the square from (0, 0, 0) to (400, 400, 0).";
    TWO_CAMERAS = "VA103", Warning, "the scene has both `Camera` and `Eye`",
        "`Camera` is used and `Eye` is ignored. With `--strict` it is an error.";
    EYE_IS_CENTER = "VA104", Error, "the camera looks at the point where it stands",
        "`eye` and `center` are the same point, so there is no direction to look in.";
    ZERO_UP = "VA105", Error, "the `up` of the camera has no length",
        "The direction of `up` says which way is up in the picture, its length is the size of a pixel in the plane \
         through `center`. A length of 0 says neither.";
    UP_PARALLEL = "VA106", Error, "the `up` of the camera points along the view",
        "When `up` is parallel to the way from `eye` to `center`, no side of the picture is its upper side. The hint \
         proposes the axis that lies least along the view; with `--lenient` that axis is taken, with a warning.";
    FLAT_SOLID = "VA107", Error, "a box, prism or tetrahedron has no volume",
        "One of its sides has no length, or all of its corners lie in one plane. A flat shape is written as a `quad` or \
         a `triangle`.";
    CROSSED_QUAD = "VA108", Warning, "the edges of a quad cross",
        "The four corners of a quad stand in their order around it. In another order, as in the letter Z, two of its \
         edges cross, and the quad is two triangles that meet in a point. Some programs take the corners in any order. The \
         labels show the two corners to exchange; `--lenient` does so.";
    OTHER_UNIT = "VA109", Warning, "an angle looks as if it were in another unit",
        "`fov` and the `angle` of a sphere's texture are in degrees, `rotation` of a box or an asset is in radians. An angle \
         is looked at as written: a `fov` of less than 3.15, a fraction of a degree within a turn of 2π, or radians that \
         are more than a turn and a multiple of 5 are more likely meant in the other unit.";
}
