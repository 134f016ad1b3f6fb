//! `rtc audit`: what is as it was made passes, on any threads and at any level of instructions;
//! each kind of change is found.

#![expect(clippy::unwrap_used, reason = "a test stops at the first surprise")]

use crate::tampered::{Made, Recipe, audit, numbers, read, recipes};
use rtc::internals::image::{FileFormat, WrittenPicture};
use rtc::internals::pipeline::{AuditResult, AuditSubject, RenderError, TileDraw};
use rtc::internals::render::SimdLevel;

/// A picture of three tiles.
fn small() -> Made {
    Made::new(Recipe {
        size: [40, 12],
        ..Recipe::of("glass.yaml", FileFormat::Png8)
    })
}

fn all(seed: u64) -> TileDraw {
    TileDraw {
        tiles: u64::MAX,
        seed,
    }
}

fn audited(written: &WrittenPicture, recipe: &Recipe) -> Result<AuditResult, RenderError> {
    audit(written, recipe, all(0), (1, SimdLevel::best()))
}

/// What the findings are about.
fn subjects(result: &AuditResult) -> Vec<AuditSubject> {
    result
        .findings
        .iter()
        .map(|finding| finding.subject)
        .collect()
}

#[test]
fn no_alarm_is_false_on_any_threads_at_any_level() {
    for recipe in recipes() {
        let made = Made::new(recipe);
        let written = made.written();
        for simd in SimdLevel::NAMES.into_iter().filter_map(SimdLevel::named) {
            for threads in [1, 2] {
                let result = audit(&written, &recipe, all(0), (threads, simd)).unwrap();
                assert_eq!(result.findings, [], "{recipe:?}");
                assert_eq!(result.fewer_than, Some(1));
                assert_eq!(
                    (result.all, result.drawn.len()),
                    (made.tiles() as u64, made.tiles())
                );
            }
        }
    }
}

#[test]
fn a_flipped_sample_is_found_if_and_only_if_its_tile_is_drawn() {
    let mut random = numbers(1);
    for recipe in recipes() {
        let made = Made::new(recipe);
        let [mut found, mut missed] = [0, 0];
        for seed in 0..12 {
            let (written, tile) = made.with_flipped_sample(&mut random);
            let draw = TileDraw { tiles: 6, seed };
            let result = audit(&written, &recipe, draw, (1, SimdLevel::best())).unwrap();
            let is_drawn = result.drawn.contains(&tile);
            let expected: &[AuditSubject] = match is_drawn {
                true => &[AuditSubject::Samples],
                false => &[],
            };
            assert_eq!(subjects(&result), expected, "{recipe:?}");
            if let [finding] = &result.findings[..] {
                assert_eq!(finding.tile, Some(tile));
                let (area, [x, y]) = (finding.area.unwrap(), finding.pixel.unwrap());
                let is_within = |at, from, length| (from..from + length).contains(&at);
                assert!(is_within(x, area.x, area.width) && is_within(y, area.y, area.height));
                assert_ne!(finding.stated, finding.anew);
            }
            found += usize::from(is_drawn);
            missed += usize::from(!is_drawn);
        }
        assert!(found > 0 && missed > 0, "{found} {missed}");
    }
}

#[test]
fn another_hash_of_a_tile_is_found_though_the_root_fits() {
    let mut random = numbers(2);
    for recipe in recipes() {
        let made = Made::new(recipe);
        let (written, tile) = made.with_other_hash(&mut random);
        let result = audited(&written, &recipe).unwrap();
        assert_eq!(subjects(&result), [AuditSubject::Values]);
        assert_eq!(result.findings[0].tile, Some(tile));
    }
}

