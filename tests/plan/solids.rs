//! Constant textures on solids, of which some parts have texture coordinates and others have none:
//! what is folded for one part is not folded for another.

use super::path_materials::FIRST;
use super::path_rules::{traced, white};
use super::scenes::{diffuse, texture, with};
use super::{bits, film, validated};
use rtc::internals::ir::{
    self, Alpha, Bump, Csg, Phong, Scene, SetStep, Shape, Solid, Standard, TextureId,
};
use rtc::internals::plan::{
    Effect, EffectState, MapPresence, Plan, Rule, RuleSet, UvCoverage, hidden_maps,
};
use rtc::internals::render::Values;
use rtc::internals::valid::{TextureId as ValidTextureId, UvSet};

const AXIS: [f64; 3] = [0.5, 1.0, 0.25];

/// An operand of each kind, all around one point.
pub(super) fn operands([x, y, z]: [f64; 3]) -> [Solid; 8] {
    let (center, base) = ([x, y, z], [x - 0.5, y - 1.0, z - 0.25]);
    [
        Solid::Sphere(ir::Sphere {
            center,
            radius: 1.5,
            texture_from_world: None,
        }),
        Solid::Plane(ir::Plane {
            center,
            normal: AXIS,
        }),
        Solid::Cylinder(ir::Cylinder {
            base,
            axis: AXIS,
            height: 2.0,
            radius: 1.25,
        }),
        Solid::Cone(ir::Cone {
            base,
            up: AXIS.map(|component| 2.0 * component),
            radius: 1.5,
        }),
        Solid::Paraboloid(ir::Paraboloid {
            base,
            up: AXIS.map(|component| 2.0 * component),
            radius: 1.5,
        }),
        Solid::Torus(ir::Torus {
            center,
            axis: AXIS,
            major: 1.25,
            minor: 0.5,
        }),
        Solid::Ellipsoid(ir::Ellipsoid {
            center,
            axes: [[1.75, 0.0, 0.0], [0.0, 1.0, 0.5], [0.0, -0.5, 1.25]],
        }),
        Solid::InfiniteCylinder(ir::InfiniteCylinder {
            center,
            axis: [0.0, 0.25, 1.0],
            radius: 0.75,
        }),
    ]
}

/// The operands that have texture coordinates.
const TEXTURED: [usize; 3] = [0, 4, 6];

fn solid([a, b]: [usize; 2], step: SetStep, faces: &[u32]) -> Shape {
    let near = operands([0.25, 0.5, 0.75]);
    Shape::Csg(Csg {
        operands: vec![operands([0.0; 3])[a].clone(), near[b].clone()],
        steps: vec![SetStep::Operand, SetStep::Operand, step],
        faces: faces.to_vec(),
    })
}

/// A shape whose maps have one value: by the Whitted integrator, and by that of paths.
fn scenes(shape: &Shape) -> [Scene; 2] {
    let map = TextureId(0);
    let bump = Bump {
        texture: map,
        height: 0.5,
    };
    let phong = Phong {
        ks: 0.5,
        color_map: Some(map),
        specular_map: Some(map),
        normal_map: Some(map),
        bump: Some(bump),
        ..diffuse()
    };
    let standard = Standard {
        base_color_map: Some(FIRST),
        metallic: 0.5,
        metallic_roughness_map: Some(FIRST),
        normal_map: Some(FIRST),
        alpha: Alpha::Blend,
        opacity_map: Some(FIRST),
        emissive: [0.25; 3],
        emissive_map: Some(FIRST),
        ..white()
    };
    let mut scenes = [
        with(&[(shape.clone(), phong)]),
        traced(&[(shape.clone(), standard)]),
    ];
    for scene in &mut scenes {
        texture(scene, [200, 40, 90], [200, 40, 90]);
        scene.camera.size = [12, 10];
        scene.camera.right[0] = 0.05;
        scene.camera.up[1] = 0.05;
    }
    scenes
}

#[test]
fn a_constant_texture_on_any_two_operands_changes_no_bit() {
    for (a, b) in (0..8).flat_map(|a| (0..8).map(move |b| (a, b))) {
        for step in [SetStep::Difference, SetStep::Intersection] {
            for scene in scenes(&solid([a, b], step, &[0, 1])) {
                let scene = validated(&scene);
                let [pruned, unpruned] = [RuleSet::ALL, RuleSet::NONE]
                    .map(|rules| bits(&film(&scene, rules, Values::Linear)));
                assert!(pruned == unpruned, "{a} {step:?} {b}");
            }
        }
    }
}

#[test]
fn a_solid_shows_a_map_on_the_operands_with_texture_coordinates_that_bound_it() {
    for (a, b) in (0..8).flat_map(|a| (0..8).map(move |b| (a, b))) {
        for faces in [&[0][..], &[1], &[0, 1]] {
            let [whitted, paths] = scenes(&solid([a, b], SetStep::Union, faces));
            let shows = |face: &u32| TEXTURED.contains(&[a, b][*face as usize]);
            let (any, all) = (faces.iter().any(shows), faces.iter().all(shows));
            for scene in [whitted, paths] {
                let scene = validated(&scene);
                let coverage = UvCoverage::of(&scene.surfaces()[0].shape, &scene);
                let texture = ValidTextureId::new(0);
                let presence = coverage.presence(&scene, texture, UvSet::First);
                assert_eq!(presence != MapPresence::Never, any, "{a}, {b}: {faces:?}");
                let is_everywhere = matches!(presence, MapPresence::Everywhere(_));
                assert_eq!(is_everywhere, all, "{a}, {b}: {faces:?}");
                let second = coverage.presence(&scene, texture, UvSet::Second);
                assert_eq!(second, MapPresence::Never);
                let told: Vec<_> = hidden_maps(&scene)
                    .iter()
                    .map(|map| map.is_partial)
                    .collect();
                let expected = if all { vec![] } else { vec![any] };
                assert_eq!(told, expected, "{a}, {b}: {faces:?}");
            }
        }
    }
}

#[test]
fn a_constant_texture_is_folded_where_all_parts_show_it_and_looked_up_where_some_do() {
    let textures = |operands| {
        let [mut scene, _] = scenes(&solid(operands, SetStep::Union, &[0, 1]));
        let phong = scene.materials[0].phong_mut().unwrap();
        (phong.normal_map, phong.bump) = (None, None);
        let plan = Plan::new(&validated(&scene), RuleSet::ALL);
        let status = super::status(&plan, Effect::Textures);
        (status.state, status.rule)
    };
    assert_eq!(
        textures([0, 4]),
        (EffectState::Pruned, Some(Rule::TextureConstant))
    );
    assert_eq!(textures([0, 2]), (EffectState::Needed, None));
    assert_eq!(
        textures([3, 2]),
        (EffectState::Pruned, Some(Rule::TextureUnseen))
    );
}
