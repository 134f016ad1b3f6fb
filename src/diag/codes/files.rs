//! `IO`: files that can't be read or written.

super::codes! { IO:
    CANNOT_READ = "IO001", Error, "a file can't be read",
        "The system refused to open or read the file; the message carries its reason. \
         Check the spelling of the path and the rights of the file.";
    TOO_LARGE = "IO002", Error, "a file is too large",
        "Scene files are read whole, up to 1 GiB. A larger text is most often the wrong file.";
    OVER_LIMIT = "IO003", Error, "a run would take more of the machine than its limit",
        "A small file can ask for much: a picture of many pixels, a mesh placed a million times, data that unpacks to \
         a thousand times its size. So what files become is charged to a budget before memory is taken, one for all \
         files of a run, and most limits grow with the bytes read. `rtc schema limits` lists them; `--limit` sets one, \
         `--allow-huge` lifts all.";
}
