//! GIF: pictures one after another in one file, each of at most 256 colours of its own.

use super::Picture;
use super::header::PictureHeader;
use super::png::pack;
use ::gif::{Encoder, EncodingError, Frame, Repeat};
use ::png::BitDepth;
use std::io::{self, ErrorKind, Write};

/// The sampling step for choosing the palette, from 1 to 30: all pixels count.
const SPEED: i32 = 1;

/// A GIF that is partly written.
pub struct AnimatedGif<W: Write> {
    encoder: Encoder<W>,
    size: [u16; 2],
    /// How long each is shown, in hundredths of a second.
    delay: u16,
}

impl<W: Write> AnimatedGif<W> {
    /// Begins a file of pictures of the size of the header, at about this many frames per second,
    /// that loops for ever. Opacities are dropped.
    ///
    /// # Errors
    /// If it can't be written, or has more pixels than a GIF on a side.
    pub fn begin(head: &PictureHeader, rate: u16, out: W) -> io::Result<Self> {
        let too_large = || io::Error::other("a GIF has at most 65535 pixels on a side");
        let [width, height] = head.size.map(|side| u16::try_from(side).ok());
        let size = [width.ok_or_else(too_large)?, height.ok_or_else(too_large)?];
        let mut encoder = Encoder::new(out, size[0], size[1], &[]).map_err(into_io)?;
        encoder.set_repeat(Repeat::Infinite).map_err(into_io)?;
        // Programs slow down frames of less than two hundredths of a second.
        let delay = ((100 + rate / 2) / rate.max(1)).max(2);
        Ok(Self {
            encoder,
            size,
            delay,
        })
    }

    /// Writes the next picture.
    ///
    /// # Errors
    /// If it can't be written, or has another size.
    pub fn add(&mut self, picture: &Picture) -> io::Result<()> {
        let [width, height] = self.size;
        let (mut pixels, mut row) = (Vec::new(), Vec::new());
        for index in 0..usize::from(height) {
            pack(picture, index, BitDepth::Eight, &mut row);
            pixels.extend_from_slice(&row);
        }
        if pixels.len() != 3 * usize::from(width) * usize::from(height) {
            return Err(ErrorKind::InvalidInput.into());
        }
        let mut frame = Frame::from_rgb_speed(width, height, &pixels, SPEED);
        frame.delay = self.delay;
        self.encoder.write_frame(&frame).map_err(into_io)
    }

    /// Ends the file.
    ///
    /// # Errors
    /// If it can't be written.
    pub fn finish(self) -> io::Result<()> {
        self.encoder.into_inner().map(drop).map_err(into_io)
    }
}

fn into_io(error: EncodingError) -> io::Error {
    if let EncodingError::Io(error) = error {
        error
    } else {
        io::Error::other(error)
    }
}
