//! PLY (Turk, "The PLY polygon file format", 1994), as text or binary of either byte order.
//!
//! Nothing is allocated by a count before the file was found long enough for it.

mod body;
mod head;
mod vertex;

use super::polygons::{CORNER, Polygons};
use super::stroke::Segments;
use super::tint::decoded;
use super::{MeshOptions, ParsedMesh, TextParseError};
use crate::splat::{self, Splat};
use crate::words::{Word, WordError};
use body::PlyBody;
use head::{PlyElement, PlyProperty};
use rtc_math::VertexColumn;
use rtc_source::{Budget, LimitExceeded, Resource};

/// True if a file that begins so is a PLY.
pub(super) fn is_head(head: &[u8]) -> bool {
    head.starts_with(b"ply\n") || head.starts_with(b"ply\r")
}

/// Which colours a mesh has where both its vertices and its faces have some.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlyColors {
    /// Those of the vertices; that the others are left out is reported.
    Reported,
    /// Those of the vertices alone.
    Vertices,
    /// Those of the faces alone.
    Faces,
}

/// Reads a PLY. Of vertices it keeps positions, normals, texture coordinates, tangents and colours,
/// of faces and strips their corners, of faces colours and texture coordinates, and edges.
pub(super) fn parse(
    bytes: &[u8],
    colors: PlyColors,
    options: MeshOptions,
    budget: &Budget,
) -> Result<ParsedMesh, TextParseError> {
    let one = |fault| TextParseError::Faults(vec![fault]);
    let mut head = head::read(bytes).map_err(one)?;
    let mut reader = PlyReader {
        body: PlyBody::new(bytes, &head),
        vertices: head.vertices(),
        parsed: ParsedMesh::default(),
        polygons: Polygons::default(),
        strokes: Segments::default(),
        splats: Vec::new(),
        long: 0,
    };
    for element in &head.elements {
        reader.element(element, budget)?;
    }
    let mut parsed = reader.finish(colors, options, budget)?;
    if let Some((texture, count)) = head.textures.take() {
        parsed.material_use.face(0);
        parsed.texture = Some(texture);
        for _ in 1..count {
            parsed.skip(|| Word::START.fault("faces have one picture alone", "it names more"));
        }
    }
    Ok(parsed)
}

/// The state so far.
struct PlyReader<'a> {
    body: PlyBody<'a>,
    /// The declared number of vertices.
    vertices: usize,
    parsed: ParsedMesh,
    polygons: Polygons,
    strokes: Segments,
    /// The vertices as splats, if they are such.
    splats: Vec<Splat>,
    /// The number of face rows with too many values.
    long: usize,
}

