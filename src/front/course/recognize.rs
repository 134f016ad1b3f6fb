//! Recognises scene texts by their top-level keys, without parsing them: a text that is broken may
//! be a scene, and a text without mistakes may be the settings of another program.

use super::object::KINDS;
use super::record::HasRecord;
use super::settings::Scene;
use rtc_diag::nearest;

/// The schema that an editor is pointed to, at the end of its address.
const SCHEMA: &str = "scene.schema.json";

/// Shorter keys must be spelt exactly: they resemble too many others.
const SHORTEST_MISSPELT: usize = 5;

/// The maximum number of keys to compare with misspellings: comparisons are slow, and scenes have
/// few top-level keys.
const MOST_MISSPELT: usize = 256;

/// Whether a text looks like a scene of the course: it names the schema of scenes, a top-level key
/// is one that no other program has, or one is a common word of the format or, among the first 256,
/// nearly one, and something below is a thing of a scene. Takes time linear in the length of the
/// text.
#[must_use]
pub fn is_scene_text(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else {
        return false;
    };
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let keys = top_level_keys(text);
    let mut first = keys.iter().take(MOST_MISSPELT);
    let mut known = keys
        .iter()
        .filter(|key| scene_keys().any(|known| known == **key))
        .peekable();
    let may_be = known.peek().is_some() || first.any(|key| is_nearly_scene_key(key));
    text.contains(SCHEMA) || known.any(|key| is_telling(key)) || (may_be && holds_thing(text))
}

/// Whether a key of a scene is no common word, which is at the top of other files, too.
fn is_telling(key: &str) -> bool {
    const THINGS: [&str; 4] = ["Camera", "Eye", "Lights", "Objects"];
    let capitals = key.chars().filter(|c| c.is_uppercase()).count();
    THINGS.contains(&key) || (capitals > 1 && key.len() > 2)
}

/// Whether a text has a key of a camera or a material of a scene, or a type of its objects.
fn holds_thing(text: &str) -> bool {
    const KEYS: [&str; 6] = ["eye", "viewSize", "ka", "kd", "ks", "baseColor"];
    let is_other = |c: char| !(c.is_alphanumeric() || c == '_' || c == '-');
    let (mut rest, mut is_type) = (text, false);
    loop {
        rest = rest.trim_start_matches(is_other);
        let (word, after) = rest.split_at(rest.find(is_other).unwrap_or(rest.len()));
        let is_key = after.trim_start_matches(['"', '\'', ' ']).starts_with(':');
        let is_kind = || KINDS.iter().any(|kind| kind.names.contains(&word));
        if (is_key && KEYS.contains(&word)) || (is_type && is_kind()) {
            return true;
        }
        if word.is_empty() {
            return false;
        }
        (rest, is_type) = (after, is_key && word == "type");
    }
}

/// The top-level keys of a scene, without that of its schema, which other formats have.
fn scene_keys() -> impl Iterator<Item = &'static str> {
    let fields = Scene::RECORD.fields.iter();
    let fields = fields.filter(|field| field.name != "_schema");
    fields.flat_map(|field| field.spellings.iter().copied().flatten().copied())
}

/// Whether a key is nearly one of a scene.
fn is_nearly_scene_key(key: &str) -> bool {
    let is_long = |known: &&str| known.len() >= SHORTEST_MISSPELT;
    is_long(&key) && nearest(key, scene_keys().filter(is_long)).is_some()
}

/// The top-level keys of a text in block or flow style. The text begins with a non-blank character.
fn top_level_keys(text: &str) -> Vec<&str> {
    let content = text.lines().find(|line| {
        let line = line.trim_start();
        !(line.is_empty() || line.starts_with(['#', '%']) || line.starts_with("---"))
    });
    match content {
        Some(line) if line.trim_start().starts_with(['{', '/']) => flow_keys(text),
        _ => text.lines().filter_map(block_key).collect(),
    }
}

/// The key of a line in block style that has no indentation.
fn block_key(line: &str) -> Option<&str> {
    let (key, value) = line.split_once(':')?;
    let is_key = !key.starts_with([' ', '\t', '#', '-', '{', '[']);
    let ends = value.is_empty() || value.starts_with([' ', '\t', '\r']);
    (is_key && ends).then(|| key.trim_end().trim_matches(['"', '\'']))
}

