//! Images, meshes and scenes that are small and ask for much.

use super::prison::{folder, run};

#[test]
#[cfg_attr(not(target_os = "linux"), ignore = "only Linux limits addresses")]
fn a_sound_scene_is_rendered_within_the_limits() {
    let scene =
        b"Eye: [200, 200, 1000]\nObjects:\n- {type: sphere, position: [200, 200, 0], radius: 100, material: {color: \
                  [1, 1, 1], ka: 1, kd: 1, ks: 0, n: 1}}\n";
    let folder = folder(&[("s.yaml", scene)]);
    let outcome = run(folder.path(), &["render", "s.yaml", "-o", "s.png", "--threads", "2"]);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(!outcome.is_refused("IO003"));
}
