//! The subject of a study: a scene, and some tiles of its picture, which it renders in any setting.

use super::journal::JournalEntry;
use super::outcome::StudyArea;
use super::runtime::{StudyRuntime, Time};
use super::setting::Setting;
use super::spread::ReseededRenders;
use rtc_image::Image;
use rtc_ir::{Pattern, Scene};
use rtc_plan::{Plan, RuleSet};
use rtc_render::{Crop, RayCounts, RenderSelection, SamplingSeeds, Tiles};
use rtc_valid::{ValidScene, revalidate};
use std::sync::Arc;
use xxhash_rust::xxh3::xxh3_64;

/// A scene, and the part of its picture that is rendered.
#[derive(Clone)]
pub(super) struct StudySubject<'runtime> {
    pub(super) scene: Arc<Scene>,
    seed: u64,
    /// The tiles in order of rank, as column and row.
    tiles: Vec<[u32; 2]>,
    runtime: &'runtime StudyRuntime<'runtime>,
}

/// The tiles of a picture as rendered.
#[derive(Clone)]
pub(super) struct RenderedTiles {
    pub(super) tiles: Vec<Image>,
    pub(super) counts: RayCounts,
}

/// A timed render of some tiles.
pub(super) struct TimedTiles {
    pub(super) rendered: RenderedTiles,
    pub(super) time: Time,
    /// The mean square error of each render, if there is a reference.
    pub(super) squares: Vec<f64>,
    /// Whether it was rendered before the study was interrupted.
    pub(super) is_resumed: bool,
}

/// The study or render was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stopped;

impl<'runtime> StudySubject<'runtime> {
    /// The whole picture of a validated scene; `seed` gives the order of tiles for smaller parts.
    pub(super) fn new(scene: &Scene, seed: u64, runtime: &'runtime StudyRuntime<'runtime>) -> Self {
        Self {
            scene: Arc::new(scene.clone()),
            seed,
            tiles: all_tiles(scene.camera.size, seed),
            runtime,
        }
    }

    /// The subject with all its tiles.
    pub(super) fn whole(&self) -> Self {
        Self {
            tiles: all_tiles(self.scene.camera.size, self.seed),
            ..self.clone()
        }
    }

    /// The subject with its first `count` tiles only, at least one.
    pub(super) fn keep(&self, count: usize) -> Self {
        let mut reduced = self.clone();
        reduced.tiles.truncate(count.max(1));
        reduced
    }

    /// The same part of another scene's picture.
    pub(super) fn with_scene(&self, scene: Scene) -> Self {
        Self {
            scene: Arc::new(scene),
            ..self.clone()
        }
    }

    /// Reports the approximate number of rays of the whole study.
    pub(super) fn report_budget(&self, rays: u64) {
        self.runtime.report_budget(rays);
    }

    /// Whether the whole picture is rendered; then it is one tile.
    pub(super) fn is_whole(&self) -> bool {
        self.fraction() >= 1.0
    }

    /// Whether both are parts of the picture of one scene.
    pub(super) fn is_of_scene_of(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
    }

    /// The number of tiles.
    pub(super) fn count(&self) -> usize {
        self.tiles.len()
    }

    /// The rectangles of the tiles.
    pub(super) fn cells(&self) -> Vec<Crop> {
        self.tiles
            .iter()
            .map(|tile| self.rectangle(*tile))
            .collect()
    }

    /// The rectangles of the images of a render: the tiles, or the whole picture.
    pub(super) fn areas(&self) -> Vec<Crop> {
        let [width, height] = self.scene.camera.size;
        match self.is_whole() {
            true => vec![Crop {
                x: 0,
                y: 0,
                width,
                height,
            }],
            false => self.cells(),
        }
    }

    /// The rays of each pixel of the whole picture in a setting, row by row.
    pub(super) fn rays_of_pixels(&self, setting: Setting) -> Result<Vec<u64>, Stopped> {
        let key = self.key("rays", setting, SamplingSeeds::NONE);
        if let Some(entry) = self.runtime.replay(key) {
            return Ok(entry.seconds.iter().map(|rays| *rays as u64).collect());
        }
        let (scene, job) = (
            self.validate(setting, SamplingSeeds::NONE),
            self.job(SamplingSeeds::NONE),
        );
        let plan = Plan::with_arithmetic(setting.precision, &scene, RuleSet::ALL);
        let count = || {
            self.runtime
                .rays_of_pixels((&scene, &plan), &job, setting.denoise)
        };
        let rays = self.runtime.in_parallel(count).ok_or(Stopped)?;
        self.runtime.record(|| JournalEntry {
            key,
            rendered: RenderedTiles {
                tiles: Vec::new(),
                counts: RayCounts::default(),
            },
            // Whole numbers below 2⁵³, so none is rounded.
            seconds: rays.iter().map(|rays| *rays as f64).collect(),
        });
        Ok(rays)
    }