#[test]
fn other_metadata_are_found_with_their_root_and_with_one_that_fits() {
    let recipe = Recipe::of("glass.yaml", FileFormat::Exr);
    let made = Made::new(recipe);
    let check = |change: fn(&mut WrittenPicture), expected: &[AuditSubject]| {
        let result = audited(&made.with_other_words(change, false), &recipe).unwrap();
        assert_eq!(subjects(&result), [AuditSubject::Root]);
        assert!(result.drawn.is_empty());
        let result = audited(&made.with_other_words(change, true), &recipe).unwrap();
        assert_eq!(subjects(&result), expected);
    };
    check(
        |written| written.metadata.scene = written.metadata.scene.replace("xxh3:", "xxh3:0"),
        &[AuditSubject::Scene],
    );
    // Other settings are another scene, and what is not of the scene is other values.
    check(
        |written| set(written, "\"supersampling\":", "\"supersampling\":1"),
        &[AuditSubject::Scene],
    );
    check(
        |written| set(written, "\"crop\":", " \"crop\":"),
        &[AuditSubject::Settings],
    );
    check(
        |written| {
            set(
                written,
                "\"crop\":null",
                "\"crop\":null,\"arithmetic\":\"f32\"",
            )
        },
        &[AuditSubject::Values; 15],
    );
    // The view is no part of the root, and follows from the scene.
    let written = made.with_other_words(
        |written| written.metadata.world_to_camera.as_mut().unwrap()[3] += 1.0,
        false,
    );
    let result = audited(&written, &recipe).unwrap();
    assert_eq!(subjects(&result), [AuditSubject::View]);
}

fn set(written: &mut WrittenPicture, old: &str, new: &str) {
    assert!(written.metadata.settings.contains(old));
    written.metadata.settings = written.metadata.settings.replacen(old, new, 1);
}

#[test]
fn the_picture_of_another_scene_is_found() {
    let recipe = Recipe::of("glass.yaml", FileFormat::Png8);
    let written = Made::new(recipe).written();
    let other = Recipe::of("mirrors.yaml", FileFormat::Png8);
    let result = audited(&written, &other).unwrap();
    assert_eq!(subjects(&result), [AuditSubject::Scene]);
}

#[test]
fn what_cannot_be_made_tile_by_tile_is_refused_with_the_reason() {
    let recipe = Recipe::of("glass.yaml", FileFormat::Png8);
    let made = Made::new(recipe);
    let refused = |change: fn(&mut WrittenPicture)| {
        let written = made.with_other_words(change, true);
        match audited(&written, &recipe) {
            Err(RenderError::Refused(words)) => words,
            other => panic!("{other:?}"),
        }
    };
    let more = |name: &str| format!("\"crop\":null,{name}");
    for (setting, words) in [
        ("\"denoiser\":\"regression-1\"", "denoised"),
        ("\"targetError\":1.0", "target error"),
        ("\"timeBudget\":1.0", "within a time"),
        ("\"tomorrow\":1", "not those of this program"),
    ] {
        let written = made.with_other_words(
            |written| set(written, "\"crop\":null", &more(setting)),
            true,
        );
        let Err(RenderError::Refused(reason)) = audited(&written, &recipe) else {
            panic!("{setting}");
        };
        assert!(reason.contains(words), "{reason}");
    }
    assert!(refused(|written| written.metadata.software = "rtc 0.0.1".into()).contains("0.0.1"));
    assert!(refused(|written| written.metadata.layer = "{}".into()).contains("layer"));
    let mut bare = made.written();
    bare.tree = None;
    assert!(matches!(
        audited(&bare, &recipe),
        Err(RenderError::Refused(_))
    ));
}

#[test]
fn each_flipped_bit_of_the_words_is_found_or_refused() {
    let mut random = numbers(5);
    for recipe in recipes() {
        let made = Made::new(recipe);
        for _ in 0..8 {
            let written = made.with_flipped_word(&mut random, false);
            let result = audited(&written, &recipe).unwrap();
            assert_eq!(subjects(&result), [AuditSubject::Root]);
            let written = made.with_flipped_word(&mut random, true);
            match audited(&written, &recipe) {
                Ok(result) => assert_ne!(result.findings, [], "{:?}", written.metadata),
                Err(RenderError::Refused(_)) => {}
                Err(other) => panic!("{other:?}"),
            }
        }
    }
}

