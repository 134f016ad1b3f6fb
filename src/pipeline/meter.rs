//! The meter: counts the rays of a picture while they are traced, and says where they run out.
//!
//! That is the first pixel, in the order of rows, up to which the pixels take more rays than the
//! limit: the same on any number of threads. A thread that is ahead of that pixel works on until
//! those behind have come there, so that in all no more is traced than the limit for each thread.

use rtc_diag::{Diagnostic, codes};
use rtc_ir::{EntityKind, Field, Light, Lowered, Material, Mode, ValuePath};
use rtc_render::{Crop, Step};
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, AtomicUsize, Ordering};

/// Branches that a path may put off: so many of them never end within a limit, and each takes
/// memory.
const MOST_OPEN: usize = 1 << 16;

/// Counts the rays of one part of a picture.
pub struct RayCounter {
    limit: u64,
    crop: Crop,
    /// The rays of the rounds before this one.
    before: AtomicU64,
    /// Those of this round.
    total: AtomicU64,
    /// The pixel was come to at which they run out: all threads stop.
    has_run_out: AtomicBool,
    rows: Vec<Row>,
    /// The rays of each pixel, row by row, and [`DONE`].
    pixels: Vec<AtomicU64>,
    /// How many pixels are done of all renders.
    done: AtomicUsize,
    /// How many renders there will be.
    renders: usize,
}

/// Marks the rays of a pixel that is done.
const DONE: u64 = 1 << 63;

#[derive(Default)]
struct Row {
    rays: AtomicU64,
    /// How many of its pixels are done.
    done: AtomicU32,
}

impl RayCounter {
    /// A meter of a part of a picture; 8 bytes a pixel, unless there is no limit.
    #[must_use]
    pub fn new(limit: u64, crop: Crop) -> Self {
        Self::of_each(limit, crop, 1)
    }

    /// A meter of so many renders of it, one after another: each may take as many rays. The next
    /// begins when all pixels of one are done.
    #[must_use]
    pub fn of_each(limit: u64, crop: Crop, renders: usize) -> Self {
        let crop = if limit == u64::MAX {
            Crop {
                width: 0,
                height: 0,
                ..crop
            }
        } else {
            crop
        };
        let pixels = crop.width as usize * crop.height as usize;
        Self {
            // Room for rays that are counted beyond it.
            limit: limit.min(u64::MAX / 4),
            crop,
            before: AtomicU64::new(0),
            total: AtomicU64::new(0),
            has_run_out: AtomicBool::new(false),
            rows: (0..crop.height).map(|_| Row::default()).collect(),
            pixels: (0..pixels).map(|_| AtomicU64::new(0)).collect(),
            done: AtomicUsize::new(0),
            renders,
        }
    }

    /// Begins another round over all pixels; nobody renders meanwhile.
    pub fn begin_round(&self) {
        self.before
            .fetch_add(self.total.load(Ordering::Relaxed), Ordering::Relaxed);
        self.clear();
    }

    /// Goes on to the next strip of the picture, whose rays come on top of those before: it is as wide as
    /// the part that this meter was made for, and no higher.
    pub fn go_on(&mut self, strip: Crop) {
        self.begin_round();
        if !self.rows.is_empty() {
            self.crop = strip;
        }
    }

    /// Forgets the rays of this round.
    fn clear(&self) {
        self.total.store(0, Ordering::Relaxed);
        self.pixels
            .iter()
            .for_each(|rays| rays.store(0, Ordering::Relaxed));
        for Row { rays, done } in &self.rows {
            rays.store(0, Ordering::Relaxed);
            done.store(0, Ordering::Relaxed);
        }
    }

    /// Counts a step; false if the rays have run out.
    pub fn step(&self, step: Step) -> bool {
        let Step {
            rays,
            pixel,
            is_done,
            open,
        } = step;
        let [x, y] = [
            pixel[0].wrapping_sub(self.crop.x),
            pixel[1].wrapping_sub(self.crop.y),
        ];
        if x >= self.crop.width || y >= self.crop.height {
            return true;
        }
        let rays = if open > MOST_OPEN {
            self.limit + 1
        } else {
            rays
        };
        let (row, at) = (
            &self.rows[y as usize],
            y as usize * self.crop.width as usize + x as usize,
        );
        self.pixels[at].fetch_add(rays, Ordering::Relaxed);
        row.rays.fetch_add(rays, Ordering::Relaxed);
        if is_done {
            self.pixels[at].fetch_or(DONE, Ordering::Release);
            row.done.fetch_add(1, Ordering::AcqRel);
        }
        let total = self.total.fetch_add(rays, Ordering::Relaxed) + rays;
        if self.before.load(Ordering::Relaxed) + total > self.limit && self.is_certain() {
            self.has_run_out.store(true, Ordering::Relaxed);
        }
        if is_done && self.renders > 1 {
            self.end_render();
        }
        !self.has_run_out.load(Ordering::Relaxed)
    }

