//! Encodes a layer of a picture as a PNG for display.

use super::{PictureSetup, RenderError, RenderSubject};
use rtc_image::{Origin, Picture, PictureHead};
use rtc_render::Aov;

impl PictureSetup {
    /// The PNG of a layer, with the bits of the picture. Its metadata has the name of the layer and
    /// the values of black and white.
    ///
    /// # Errors
    /// If there is no such layer, or it is larger than the format allows.
    pub fn encode_layer(
        &self,
        aov: Aov,
        picture: &Picture,
        subject: &RenderSubject,
    ) -> Result<Vec<u8>, RenderError> {
        let rejected = |message: String| RenderError::Refused(message);
        let layer = picture.layer_picture(aov.channels());
        let layer = layer.ok_or_else(|| rejected(format!("there is no layer `{}`", aov.name())))?;
        let mut metadata = serde_json::json!({ "layer": aov.name() });
        if !layer.ranges.is_empty() {
            metadata["ranges"] = serde_json::json!(layer.ranges);
        }
        let look = self.look.resolve(&subject.validated.scene.settings().mode);
        let displayed = Picture::opaque(layer.image);
        let head = PictureHead {
            is_color: layer.is_color,
            origin: look.origin(Origin {
                layer: metadata.to_string(),
                ..self.origin(&subject.validated.lowered.scene)
            }),
            ..PictureHead::of(&displayed, self.look.kind)
        };
        let bytes = head.encode(&displayed);
        bytes.map_err(|error| rejected(error.to_string()))
    }
}
