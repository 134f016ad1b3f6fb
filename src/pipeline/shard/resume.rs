//! State for resuming a render in addition to its shares: finished pictures, and the progressive
//! state.

use super::RenderShard;
use rtc_render::Crop;

impl RenderShard {
    /// The crop window.
    #[must_use]
    pub fn window(&self) -> Crop {
        self.head.crop()
    }

    /// Sets the hashes of the files of finished pictures.
    #[must_use]
    pub fn after(mut self, finished: Vec<String>) -> Self {
        self.head.finished = finished;
        self
    }

    /// The hashes of the pictures that were finished before.
    #[must_use]
    pub fn finished(&self) -> &[String] {
        &self.head.finished
    }

    /// Sets the progressive state.
    pub fn grow(&mut self, growth: Vec<u8>) {
        self.head.growth = Some(growth.len() as u64);
        self.growth = growth;
    }

    /// Takes the progressive state out.
    #[must_use]
    pub fn take_growth(&mut self) -> Vec<u8> {
        self.head.growth = None;
        std::mem::take(&mut self.growth)
    }
}
