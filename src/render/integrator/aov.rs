//! Layers beside the colours, for denoisers and compositors: what the camera rays of a pixel meet
//! first, in the mean over those that meet something. They are the very rays that the colours are
//! made of.

use crate::image::Layers;
use crate::math::Vec3;
use crate::plan::Features;
use crate::render::film::Crop;
use crate::render::frame::camera_rays;
use crate::render::integrator::whitted::Tracer;
use crate::render::sampler::Key;
use crate::render::shape::geometry::Geometry;
use crate::render::shape::instance::Asked;
use crate::render::world::World;
use crate::valid::{Camera, Mode};
use rayon::prelude::*;

/// A layer. All are zero where nothing is met, but for the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aov {
    /// The base colour, maps included, linear, in [0, 1]; C·kd of Phong's model.
    Albedo,
    /// The shading normal in the world, maps included, on the side of the viewer; shorter than 1
    /// where normals differ.
    Normal,
    /// The distance from the eye along the axis of view, in units of the scene; 1e10 where nothing
    /// is met.
    Depth,
    /// The first texture coordinates, where there are some.
    Uv,
    /// The number of the surface in the scene, from 1, that the first ray meets: whole, and exact
    /// below 2²⁴.
    Instance,
    /// The place in the world.
    Position,
}

/// The depth of nothing, as in other renderers.
const FAR: f64 = 1e10;

impl Aov {
    /// The channels, by the names that denoisers and compositors look for.
    #[must_use]
    pub fn channels(self) -> &'static [&'static str] {
        match self {
            Self::Albedo => &["albedo.R", "albedo.G", "albedo.B"],
            Self::Normal => &["normal.X", "normal.Y", "normal.Z"],
            Self::Depth => &["depth.Z"],
            Self::Uv => &["uv.U", "uv.V"],
            Self::Instance => &["instance.X"],
            Self::Position => &["position.X", "position.Y", "position.Z"],
        }
    }
}

/// What a camera ray meets first.
pub(in crate::render) struct First {
    pub(in crate::render) albedo: Vec3,
    /// On either side.
    pub(in crate::render) normal: Vec3,
    pub(in crate::render) point: Vec3,
    pub(in crate::render) uv: Option<[f64; 2]>,
    /// The index of the surface in the scene.
    pub(in crate::render) surface: usize,
}

/// The sums over the rays of a pixel.
#[derive(Default)]
pub(in crate::render) struct Sums {
    rays: u32,
    hits: u32,
    albedo: Vec3,
    normal: Vec3,
    point: Vec3,
    uv: Vec3,
    hits_with_uv: u32,
    /// The number of the surface that the first ray met.
    instance: usize,
}

impl Sums {
    /// Adds what a ray in this direction met.
    pub(in crate::render) fn add(&mut self, direction: Vec3, first: Option<First>) {
        self.rays += 1;
        let Some(First {
            albedo,
            normal,
            point,
            uv,
            surface,
        }) = first
        else {
            return;
        };
        if self.rays == 1 {
            self.instance = surface + 1;
        }
        self.hits += 1;
        self.albedo += albedo.clamp(Vec3::ZERO, Vec3::ONE);
        self.normal += if normal.dot(direction) > 0.0 {
            -normal
        } else {
            normal
        };
        self.point += point;
        if let Some([u, v]) = uv {
            self.uv += Vec3::new(u, v, 0.0);
            self.hits_with_uv += 1;
        }
    }

    /// The values of the channels of a layer.
    fn values(&self, aov: Aov, camera: &Camera) -> [f64; 3] {
        let mean = |sum: Vec3, count: u32| sum / f64::from(count.max(1));
        match aov {
            Aov::Albedo => mean(self.albedo, self.hits).to_array(),
            Aov::Normal => mean(self.normal, self.hits).to_array(),
            Aov::Depth if self.hits == 0 => [FAR; 3],
            Aov::Depth => [depth(camera, mean(self.point, self.hits)); 3],
            Aov::Uv => mean(self.uv, self.hits_with_uv).to_array(),
            Aov::Instance => [self.instance as f64; 3],
            Aov::Position => mean(self.point, self.hits).to_array(),
        }
    }
}

