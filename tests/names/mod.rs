//! Which places of the house each file names, as the compiler sees it: `use` in lists, `super`,
//! other names given by `as`, globs, and what other modules re-export.

use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};

/// The way to a module or an item from the root of the crate, `ir::Camera`.
type Way = Vec<String>;

/// A file, and a place outside its own module that it names.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Named {
    /// The file.
    pub(crate) file: String,
    /// Where its module is: the first step is the room.
    pub(crate) module: Way,
    /// What it names.
    pub(crate) place: Way,
}

/// All modules of the crate.
#[derive(Default)]
pub(crate) struct House {
    modules: BTreeMap<Way, Module>,
}

#[derive(Default)]
struct Module {
    file: String,
    /// What each name that a `use` brings stands for, as written there.
    uses: BTreeMap<String, Way>,
    globs: BTreeSet<Way>,
    /// All ways written in the module, those of `use` too.
    written: BTreeSet<Way>,
}

/// No chain of re-exports is longer.
const MAX_STEPS: usize = 16;

impl House {
    /// Reads the files below `src`, each its path and its text, without their tests.
    pub(crate) fn read(files: &[(String, String)]) -> Self {
        let (mut house, mut tests) = (Self::default(), Vec::new());
        for (path, text) in files {
            let module = module_of(path);
            let tokens: TokenStream = text.parse().unwrap_or_else(|e| panic!("{path}: {e}"));
            Reader {
                house: &mut house,
                tests: &mut tests,
                file: path,
            }
            .module(&module, tokens);
        }
        house
            .modules
            .retain(|way, _| !tests.iter().any(|test| way.starts_with(test)));
        house
    }

    /// What each file names outside its own module.
    pub(crate) fn named(&self) -> BTreeSet<Named> {
        let mut named = BTreeSet::new();
        for (way, module) in &self.modules {
            let mut places = BTreeSet::new();
            for written in &module.written {
                self.follow(way, written, MAX_STEPS, &mut places);
            }
            for glob in &module.globs {
                self.follow_all(way, glob, MAX_STEPS, &mut places);
            }
            named.extend(places.into_iter().map(|place| Named {
                file: module.file.clone(),
                module: way.clone(),
                place,
            }));
        }
        named
    }

    /// Adds every place on a way that is written in a module.
    fn follow(&self, module: &[String], way: &[String], steps: usize, places: &mut BTreeSet<Way>) {
        let (Some((first, mut rest)), Some(steps)) = (way.split_first(), steps.checked_sub(1))
        else {
            return;
        };
        let mut at: Way = module.to_vec();
        match first.as_str() {
            "crate" | "rtc" => at.clear(),
            "self" => {}
            "super" => drop(at.pop()),
            name => {
                at.push(name.to_owned());
                if !self.modules.contains_key(&at) {
                    // Another name for something, or nothing of this house.
                    let stands_for = self.modules[module].uses.get(name);
                    let whole = stands_for.map(|way| [way, rest].concat());
                    return whole
                        .iter()
                        .for_each(|way| self.follow(module, way, steps, places));
                }
            }
        }
        while let Some((step, after)) = rest.split_first() {
            if step == "super" {
                at.pop();
            } else {
                at.push(step.clone());
                places.insert(at.clone());
            }
            if !self.modules.contains_key(&at) {
                at.pop();
                return self.follow_item(&at, rest, steps, places);
            }
            rest = after;
        }
    }

    /// Goes on where a module has no child of the next name: what it re-exports under that name.
    fn follow_item(
        &self,
        at: &[String],
        rest: &[String],
        steps: usize,
        places: &mut BTreeSet<Way>,
    ) {
        let Some(holder) = self.modules.get(at) else {
            return;
        };
        if let Some(way) = holder.uses.get(&rest[0]) {
            let whole = [way, &rest[1..]].concat();
            return self.follow(at, &whole, steps, places);
        }
        for glob in &holder.globs {
            let module = self.module_at(at, glob);
            if module.is_some_and(|module| self.modules[&module].uses.contains_key(&rest[0])) {
                self.follow(at, &[glob, rest].concat(), steps, places);
            }
        }
    }

    /// Adds what a glob brings: all names that the module has from elsewhere.
    fn follow_all(
        &self,
        from: &[String],
        glob: &[String],
        steps: usize,
        places: &mut BTreeSet<Way>,
    ) {
        self.follow(from, glob, steps, places);
        let (Some(module), Some(steps)) = (self.module_at(from, glob), steps.checked_sub(1)) else {
            return;
        };
        let Module { uses, globs, .. } = &self.modules[&module];
        uses.values()
            .for_each(|way| self.follow(&module, way, steps, places));
        // What came by `super::*` is the module's own.
        let others = globs.iter().filter(|glob| glob[0] != "super");
        others.for_each(|glob| self.follow_all(&module, glob, steps, places));
    }

    /// The module at the end of a way, if all of the way is modules.
    fn module_at(&self, from: &[String], way: &[String]) -> Option<Way> {
        let mut at: Way = from.to_vec();
        for (place, step) in way.iter().enumerate() {
            match step.as_str() {
                "crate" | "rtc" if place == 0 => at.clear(),
                "self" if place == 0 => {}
                "super" => drop(at.pop()),
                name => at.push(name.to_owned()),
            }
        }
        self.modules.contains_key(&at).then_some(at)
    }
}