    /// Takes down that a pixel is done. Behind the last of a render the rays of the next are
    /// counted from none; no other thread renders then.
    fn end_render(&self) {
        let done = self.done.fetch_add(1, Ordering::AcqRel) + 1;
        if !done.is_multiple_of(self.pixels.len()) {
            return;
        }
        if self.ran_out().is_some() {
            self.has_run_out.store(true, Ordering::Relaxed);
        } else if done < self.renders * self.pixels.len() {
            self.clear();
        }
    }

    /// Whether it is known at which pixel the rays run out: all before it are done.
    fn is_certain(&self) -> bool {
        let width = self.crop.width;
        let mut sum = self.before.load(Ordering::Relaxed);
        let is_whole = |row: &&Row| row.done.load(Ordering::Acquire) >= width;
        let whole = self.rows.iter().take_while(is_whole);
        let first = whole
            .map(|row| sum = sum.saturating_add(row.rays.load(Ordering::Relaxed)))
            .count();
        for pixel in self.pixels.iter().skip(first * width as usize) {
            let rays = pixel.load(Ordering::Acquire);
            sum = sum.saturating_add(rays & !DONE);
            if sum > self.limit || rays & DONE == 0 {
                break;
            }
        }
        sum > self.limit
    }

    /// The pixel at which the rays ran out, if they did; to be asked when the render has ended.
    #[must_use]
    pub fn ran_out(&self) -> Option<[u32; 2]> {
        let mut sum = self.before.load(Ordering::Relaxed);
        let at = self.pixels.iter().position(|rays| {
            sum = sum.saturating_add(rays.load(Ordering::Relaxed) & !DONE);
            sum > self.limit
        })?;
        let at = u32::try_from(at).unwrap_or(u32::MAX);
        Some([
            self.crop.x + at % self.crop.width,
            self.crop.y + at / self.crop.width,
        ])
    }

    /// What to say of a scene whose rays ran out at a pixel: it points at the key that makes them
    /// so many.
    #[must_use]
    pub fn finding(&self, lowered: &Lowered, pixel: [u32; 2]) -> Diagnostic {
        let ([x, y], RayKey { place, name, value }) = (pixel, key(lowered));
        let message = format!(
            "the picture takes more than {} rays: they run out at pixel {x}, {y}",
            self.limit
        );
        let camera = ValuePath::new(EntityKind::Camera, 0, Field::Whole);
        let span = lowered
            .source_spans
            .span(place)
            .or_else(|| lowered.source_spans.span(camera));
        Diagnostic::new(&codes::RAYS_RAN_OUT, message)
            .at(span, format!("`{name}` is {value}"))
            .hint(format!(
                "lower `{name}`; `--limit rays=…` sets another limit, `--allow-huge` lifts it"
            ))
    }
}

/// A key of a scene that multiplies rays.
struct RayKey {
    place: ValuePath,
    name: &'static str,
    value: u32,
}

