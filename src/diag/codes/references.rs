//! `RE`: files that a scene names, and what is in them.

super::codes! { RE:
    FILE_NOT_FOUND = "RE001", Error, "a file named by the scene can't be found",
        "Textures and meshes are looked for beside the scene file, in the folder given by `--asset-root`, and in the \
         folder above the scene's, unless that is a home, `/`, a folder in `/`, or one of the system. If they are at none of these places, the last components of the name alone are looked \
         for there, and last a name that differs in upper and lower case only. With `--lenient` the texture falls back \
         to the colour, or the object is left out, with a warning.";
    FILE_OUTSIDE = "RE002", Error, "a file named by the scene lies where scenes may not read",
        "A scene may come from anywhere, so it may not read any file: only those below its own folder and the folder given \
         by `--asset-root`, and in the folder above its own those that are what it asks for: their extension and first \
         bytes are of a picture, a mesh or an asset, and nothing of their path there is hidden. A path from the root, from a Windows drive or \
         through `..`, and a link that leads out, are not followed; only a file of that name inside is taken. Put the \
         file beside the scene, or allow its folder by `--asset-root`.";
    FILE_ELSEWHERE = "RE003", Note, "a file was found under another name than the scene gives",
        "The path leads to another machine or folder, or has another case or white space at its end, but a file of that \
         name is beside the scene or in the folder above. The note says which was taken.";
    BAD_PICTURE = "RE004", Error, "a texture can't be read as a picture",
        "Pictures are PNG, JPEG or WebP, those of an environment Radiance HDR or OpenEXR with finite values; they are \
         recognised by their content and not by their name. A damaged file shows itself \
         by the words of its decoder. With `--lenient` the texture falls back to the colour, with a warning.";
    HUGE_PICTURE = "RE005", Error, "a texture has too many pixels",
        "A small file can ask for much memory, so the size is looked at before a texture is decoded: at most 16384 × \
         16384 pixels, unless `--limit pixels=…` allows more. Scale the picture down.";
    BAD_MESH_FILE = "RE006", Error, "a mesh file is faulty",
        "Meshes are Wavefront OBJ, OFF, STL or PLY, or points as XYZ; of another file nothing is shown. The label is at the first place that \
         can't be: a number that is missing or not finite, or, where no face is left, a corner that refers to a vertex that is not there or a face of fewer than three corners. Export the mesh \
         again. With `--lenient` the object is left out, with a warning.";
    NOT_DRAWN = "RE007", Warning, "a mesh file holds elements that don't show",
        "A face with a corner that is not there, or with fewer than three, is left out; free-form curves and surfaces are not \
         supported, nor colours of faces beside those of vertices, and colours show in traced paths alone. The message says why the first does not show.";
    NORMALS_AS_BUMP = "RE008", Note, "a bump map holds normals and is used as a normal map",
        "A bump map is grey, its brightness the height of the surface. This one is coloured as normal maps are: blue \
         along the normal, red and green across. It is used as one; `normalMap` says so from the start.";
    BAD_PHOTOMETRY = "RE009", Error, "the profile of a lamp is faulty",
        "Profiles are LM-63 files (`.ies`) of type C with `TILT=NONE`: after that line stand the counts of angles, the \
         angles in ascending order, and the candelas, none of them negative. The label is at the first place that can't \
         be. With `--lenient` the light is dark, with a warning.";
    BAD_MTL = "RE010", Warning, "the materials of a mesh are not all as its MTL says",
        "A mesh that has no material of its own, or `materials: mtl`, takes those that its OBJ names. Here the MTL file is \
         not beside it, a statement in it can't be read or shows nothing, or it has no material that faces ask for. The mesh \
         stays; the message says what is missing. Phong's model shows the colours and maps of Wavefront's own statements, traced \
         paths also light (`Ke`), the physical ones (`Pr`, `Pm`, `Ps`, `Pc`, `aniso`), `map_d`, `Tf` of what refracts, and where maps lie.";
    MTL_UNUSED = "RE011", Note, "the materials of a mesh file are not used",
        "The scene gives the mesh a material, and that counts. With `materials: mtl` those of the MTL do that the OBJ names.";
}
