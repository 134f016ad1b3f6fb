//! Many scenes in one call: which files are meant, where their pictures go, and what fails.

use super::*;

/// Scenes in folders, some of them hidden, and what is none.
fn shelf() -> TempDir {
    let shelf = folder();
    let path = |name: &str| shelf.path().join(name);
    for folder in ["set/deep", "set/.hidden", "empty"] {
        fs::create_dir_all(path(folder)).unwrap();
    }
    let small = SCENE.replace("[40, 30]", "[4, 3]");
    for name in [
        "b.json",
        "a.json",
        "deep/c.json",
        ".d.json",
        ".hidden/e.json",
        "notes.txt",
    ] {
        fs::write(path("set").join(name), &small).unwrap();
    }
    shelf
}

/// The files of which something is told, in this order.
fn reported(output: &Output) -> Vec<String> {
    let text = stderr(output);
    let names = text.lines().filter_map(|line| line.split_once(": 4×3, "));
    names.map(|(name, _)| name.to_owned()).collect()
}

#[test]
fn a_folder_is_all_its_scenes_in_order() {
    let shelf = shelf();
    let made = rtc(&shelf, &["render", "set", "-o", "out/"]);
    assert_eq!(code(&made), 0, "{}", stderr(&made));
    assert_eq!(reported(&made), ["out/a.png", "out/b.png", "out/c.png"]);
    assert_eq!(
        names(&shelf.path().join("out")),
        ["a.png", "b.png", "c.png"]
    );
    let one = rtc(&shelf, &["render", "set/b.json", "-o", "-"]);
    let many = fs::read(shelf.path().join("out/b.png")).unwrap();
    assert_eq!(many, one.stdout, "the bytes are those of one call");
    for folder in ["empty", "set/.hidden/none", "set/*.glb", "set/["] {
        let none = rtc(&shelf, &["check", folder]);
        assert_eq!(code(&none), 2, "{folder}");
    }
}

#[test]
fn a_pattern_is_what_fits_it_but_for_what_is_hidden() {
    let shelf = shelf();
    let made = rtc(&shelf, &["render", "set/*.json", "-o", "set/{stem}-4.png"]);
    assert_eq!(reported(&made), ["set/a-4.png", "set/b-4.png"]);
    fs::write(
        shelf.path().join("[x].json"),
        SCENE.replace("[40, 30]", "[4, 3]"),
    )
    .unwrap();
    let one = rtc(&shelf, &["render", "[x].json"]);
    assert_eq!(reported(&one), ["[x].png"], "a file of that name is meant");
}

/// Neither round in circles nor out of the folder.
#[cfg(unix)]
#[test]
fn no_walk_follows_links() {
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::symlink;
    let (shelf, elsewhere) = (shelf(), tempfile::tempdir().unwrap());
    fs::write(elsewhere.path().join("secret.json"), "Lights: hunter2").unwrap();
    let path = |name: &str| shelf.path().join("set").join(name);
    for name in ["l1", "l2", "deep/up"] {
        symlink(".", path(name)).unwrap();
    }
    symlink(elsewhere.path().join("secret.json"), path("x.json")).unwrap();
    symlink(elsewhere.path(), path("away")).unwrap();
    let odd = std::ffi::OsStr::from_bytes(b"\xff.json");
    fs::write(path("deep").join(odd), SCENE.replace("[40, 30]", "[4, 3]")).unwrap();
    for (suggestion, count) in [
        ("set", 4),
        ("set/**/*.json", 4),
        ("set/*", 5),
        ("set/*.json", 2),
        ("s?t/*/*.json", 2),
        ("*/[a-b].json", 2),
        ("./set/*.json", 2),
    ] {
        let checked = rtc(&shelf, &["check", suggestion, "--message-format", "json"]);
        let said = stderr(&checked) + &String::from_utf8_lossy(&checked.stdout);
        assert!(!said.contains("hunter2"), "{suggestion}: {said}");
        let made = rtc(&shelf, &["render", suggestion, "-o", "out/"]);
        assert_eq!(
            (code(&made), reported(&made).len()),
            (0, count),
            "{suggestion}"
        );
    }
    for suggestion in ["set/x.*", "set/l?/a.json", "set/away/*"] {
        let expected = if suggestion.ends_with("away/*") { 1 } else { 2 };
        assert_eq!(
            code(&rtc(&shelf, &["check", suggestion])),
            expected,
            "{suggestion}"
        );
    }
    // What is named is followed.
    assert_eq!(code(&rtc(&shelf, &["check", "set/l1/a.json"])), 0);
}

