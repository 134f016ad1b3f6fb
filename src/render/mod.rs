//! A proven scene becomes a world, the world a film. Nothing here can fail, and nothing depends on the threads:
//! a pixel is a function of the scene and its coordinates alone.

mod bounds;
mod bvh;
mod camera;
mod film;
mod frame;
mod optics;
mod plane;
mod ray;
mod sampler;
mod shade;
mod sphere;
mod triangle;
mod whitted;
mod world;

pub use camera::{camera_ray, image_point, lens_point, vogel};
pub use film::{Counts, Crop, Film, Job, Values};
pub use optics::{highlight, reflect, refract};
pub use plane::Plane;
pub use ray::{Interaction, Ray};
pub use sphere::Sphere;
pub use triangle::{Shear, Triangle};
pub use world::{Hit, Shape, Surface, World};
