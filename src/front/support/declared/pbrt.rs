//! The tables of pbrt.

use super::{ForeignFormat, assert_proposed, findings, texts};
use crate::pbrt::completion::token;
use crate::pbrt::plugins::{Argument, DIRECTIVES, Directive};
use crate::plugin::{DeclaredParameter, Plugin};
use std::ops::Range;

/// A value of a type of pbrt, and the files and names that there are.
fn value(parameter: &DeclaredParameter, kind: &str) -> &'static str {
    match kind {
        "integer" if parameter.name == "indices" => "[ 0 1 2 0 1 2 0 1 2 0 1 2 ]",
        "string" if parameter.name == "filename" => "\"a.ply\"",
        "string" if parameter.name == "materials" => "[ \"m\" \"m\" ]",
        "string" => "\"a\"",
        "texture" => "\"t\"",
        "bool" => "true",
        "point2" => "[ 0 0 1 0 0 1 ]",
        "point3" | "normal3" | "vector3" => "[ 0 0 0 1 0 0 0 1 0 ]",
        "rgb" => "[ 0.1 0.2 0.3 ]",
        "spectrum" => "[ 400 0.1 700 0.2 ]",
        "blackbody" => "4000",
        _ => "0.5",
    }
}

/// The parameters without which a reader leaves a plugin.
const NEEDED: [&str; 4] = ["P", "indices", "filename", "materials"];

/// A scene of pbrt with a plugin and some of its parameters, each by the given type.
fn pbrt_scene(
    directive: &Directive,
    plugin: &Plugin,
    parameters: &[(&DeclaredParameter, &str)],
    end: &str,
) -> String {
    let words = directive.arguments.iter().map(|argument| match argument {
        Argument::Plugin => format!("\"{}\" ", plugin.name),
        Argument::Word(words) => format!("\"{}\" ", words[0]),
        Argument::Free | Argument::MadeBy(_) => "\"new\" ".to_owned(),
    });
    let mut own = format!("{} {}", directive.name, words.collect::<String>());
    let is_named = !matches!(directive.arguments.last(), Some(Argument::Plugin));
    if is_named {
        own += &format!("\"string type\" \"{}\" ", plugin.name);
    }
    for (parameter, kind) in parameters
        .iter()
        .filter(|(own, _)| !is_named || own.name != "type")
    {
        own += &format!("\"{kind} {}\" {} ", parameter.name, value(parameter, kind));
    }
    let is_view = ["Camera", "Film", "Sampler", "Integrator", "PixelFilter"];
    let camera = "Camera \"perspective\"\n";
    let texture = "Texture \"t\" \"float\" \"constant\"\n\
                   MakeNamedMaterial \"m\" \"string type\" \"diffuse\"\n";
    match directive.name {
        "Camera" => format!("{own}\nWorldBegin\n{end}"),
        name if is_view.contains(&name) => format!("{camera}{own}\nWorldBegin\n{end}"),
        _ => format!("{camera}WorldBegin\n{texture}{own}\nShape \"sphere\"\n{end}"),
    }
}

#[test]
fn the_tables_of_pbrt_are_what_its_reader_reads() {
    let mut faults = String::new();
    for directive in DIRECTIVES {
        for plugin in directive.kind.iter().flat_map(|kind| kind.plugins) {
            let read = |parameters: &[(&DeclaredParameter, &str)]| {
                // A parameter may be of one version alone.
                let scene = |end| pbrt_scene(directive, plugin, parameters, end);
                ["", "WorldEnd\n"].map(|end| findings(ForeignFormat::Pbrt, &scene(end)))
            };
            let found = read(&[]);
            if found[0].contains(&format!("`{}` is not supported", plugin.name)) {
                faults += &format!("{} {}: {}\n", directive.name, plugin.name, found[0]);
            }
            let first = |own: &'static DeclaredParameter| (own, own.types().next().unwrap());
            let all: Vec<_> = plugin.parameters().map(first).collect();
            for own in plugin.parameters() {
                let needed = |(other, _): &(&DeclaredParameter, _)| {
                    NEEDED.contains(&other.name) && other.name != own.name
                };
                let others = all.iter().copied().filter(needed);
                let ignored = format!("{}` of the", own.name);
                let is_read = |given: &[(&DeclaredParameter, &str)]| {
                    read(given).iter().any(|found| !found.contains(&ignored))
                };
                for kind in own.types() {
                    let with_others: Vec<_> = others.clone().chain([(own, kind)]).collect();
                    if ![&[(own, kind)], &with_others[..], &all[..]]
                        .into_iter()
                        .any(is_read)
                    {
                        let name = [directive.name, plugin.name, kind, own.name].join(" ");
                        faults += &format!("{name}: {:?}\n", read(&with_others));
                    }
                }
            }
        }
    }
    assert_eq!(faults, "");
}

