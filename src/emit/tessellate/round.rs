//! Tessellates round shapes: spheres, and surfaces of revolution about +z of radius and height 1.

use super::ShapeMesh;
use super::builder::{GridVertex, MeshBuilder, circle_point, fraction};
use super::tolerance::TessellationTolerance;
use glam::{DAffine3, DMat3};
use rtc_ir::{Cone, Cylinder, Disc, Ellipsoid, Mesh, Paraboloid, Sphere, Torus};
use rtc_math::{OrthonormalBasis, Vec3, length, unit};

/// A round shape of radius 1 (and height 1 along +z) with its numbers of steps around and along the
/// axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum UnitRoundShape {
    /// With its poles at ±z.
    Sphere {
        around: u32,
        along: u32,
    },
    Cylinder {
        around: u32,
    },
    Cone {
        around: u32,
    },
    Paraboloid {
        around: u32,
        along: u32,
    },
    /// With the bits of the radius of its tube.
    Torus {
        around: u32,
        along: u32,
        tube: u64,
    },
    Disc {
        around: u32,
    },
}

pub(super) fn sphere(sphere: &Sphere, tessellation: &TessellationTolerance) -> ShapeMesh {
    let Sphere {
        center,
        radius,
        texture_from_world,
    } = sphere;
    let unit_shape = unit_sphere(*radius, tessellation);
    // The rows of the rotation into texture coordinates are the axes of the texture frame.
    let axes = texture_from_world.unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let axes = axes.map(|axis| Vec3::from_array(axis) * *radius);
    ShapeMesh::Round(unit_shape, placed(axes, *center))
}

pub(super) fn ellipsoid(ellipsoid: &Ellipsoid, tessellation: &TessellationTolerance) -> ShapeMesh {
    let Ellipsoid { center, axes } = ellipsoid;
    let axes = axes.map(Vec3::from_array);
    let longest = axes.iter().fold(0.0, |most, axis| length(*axis).max(most));
    ShapeMesh::Round(unit_sphere(longest, tessellation), placed(axes, *center))
}

/// The unit sphere, for a sphere of this radius.
fn unit_sphere(radius: f64, tessellation: &TessellationTolerance) -> UnitRoundShape {
    let along = TessellationTolerance::along_sphere(tessellation.fraction(radius));
    UnitRoundShape::Sphere {
        around: along.saturating_mul(2),
        along,
    }
}

pub(super) fn cylinder(cylinder: &Cylinder, tessellation: &TessellationTolerance) -> ShapeMesh {
    let Cylinder {
        base,
        axis,
        height,
        radius,
    } = cylinder;
    let around = TessellationTolerance::around(tessellation.fraction(*radius));
    let up = unit(Vec3::from_array(*axis)).unwrap_or(Vec3::Z) * *height;
    ShapeMesh::Round(
        UnitRoundShape::Cylinder { around },
        on_base(*base, up, *radius),
    )
}

pub(super) fn cone(cone: &Cone, tessellation: &TessellationTolerance) -> ShapeMesh {
    let Cone { base, up, radius } = cone;
    let around = TessellationTolerance::around(tessellation.fraction(*radius));
    let world = on_base(*base, Vec3::from_array(*up), *radius);
    ShapeMesh::Round(UnitRoundShape::Cone { around }, world)
}

pub(super) fn paraboloid(
    paraboloid: &Paraboloid,
    tessellation: &TessellationTolerance,
) -> ShapeMesh {
    let Paraboloid { base, up, radius } = paraboloid;
    let up = Vec3::from_array(*up);
    // Half of the tolerance for each direction.
    let fraction = tessellation.fraction(*radius) / 2.0;
    let unit_shape = UnitRoundShape::Paraboloid {
        around: TessellationTolerance::around(fraction),
        along: TessellationTolerance::along_parabola(length(up) / radius, fraction),
    };
    ShapeMesh::Round(unit_shape, on_base(*base, up, *radius))
}

pub(super) fn torus(torus: &Torus, tessellation: &TessellationTolerance) -> ShapeMesh {
    let Torus {
        center,
        axis,
        major,
        minor,
    } = torus;
    // Half of the tolerance for each direction; the default tolerance is relative to the radius of
    // the tube.
    let fraction = tessellation.fraction(*minor) / 2.0;
    let unit_shape = UnitRoundShape::Torus {
        around: TessellationTolerance::around(fraction * minor / (major + minor)),
        along: TessellationTolerance::around(fraction),
        tube: (minor / major).to_bits(),
    };
    let up = unit(Vec3::from_array(*axis)).unwrap_or(Vec3::Z) * *major;
    ShapeMesh::Round(unit_shape, on_base(*center, up, *major))
}

pub(super) fn disc(disc: &Disc, tessellation: &TessellationTolerance) -> ShapeMesh {
    let Disc {
        center,
        normal,
        radius,
    } = disc;
    let around = TessellationTolerance::around(tessellation.fraction(*radius));
    let up = unit(Vec3::from_array(*normal)).unwrap_or(Vec3::Z) * *radius;
    ShapeMesh::Round(
        UnitRoundShape::Disc { around },
        on_base(*center, up, *radius),
    )
}

/// The transform of a round shape on a base: +z is mapped to `up`. The perpendicular axes are those
/// of the texture coordinates.
fn on_base(base: [f64; 3], up: Vec3, radius: f64) -> DAffine3 {
    let around = OrthonormalBasis::around(unit(up).unwrap_or(Vec3::Z));
    placed(
        [around.tangent * radius, around.bitangent * radius, up],
        base,
    )
}

