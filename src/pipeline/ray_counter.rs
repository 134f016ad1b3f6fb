//! Counts the rays of a picture while it is rendered, and finds where they exceed the limit.
//!
//! That is the first pixel in row order at which the sum of rays exceeds the limit, which does not
//! depend on the number of threads. A thread ahead of that pixel continues until the pixels before
//! it are done, so the total is at most the limit per thread.

use rtc_diag::{Diagnostic, codes};
use rtc_ir::{EntityField, EntityKind, Light, LoweredScene, Material, Mode, ValuePath};
use rtc_math::to_u32;
use rtc_render::{Crop, RenderStep};
use std::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, AtomicUsize, Ordering};

/// The maximum number of deferred branches of a path: more would never end within a limit, and each
/// needs memory.
const MAX_DEFERRED: usize = 1 << 16;

/// Counts the rays of a part of a picture.
pub struct RayCounter {
    limit: u64,
    crop: Crop,
    /// The rays of the rounds before this one.
    before: AtomicU64,
    /// The rays of this round.
    total: AtomicU64,
    /// Whether the pixel at which the limit is exceeded is known: all threads stop.
    has_run_out: AtomicBool,
    rows: Vec<RowCount>,
    /// The rays of each pixel, row by row, and [`DONE`].
    pixels: Vec<AtomicU64>,
    /// The number of pixels done, over all renders.
    done: AtomicUsize,
    /// The number of renders.
    renders: usize,
}

/// Marks the rays of a pixel that is done.
const DONE: u64 = 1 << 63;

#[derive(Default)]
struct RowCount {
    rays: AtomicU64,
    /// The number of its pixels that are done.
    done: AtomicU32,
}

impl RayCounter {
    /// A counter for a part of a picture; it needs 8 bytes per pixel, unless there is no limit.
    #[must_use]
    pub fn new(limit: u64, crop: Crop) -> Self {
        Self::of_each(limit, crop, 1)
    }