/// The key that multiplies rays most: by branching, if it does so at all.
fn key(lowered: &Lowered) -> RayKey {
    let settings = &lowered.scene.settings;
    let setting = |field, name, value| RayKey {
        place: ValuePath::new(EntityKind::Settings, 0, field),
        name,
        value,
    };
    let depth = setting(Field::MaxDepth, "MaxRecursionDepth", settings.max_depth);
    if let Mode::Path(path) = &settings.mode {
        let samples = setting(Field::Mode, "samples", path.samples);
        return if path.samples >= settings.max_depth {
            samples
        } else {
            depth
        };
    }
    let phongs = || {
        lowered
            .scene
            .materials
            .iter()
            .map(Material::phong)
            .enumerate()
    };
    let glossy = phongs().filter_map(|(index, phong)| {
        let phong = phong.filter(|phong| phong.ks > 0.0 && phong.glossy_samples > 1)?;
        let place = ValuePath::new(EntityKind::Material, index, Field::GlossySamples);
        Some(RayKey {
            place,
            name: "glossySamples",
            value: phong.glossy_samples,
        })
    });
    let bounces =
        phongs().any(|(_, phong)| phong.is_some_and(|phong| phong.ks > 0.0 || phong.kt > 0.0));
    if settings.max_depth > 0 && bounces {
        return glossy
            .max_by_key(|key| key.value)
            .filter(|key| key.value >= settings.max_depth)
            .unwrap_or(depth);
    }
    let is_soft = lowered
        .scene
        .lights
        .iter()
        .filter_map(Light::point)
        .any(|light| light.radius > 0.0);
    if is_soft && settings.light_samples >= settings.supersampling {
        return setting(Field::LightSamples, "LightSamples", settings.light_samples);
    }
    setting(
        Field::Supersampling,
        "SuperSampling",
        settings.supersampling,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const CROP: Crop = Crop {
        x: 5,
        y: 7,
        width: 3,
        height: 2,
    };

    fn step(x: u32, y: u32, rays: u64) -> Step {
        Step {
            rays,
            pixel: [x, y],
            is_done: true,
            open: 0,
        }
    }

    #[test]
    fn the_pixel_named_hangs_on_no_order_of_rows() {
        let first = [step(5, 7, 2), step(6, 7, 2), step(7, 7, 2)];
        let second = [step(5, 8, 2), step(6, 8, 2), step(7, 8, 2)];
        let run = |steps: &[Step]| {
            let meter = RayCounter::new(7, CROP);
            let stopped = steps.iter().position(|step| !meter.step(*step));
            (stopped, meter.ran_out())
        };
        assert_eq!(run(&[first, second].concat()), (Some(3), Some([5, 8])));
        // The second row goes on until the first is done.
        assert_eq!(run(&[second, first].concat()), (Some(5), Some([5, 8])));
        // What the first row finds out stops the second.
        assert_eq!(
            run(&[step(5, 8, 9), step(5, 7, 8), step(6, 8, 1)]),
            (Some(1), Some([5, 7]))
        );
        // A row whose last pixel is done need not be.
        let late = [first[2], second[0], second[1], first[0], first[1]];
        assert_eq!(run(&late), (Some(4), Some([5, 8])));
        assert_eq!(run(&first), (None, None));
    }

    #[test]
    fn rounds_add_up() {
        let meter = RayCounter::new(7, CROP);
        assert!(meter.step(step(5, 7, 3)) && meter.step(step(6, 7, 1)));
        meter.begin_round();
        assert!(meter.step(step(5, 7, 3)) && meter.ran_out().is_none());
        assert!(!meter.step(step(6, 7, 1)));
        assert_eq!(meter.ran_out(), Some([6, 7]));
    }

    #[test]
    fn strips_run_out_where_the_whole_does() {
        let whole = RayCounter::new(7, CROP);
        let rows = [[2, 2, 2], [0, 3, 1]];
        let mut strips = RayCounter::new(7, Crop { height: 1, ..CROP });
        for (y, row) in (7..).zip(rows) {
            strips.go_on(Crop {
                y,
                height: 1,
                ..CROP
            });
            for (x, rays) in (5..).zip(row) {
                let goes_on = whole.step(step(x, y, rays));
                assert_eq!(strips.step(step(x, y, rays)), goes_on, "{x}, {y}");
            }
        }
        assert_eq!(whole.ran_out(), Some([6, 8]));
        assert_eq!(strips.ran_out(), whole.ran_out());
    }

    #[test]
    fn each_render_has_the_limit_to_itself() {
        let all: Vec<_> = (7..9)
            .flat_map(|y| (5..8).map(move |x| step(x, y, 1)))
            .collect();
        let meter = RayCounter::of_each(6, CROP, 2);
        assert!(all.iter().chain(&all).all(|step| meter.step(*step)));
        assert_eq!(meter.ran_out(), None);
        let meter = RayCounter::of_each(6, CROP, 2);
        assert!(all.iter().all(|step| meter.step(*step)) && meter.step(step(5, 7, 2)));
        assert!(all[1..5].iter().all(|step| meter.step(*step)) && !meter.step(all[5]));
        assert_eq!(meter.ran_out(), Some([7, 8]));
    }

    #[test]
    fn a_pixel_that_puts_off_too_much_has_no_end() {
        let meter = RayCounter::new(1 << 32, CROP);
        assert!(meter.step(step(5, 7, 1)));
        assert!(!meter.step(Step {
            open: MOST_OPEN + 1,
            is_done: false,
            ..step(6, 7, 1)
        }));
        assert_eq!(meter.ran_out(), Some([6, 7]));
    }

    #[test]
    fn without_a_limit_nothing_runs_out() {
        let meter = RayCounter::new(u64::MAX, CROP);
        assert!(meter.step(step(5, 7, u64::MAX)) && meter.ran_out().is_none());
    }
}
