//! What a user may not do, which a test can show only where this user may not do it.

use libtest_mimic::{Completion, Failed, Trial};

#[cfg(unix)]
pub(crate) fn trials() -> Vec<Trial> {
    vec![Trial::ignorable_test(
        "permissions: a folder that takes nothing is said before the render",
        a_folder_that_takes_nothing_is_said_before_the_render,
    )]
}

#[cfg(unix)]
fn a_folder_that_takes_nothing_is_said_before_the_render() -> Result<Completion, Failed> {
    use std::fs;
    use std::os::unix::fs::PermissionsExt as _;
    use std::process::Command;

    let folder = tempfile::tempdir()?;
    let locked = folder.path().join("locked");
    fs::create_dir(&locked)?;
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555))?;
    if fs::write(locked.join("probe"), "").is_ok() {
        return Ok(Completion::ignored_with("this user may write everywhere"));
    }
    let scene = crate::suite::root("scenes/globe.yaml");
    let refused = Command::new(env!("CARGO_BIN_EXE_rtc"))
        .args(["render", "-o", "locked/x.png"])
        .arg(scene)
        .current_dir(folder.path())
        .output()?;
    assert_eq!(
        String::from_utf8_lossy(&refused.stderr),
        "error: can't write `locked/x.png`: permission denied\n"
    );
    assert_eq!(refused.status.code(), Some(2));
    assert_eq!(locked.read_dir()?.count(), 0);
    Ok(Completion::Completed)
}

#[cfg(not(unix))]
pub(crate) fn trials() -> Vec<Trial> {
    let name = "permissions: a folder that takes nothing is said before the render";
    vec![Trial::ignorable_test(
        name,
        || -> Result<Completion, Failed> {
            Ok(Completion::ignored_with(
                "folders of this system have no modes",
            ))
        },
    )]
}
