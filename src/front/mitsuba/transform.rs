//! The transforms of a scene: products of steps, the first one applied first.

use super::value;
use super::xml::{XmlElement, XmlReader, span};
use crate::exchange::transform::AffineTransform;
use rtc_diag::{Diagnostic, clip, codes};
use rtc_math::Vec3;
use rtc_source::FileId;

/// How far the axis of a rotation is from the length 1 by rounding: three digits.
const AXIS_ROUNDING: f64 = 2e-3;

impl XmlReader<'_> {
    /// The product of the elements of a `<transform>`: the first one is applied first.
    pub(super) fn transform(
        &mut self,
        file: FileId,
        element: XmlElement<'_, '_>,
    ) -> AffineTransform {
        // Of the keyframes of an animation the first one is shown.
        let keyframe = |child: &XmlElement<'_, '_>| child.has_tag_name("transform");
        let mut keyframes = element.children().filter(keyframe);
        let first = keyframes.next();
        if keyframes.next().is_some() {
            let message = "motion is left out: the first transform is shown";
            let diagnostic = Diagnostic::new(&codes::MITSUBA_APPROXIMATE, message);
            self.sink.push(diagnostic.at(span(file, &element), ""));
        }
        let mut product = AffineTransform::IDENTITY;
        let steps = first.unwrap_or(element).children();
        for child in steps.filter(XmlElement::is_element) {
            let name = child.tag_name().name();
            let step = match name {
                "translate" => self
                    .components(file, child, 0.0)
                    .map(AffineTransform::translation),
                "scale" => self
                    .components(file, child, 1.0)
                    .map(AffineTransform::scale),
                "rotate" => self.rotation(file, child),
                "lookat" | "lookAt" => self.look_at(file, child),
                "matrix" => self.matrix(file, child),
                _ => {
                    let message = format!("`<{}>` is no transform", clip(name));
                    let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
                    self.sink.push(diagnostic.at(span(file, &child), ""));
                    None
                }
            };
            product = step.unwrap_or(AffineTransform::IDENTITY).after(&product);
        }
        product
    }

    fn rotation(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Option<AffineTransform> {
        let axis = self.components(file, element, 0.0)?;
        let Some(angle) = self.attribute(file, element, "angle") else {
            self.missing(file, element, "`angle`");
            return None;
        };
        let degrees = value::number(&angle.text);
        if degrees.is_none() {
            self.not_numbers(&angle);
        }
        let rotation = AffineTransform::rotation(axis, degrees?);
        let length = Vec3::from_array(axis).length();
        if rotation.is_none() {
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, "the axis has no length");
            self.sink.push(diagnostic.at(span(file, &element), ""));
        } else if self.version >= 2 && (length - 1.0).abs() > AXIS_ROUNDING {
            let message = format!(
                "the axis of `<rotate>` has the length {length:.4}: as Mitsuba does not normalize \
                 it, it scales and skews, too"
            );
            let diagnostic = Diagnostic::new(&codes::MITSUBA_DOUBTFUL, message);
            let hint = "give an axis of length 1 for a rotation alone";
            self.sink
                .push(diagnostic.at(span(file, &element), "").hint(hint));
            return Some(AffineTransform::rodrigues(Vec3::from_array(axis), degrees?));
        }
        rotation
    }

    fn look_at(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Option<AffineTransform> {
        let mut point = |name: &str| -> Option<[f64; 3]> {
            let text = self.attribute(file, element, name)?;
            let vector = value::vector(&text.text);
            if vector.is_none() {
                self.not_numbers(&text);
            }
            vector
        };
        let (origin, target, up) = (point("origin"), point("target"), point("up"));
        let (Some(origin), Some(target)) = (origin, target) else {
            self.missing(file, element, "`origin` and `target`");
            return None;
        };
        let transform = AffineTransform::look_at(origin, target, up);
        if transform.is_none() {
            let message = "`origin`, `target` and `up` give no direction";
            let diagnostic = Diagnostic::new(&codes::MITSUBA_ELEMENT, message);
            self.sink.push(diagnostic.at(span(file, &element), ""));
        }
        transform
    }

    fn matrix(&mut self, file: FileId, element: XmlElement<'_, '_>) -> Option<AffineTransform> {
        let Some(text) = self.attribute(file, element, "value") else {
            self.missing(file, element, "`value`");
            return None;
        };
        let matrix = value::matrix(&text.text);
        if matrix.is_none() {
            self.not_numbers(&text);
        }
        matrix
    }
}
