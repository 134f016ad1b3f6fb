//! The MTL files that an OBJ names, and their materials as Phong's model says them.

use super::mesh::MeshFile;
use super::text::TextKind;
use super::{Asset, Porter, Wanted, Without};
use crate::mesh::Named;
use crate::mesh::mtl::{Library, MtlMaterial, Said, is_mtl, parse};
use rtc_diag::{Diagnostic, Severity, codes};
use rtc_ir::{
    Bump, Field, Image, Lowered, Material, MaterialId, Mode, Noun, Phong, Pixels, Place, Texture,
    TextureId,
};
use rtc_source::{FileId, FileKind, Span};
use std::collections::BTreeMap;

/// Such files.
pub(super) const TEXT: TextKind = TextKind {
    noun: "material",
    is_not: "no MTL",
    code: &codes::BAD_MTL,
    without: Without::Materials,
    max_bytes: 1 << 24,
    file: FileKind {
        extensions: &["mtl"],
        begins: is_mtl,
    },
};

/// The part of the light that a surface scatters as ambient light, at most: programs write a `Ka` of
/// 1 and mean an ambient light that scenes of the course don't have.
const MOST_AMBIENT: f64 = 0.2;

/// The materials brought so far, and the images that they wait for.
#[derive(Default)]
pub(super) struct Shelf {
    pub(super) wanted: Vec<Wanted>,
    textures: BTreeMap<String, TextureId>,
}

/// A library with its file.
struct Shelved {
    library: Library,
    file: FileId,
    /// Its path from a folder that is searched.
    path: String,
}

impl MeshFile {
    /// The libraries that the file names and that can be found, with a word on those that can't, if
    /// `tells`.
    fn libraries<'a>(
        &'a self,
        porter: &'a Porter<'_>,
    ) -> impl Iterator<Item = (Wanted, &'a Named)> {
        let wish = |named: &Named| Wanted {
            asset: Asset::Materials,
            path: beside(&self.path, &named.text),
            span: Some(named.at.span(self.file)),
        };
        let named = self
            .material_use
            .libraries
            .iter()
            .map(move |named| (wish(named), named));
        named.filter(|(wish, _)| porter.search.find(&wish.path, &TEXT.file).is_ok())
    }

    /// Whether it asks for materials of a file that is there.
    pub(super) fn has_library(&self, porter: &Porter<'_>) -> bool {
        self.material_use.names_any() && self.libraries(porter).next().is_some()
    }

    /// The material of the scene for each material that the faces ask for; `None` if there is none
    /// at all.
    pub(super) fn materials(
        &self,
        shelf: &mut Shelf,
        lowered: &mut Lowered,
        porter: &mut Porter<'_>,
    ) -> Option<Vec<Option<MaterialId>>> {
        if !self.material_use.names_any() {
            return None;
        }
        let libraries = self.read(porter);
        if libraries.is_empty() {
            return None;
        }
        let mut materials = Vec::with_capacity(self.material_use.materials.len());
        let mut unknown: Option<(&Named, usize)> = None;
        for named in &self.material_use.materials {
            let place = libraries
                .iter()
                .find_map(|shelved| Some((shelved, shelved.library.materials.get(&named.text)?)));
            if place.is_none() && !named.text.is_empty() {
                unknown.get_or_insert((named, 0)).1 += 1;
            }
            materials.push(place.map(|(shelved, material)| shelf.add(shelved, material, lowered)));
        }
        if let Some((first, count)) = unknown {
            let more = match count {
                1 => String::new(),
                _ => format!(", nor {} more that faces ask for", count - 1),
            };
            let message = format!("the MTL has no material `{}`{more}", first.text);
            let finding = Diagnostic::new(&codes::BAD_MTL, message);
            porter
                .sink
                .push(finding.at(first.at.span(self.file), "faces go without it"));
        }
        self.note_mirrors(&libraries, lowered, porter);
        materials.iter().any(Option::is_some).then_some(materials)
    }

    fn read(&self, porter: &mut Porter<'_>) -> Vec<Shelved> {
        let wishes: Vec<_> = self.libraries(porter).map(|(wish, _)| wish).collect();
        if let (true, Some(named)) = (wishes.is_empty(), self.material_use.libraries.first()) {
            let message = format!(
                "there is no file `{}`; {}",
                named.text,
                Without::Materials.consequence()
            );
            let finding = Diagnostic::new(&codes::BAD_MTL, message);
            porter
                .sink
                .push(finding.at(named.at.span(self.file), "not found"));
        }
        let mut libraries = Vec::new();
        for wish in wishes {
            let Some(found) = porter.find(&wish, Without::Materials) else {
                continue;
            };
            let path = porter.search.path_to(&found).unwrap_or_default();
            if let Some((file, library)) = porter.read_text(&found, &wish, &TEXT, parse) {
                tell(&library, file, porter);
                libraries.push(Shelved {
                    library,
                    file,
                    path,
                });
            }
        }
        libraries
    }

    /// Says once that a highlight mirrors here, where its file says that it does not.
    fn note_mirrors(&self, libraries: &[Shelved], lowered: &Lowered, porter: &mut Porter<'_>) {
        let settings = &lowered.scene.settings;
        if settings.max_depth == 0 || settings.mode != Mode::Phong {
            return;
        }
        let place = |shelved: &Shelved| -> Option<Span> {
            let is_asked = |named: &&Named| shelved.library.materials.contains_key(&named.text);
            let asked = self.material_use.materials.iter().filter(is_asked);
            let mut mirrors = asked.filter_map(|named| {
                let material = shelved.library.materials.get(&named.text)?;
                let is_mirror = material.model.as_ref().is_some_and(|model| model.value > 2);
                let specular = material.specular.as_ref()?;
                (!is_mirror && weight(material) > 0.0).then(|| specular.at.span(shelved.file))
            });
            mirrors.next()
        };
        if let Some(span) = libraries.iter().find_map(place) {
            let note = Diagnostic::new(&codes::TWO_READINGS, "the `Ks` of an MTL mirrors here");
            let note = note.severity(Severity::Note);
            porter.sink.push(
                note.at(span, "in some programs a highlight alone")
                    .hint("the scene follows mirrors; `MaxRecursionDepth: 0` does not"),
            );
        }
    }
}

