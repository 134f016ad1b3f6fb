//! A picture made in parts is, byte for byte, the picture made at once.

use crate::small::{bits, paths, small, validated};
use rtc::internals::ir::{Mode, PathSettings, Scene};
use rtc::internals::passes::Overrides;
use rtc::internals::plan::{Plan, RuleSet};
use rtc::internals::render::{
    AnyWorld, Crop, Film, FilmError, PartialFilm, RenderSelection, Tiles, Values,
};
use std::num::NonZeroU32;
use std::ops::Range;

/// Samples of a pixel: seven blocks, the last of them not full.
const SAMPLES: u32 = 100;

const MAX_PIXELS: u64 = 1 << 12;

fn world(scene: &Scene) -> AnyWorld {
    let proof = validated(scene);
    AnyWorld::prepare(&proof, &Plan::new(&proof, RuleSet::ALL))
}

/// A scene of the repo, made small: four tiles of unlike size.
fn scene(name: &str) -> Scene {
    let paths = paths();
    let mut scene = small(paths.iter().find(|path| path.ends_with(name)).unwrap());
    let size = Some([22, 18]);
    Overrides {
        size,
        ..Overrides::default()
    }
    .apply(&mut scene);
    scene
}

/// The same, its paths traced.
fn traced(name: &str) -> AnyWorld {
    let mut scene = scene(name);
    scene.settings.max_depth = 3;
    scene.settings.mode = Mode::Path(PathSettings {
        samples: SAMPLES,
        multiple_scattering: true,
        ..PathSettings::default()
    });
    world(&scene)
}

fn whole(world: &AnyWorld, job: &RenderSelection) -> Film {
    world.render(job, &|_| true).unwrap()
}

fn part(world: &AnyWorld, job: &RenderSelection, samples: Option<Range<u32>>) -> PartialFilm {
    let part = world.render_part(job, samples, &|_| true);
    part.unwrap().unwrap()
}

/// The same part after a journey through bytes.
fn sent(part: &PartialFilm) -> PartialFilm {
    let bytes = part.save();
    let loaded = PartialFilm::load(&bytes, MAX_PIXELS).unwrap();
    assert_eq!(&loaded, part);
    assert!(loaded.save() == bytes, "equal films are equal bytes");
    loaded
}

fn sum(parts: impl IntoIterator<Item = PartialFilm>) -> PartialFilm {
    let add = |mut sum: PartialFilm, part| {
        sum.add(part).unwrap();
        sent(&sum)
    };
    parts.into_iter().reduce(add).unwrap()
}

fn assert_same(ours: &Film, whole: &Film, what: &str) {
    assert!(bits(ours) == bits(whole), "{what}");
    assert_eq!(ours.coverage, whole.coverage, "{what}");
    assert_eq!(ours.counts, whole.counts, "{what}");
    let size = |film: &Film| (film.image.width, film.image.height);
    assert_eq!(size(ours), size(whole), "{what}");
}

/// The tiles in three shares, each with some of them.
fn shares(job: &RenderSelection<'static>) -> [RenderSelection<'static>; 3] {
    let third = u64::MAX / 3;
    let cuts = [
        (0, third),
        (third + 1, 2 * third),
        (2 * third + 1, u64::MAX),
    ];
    let tiles = |(first, last)| {
        Some(Tiles {
            seed: 11,
            first,
            last,
        })
    };
    cuts.map(|cut| RenderSelection {
        tiles: tiles(cut),
        ..*job
    })
}

#[test]
fn tiles_made_apart_are_the_picture() {
    for path in paths() {
        let world = world(&small(&path));
        for values in [Values::Display, Values::Linear] {
            let job = RenderSelection {
                values,
                ..RenderSelection::default()
            };
            let [a, b, c] = shares(&job).map(|job| sent(&part(&world, &job, None)));
            let name = path.display().to_string();
            let film = sum([c, a, b]).develop().unwrap();
            assert_same(&film, &whole(&world, &job), &name);
        }
    }
}

#[test]
fn samples_made_apart_are_the_picture() {
    let world = traced("five-spheres.yaml");
    let block = |k: u32| 16 * k..SAMPLES.min(16 * (k + 1));
    let cuts: [Vec<Range<u32>>; 4] = [
        vec![0..64, 64..SAMPLES],
        vec![48..SAMPLES, 0..48],
        [3, 6, 0, 5, 1, 4, 2].map(block).to_vec(),
        vec![16..80, 0..16, 80..96, 96..SAMPLES],
    ];
    for values in [Values::Display, Values::Linear] {
        let job = RenderSelection {
            values,
            ..RenderSelection::default()
        };
        let whole = whole(&world, &job);
        for cut in &cuts {
            let parts = cut
                .iter()
                .map(|range| part(&world, &job, Some(range.clone())));
            let film = sum(parts).develop().unwrap();
            assert_same(&film, &whole, &format!("{cut:?}"));
        }
    }
}

