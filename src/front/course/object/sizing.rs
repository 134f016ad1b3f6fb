//! Sizes of meshes that depend on the bounds of the mesh in its file.

use super::mesh::TRANSFORM;
use rtc_diag::{Diagnostic, DiagnosticSink, Severity, codes};
use rtc_ir::{self as ir, EntityField, EntityKind, LoweredScene, ValuePath};
use rtc_math::{Vec3, shortest};
use rtc_source::Span;

/// A change of the size of a mesh instance, applied after its file is loaded.
#[derive(Clone, Copy, Debug)]
pub(crate) enum MeshSizing {
    /// Scale the mesh to the size in the transform of this surface.
    Fit(usize),
    /// Keep this surface, which is scaled by this factor, unless it fills the view.
    Check(usize, f64),
}

/// Applies the sizing of a mesh instance; its mesh is loaded.
pub(crate) fn apply(sizing: MeshSizing, lowered: &mut LoweredScene, sink: &mut DiagnosticSink) {
    // The instance and the bounds of its mesh.
    let (surface, factor_of) = match sizing {
        MeshSizing::Fit(surface) => (surface, None),
        MeshSizing::Check(surface, size) => (surface, Some(size)),
    };
    let LoweredScene {
        scene,
        source_spans,
    } = lowered;
    let Some(ir::Surface {
        shape: ir::Shape::Instance(instance),
        ..
    }) = scene.surfaces.get_mut(surface)
    else {
        return;
    };
    let Some(mesh) = scene.meshes.get(instance.mesh.0 as usize) else {
        return;
    };
    let corners = mesh.positions.iter().map(Vec3::from_array);
    let bounds = corners.map(|p| (p, p));
    let Some((min, max)) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))) else {
        return;
    };
    // A factor is kept unless the mesh would fill the view.
    if let Some(size) = factor_of {
        let transform = EntityField::of_shape(ir::ShapeKind::Instance, TRANSFORM);
        let span = source_spans.span(ValuePath::new(EntityKind::Surface, surface, transform));
        if !hides_view(
            transformed_box(instance.world_from_object, [min, max]),
            &scene.camera,
        ) {
            sink.push(report_size_as_factor(size, span));
            return;
        }
        let half = size / SIZE_PER_FIT;
        sink.push(report_size_as_fit(size, half, span));
        let [axes @ .., position] = instance.world_from_object;
        let [x, y, z] = axes.map(|axis| (Vec3::from_array(axis) / SIZE_PER_FIT).to_array());
        instance.world_from_object = [x, y, z, position];
    }
    // Scale and move the mesh.
    fit(instance, [min, max]);
}

/// The `size` that equals a `fit` of 1, if it is not a factor.
const SIZE_PER_FIT: f64 = 1.5;

/// The axis-aligned bounding box of a transformed box.
fn transformed_box(transform: [[f64; 3]; 4], ends: [Vec3; 2]) -> [Vec3; 2] {
    let [x, y, z, origin] = transform.map(Vec3::from_array);
    let corners = (0..8_usize).map(|index| {
        let of = |axis: usize| ends[(index >> axis) & 1][axis];
        origin + x * of(0) + y * of(1) + z * of(2)
    });
    let first = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    corners.fold(first, |[min, max], p| [min.min(p), max.max(p)])
}

/// Whether the eye is in a box, or the box fills the view. A box is convex, so it fills the view if
/// all corners of the image see it.
fn hides_view([a, b]: [Vec3; 2], camera: &ir::Camera) -> bool {
    let ir::Camera {
        eye,
        center,
        right,
        up,
        size,
        ..
    } = camera;
    let [eye, center, right, up] = [eye, center, right, up].map(|v| Vec3::from_array(*v));
    let (min, max) = (a.min(b), a.max(b));
    let [x, y] = size.map(|side| f64::from(side) / 2.0);
    let corners = [[-x, -y], [x, -y], [-x, y], [x, y]];
    let is_inside = eye.clamp(min, max) == eye;
    is_inside
        || corners.iter().all(|[x, y]| {
            let direction = center + right * *x + up * *y - eye;
            let (to_low, to_high) = ((min - eye) / direction, (max - eye) / direction);
            let (enter, leave) = (to_low.min(to_high), to_low.max(to_high));
            leave.min_element() >= enter.max_element().max(0.0)
        })
}

fn report_size_as_factor(size: f64, span: Option<Span>) -> Diagnostic {
    let message = format!(
        "the `size` of a mesh is a factor, as in `scale: {}`",
        shortest(size)
    );
    Diagnostic::new(&codes::KEY_READ_DIFFERENTLY, message)
        .severity(Severity::Note)
        .at(span, "times as large as in its file")
        .hint("in some programs it is the size of the mesh; that is written `fit`")
}

fn report_size_as_fit(size: f64, half: f64, span: Option<Span>) -> Diagnostic {
    let (size, half) = (shortest(size), shortest(half));
    let message =
        format!("`size: {size}` scales the mesh to a size of {size}, not by a factor of {size}");
    Diagnostic::new(&codes::KEY_READ_DIFFERENTLY, message)
        .at(span, "as a factor it would hide the view")
        .hint(format!(
            "`fit: {half}` is the size that is shown, `scale: {size}` the factor"
        ))
}

/// Scales a mesh of these bounds to the size in the transform of the instance, and moves its middle
/// to the position there.
fn fit(instance: &mut ir::Instance, [min, max]: [Vec3; 2]) {
    let half = ((max - min) / 2.0).max_element();
    if half > 0.0 {
        let [x, y, z, middle] = instance.world_from_object.map(Vec3::from_array);
        let axes = [x, y, z].map(|axis| axis / half);
        let center = (min + max) / 2.0;
        let origin = middle - (axes[0] * center.x + axes[1] * center.y + axes[2] * center.z);
        instance.world_from_object =
            [axes[0], axes[1], axes[2], origin].map(|column| column.to_array());
    }
}
