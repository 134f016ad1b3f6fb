//! `IO`: files that can't be read or written.

super::codes! { IO:
    CANNOT_READ = "IO001", Error, "a file can't be read",
        "The system refused to open or read the file; the message carries its reason. \
         Check the spelling of the path and the rights of the file.";
    TOO_LARGE = "IO002", Error, "a file is too large",
        "Scene files are read whole, up to 1 GiB. A larger text is most often the wrong file.";
}
