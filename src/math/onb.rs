//! An orthonormal basis around one vector.

use super::Vec3;

/// Three unit vectors at right angles, right-handed: `tangent × bitangent = normal`.
#[derive(Clone, Copy, Debug)]
pub struct OrthonormalBasis {
    /// The first.
    pub tangent: Vec3,
    /// The second.
    pub bitangent: Vec3,
    /// The vector the basis was built around.
    pub normal: Vec3,
}

impl OrthonormalBasis {
    /// The basis around a unit vector (Duff et al., "Building an orthonormal basis, revisited",
    /// JCGT 6 (2017)).
    #[must_use]
    pub fn around(n: Vec3) -> Self {
        let sign = 1.0_f64.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            tangent: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            bitangent: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            normal: n,
        }
    }

    /// The vector with the coordinates given along tangent, bitangent and normal.
    #[must_use]
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }
    /// The coordinates of a vector along tangent, bitangent and normal.
    #[must_use]
    pub fn to_local(&self, world: Vec3) -> Vec3 {
        Vec3::new(
            self.tangent.dot(world),
            self.bitangent.dot(world),
            self.normal.dot(world),
        )
    }
}