/// What is wrong with a file of materials.
fn tell(library: &Library, file: FileId, porter: &mut Porter<'_>) {
    let Library {
        materials: _,
        faults,
        not_shown,
    } = library;
    for fault in faults {
        let finding = Diagnostic::new(&codes::BAD_MTL, fault.message.as_str());
        porter
            .sink
            .push(finding.at(fault.span(file), fault.label.as_str()));
    }
    if let Some((first, count)) = not_shown {
        let message = match count {
            1 => format!("a statement of the MTL has no effect: {}", first.message),
            _ => format!(
                "{count} statements of the MTL have no effect: {}",
                first.message
            ),
        };
        let finding = Diagnostic::new(&codes::BAD_MTL, message);
        porter
            .sink
            .push(finding.at(first.span(file), first.label.as_str()));
    }
}

/// The path of a file named in the one at `path`; of a path from a root or a drive the last part.
fn beside(path: &str, name: &str) -> String {
    let name = name.replace('\\', "/");
    let is_absolute = name.starts_with('/') || name.as_bytes().get(1) == Some(&b':');
    let name = match name.rsplit_once('/') {
        Some((_, last)) if is_absolute => last,
        _ => &name,
    };
    match path.rsplit_once('/') {
        Some((folder, _)) => format!("{folder}/{name}"),
        None => name.to_owned(),
    }
}

/// The mean of three channels, of grey to the last bit.
fn mean([r, g, b]: [f64; 3]) -> f64 {
    if r == g && g == b {
        r
    } else {
        (r + g + b) / 3.0
    }
}

/// The weight of the highlight.
fn weight(material: &MtlMaterial) -> f64 {
    let is_matt = material.model.as_ref().is_some_and(|model| model.value < 2);
    let specular = material.specular.as_ref().filter(|_| !is_matt);
    specular.map_or(0.0, |specular| mean(specular.value))
}