#[test]
fn a_failure_is_told_and_the_rest_goes_on() {
    let shelf = shelf();
    fs::create_dir(shelf.path().join("a.png")).unwrap();
    let args = [
        "render",
        "bad.json",
        "none.json",
        "set/a.json",
        "set/b.json",
    ];
    let made = rtc(&shelf, &args);
    assert_eq!(
        (code(&made), reported(&made)),
        (1, vec!["b.png".to_owned()])
    );
    let said = stderr(&made);
    assert!(
        said.contains("error: `set/a.json`: can't write `a.png`")
            && said.ends_with("error: 3 of 4 scenes have no picture\n"),
        "{said}"
    );
    let checked = rtc(&shelf, &["check", "bad.json", "set"]);
    assert_eq!(code(&checked), 1);
}

#[test]
fn a_folder_made_in_vain_goes_again() {
    let shelf = shelf();
    let made = rtc(&shelf, &["render", "bad.json", "-o", "out/"]);
    assert_eq!(code(&made), 1);
    assert!(!names(shelf.path()).contains(&"out".to_owned()));
}

#[test]
fn what_can_not_be_meant_is_told_before_anything_is_rendered() {
    let shelf = shelf();
    fs::write(shelf.path().join("set/deep/a.json"), SCENE).unwrap();
    let before = names(shelf.path());
    let cases = [
        (
            &["set", "-o", "x-{stem}.png"][..],
            "error: `x-a.png` would be the picture of both `set/a.json` and `set/deep/a.json`; \
             `-o '{dir}/{stem}.png'` names the folder of each\n",
        ),
        (
            &["ball.json", "away.json", "-o", "x.png"],
            "error: `x.png` is one picture, and there are 2 scenes; give `-o FOLDER/` or \
             `-o '{stem}.png'`\n",
        ),
        (&["ball.json", "away.json", "-o", "-"], "error: `-` is one"),
        (
            &["ball.json", "-o", "{stem}.tiff"],
            "error: unknown picture format `ball.tiff`",
        ),
        (
            &["ball.json", "away.json", "--part", "1/2"],
            "error: `--part`",
        ),
        (
            &["ball.json", "-o", "no/such/"],
            "error: can't make `no/such`",
        ),
    ];
    for (args, words) in cases {
        let refused = rtc(&shelf, &[&["render"], args].concat());
        let said = stderr(&refused);
        assert_eq!(code(&refused), 2, "{args:?}: {said}");
        assert!(said.starts_with(words), "{args:?}: {said}");
    }
    assert_eq!(names(shelf.path()), before);
}

/// Pictures of one name lie in folders as their scenes do.
#[test]
fn scenes_of_one_name_have_a_picture_each() {
    let shelf = shelf();
    let path = |name: &str| shelf.path().join(name);
    fs::create_dir_all(path("class/anna/one")).unwrap();
    fs::create_dir_all(path("class/ben")).unwrap();
    for name in ["class/anna/one/a.json", "class/ben/a.json", "class/b.json"] {
        fs::copy(path("set/a.json"), path(name)).unwrap();
    }
    for (args, expected) in [
        (
            &["class", "-o", "out/"][..],
            ["out/anna/one/a.png", "out/b.png", "out/ben/a.png"],
        ),
        (&["class"], ["anna/one/a.png", "b.png", "ben/a.png"]),
        (
            &["class/**/*.json", "-o", "p/{dir}-{stem}.png"],
            ["p/anna/one-a.png", "p/.-b.png", "p/ben-a.png"],
        ),
        (
            &[
                "class/anna/one/a.json",
                "class/b.json",
                "class/ben/a.json",
                "-o",
                "n/",
            ],
            [
                "n/class/anna/one/a.png",
                "n/class/b.png",
                "n/class/ben/a.png",
            ],
        ),
    ] {
        let made = rtc(&shelf, &[&["render"], args].concat());
        let mut told = reported(&made);
        assert_eq!(code(&made), 0, "{args:?}: {}", stderr(&made));
        let mut expected = expected.map(str::to_owned);
        told.sort();
        expected.sort();
        assert_eq!(told, expected, "{args:?}");
        assert!(expected.iter().all(|name| path(name).exists()), "{args:?}");
    }
    // Folders that hold no picture go again.
    fs::write(path("class/ben/a.json"), "Objects: [{}]").unwrap();
    assert_eq!(code(&rtc(&shelf, &["render", "class", "-o", "new/"])), 1);
    assert!(path("new/anna/one/a.png").exists() && !path("new/ben").exists());
}