/// How far a point lies from the eye along the normal of the image plane.
fn depth(camera: &Camera, point: Vec3) -> f64 {
    let [right, up] = [camera.right, camera.up].map(Vec3::normalize_or_zero);
    let normal = up.cross(right).normalize_or_zero();
    let forward = if normal.dot(camera.center - camera.eye) < 0.0 {
        -normal
    } else {
        normal
    };
    (point - camera.eye).dot(forward)
}

/// Who follows the camera rays of a pixel to what they meet first.
pub(in crate::render) trait See {
    /// Adds what a pixel sees; false if the observer said stop.
    fn see(&mut self, pixel: [u32; 2], sums: &mut Sums) -> bool;
}

impl<S: Geometry, const F: u32> See for Tracer<'_, S, F> {
    fn see(&mut self, pixel: [u32; 2], sums: &mut Sums) -> bool {
        for ray in camera_rays(self.scene(), pixel) {
            if !self.goes_on() {
                return false;
            }
            let first = self.world.nearest(&ray).map(|hit| {
                let view = self.view_of(&ray, hit, Key::new(pixel, 0));
                let shape = &self.world.surfaces[hit.surface].shape;
                let details = shape.details(&ray, &view.interaction, hit.part, Asked::ALL);
                let albedo = view.color * view.material.kd.get();
                First {
                    albedo,
                    normal: view.normal,
                    point: view.interaction.point,
                    uv: details.uv,
                    surface: view.surface,
                }
            });
            sums.add(ray.direction, first);
        }
        self.heartbeat.done(&self.counts)
    }
}

impl<S: Geometry> World<S> {
    /// As [`crate::render::AnyWorld::layers`], of what this world holds.
    pub(in crate::render) fn layers(
        &self,
        wanted: &[Aov],
        crop: Crop,
        proceed: &(dyn Fn() -> bool + Sync),
    ) -> Option<Layers> {
        match self.scene.settings().mode {
            Mode::Path(path) => self.layers_of_paths(path, wanted, crop, proceed),
            Mode::Phong | Mode::Zbuffer | Mode::Normal | Mode::Gooch(_) => {
                let proceed = |_| proceed();
                let tracer = || Tracer::<'_, S, { Features::EVERYTHING.0 }>::new(self, &proceed);
                self.layers_by(tracer, wanted, crop)
            }
        }
    }

    /// Renders layers by what `eye` makes for each row.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounds to the nearest float, or to infinity"
    )]
    pub(in crate::render) fn layers_by<E: See>(
        &self,
        eye: impl Fn() -> E + Sync,
        wanted: &[Aov],
        crop: Crop,
    ) -> Option<Layers> {
        let camera = self.scene.camera();
        let crop = crop.within(camera.width.get(), camera.height.get());
        let names: Vec<_> = wanted
            .iter()
            .flat_map(|aov| aov.channels())
            .copied()
            .collect();
        let width = crop.width as usize * names.len();
        let mut values = vec![0.0_f32; width * crop.height as usize];
        let row = |(y, row): (u32, &mut [f32])| {
            let mut eye = eye();
            for (x, pixel) in (crop.x..).zip(row.chunks_mut(names.len())) {
                let mut sums = Sums::default();
                if !eye.see([x, y], &mut sums) {
                    return None;
                }
                let means = wanted
                    .iter()
                    .map(|aov| (sums.values(*aov, camera), aov.channels().len()));
                let means = means.flat_map(|(values, count)| values.into_iter().take(count));
                pixel
                    .iter_mut()
                    .zip(means)
                    .for_each(|(value, mean)| *value = mean as f32);
            }
            Some(())
        };
        let rows = (crop.y..crop.y + crop.height)
            .into_par_iter()
            .zip(values.par_chunks_mut(width.max(1)));
        rows.map(row).try_reduce(|| (), |(), ()| Some(()))?;
        Some(Layers { names, values })
    }
}
