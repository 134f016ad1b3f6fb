//! Circles: files of a package that use each other. Who changes one of them has to know all.

use super::tokens::{tokens, without_tests};
use std::collections::{BTreeMap, BTreeSet};

/// The path of a module below its package, or of a thing in it.
type Names<'a> = Vec<&'a str>;

/// A file of a package.
#[derive(Default)]
struct Module<'a> {
    file: &'a str,
    /// Names that it takes from elsewhere, also to hand them on: path by name.
    imports: BTreeMap<&'a str, Names<'a>>,
    /// Modules whose names it takes all.
    globs: Vec<Names<'a>>,
    /// The names that it defines.
    definitions: BTreeSet<&'a str>,
    /// The paths that it uses.
    uses: Vec<Names<'a>>,
}

/// The modules of a package by their paths.
struct Package<'a>(BTreeMap<Names<'a>, Module<'a>>);

/// The circles of two and more files of a package, the largest first. Arrows are the paths of its
/// code, nested ones and those through re-exports too; a file that only hands a name on does not
/// use it.
pub(super) fn circles<'a>(base: &str, files: &'a [(String, String)]) -> Vec<Vec<&'a str>> {
    let package = Package::read(base, files);
    let arrows = package.arrows();
    let reached = |from: &'a str| {
        let (mut found, mut open) = (BTreeSet::new(), vec![from]);
        while let Some(file) = open.pop() {
            for next in arrows.get(file).into_iter().flatten() {
                if found.insert(*next) {
                    open.push(next);
                }
            }
        }
        found
    };
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|file| (*file, reached(file))).collect();
    let mut circles: Vec<Vec<&str>> = Vec::new();
    for (file, ends) in &reached {
        if !ends.contains(file) || circles.iter().any(|circle| circle.contains(file)) {
            continue;
        }
        let returns = |other: &&&str| reached.get(**other).is_some_and(|back| back.contains(file));
        circles.push(ends.iter().filter(returns).copied().collect());
    }
    circles.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
    circles
}

impl<'a> Package<'a> {
    fn read(base: &str, files: &'a [(String, String)]) -> Self {
        let path = |file: &'a str| -> Names<'a> {
            let below = &file[base.len()..file.len() - ".rs".len()];
            let mut path: Names = below.split('/').filter(|name| !name.is_empty()).collect();
            if matches!(path.last(), Some(&("mod" | "lib" | "main"))) {
                path.pop();
            }
            path
        };
        let modules = files.iter().map(|(file, text)| {
            let path = path(file);
            let module = Module::read(file, &path, &without_tests(&tokens(text)));
            (path, module)
        });
        Self(modules.collect())
    }

    /// For each file the others that it uses.
    fn arrows(&self) -> BTreeMap<&'a str, BTreeSet<&'a str>> {
        let ends = |(path, module): (&Names<'a>, &Module<'a>)| {
            let ends = module.uses.iter().filter_map(|used| {
                let [first, ..] = used.as_slice() else {
                    return None;
                };
                if *first == "crate" {
                    return self.home(&used[1..], 8);
                }
                // Relative paths start at a child, at an imported name or at one of a glob.
                let places = [path].into_iter().chain(&module.globs);
                let mut paths = places.map(|place| [place.as_slice(), used].concat());
                let full = paths.find(|full| {
                    let (place, name) = full.split_at(full.len() - used.len());
                    self.0.contains_key(&full[..place.len() + 1])
                        || self
                            .0
                            .get(place)
                            .is_some_and(|it| it.imports.contains_key(name[0]))
                })?;
                self.home(&full, 8)
            });
            let others = ends.filter(|file| *file != module.file).collect();
            (module.file, others)
        };
        self.0.iter().map(ends).collect()
    }

