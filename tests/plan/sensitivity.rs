//! Sensitivity: a minimal change of the fact that a rule depends on changes the status and the
//! picture.

use super::scenes::{
    ball, diffuse, disc, first_light, light, material, plane, shiny, square, texture, with,
};
use super::{bits, fate, film, validated};
use rtc::internals::ir::{Mode, Scene};
use rtc::internals::plan::{Effect, EffectState, Plan, Rule, RuleSet};
use rtc::internals::render::Values;

/// A scene in which a rule removes an effect, and a change after which it is needed.
fn turns(effect: Effect, rule: Rule, scene: &Scene, change: impl FnOnce(&mut Scene)) {
    assert_eq!(
        fate(scene, effect),
        (EffectState::Pruned, Some(rule)),
        "before"
    );
    flips(effect, scene, change);
}

/// A scene without an effect, and a change after which it is needed and the picture changes.
fn flips(effect: Effect, scene: &Scene, change: impl FnOnce(&mut Scene)) {
    assert_ne!(fate(scene, effect).0, EffectState::Needed, "before");
    let mut changed = scene.clone();
    change(&mut changed);
    assert_eq!(fate(&changed, effect).0, EffectState::Needed, "after");
    let picture = |scene| bits(&film(&validated(scene), RuleSet::ALL, Values::Linear));
    assert!(
        picture(scene) != picture(&changed),
        "{effect:?}: the change does not show"
    );
}

fn one_ball() -> Scene {
    with(&[(ball([0.0; 3], 1.0), diffuse())])
}

fn two_balls() -> Scene {
    with(&[
        (ball([-1.2, 0.0, 0.0], 1.0), diffuse()),
        (ball([1.2, 0.0, 0.0], 1.0), diffuse()),
    ])
}

#[test]
fn a_little_ks_makes_a_highlight_and_a_mirror() {
    turns(Effect::Highlight, Rule::HighlightKs, &one_ball(), |scene| {
        material(scene, 0).ks = 1e-3
    });
    turns(Effect::Mirror, Rule::MirrorKs, &two_balls(), |scene| {
        material(scene, 0).ks = 1e-3
    });
    turns(Effect::Mirror, Rule::MirrorKs, &two_balls(), |scene| {
        material(scene, 0).kr = Some(1e-3)
    });
}

#[test]
fn a_second_ball_and_a_light_inside_make_shadows() {
    let shadows = |change: &dyn Fn(&mut Scene)| {
        turns(Effect::Shadows, Rule::ShadowConvex, &one_ball(), change)
    };
    shadows(&|scene| {
        *scene = with(&[
            (ball([0.0; 3], 1.0), diffuse()),
            (ball([0.75, 1.0, 3.0], 0.25), diffuse()),
        ])
    });
    // Seen from inside, a sphere occludes the light.
    shadows(&|scene| scene.camera.eye = [0.0, 0.0, 0.9]);
    turns(Effect::Shadows, Rule::ShadowPair, &two_balls(), |scene| {
        first_light(scene).position = [9.0, 0.2, 0.0]
    });
}

/// If one surface may occlude a light, shadow rays still skip all others.
#[test]
fn a_light_is_asked_of_those_alone_that_may_hide_it() {
    let mut scene = with(&[
        (ball([0.0; 3], 1.0), diffuse()),
        (ball([0.75, 1.0, 3.0], 0.25), diffuse()),
        (ball([0.0, -50.0, 0.0], 1.0), diffuse()),
        (plane(-60.0), diffuse()),
        (plane(20.0), diffuse()),
    ]);
    let asked = |scene: &Scene, rules: RuleSet| {
        let plan = Plan::new(&validated(scene), rules);
        let may_occlude = |receiver: usize| {
            let occluders = (0..5).filter(|occluder| {
                plan.lights
                    .first()
                    .unwrap()
                    .may_occlude(*occluder, receiver)
            });
            occluders.collect::<Vec<_>>()
        };
        [0, 3].map(may_occlude)
    };
    assert_eq!(asked(&scene, RuleSet::ALL), [vec![1], vec![0, 1, 2]]);
    let all = vec![0, 1, 2, 3, 4];
    assert_eq!(asked(&scene, RuleSet::NONE), [all.clone(), all.clone()]);
    let alone = RuleSet::ALL.without(Rule::ShadowConvex);
    assert_eq!(asked(&scene, alone), [vec![0, 1], vec![0, 1, 2, 3]]);
    // A light beyond the upper plane.
    first_light(&mut scene).position = [3.0, 44.0, 12.0];
    assert_eq!(asked(&scene, RuleSet::ALL), [vec![4], vec![0, 1, 2, 4]]);
}

