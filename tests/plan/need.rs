//! No false need: an effect that a scene clearly does not need is removed in every formulation.

use super::fate;
use super::scenes::{
    ball, base_scene, diffuse, disc, first_light, material, plane, shiny, texture, with,
};
use rtc::internals::diag::DiagnosticSink;
use rtc::internals::ir::{Bump, LoweredScene, Mode, Scene, SourceSpans};
use rtc::internals::pipeline::{self, Options};
use rtc::internals::plan::{Effect, EffectState, PixelClass, Plan, Rule, RuleSet};

fn is_not_needed(effect: Effect, ways: &[(&str, Scene)]) {
    assert!(ways.len() >= 3);
    for (way, scene) in ways {
        assert_ne!(
            fate(scene, effect).0,
            EffectState::Needed,
            "{effect:?}: {way}"
        );
    }
}

fn changed(scene: &Scene, change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = scene.clone();
    change(&mut scene);
    scene
}

/// A shiny ball before a shiny wall.
fn busy() -> Scene {
    let surfaces = [
        (ball([0.0, 0.0, 3.0], 1.0), shiny()),
        (disc([0.0; 3], 4.0), shiny()),
    ];
    changed(&with(&surfaces), |scene| {
        (scene.settings.supersampling, scene.settings.light_samples) = (2, 4)
    })
}

fn all(scene: &mut Scene, change: impl Fn(&mut rtc::internals::ir::Phong)) {
    (0..scene.materials.len()).for_each(|index| change(material(scene, index)));
}

#[test]
fn highlights() {
    let black = |scene: &mut Scene| first_light(scene).color = [0.0; 3];
    let unseen = |scene: &mut Scene| {
        all(scene, |phong| phong.ks = 0.0);
        material(scene, 1).ks = 1.0;
        scene.surfaces[1].shape = ball([90.0, 0.0, 0.0], 1.0);
    };
    is_not_needed(
        Effect::Highlight,
        &[
            (
                "ks is 0",
                changed(&busy(), |scene| all(scene, |phong| phong.ks = 0.0)),
            ),
            ("the light is black", changed(&busy(), black)),
            ("no light", changed(&busy(), |scene| scene.lights.clear())),
            (
                "a depth buffer",
                changed(&busy(), |scene| scene.settings.mode = Mode::Depth),
            ),
            ("out of sight", changed(&busy(), unseen)),
        ],
    );
}

#[test]
fn mirrors() {
    let aside = |scene: &mut Scene| {
        material(scene, 0).ks = 0.0;
        scene.surfaces[1].shape = disc([0.0, 0.0, 20.0], 1.0);
    };
    let nothing_before = |scene: &mut Scene| {
        material(scene, 0).ks = 0.0;
        scene.surfaces[0].shape = ball([2.0, 0.0, -3.0], 1.0);
    };
    is_not_needed(
        Effect::Mirror,
        &[
            (
                "ks is 0",
                changed(&busy(), |scene| all(scene, |phong| phong.ks = 0.0)),
            ),
            (
                "kr is 0",
                changed(&busy(), |scene| all(scene, |phong| phong.kr = Some(0.0))),
            ),
            (
                "no bounce",
                changed(&busy(), |scene| scene.settings.max_depth = 0),
            ),
            ("the mirror is behind the camera", changed(&busy(), aside)),
            (
                "a mirror with nothing before it",
                changed(&busy(), nothing_before),
            ),
            ("one ball", with(&[(ball([0.0; 3], 1.0), shiny())])),
            (
                "a normal buffer",
                changed(&busy(), |scene| scene.settings.mode = Mode::Normal),
            ),
        ],
    );
}

#[test]
fn the_reason_names_the_weight_that_is_0() {
    let reason = |change: fn(&mut rtc::internals::ir::Phong)| {
        let scene = changed(&busy(), |scene| all(scene, change));
        let lowered = LoweredScene {
            scene,
            source_spans: SourceSpans::default(),
        };
        let validated = pipeline::validate(
            &lowered,
            &Options::default(),
            &mut DiagnosticSink::default(),
        )
        .unwrap();
        let plan = Plan::new(&validated, RuleSet::ALL);
        let status = plan.statuses.iter().find(|s| s.effect == Effect::Mirror);
        status.unwrap().reason.to_string()
    };
    let kr = reason(|phong| phong.kr = Some(0.0));
    assert!(kr.contains("kr or else ks"), "{kr}");
    let ks = reason(|phong| phong.ks = 0.0);
    assert_eq!(ks, "ks is 0 on all visible surfaces");
}

