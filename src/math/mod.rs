//! Numbers: vectors, bases, and arithmetic that is the same on every machine.

pub use glam::DVec3 as Vec3;