#[test]
fn draws_miss_as_many_tiles_as_the_bound_rules_out_no_more_often_than_said() {
    let recipe = Recipe::of("one-light-shadows.yaml", FileFormat::Png8);
    let made = Made::new(recipe);
    let draw = |seed| TileDraw { tiles: 6, seed };
    let on = (1, SimdLevel::best());
    let sound = audit(&made.written(), &recipe, draw(0), on).unwrap();
    // Of 15 tiles: C(9, 6) / C(15, 6) = 1.7 %.
    assert_eq!(sound.fewer_than, Some(6));
    let missed = |damaged: u64| {
        let written = made.with_damaged_tiles(damaged);
        let results = (0..400).map(|seed| audit(&written, &recipe, draw(seed), on).unwrap());
        results.filter(|result| result.findings.is_empty()).count()
    };
    // With one damaged tile less C(10, 6) / C(15, 6) = 4.2 %.
    let [rare, usual] = [missed(6), missed(5)];
    assert!(rare <= 8 && usual > 8, "{rare} {usual}");
}

/// The chunks of a PNG: where their contents are, and their names.
fn chunks(png: &[u8]) -> Vec<([u8; 4], std::ops::Range<usize>)> {
    let (mut found, mut at) = (Vec::new(), 8);
    while let Some((length, _)) = png.get(at..).and_then(<[u8]>::split_first_chunk::<4>) {
        let length = u32::from_be_bytes(*length) as usize;
        let name = png[at + 4..at + 8].try_into().unwrap();
        found.push((name, at + 8..at + 8 + length));
        at += 12 + length;
    }
    found
}

#[test]
fn each_flipped_bit_of_the_metadata_of_a_png_is_found() {
    let made = small();
    let metadata = made.written().metadata;
    let bytes = made.file();
    let texts = ["Software", "rtc:scene", "rtc:settings"];
    let mut flips = 0;
    for (name, content) in chunks(&bytes) {
        // Of a text what follows its name and the four bytes that end names and say how it is
        // coded.
        let skipped = texts.iter().find_map(|text| {
            let has_name = bytes[content.clone()].starts_with(text.as_bytes());
            (&name == b"iTXt" && has_name).then_some(text.len() + 5)
        });
        let Some(skipped) = skipped.or((&name == b"rtMT").then_some(0)) else {
            continue;
        };
        for bit in skipped * 8..content.len() * 8 {
            let mut bytes = bytes.clone();
            bytes[content.start + bit / 8] ^= 1 << (bit % 8);
            let sum = crc32fast::hash(&bytes[content.start - 4..content.end]);
            bytes[content.end..content.end + 4].copy_from_slice(&sum.to_be_bytes());
            let is_found = read(&bytes).is_none_or(|written| {
                let is_other = written.metadata != metadata || written.tree != made.written().tree;
                assert!(is_other, "a bit that is not read");
                match audited(&written, &made.recipe) {
                    Ok(result) => !result.findings.is_empty(),
                    Err(RenderError::Refused(_)) => true,
                    Err(other) => panic!("{other:?}"),
                }
            });
            assert!(is_found, "{} {bit}", String::from_utf8_lossy(&name));
            flips += 1;
        }
    }
    // The root and three hashes alone have 1024 bits.
    assert!(flips > 2000, "{flips}");
}

#[test]
fn a_large_picture_keeps_few_hashes_and_draws_a_few_tiles_at_once() {
    let recipe = Recipe {
        size: [700, 410],
        crop: None,
        ..Recipe::of("one-light-shadows.yaml", FileFormat::Png8)
    };
    let made = Made::new(recipe);
    let written = made.written();
    let tree = written.tree.as_ref().unwrap();
    assert_eq!(
        (made.tiles(), tree.tiles_of_node(), tree.nodes().len()),
        (1144, 4, 286)
    );
    let draw = |seed| TileDraw { tiles: 20, seed };
    let result = audit(&written, &recipe, draw(1), (2, SimdLevel::best())).unwrap();
    assert_eq!(
        (result.findings.len(), result.all, result.film_tiles),
        (0, 286, 4)
    );
    let mut random = numbers(3);
    for seed in 0..4 {
        let (written, tile) = made.with_flipped_sample(&mut random);
        let result = audit(&written, &recipe, all(seed), (2, SimdLevel::best())).unwrap();
        assert_eq!(result.findings[0].tile, Some(tile / 4));
    }
}
