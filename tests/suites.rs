//! All suites of tests that are written as functions, in one program, so that the library is linked once.

#![expect(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    clippy::wildcard_enum_match_arm,
    clippy::string_slice,
    clippy::type_complexity,
    reason = "a test stops at the first surprise and reads what it checks"
)]

mod api;
mod assets;
mod audit;
mod book;
mod bsdf;
mod builder;
mod camera;
mod certify;
mod cli;
mod codec;
mod codes;
mod cost;
mod course;
mod foreign_findings;
mod gltf;
mod guide;
mod hardcases;
mod honest;
mod ir_schema;
mod laws;
mod library;
mod links;
mod mitsuba;
mod mitsuba_materials;
mod motion;
mod numbers;
mod obj_oracle;
mod pages;
mod path;
mod pbrt;
mod pictures;
mod plain;
mod plan;
mod proofs;
mod ray_counts;
mod readme;
mod repo;
mod round_trips;
mod scale;
mod scene_laws;
mod schema;
mod shapes;
mod small;
mod tampered;
mod texts;
mod tidy;
mod unseen;
mod usd;
mod valid;
