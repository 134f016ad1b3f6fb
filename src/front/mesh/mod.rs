//! Readers of mesh files: OBJ with MTL, OFF, STL, PLY, and XYZ point lists.
//!
//! The content decides the format, not the name of the file. Each reader turns bytes into a
//! [`ParsedMesh`]: an IR mesh, the materials that the file names, and the errors of the file. The
//! caller (`front/course/assets`) locates the file and turns errors into diagnostics.
//!
//! - `obj` and `mtl`: Wavefront OBJ and its material libraries. `material_use` records which
//!   triangles use which material.
//! - `off`: the object file format of Geomview.
//! - `stl`: binary and text.
//! - `ply`: binary of either byte order, and text.
//! - `xyz`: one point per line, with a color or a normal.
//!
//! Shared steps: `polygons` collects polygons until all vertices are known, `polygon`
//! triangulates them by ear clipping with exact predicates, `stroke` makes meshes of points and
//! lines, and `tint` finds the range of vertex colors that a file does not declare.
//!
//! Files are not trusted. The memory of a mesh is charged to the budget before it is allocated, and
//! no count in a file causes an allocation before the file is known to be long enough.

mod material_use;
pub mod mtl;
mod obj;
mod off;
mod ply;
pub(crate) use ply::PlyColors;
mod polygon;
pub(crate) use polygon::EarClipper;
mod polygons;
mod stl;
mod stroke;
mod tint;
mod xyz;

pub use crate::words::{TextParseError, WordError, WordSpan};
pub use material_use::{MaterialUse, SpannedName};

use crate::words::{Word, WordLines};
use rtc_ir::Mesh;
use rtc_source::{Budget, LimitExceeded, Resource};
use stroke::{Segments, StrokeMesher, join};

/// The maximum number of errors reported for one file.
pub const MAX_FAULTS: usize = 10;

/// The options of reading a mesh file.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MeshOptions {
    /// Whether mistakes that other readers repair are repaired.
    pub is_lenient: bool,
    /// The diameter of points in pixels of the default view; by their density by default.
    pub point_size: Option<f64>,
}

/// A mesh file as read.
#[derive(Debug, Default)]
pub struct ParsedMesh {
    /// The mesh, without a name, in the precision of the file: normals, texture coordinates,
    /// tangents and colours only where the file has some, colours at least 0, indices in range.
    pub mesh: Mesh,
    /// Elements that don't show: the first, and how many.
    pub not_drawn: Option<(WordError, usize)>,
    /// What else of the file the picture does not show.
    pub remarks: Vec<WordError>,
    /// Whether the colours of its vertices are the radiance that they show.
    pub is_unlit: bool,
    /// What was repaired: the first, and how many.
    pub repaired: Option<(WordError, usize)>,
    /// Its materials.
    pub material_use: MaterialUse,
    /// The picture of all its faces, where it names one itself.
    pub texture: Option<SpannedName>,
}

impl ParsedMesh {
    /// What of the file is not drawn, in words; `None` if all is.
    pub(crate) fn loss(&self) -> Option<String> {
        let (first, count) = self.not_drawn.as_ref()?;
        let elements = match count {
            1 => "an element of the file is not drawn".to_owned(),
            count => format!("{count} elements of the file are not drawn"),
        };
        Some(format!("{elements}: {}", first.message))
    }

    /// What of the file was repaired, in words.
    pub(crate) fn repair(&self) -> Option<String> {
        let (first, count) = self.repaired.as_ref()?;
        let more = match count {
            1 => String::new(),
            count => format!(", {count} times"),
        };
        let repair = first.repair.unwrap_or_default();
        Some(format!("{}{more}: {repair}", first.message))
    }

    /// Notes a repair; only the first error is kept.
    fn note_repair(&mut self, fault: WordError) {
        self.repaired.get_or_insert((fault, 0)).1 += 1;
    }

    /// Reports an element that is not rendered; only the first error is kept.
    fn skip(&mut self, fault: impl FnOnce() -> WordError) {
        self.not_drawn.get_or_insert_with(|| (fault(), 0)).1 += 1;
    }

    /// Adds the tessellation of points and lines between its vertices.
    ///
    /// # Errors
    /// If that would take more memory than there is.
    fn draw(
        &mut self,
        segments: Segments,
        options: MeshOptions,
        budget: &Budget,
    ) -> Result<(), LimitExceeded> {
        if segments.ends.is_empty() {
            return Ok(());
        }
        let drawn_meshes = StrokeMesher::new(&self.mesh, options, budget).draw(segments)?;
        join(&mut self.mesh, drawn_meshes);
        Ok(())
    }
}

/// The bytes per vertex of a mesh, in 64 bits.
fn columns(mesh: &Mesh) -> u64 {
    let column = |exists: bool, numbers: u64| if exists { 8 * numbers } else { 0 };
    column(true, 3)
        + column(!mesh.normals.is_empty(), 3)
        + column(!mesh.uvs.is_empty(), 2)
        + column(!mesh.second_uvs.is_empty(), 2)
        + column(!mesh.tangents.is_empty(), 4)
        + column(!mesh.colors.is_empty(), 2)
}

