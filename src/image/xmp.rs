//! The provenance of a WebP, as XMP (ISO 16684-1): attributes of one description.

use super::merkle::from_hex;
use super::{MerkleTree, PictureMetadata};
use roxmltree::{Document, ParsingOptions};
use std::fmt::Write as _;

/// The namespaces of RDF, of XMP's own properties, and of those of this program.
const RDF: &str = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
const XMP: &str = "http://ns.adobe.com/xap/1.0/";
const RTC: &str = "urn:rtc:picture";

/// The packet; `None` if there is no provenance.
pub(super) fn packet(metadata: &PictureMetadata, tree: Option<MerkleTree>) -> Option<String> {
    let PictureMetadata {
        software,
        scene,
        settings,
        world_to_camera: _,
        layer: _,
    } = metadata;
    let tree = tree.map(|tree| tree.pruned().bytes());
    let mut hex = String::new();
    for byte in tree.into_iter().flatten() {
        write!(hex, "{byte:02x}").expect("a string takes all");
    }
    let properties = [
        ("xmp:CreatorTool", software),
        ("rtc:scene", scene),
        ("rtc:settings", settings),
        ("rtc:tiles", &hex),
    ];
    let mut attributes = String::new();
    for (name, text) in properties.iter().filter(|(_, text)| !text.is_empty()) {
        write!(attributes, " {name}=\"{}\"", escaped(text)).expect("a string takes all");
    }
    (!attributes.is_empty()).then(|| {
        format!(
            "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"{RDF}\">\
             <rdf:Description rdf:about=\"\" xmlns:xmp=\"{XMP}\" xmlns:rtc=\"{RTC}\"{attributes}/>\
             </rdf:RDF></x:xmpmeta>"
        )
    })
}

/// The provenance in such a packet; empty for another one.
pub(super) fn read(packet: &[u8]) -> (PictureMetadata, Option<MerkleTree>) {
    let text = std::str::from_utf8(packet).unwrap_or_default();
    let options = ParsingOptions {
        nodes_limit: 64,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, options).ok();
    let described = document.as_ref().and_then(|document| {
        let mut nodes = document.descendants();
        nodes.find(|node| node.has_tag_name((RDF, "Description")))
    });
    let property = |space, name| {
        let found = described.and_then(|node| node.attribute((space, name)));
        found.unwrap_or_default().to_owned()
    };
    let metadata = PictureMetadata {
        software: property(XMP, "CreatorTool"),
        scene: property(RTC, "scene"),
        settings: property(RTC, "settings"),
        ..PictureMetadata::default()
    };
    let tree = from_hex(&property(RTC, "tiles"));
    (metadata, tree.as_deref().and_then(MerkleTree::read))
}

/// Text within an attribute.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::super::TileHash;
    use super::*;

    #[test]
    fn what_is_said_comes_back() {
        let metadata = PictureMetadata {
            software: "rtc 1".into(),
            scene: "a&b".into(),
            settings: "{\"size\":\"<2×2>\"}".into(),
            ..PictureMetadata::default()
        };
        let tree = MerkleTree::new(vec![TileHash::of_tile(b"a")], &metadata);
        let packet_text = packet(&metadata, Some(tree.clone())).unwrap();
        assert_eq!(read(packet_text.as_bytes()), (metadata.clone(), Some(tree)));
        let bare = packet(&metadata, None).unwrap();
        assert_eq!(read(bare.as_bytes()), (metadata, None));
        assert_eq!(packet(&PictureMetadata::default(), None), None);
        assert_eq!(read(b"<a"), (PictureMetadata::default(), None));
        let many = bare.replace("</rdf:RDF>", &("<a/>".repeat(99) + "</rdf:RDF>"));
        assert_eq!(read(many.as_bytes()), (PictureMetadata::default(), None));
    }
}
