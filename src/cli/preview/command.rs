//! The command that renders the picture of the page: `rtc render` with the arguments of the
//! preview, the view and the settings.

use super::choice::SettingOverrides;
use crate::typed::{quoted, without};
use std::ffi::OsString;

/// The options of the preview that `rtc render` has not: those with a value, and that without.
const OWN: [&str; 2] = ["--port", "--against"];
const OPEN: &str = "--open";

/// The position of the camera, instead of an orbit.
const EYE: &str = "--eye";
const ORBIT: &str = "--orbit";

/// The arguments of the preview as arguments of `rtc render`.
pub(super) struct RenderCommand(Vec<OsString>);

impl RenderCommand {
    /// From the arguments of a preview, program name first.
    pub(super) fn new(typed: &[OsString]) -> Self {
        let kept = without(typed, &OWN).into_iter().skip(1);
        let arguments = ["rtc".to_owned(), "render".to_owned()].into_iter();
        let arguments = arguments.chain(kept.filter(|argument| argument != OPEN));
        Self(arguments.map(OsString::from).collect())
    }

    /// With the flags of a view and of settings, instead of the typed ones.
    pub(super) fn command(&self, view: &[(&str, String)], choice: &SettingOverrides) -> String {
        let view = view
            .iter()
            .map(|(name, value)| (*name, Some(value.clone())));
        let more: Vec<_> = view.chain(choice.flags()).collect();
        let orbit = more.iter().any(|(name, _)| *name == EYE).then_some(ORBIT);
        // `--set` can be repeated, and the last counts.
        let names = more.iter().map(|(name, _)| *name);
        let replaced: Vec<_> = names.filter(|name| *name != "--set").chain(orbit).collect();
        let kept = without(&self.0, &replaced).into_iter();
        let more = more
            .into_iter()
            .flat_map(|(name, value)| [name.to_owned()].into_iter().chain(value));
        let arguments = kept.chain(more).map(|argument| quoted(&argument));
        let arguments: Vec<_> = arguments.collect();
        format!("rtc {}", arguments.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_page_says_stands_in_place_of_what_was_typed() {
        let typed =
            "rtc preview my.yaml --open --orbit 30,20 --depth=3 --port 80 --against HEAD --spp 4";
        let typed: Vec<_> = typed.split(' ').map(OsString::from).collect();
        let arguments = RenderCommand::new(&typed);
        assert_eq!(
            arguments.command(&[], &SettingOverrides::default()),
            "rtc render my.yaml --orbit 30,20 --depth=3 --spp 4"
        );
        let choice =
            SettingOverrides::read(br#"{"values": {"depth": 1}, "integrator": null}"#).unwrap();
        let view = [("--eye", "1,2,3".to_owned())];
        assert_eq!(
            arguments.command(&view, &choice),
            "rtc render my.yaml --spp 4 --eye 1,2,3 --depth 1"
        );
        let choice = SettingOverrides::read(
            br#"{"values": {"denoise": 1, "depth": 1}, "integrator": null}"#,
        );
        assert_eq!(
            arguments.command(&[], &choice.unwrap()),
            "rtc render my.yaml --orbit 30,20 --spp 4 --denoise --depth 1"
        );
    }
}