#[test]
fn shadows() {
    let beside = with(&[
        (ball([0.0; 3], 1.0), diffuse()),
        (ball([0.0, -5.0, 0.0], 1.0), diffuse()),
    ]);
    is_not_needed(
        Effect::Shadows,
        &[
            (
                "not asked for",
                changed(&busy(), |scene| scene.settings.shadows = false),
            ),
            ("one ball", with(&[(ball([0.0; 3], 1.0), diffuse())])),
            ("one disc", with(&[(disc([0.0; 3], 1.0), diffuse())])),
            ("nothing between", beside),
            (
                "a black light",
                changed(&busy(), |scene| first_light(scene).color = [0.0; 3]),
            ),
            (
                "nothing shows light",
                changed(&busy(), |scene| {
                    all(scene, |phong| (phong.kd, phong.ks) = (0.0, 0.0))
                }),
            ),
            (
                "black surfaces",
                changed(&busy(), |scene| {
                    all(scene, |phong| (phong.color, phong.ks) = ([0.0; 3], 0.0))
                }),
            ),
        ],
    );
}

#[test]
fn lights() {
    let background = |scene: &mut Scene| {
        scene.surfaces.remove(0);
        first_light(scene).position = [0.0, 0.0, -5.0];
    };
    is_not_needed(
        Effect::DirectLight,
        &[
            (
                "black",
                changed(&busy(), |scene| first_light(scene).color = [0.0; 3]),
            ),
            (
                "kd and ks are 0",
                changed(&busy(), |scene| {
                    all(scene, |phong| (phong.kd, phong.ks) = (0.0, 0.0))
                }),
            ),
            ("behind a wall", changed(&busy(), background)),
            (
                "a depth buffer",
                changed(&busy(), |scene| scene.settings.mode = Mode::Depth),
            ),
            ("no surface", base_scene()),
        ],
    );
    let soft = changed(&busy(), |scene| first_light(scene).radius = 0.5);
    assert_eq!(fate(&soft, Effect::SoftLight).0, EffectState::Needed);
    is_not_needed(
        Effect::SoftLight,
        &[
            ("no radius", busy()),
            (
                "one sample",
                changed(&soft, |scene| scene.settings.light_samples = 1),
            ),
            (
                "black",
                changed(&soft, |scene| first_light(scene).color = [0.0; 3]),
            ),
            ("behind a wall", changed(&soft, background)),
        ],
    );
}

#[test]
fn lenses_and_samples() {
    let lens = changed(&busy(), |scene| {
        scene.camera.lens = rtc::internals::ir::Lens {
            radius: 0.2,
            samples: 4,
        }
    });
    assert_eq!(fate(&lens, Effect::Lens).0, EffectState::Needed);
    let away = |scene: &mut Scene| scene.camera.center = [0.0, 0.0, 20.0];
    is_not_needed(
        Effect::Lens,
        &[
            (
                "no radius",
                changed(&lens, |scene| scene.camera.lens.radius = 0.0),
            ),
            (
                "one sample",
                changed(&lens, |scene| scene.camera.lens.samples = 1),
            ),
            (
                "a depth buffer",
                changed(&lens, |scene| scene.settings.mode = Mode::Depth),
            ),
            ("nothing in view", changed(&lens, away)),
        ],
    );
    is_not_needed(
        Effect::Supersampling,
        &[
            (
                "a factor of 1",
                changed(&busy(), |scene| scene.settings.supersampling = 1),
            ),
            (
                "a depth buffer",
                changed(&busy(), |scene| scene.settings.mode = Mode::Depth),
            ),
            ("nothing in view", changed(&busy(), away)),
        ],
    );
}

#[test]
fn glossy_lobes_and_refraction() {
    let glossy = changed(&busy(), |scene| {
        all(scene, |phong| (phong.glossy_samples, phong.kt) = (4, 0.5))
    });
    let opaque = changed(&busy(), |scene| {
        all(scene, |phong| phong.glossy_samples = 4)
    });
    for effect in [Effect::GlossyReflection, Effect::Refraction] {
        assert_eq!(fate(&glossy, effect).0, EffectState::Needed);
        is_not_needed(
            effect,
            &[
                (
                    "no bounce",
                    changed(&glossy, |scene| scene.settings.max_depth = 0),
                ),
                (
                    "another mode",
                    changed(&glossy, |scene| scene.settings.mode = Mode::Normal),
                ),
                (
                    "nothing in view",
                    changed(&glossy, |scene| scene.camera.center = [0.0, 0.0, 20.0]),
                ),
                ("not asked for", busy()),
            ],
        );
    }
    let unshiny = changed(&opaque, |scene| all(scene, |phong| phong.ks = 0.0));
    assert_ne!(
        fate(&unshiny, Effect::GlossyReflection).0,
        EffectState::Needed,
        "of weight 0"
    );
}