#[test]
fn a_plane_between_hides_the_light_and_one_beside_does_not() {
    let far = with(&[
        (ball([0.0; 3], 1.0), diffuse()),
        (ball([0.0, -50.0, 0.0], 1.0), diffuse()),
    ]);
    turns(Effect::Shadows, Rule::ShadowPair, &far, |scene| {
        scene.surfaces[1].shape = plane(2.0)
    });
}

#[test]
fn a_light_shines_as_soon_as_it_has_a_colour_and_stands_in_front() {
    let mut black = one_ball();
    first_light(&mut black).color = [0.0; 3];
    turns(Effect::DirectLight, Rule::LightBlack, &black, |scene| {
        first_light(scene).color = [0.0, 1e-3, 0.0]
    });
    let mut background = with(&[(disc([0.0; 3], 2.0), shiny())]);
    first_light(&mut background).position = [5.0, 0.0, -1e-3];
    turns(
        Effect::DirectLight,
        Rule::LightBehind,
        &background,
        |scene| first_light(scene).position[2] = 1e-3,
    );
    // Without shadows the highlight is visible through the surface.
    turns(
        Effect::DirectLight,
        Rule::LightBehind,
        &background,
        |scene| scene.settings.shadows = false,
    );
    let mut unlit = one_ball();
    material(&mut unlit, 0).kd = 0.0;
    turns(Effect::DirectLight, Rule::LightUnreached, &unlit, |scene| {
        material(scene, 0).kd = 1e-3
    });
}

#[test]
fn a_lens_needs_a_radius_and_samples() {
    let mut lens = one_ball();
    lens.camera.lens.samples = 4;
    turns(Effect::Lens, Rule::Pinhole, &lens, |scene| {
        scene.camera.lens.radius = 1e-3
    });
    lens.camera.lens = rtc::internals::ir::Lens {
        radius: 0.1,
        samples: 1,
    };
    turns(Effect::Lens, Rule::Pinhole, &lens, |scene| {
        scene.camera.lens.samples = 2
    });
}

#[test]
fn a_soft_light_needs_a_radius_and_samples() {
    let mut soft = one_ball();
    soft.settings.light_samples = 3;
    flips(Effect::SoftLight, &soft, |scene| {
        first_light(scene).radius = 1e-3
    });
    (soft.settings.light_samples, first_light(&mut soft).radius) = (1, 0.5);
    turns(Effect::SoftLight, Rule::SoftPoint, &soft, |scene| {
        scene.settings.light_samples = 2
    });
}

#[test]
fn one_texel_makes_a_texture() {
    let mut scene = one_ball();
    material(&mut scene, 0).color_map = Some(texture(&mut scene, [7, 8, 9], [7, 8, 9]));
    turns(Effect::Textures, Rule::TextureConstant, &scene, |scene| {
        scene.images.clear();
        scene.textures.clear();
        texture(scene, [7, 8, 9], [7, 8, 10]);
    });
    scene.settings.mode = Mode::Normal;
    assert_eq!(
        fate(&scene, Effect::Textures),
        (EffectState::Pruned, Some(Rule::Mode))
    );
}

