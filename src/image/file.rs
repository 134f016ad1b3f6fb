//! A pixel file, written as the strips of its picture arrive, each some whole rows from the top;
//! written rows are freed. A whole picture is one strip, so that the bytes are the same.

use super::compressed::{self, CompressedForm};
use super::header::{PictureHeader, StripSource};
use super::{FileFormat, Picture, exr, png, rgbe};
use ::png::BitDepth;
use std::borrow::Cow;
use std::fmt;
use std::io::{self, Cursor, Seek, Write};

/// Why a picture has no pixel file, with the message of the encoder; a width or height of 0 is a
/// reason.
#[derive(Debug)]
pub struct EncodeError(String);

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl Picture {
    /// The bytes of the pixel file.
    ///
    /// # Errors
    /// If the picture is empty or larger than the format can hold.
    pub fn encode(&self, form: FileFormat) -> Result<Vec<u8>, EncodeError> {
        PictureHeader::of(self, form).encode(self)
    }
}

impl PictureHeader {
    /// Writes the file as its strips come.
    ///
    /// # Errors
    /// If it can't be written, the picture is empty or larger than the format can hold, or there
    /// is no next strip.
    pub fn write(&self, out: impl Write + Seek, mut strips: StripSource<'_>) -> io::Result<()> {
        self.check_size()?;
        match self.form {
            FileFormat::Png8 | FileFormat::Png16 => self.write_png(out, &mut strips),
            FileFormat::Jpeg => compressed::write(self, CompressedForm::Jpeg, out, &mut strips),
            FileFormat::Webp => compressed::write(self, CompressedForm::Webp, out, &mut strips),
            FileFormat::Exr | FileFormat::ExrHalf => exr::write(self, out, &mut strips),
            FileFormat::Hdr => rgbe::write(self, out, &mut strips),
        }
    }

    /// The bytes of the file of a whole picture.
    ///
    /// # Errors
    /// If the picture is empty or larger than the format can hold.
    pub fn encode(&self, picture: &Picture) -> Result<Vec<u8>, EncodeError> {
        self.encode_by(picture, |bytes, strips| self.write(bytes, strips))
    }

    /// The bytes of the PNG file of a whole picture; a program that calls nothing else has no code
    /// for other formats.
    ///
    /// # Errors
    /// If the form is no PNG, or the picture is empty or larger than the format can hold.
    pub fn encode_png(&self, picture: &Picture) -> Result<Vec<u8>, EncodeError> {
        self.encode_by(picture, |bytes, mut strips| {
            self.check_size()?;
            self.write_png(bytes, &mut strips)
        })
    }

    fn encode_by(
        &self,
        picture: &Picture,
        write: impl FnOnce(&mut Cursor<Vec<u8>>, StripSource<'_>) -> io::Result<()>,
    ) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Cursor::new(Vec::new());
        let mut whole = || Ok(Cow::Borrowed(picture));
        write(&mut bytes, StripSource::new(&mut whole))
            .map_err(|error| EncodeError(error.to_string()))?;
        Ok(bytes.into_inner())
    }

    fn check_size(&self) -> io::Result<()> {
        let [width, height] = self.size;
        if width == 0 || height == 0 {
            let words = format!("a picture of {width}×{height} pixels has no file");
            return Err(io::Error::other(words));
        }
        Ok(())
    }

    fn write_png(&self, out: impl Write, strips: &mut StripSource<'_>) -> io::Result<()> {
        let depth = match self.form {
            FileFormat::Png8 => BitDepth::Eight,
            FileFormat::Png16 => BitDepth::Sixteen,
            FileFormat::Jpeg
            | FileFormat::Webp
            | FileFormat::Exr
            | FileFormat::ExrHalf
            | FileFormat::Hdr => return Err(io::Error::other("the picture is not made for PNG")),
        };
        png::write(self, depth, out, strips)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Image, PixelLayers, TileHash, tile_count};
    use super::*;

    /// A picture with opacities and layers, all of whose rows differ.
    fn picture([width, height]: [u32; 2]) -> Picture {
        let pixels = u16::try_from(width * height).unwrap();
        let color = |at: u16| [f64::from(at) / 999.0, f64::from(at * 7 % 64) / 63.0, 0.5];
        Picture {
            image: Image {
                width,
                height,
                pixels: (0..pixels).map(color).collect(),
            },
            alpha: Some((0..pixels).map(|at| f32::from(at % 11) / 10.0).collect()),
            layers: PixelLayers {
                names: vec!["uv.U", "depth.Z"],
                values: (0..2 * pixels).map(f32::from).collect(),
            },
            tiles: (0..tile_count([width, height]))
                .map(|tile| TileHash::of_tile(&tile.to_le_bytes()))
                .collect(),
        }
    }

