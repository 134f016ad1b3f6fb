//! Render settings and the environment, from `extras.rtc` of the asset.

use super::super::accessor_reader::AccessorReader;
use super::super::field::ObjectFields;
use super::super::layout::ComponentType;
use super::{Lowering, material};
use rtc_color::Tone;
use rtc_diag::codes;
use rtc_ir::{
    Display, EntityField, EntityKind, Environment, Gooch, Image, ImageId, Mode, PathSettings,
    Pixels, Settings, ValuePath,
};
use rtc_math::PixelFilter;
use rtc_source::Resource;
use serde_json::Value as Json;

impl Lowering<'_, '_, '_> {
    /// Adopts the settings and the environment of the asset.
    pub(super) fn settings_extras(&mut self) {
        let root = ObjectFields::new(self.report.json, self.report.json.root());
        let Some(extras) = root.rtc_extras() else {
            return;
        };
        if extras.has("mode") || extras.has("display") {
            let place = ValuePath::new(EntityKind::Settings, 0, EntityField::Whole);
            self.source_spans
                .record(place, self.report.json.span(extras.at));
        }
        read(extras, &mut self.scene.settings);
        if let Some(display) = extras.object("display") {
            let name = display.text("tone");
            self.scene.display = Display {
                exposure: display.number_or("exposure", 0.0),
                tone: Tone::ALL
                    .into_iter()
                    .find(|tone| Some(tone.name()) == name.as_deref()),
            };
        }
        if let Some(environment) = extras.object("environment") {
            self.environment(environment);
        }
        self.scene.medium = material::medium(extras, "medium");
    }

    fn environment(&mut self, extras: ObjectFields<'_, '_>) {
        let place = ValuePath::new(EntityKind::Environment, 0, EntityField::Whole);
        self.source_spans
            .record(place, self.report.json.span(extras.at));
        let image = match (extras.index("image"), extras.index("pixels")) {
            (Some(image), _) => {
                let Self {
                    doc,
                    scene,
                    source_spans,
                    report,
                    ..
                } = self;
                self.materials
                    .image(doc, image, scene, source_spans, report)
            }
            (None, Some(pixels)) => self.pixels(extras, pixels),
            (None, None) => None,
        };
        let rotation = extras.vector::<9>("rotation");
        self.scene.environment = Some(Environment {
            radiance: extras.vector_or("radiance", [0.0; 3]),
            image,
            image_from_world: rotation
                .map(|[a, b, c, d, e, f, g, h, i]| [[a, b, c], [d, e, f], [g, h, i]]),
        });
    }

    /// The image whose pixels are the elements of an accessor.
    fn pixels(&mut self, extras: ObjectFields<'_, '_>, accessor: usize) -> Option<ImageId> {
        let doc = self.doc;
        let accessor = doc.accessors.get(accessor)?;
        let elements = AccessorReader::of(doc, accessor)?;
        let count = elements.count as u64;
        // The elements are rows of `width` RGB pixels in f32.
        let size = extras.integer("width").and_then(|width| {
            let height = count
                .checked_div(width)
                .filter(|height| height * width == count)?;
            Some([u32::try_from(width).ok()?, u32::try_from(height).ok()?])
        });
        let is_color = elements.layout.component == ComponentType::F32
            && (elements.layout.columns, elements.layout.rows) == (1, 3);
        let Some([width, height]) = size.filter(|_| is_color) else {
            let message = "the number of pixels is not a multiple of `width`";
            self.report
                .add(&codes::GLTF_ACCESSOR, "", extras.at, message.to_owned());
            return None;
        };
        // Charge the memory before it is taken.
        let kind = Pixels::Rgb32f;
        let bytes = count.saturating_mul(kind.bytes() as u64);
        if !self
            .report
            .charge(Resource::Memory, bytes, extras.at, "the picture")
        {
            return None;
        }
        let place = ValuePath::new(
            EntityKind::Image,
            self.scene.images.len(),
            EntityField::Whole,
        );
        self.source_spans
            .record(place, self.report.json.span(extras.at));
        // Copy the pixels as 32-bit floats.
        let mut pixels = Vec::with_capacity(elements.count * kind.bytes());
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the channels are 32-bit floats"
        )]
        elements.each(|_, pixel| {
            let channels = pixel.iter().map(|channel| *channel as f32);
            pixels.extend(channels.flat_map(f32::to_le_bytes));
        });
        Some(self.scene.add_image(Image {
            name: ObjectFields::new(self.report.json, accessor.at).name(),
            width,
            height,
            kind,
            pixels: pixels.into(),
        }))
    }
}

/// Changes the settings that are named. The schema has reported wrong values.
fn read(extras: ObjectFields<'_, '_>, settings: &mut Settings) {
    if let Some(mode) = extras.text("mode").and_then(|word| mode_of(&word, extras)) {
        settings.mode = mode;
    }
    for name in Settings::names().iter().filter(|name| *name != "mode") {
        let written = extras.node(name).map(|at| extras.json.written(at));
        if let Some(value) = written.and_then(|text| serde_json::from_str::<Json>(text).ok())
            && let Ok(mut all) = serde_json::to_value(&*settings)
        {
            all[name] = value;
            *settings = serde_json::from_value(all).unwrap_or_else(|_| settings.clone());
        }
    }
}

fn filter_of(extras: ObjectFields<'_, '_>) -> Option<PixelFilter> {
    let kinds = ["box", "tent", "gaussian", "mitchell", "lanczos"];
    let found = kinds
        .into_iter()
        .find_map(|kind| Some((kind, extras.object(kind)?)));
    let (kind, numbers) = found?;
    let number = |key| numbers.number_or(key, 0.0);
    let radius = number("radius");
    Some(match kind {
        "box" => PixelFilter::Box { radius },
        "tent" => PixelFilter::Tent { radius },
        "gaussian" => PixelFilter::Gaussian {
            deviation: number("deviation"),
            radius,
        },
        "mitchell" => PixelFilter::Mitchell {
            b: number("b"),
            c: number("c"),
            radius,
        },
        _ => PixelFilter::Lanczos {
            window: number("window"),
            radius,
        },
    })
}

fn mode_of(word: &str, extras: ObjectFields<'_, '_>) -> Option<Mode> {
    let parameters = extras.object(word);
    Some(match word {
        "phong" => Mode::Phong,
        "zbuffer" => Mode::Depth,
        "normal" => Mode::Normal,
        "gooch" => {
            let number = |key| parameters.map_or(0.0, |extras| extras.number_or(key, 0.0));
            Mode::Gooch(Gooch {
                b: number("b"),
                y: number("y"),
                alpha: number("alpha"),
                beta: number("beta"),
            })
        }
        "path" => {
            let default = PathSettings::default();
            let samples = parameters.map(|extras| extras.count_or("samples", default.samples));
            let scatters = parameters.filter(|extras| extras.has("multipleScattering"));
            Mode::Path(PathSettings {
                samples: samples.unwrap_or(default.samples),
                multiple_scattering: scatters.map_or(default.multiple_scattering, |extras| {
                    extras.boolean("multipleScattering")
                }),
                caustics: parameters.is_some_and(|extras| extras.boolean("caustics")),
                filter: parameters
                    .and_then(|extras| extras.object("filter"))
                    .and_then(filter_of)
                    .unwrap_or_default(),
            })
        }
        _ => return None,
    })
}