/// Charges a mesh, and frees its spare capacity.
fn charge(mesh: &mut Mesh, budget: &Budget) -> Result<(), LimitExceeded> {
    let Mesh {
        name: _,
        part: _,
        positions,
        normals,
        uvs,
        second_uvs,
        tangents,
        colors,
        triangles,
    } = mesh;
    triangles.shrink_to_fit();
    budget.charge(Resource::Vertices, positions.len() as u64)?;
    let bytes = positions.bytes()
        + normals.bytes()
        + uvs.bytes()
        + second_uvs.bytes()
        + tangents.bytes()
        + colors.bytes()
        + size_of_val(triangles.as_slice());
    budget.charge(Resource::Memory, bytes as u64)
}

/// The extensions of mesh files, in lower case.
pub const EXTENSIONS: &[&str] = &["obj", "off", "stl", "ply", "xyz"];

/// Whether a file of this name and these bytes is a mesh.
#[must_use]
pub fn is_mesh_file(name: &str, bytes: &[u8]) -> bool {
    let extension = name.rsplit_once('.').map(|(_, last)| last.to_lowercase());
    extension.is_some_and(|extension| EXTENSIONS.contains(&&*extension)) || is_mesh(bytes)
}

/// The maximum number of bytes inspected to detect the format: a line takes some twenty times its
/// length.
const LOOKED_AT: usize = 1 << 18;

/// The lines of a file for detecting its format.
fn first_lines(bytes: &[u8]) -> WordLines<'_> {
    WordLines::new(&bytes[..bytes.len().min(LOOKED_AT)])
}

/// Whether a file that begins so is a mesh: it starts as PLY, STL or OFF, or as OBJ and has a
/// vertex.
#[must_use]
pub fn is_mesh(head: &[u8]) -> bool {
    if ply::is_head(head) || stl::is_head(head) {
        return true;
    }
    let (mut lines, mut words) = (first_lines(head), Vec::new());
    let has_words = lines.next(&mut words);
    if !has_words || !obj::is_keyword(&words[0]) {
        return has_words && (off::is_head(&words[0]) || xyz::is_head(head));
    }
    let is_vertex = |words: &[Word<'_>]| match words {
        [Word { bytes: b"v", .. }, x, ..] => x.number().is_ok(),
        _ => false,
    };
    while !is_vertex(&words) {
        if !lines.next(&mut words) {
            return false;
        }
    }
    true
}

/// The mesh of a PLY with the colours of its vertices or of its faces.
///
/// # Errors
/// If it has errors, or exceeds the budget.
pub(crate) fn parse_colored_ply(
    bytes: &[u8],
    colors: PlyColors,
    budget: &Budget,
) -> Result<ParsedMesh, TextParseError> {
    let mut parsed = ply::parse(bytes, colors, MeshOptions::default(), budget)?;
    charge(&mut parsed.mesh, budget)?;
    Ok(parsed)
}

/// Reads a mesh file of any format.
///
/// # Errors
/// If it has errors, or exceeds the budget.
pub fn parse(bytes: &[u8], budget: &Budget) -> Result<ParsedMesh, TextParseError> {
    parse_with(bytes, MeshOptions::default(), budget)
}

/// As [`parse`], with options.
///
/// # Errors
/// As [`parse`].
pub fn parse_with(
    bytes: &[u8],
    options: MeshOptions,
    budget: &Budget,
) -> Result<ParsedMesh, TextParseError> {
    let mut words = Vec::new();
    first_lines(bytes).next(&mut words);
    let mut parsed = match words.first() {
        _ if ply::is_head(bytes) => ply::parse(bytes, ply::PlyColors::Reported, options, budget)?,
        _ if stl::is_head(bytes) => stl::parse(bytes, options, budget)?,
        Some(head) if off::is_head(head) => off::parse(bytes, options, budget)?,
        _ if xyz::is_head(bytes) => xyz::parse(bytes, options, budget)?,
        Some(_) | None => obj::parse(bytes, options, budget)?,
    };
    if parsed.mesh.triangles.is_empty() && parsed.not_drawn.is_none() {
        // Of points alone the vertices themselves are not kept.
        let vertices = std::mem::take(&mut parsed.mesh);
        let points =
            StrokeMesher::new(&vertices, options, budget).draw(Segments::points(&vertices))?;
        join(&mut parsed.mesh, points);
    }
    charge(&mut parsed.mesh, budget)?;
    if parsed.mesh.triangles.is_empty() {
        let head = words.first().filter(|head| head.bytes.len() < 80);
        let none = || {
            head.unwrap_or(&Word::START)
                .fault("the mesh has no faces, lines or points", "nothing is drawn")
        };
        let fault = parsed.not_drawn.map_or_else(none, |(fault, _)| fault);
        return Err(TextParseError::Faults(vec![fault]));
    }
    Ok(parsed)
}
