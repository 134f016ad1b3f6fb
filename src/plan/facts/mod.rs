//! Conversions of validated lights and materials to the models that each integrator uses.
//!
//! Each integrator has one material model and one light model: the Whitted integrator the Phong
//! model and point lights without falloff, the path integrator the glTF material and physical
//! lights. Other models are converted to the closest equivalent.

pub mod light;
pub mod material;