/// The directives, plugins and parameters of a text: their bytes and the text proposed there.
fn pbrt_words(text: &str) -> Vec<(Range<usize>, String)> {
    let (mut words, mut plugin, mut strings) = (Vec::new(), None, 0);
    let mut directive: Option<&Directive> = None;
    let (mut at, mut lists) = (0, 0);
    while let Some(token) = token(text.as_bytes(), at) {
        let range = token.range();
        let own = text.get(range.clone()).unwrap();
        let is_string = text.get(..range.start).unwrap().ends_with('"');
        at = range.end + usize::from(is_string);
        lists += i32::from(own == "[") - i32::from(own == "]");
        let known = DIRECTIVES.iter().find(|known| known.name == own);
        if known.is_some() && !is_string {
            (directive, plugin, strings) = (known, None, 0);
            words.push((range, own.to_owned()));
            continue;
        }
        let Some(directive) = directive.filter(|_| is_string && lists == 0) else {
            continue;
        };
        let kind = directive.kind;
        let argument = directive.arguments.get(strings).copied();
        strings += 1;
        if matches!(argument, Some(Argument::Plugin)) {
            plugin = kind.and_then(|kind| kind.find(own));
            words.extend(plugin.map(|plugin| (range, plugin.name.to_owned())));
        } else if argument.is_none() {
            let mut parameters = plugin.iter().flat_map(|plugin| plugin.parameters());
            let name = own.split_once(' ').map(|(_, name)| name);
            let is_known = parameters.any(|parameter| Some(parameter.name) == name);
            words.extend(is_known.then(|| (range, own.to_owned())));
        }
    }
    words
}

#[test]
fn what_stands_in_a_scene_of_pbrt_is_proposed_there() {
    let mut count = 0;
    for text in texts(ForeignFormat::Pbrt, "pbrt") {
        for (range, word) in pbrt_words(&text) {
            count += 1;
            assert_proposed(ForeignFormat::Pbrt, &text, range, &word);
        }
    }
    assert!(count > 500, "{count}");
}

#[test]
fn names_of_a_scene_of_pbrt_are_proposed() {
    let scene = "MakeNamedMaterial \"red\" \"string type\" \"diffuse\"\nTexture \"wood\" \"spectrum\" \
                 \"imagemap\"\nObjectBegin \"tree\"\nObjectEnd\n";
    let cases = [
        ("NamedMaterial \"", "red"),
        ("Material \"mix\" \"string materials\" [ \"red\" \"", "red"),
        ("Material \"diffuse\" \"texture reflectance\" \"", "wood"),
        ("ObjectInstance \"tr", "tree"),
        (
            "MakeNamedMaterial \"x\" \"string type\" \"",
            "coateddiffuse",
        ),
        (
            "MakeNamedMaterial \"x\" \"string type\" \"metal\" \"",
            "rgb k",
        ),
        ("Attribute \"shape\" \"", "float radius"),
        ("Texture \"x\" \"", "spectrum"),
        ("  Sha", "Shape"),
        ("", "AttributeBegin"),
    ];
    for (end, expected) in cases {
        let text = format!("{scene}{end}");
        let found = ForeignFormat::Pbrt.completion(&text, text.len()).unwrap();
        let mut proposals = found.proposals.iter();
        assert!(
            proposals.any(|own| own.text == expected),
            "{end}: {found:?}"
        );
    }
    // Neither numbers nor comments are completed, and no parameter is proposed twice.
    for end in ["Translate 1 ", "# Sha", "Shape \"sphere\" # "] {
        let text = format!("{scene}{end}");
        assert!(
            ForeignFormat::Pbrt.completion(&text, text.len()).is_none(),
            "{end}"
        );
    }
    let text = "Shape \"sphere\" \"float radius\" 2 \"float \"";
    let found = ForeignFormat::Pbrt
        .completion(text, text.len() - 1)
        .unwrap();
    assert_eq!(text.get(found.replaced.clone()), Some("float "));
    assert!(!found.proposals.iter().any(|own| own.text == "float radius"));
}
