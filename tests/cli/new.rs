//! `rtc new`: what it writes is sound and shows something, and it overwrites nothing.

use super::{folder, rtc};

#[test]
fn each_template_checks_without_diagnostics_and_renders() {
    for template in ["course", "path", "gltf", "turntable"] {
        let folder = folder();
        let made = rtc(&folder, &["new", "scene.yaml", "--template", template]);
        assert_eq!(made.status.code(), Some(0), "{template}");
        let checked = rtc(&folder, &["check", "scene.yaml", "-v"]);
        assert_eq!(String::from_utf8_lossy(&checked.stderr), "", "{template}");
        let laid_out = rtc(&folder, &["fmt", "--check", "scene.yaml"]);
        assert_eq!(laid_out.status.code(), Some(0), "{template}");
        let small = ["render", "scene.yaml", "--size", "24x16", "-q"];
        assert_eq!(rtc(&folder, &small).status.code(), Some(0), "{template}");
        let again = rtc(&folder, &["new", "scene.yaml"]);
        assert_eq!(
            again.status.code(),
            Some(2),
            "{template}: nothing is overwritten"
        );
    }
}
