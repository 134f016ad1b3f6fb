//! `RE`: files that a scene names, and their contents.

super::codes! { RE:
    FILE_NOT_FOUND = "RE001", Error, "a file of the scene does not exist";
    FILE_OUTSIDE = "RE002", Error, "a file of the scene is in a folder that scenes may not read";
    FILE_ELSEWHERE = "RE003", Note, "a file is found under another name";
    BAD_PICTURE = "RE004", Error, "a texture is not a readable picture";
    HUGE_PICTURE = "RE005", Error, "a texture has too many pixels";
    BAD_MESH_FILE = "RE006", Error, "a mesh file has a mistake";
    NOT_DRAWN = "RE007", Warning, "a mesh file has elements that the picture does not show";
    NORMALS_AS_BUMP = "RE008", Note, "a bump map is used as a normal map";
    BAD_PHOTOMETRY = "RE009", Error, "the profile of a lamp has a mistake";
    BAD_MTL = "RE010", Warning, "the materials of a mesh differ from its MTL file";
    MTL_UNUSED = "RE011", Note, "the materials of a mesh file are not used";
}
