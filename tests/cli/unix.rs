//! What a picture does to files that are there: permissions, links, devices, and what is read-only.

use super::*;
use std::os::unix::fs::{PermissionsExt, symlink};

#[test]
fn a_new_file_is_for_all_and_an_old_one_keeps_its_permissions() {
    let folder = folder();
    let mode = |name: &str| {
        fs::metadata(folder.path().join(name))
            .unwrap()
            .permissions()
            .mode()
            & 0o777
    };
    fs::write(folder.path().join("plain"), "").unwrap();
    fs::write(folder.path().join("old.png"), "").unwrap();
    fs::set_permissions(
        folder.path().join("old.png"),
        fs::Permissions::from_mode(0o640),
    )
    .unwrap();
    for name in ["new.png", "old.png"] {
        assert_eq!(code(&rtc(&folder, &["render", "ball.json", "-o", name])), 0);
    }
    assert_eq!((mode("new.png"), mode("old.png")), (mode("plain"), 0o640));
}

#[test]
fn links_and_devices_stay_what_they_are() {
    let folder = folder();
    fs::write(folder.path().join("real.png"), "").unwrap();
    symlink("real.png", folder.path().join("link.png")).unwrap();
    symlink("/dev/null", folder.path().join("null.png")).unwrap();
    for name in ["link.png", "null.png"] {
        assert_eq!(code(&rtc(&folder, &["render", "ball.json", "-o", name])), 0);
        assert!(
            fs::symlink_metadata(folder.path().join(name))
                .unwrap()
                .is_symlink()
        );
    }
    assert!(
        fs::read(folder.path().join("real.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn what_is_read_only_is_not_replaced() {
    let folder = folder();
    fs::write(folder.path().join("kept.png"), "before").unwrap();
    fs::set_permissions(
        folder.path().join("kept.png"),
        fs::Permissions::from_mode(0o444),
    )
    .unwrap();
    let refused = rtc(&folder, &["render", "ball.json", "-o", "kept.png"]);
    assert_eq!(
        (
            code(&refused),
            fs::read(folder.path().join("kept.png")).unwrap()
        ),
        (2, b"before".to_vec())
    );
}