#[test]
fn one_corner_makes_normals_worth_interpolating() {
    let (up, tilted) = ([0.0, 0.0, 1.0], [1e-3, 0.0, 1.0]);
    let mut scene = with(&[(ball([3.0, 0.0, 0.0], 0.5), diffuse())]);
    square(&mut scene, [up; 4]);
    let lean =
        |scene: &mut Scene| scene.meshes[0].normals = [up, tilted, up, up].into_iter().collect();
    turns(Effect::NormalInterpolation, Rule::NormalFlat, &scene, lean);
    lean(&mut scene);
    scene.lights.clear();
    assert_eq!(
        fate(&scene, Effect::NormalInterpolation),
        (EffectState::Pruned, Some(Rule::NormalFlat))
    );
}

#[test]
fn a_mirror_shows_what_is_before_it_and_nothing_background() {
    let background = with(&[
        (disc([0.0; 3], 2.0), shiny()),
        (ball([0.0, 0.0, -4.0], 1.0), diffuse()),
    ]);
    let before = |scene: &mut Scene| scene.surfaces[1].shape = ball([0.0, 0.0, 4.0], 1.0);
    turns(Effect::Mirror, Rule::MirrorUnreached, &background, before);
    let alone = with(&[(ball([0.0; 3], 1.0), shiny())]);
    let torus = |scene: &mut Scene| {
        let (center, axis) = ([0.0; 3], [0.0, 0.0, 1.0]);
        scene.surfaces[0].shape = rtc::internals::ir::Shape::Torus(rtc::internals::ir::Torus {
            center,
            axis,
            major: 1.0,
            minor: 0.5,
        });
    };
    turns(Effect::Mirror, Rule::MirrorConvex, &alone, torus);
    let mut shallow = with(&[
        (ball([-1.2, 0.0, 0.0], 1.0), shiny()),
        (ball([1.2, 0.0, 0.0], 1.0), shiny()),
    ]);
    shallow.settings.max_depth = 0;
    turns(Effect::Mirror, Rule::MirrorDepth, &shallow, |scene| {
        scene.settings.max_depth = 1
    });
}

#[test]
fn what_lets_light_through_refracts() {
    flips(Effect::Refraction, &two_balls(), |scene| {
        material(scene, 0).kt = 1e-3
    });
    let mut glossy = two_balls();
    material(&mut glossy, 0).glossy_samples = 3;
    flips(Effect::GlossyReflection, &glossy, |scene| {
        material(scene, 0).ks = 1e-3
    });
}

#[test]
fn samples_of_a_pixel_are_needed_as_soon_as_there_are_two() {
    flips(Effect::Supersampling, &one_ball(), |scene| {
        scene.settings.supersampling = 2
    });
}

#[test]
fn a_ball_that_comes_into_view_brings_what_it_needs() {
    let aside = with(&[
        (ball([0.0; 3], 1.0), diffuse()),
        (ball([40.0, 0.0, 0.0], 1.0), shiny()),
    ]);
    turns(Effect::Highlight, Rule::Cull, &aside, |scene| {
        scene.surfaces[1].shape = ball([3.0, 0.0, 0.0], 1.0)
    });
    let background = with(&[(ball([0.0, 0.0, 14.0], 1.0), diffuse())]);
    turns(Effect::Surfaces, Rule::Cull, &background, |scene| {
        scene.surfaces[0].shape = ball([0.0, 0.0, 4.0], 1.0)
    });
}

#[test]
fn a_second_light_behind_the_disc_is_left_out_alone() {
    let mut scene = with(&[(disc([0.0; 3], 2.0), diffuse())]);
    scene.lights.push(light([0.0, 0.0, -3.0]));
    let plan = rtc::internals::plan::Plan::new(&validated(&scene), RuleSet::ALL);
    let [lit, behind] = &*plan.lights else {
        panic!("two lights")
    };
    assert_eq!([lit.direct, behind.direct], [true, false]);
    assert!(behind.is_used, "its ambient term stays");
}
