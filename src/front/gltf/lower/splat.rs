//! Gaussian splats (`KHR_gaussian_splatting`): points that are drawn as ellipsoids of one colour.

use super::super::accessor_reader::AccessorReader;
use super::super::document::Document;
use super::super::primitive::Primitive;
use super::Lowering;
use super::transform::InstanceTransforms;
use crate::splat::{self, Splat};
use rtc_diag::codes;
use rtc_ir::{EntityField, EntityKind, Material, MaterialId, MeshId, Standard, ValuePath};
use rtc_math::{Vec3, to_u32};
use rtc_source::Resource;
use rtc_source::tree::NodeId;
use std::collections::BTreeMap;

/// The meshes of splats that were made, and their material.
#[derive(Default)]
pub(super) struct SplatMeshes {
    meshes: BTreeMap<NodeId, Option<MeshId>>,
    material: Option<MaterialId>,
}

/// An attribute of splats.
fn attribute(primitive: &Primitive, name: &str) -> Option<usize> {
    primitive.find(&format!("KHR_gaussian_splatting:{name}"))
}

/// True if the points of a primitive are splats.
pub(super) fn is_splatted(primitive: &Primitive) -> bool {
    let has = |name: &&str| attribute(primitive, name).is_some();
    primitive.mode == 0 && ["SCALE", "ROTATION", "OPACITY"].iter().all(has)
}

/// The splats of a primitive.
fn splats(doc: &Document<'_>, primitive: &Primitive) -> Option<Vec<Splat>> {
    let reader = |accessor: usize| AccessorReader::of(doc, doc.accessors.get(accessor)?);
    let read = |name: &str| reader(attribute(primitive, name)?);
    let centers = reader(primitive.find("POSITION")?)?;
    let (scales, rotations, opacities) = (read("SCALE")?, read("ROTATION")?, read("OPACITY")?);
    let harmonics = read("SH_DEGREE_0_COEF_0");
    let parts = [&centers, &scales, &rotations, &opacities];
    let count = parts
        .into_iter()
        .chain(&harmonics)
        .map(|part| part.count)
        .min()?;
    let splat = |at: usize| Splat {
        center: Vec3::from_array(centers.at(at)),
        rotation: rotations.at(at),
        log_scale: scales.at(at),
        opacity: opacities.at::<1>(at)[0],
        color: harmonics.as_ref().map_or([0.5; 3], |harmonics| {
            splat::harmonic_color(harmonics.at(at))
        }),
    };
    Some((0..count).map(splat).collect())
}

impl Lowering<'_, '_, '_> {
    /// Draws the splats of a primitive at the transforms of a node.
    pub(super) fn splats(
        &mut self,
        primitive: &Primitive,
        places: &InstanceTransforms<'_>,
        (name, at): (&str, NodeId),
    ) {
        let known = self.splats.meshes.get(&primitive.at).copied();
        let made = known.unwrap_or_else(|| self.splat_mesh(primitive));
        self.splats.meshes.insert(primitive.at, made);
        let Some(mesh) = made else {
            return;
        };
        let material = self.splat_material();
        for place in 0..places.count() {
            self.surface(mesh, places.at(place), material, name, at);
        }
    }

    fn splat_mesh(&mut self, primitive: &Primitive) -> Option<MeshId> {
        let memory = super::mesh::corners(self.doc, primitive).saturating_mul(splat::MEMORY);
        let at = primitive.at;
        if !self
            .report
            .charge(Resource::Memory, memory, at, "the splats")
        {
            return None;
        }
        let message = splat::APPROXIMATION.to_owned();
        let hint = "a mesh shows surfaces as they are".to_owned();
        let code = &codes::GLTF_PRIMITIVE_ODD;
        self.report.add_with_hint(code, "", at, message, hint);
        let mesh = splat::mesh(&splats(self.doc, primitive)?);
        if mesh.triangles.is_empty() {
            return None;
        }
        let place = ValuePath::new(
            EntityKind::Mesh,
            self.scene.meshes.len(),
            EntityField::Whole,
        );
        self.source_spans.record(place, self.report.json.span(at));
        self.scene.meshes.push(mesh);
        Some(MeshId(to_u32(self.scene.meshes.len() - 1)))
    }

    /// The material of splats, whose colours are radiance.
    fn splat_material(&mut self) -> MaterialId {
        let next = MaterialId(to_u32(self.scene.materials.len()));
        let id = *self.splats.material.get_or_insert(next);
        if id == next {
            self.scene
                .materials
                .push(Material::Standard(Box::new(Standard {
                    name: "splats".to_owned(),
                    unlit: true,
                    double_sided: true,
                    ..Standard::default()
                })));
        }
        id
    }
}
