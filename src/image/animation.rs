//! APNG: pictures one after another in one file (PNG, third edition, section 4.9). Its first
//! picture is that of programs which show no other.

use super::Picture;
use super::header::PictureHeader;
use super::png::pack;
use ::png::{BitDepth, ColorType, Encoder, SrgbRenderingIntent, Writer};
use std::io::{self, Write};

/// An APNG that is partly written, 8 bits per channel.
pub struct AnimatedPng<W: Write> {
    writer: Writer<W>,
    height: u32,
}

impl<W: Write> AnimatedPng<W> {
    /// Begins a file of a number of pictures, at least 1, at a number of frames per second, that
    /// loops for ever; the header gives the size, and whether there is an alpha channel.
    ///
    /// # Errors
    /// If it can't be written, or there are no pictures or pixels.
    pub fn begin(head: &PictureHeader, frames: u32, rate: u16, out: W) -> io::Result<Self> {
        let [width, height] = head.size;
        let mut encoder = Encoder::new(out, width, height);
        encoder.set_color(if head.has_alpha {
            ColorType::Rgba
        } else {
            ColorType::Rgb
        });
        encoder.set_depth(BitDepth::Eight);
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
        encoder.set_animated(frames, 0)?;
        encoder.set_frame_delay(1, rate)?;
        encoder.validate_sequence(true);
        let writer = encoder.write_header()?;
        Ok(Self { writer, height })
    }

    /// Writes the next picture.
    ///
    /// # Errors
    /// If it can't be written, or does not match the header.
    pub fn add(&mut self, picture: &Picture) -> io::Result<()> {
        let (mut pixels, mut row) = (Vec::new(), Vec::new());
        for index in 0..self.height.min(picture.image.height) as usize {
            pack(picture, index, BitDepth::Eight, &mut row);
            pixels.extend_from_slice(&row);
        }
        Ok(self.writer.write_image_data(&pixels)?)
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If it can't be written, or pictures are missing.
    pub fn finish(self) -> io::Result<()> {
        Ok(self.writer.finish()?)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FileFormat, Image};
    use super::*;

    #[test]
    fn a_file_has_as_many_pictures_as_it_says() {
        let picture = Picture::opaque(Image {
            width: 3,
            height: 2,
            pixels: vec![[0.5; 3]; 6],
        });
        let head = PictureHeader::of(&picture, FileFormat::Png8);
        let written = |frames: u32| {
            let mut bytes = Vec::new();
            let mut animation = AnimatedPng::begin(&head, 2, 12, &mut bytes)?;
            (0..frames).try_for_each(|_| animation.add(&picture))?;
            animation.finish()
        };
        assert!(written(2).is_ok() && written(1).is_err() && written(3).is_err());
        assert!(AnimatedPng::begin(&head, 0, 12, Vec::new()).is_err());
    }
}
