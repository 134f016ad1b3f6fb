//! The tables of Mitsuba.

use super::{ForeignFormat, assert_proposed, findings, texts};
use crate::mitsuba::plugins::{ELEMENTS, Element, NONE, find, kind};
use crate::plugin::{DeclaredParameter, Plugin};
use std::fs;
use std::ops::Range;
use std::path::Path;

/// A parameter as an element of a type.
fn written(parameter: &DeclaredParameter, kind: &str) -> String {
    let name = parameter.name;
    let value = match (kind, name) {
        ("boolean", _) => "true",
        ("string", "filename") => "a.ply",
        ("string", "name") => "vertex_color",
        ("string", _) => "50mm",
        ("rgb", _) => "0.1, 0.2, 0.3",
        ("spectrum", _) => "400:0.1, 700:0.2",
        ("point" | "vector", _) => "0, 0, 1",
        _ => "2",
    };
    match kind {
        "transform" => format!("<transform name=\"{name}\"><scale value=\"2\"/></transform>"),
        "texture" => format!("<texture name=\"{name}\" type=\"checkerboard\"/>"),
        "medium" => format!("<medium name=\"{name}\" type=\"homogeneous\"/>"),
        "volume" => format!("<volume name=\"{name}\" type=\"constvolume\"/>"),
        _ => format!("<{kind} name=\"{name}\" value=\"{value}\"/>"),
    }
}

/// A scene with a plugin and a text in it.
fn scene(element: &Element, plugin: &Plugin, inside: &str) -> String {
    let (tag, name) = (element.name, plugin.name);
    let role = match tag {
        "texture" => "name=\"reflectance\"",
        "medium" => "name=\"interior\"",
        "volume" => "name=\"albedo\"",
        _ => "",
    };
    let two = match tag {
        "bsdf" => "<bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/>",
        _ => "",
    };
    let group = match name {
        "instance" => "<ref id=\"group\"/>",
        _ => "",
    };
    let own = format!("<{tag} type=\"{name}\" {role}>{inside}{two}{group}</{tag}>");
    let outer: &[&str] = match tag {
        "bsdf" | "medium" => &["shape type=\"sphere\""],
        "emitter" if name == "area" => &["shape type=\"sphere\""],
        "texture" => &["shape type=\"rectangle\"", "bsdf type=\"diffuse\""],
        "film" | "sampler" => &["sensor type=\"perspective\""],
        "rfilter" => &["sensor type=\"perspective\"", "film type=\"hdrfilm\""],
        "phase" | "volume" => &[
            "shape type=\"sphere\"",
            "medium type=\"homogeneous\" name=\"interior\"",
        ],
        _ => &[],
    };
    let placed = outer.iter().rev().fold(own, |own, outer| {
        let name = outer.split(' ').next().unwrap();
        format!("<{outer}>{own}</{name}>")
    });
    let group = "<shape type=\"shapegroup\" id=\"group\"><shape type=\"cube\"/></shape>";
    format!("<scene version=\"3.0.0\">{group}{placed}</scene>")
}

#[test]
fn the_tables_of_mitsuba_are_what_its_reader_reads() {
    let mut faults = String::new();
    for element in ELEMENTS {
        for plugin in element.kind.iter().flat_map(|kind| kind.plugins) {
            // All parameters, by the first type of each, by the second, and so on.
            for index in 0..4 {
                let inside = plugin.parameters().filter_map(|parameter| {
                    let kind = parameter.types().cycle().nth(index)?;
                    Some(written(parameter, kind))
                });
                let text = scene(element, plugin, &inside.collect::<String>());
                let found = findings(ForeignFormat::Mitsuba, &text);
                let faulty = ["is not supported", "has no effect", "not a value of"];
                if faulty.iter().any(|fault| found.contains(fault)) {
                    faults += &format!("{} {}: {found}\n", element.name, plugin.name);
                }
            }
        }
    }
    assert_eq!(faults, "");
}

/// The names that the source of the reader looks up, and all strings in it.
fn read_by_the_source() -> (Vec<String>, Vec<String>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("mitsuba");
    let (mut names, mut strings) = (Vec::new(), Vec::new());
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let file = path.file_stem().unwrap().to_str().unwrap();
        if ["plugins", "completion", "xml", "value"].contains(&file) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let mut before = "";
        for (at, piece) in text.split('"').enumerate() {
            let calls = [
                "number(",
                "count(",
                "flag(",
                "string(",
                "vector(",
                "color(",
                "transform(",
                "get(",
                "child(",
                "channel(node, ",
                "map(node, ",
                "map_named(node, ",
            ];
            if at % 2 == 1 {
                strings.push(piece.to_owned());
                let is_name = calls
                    .iter()
                    .any(|call| before.trim_end_matches("self.").ends_with(call));
                names.extend(is_name.then(|| piece.to_owned()));
            }
            before = piece;
        }
    }
    (names, strings)
}