    /// A counter for several renders in sequence, each with the full limit. The next render begins
    /// when all pixels of the previous one are done.
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
            // Avoids overflow of the sums.
            limit: limit.min(u64::MAX / 4),
            crop,
            before: AtomicU64::new(0),
            total: AtomicU64::new(0),
            has_run_out: AtomicBool::new(false),
            rows: (0..crop.height).map(|_| RowCount::default()).collect(),
            pixels: (0..pixels).map(|_| AtomicU64::new(0)).collect(),
            done: AtomicUsize::new(0),
            renders,
        }
    }

    /// Begins another round over all pixels; no render may be running.
    pub fn begin_round(&self) {
        self.before
            .fetch_add(self.total.load(Ordering::Relaxed), Ordering::Relaxed);
        self.clear();
    }

    /// Continues with the next strip, whose rays are added to those before. It has the width of the
    /// first strip and at most its height.
    pub fn next_strip(&mut self, strip: Crop) {
        self.begin_round();
        if !self.rows.is_empty() {
            self.crop = strip;
        }
    }

    /// Discards the rays of this round.
    fn clear(&self) {
        self.total.store(0, Ordering::Relaxed);
        self.pixels
            .iter()
            .for_each(|rays| rays.store(0, Ordering::Relaxed));
        for RowCount { rays, done } in &self.rows {
            rays.store(0, Ordering::Relaxed);
            done.store(0, Ordering::Relaxed);
        }
    }

    /// Counts a step; false if the limit is exceeded.
    pub fn step(&self, step: RenderStep) -> bool {
        // Find the pixel; without a limit there are no rows.
        let RenderStep {
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
        // Add the rays to pixel, row and total.
        let rays = if open > MAX_DEFERRED {
            self.limit + 1
        } else {
            rays
        };
        let (row, at) = (
            &self.rows[y as usize],
            y as usize * self.crop.width as usize + x as usize,
        );
        if rays > 0 {
            self.pixels[at].fetch_add(rays, Ordering::Relaxed);
            row.rays.fetch_add(rays, Ordering::Relaxed);
            self.total.fetch_add(rays, Ordering::Relaxed);
        }
        if is_done {
            self.pixels[at].fetch_or(DONE, Ordering::Release);
            row.done.fetch_add(1, Ordering::AcqRel);
        }
        let total = self.total.load(Ordering::Relaxed);
        // Check the limit.
        if self.before.load(Ordering::Relaxed) + total > self.limit && self.is_certain() {
            self.has_run_out.store(true, Ordering::Relaxed);
        }
        if is_done && self.renders > 1 {
            self.end_render();
        }
        !self.has_run_out.load(Ordering::Relaxed)
    }

    /// Records that a pixel is done. After the last pixel of a render the count restarts; no other
    /// thread renders then.
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

    /// Whether the pixel at which the limit is exceeded is known: all pixels before it are done.
    fn is_certain(&self) -> bool {
        let width = self.crop.width;
        let mut total_so_far = self.before.load(Ordering::Relaxed);
        let is_whole = |row: &&RowCount| row.done.load(Ordering::Acquire) >= width;
        let whole = self.rows.iter().take_while(is_whole);
        let first = whole
            .map(|row| total_so_far = total_so_far.saturating_add(row.rays.load(Ordering::Relaxed)))
            .count();
        for pixel in self.pixels.iter().skip(first * width as usize) {
            let rays = pixel.load(Ordering::Acquire);
            total_so_far = total_so_far.saturating_add(rays & !DONE);
            if total_so_far > self.limit || rays & DONE == 0 {
                break;
            }
        }
        total_so_far > self.limit
    }

    /// The pixel at which the limit was exceeded, if any; valid after the render.
    #[must_use]
    pub fn ran_out(&self) -> Option<[u32; 2]> {
        let mut total_so_far = self.before.load(Ordering::Relaxed);
        let at = self.pixels.iter().position(|rays| {
            total_so_far = total_so_far.saturating_add(rays.load(Ordering::Relaxed) & !DONE);
            total_so_far > self.limit
        })?;
        let at = to_u32(at);
        Some([
            self.crop.x + at % self.crop.width,
            self.crop.y + at / self.crop.width,
        ])
    }

    /// The diagnostic for a scene that exceeded the limit at a pixel; it points to the key that
    /// multiplies the rays most.
    #[must_use]
    pub fn diagnostic(&self, lowered: &LoweredScene, pixel: [u32; 2]) -> Diagnostic {
        let ([x, y], RayKey { path, name, value }) = (pixel, key(lowered));
        let message = format!(
            "the picture takes more than {} rays: they run out at pixel {x}, {y}",
            self.limit
        );
        let camera = ValuePath::new(EntityKind::Camera, 0, EntityField::Whole);
        let span = lowered
            .source_spans
            .span(path)
            .or_else(|| lowered.source_spans.span(camera));
        Diagnostic::new(&codes::RAYS_RAN_OUT, message)
            .at(span, format!("`{name}` is {value}"))
            .hint(format!(
                "lower `{name}`; `--limit rays=…` changes the limit, `--allow-huge` removes it"
            ))
    }
}

/// A key of a scene that multiplies rays.
struct RayKey {
    path: ValuePath,
    name: &'static str,
    value: u32,
}