#[test]
fn what_git_ignores_and_a_project_excludes_is_not_found() {
    let shelf = shelf();
    let path = |name: &str| shelf.path().join(name);
    let found = |args: &[&str]| {
        let made = rtc(&shelf, &[&["render"], args, &["-o", "out/"]].concat());
        let names = reported(&made).into_iter();
        names
            .map(|name| name.replace("out/", ""))
            .collect::<Vec<_>>()
    };
    assert_eq!(found(&["set"]), ["a.png", "b.png", "c.png"]);
    fs::write(path("set/.gitignore"), "a.*\n").unwrap();
    assert_eq!(found(&["set"]), ["b.png", "c.png"]);
    assert_eq!(found(&["set/*.json"]), ["b.png"]);
    // What is named is meant.
    assert_eq!(found(&["set/a.json"]), ["a.png"]);
    // Above the folder, up to the root of the repository.
    fs::write(path(".gitignore"), "deep/\nb.json\n").unwrap();
    assert_eq!(
        found(&["set"]),
        ["b.png", "c.png"],
        "there is no repository"
    );
    fs::create_dir(path(".git")).unwrap();
    fs::write(path("set/b.yaml"), "x: 1").unwrap();
    assert_eq!(found(&["set"]), Vec::<String>::new());
    fs::write(path("set/.gitignore"), "!b.json").unwrap();
    assert_eq!(found(&["set"]), ["a.png", "b.png"]);
    assert_eq!(found(&["set/deep"]), ["c.png"], "the folder is named");
    fs::write(path("rtc.toml"), "exclude = [\"set/b*\"]").unwrap();
    assert_eq!(
        found(&["set"]),
        ["a.png", "b.png"],
        "the inner list comes first"
    );
    fs::write(path("set/.gitignore"), "").unwrap();
    fs::write(path(".gitignore"), "").unwrap();
    assert_eq!(found(&["set"]), ["a.png", "c.png"]);
    fs::write(path("rtc.toml"), "exclude = \"set\"").unwrap();
    let told = stderr(&rtc(&shelf, &["check", "set"]));
    assert!(told.contains("`exclude` is a list of patterns"), "{told}");
}

#[test]
fn one_log_holds_the_findings_of_all() {
    let shelf = shelf();
    let args = [
        "bad.json",
        "set/a.json",
        "none.json",
        "--message-format",
        "sarif",
        "-q",
    ];
    let made = rtc(&shelf, &[&["render"], &args[..]].concat());
    let said = stderr(&made);
    let log = said.strip_suffix("error: 2 of 3 scenes have no picture\n");
    let log: serde_json::Value = serde_json::from_str(log.unwrap()).unwrap();
    let results = log["runs"][0]["results"].as_array().unwrap();
    assert_eq!((code(&made), results.len()), (1, 2), "{said}");
}

#[test]
#[cfg(unix)]
fn one_interrupt_ends_all() {
    let shelf = shelf();
    let slow = ["--size", "2000x1500", "--supersampling", "16"];
    let args = [&["render", "set", "-o", "out/"], &slow[..]].concat();
    let mut child = command(shelf.path(), &args).spawn().unwrap();
    outputs::until_it_listens(&mut child);
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(killed.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!names(shelf.path()).contains(&"out".to_owned()));
}

#[test]
fn a_contact_sheet_shows_what_this_call_made() {
    let shelf = shelf();
    fs::write(
        shelf.path().join("set/b.json"),
        SCENE.replace("\"radius\": 10", "\"radius\": -10"),
    )
    .unwrap();
    fs::create_dir(shelf.path().join("out")).unwrap();
    image::RgbImage::from_pixel(4, 3, image::Rgb([0, 255, 0]))
        .save(shelf.path().join("out/b.png"))
        .unwrap();
    let made = rtc(
        &shelf,
        &[
            "render",
            "set",
            "-q",
            "-o",
            "out/",
            "--contact-sheet",
            "all.png",
        ],
    );
    assert_eq!(code(&made), 1, "{}", stderr(&made));
    let sheet = image::open(shelf.path().join("all.png")).unwrap().to_rgb8();
    assert_eq!(sheet.dimensions(), (3 * 168 + 8, 152 + 8));
    // Each picture is in the middle of its cell.
    let middle = |cell: u32| sheet.get_pixel(cell * 168 + 8 + 80, 8 + 60).0;
    assert!(
        middle(0)[0] > 100 && middle(0)[1] < 100,
        "the red ball: {:?}",
        middle(0)
    );
    assert_eq!(middle(1), [63; 3], "a scene with an error has no picture");
    assert_eq!(middle(2), middle(0));
    for (sheet, words) in [
        ("out/a.png", "would be the contact sheet and another file"),
        ("all.exr", "is a PNG"),
    ] {
        let refused = rtc(
            &shelf,
            &["render", "set", "-o", "out/", "--contact-sheet", sheet],
        );
        assert!(
            code(&refused) == 2 && stderr(&refused).contains(words),
            "{}",
            stderr(&refused)
        );
    }
    let one = rtc(
        &shelf,
        &["render", "set/a.json", "--contact-sheet", "all.png"],
    );
    assert!(code(&one) == 2 && stderr(&one).contains("is for many scenes"));
}