/// Parts may have other samples in each tile, and a part of the picture has parts too.
#[test]
fn tiles_and_samples_made_apart_are_the_crop() {
    let world = traced("glass.yaml");
    let job = RenderSelection {
        crop: Some(Crop {
            x: 3,
            y: 5,
            width: 18,
            height: 13,
        }),
        samples: NonZeroU32::new(80),
        ..RenderSelection::default()
    };
    let [a, b, c] = shares(&job);
    let of = |job: &RenderSelection, range: Range<u32>| part(&world, job, Some(range));
    let parts = [
        of(&b, 64..80),
        part(&world, &a, None),
        of(&c, 0..32),
        of(&b, 0..64),
        of(&c, 32..80),
    ];
    assert_same(&sum(parts).develop().unwrap(), &whole(&world, &job), "crop");
}

#[test]
fn parts_that_do_not_fit_are_refused() {
    let (world, job) = (traced("five-spheres.yaml"), RenderSelection::default());
    for range in [8..24, 0..10, 96..112] {
        let refused = world.render_part(&job, Some(range.clone()), &|_| true);
        assert_eq!(refused.unwrap_err(), FilmError::Misaligned(range));
    }
    let [tiles, ..] = shares(&job);
    let mut film = part(&world, &tiles, Some(0..32));
    let before = film.clone();
    let overlapping = part(&world, &job, Some(16..48));
    let refused = film.add(overlapping).unwrap_err();
    assert!(matches!(refused, FilmError::Overlap(_)), "{refused}");
    assert_eq!(film, before);
    for other in [
        RenderSelection {
            values: Values::Linear,
            ..job
        },
        RenderSelection {
            samples: NonZeroU32::new(99),
            ..job
        },
        RenderSelection {
            crop: Some(Crop {
                x: 1,
                y: 0,
                width: 20,
                height: 18,
            }),
            ..job
        },
    ] {
        let refused = film.add(part(&world, &other, Some(32..48)));
        assert_eq!(refused, Err(FilmError::OtherPicture));
    }
    let missing = film.develop().unwrap_err();
    assert!(matches!(missing, FilmError::Missing(_)), "{missing}");
    let course = self::world(&scene("five-spheres.yaml"));
    let refused = course.render_part(&job, Some(0..16), &|_| true);
    assert_eq!(refused.unwrap_err(), FilmError::Inseparable);
}

#[test]
fn a_part_that_is_stopped_is_none() {
    let world = traced("five-spheres.yaml");
    let stopped = world.render_part(&RenderSelection::default(), Some(0..64), &|_| false);
    assert_eq!(stopped, Ok(None));
}

/// A film of few pixels in four tiles, with nodes of several levels.
fn saved() -> Vec<u8> {
    let crop = Some(Crop {
        x: 14,
        y: 14,
        width: 4,
        height: 3,
    });
    let (world, job) = (
        traced("five-spheres.yaml"),
        RenderSelection {
            crop,
            ..RenderSelection::default()
        },
    );
    let [a, _, c] = shares(&job);
    sum([part(&world, &a, Some(16..48)), part(&world, &c, None)]).save()
}

#[test]
fn damaged_bytes_are_refused() {
    let bytes = saved();
    let load = |bytes: &[u8]| PartialFilm::load(bytes, MAX_PIXELS);
    for end in 0..bytes.len() {
        assert!(load(&bytes[..end]).is_err(), "cut at {end}");
    }
    for at in 0..bytes.len() {
        let mut other = bytes.clone();
        other[at] ^= 1 << (at % 8);
        let refused = load(&other).unwrap_err();
        let is_told = match at {
            0..8 => refused == FilmError::NotAFilm,
            8..12 => matches!(refused, FilmError::Version(_)),
            _ => matches!(refused, FilmError::Corrupt(_)),
        };
        assert!(is_told, "byte {at}: {refused}");
    }
    let too_large = PartialFilm::load(&bytes, 11);
    assert_eq!(too_large, Err(FilmError::TooLarge(12)));
}

/// Bytes made to deceive: damaged, but with a checksum that fits.
#[test]
fn lying_bytes_do_no_harm() {
    let bytes = saved();
    let signed = |mut bytes: Vec<u8>| {
        let end = bytes.len() - 4;
        let sum = crc32fast::hash(&bytes[..end]);
        bytes[end..].copy_from_slice(&sum.to_le_bytes());
        bytes
    };
    let mut accepted = 0;
    for at in 12..bytes.len() - 4 {
        for value in [0, 1, 0x7f, 0xff] {
            let mut other = bytes.clone();
            other[at] = value;
            if let Ok(mut film) = PartialFilm::load(&signed(other), MAX_PIXELS) {
                let _ = film.develop();
                let _ = film.add(PartialFilm::load(&bytes, MAX_PIXELS).unwrap());
                accepted += 1;
            }
        }
    }
    assert!(accepted > bytes.len(), "values of sums may be any");
    // A head alone that promises the largest picture.
    let mut head = bytes[..bytes.len() - 4].to_vec();
    head.truncate(35);
    head[27..35].copy_from_slice(&[0xff; 8]);
    let refused = PartialFilm::load(&signed([head, vec![0; 4]].concat()), u64::MAX >> 1);
    assert_eq!(
        refused,
        Err(FilmError::TooLarge(
            u64::from(u32::MAX) * u64::from(u32::MAX)
        ))
    );
}
