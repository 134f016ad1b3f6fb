//! The reconstruction filter of pixels.

use super::decode::{Decode, DecodeContext, Spanned};
use super::keyword::{KeywordTable, keyword, keyword_schema};
use super::number::{Positive, Real};
use super::record::{FieldResult, record};
use super::schema::SchemaDefinitions;
use rtc_math::PixelFilter;
use rtc_source::tree::NodeId;
use serde_json::{Value as Json, json};

/// A filter: its name, or its name with its numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct FilterSetting(pub(super) PixelFilter);

/// The filters by name, with the usual numbers.
const FILTERS: KeywordTable<PixelFilter> = &[
    ("box", PixelFilter::PIXEL, "The mean over the pixel."),
    (
        "tent",
        PixelFilter::Tent { radius: 1.0 },
        "Linearly less to a distance of 1 pixel.",
    ),
    (
        "gaussian",
        PixelFilter::Gaussian {
            deviation: 0.5,
            radius: 2.0,
        },
        "A normal distribution with a deviation of half a pixel.",
    ),
    (
        "mitchell",
        PixelFilter::Mitchell {
            b: 1.0 / 3.0,
            c: 1.0 / 3.0,
            radius: 2.0,
        },
        "The cubic of Mitchell and Netravali: sharp, with little ringing.",
    ),
    (
        "catmullRom",
        PixelFilter::CATMULL_ROM,
        "The cubic of Catmull and Rom: sharper.",
    ),
    (
        "lanczos",
        PixelFilter::Lanczos {
            window: 3.0,
            radius: 3.0,
        },
        "The sine cardinal under a window: the sharpest, with the most ringing.",
    ),
];

record! {
    /// A filter of pixels by one key, with its numbers in pixels.
    struct FilterParameters, "filter" {
        /// The mean.
        uniform: Spanned<FilterRadius>, optional, &[&["box"]];
        /// Linearly less.
        tent: Spanned<FilterRadius>, optional, &[&["tent"]];
        /// A normal distribution.
        gaussian: Spanned<GaussianFilter>, optional, &[&["gaussian"]];
        /// The cubic of Mitchell and Netravali.
        mitchell: Spanned<MitchellFilter>, optional, &[&["mitchell"]];
        /// The sine cardinal under a window.
        lanczos: Spanned<LanczosFilter>, optional, &[&["lanczos"]];
    }
    variants { [uniform] [tent] [gaussian] [mitchell] [lanczos] }
}

record! {
    /// A filter with a radius.
    struct FilterRadius, "filter with a radius" {
        /// The distance, along each axis, beyond which light counts nothing.
        radius: Spanned<Positive>, required, &[&["radius"]];
    }
}

record! {
    /// A normal distribution.
    struct GaussianFilter, "Gaussian filter" {
        /// The standard deviation.
        deviation: Spanned<Positive>, default(Positive(0.5)), &[&["deviation"]];
        /// The distance, along each axis, beyond which light counts nothing.
        radius: Spanned<Positive>, default(Positive(2.0)), &[&["radius"]];
    }
}

record! {
    /// The cubic of Mitchell and Netravali.
    struct MitchellFilter, "Mitchell filter" {
        /// The blur, from 0 to 1.
        b: Spanned<Real>, required, &[&["b"]];
        /// The ringing, from 0 to 1.
        c: Spanned<Real>, required, &[&["c"]];
        /// The distance, along each axis, beyond which light counts nothing.
        radius: Spanned<Positive>, default(Positive(2.0)), &[&["radius"]];
    }
}

record! {
    /// The sine cardinal under a window.
    struct LanczosFilter, "Lanczos filter" {
        /// The zero of the window, at least 1.
        window: Spanned<Positive>, default(Positive(3.0)), &[&["window"]];
        /// The distance, along each axis, beyond which light counts nothing, at least 1.
        radius: Spanned<Positive>, default(Positive(3.0)), &[&["radius"]];
    }
}

impl FilterParameters {
    fn filter(&self) -> Option<PixelFilter> {
        let Self {
            uniform,
            tent,
            gaussian,
            mitchell,
            lanczos,
        } = self;
        if let FieldResult::Read(filter) = uniform {
            let radius = filter.value.radius.value.0;
            return Some(PixelFilter::Box { radius });
        }
        if let FieldResult::Read(filter) = tent {
            let radius = filter.value.radius.value.0;
            return Some(PixelFilter::Tent { radius });
        }
        if let FieldResult::Read(filter) = gaussian {
            let GaussianFilter { deviation, radius } = &filter.value;
            let [deviation, radius] = [deviation, radius].map(|number| number.value.0);
            return Some(PixelFilter::Gaussian { deviation, radius });
        }
        if let FieldResult::Read(filter) = mitchell {
            let MitchellFilter { b, c, radius } = &filter.value;
            return Some(PixelFilter::Mitchell {
                b: b.value.0,
                c: c.value.0,
                radius: radius.value.0,
            });
        }
        if let FieldResult::Read(filter) = lanczos {
            let LanczosFilter { window, radius } = &filter.value;
            let [window, radius] = [window, radius].map(|number| number.value.0);
            return Some(PixelFilter::Lanczos { window, radius });
        }
        None
    }
}

impl Decode for FilterSetting {
    fn decode(node: NodeId, context: &mut DecodeContext<'_>) -> Option<Self> {
        if context.tree.is_map(node) {
            let parameters = FilterParameters::decode(node, context)?;
            return parameters.filter().map(Self);
        }
        keyword(node, FILTERS, context).map(Self)
    }

    fn schema(definitions: &mut SchemaDefinitions) -> Json {
        let mut schema = keyword_schema(FILTERS);
        let variants = schema["anyOf"].as_array_mut();
        let parameters = FilterParameters::schema(definitions);
        variants
            .into_iter()
            .for_each(|variants| variants.push(parameters.clone()));
        schema
    }

    fn json(&self) -> Json {
        let keyword = FILTERS.iter().find(|(_, filter, _)| *filter == self.0);
        keyword.map_or(Json::Null, |(keyword, ..)| json!(keyword))
    }
}