#[test]
fn textures_and_normal_maps() {
    let mapped = changed(&busy(), |scene| {
        let texture = texture(scene, [10, 20, 30], [40, 50, 60]);
        let bump = Some(Bump {
            texture,
            height: 1.0,
        });
        let all = rtc::internals::ir::Phong {
            color_map: Some(texture),
            bump,
            ..shiny()
        };
        *material(scene, 0) = all;
    });
    let out_of_sight = |scene: &mut Scene| {
        scene.surfaces[0].shape = ball([90.0, 0.0, 0.0], 1.0);
        material(scene, 1).ks = 0.0;
    };
    for effect in [Effect::Textures, Effect::NormalMapping] {
        assert_eq!(fate(&mapped, effect).0, EffectState::Needed);
        is_not_needed(
            effect,
            &[
                (
                    "no uv",
                    changed(&mapped, |scene| {
                        scene.surfaces[0].shape = disc([0.0, 0.0, 3.0], 1.0)
                    }),
                ),
                (
                    "unused",
                    changed(&mapped, |scene| scene.surfaces.truncate(0)),
                ),
                ("out of sight", changed(&mapped, out_of_sight)),
                (
                    "a depth buffer",
                    changed(&mapped, |scene| scene.settings.mode = Mode::Depth),
                ),
                (
                    "no light",
                    changed(&mapped, |scene| {
                        scene.lights.clear();
                        all(scene, |phong| {
                            (phong.ka, phong.kd, phong.ks) = (0.0, 0.0, 0.0)
                        });
                    }),
                ),
            ],
        );
    }
}

/// 0 times infinity is NaN: values that are not finite are rejected, never removed for a factor of
/// 0.
#[test]
fn a_light_that_is_not_finite_is_reported_whatever_it_is_multiplied_by() {
    for color in [f64::INFINITY, f64::NAN, 1e61] {
        let mut scene = changed(&busy(), |scene| {
            all(scene, |phong| {
                (phong.ka, phong.kd, phong.ks) = (0.0, 0.0, 0.0)
            })
        });
        first_light(&mut scene).color[1] = color;
        let (mut sink, options) = (DiagnosticSink::default(), Options::default());
        let lowered = LoweredScene {
            scene,
            source_spans: SourceSpans::default(),
        };
        assert!(
            pipeline::validate(&lowered, &options, &mut sink).is_none() && sink.has_errors(),
            "{color}"
        );
    }
}

#[test]
fn pixels_that_show_nothing_are_traced_where_no_rule_may_leave_them_out() {
    let scene = super::validated(&with(&[(ball([0.0; 3], 1.0), diffuse())]));
    let pixel_classes = |rules| Plan::new(&scene, rules).pixel_classes;
    let (some, none) = (
        pixel_classes(RuleSet::ALL),
        pixel_classes(RuleSet::ALL.without(Rule::PixelMiss)),
    );
    assert_eq!(
        [some.class_of([0, 0]), none.class_of([0, 0])],
        [PixelClass::Nothing, PixelClass::Anything]
    );
    assert!(some.empty_fraction() > 0.5 && none.empty_fraction() == 0.0);
}

#[test]
fn a_plane_is_never_said_to_spare_itself() {
    assert_eq!(
        fate(&with(&[(plane(-1.0), diffuse())]), Effect::Shadows).0,
        EffectState::Needed
    );
}

/// The statuses of materials take linear time in the number of surfaces.
#[test]
fn materials_that_show_no_highlight_are_named_and_the_others_are_not() {
    let scene = with(&[
        (ball([-1.2, 0.0, 0.0], 1.0), diffuse()),
        (ball([1.2, 0.0, 0.0], 1.0), shiny()),
    ]);
    let plan = Plan::new(&super::validated(&scene), RuleSet::ALL);
    for effect in [Effect::Highlight, Effect::Mirror] {
        let named = plan
            .statuses
            .iter()
            .filter(|status| status.effect == effect)
            .filter_map(|status| status.of);
        assert_eq!(
            named.map(|place| place.to_string()).collect::<Vec<_>>(),
            ["/materials/0"],
            "{effect:?}"
        );
    }
}