/// The keys in the outermost brackets: the tokens before a colon.
fn flow_keys(text: &str) -> Vec<&str> {
    let (mut keys, mut depth, mut word) = (Vec::new(), 0_usize, None);
    let mut rest = text.char_indices().peekable();
    while let Some((at, letter)) = rest.next() {
        match letter {
            // A comment ends with its line.
            '#' | '/' => while rest.next_if(|(_, next)| *next != '\n').is_some() {},
            '"' | '\'' => {
                let start = at + 1;
                let mut end = start;
                while let Some((at, next)) = rest.next_if(|(_, next)| *next != letter) {
                    end = at + next.len_utf8();
                    // An escaped quote does not end the string.
                    if next == '\\' && letter == '"' {
                        rest.next();
                    }
                }
                rest.next();
                word = text.get(start..end);
            }
            '{' | '[' => {
                depth += 1;
                word = None;
            }
            '}' | ']' => depth = depth.saturating_sub(1),
            ':' if depth == 1 => keys.extend(word.take()),
            _ if letter.is_alphanumeric() => {
                let mut end = at + letter.len_utf8();
                let is_part = |next: char| next.is_alphanumeric() || next == '_' || next == '-';
                while let Some((at, next)) = rest.next_if(|(_, next)| is_part(*next)) {
                    end = at + next.len_utf8();
                }
                word = text.get(at..end);
            }
            _ => {}
        }
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_recognised_by_their_top_level_keys() {
        for text in [
            "Objects: []",
            "---\n# A scene\nLights:\n  - {position: [0, 0, 0]}\n",
            "{\"Eye\": [200, 200, 1000], \"Objects\": []}",
            "// A comment\n{\n  Objects: [ {type: sphere} ]}",
            "Objcts:\n  - type: sphere\n",
            "\u{feff}\"Camera\": {}\n",
            "# yaml-language-server: $schema=../schema/scene.schema.json\nx: 1\n",
            "Objects: [{a: 1}\nLights\n",
            "camera: {eye: [0, 0, 1]}\nobjects: []\n",
            "objects:\n- position: [0, 0, 0]\n  type: 'sphere'\n",
            "{\"Shadows\": true, \"objcts\": [{\"type\": \"triangle\"}]}",
        ] {
            assert!(is_scene_text(text.as_bytes()), "{text}");
        }
    }

    #[test]
    fn spelling_is_compared_for_the_first_keys_alone() {
        let keys = |count: usize| {
            (0..count)
                .map(|k| format!("entry{k}: 0\n"))
                .collect::<String>()
        };
        let is_scene = |text: String| is_scene_text(text.as_bytes());
        let misspelt = "Objcts: [{type: sphere}]\n";
        assert!(is_scene(keys(MOST_MISSPELT - 1) + misspelt));
        assert!(!is_scene(keys(MOST_MISSPELT) + misspelt));
        assert!(is_scene(keys(MOST_MISSPELT) + "Objects: []\n"));
    }

    #[test]
    fn the_settings_of_other_programs_are_no_scenes() {
        for text in [
            "",
            "name: build\non: push\njobs:\n  Objects: {}\n",
            "{\"name\": \"x\", \"dependencies\": {\"Objects\": \"1\"}, \"a\": \"Lights: \\\"\"}",
            "site_name: x\nnav:\n  - Camera: a.md\n",
            "- Objects\n- Lights\n",
            "# Objects: []\nx: y\n",
            "{\"$schema\": \"https://json.schemastore.org/package.json\", \"version\": 1}",
            "\u{0}Objects",
            "light:\n  - platform: mqtt\ncamera:\n  - platform: generic\n",
            "{\"camera\":{\"fov\":3},\"objects\":[]}",
            "{\"metadata\": {\"type\": \"Object\"}, \"object\": {\"type\": \"Scene\", \"camera\": {}}}",
            "apiVersion: v1\nkind: Service\nmetadata:\n  name: a\n",
            "services:\n  web:\n    image: a\nvolumes: {}\n",
            "{\"Logging\": {}, \"Environment\": \"Production\"}",
            "shadow: 1px\nbackground: red\n",
        ] {
            assert!(!is_scene_text(text.as_bytes()), "{text}");
        }
    }
}
