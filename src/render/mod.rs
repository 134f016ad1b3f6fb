//! A proven scene becomes a world, the world a film. Nothing here can fail, and nothing depends on the threads:
//! a pixel is a function of the scene and its coordinates alone.

mod basic;
mod bounds;
mod bvh;
mod camera;
mod cone;
mod cylinder;
mod disc;
mod film;
mod frame;
mod geometry;
mod instance;
mod interval;
mod kernel;
mod optics;
mod plane;
mod quad;
mod ray;
mod sampler;
mod shade;
mod shape;
mod sphere;
mod texture;
mod torus;
mod triangle;
mod whitted;
mod world;

pub use basic::Basic;
pub use bounds::Bounds;
pub use camera::{camera_ray, image_point, vogel};
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use disc::Disc;
pub use film::{Counts, Crop, Film, Job, Seeds, Tiles, Values};
pub use geometry::Geometry;
pub use instance::{Details, Instance, PreparedMesh};
pub use kernel::{KERNELS, Kernel, choose, render};
pub use optics::{highlight, reflect, refract};
pub use plane::Plane;
pub use quad::{Patch, Quad};
pub use ray::{Interaction, Ray};
pub use shape::Shape;
pub use sphere::Sphere;
pub use torus::Torus;
pub use triangle::{Shear, Triangle};
pub use world::{Hit, Surface, World};