/// The module that a file is.
fn module_of(path: &str) -> Way {
    let path = path.trim_start_matches("src/").trim_end_matches(".rs");
    let steps = path
        .split('/')
        .filter(|step| !matches!(*step, "mod" | "lib" | "main"));
    steps.map(str::to_owned).collect()
}

struct Reader<'h> {
    house: &'h mut House,
    /// The modules of tests that are files of their own.
    tests: &'h mut Vec<Way>,
    file: &'h str,
}

impl Reader<'_> {
    fn module(&mut self, module: &[String], tokens: TokenStream) {
        let own = self.house.modules.entry(module.to_vec()).or_default();
        self.file.clone_into(&mut own.file);
        self.tokens(module, tokens);
    }

    fn tokens(&mut self, module: &[String], tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let (mut at, mut is_test) = (0, false);
        while at < tokens.len() {
            let rest = &tokens[at..];
            at += match rest {
                [TokenTree::Punct(hash), TokenTree::Group(attribute), ..]
                    if hash.as_char() == '#' =>
                {
                    let text = attribute.stream().to_string();
                    is_test |= text.split_whitespace().collect::<String>() == "cfg(test)";
                    2
                }
                [TokenTree::Ident(word), TokenTree::Ident(name), ..]
                    if is_test && word == "mod" =>
                {
                    is_test = false;
                    self.tests.push([module, &[name.to_string()]].concat());
                    3
                }
                _ if is_test => {
                    is_test = false;
                    length_of_item(rest)
                }
                [TokenTree::Ident(word), next, ..] if word == "use" && !is(next, '<') => {
                    let end = rest.iter().position(|token| is(token, ';'));
                    let end = end.unwrap_or(rest.len());
                    self.import(module, &Vec::new(), &rest[1..end]);
                    end
                }
                [
                    TokenTree::Ident(word),
                    TokenTree::Ident(name),
                    TokenTree::Group(body),
                    ..,
                ] if word == "mod" => {
                    self.module(&[module, &[name.to_string()]].concat(), body.stream());
                    3
                }
                [TokenTree::Ident(_), ..] => {
                    let (way, length) = way(rest);
                    if way.len() > 1 {
                        self.write(module, way);
                    }
                    length.max(1)
                }
                [TokenTree::Group(group), ..] => {
                    self.tokens(module, group.stream());
                    1
                }
                _ => 1,
            };
        }
    }

    /// Reads one tree of a `use`, which stands after `before`.
    fn import(&mut self, module: &[String], before: &Way, tokens: &[TokenTree]) {
        let (steps, length) = way(tokens);
        let mut whole = [before.as_slice(), &steps].concat();
        let mut rest = &tokens[length..];
        while rest.first().is_some_and(|token| is(token, ':')) {
            rest = &rest[1..];
        }
        match rest {
            [TokenTree::Group(list), ..] if list.delimiter() == Delimiter::Brace => {
                let list: Vec<TokenTree> = list.stream().into_iter().collect();
                for tree in list
                    .split(|token| is(token, ','))
                    .filter(|tree| !tree.is_empty())
                {
                    self.import(module, &whole, tree);
                }
            }
            [star, ..] if is(star, '*') => {
                self.write(module, whole.clone());
                self.own(module).globs.insert(whole);
            }
            _ => {
                if whole.last().is_some_and(|step| step == "self") {
                    whole.pop();
                }
                let name = match rest {
                    [_, TokenTree::Ident(name)] => Some(name.to_string()),
                    _ => whole.last().cloned(),
                };
                self.write(module, whole.clone());
                let uses = &mut self.own(module).uses;
                name.map(|name| uses.insert(name, whole));
            }
        }
    }

    fn write(&mut self, module: &[String], way: Way) {
        self.own(module).written.insert(way);
    }

    fn own(&mut self, module: &[String]) -> &mut Module {
        self.house
            .modules
            .get_mut(module)
            .expect("it is being read")
    }
}

/// The names joined by `::` that tokens begin with, and how many tokens they are.
fn way(tokens: &[TokenTree]) -> (Way, usize) {
    let (mut way, mut at) = (Way::new(), 0);
    loop {
        match &tokens[at..] {
            [TokenTree::Ident(step), ..] if step != "as" => way.push(step.to_string()),
            _ => return (way, at),
        }
        at += 1;
        match &tokens[at..] {
            [a, b, TokenTree::Ident(_), ..] if is(a, ':') && is(b, ':') => at += 2,
            _ => return (way, at),
        }
    }
}

/// How many tokens an item has: up to its body or its semicolon.
fn length_of_item(tokens: &[TokenTree]) -> usize {
    let is_body = |token: &TokenTree| matches!(token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace);
    let end = tokens
        .iter()
        .position(|token| is(token, ';') || is_body(token));
    end.map_or(tokens.len(), |end| end + 1)
}

fn is(token: &TokenTree, sign: char) -> bool {
    matches!(token, TokenTree::Punct(own) if own.as_char() == sign)
}