fn placed([x, y, z]: [Vec3; 3], origin: [f64; 3]) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), Vec3::from_array(origin))
}

impl UnitRoundShape {
    /// An upper bound of the number of vertices while its mesh is built.
    pub(super) fn vertices(self) -> u64 {
        let grid = |around: u32, along: u32| (u64::from(around) + 1) * (u64::from(along) + 1);
        match self {
            Self::Sphere { around, along } | Self::Torus { around, along, .. } => {
                grid(around, along)
            }
            Self::Paraboloid { around, along } => grid(around, along) + grid(around, 1),
            Self::Cylinder { around } => 3 * grid(around, 1),
            Self::Cone { around } => 2 * grid(around, 1),
            Self::Disc { around } => grid(around, 1),
        }
    }

    /// Its mesh.
    pub(super) fn mesh(self) -> Mesh {
        // Side and caps of each shape.
        let mut builder = MeshBuilder::default();
        match self {
            Self::Sphere { around, along } => {
                builder.grid([around, along], |column, row| {
                    sphere_vertex(column, row, around, along)
                });
            }
            Self::Cylinder { around } => {
                builder.grid([around, 1], |column, row| {
                    let [cos, sin] = circle_point(column, around);
                    vertex([cos, sin, f64::from(row)], [cos, sin, 0.0])
                });
                cap(&mut builder, around, 1.0, 1.0);
                cap(&mut builder, around, 0.0, -1.0);
            }
            Self::Cone { around } => {
                builder.grid([around, 1], |column, row| cone_vertex(column, row, around));
                cap(&mut builder, around, 0.0, -1.0);
            }
            Self::Paraboloid { around, along } => {
                builder.grid([around, along], |column, row| {
                    paraboloid_vertex(column, row, around, along)
                });
                cap(&mut builder, around, 0.0, -1.0);
            }
            Self::Torus {
                around,
                along,
                tube,
            } => {
                let tube = f64::from_bits(tube);
                builder.grid([around, along], |column, row| {
                    let ([cos, sin], [out, up]) =
                        (circle_point(column, around), circle_point(row, along));
                    let far = 1.0 + tube * out;
                    vertex(
                        [far * cos, far * sin, tube * up],
                        [out * cos, out * sin, up],
                    )
                });
            }
            Self::Disc { around } => cap(&mut builder, around, 0.0, 1.0),
        }
        builder.mesh(matches!(
            self,
            Self::Sphere { .. } | Self::Paraboloid { .. }
        ))
    }
}

fn vertex(position: [f64; 3], normal: [f64; 3]) -> GridVertex {
    GridVertex {
        position: Vec3::from_array(position),
        normal: Vec3::from_array(normal),
        uv: [0.0; 2],
    }
}

/// A vertex of the sphere, rows from +z: u around the axis, v = 1 at +z.
fn sphere_vertex(column: u32, row: u32, around: u32, along: u32) -> GridVertex {
    let ([cos, sin], [z, out]) = (circle_point(column, around), circle_point(row, 2 * along));
    // At a pole, u is that of the middle of the opposite side.
    let aside = match row {
        0 => 0.5,
        _ if row == along => -0.5,
        _ => 0.0,
    };
    let u = (f64::from(column) + aside) / f64::from(around);
    let out = if row == along { 0.0 } else { out };
    let point = Vec3::new(out * cos, out * sin, z);
    GridVertex {
        position: point,
        normal: point,
        uv: [u.clamp(0.0, 1.0), 1.0 - fraction(row, along)],
    }
}

/// A vertex of the side of the cone, row 1 at its apex, where the normals are those of the side.
fn cone_vertex(column: u32, row: u32, around: u32) -> GridVertex {
    let [cos, sin] = circle_point(column, around);
    let (half_cos, half_sin) = if row == 0 {
        (cos, sin)
    } else {
        let [cos, sin] = circle_point((2 * column).saturating_sub(1), 2 * around);
        (cos, sin)
    };
    let out = f64::from(1 - row);
    vertex(
        [out * cos, out * sin, f64::from(row)],
        [half_cos, half_sin, 1.0],
    )
}

/// A vertex of the side of the paraboloid, rows from its vertex; v is the depth below it.
fn paraboloid_vertex(column: u32, row: u32, around: u32, along: u32) -> GridVertex {
    let ([cos, sin], out) = (circle_point(column, around), fraction(row, along));
    let aside = if row == 0 { 0.5 } else { 0.0 };
    let u = (f64::from(column) + aside) / f64::from(around);
    GridVertex {
        position: Vec3::new(out * cos, out * sin, 1.0 - out * out),
        normal: Vec3::new(2.0 * out * cos, 2.0 * out * sin, 1.0),
        uv: [u.min(1.0), out * out],
    }
}

/// Adds a disc of radius 1 at a height, facing up or down; v is the distance from the centre.
fn cap(builder: &mut MeshBuilder, around: u32, height: f64, front: f64) {
    builder.grid([around, 1], |column, row| {
        let ([cos, sin], out) = (circle_point(column, around), f64::from(row));
        let aside = if row == 0 { 0.5 } else { 0.0 };
        let u = (f64::from(column) + aside) / f64::from(around);
        GridVertex {
            uv: [u.min(1.0), out],
            ..vertex([out * cos, out * sin, height], [0.0, 0.0, front])
        }
    });
}
