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
    SETTINGS_WRONG = "IO004", Error, "an `rtc.toml` says what can't be done",
        "The `rtc.toml` nearest above a scene holds for it where the command line says nothing else: `[levels]` of findings, \
         `[limits]` on what a run may take, the `asset-root`, and how pictures are made, in `[render]`. \
         What is wrong in it is told as if it were in the scene.";
    SETTINGS_UNKNOWN = "IO005", Warning, "an `rtc.toml` has a key that means nothing",
        "The key is ignored. At the top there are `asset-root`, `levels`, `limits` and `render`; the keys of `limits` are those \
         of `rtc schema limits`, those of `render` are named as the flags of `rtc render`.";
    SETTINGS_READ = "IO006", Note, "settings came from an `rtc.toml`",
        "It lies in the folder of the scene, or is the nearest above it; the search ends where a repository does, at a folder with \
         a `.git`. What the command line says goes before it.";
    SETTINGS_UNTRUSTED = "IO007", Warning, "an `rtc.toml` asks for more than one that is not trusted may have",
        "Whoever wrote a scene may have written the `rtc.toml` beside it. So it may lower limits and not raise them, and its \
         `asset-root` lies in the folder of the scene or below. Not read at all is one of another user, one that all may write, \
         and a link that leaves its folder. `--trust-project` trusts it for one run; `trusted-projects = [\"/a/folder\"]` in the user's \
         own `rtc/config.toml` (in `$XDG_CONFIG_HOME` or `~/.config`) trusts those in that folder and below.";
}
