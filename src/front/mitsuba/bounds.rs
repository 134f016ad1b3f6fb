//! Bounds of a text before the XML parser reads it: the parser compares each attribute of an
//! element with each other one, and copies the namespaces that are in scope.

/// The most attributes of an element, and the most namespaces of a text.
const MAX_ATTRIBUTES: usize = 64;

/// Where a text has more than the parser compares quickly, and what.
pub(super) fn excess(text: &str) -> Option<(usize, String)> {
    let bytes = text.as_bytes();
    let (mut at, mut namespaces) = (0, 0);
    while let Some(start) = memchr::memchr(b'<', &bytes[at..]).map(|found| at + found) {
        let rest = &bytes[start..];
        let other = [
            (&b"<!--"[..], &b"-->"[..]),
            (b"<![CDATA[", b"]]>"),
            (b"<?", b"?>"),
        ];
        if let Some((open, close)) = other.into_iter().find(|(open, _)| rest.starts_with(open)) {
            let end = memchr::memmem::find(&rest[open.len()..], close)?;
            at = start + open.len() + end + close.len();
            continue;
        }
        let (length, attributes) = tag(rest);
        at = start + length;
        namespaces += memchr::memmem::find_iter(&rest[..length], "xmlns").count();
        for (count, what) in [
            (attributes, "an element has more than 64 attributes"),
            (namespaces, "the text has more than 64 namespaces"),
        ] {
            if count > MAX_ATTRIBUTES {
                return Some((start, what.to_owned()));
            }
        }
    }
    None
}

/// The bytes of a tag to its `>`, which is not within quotes, and its attributes.
fn tag(bytes: &[u8]) -> (usize, usize) {
    let (mut quote, mut attributes) = (None, 0);
    for (at, byte) in bytes.iter().enumerate() {
        match (quote, byte) {
            (Some(open), byte) if open == byte => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'=') => attributes += 1,
            (None, b'>') => return (at + 1, attributes),
            (None, _) => {}
        }
    }
    (bytes.len(), attributes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_attributes_or_namespaces_are_found_where_they_are() {
        let attributes = |count: usize| {
            let all: String = (0..count).map(|n| format!(" a{n}='=>'")).collect();
            format!("<scene><a{all}/></scene>")
        };
        assert_eq!(excess(&attributes(64)), None);
        assert_eq!(excess(&attributes(65)).unwrap().0, 7);
        let spaces = |count| "<a xmlns:b=\"c\"/>".repeat(count);
        assert_eq!(excess(&spaces(64)), None);
        assert!(excess(&spaces(65)).is_some());
    }

    #[test]
    fn comments_texts_and_instructions_have_neither() {
        let many = " a=\"1\" xmlns:b=\"2\"".repeat(100);
        for text in [
            format!("<!-- <a {many}> -->"),
            format!("<![CDATA[ <a {many}> ]]>"),
            format!("<? <a {many}> ?>"),
            format!("<a>{many}</a>"),
            "<!-- never closed".to_owned(),
            "<a b=\"".to_owned(),
        ] {
            assert_eq!(excess(&text), None, "{text}");
        }
    }
}
