//! Parts of pictures with damage behind checksums that fit: read or refused, at once.

use rtc::internals::pipeline::trial;
use rtc::internals::study::SplitMix64;
use std::fs;
use std::path::Path;

/// Numbers that lengths and counts are made of.
const NUMBERS: [u32; 7] = [0, 1, 2, 0xFF, 0xFFFF, 0x7FFF_FFFF, u32::MAX];

/// Damages bytes in one of several ways.
fn damage(bytes: &mut Vec<u8>, rng: &mut SplitMix64) {
    let mut below = |most: usize| rng.below(most.max(1));
    let (at, kind) = (below(bytes.len()), below(5));
    match kind {
        0 => bytes[at] ^= 1 << below(8),
        1 => bytes[at] = below(256).to_le_bytes()[0],
        2 => bytes.truncate(at.max(64)),
        3 => {
            let number = NUMBERS[below(NUMBERS.len())].to_le_bytes();
            // The lengths are in the first bytes.
            let at = if below(2) == 0 { 8 + below(16) } else { at };
            let end = bytes.len().min(at + 4);
            bytes[at.min(end)..end].copy_from_slice(&number[..end - at.min(end)]);
        }
        _ => {
            let length = below(32).min(bytes.len() - at);
            let piece = bytes[at..at + length].to_vec();
            let to = below(bytes.len());
            bytes.splice(to..to, piece);
        }
    }
}

#[test]
fn a_damaged_part_is_read_or_refused() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus/part");
    let mut files: Vec<_> = fs::read_dir(corpus)
        .unwrap()
        .map(|it| it.unwrap().path())
        .collect();
    files.sort();
    assert!(files.len() > 3, "the corpus is gone");
    let mut rng = SplitMix64::new(1);
    for file in files {
        let whole = fs::read(&file).unwrap();
        for _ in 0..500 {
            let mut bytes = whole.clone();
            let times = 1 + rng.below(3);
            (0..times).for_each(|_| damage(&mut bytes, &mut rng));
            trial::part(&bytes);
        }
    }
}
