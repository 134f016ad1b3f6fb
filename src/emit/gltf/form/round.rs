//! The round shapes: spheres, and surfaces of revolution about +z, of radius and height 1.

use super::ShapeForm;
use super::draft::{DraftVertex, MeshDraft, fraction, turn};
use super::fineness::Fineness;
use glam::{DAffine3, DMat3};
use rtc_ir::{Cone, Cylinder, Disc, Mesh, Paraboloid, Sphere, Torus};
use rtc_math::{Basis, Vec3, length, unit};

/// A round shape of radius 1, and height 1 if it has one, in so many steps around and along; the
/// height is along +z.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum RoundForm {
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

pub(super) fn sphere(sphere: &Sphere, fineness: &Fineness) -> ShapeForm {
    let Sphere {
        center,
        radius,
        texture_from_world,
    } = sphere;
    let along = Fineness::along_sphere(fineness.share(*radius));
    let form = RoundForm::Sphere {
        around: along.saturating_mul(2),
        along,
    };
    // The rows of the rotation into the frame of the texture are the axes of that frame.
    let axes = texture_from_world.unwrap_or([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let axes = axes.map(|axis| Vec3::from_array(axis) * *radius);
    ShapeForm::Round(form, placed(axes, *center))
}

pub(super) fn cylinder(cylinder: &Cylinder, fineness: &Fineness) -> ShapeForm {
    let Cylinder {
        base,
        axis,
        height,
        radius,
    } = cylinder;
    let around = Fineness::around(fineness.share(*radius));
    let up = unit(Vec3::from_array(*axis)).unwrap_or(Vec3::Z) * *height;
    ShapeForm::Round(RoundForm::Cylinder { around }, standing(*base, up, *radius))
}

pub(super) fn cone(cone: &Cone, fineness: &Fineness) -> ShapeForm {
    let Cone { base, up, radius } = cone;
    let around = Fineness::around(fineness.share(*radius));
    let world = standing(*base, Vec3::from_array(*up), *radius);
    ShapeForm::Round(RoundForm::Cone { around }, world)
}

pub(super) fn paraboloid(paraboloid: &Paraboloid, fineness: &Fineness) -> ShapeForm {
    let Paraboloid { base, up, radius } = paraboloid;
    let up = Vec3::from_array(*up);
    // Half of what it may be off is for each direction.
    let share = fineness.share(*radius) / 2.0;
    let form = RoundForm::Paraboloid {
        around: Fineness::around(share),
        along: Fineness::along_parabola(length(up) / radius, share),
    };
    ShapeForm::Round(form, standing(*base, up, *radius))
}

pub(super) fn torus(torus: &Torus, fineness: &Fineness) -> ShapeForm {
    let Torus {
        center,
        axis,
        major,
        minor,
    } = torus;
    // Half of what it may be off is for each direction; without a length, of the tube's radius.
    let share = fineness.share(*minor) / 2.0;
    let form = RoundForm::Torus {
        around: Fineness::around(share * minor / (major + minor)),
        along: Fineness::around(share),
        tube: (minor / major).to_bits(),
    };
    let up = unit(Vec3::from_array(*axis)).unwrap_or(Vec3::Z) * *major;
    ShapeForm::Round(form, standing(*center, up, *major))
}

pub(super) fn disc(disc: &Disc, fineness: &Fineness) -> ShapeForm {
    let Disc {
        center,
        normal,
        radius,
    } = disc;
    let around = Fineness::around(fineness.share(*radius));
    let up = unit(Vec3::from_array(*normal)).unwrap_or(Vec3::Z) * *radius;
    ShapeForm::Round(RoundForm::Disc { around }, standing(*center, up, *radius))
}

/// Where something round stands on a base: +z becomes `up`. The axes around it are those of the
/// texture coordinates.
fn standing(base: [f64; 3], up: Vec3, radius: f64) -> DAffine3 {
    let around = Basis::around(unit(up).unwrap_or(Vec3::Z));
    placed(
        [around.tangent * radius, around.bitangent * radius, up],
        base,
    )
}

fn placed([x, y, z]: [Vec3; 3], origin: [f64; 3]) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_cols(x, y, z), Vec3::from_array(origin))
}

impl RoundForm {
    /// No fewer vertices than its mesh will have while it is made.
    pub(super) fn vertices(self) -> u64 {
        let sheet = |around: u32, along: u32| (u64::from(around) + 1) * (u64::from(along) + 1);
        match self {
            Self::Sphere { around, along } | Self::Torus { around, along, .. } => {
                sheet(around, along)
            }
            Self::Paraboloid { around, along } => sheet(around, along) + sheet(around, 1),
            Self::Cylinder { around } => 3 * sheet(around, 1),
            Self::Cone { around } => 2 * sheet(around, 1),
            Self::Disc { around } => sheet(around, 1),
        }
    }