/// The key that multiplies rays most, preferably one that makes rays branch.
fn key(lowered: &LoweredScene) -> RayKey {
    let settings = &lowered.scene.settings;
    let setting = |field, name, value| RayKey {
        path: ValuePath::new(EntityKind::Settings, 0, field),
        name,
        value,
    };
    // Path tracing: samples or bounces.
    let depth = setting(
        EntityField::MaxDepth,
        "MaxRecursionDepth",
        settings.max_depth,
    );
    if let Mode::Path(path) = &settings.mode {
        let samples = setting(EntityField::Mode, "samples", path.samples);
        return if path.samples >= settings.max_depth {
            samples
        } else {
            depth
        };
    }
    // Reflection and refraction branch.
    let phongs = || {
        lowered
            .scene
            .materials
            .iter()
            .map(Material::phong)
            .enumerate()
    };
    let glossy = phongs().filter_map(|(index, phong)| {
        let phong =
            phong.filter(|phong| phong.most_mirror_weight() > 0.0 && phong.glossy_samples > 1)?;
        let path = ValuePath::new(EntityKind::Material, index, EntityField::GlossySamples);
        Some(RayKey {
            path,
            name: "glossySamples",
            value: phong.glossy_samples,
        })
    });
    let bounces = phongs().any(|(_, phong)| {
        phong.is_some_and(|phong| phong.most_mirror_weight() > 0.0 || phong.kt > 0.0)
    });
    if settings.max_depth > 0 && bounces {
        return glossy
            .max_by_key(|key| key.value)
            .filter(|key| key.value >= settings.max_depth)
            .unwrap_or(depth);
    }
    // Soft shadows, then supersampling.
    let is_soft = lowered
        .scene
        .lights
        .iter()
        .filter_map(Light::point)
        .any(|light| light.radius > 0.0);
    if is_soft && settings.light_samples >= settings.supersampling {
        return setting(
            EntityField::LightSamples,
            "LightSamples",
            settings.light_samples,
        );
    }
    setting(
        EntityField::Supersampling,
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

    fn step(x: u32, y: u32, rays: u64) -> RenderStep {
        RenderStep {
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
        let run = |steps: &[RenderStep]| {
            let counter = RayCounter::new(7, CROP);
            let stopped = steps.iter().position(|step| !counter.step(*step));
            (stopped, counter.ran_out())
        };
        assert_eq!(run(&[first, second].concat()), (Some(3), Some([5, 8])));
        // The second row continues until the first is done.
        assert_eq!(run(&[second, first].concat()), (Some(5), Some([5, 8])));
        // The first row finds out and stops the second.
        assert_eq!(
            run(&[step(5, 8, 9), step(5, 7, 8), step(6, 8, 1)]),
            (Some(1), Some([5, 7]))
        );
        // A row whose last pixel is done may have others that are not.
        let late = [first[2], second[0], second[1], first[0], first[1]];
        assert_eq!(run(&late), (Some(4), Some([5, 8])));
        assert_eq!(run(&first), (None, None));
    }

    #[test]
    fn rounds_add_up() {
        let counter = RayCounter::new(7, CROP);
        assert!(counter.step(step(5, 7, 3)) && counter.step(step(6, 7, 1)));
        counter.begin_round();
        assert!(counter.step(step(5, 7, 3)) && counter.ran_out().is_none());
        assert!(!counter.step(step(6, 7, 1)));
        assert_eq!(counter.ran_out(), Some([6, 7]));
    }

    #[test]
    fn strips_run_out_where_the_whole_does() {
        let whole = RayCounter::new(7, CROP);
        let rows = [[2, 2, 2], [0, 3, 1]];
        let mut strips = RayCounter::new(7, Crop { height: 1, ..CROP });
        for (y, row) in (7..).zip(rows) {
            strips.next_strip(Crop {
                y,
                height: 1,
                ..CROP
            });
            for (x, rays) in (5..).zip(row) {
                let should_continue = whole.step(step(x, y, rays));
                assert_eq!(strips.step(step(x, y, rays)), should_continue, "{x}, {y}");
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
        let counter = RayCounter::of_each(6, CROP, 2);
        assert!(all.iter().chain(&all).all(|step| counter.step(*step)));
        assert_eq!(counter.ran_out(), None);
        let counter = RayCounter::of_each(6, CROP, 2);
        assert!(all.iter().all(|step| counter.step(*step)) && counter.step(step(5, 7, 2)));
        assert!(all[1..5].iter().all(|step| counter.step(*step)) && !counter.step(all[5]));
        assert_eq!(counter.ran_out(), Some([7, 8]));
    }

    #[test]
    fn a_pixel_that_puts_off_too_much_has_no_end() {
        let counter = RayCounter::new(1 << 32, CROP);
        assert!(counter.step(step(5, 7, 1)));
        assert!(!counter.step(RenderStep {
            open: MAX_DEFERRED + 1,
            is_done: false,
            ..step(6, 7, 1)
        }));
        assert_eq!(counter.ran_out(), Some([6, 7]));
    }

    #[test]
    fn without_a_limit_nothing_runs_out() {
        let counter = RayCounter::new(u64::MAX, CROP);
        assert!(counter.step(step(5, 7, u64::MAX)) && counter.ran_out().is_none());
    }
}