impl<'a> PlyReader<'a> {
    fn element(&mut self, element: &PlyElement<'a>, budget: &Budget) -> Result<(), TextParseError> {
        let one = |fault| TextParseError::Faults(vec![fault]);
        if !self.body.has_room(element) {
            return Err(one(element.is_cut_off()));
        }
        match element.name.bytes {
            b"vertex" => {
                let unread = vertex::unread(element);
                // The higher harmonics of splats have a remark of their own.
                let is_rest =
                    |property: &&PlyProperty<'_>| property.name.bytes.starts_with(b"f_rest_");
                let is_splat = |property: &PlyProperty<'_>| property.name.bytes == b"f_dc_0";
                let has_splats = element.properties.iter().any(is_splat);
                let unread = unread
                    .into_iter()
                    .filter(|name| !(has_splats && is_rest(name)));
                self.remark_unread(element, &unread.collect::<Vec<_>>());
                let mesh = &mut self.parsed.mesh;
                self.splats = vertex::read(element, &mut self.body, mesh, budget)?;
                if !self.splats.is_empty() {
                    let remark = element.name.fault(splat::APPROXIMATION, "these");
                    self.parsed.remarks.push(remark);
                }
            }
            // A list of empty elements.
            _ if element.properties.is_empty() => {}
            b"face" | b"tristrips" | b"edge" => {
                let corner = element
                    .properties
                    .iter()
                    .find(|property| property.is_corners());
                let size = corner.map_or(1, |corner| self.body.least(corner.kind));
                let at_most = CORNER * self.body.left() / size;
                budget.has(Resource::Memory, at_most as u64)?;
                if element.name.bytes == b"face" {
                    let is_read = |property: &&PlyProperty<'_>| {
                        let is_list = property.is_corners() || property.is_uvs();
                        is_list || vertex::channel(property).is_some()
                    };
                    let properties = element.properties.iter();
                    let unread = properties.filter(|property| !is_read(property));
                    self.remark_unread(element, &unread.collect::<Vec<_>>());
                }
                match element.name.bytes {
                    b"face" => self.faces(element).map_err(one)?,
                    b"edge" => self.edges(element).map_err(one)?,
                    _ => self.strips(element).map_err(one)?,
                }
            }
            _ => {
                self.remark_unread(element, &element.properties.iter().collect::<Vec<_>>());
                self.skip(element).map_err(one)?;
            }
        }
        Ok(())
    }

    /// Tells that properties of an element are not read.
    fn remark_unread(&mut self, element: &PlyElement<'a>, unread: &[&PlyProperty<'a>]) {
        const NAMED: usize = 6;
        let Some(first) = unread.first().filter(|_| element.count > 0) else {
            return;
        };
        let names = unread.iter().take(NAMED);
        let names: Vec<_> = names.map(|one| format!("`{}`", one.name.text())).collect();
        let more = match unread.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let message = format!(
            "properties of `{}` are not read: {}{more}",
            element.name.text(),
            names.join(", ")
        );
        let remark = first.name.fault(message, "the first one");
        self.parsed.remarks.push(remark);
    }

    fn finish(
        self,
        colors: PlyColors,
        options: MeshOptions,
        budget: &Budget,
    ) -> Result<ParsedMesh, LimitExceeded> {
        let Self {
            mut parsed,
            mut polygons,
            strokes,
            splats,
            long,
            ..
        } = self;
        if polygons.count() == 0 && !splats.is_empty() {
            parsed.mesh = splat::mesh(&splats);
            parsed.is_unlit = true;
            return Ok(parsed);
        }
        // Where lines are longer than they should be, which number is which part of a colour is
        // open.
        if long > 0 || polygons.colors.len() < polygons.count() {
            polygons.colors.clear();
        }
        if polygons.uvs.len() < polygons.corners() {
            polygons.uvs.clear();
        }
        match colors {
            PlyColors::Reported => {}
            PlyColors::Vertices => polygons.colors.clear(),
            PlyColors::Faces => parsed.mesh.colors = VertexColumn::default(),
        }
        if !polygons.colors.is_empty() && !parsed.mesh.colors.is_empty() {
            polygons.colors.clear();
            parsed.skip(|| Word::START.fault("its vertices have colours", "faces have too"));
        }
        let missing = || Word::START.fault("a corner is not there", "in this file");
        polygons.cut(&mut parsed, missing, budget)?;
        parsed.draw(strokes, options, budget)?;
        Ok(parsed)
    }

    /// The vertex that the next number refers to; `None`, with an error, if there is none.
    fn vertex(
        &mut self,
        property: &PlyProperty<'_>,
        element: &PlyElement<'_>,
    ) -> Result<Option<u32>, WordError> {
        let number = self.body.number(property.kind, element)?;
        Ok(whole(number).filter(|vertex| (*vertex as usize) < self.vertices))
    }

    /// An element does not show, since the vertex that was read last is not there.
    fn no_vertex(&mut self) {
        let Self {
            body,
            parsed,
            vertices,
            ..
        } = self;
        parsed.skip(|| {
            let message = format!("it refers to a vertex that is not one of {vertices}, from 0");
            body.fault(&message, "there is no such vertex")
        });
    }

    fn faces(&mut self, element: &PlyElement<'_>) -> Result<(), WordError> {
        // Find the properties that are colour channels.
        let channels: Vec<_> = element.properties.iter().map(vertex::channel).collect();
        for _ in 0..element.count {
            let (mut color, mut is_sound) = ([0.0, 0.0, 0.0, 1.0_f32], true);
            let (mut has_color, mut corners) = (false, 0);
            let mut uvs = Vec::new();
            // Read the corners, coordinates and colour of a row.
            for (property, channel) in element.properties.iter().zip(&channels) {
                match (property.length, channel) {
                    (Some(length), _) if property.is_corners() => {
                        corners = self.body.count(length, element)?;
                        is_sound = self.corners(corners, property, element)?;
                    }
                    (Some(length), _) if property.is_uvs() => {
                        for _ in 0..self.body.count(length, element)? {
                            uvs.push(self.body.number(property.kind, element)?);
                        }
                    }
                    (None, Some(channel)) => {
                        let number = self.body.number(channel.kind, element)?;
                        let fraction = channel.kind.fraction(number);
                        color[channel.index] = match channel.index {
                            0..3 if !channel.is_linear => decoded(fraction),
                            _ => opacity(fraction),
                        };
                        has_color = true;
                    }
                    _ => self.body.skip(property, element)?,
                }
            }
            // Report what does not fit.
            if self.body.end_row() {
                self.long += 1;
                let body = &self.body;
                let message = "a line has more numbers than properties, so its colour is open";
                self.parsed
                    .skip(|| body.line_fault(message, "the first such line"));
            }
            // Keep a sound face with at least three corners.
            if !is_sound || corners < 3 {
                self.polygons.discard_polygon();
            }
            if is_sound && corners < 3 {
                let name = &element.name;
                self.parsed
                    .skip(|| name.fault("faces need three corners", "one of these"));
            }
            if is_sound && corners >= 3 {
                self.polygons.end();
                if has_color {
                    self.polygons.colors.push(color);
                }
                let pairs = uvs.as_chunks::<2>().0;
                if pairs.len() == corners as usize
                    && pairs.iter().flatten().all(|uv| uv.is_finite())
                {
                    self.polygons.uvs.extend(pairs);
                }
            }
        }
        Ok(())
    }

    /// Adds the corners of a face; whether all are there.
    fn corners(
        &mut self,
        count: u32,
        property: &PlyProperty<'_>,
        element: &PlyElement<'_>,
    ) -> Result<bool, WordError> {
        let mut is_sound = true;
        for _ in 0..count {
            match self.vertex(property, element)? {
                Some(vertex) => self.polygons.corner(vertex),
                None if is_sound => {
                    is_sound = false;
                    self.no_vertex();
                }
                None => {}
            }
        }
        Ok(is_sound)
    }

    /// Strips of triangles, each next one turned over; −1 begins another.
    fn strips(&mut self, element: &PlyElement<'_>) -> Result<(), WordError> {
        for _ in 0..element.count {
            for property in &element.properties {
                let Some(length) = property.length.filter(|_| property.is_corners()) else {
                    self.body.skip(property, element)?;
                    continue;
                };
                let mut strip: Vec<u32> = Vec::new();
                let mut is_odd = false;
                for _ in 0..self.body.count(length, element)? {
                    let Some(corner) = self.vertex(property, element)? else {
                        if !self.body.last_is(-1.0) {
                            self.no_vertex();
                        }
                        (strip, is_odd) = (Vec::new(), false);
                        continue;
                    };
                    if let [a, b] = *strip {
                        // A repeated corner turns the strip, and adds no triangle.
                        if a != b && b != corner && corner != a {
                            let three = if is_odd {
                                [b, a, corner]
                            } else {
                                [a, b, corner]
                            };
                            three
                                .into_iter()
                                .for_each(|property| self.polygons.corner(property));
                            self.polygons.end();
                        }
                        is_odd = !is_odd;
                        strip.remove(0);
                    }
                    strip.push(corner);
                }
            }
            self.body.end_row();
        }
        Ok(())
    }

    /// Lines from a vertex to another.
    fn edges(&mut self, element: &PlyElement<'_>) -> Result<(), WordError> {
        let is_end =
            |property: &&PlyProperty<'_>| matches!(property.name.bytes, b"vertex1" | b"vertex2");
        if element.properties.iter().filter(is_end).count() != 2 {
            return self.skip(element);
        }
        for _ in 0..element.count {
            let mut ends = Vec::new();
            for property in &element.properties {
                if matches!(property.name.bytes, b"vertex1" | b"vertex2")
                    && property.length.is_none()
                {
                    ends.push(self.vertex(property, element)?);
                } else {
                    self.body.skip(property, element)?;
                }
            }
            self.body.end_row();
            match *ends {
                [Some(from), Some(to)] => self.strokes.row(&[from, to]),
                _ => self.no_vertex(),
            }
        }
        Ok(())
    }

    fn skip(&mut self, element: &PlyElement<'_>) -> Result<(), WordError> {
        for _ in 0..element.count {
            for property in &element.properties {
                self.body.skip(property, element)?;
            }
            self.body.end_row();
        }
        Ok(())
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "rounded to what the IR stores"
)]
fn opacity(alpha: f64) -> f32 {
    alpha as f32
}

/// A number that is an index.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole and in range"
)]
fn whole(number: f64) -> Option<u32> {
    let is_whole = number.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&number);
    is_whole.then_some(number as u32)
}
