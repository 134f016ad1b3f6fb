//! The path integrator: the light that arrives along all paths, by next-event estimation and
//! scattering together.
//!
//! A pixel is a function of the scene and its coordinates alone, whatever the number of threads. No
//! path goes on, and no light is taken, on another side of the surface itself than its kind
//! demands: closed meshes let no light in, whatever the normals of their corners.

mod aov;
mod tracer;

use crate::image::Image;
use crate::render::film::heartbeat::Proceed;
use crate::render::film::{Counts, Crop, Film, Job, Values};
use crate::render::frame::progressive::Growing;
use crate::render::light::Lights;
use crate::render::shape::geometry::Geometry;
use crate::render::world::World;
use crate::valid::Path;
use rayon::prelude::*;
use tracer::Tracer;

/// How light is looked for. All find the same; only the noise differs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Strategy {
    /// Both ways, weighted by the power heuristic (Veach, Guibas, 1995).
    #[default]
    Both,
    /// By aiming at lights, wherever a surface scatters widely enough for that.
    Lights,
    /// By scattering, but for lights without extent.
    Scattering,
}

impl<S: Geometry> World<S> {
    /// Renders by tracing paths; `None` if `proceed` said stop.
    #[must_use]
    pub fn render_paths(
        &self,
        path: Path,
        strategy: Strategy,
        job: &Job,
        proceed: &Proceed<'_>,
    ) -> Option<Film> {
        let camera = self.scene.camera();
        let (width, height) = (camera.width.get(), camera.height.get());
        let whole = Crop {
            x: 0,
            y: 0,
            width,
            height,
        };
        let crop = job.crop.map_or(whole, |crop| crop.within(width, height));
        let lights = Lights::new(self, strategy);
        let count = crop.width as usize * crop.height as usize;
        let (mut pixels, mut coverage) = (vec![[0.0; 3]; count], vec![0.0; count]);
        let tone = self.scene.settings().mode.tone();
        let row = |((y, row), shares): ((u32, &mut [[f64; 3]]), &mut [f32])| {
            let mut tracer = Tracer::new(self, &lights, path, strategy, proceed).before(job.behind);
            for x in job.columns(y, crop.x..crop.x + crop.width) {
                let (before, place) = (tracer.counts, (x - crop.x) as usize);
                tracer.heartbeat.begin([x, y]);
                let radiance = tracer.pixel([x, y], job.seeds).to_array();
                row[place] = if job.values == Values::Display {
                    tone.display(radiance)
                } else {
                    radiance
                };
                shares[place] = tracer.counts.coverage_since(&before);
                if !tracer.heartbeat.done(&tracer.counts) {
                    return None;
                }
            }
            Some(tracer.counts)
        };
        let rows = (crop.y..crop.y + crop.height).into_par_iter();
        let width = (crop.width as usize).max(1);
        let rows = rows
            .zip(pixels.par_chunks_mut(width))
            .zip(coverage.par_chunks_mut(width));
        let rows = rows.step_by(job.stride.get() as usize);
        let counts = rows
            .map(row)
            .try_reduce(Counts::default, |a, b| Some(a.plus(b)))?;
        Some(Film {
            image: Image {
                width: crop.width,
                height: crop.height,
                pixels,
            },
            coverage,
            counts,
        })
    }

    /// Grows a film by tracing paths; see [`crate::render::AnyWorld::grow`].
    pub(in crate::render) fn grow_paths(
        &self,
        path: Path,
        film: &mut Growing,
        wanted: &(dyn Fn(usize) -> [u32; 2] + Sync),
        proceed: &Proceed<'_>,
    ) -> bool {
        let lights = Lights::new(self, Strategy::Both);
        let behind = film.behind;
        let tracer = || Tracer::new(self, &lights, path, Strategy::Both, proceed).before(behind);
        film.lengthen(tracer, wanted)
    }
}