    /// The tiles of a render; a whole picture is split into tiles.
    pub(super) fn tiles_of(&self, rendered: RenderedTiles) -> Vec<Image> {
        match rendered.tiles.as_slice() {
            [whole] if self.is_whole() => {
                let cells = self.cells();
                cells.iter().map(|cell| cut(whole, *cell)).collect()
            }
            _ => rendered.tiles,
        }
    }

    /// The number of pixels.
    pub(super) fn pixels(&self) -> u64 {
        let pixels = |cell: Crop| cell.pixels() as u64;
        self.cells().into_iter().map(pixels).sum()
    }

    /// The fraction of the picture that is rendered.
    pub(super) fn fraction(&self) -> f64 {
        let [width, height] = self.scene.camera.size;
        self.pixels() as f64 / (f64::from(width) * f64::from(height))
    }

    /// The rendered part, for reports.
    pub(super) fn area(&self) -> StudyArea {
        StudyArea {
            size: self.scene.camera.size,
            tiles: if self.is_whole() { 0 } else { self.count() },
            pixels: self.pixels(),
            fraction: self.fraction(),
        }
    }

    /// Renders in a setting on all threads. A seed other than 0 gives samples independent of all
    /// other seeds.
    pub(super) fn render(
        &self,
        setting: Setting,
        seeds: SamplingSeeds,
    ) -> Result<RenderedTiles, Stopped> {
        let key = self.key("picture", setting, seeds);
        if let Some(entry) = self.runtime.replay(key) {
            return Ok(entry.rendered);
        }
        let scene = self.validate(setting, seeds);
        let rendered = self
            .runtime
            .in_parallel(|| self.render_scene(&scene, setting, seeds))?;
        self.runtime.record(|| JournalEntry {
            key,
            rendered: rendered.clone(),
            seconds: Vec::new(),
        });
        Ok(rendered)
    }

    /// A key that identifies a render of the study.
    fn key(&self, kind: &str, setting: Setting, seeds: SamplingSeeds) -> u64 {
        let tiles = self.tiles.len();
        xxh3_64(format!("{kind} {setting:?} {seeds:?} {tiles}").as_bytes())
    }

    /// Renders in a setting on one thread, `repeats` times as decided from the first result, each
    /// as `reseeded` selects. If the first picture is not needed, it may be missing.
    pub(super) fn time(
        &self,
        setting: Setting,
        is_wanted: bool,
        reseeded: ReseededRenders<'_>,
        repeats: impl FnOnce(&RenderedTiles) -> u64,
    ) -> Result<TimedTiles, Stopped> {
        // Replay the render from the journal, if it is there.
        let key = self.key("time", setting, reseeded.seeds(0, &self.scene.settings));
        if let Some(JournalEntry {
            rendered, seconds, ..
        }) = self.runtime.replay(key)
            && let [cpu, wall, squares @ ..] = &seconds[..]
        {
            repeats(&rendered);
            let (cpu, wall) = (*cpu, *wall);
            return Ok(TimedTiles {
                rendered,
                time: Time { cpu, wall },
                squares: squares.to_vec(),
                is_resumed: true,
            });
        }
        // Render and time.
        let scene = self.validate_with(setting, None);
        let render = |number| {
            let seeds = reseeded.seeds(number, &self.scene.settings);
            self.runtime
                .measure(|| self.render_scene(&scene, setting, seeds))
        };
        let (rendered, mut time) = render(0);
        let rendered = rendered?;
        let mut squares = Vec::from_iter(reseeded.square(&rendered));
        let count = repeats(&rendered);
        for number in 1..count {
            let (again, more) = render(number);
            squares.extend(reseeded.square(&again?));
            time = time.plus(more);
        }
        let time = time.over(count as f64);
        // Record it.
        self.runtime.record(|| JournalEntry {
            key,
            rendered: RenderedTiles {
                tiles: match is_wanted {
                    true => rendered.tiles.clone(),
                    false => Vec::new(),
                },
                counts: rendered.counts,
            },
            seconds: [&[time.cpu, time.wall], &squares[..]].concat(),
        });
        Ok(TimedTiles {
            rendered,
            time,
            squares,
            is_resumed: false,
        })
    }

