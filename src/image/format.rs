//! The formats of pictures, detected by the first bytes of a file.

use super::decode::ktx2::MAGIC;

/// A format that a file may be of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PictureFormat {
    Png,
    Jpeg,
    WebP,
    Ktx2,
    /// One that is read elsewhere or not at all, by its name.
    Other(&'static str),
}

impl PictureFormat {
    /// The format of a file that begins so.
    pub(super) fn of(head: &[u8]) -> Option<Self> {
        let mut known = MAGICS.iter();
        let plain = known.find(|(magic, _)| head.starts_with(magic));
        let plain = plain.map(|(_, format)| *format).or_else(|| boxed(head));
        plain.or_else(|| head.starts_with(MAGIC).then_some(Self::Ktx2))
    }

    /// Its name: the media type without `image/`.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Jpeg => "jpeg",
            Self::WebP => "webp",
            Self::Ktx2 => "ktx2",
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
    (b"BM", PictureFormat::Other("bmp")),
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

const PNM: PictureFormat = PictureFormat::Other("x-portable-anymap");

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