    /// Its mesh.
    pub(super) fn mesh(self) -> Mesh {
        let mut draft = MeshDraft::default();
        match self {
            Self::Sphere { around, along } => {
                draft.sheet([around, along], |column, row| {
                    ball(column, row, around, along)
                });
            }
            Self::Cylinder { around } => {
                draft.sheet([around, 1], |column, row| {
                    let [cos, sin] = turn(column, around);
                    vertex([cos, sin, f64::from(row)], [cos, sin, 0.0])
                });
                lid(&mut draft, around, 1.0, 1.0);
                lid(&mut draft, around, 0.0, -1.0);
            }
            Self::Cone { around } => {
                draft.sheet([around, 1], |column, row| tip(column, row, around));
                lid(&mut draft, around, 0.0, -1.0);
            }
            Self::Paraboloid { around, along } => {
                draft.sheet([around, along], |column, row| {
                    bowl(column, row, around, along)
                });
                lid(&mut draft, around, 0.0, -1.0);
            }
            Self::Torus {
                around,
                along,
                tube,
            } => {
                let tube = f64::from_bits(tube);
                draft.sheet([around, along], |column, row| {
                    let ([cos, sin], [out, up]) = (turn(column, around), turn(row, along));
                    let far = 1.0 + tube * out;
                    vertex(
                        [far * cos, far * sin, tube * up],
                        [out * cos, out * sin, up],
                    )
                });
            }
            Self::Disc { around } => lid(&mut draft, around, 0.0, 1.0),
        }
        draft.mesh(matches!(
            self,
            Self::Sphere { .. } | Self::Paraboloid { .. }
        ))
    }
}

fn vertex(position: [f64; 3], normal: [f64; 3]) -> DraftVertex {
    DraftVertex {
        position: Vec3::from_array(position),
        normal: Vec3::from_array(normal),
        uv: [0.0; 2],
    }
}

/// A corner of the sphere, rows from +z: u about the axis, v = 1 at +z.
fn ball(column: u32, row: u32, around: u32, along: u32) -> DraftVertex {
    let ([cos, sin], [z, out]) = (turn(column, around), turn(row, 2 * along));
    // Triangles at a pole look at the middle of their side.
    let aside = match row {
        0 => 0.5,
        _ if row == along => -0.5,
        _ => 0.0,
    };
    let u = (f64::from(column) + aside) / f64::from(around);
    let out = if row == along { 0.0 } else { out };
    let point = Vec3::new(out * cos, out * sin, z);
    DraftVertex {
        position: point,
        normal: point,
        uv: [u.clamp(0.0, 1.0), 1.0 - fraction(row, along)],
    }
}

/// A corner of the side of the cone, row 1 at its tip, where normals are those of the sides.
fn tip(column: u32, row: u32, around: u32) -> DraftVertex {
    let [cos, sin] = turn(column, around);
    let (half_cos, half_sin) = if row == 0 {
        (cos, sin)
    } else {
        let [cos, sin] = turn((2 * column).saturating_sub(1), 2 * around);
        (cos, sin)
    };
    let out = f64::from(1 - row);
    vertex(
        [out * cos, out * sin, f64::from(row)],
        [half_cos, half_sin, 1.0],
    )
}

/// A corner of the side of the paraboloid, rows from its vertex; v is the depth below it.
fn bowl(column: u32, row: u32, around: u32, along: u32) -> DraftVertex {
    let ([cos, sin], out) = (turn(column, around), fraction(row, along));
    let aside = if row == 0 { 0.5 } else { 0.0 };
    let u = (f64::from(column) + aside) / f64::from(around);
    DraftVertex {
        position: Vec3::new(out * cos, out * sin, 1.0 - out * out),
        normal: Vec3::new(2.0 * out * cos, 2.0 * out * sin, 1.0),
        uv: [u.min(1.0), out * out],
    }
}

/// Adds a disc of radius 1 at a height, its front up or down; v is the distance from the middle.
fn lid(draft: &mut MeshDraft, around: u32, height: f64, front: f64) {
    draft.sheet([around, 1], |column, row| {
        let ([cos, sin], out) = (turn(column, around), f64::from(row));
        let aside = if row == 0 { 0.5 } else { 0.0 };
        let u = (f64::from(column) + aside) / f64::from(around);
        DraftVertex {
            uv: [u.min(1.0), out],
            ..vertex([out * cos, out * sin, height], [0.0, 0.0, front])
        }
    });
}
