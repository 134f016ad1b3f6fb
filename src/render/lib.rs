//! A proven scene becomes a world, the world a film. Nothing here can fail, and nothing depends on
//! the threads: a pixel is a function of the scene and its coordinates alone.

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
mod ray;
mod sampler;
mod shape;
mod texture;
mod world;

pub use accel::simd::SimdLevel;
pub use bsdf::optics::{highlight, reflect, refract};
pub use bsdf::standard::*;
pub use bsdf::{Bsdf, BsdfSample, Evaluation, Lobes, dispersed};
pub use camera::{Camera, Projection, camera_ray, image_point, vogel};
pub use film::heartbeat::{OnPixel, Step};
pub use film::partial::{FilmError, PartialFilm};
pub use film::pixel::BLOCK as SAMPLES_OF_BLOCK;
pub use film::progressive::{ProgressiveFilm, Replicates};
pub use film::{Background, ClampedLight, Counts, Crop, Film, Job, Seeds, Stride, Tiles, Values};
pub use frame::halves::DenoisedFilm;
pub use frame::verify::Mismatch;
pub use integrator::aov::Aov;
pub use integrator::path::Strategy;
pub use kernel::{KERNELS, Kernel, PATH_KERNELS, PathKernel, choose, choose_for_paths};
pub use ray::{Interaction, Ray};
pub use rtc_math::Bounds;
pub use shape::Shape;
pub use shape::baseline::BaselineShape;
pub use shape::baseline::real::Real;
pub use shape::basic::Basic;
pub use shape::cone::Cone;
pub use shape::cylinder::Cylinder;
pub use shape::disc::Disc;
pub use shape::geometry::{AttributeRequest, Intersect, ShadingAttributes};
pub use shape::instance::Instance;
pub use shape::mesh::{Attributes, PreparedMesh};
pub use shape::paraboloid::Paraboloid;
pub use shape::plane::Plane;
pub use shape::quad::{Patch, Quad};
pub use shape::sphere::{Sphere, TexturedSphere};
pub use shape::torus::Torus;
pub use shape::triangle::{TexturedTriangle, Triangle, WatertightRay};
pub use world::any::{AnyWorld, render};
pub use world::shape::Prepare;
pub use world::verify::verify;
pub use world::{Hit, Surface, World};
