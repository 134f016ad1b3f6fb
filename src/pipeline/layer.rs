//! A layer of a picture as a PNG, for people.

use super::{PictureSetup, RenderError, RenderSubject};
use rtc_image::{Origin, Picture, PictureHead};
use rtc_render::Aov;

impl PictureSetup {
    /// The bytes of the PNG of a layer that was asked for, with as many bits as the picture has; it says
    /// which layer it is, and what black and white stand for.
    ///
    /// # Errors
    /// If the layer is not there, or larger than the format can hold.
    pub fn encode_layer(
        &self,
        aov: Aov,
        picture: &Picture,
        subject: &RenderSubject,
    ) -> Result<Vec<u8>, RenderError> {
        let refused = |words: String| RenderError::Refused(words);
        let layer = picture.layer_picture(aov.channels());
        let layer = layer.ok_or_else(|| refused(format!("there is no layer `{}`", aov.name())))?;
        let mut told = serde_json::json!({ "layer": aov.name() });
        if !layer.ranges.is_empty() {
            told["ranges"] = serde_json::json!(layer.ranges);
        }
        let look = self.look.settled(&subject.proven.scene.settings().mode);
        let shown = Picture::opaque(layer.image);
        let head = PictureHead {
            is_color: layer.is_color,
            origin: look.origin(Origin {
                layer: told.to_string(),
                ..self.origin(&subject.proven.lowered.scene)
            }),
            ..PictureHead::of(&shown, self.look.kind)
        };
        let bytes = head.encode(&shown);
        bytes.map_err(|error| refused(error.to_string()))
    }
}
