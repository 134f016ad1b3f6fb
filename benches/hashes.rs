//! Prints the rows of `tests/hashes.txt` as this machine finds them, on one thread; with words as
//! arguments, those whose names have one of them. `benches/hashes.sh` runs it on machines that are
//! simulated.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a comparison stops at the first surprise, and prints what it finds"
)]

#[path = "../tests/hashed.rs"]
mod hashed;
#[path = "../tests/small.rs"]
mod small;

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with("--"))
        .collect();
    for source in hashed::sources() {
        let name = source.name();
        if words.is_empty() || words.iter().any(|word| name.contains(word.as_str())) {
            println!("{:016x} {name}", hashed::hash(&source.scene(), 1));
        }
    }
}
