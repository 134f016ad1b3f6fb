//! The renderer: builds a [`World`] from a validated scene and renders it into a [`Film`].
//!
//! # Data flow
//!
//! 1. `world` builds a [`World`] from a `ValidScene` and a `Plan`: shapes, materials, textures and
//!    lights, with acceleration structures over the shapes.
//! 2. `kernel` chooses the smallest compiled integrator that has all features of the plan
//!    ([`choose`] for Whitted kernels, [`choose_for_paths`] for path kernels).
//! 3. `frame` loops over the tiles on all threads of the pool. Each thread calls the integrator for
//!    each pixel of its tile.
//! 4. `integrator` traces the camera rays of a pixel and shades their hits.
//! 5. `film` sums the samples of each pixel and returns the [`Film`]; a [`PartialFilm`] has part of
//!    the picture, a [`ProgressiveFilm`] can be refined.
//!
//! # Modules
//!
//! - `accel`: bounding volume hierarchies, the ray-cone cache. It knows no
//!   shapes.
//! - `shape`: the robust ray–shape intersections, and the [`BaselineShape`] variants.
//! - `material`, `texture`, `bsdf`: material parameters at a hit, and the BSDF of the glTF
//!   material.
//! - `light`, `sampler`, `camera`: light sampling, sample sequences, camera rays.
//! - `integrator`: Whitted ray tracing, path tracing ([`SamplingStrategy`]), depth buffers and
//!   [`Aov`]s.
//!
//! # Guarantees
//!
//! - Rendering does not fail: validation rejects every scene that could make it fail.
//! - The value of a pixel depends on the scene, the settings and the pixel's coordinates alone. It
//!   does not depend on the number of threads, the order of tiles or the [`SimdLevel`].
//! - Geometry and shading use f64. Acceleration structures use f32 with conservative error bounds,
//!   so they never miss a hit.

mod accel;
mod bsdf;
mod camera;
mod film;
mod frame;
mod integrator;
mod kernel;
#[cfg_attr(
    not(target_arch = "x86_64"),
    allow(dead_code, reason = "lanes gain with AVX-512 alone")
)]
mod lanes;
mod light;
mod material;
mod medium;
mod ray;
mod sampler;
mod shape;
mod texture;
mod world;

pub use accel::simd::SimdLevel;
pub use bsdf::optics::{highlight, reflect, refract};
pub use bsdf::standard::*;
pub use bsdf::{Bsdf, BsdfEvaluation, BsdfLobes, BsdfSample, PlasticBoundary, dispersed};
pub use camera::{Camera, Projection, camera_ray, image_point, vogel};
pub use film::heartbeat::{PixelObserver, RenderStep};
pub use film::monitor::FilmMonitor;
pub use film::partial::{FilmError, MeanOfSamples, PartialFilm};
pub use film::pixel::BLOCK as SAMPLES_OF_BLOCK;
pub use film::progressive::{ProgressiveFilm, Replicates};
pub use film::{
    Background, ClampedLight, Crop, Film, PixelStride, RayCounts, RenderSelection, SamplingSeeds,
    Tiles, Values,
};
pub use frame::halves::DenoisedFilm;
pub use frame::verify::PlanMismatch;
pub use integrator::aov::Aov;
pub use integrator::path::SamplingStrategy;
pub use kernel::{KERNELS, Kernel, PATH_KERNELS, choose, choose_for_paths};
pub use ray::{Interaction, Ray};
pub use rtc_math::Bounds;
pub use shape::Shape;
pub use shape::baseline::BaselineShape;
pub use shape::baseline::real::Real;
pub use shape::basic::BasicShape;
pub use shape::cone::Cone;
pub use shape::csg::Csg;
pub use shape::cylinder::{Cylinder, InfiniteCylinder};
pub use shape::disc::Disc;
pub use shape::ellipsoid::Ellipsoid;
pub use shape::geometry::{AttributeRequest, Intersect, ShadingAttributes};
pub use shape::instance::Instance;
pub use shape::mesh::{Attributes, PreparedMesh};
pub use shape::paraboloid::Paraboloid;
pub use shape::plane::Plane;
pub use shape::quad::{BilinearPatch, Quad};
pub use shape::sphere::{Sphere, TexturedSphere};
pub use shape::torus::Torus;
pub use shape::triangle::{TexturedTriangle, Triangle, WatertightRay};
pub use world::any::{AnyWorld, render};
pub use world::behind::SeenBehind;
pub use world::shape::Prepare;
pub use world::verify::verify;
pub use world::{Hit, Surface, World};
