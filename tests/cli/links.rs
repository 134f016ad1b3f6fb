//! What links do to results: none is followed that the command line did not name.

use super::*;
use std::os::unix::fs::symlink;

/// A link that is the last part of a path is replaced, wherever it leads, and whether the command
/// line named it or not; one before it is followed.
#[test]
fn a_link_is_replaced_and_what_it_leads_to_stays() {
    let (folder, elsewhere) = (folder(), tempfile::tempdir().unwrap());
    let outside = elsewhere.path().join("own.png");
    fs::write(&outside, "kept").unwrap();
    let path = |name: &str| folder.path().join(name);
    symlink(elsewhere.path(), path("linked")).unwrap();
    for (target, args) in [
        (outside.as_path(), &["-o", "ball.png"][..]),
        (&outside, &[]),
        (Path::new("nothing.png"), &[]),
        (Path::new("ball.png"), &[]),
    ] {
        let _ = fs::remove_file(path("ball.png"));
        symlink(target, path("ball.png")).unwrap();
        let made = rtc(&folder, &[&["render", "ball.json", "-q"], args].concat());
        assert_eq!(code(&made), 0, "{}", stderr(&made));
        assert!(fs::symlink_metadata(path("ball.png")).unwrap().is_file());
        assert!(!path("nothing.png").exists());
    }
    assert_eq!(fs::read(&outside).unwrap(), b"kept");
    let made = rtc(
        &folder,
        &["render", "ball.json", "-q", "-o", "linked/new.png"],
    );
    assert_eq!(code(&made), 0);
    assert!(elsewhere.path().join("new.png").is_file());
}

/// What a result needs beside it goes into no folder that a link stands for.
#[test]
fn files_beside_a_result_go_through_no_link() {
    let (folder, elsewhere) = (folder(), tempfile::tempdir().unwrap());
    symlink(elsewhere.path(), folder.path().join("s.files")).unwrap();
    let before = names(folder.path());
    let refused = rtc(&folder, &["compile", "ball.json", "-o", "s.gltf"]);
    let said = stderr(&refused);
    assert!(
        code(&refused) == 2 && said.contains("its folder is a link"),
        "{said}"
    );
    assert_eq!(names(folder.path()), before);
    assert!(names(elsewhere.path()).is_empty());
}