/// A repository with one scene, one broken scene, and files of other programs.
fn repository() -> TempDir {
    let repository = folder();
    let write = |name: &str, text: &str| fs::write(repository.path().join(name), text).unwrap();
    write("scene.json", SCENE);
    write("broken.yaml", "Objects:\n  - {type: sphere\nLights: []\n");
    write("package.json", "{\"name\": \"x\", \"version\": \"1.0.0\"}");
    write(
        "mkdocs.yml",
        "site_name:    x\nnav:\n    - Objects:   a.md\n",
    );
    write("pom.xml", "<project><scene/></project>");
    write(
        "home.yaml",
        "light:\n  - platform: mqtt\ncamera:\n  - platform: generic\n",
    );
    write("three.json", "{\"camera\":{\"fov\":3},\"objects\":[]}");
    repository
}

#[test]
fn the_files_of_other_programs_are_no_scenes_in_folders_and_patterns() {
    let repository = repository();
    let checked = rtc(&repository, &["check", "."]);
    assert_eq!(code(&checked), 1, "{}", stderr(&checked));
    let text = stderr(&checked);
    assert!(text.contains("broken.yaml"), "{text}");
    assert!(
        text.contains("5 files skipped that are no scenes"),
        "{text}"
    );
    for other in [
        "package.json",
        "mkdocs.yml",
        "pom.xml",
        "home.yaml",
        "three.json",
    ] {
        assert!(!text.contains(other), "{text}");
        let named = rtc(&repository, &["check", other]);
        assert_eq!(code(&named), 1, "a named file is a scene: {other}");
        let skipped = rtc(&repository, &["check", "--skip-others", other]);
        assert_eq!(code(&skipped), 0, "{}", stderr(&skipped));
    }
    let none = rtc(&repository, &["check", "*.yml"]);
    assert_eq!(code(&none), 2, "{}", stderr(&none));
}

#[test]
fn fmt_leaves_the_yaml_of_other_programs_as_it_is() {
    let repository = repository();
    let path = repository.path().join("mkdocs.yml");
    let before = fs::read_to_string(&path).unwrap();
    let laid_out = rtc(&repository, &["fmt", "mkdocs.yml"]);
    assert_eq!(code(&laid_out), 0, "{}", stderr(&laid_out));
    assert!(stderr(&laid_out).contains("no key of a scene"));
    assert_eq!(fs::read_to_string(&path).unwrap(), before);
    // A text of several documents is reported, and stays.
    let two = format!("{SCENE}\n---\n{SCENE}");
    fs::write(&path, &two).unwrap();
    let refused = rtc(&repository, &["fmt", "mkdocs.yml"]);
    assert_eq!(code(&refused), 1);
    assert_eq!(fs::read_to_string(&path).unwrap(), two);
}

#[test]
fn a_table_has_a_row_for_each_scene_and_a_total() {
    let folder = folder();
    let output = rtc(&folder, &["check", ".", "--table", "csv"]);
    let table = String::from_utf8(output.stdout.clone()).unwrap();
    assert_eq!(code(&output), 1, "one of them has an error: {table}");
    let lines: Vec<_> = table.lines().collect();
    assert_eq!(lines[0], "file,errors,warnings,notes");
    assert!(lines[1].starts_with("./away.json,0,"), "{table}");
    assert!(lines[2].starts_with("./bad.json,1,"), "{table}");
    assert!(lines[3].starts_with("./ball.json,0,0,"), "{table}");
    assert!(
        lines[4].starts_with("3 files,1,") && lines.len() == 5,
        "{table}"
    );
    assert!(stderr(&output).contains("error["), "the findings, too");
    let output = rtc(&folder, &["check", ".", "--table", "json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["files"][1]["errors"], 1);
    assert_eq!(
        (&value["total"]["files"], &value["total"]["errors"]),
        (&3.into(), &1.into())
    );
}
