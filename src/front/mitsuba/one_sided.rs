//! Area lights of flat shapes emit on the side of the normal: a cover hides the other side.

use super::Lowering;
use super::medium::ShapeMedia;
use super::xml::PluginNode;
use crate::exchange::material::matte;
use crate::exchange::one_sided::{behind, flat_mesh, is_closed};
use crate::exchange::transform::AffineTransform;
use rtc_diag::{Diagnostic, DiagnosticSink, codes};
use rtc_ir::{
    Disc, Ellipsoid, EntityField, EntityKind, LoweredScene, Material, MaterialId, Mesh, Shape,
    Sphere, Surface, ValuePath,
};
use rtc_math::Vec3;
use rtc_source::Span;

/// A surface that emits on one side.
pub(super) struct OneSided {
    /// Its index.
    pub(super) surface: usize,
    /// The material of its back.
    pub(super) back: MaterialId,
    pub(super) to_world: AffineTransform,
    /// Whether its normal is reversed.
    pub(super) is_flipped: bool,
    /// Whether its shape is turned round for that.
    pub(super) is_turned: bool,
    pub(super) span: Span,
}

/// How far the cover of a sphere is from it, over the radius.
const AROUND: f64 = 1e-5;
/// The deepest nesting of what is looked at for the contents of a BSDF.
const MAX_DEPTH: usize = 64;

/// What is inside a BSDF, itself included.
#[derive(Clone, Copy, Default)]
pub(super) struct BsdfContents<'run> {
    /// Whether any part scatters light that comes from behind.
    has_two_sides: bool,
    /// The attribute of meshes that a texture shows.
    pub(super) attribute: Option<&'run str>,
}

impl<'run> Lowering<'run> {
    /// The material of the back of a light: that of its shape without the emission, or black if
    /// its BSDF has one side.
    pub(super) fn back_material(&mut self, shape: &'run PluginNode, flip: bool) -> MaterialId {
        let bsdf = self.bsdf_of(shape);
        let same = bsdf.filter(|node| self.has_two_sides(node));
        if let Some(id) =
            same.and_then(|_| self.material(shape, None, [flip, true], ShapeMedia::default()))
        {
            return id;
        }
        if let Some(id) = self.black {
            return id;
        }
        let material = Material::Standard(Box::new(matte([0.0; 3])));
        let index = self.scene.materials.len();
        self.record(EntityKind::Material, index, shape.span);
        self.scene.materials.push(material);
        *self.black.insert(MaterialId(rtc_math::to_u32(index)))
    }

    /// Whether a BSDF, or one inside it, scatters light that comes from behind.
    pub(super) fn has_two_sides(&mut self, bsdf: &'run PluginNode) -> bool {
        self.contents(bsdf, 0).has_two_sides
    }

    /// What is inside a BSDF or a texture; each is looked at once.
    pub(super) fn contents(&mut self, node: &'run PluginNode, depth: usize) -> BsdfContents<'run> {
        if let Some(known) = self.contents.get(&node.span) {
            return *known;
        }
        if depth >= MAX_DEPTH {
            return BsdfContents::default();
        }
        // What is inside itself ends there.
        self.contents.insert(node.span, BsdfContents::default());
        let has_two_sides = match node.plugin.text.as_str() {
            "twosided" | "dielectric" | "thindielectric" | "roughdielectric" | "null" | "hair"
            | "polarizer" | "circular" | "retarder" | "principledthin" => true,
            "principled" => {
                let has_map = node.child("spec_trans").is_some();
                has_map || node.number("spec_trans").is_some_and(|share| share > 0.0)
            }
            _ => false,
        };
        let attribute = node.string("name").map(|name| name.text.as_str());
        let is_attribute = node.plugin.text == "mesh_attribute";
        let mut contents = BsdfContents {
            has_two_sides,
            attribute: attribute.filter(|_| is_attribute),
        };
        for child in &node.children {
            let Some(child) = self.resolve(child) else {
                continue;
            };
            let inside = self.contents(child, depth + 1);
            contents.has_two_sides |= inside.has_two_sides;
            contents.attribute = contents.attribute.or(inside.attribute);
        }
        self.contents.insert(node.span, contents);
        contents
    }
}

/// Adds a cover behind each flat light, when the meshes are loaded. A light that is neither flat
/// nor closed emits on both sides, with a warning.
pub(super) fn cover_backs(
    lowered: &mut LoweredScene,
    lights: &[OneSided],
    sink: &mut DiagnosticSink,
) {
    for light in lights {
        let Some(surface) = lowered.scene.surfaces.get(light.surface) else {
            continue;
        };
        let cover = match &surface.shape {
            Shape::Disc(disc) => {
                let normal = if light.is_flipped {
                    Vec3::NEG_Z
                } else {
                    Vec3::Z
                };
                let extent = 2.0;
                behind(normal, extent, &light.to_world).map(|by| {
                    let center = Vec3::from_array(disc.center) + by;
                    Shape::Disc(Disc {
                        center: center.to_array(),
                        ..disc.clone()
                    })
                })
            }
            Shape::Instance(instance) => {
                let Some(mesh) = lowered.scene.meshes.get(instance.mesh.0 as usize) else {
                    continue;
                };
                let placed = AffineTransform(instance.world_from_object.map(Vec3::from_array));
                let is_against = light.is_flipped != light.is_turned;
                let back = back_of(mesh, &placed, is_against);
                if back.is_none() && (light.is_flipped || !is_closed(mesh)) {
                    let message = "the light shines from both sides of its shape";
                    let diagnostic = Diagnostic::new(&codes::MITSUBA_APPROXIMATE, message);
                    sink.push(diagnostic.at(light.span, ""));
                }
                back.map(|by| {
                    let moved = AffineTransform::translation(by.to_array()).after(&placed);
                    moved.instance(instance.mesh)
                })
            }
            // The front of these is inside; no camera is inside of one that shines outward.
            Shape::Sphere(sphere) if light.is_flipped => Some(Shape::Sphere(Sphere {
                radius: sphere.radius * (1.0 + AROUND),
                ..sphere.clone()
            })),
            Shape::Ellipsoid(solid) if light.is_flipped => Some(Shape::Ellipsoid(Ellipsoid {
                axes: solid
                    .axes
                    .map(|axis| axis.map(|part| part * (1.0 + AROUND))),
                ..solid.clone()
            })),
            _ => None,
        };
        let Some(shape) = cover else { continue };
        let index = lowered.scene.surfaces.len();
        let path = ValuePath::new(EntityKind::Surface, index, EntityField::Whole);
        lowered.source_spans.record(path, light.span);
        lowered.scene.surfaces.push(Surface::new(shape, light.back));
    }
}

/// The vector to the back of a flat mesh. The side of its vertex normals is the front, or without
/// them that from which its triangles in the world run counterclockwise.
fn back_of(mesh: &Mesh, placed: &AffineTransform, is_flipped: bool) -> Option<Vec3> {
    let (normal, extent) = flat_mesh(mesh)?;
    let is_against = match mesh.normals.is_empty() {
        true => placed.determinant() < 0.0,
        false => {
            let sum: Vec3 = mesh.normals.iter().map(Vec3::from_array).sum();
            sum.dot(normal) < 0.0
        }
    };
    let normal = if is_against == is_flipped {
        normal
    } else {
        -normal
    };
    behind(normal, extent, placed)
}