#[test]
fn the_reader_of_mitsuba_and_its_tables_have_the_same_names() {
    let (names, strings) = read_by_the_source();
    let kinds = || ELEMENTS.iter().filter_map(|element| element.kind);
    let parameters: Vec<_> = kinds().flat_map(|kind| kind.parameters()).collect();
    let is_declared = |name: &str| parameters.iter().any(|known| known.name == name);
    let unknown = names
        .iter()
        .filter(|name| !name.is_empty() && !is_declared(name));
    let unknown: Vec<_> = unknown.collect();
    assert!(names.len() > 80, "{names:?}");
    assert_eq!(unknown, [""; 0], "is read, and in no table");
    let is_read = |name: &str| strings.iter().any(|own| own == name);
    let has_effect = parameters
        .iter()
        .filter(|known| known.proposal(String::new()).about != NONE);
    let unread: Vec<_> = has_effect
        .map(|known| known.name)
        .filter(|name| !is_read(name))
        .collect();
    assert_eq!(unread, [""; 0], "is in a table, and not read");
}

/// The bytes of a word, and the text proposed there.
type PlacedWord = (Range<usize>, String);

/// The elements, plugins and parameters of a scene: their bytes and the text proposed there.
fn words(text: &str) -> Vec<PlacedWord> {
    let mut words = Vec::new();
    let Ok(document) = roxmltree::Document::parse(text) else {
        return words;
    };
    traverse(document.root_element(), None, &mut words);
    words
}

/// Adds the words of an element and of those in it, within a plugin.
fn traverse(
    node: roxmltree::Node<'_, '_>,
    parent: Option<&'static Plugin>,
    words: &mut Vec<PlacedWord>,
) {
    let name = node.tag_name().name();
    let start = node.range().start + 1;
    words.extend(find(name).map(|own| (start..start + name.len(), own.name.to_owned())));
    let value = |attribute| node.attribute_node(attribute);
    let plugin = value("type").and_then(|kind_| kind(name)?.find(kind_.value()));
    words.extend(
        plugin.map(|plugin| (value("type").unwrap().range_value(), plugin.name.to_owned())),
    );
    let role = value("name").filter(|own| {
        parent.is_some_and(|plugin| {
            let mut known = plugin.parameters();
            known.any(|known| {
                super::plain(known.name) == super::plain(own.value())
                    && known.types().any(|kind| kind == name)
            })
        })
    });
    words.extend(role.map(|own| (own.range_value(), own.value().to_owned())));
    for child in node.children().filter(|child| child.is_element()) {
        traverse(child, plugin, words);
    }
}

#[test]
fn what_stands_in_a_scene_of_mitsuba_is_proposed_there() {
    let mut count = 0;
    for text in texts(ForeignFormat::Mitsuba, "xml") {
        for (range, word) in words(&text) {
            count += 1;
            assert_proposed(ForeignFormat::Mitsuba, &text, range, &word);
        }
    }
    assert!(count > 500, "{count}");
}

#[test]
fn a_scene_of_mitsuba_is_completed_while_it_is_typed() {
    let scene =
        "<scene version=\"3.0.0\"><!-- <bsdf id=\"no\"> --><bsdf type=\"diffuse\" id=\"red\"/>";
    let cases = [
        ("<!-- a --><!-- <", ""),
        ("<!-- a --><!-- <x> --><", "integrator"),
        ("<shape type=\"sphere\"><", "point"),
        ("<shape type=\"sphere\">\n<flo", "float"),
        ("<shape type=\"sph", "sphere"),
        ("<shape type='sph", "sphere"),
        ("<shape type=\"sphere\"><float name=\"", "radius"),
        ("<shape type=\"sphere\"\n<float name=\"", "radius"),
        ("<shape type=\"sphere\"><ref id=\"", "red"),
        ("<shape type=\"sphere\"><ref name=\"", "interior"),
        (
            "<shape type=\"sphere\"><transform name=\"to_world\"><",
            "lookat",
        ),
        (
            "<shape type=\"cube\"><boolean name=\"flip_normals\" value=\"",
            "true",
        ),
        (
            "<bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"",
            "reflectance",
        ),
        ("<bsdf type=\"diffuse\"></", "bsdf"),
        ("<shape type=\"sphere\"><float name=\" value=\"2\"/>", ""),
    ];
    for (end, expected) in cases {
        let text = format!("{scene}{end}");
        let found = ForeignFormat::Mitsuba.completion(&text, text.len());
        let proposals = found
            .as_ref()
            .map_or(&[][..], |found| found.proposals.as_slice());
        let is_there = proposals.iter().any(|own| own.text == expected);
        assert!(is_there || expected.is_empty(), "{end}: {found:?}");
        assert!(
            !proposals.iter().any(|own| own.text == "no"),
            "{end}: {found:?}"
        );
    }
    let old = scene.replace('3', "0") + "<sensor type=\"perspective\"><transform name=\"";
    let found = ForeignFormat::Mitsuba.completion(&old, old.len()).unwrap();
    assert_eq!(found.proposals[0].text, "toWorld");
    for end in ["text", "<!-- <sh", "<shape type=\"sphere\"> "] {
        let text = format!("{scene}{end}");
        assert!(
            ForeignFormat::Mitsuba
                .completion(&text, text.len())
                .is_none(),
            "{end}"
        );
    }
    // What is there is not proposed again, and the rest of a word is replaced.
    let text = "<scene><shape type=\"sphere\"><float name=\"radius\"/><float name=\"ra\"";
    let found = ForeignFormat::Mitsuba
        .completion(text, text.len() - 1)
        .unwrap();
    assert_eq!(text.get(found.replaced.clone()), Some("ra"));
    assert_eq!(found.proposals, []);
}
