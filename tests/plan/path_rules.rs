//! Each rule for paths by two scenes: one where it holds, and one as near to it as can be where it
//! does not. The first is told so, the second is not, and the picture of neither changes a bit.

use super::proven;
use super::stage::{ball, stage};
use super::told::{difference, film};
use rtc::ir::{Alpha, Material, MaterialId, Mode, PathSettings, Scene, Shape, Standard, Surface};
use rtc::plan::{Plan, Rule, Rules};

/// White without reflection, seen from both sides.
fn white() -> Standard {
    Standard {
        metallic: 0.0,
        specular: 0.0,
        double_sided: true,
        ..Standard::default()
    }
}

/// A stage whose paths are traced, with surfaces of glTF materials.
fn traced(surfaces: &[(Shape, Standard)]) -> Scene {
    let mut scene = stage();
    scene.settings.mode = Mode::Path(PathSettings {
        samples: 4,
        multiple_scattering: false,
    });
    for (index, (shape, material)) in (0..).zip(surfaces) {
        let (shape, material) = (shape.clone(), Box::new(material.clone()));
        scene.materials.push(Material::Standard(material));
        scene.surfaces.push(Surface {
            shape,
            material: MaterialId(index),
        });
    }
    scene
}

/// Whether a rule removes an effect from a scene. The picture by it, and by all rules, keeps its
/// bits in any case.
fn fires(rule: Rule, scene: &Scene) -> bool {
    let proof = proven(scene);
    let unpruned = film(&proof, Rules::NONE);
    for rules in [Rules::NONE.with(rule), Rules::ALL] {
        assert_eq!(difference(&proof, &unpruned, rules), None, "{rule:?}");
    }
    let plan = Plan::new(&proof, Rules::ALL);
    plan.verdicts
        .iter()
        .any(|verdict| verdict.rule == Some(rule))
}

#[test]
fn a_solid_alone_casts_no_shadow_unless_rays_get_inside() {
    let alone = |material: Standard| traced(&[(ball([0.0; 3], 1.0), material)]);
    let fires = |material: Standard| fires(Rule::PathShadowAlone, &alone(material));
    assert!(fires(white()));
    let half = [1.0, 1.0, 1.0, 0.5];
    for alpha in [Alpha::Blend, Alpha::Mask(0.7)] {
        let base_color = half;
        assert!(!fires(Standard {
            base_color,
            alpha,
            ..white()
        }));
    }
    let opaque = Alpha::Opaque;
    assert!(fires(Standard {
        base_color: half,
        alpha: opaque,
        ..white()
    }));
}
