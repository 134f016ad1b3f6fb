//! The table of pictures: for each scene the hash of its values, the same for 1, 2 and 7 threads,
//! in debug and release, and on every machine. `RTC_UPDATE=1 cargo test --test files hashes/`
//! rewrites `tests/hashes.txt`. `benches/hashes.sh` compares it on other machines.

use crate::hashed::{Source, hash, sources};
use crate::small::{WHOLE, bits, film};
use crate::suite::{root, trial, updates};
use libtest_mimic::Trial;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;

pub(crate) fn trials() -> Vec<Trial> {
    let sources = sources();
    let names: Vec<String> = sources.iter().map(Source::name).collect();
    let mut trials: Vec<_> = sources
        .into_iter()
        .map(|source| {
            let names = names.clone();
            trial(format!("hashes/{}", source.name()), move || {
                check(&source, &names);
            })
        })
        .collect();
    trials.push(trial("hashes: a row for each scene", move || {
        let rows: Vec<_> = table().into_iter().map(|(name, _)| name).collect();
        assert!(updates() || rows == names, "{rows:?} instead of {names:?}");
    }));
    trials
}

fn path() -> PathBuf {
    root("tests/hashes.txt")
}

/// The rows of the table, names with their hashes.
fn table() -> Vec<(String, String)> {
    let text = std::fs::read_to_string(path()).unwrap_or_default();
    let rows = text.lines().filter_map(|row| row.split_once(' '));
    rows.map(|(hash, name)| (name.to_owned(), hash.to_owned()))
        .collect()
}

/// Writes a row into the table, in which only scenes that there are stay.
fn update(names: &[String], name: &str, hash: &str) {
    static TABLE: Mutex<()> = Mutex::new(());
    let _alone = TABLE.lock().unwrap();
    let mut rows: BTreeMap<String, String> = table().into_iter().collect();
    rows.insert(name.to_owned(), hash.to_owned());
    let row = |name: &String| Some(format!("{} {name}\n", rows.get(name)?));
    let text: String = names.iter().filter_map(row).collect();
    std::fs::write(path(), text).unwrap();
}

fn check(source: &Source, names: &[String]) {
    let (name, scene) = (source.name(), source.scene());
    // A picture that is all one value would have a hash as well.
    let mut values = bits(&film(&scene, &WHOLE, 0));
    values.sort_unstable();
    values.dedup();
    assert!(values.len() > 50, "only {} values", values.len());
    let one = hash(&scene, 1);
    for threads in [2, 7] {
        assert_eq!(hash(&scene, threads), one, "on {threads} threads");
    }
    let found = format!("{one:016x}");
    if updates() {
        return update(names, &name, &found);
    }
    let kept = table().into_iter().find(|row| row.0 == name);
    assert_eq!(Some((name, found)), kept, "now, and in tests/hashes.txt");
}