    /// The seconds for preparing the scene and for skipping all pixels, in each of `rounds`.
    pub(super) fn time_overhead(&self, setting: Setting, rounds: usize) -> Vec<[f64; 2]> {
        // Replay from the journal, if it is there.
        let key = self.key("overhead", setting, SamplingSeeds::NONE);
        if let Some(entry) = self.runtime.replay(key) {
            let (pairs, _) = entry.seconds.as_chunks();
            return pairs.to_vec();
        }
        // Define a render without pixels, and one that skips all pixels.
        let scene = self.validate(setting, SamplingSeeds::NONE);
        let nowhere = Crop {
            x: 0,
            y: 0,
            width: 0,
            height: 0,
        };
        let without_pixels = RenderSelection {
            crop: Some(nowhere),
            ..RenderSelection::default()
        };
        let without_tiles = RenderSelection {
            tiles: Some(Tiles {
                seed: self.seed,
                first: 0,
                last: 0,
            }),
            ..RenderSelection::default()
        };
        // Time both in rounds.
        let seconds = |job| {
            let plan = || Plan::with_arithmetic(setting.precision, &scene, RuleSet::ALL);
            let work = || self.runtime.render((&scene, &plan()), job, false);
            self.runtime.measure(work).1.cpu
        };
        let round = |_| {
            let prepare = seconds(&without_pixels);
            [prepare, (seconds(&without_tiles) - prepare).max(0.0)]
        };
        let seconds: Vec<[f64; 2]> = (0..rounds).map(round).collect();
        // Record the times.
        self.runtime.record(|| JournalEntry {
            key,
            rendered: RenderedTiles {
                tiles: Vec::new(),
                counts: RayCounts::default(),
            },
            seconds: seconds.iter().flatten().copied().collect(),
        });
        seconds
    }

    /// The validated scene in a setting, with jittered sub-samples if the seeds change them.
    fn validate(&self, setting: Setting, seeds: SamplingSeeds) -> ValidScene {
        self.validate_with(setting, (seeds.pixel != 0).then_some(Pattern::Jitter))
    }

    /// The validated scene in a setting, with its own pixel pattern or another.
    fn validate_with(&self, setting: Setting, pattern: Option<Pattern>) -> ValidScene {
        let mut scene = Scene::clone(&self.scene);
        setting.apply(&mut scene);
        if let Some(pattern) = pattern {
            scene.settings.pattern = pattern;
        }
        revalidate(&scene)
    }

    fn render_scene(
        &self,
        scene: &ValidScene,
        setting: Setting,
        seeds: SamplingSeeds,
    ) -> Result<RenderedTiles, Stopped> {
        let job = self.job(seeds);
        let plan = Plan::with_arithmetic(setting.precision, scene, RuleSet::ALL);
        let film = self.runtime.render((scene, &plan), &job, setting.denoise);
        let film = film.ok_or(Stopped)?;
        let counts = film.counts;
        if self.is_whole() {
            return Ok(RenderedTiles {
                tiles: vec![film.image],
                counts,
            });
        }
        let cells = self.cells();
        let tiles = cells.iter().map(|cell| cut(&film.image, *cell)).collect();
        Ok(RenderedTiles { tiles, counts })
    }

    /// The render job: the tiles, with seeds.
    fn job(&self, seeds: SamplingSeeds) -> RenderSelection<'static> {
        let last = self
            .tiles
            .last()
            .map_or(0, |tile| Tiles::rank(self.seed, *tile));
        let tiles = Some(Tiles {
            seed: self.seed,
            first: 0,
            last,
        });
        RenderSelection {
            tiles,
            seeds,
            ..RenderSelection::default()
        }
    }

    /// The rectangle of a tile.
    fn rectangle(&self, [x, y]: [u32; 2]) -> Crop {
        let [width, height] = self.scene.camera.size;
        let side = Tiles::SIDE;
        Crop {
            x: x * side,
            y: y * side,
            width: side,
            height: side,
        }
        .within(width, height)
    }
}

/// The tiles of a picture of a size in pixels, in order of rank.
fn all_tiles(size: [u32; 2], seed: u64) -> Vec<[u32; 2]> {
    let [columns, rows] = size.map(|pixels| pixels.div_ceil(Tiles::SIDE));
    let mut tiles: Vec<_> = (0..rows)
        .flat_map(|y| (0..columns).map(move |x| [x, y]))
        .collect();
    tiles.sort_by_key(|tile| Tiles::rank(seed, *tile));
    tiles
}

/// A part of a picture.
fn cut(image: &Image, part: Crop) -> Image {
    let row = |y: u32| {
        &image.pixels[y as usize * image.width as usize..][part.x as usize..][..part.width as usize]
    };
    let pixels = (part.y..part.y + part.height)
        .flat_map(row)
        .copied()
        .collect();
    Image {
        width: part.width,
        height: part.height,
        pixels,
    }
}