    /// Some rows of a picture.
    fn strip(picture: &Picture, rows: std::ops::Range<u32>) -> Picture {
        let width = picture.image.width as usize;
        let range = rows.start as usize * width..rows.end as usize * width;
        let before = |rows| tile_count([picture.image.width, rows]);
        let tiles = before(rows.start)..before(rows.end);
        Picture {
            image: Image {
                width: picture.image.width,
                height: rows.end - rows.start,
                pixels: picture.image.pixels[range.clone()].to_vec(),
            },
            alpha: picture
                .alpha
                .as_ref()
                .map(|alpha| alpha[range.clone()].to_vec()),
            layers: PixelLayers {
                names: picture.layers.names.clone(),
                values: picture.layers.values[2 * range.start..2 * range.end].to_vec(),
            },
            tiles: picture.tiles[tiles].to_vec(),
        }
    }

    fn forms() -> [FileFormat; 4] {
        [
            FileFormat::Png8,
            FileFormat::Png16,
            FileFormat::Exr,
            FileFormat::ExrHalf,
        ]
    }

    #[test]
    fn strips_make_the_bytes_of_the_whole() {
        let sizes = [[31, 70], [1, 16], [90, 17], [33, 40]];
        for (size, form) in sizes.into_iter().zip(forms()) {
            let whole = picture(size);
            let head = PictureHeader::of(&whole, form);
            for rows in [16, 32, 64, 80] {
                let mut top = 0;
                let mut next = || {
                    let end = (top + rows).min(size[1]);
                    let strip = strip(&whole, top..end);
                    top = end;
                    Ok(Cow::Owned(strip))
                };
                let mut bytes = Cursor::new(Vec::new());
                head.write(&mut bytes, StripSource::new(&mut next)).unwrap();
                assert!(
                    bytes.into_inner() == head.encode(&whole).unwrap(),
                    "{form:?}, {rows}"
                );
            }
        }
    }

    #[test]
    fn the_encoder_of_png_alone_makes_the_same_bytes_and_no_other_form() {
        let picture = picture([31, 20]);
        for form in forms() {
            let head = PictureHeader::of(&picture, form);
            let png = head.encode_png(&picture).ok();
            let is_png = matches!(form, FileFormat::Png8 | FileFormat::Png16);
            let expected = is_png.then(|| head.encode(&picture).unwrap());
            assert!(png == expected, "{form:?}");
        }
        let empty = Picture::opaque(Image {
            width: 0,
            height: 3,
            pixels: Vec::new(),
        });
        let head = PictureHeader::of(&empty, FileFormat::Png8);
        assert!(head.encode_png(&empty).is_err());
    }

    #[test]
    fn a_fault_of_a_strip_or_of_the_disk_is_told() {
        /// Reserves this many bytes.
        struct Full(usize);

        impl Write for Full {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                self.0 = self
                    .0
                    .checked_sub(bytes.len())
                    .ok_or(io::ErrorKind::StorageFull)?;
                Ok(bytes.len())
            }

            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }

        impl Seek for Full {
            fn seek(&mut self, _: io::SeekFrom) -> io::Result<u64> {
                Ok(0)
            }
        }

        let whole = picture([31, 70]);
        for form in forms() {
            let head = PictureHeader::of(&whole, form);
            let length = head.encode(&whole).unwrap().len();
            for room in [0, 40, length / 2, length - 30, length - 13, length - 1] {
                let mut one = || Ok(Cow::Borrowed(&whole));
                let full = head.write(Full(room), StripSource::new(&mut one));
                assert_eq!(
                    full.unwrap_err().kind(),
                    io::ErrorKind::StorageFull,
                    "{room}"
                );
            }
            let mut first = true;
            let mut next = || {
                let strip = strip(&whole, 0..16);
                let fault = || io::Error::from(io::ErrorKind::Interrupted);
                std::mem::take(&mut first)
                    .then_some(Cow::Owned(strip))
                    .ok_or_else(fault)
            };
            let stopped = head.write(Cursor::new(Vec::new()), StripSource::new(&mut next));
            assert_eq!(stopped.unwrap_err().kind(), io::ErrorKind::Interrupted);
        }
    }
}
