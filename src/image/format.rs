//! The formats of pictures, detected by the first bytes of a file.

use super::decode::ktx2::MAGIC;

/// A format that a file may be of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PictureFormat {
    Png,
    Jpeg,
    WebP,
    Ktx2,
    Raster(RasterFormat),
    /// One that is read elsewhere or not at all, by its name.
    Other(&'static str),
}

/// A format without compression, or with runs of equal pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum RasterFormat {
    Bmp,
    Tga,
    Pnm,
}

impl PictureFormat {
    /// The format of a file that begins so.
    pub(super) fn of(head: &[u8]) -> Option<Self> {
        let mut known = MAGICS.iter();
        let plain = known.find(|(magic, _)| head.starts_with(magic));
        let plain = plain.map(|(_, format)| *format).or_else(|| boxed(head));
        let plain = plain.or_else(|| head.starts_with(MAGIC).then_some(Self::Ktx2));
        plain.or_else(|| is_tga(head).then_some(Self::Raster(RasterFormat::Tga)))
    }

    /// Its name: the media type without `image/`.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpeg",
            Self::WebP => "webp",
            Self::Ktx2 => "ktx2",
            Self::Raster(RasterFormat::Bmp) => "bmp",
            Self::Raster(RasterFormat::Tga) => "x-targa",
            Self::Raster(RasterFormat::Pnm) => "x-portable-anymap",
            Self::Other(name) => name,
        }
    }
}

/// The first bytes of the formats that begin with always the same.
const MAGICS: [(&[u8], PictureFormat); 20] = [
    (b"\x89PNG\r\n\x1a\n", PictureFormat::Png),
    (b"\xff\xd8\xff", PictureFormat::Jpeg),
    (b"GIF89a", PictureFormat::Other("gif")),
    (b"GIF87a", PictureFormat::Other("gif")),
    (b"MM\0*", PictureFormat::Other("tiff")),
    (b"II*\0", PictureFormat::Other("tiff")),
    (b"DDS ", PictureFormat::Other("vnd-ms.dds")),
    (b"BM", PictureFormat::Raster(RasterFormat::Bmp)),
    (b"\0\0\x01\0", PictureFormat::Other("x-icon")),
    (b"#?RADIANCE", PictureFormat::Other("vnd.radiance")),
    (b"\x76\x2f\x31\x01", PictureFormat::Other("x-exr")),
    (b"qoif", PictureFormat::Other("x-qoi")),
    (b"P1", PNM),
    (b"P2", PNM),
    (b"P3", PNM),
    (b"P4", PNM),
    (b"P5", PNM),
    (b"P6", PNM),
    (b"P7", PNM),
    (
        b"farbfeld",
        PictureFormat::Other("application/octet-stream"),
    ),
];

const PNM: PictureFormat = PictureFormat::Raster(RasterFormat::Pnm);

/// Whether a file begins with a header of TGA, which has no magic number: the kinds of its colour
/// map and of its pixels, no colour map where there is none, a size, and bits of a pixel
/// (Truevision TGA File Format Specification 2.0).
fn is_tga(head: &[u8]) -> bool {
    let Some(
        &[
            _,
            map,
            kind,
            m0,
            m1,
            m2,
            m3,
            m4,
            _,
            _,
            _,
            _,
            w0,
            w1,
            h0,
            h1,
            depth,
            flags,
        ],
    ) = head.first_chunk::<18>()
    else {
        return false;
    };
    let has_map = match (map, kind) {
        (0, 2 | 3 | 10 | 11) => [m0, m1, m2, m3, m4] == [0; 5],
        (1, 1 | 9) => matches!(m4, 15 | 16 | 24 | 32),
        _ => false,
    };
    let has_size = [w0, w1] != [0; 2] && [h0, h1] != [0; 2];
    has_map && has_size && matches!(depth, 8 | 15 | 16 | 24 | 32) && flags & 0xc0 == 0
}

/// The formats that begin with a length.
fn boxed(head: &[u8]) -> Option<PictureFormat> {
    match *head.first_chunk::<12>()? {
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P'] => Some(PictureFormat::WebP),
        [0, 0, _, _, b'f', b't', b'y', b'p', b'a', b'v', b'i', b'f'] => {
            Some(PictureFormat::Other("avif"))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The name of the format in the crate `image`.
    fn witness(head: &[u8]) -> Option<&'static str> {
        let format = ::image::guess_format(head).ok()?;
        Some(format.to_mime_type().trim_start_matches("image/"))
    }

    #[test]
    fn the_witness_tells_the_same_formats() {
        let with_length: [&[u8]; 4] = [
            b"RIFF\x01\x02\x03\x04WEBP",
            b"\0\0\0\x1cftypavif",
            b"\0\0\xff\x01ftypavif",
            b"\0\0\x01\0ftypavif",
        ];
        let others: [&[u8]; 6] = [
            b"",
            b"RIFF\x01\x02\x03\x04WAVE",
            b"\0\x01\0\x1cftypavif",
            b"P8 1 1",
            b"#?RGBE\n",
            b"hello, this is no picture",
        ];
        let plain = MAGICS.iter().map(|(magic, _)| *magic);
        let (mut known, mut unknown) = (0, 0);
        for magic in plain.chain(with_length).chain(others) {
            for head in [magic, &[magic, b" and more"].concat()] {
                for end in 0..=head.len() {
                    let format = PictureFormat::of(&head[..end]).map(PictureFormat::name);
                    assert_eq!(format, witness(&head[..end]), "{:?}", &head[..end]);
                    match format {
                        Some(_) => known += 1,
                        None => unknown += 1,
                    }
                }
            }
        }
        assert!(known > 200 && unknown > 200, "{known} {unknown}");
    }
}