    /// The file that defines what a path names; re-exports are followed so many times.
    fn home(&self, path: &[&'a str], steps: usize) -> Option<&'a str> {
        let mut lengths = (0..=path.len()).rev();
        let length = lengths.find(|length| self.0.contains_key(&path[..*length]))?;
        let module = &self.0[&path[..length]];
        let Some((name, rest)) = path[length..].split_first() else {
            return Some(module.file);
        };
        if steps > 0
            && let Some(target) = module.imports.get(name)
        {
            return self.home(&[target, rest].concat(), steps - 1);
        }
        if module.definitions.contains(name) || steps == 0 {
            return Some(module.file);
        }
        let mut globs = module.globs.iter().filter_map(|glob| {
            let home = self.home(&[glob.as_slice(), &[*name]].concat(), steps - 1)?;
            let defines =
                |module: &Module| module.file == home && module.definitions.contains(name);
            self.0.values().any(defines).then_some(home)
        });
        globs.next().or(Some(module.file))
    }
}

impl<'a> Module<'a> {
    fn read(file: &'a str, path: &[&'a str], tokens: &[&'a str]) -> Self {
        let mut module = Self {
            file,
            ..Self::default()
        };
        let mut at = 0;
        while at < tokens.len() {
            let before = at.checked_sub(1).map(|before| tokens[before]);
            match tokens[at] {
                "use" => at = module.read_use(path, tokens, at, before),
                "struct" | "enum" | "trait" | "fn" | "type" | "const" | "static" | "union"
                | "macro_rules" => {
                    let name = tokens[at + 1..].iter().find(|token| **token != "!");
                    module.definitions.extend(name);
                    at += 1;
                }
                name if is_name(name)
                    && before != Some("::")
                    && tokens.get(at + 1) == Some(&"::") =>
                {
                    let mut used = Vec::new();
                    at = read_path(tokens, at, &mut used);
                    module.uses.push(absolute(path, &used));
                }
                _ => at += 1,
            }
        }
        module
    }

    /// Reads a `use`, public or not; returns where it ends.
    fn read_use(
        &mut self,
        path: &[&'a str],
        tokens: &[&'a str],
        at: usize,
        before: Option<&str>,
    ) -> usize {
        let mut leaves = Vec::new();
        let end = read_tree(tokens, at + 1, &mut Vec::new(), &mut leaves);
        let hands_on = matches!(before, Some("pub" | ")"));
        for (leaf, name) in leaves {
            let leaf = match leaf.first() {
                // A child of this module.
                Some(&first) if !matches!(first, "crate" | "super" | "self") => {
                    [&["self"], leaf.as_slice()].concat()
                }
                _ => leaf,
            };
            let leaf = absolute(path, &leaf);
            if !hands_on {
                self.uses.push(leaf.clone());
            }
            match name {
                "*" => self.globs.push(leaf[1..].to_vec()),
                _ => drop(self.imports.insert(name, leaf[1..].to_vec())),
            }
        }
        end
    }
}

/// A path from the package's root, with `crate` before it; a path of a local name is kept.
fn absolute<'a>(module: &[&'a str], path: &[&'a str]) -> Names<'a> {
    let (mut place, rest) = match path.split_first() {
        Some((&"crate", rest)) => (Vec::new(), rest),
        Some((&"self", rest)) => (module.to_vec(), rest),
        Some((&"super", _)) => (module.to_vec(), path),
        _ => return path.to_vec(),
    };
    let ups = rest.iter().take_while(|name| **name == "super").count();
    place.truncate(place.len().saturating_sub(ups));
    [&["crate"], place.as_slice(), &rest[ups..]].concat()
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Reads `a::b::c`; returns where it ends.
fn read_path<'a>(tokens: &[&'a str], mut at: usize, path: &mut Names<'a>) -> usize {
    while let Some(name) = tokens.get(at).filter(|token| is_name(token)) {
        path.push(name);
        at += 1;
        if tokens.get(at) != Some(&"::") {
            break;
        }
        at += 1;
    }
    at
}

/// Reads a tree of `use` below a path; adds each leaf with the name that it gets here.
fn read_tree<'a>(
    tokens: &[&'a str],
    at: usize,
    path: &mut Names<'a>,
    leaves: &mut Vec<(Names<'a>, &'a str)>,
) -> usize {
    let length = path.len();
    let mut at = read_path(tokens, at, path);
    match tokens.get(at) {
        Some(&"{") => {
            while !matches!(tokens.get(at), Some(&"}") | None) {
                at = read_tree(tokens, at + 1, path, leaves);
            }
            at += 1;
        }
        Some(&"*") => {
            leaves.push((path.clone(), "*"));
            at += 1;
        }
        next if path.len() > length => {
            if path.last() == Some(&"self") {
                path.pop();
            }
            // `read_path` takes `as` for no name, as no `::` stands before it.
            let renamed = (next == Some(&"as")).then(|| tokens[at + 1]);
            let name = renamed.or(path.last().copied()).unwrap_or("self");
            leaves.push((path.clone(), name));
            at += if renamed.is_some() { 2 } else { 0 };
        }
        _ => {}
    }
    path.truncate(length);
    at
}

/// A package of three files: `lib.rs` hands names on, `a.rs` defines `A`; `b.rs`, which `a.rs`
/// uses, has these lines.
fn package(lines: &str) -> Vec<(String, String)> {
    let files = [
        (
            "p/lib.rs",
            "mod a; mod b; pub use a::A; pub use a::A as Renamed; pub use a::*;",
        ),
        (
            "p/a.rs",
            "use crate::b::f; pub struct A; pub struct Globbed;",
        ),
        ("p/b.rs", lines),
    ];
    files
        .map(|(path, text)| (path.to_owned(), text.to_owned()))
        .to_vec()
}

#[test]
fn no_arrow_is_hidden() {
    for lines in [
        "use crate::a::A;",
        "use crate::{a::{A}};",
        "use super::a::A as Other;",
        "use super::{self, a};",
        "use crate::A;",
        "use crate::Renamed;",
        "use super::Globbed;",
        "use crate::*; fn g(_: a::A) {}",
        "fn f(_: crate::a::A) {}",
        "fn f(_: super::A) { super::A::new() }",
    ] {
        assert_eq!(
            circles("p/", &package(lines)),
            [["p/a.rs", "p/b.rs"]],
            "{lines}"
        );
    }
    for lines in [
        "fn f() {}",
        "// use crate::a::A;",
        "const S: &str = \"crate::a::A\";",
        "#[cfg(test)] mod tests { use crate::a::A; } fn f() {}",
        "#[cfg(test)] use crate::a::A; fn f() {}",
    ] {
        assert!(circles("p/", &package(lines)).is_empty(), "{lines}");
    }
}
