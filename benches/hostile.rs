//! Writes the hostile files of `tests/hostile` into a folder, each set in a folder of its own, and
//! prints a line for each: the folder, the code that is expected or `-`, the name, and the
//! arguments of `rtc`, apart by tabs. `benches/hostile.sh` measures what they cost.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a generator stops at the first surprise, writes files and prints what it wrote"
)]

#[path = "../tests/hostile/make/mod.rs"]
mod make;

use make::Repro;
use std::path::PathBuf;
use std::{env, fs};

fn main() {
    let folder = PathBuf::from(env::args_os().nth(1).expect("usage: hostile FOLDER"));
    for (index, repro) in make::gltf::all()
        .into_iter()
        .chain(make::media::all())
        .chain(make::mitsuba::all())
        .chain(make::many::all())
        .chain(make::pbrt::all())
        .chain(make::usd::all())
        .enumerate()
    {
        let Repro {
            name,
            files,
            arguments,
            expected,
        } = repro;
        let own = folder.join(format!("{index:03}"));
        fs::create_dir_all(&own).unwrap();
        for (name, bytes) in files {
            fs::write(own.join(name), bytes).unwrap();
        }
        println!(
            "{}\t{}\t{name}\t{}",
            own.display(),
            expected.unwrap_or("-"),
            arguments.join("\t")
        );
    }
}
