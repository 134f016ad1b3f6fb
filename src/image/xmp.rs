//! The provenance of a WebP, as XMP (ISO 16684-1): attributes of one description.

use super::merkle::from_hex;
use super::{MerkleTree, Origin};
use roxmltree::{Document, ParsingOptions};
use std::fmt::Write as _;

/// The namespaces of RDF, of XMP's own properties, and of those of this program.
const RDF: &str = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
const XMP: &str = "http://ns.adobe.com/xap/1.0/";
const RTC: &str = "urn:rtc:picture";

/// The packet; `None` if there is no provenance.
pub(super) fn packet(origin: &Origin, tree: Option<MerkleTree>) -> Option<String> {
    let Origin {
        software,
        scene,
        settings,
        world_to_camera: _,
        layer: _,
    } = origin;
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
pub(super) fn read(packet: &[u8]) -> (Origin, Option<MerkleTree>) {
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
    let origin = Origin {
        software: property(XMP, "CreatorTool"),
        scene: property(RTC, "scene"),
        settings: property(RTC, "settings"),
        ..Origin::default()
    };
    let tree = from_hex(&property(RTC, "tiles"));
    (origin, tree.as_deref().and_then(MerkleTree::read))
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
        let origin = Origin {
            software: "rtc 1".into(),
            scene: "a&b".into(),
            settings: "{\"size\":\"<2×2>\"}".into(),
            ..Origin::default()
        };
        let tree = MerkleTree::new(vec![TileHash::of_tile(b"a")], &origin);
        let packet_text = packet(&origin, Some(tree.clone())).unwrap();
        assert_eq!(read(packet_text.as_bytes()), (origin.clone(), Some(tree)));
        let bare = packet(&origin, None).unwrap();
        assert_eq!(read(bare.as_bytes()), (origin, None));
        assert_eq!(packet(&Origin::default(), None), None);
        assert_eq!(read(b"<a"), (Origin::default(), None));
        let many = bare.replace("</rdf:RDF>", &("<a/>".repeat(99) + "</rdf:RDF>"));
        assert_eq!(read(many.as_bytes()), (Origin::default(), None));
    }
}
