//! What a picture on its way knows beside its shares: the pictures that were finished before it, and how far
//! it has grown as a whole.

use super::PicturePart;
use rtc_render::Crop;

impl PicturePart {
    /// The pixels of its picture that are wanted.
    #[must_use]
    pub fn window(&self) -> Crop {
        self.head.crop()
    }

    /// The part, after so many pictures that were finished, by the hashes of their files.
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

    /// The part, as far as its picture has grown as a whole.
    pub fn grow(&mut self, growth: Vec<u8>) {
        self.head.growth = Some(growth.len() as u64);
        self.growth = growth;
    }

    /// How far its picture has grown as a whole, which it forgets.
    #[must_use]
    pub fn take_growth(&mut self) -> Vec<u8> {
        self.head.growth = None;
        std::mem::take(&mut self.growth)
    }
}