/// The numbers of a material in Phong's model; its maps aside.
fn phong(material: &MtlMaterial) -> Phong {
    let diffuse = material.diffuse.as_ref().map(|diffuse| diffuse.value);
    let largest = diffuse.map_or(1.0, |[r, g, b]| r.max(g).max(b));
    let color = diffuse.unwrap_or([DIFFUSE; 3]);
    let kd = match material.color_map {
        // A map of something black would be as good as none.
        Some(_) if largest > 0.0 => largest,
        _ => 1.0,
    };
    let ambient = material.ambient.as_ref();
    let ka = ambient.map_or(MOST_AMBIENT, |ambient| mean(ambient.value));
    let bends = material.model.as_ref();
    let is_glass = bends.is_some_and(|model| matches!(model.value, 4 | 6 | 7 | 9));
    let clear = if is_glass { 0.0 } else { 1.0 };
    let opacity = material
        .opacity
        .as_ref()
        .map_or(clear, |opacity| opacity.value);
    let index = material.index.as_ref().map_or(1.0, |index| index.value);
    Phong {
        color,
        ka: opacity * ka.min(MOST_AMBIENT),
        kd: opacity * kd,
        ks: weight(material),
        n: material
            .exponent
            .as_ref()
            .map_or(EXPONENT, |exponent| exponent.value),
        kt: 1.0 - opacity,
        eta: if is_glass && opacity < 1.0 && index > 0.0 {
            index
        } else {
            1.0
        },
        ..Phong::MATT
    }
}

/// The diffuse reflectance of a material that says none.
const DIFFUSE: f64 = 0.8;

/// The exponent of a material that says none.
const EXPONENT: f64 = 10.0;

impl Shelf {
    /// Adds a material to the scene.
    fn add(
        &mut self,
        shelved: &Shelved,
        material: &MtlMaterial,
        lowered: &mut Lowered,
    ) -> MaterialId {
        let mut phong = phong(material);
        let mut map = |slot: &Option<Said<String>>, lowered: &mut Lowered| {
            Some(self.texture(shelved, slot.as_ref()?, lowered))
        };
        phong.color_map = map(&material.color_map, lowered);
        phong.specular_map = map(&material.specular_map, lowered);
        phong.normal_map = map(&material.normal_map, lowered);
        phong.bump = map(&material.bump, lowered).map(|texture| Bump {
            texture,
            height: 1.0,
        });
        let Lowered { scene, origins } = lowered;
        let index = scene.materials.len();
        scene.materials.push(Material::Phong(phong));
        let bump = material.bump.as_ref().map(|bump| bump.at);
        for (field, at) in [(Field::Whole, Some(material.at)), (Field::Bump, bump)] {
            let span = at.map(|at| at.span(shelved.file));
            origins.record(Place::new(Noun::Material, index, field), span);
        }
        MaterialId(id(index))
    }

    /// The texture of a file that a material names, of one white pixel until the file is there.
    fn texture(
        &mut self,
        shelved: &Shelved,
        file: &Said<String>,
        lowered: &mut Lowered,
    ) -> TextureId {
        let path = beside(&shelved.path, &file.value);
        if let Some(known) = self.textures.get(&path) {
            return *known;
        }
        let scene = &mut lowered.scene;
        let image = scene.add_image(Image {
            name: path.clone(),
            width: 1,
            height: 1,
            kind: Pixels::Rgb8,
            pixels: vec![255; 3].into(),
        });
        let texture = TextureId(id(scene.textures.len()));
        scene.textures.push(Texture::Image(image));
        self.wanted.push(Wanted {
            asset: Asset::Map(image),
            path: path.clone(),
            span: Some(file.at.span(shelved.file)),
        });
        self.textures.insert(path, texture);
        texture
    }
}

/// An index of the scene.
fn id(index: usize) -> u32 {
    u32::try_from(index).unwrap_or(u32::MAX)
}
