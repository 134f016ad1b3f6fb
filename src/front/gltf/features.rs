//! Features of image files that glTF ignores: color profiles, pixels that are not square,
//! animation. glTF defines what the values mean, independent of the file.

use super::image::ImageCoding;

/// The gamma of an ordinary PNG and of a linear one, times 100 000.
const GAMMAS: [u32; 2] = [45_455, 100_000];
/// The white point and the primaries of sRGB, times 100 000.
const SRGB: [u32; 8] = [
    31_270, 32_900, 64_000, 33_000, 30_000, 60_000, 15_000, 6_000,
];

/// The unsupported feature of an image, if any.
pub(super) fn unfollowed(format: ImageCoding, bytes: &[u8]) -> Option<&'static str> {
    match format {
        ImageCoding::Png => png(bytes),
        ImageCoding::Jpeg | ImageCoding::Ktx2 => None,
        ImageCoding::WebP => webp(bytes),
    }
}

/// Looks at the chunks before the pixels. Of the chunks about colour the first decides, and `sRGB`
/// before all.
fn png(bytes: &[u8]) -> Option<&'static str> {
    let (mut rest, mut gamma, mut primaries, mut squares) = (bytes.get(8..)?, None, None, true);
    while let Some((kind, content, after)) = chunk(rest) {
        let mut words = content
            .chunks_exact(4)
            .map(|word| u32::from_be_bytes([word[0], word[1], word[2], word[3]]));
        match kind {
            b"IDAT" => break,
            b"iCCP" => (gamma, primaries) = (Some(false), Some(false)),
            b"sRGB" => (gamma, primaries) = (Some(true), Some(true)),
            b"gAMA" => gamma = gamma.or(words.next().map(|word| GAMMAS.contains(&word))),
            b"cHRM" => primaries = primaries.or(Some(words.eq(SRGB))),
            b"pHYs" => squares = words.next() == words.next(),
            _ => {}
        }
        rest = after;
    }
    if gamma == Some(false) || primaries == Some(false) {
        Some("a colour profile")
    } else {
        (!squares).then_some("non-square pixels")
    }
}

/// The type and the content of a chunk, and the bytes after it.
fn chunk(bytes: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (head, rest) = bytes.split_at_checked(8)?;
    let length = usize::try_from(u32::from_be_bytes([head[0], head[1], head[2], head[3]])).ok()?;
    let (content, rest) = rest.split_at_checked(length)?;
    Some((&head[4..], content, rest.get(4..)?))
}

/// Looks at the flags of an extended file.
fn webp(bytes: &[u8]) -> Option<&'static str> {
    const ANIMATION: u8 = 0x02;
    const PROFILE: u8 = 0x20;
    let flags = *bytes
        .get(20)
        .filter(|_| bytes.get(12..16) == Some(b"VP8X"))?;
    if flags & ANIMATION != 0 {
        Some("an animation")
    } else {
        (flags & PROFILE != 0).then_some("a colour profile")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
        for (kind, content) in chunks {
            bytes.extend(u32::try_from(content.len()).unwrap().to_be_bytes());
            bytes.extend([&kind[..], content, &[0; 4]].concat());
        }
        bytes
    }

    #[test]
    fn the_first_word_about_colour_counts_and_srgb_before_all() {
        let found = |chunks: &[(&[u8; 4], &[u8])]| unfollowed(ImageCoding::Png, &image(chunks));
        let gamma = 50_000_u32.to_be_bytes();
        let srgb: Vec<u8> = SRGB.iter().flat_map(|word| word.to_be_bytes()).collect();
        assert_eq!(
            found(&[(b"gAMA", &45_455_u32.to_be_bytes()), (b"cHRM", &srgb)]),
            None
        );
        assert_eq!(found(&[(b"gAMA", &gamma)]), Some("a colour profile"));
        assert_eq!(found(&[(b"sRGB", &[0]), (b"gAMA", &gamma)]), None);
        assert_eq!(found(&[(b"cHRM", &[0; 32])]), Some("a colour profile"));
        assert_eq!(found(&[(b"IDAT", &[]), (b"iCCP", &[])]), None);
        assert_eq!(
            found(&[(b"pHYs", &[0, 0, 0, 1, 0, 0, 0, 2, 0])]),
            Some("non-square pixels")
        );
        assert_eq!(unfollowed(ImageCoding::Png, b"\x89PNG"), None);
    }

    #[test]
    fn flags_of_a_webp_count_if_it_is_extended() {
        let webp = |kind: &[u8], flags| [b"RIFF\0\0\0\0WEBP", kind, &[10, 0, 0, 0, flags]].concat();
        assert_eq!(
            unfollowed(ImageCoding::WebP, &webp(b"VP8X", 0x20)),
            Some("a colour profile")
        );
        assert_eq!(
            unfollowed(ImageCoding::WebP, &webp(b"VP8X", 0x02)),
            Some("an animation")
        );
        assert_eq!(unfollowed(ImageCoding::WebP, &webp(b"VP8L", 0x22)), None);
    }
}
