//! Materials as a world uses them: a map that shows one value gives way to the value, where the
//! surface has uv to look it up by.

use crate::plan::Plan;
use crate::valid::{Maps, Phong, Proof};

/// The materials of a scene, and after them those of surfaces whose maps gave way.
pub(in crate::render) struct Materials<'plan> {
    pub(in crate::render) all: Vec<Phong>,
    plan: &'plan Plan,
    /// Per material of the scene, the index of it with values for maps.
    simple: Vec<Option<usize>>,
}

impl<'plan> Materials<'plan> {
    pub(in crate::render) fn new(scene: &Proof, plan: &'plan Plan) -> Self {
        Self {
            all: scene.materials().to_vec(),
            plan,
            simple: vec![None; scene.materials().len()],
        }
    }

    /// The index of the material that stands for one of the scene.
    pub(in crate::render) fn of(&mut self, material: usize, has_uv: bool) -> usize {
        if let Some(simple) = self.simple[material].filter(|_| has_uv) {
            return simple;
        }
        match self.simplified(&self.all[material]).filter(|_| has_uv) {
            Some(phong) => {
                self.all.push(phong);
                *self.simple[material].insert(self.all.len() - 1)
            }
            None => material,
        }
    }

    /// The material with values for maps that show one, if it has such.
    fn simplified(&self, material: &Phong) -> Option<Phong> {
        let Maps {
            color,
            specular,
            normal,
            bump,
        } = **material.maps.as_ref()?;
        let value = |map: Option<usize>| map.and_then(|map| self.plan.constants[map]);
        let (new_color, scale) = (value(color), value(specular));
        if new_color.is_none() && scale.is_none() {
            return None;
        }
        let rest = Maps {
            color: color.filter(|_| new_color.is_none()),
            specular: specular.filter(|_| scale.is_none()),
            normal,
            bump,
        };
        let is_empty =
            rest.color.is_none() && rest.specular.is_none() && normal.is_none() && bump.is_none();
        let ks = scale.map_or(material.ks, |scale| material.ks.times(scale.x));
        let maps = (!is_empty).then(|| Box::new(rest));
        Some(Phong {
            color: new_color.unwrap_or(material.color),
            ks,
            maps,
            ..material.clone()
        })
    }
}
