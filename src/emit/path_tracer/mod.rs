//! What the writers for path tracers (Mitsuba, pbrt) share.
//!
//! - `camera_frame`: the axes and the image of a camera.
//! - `settings`: samples, bounces, and what other programs lack.
//! - [`PathTracerLight`]: lights as both have them.
//! - [`SurfaceMaterial`]: a material as surfaces of one kind show it.
//! - [`TexturedFactor`]: a value of a material, times a channel of a texture.
//! - [`PathTracerShape`]: surfaces as shapes that both have.
//! - [`SidecarWriter`]: meshes and pictures beside the scene.

mod basic_shape;
mod camera_frame;
mod light;
mod settings;
mod sidecar_writer;
mod surface_material;
mod textured_factor;

pub(crate) use basic_shape::{PathTracerShape, TriangleSoup, basic_shapes, has_maps, is_basic};
pub(crate) use camera_frame::{CameraFrame, SQUARE};
pub(crate) use light::{PathTracerLight, SpotEdge, SpotLight, lights};
pub(crate) use settings::{bounces, pixel_filter};
pub(crate) use sidecar_writer::{BitmapTexture, CornerColor, SidecarWriter};
pub(crate) use surface_material::{
    SurfaceMaterial, blend_weight, has_media, is_glass, is_null, media, missing_features, opacity,
    other_material, radiance,
};
pub(crate) use textured_factor::{TextureChannel, TexturedFactor};
