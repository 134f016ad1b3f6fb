//! Files made to exhaust the machine end in a finding, or are harmless: texts, assets, images,
//! meshes, and folders of scenes with what they name.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test stops at the first surprise, and makes the files it checks"
)]

mod make;
mod parts;
mod prison;
mod texts;
