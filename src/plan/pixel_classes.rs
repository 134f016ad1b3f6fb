//! The classes of pixels: empty, one flat surface of one value, or anything.
//!
//! The picture is divided into a limited number of square cells. Each surface is counted in the
//! cells that its screen rectangle overlaps (as differences at its corners; a 2-D prefix sum gives
//! the counts). A cell with count 0 is empty.

use super::margin::VisibleSides;
use super::projection::{PixelRect, ScreenProjection, ScreenRect};
use super::rules::Rule;
use super::shape::shape_facts;
use super::surface_bounds::ShapeClass;
use super::{RuleResults, SceneFacts};
use rtc_valid::{Mode, Shape};

/// The maximum number of cells of a picture.
const MAX_CELLS: u64 = 1 << 18;

/// The margin in pixels between the samples of a pixel and the edge of the surface that covers it.
const MARGIN: f64 = 1.0;

/// The class of a pixel, by the possible hits of its rays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelClass {
    /// Nothing.
    Nothing,
    /// All rays hit one flat surface of one value.
    Uniform,
    /// Any surfaces.
    Anything,
}

/// A grid over the picture that tells the class of each pixel.
#[derive(Clone, Debug, Default)]
pub struct PixelClassGrid {
    /// The width of a cell is 2 to this power, in pixels.
    shift: u32,
    /// The number of cells in a row; 0 if no pixel has a known class.
    columns: usize,
    cells: Vec<CellVisibility>,
    /// Convex polygons on the screen, each inside a surface of one value.
    polygons: Vec<Vec<[f64; 2]>>,
    /// Whether empty pixels may be skipped.
    skips_empty: bool,
}

/// What the pixels of a cell may show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellVisibility {
    Nothing,
    /// One surface of one value, by the index of its polygon.
    One(u32),
    Anything,
}

impl PixelClassGrid {
    pub(super) fn new(
        findings: &RuleResults<'_>,
        projection: &ScreenProjection,
        screen_rects: &[ScreenRect],
    ) -> Self {
        // Without rules or bounds, nothing is known about any pixel.
        let rules = findings.facts.rules;
        let is_wanted = rules.contains(Rule::PixelMiss) || rules.contains(Rule::PixelFlat);
        if !is_wanted || screen_rects.contains(&ScreenRect::Unknown) {
            return Self::default();
        }
        let (mut grid, mut polygons) = (CellGrid::new(findings), Vec::new());
        let flats = findings.has_flat_pixels();
        // Mark the cells that each surface may cover.
        for (surface, rect) in screen_rects.iter().enumerate() {
            let ScreenRect::Within(rect) = rect else {
                continue;
            };
            let polygon = if flats {
                findings.polygon(surface, projection)
            } else {
                None
            };
            // A cell inside the polygon of one flat surface has its value.
            let mark = polygon.map_or(0, |polygon| {
                polygons.push(polygon);
                polygons.len() as i64
            });
            grid.add(*rect, mark);
        }
        let cells = grid.cells();
        let (shift, columns) = (grid.shift, grid.columns);
        Self {
            shift,
            columns,
            cells,
            polygons,
            skips_empty: rules.contains(Rule::PixelMiss),
        }
    }

    /// The class of a pixel, by the possible hits of its rays.
    #[must_use]
    pub fn class_of(&self, [x, y]: [u32; 2]) -> PixelClass {
        if self.columns == 0 {
            return PixelClass::Anything;
        }
        match self.cells[(y >> self.shift) as usize * self.columns + (x >> self.shift) as usize] {
            CellVisibility::Nothing if self.skips_empty => PixelClass::Nothing,
            CellVisibility::One(polygon) if is_inside(&self.polygons[polygon as usize], [x, y]) => {
                PixelClass::Uniform
            }
            CellVisibility::Nothing | CellVisibility::One(_) | CellVisibility::Anything => {
                PixelClass::Anything
            }
        }
    }

    /// The fraction of the picture that is certainly empty, in [0, 1].
    #[must_use]
    pub fn empty_fraction(&self) -> f64 {
        let empty = self
            .cells
            .iter()
            .filter(|cell| **cell == CellVisibility::Nothing)
            .count();
        if self.skips_empty {
            empty as f64 / self.cells.len().max(1) as f64
        } else {
            0.0
        }
    }

    /// Whether some pixels may have the class [`PixelClass::Uniform`].
    #[must_use]
    pub fn has_flat_pixels(&self) -> bool {
        self.cells
            .iter()
            .any(|cell| matches!(cell, CellVisibility::One(_)))
    }
}

impl RuleResults<'_> {
    /// Whether uniform pixels take fewer rays than others.
    fn has_flat_pixels(&self) -> bool {
        self.facts.rules.contains(Rule::PixelFlat) && self.is_sampled() && self.facts.is_pinhole()
    }

    /// The screen-space outline of a convex polygon inside a surface, if the surface is flat and
    /// has one value.
    fn polygon(&self, surface: usize, projection: &ScreenProjection) -> Option<Vec<[f64; 2]>> {
        let ShapeClass::Planar(plane) = self.facts.surface_bounds[surface].class else {
            return None;
        };
        let shape = &self.facts.scene.surfaces()[surface].shape;
        let summary = &self.facts.summaries[surface];
        let shows_one_value = match self.mode() {
            // The normals of the two triangles of a quad may differ in the last bit.
            Mode::Normal => {
                !summary.has_shading_normals()
                    && !matches!(shape, Shape::Quad(_))
                    && self.visibility.sides[surface] != VisibleSides::BOTH
            }
            // Cartoon outlines are drawn within a surface.
            Mode::Phong if self.facts.scene.settings().toon => false,
            Mode::Phong => {
                let lights = self.facts.sources.iter().zip(&self.lights.plans);
                let mut direct = lights.filter(|(_, plan)| plan.direct);
                let adds_no_direct = direct.all(|(light, _)| {
                    self.facts
                        .adds_no_direct(surface, self.visibility.sides[surface], light)
                });
                adds_no_direct
                    && !self.shows_color_map(summary)
                    && (self.max_depth == 0 || !summary.has_bounce())
            }
            Mode::Depth | Mode::Gooch(_) | Mode::Path(_) => false,
        };
        let corners = if shows_one_value {
            shape_facts(shape).polygon(plane.normal)
        } else {
            None
        };
        convex(
            corners?
                .into_iter()
                .map(|corner| projection.project_through_center(corner))
                .collect::<Option<_>>()?,
        )
    }
}

/// Twice the signed area of the triangle of an edge and a point (the edge function); positive if
/// the point is to the left.
fn area([a, b]: [[f64; 2]; 2], p: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// The edges of a polygon.
fn edges(polygon: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// The polygon with its interior to the left of each edge, or `None` if it is not convex or smaller
/// than a pixel.
fn convex(mut polygon: Vec<[f64; 2]>) -> Option<Vec<[f64; 2]>> {
    let signed_area = edges(&polygon)
        .map(|edge| area(edge, polygon[0]))
        .sum::<f64>();
    if signed_area < 0.0 {
        polygon.reverse();
    }
    let turns_left = |edge| polygon.iter().all(|corner| area(edge, *corner) >= 0.0);
    let is_convex = edges(&polygon).all(turns_left) && signed_area.abs() > 2.0;
    is_convex.then_some(polygon)
}

/// Whether a pixel lies inside a polygon, with a margin.
fn is_inside(polygon: &[[f64; 2]], [x, y]: [u32; 2]) -> bool {
    let (low, high) = (
        [x, y].map(|at| f64::from(at) - MARGIN),
        [x, y].map(|at| f64::from(at) + 1.0 + MARGIN),
    );
    let corners = [
        [low[0], low[1]],
        [high[0], low[1]],
        [low[0], high[1]],
        [high[0], high[1]],
    ];
    edges(polygon).all(|edge| corners.iter().all(|corner| area(edge, *corner) >= 0.0))
}

/// The number of surfaces in each cell and the sum of their marks, stored as differences (a 2-D
/// prefix sum restores them).
struct CellGrid {
    shift: u32,
    columns: usize,
    rows: usize,
    differences: Vec<(i32, i64)>,
}

impl CellGrid {
    fn new(findings: &RuleResults<'_>) -> Self {
        let SceneFacts { scene, .. } = &findings.facts;
        let (width, height) = (scene.camera().width.get(), scene.camera().height.get());
        let count = |side: u32, shift: u32| u64::from((side - 1) >> shift) + 1;
        let is_cheap = |shift: &u32| count(width, *shift) * count(height, *shift) <= MAX_CELLS;
        let shift = (0..31).find(is_cheap).unwrap_or(31);
        let side = |side: u32| ((side - 1) >> shift) as usize + 1;
        let (columns, rows) = (side(width), side(height));
        Self {
            shift,
            columns,
            rows,
            differences: vec![(0, 0); (columns + 1) * (rows + 1)],
        }
    }

    fn add(&mut self, rect: PixelRect, mark: i64) {
        let span = |[first, last]: [u32; 2]| {
            [first >> self.shift, ((last - 1) >> self.shift) + 1].map(|k| k as usize)
        };
        let ([left, right], [top, bottom]) = (span(rect.x), span(rect.y));
        for (x, y, sign) in [
            (left, top, 1),
            (right, top, -1),
            (left, bottom, -1),
            (right, bottom, 1),
        ] {
            let (count, marks) = &mut self.differences[y * (self.columns + 1) + x];
            *count += sign;
            *marks += i64::from(sign) * mark;
        }
    }

    fn cells(&mut self) -> Vec<CellVisibility> {
        let stride = self.columns + 1;
        let mut cells = Vec::with_capacity(self.columns * self.rows);
        for y in 0..self.rows {
            let mut row = (0, 0);
            for x in 0..self.columns {
                let above = if y == 0 {
                    (0, 0)
                } else {
                    self.differences[(y - 1) * stride + x]
                };
                let here = &mut self.differences[y * stride + x];
                row = (row.0 + here.0, row.1 + here.1);
                *here = (row.0 + above.0, row.1 + above.1);
                cells.push(match *here {
                    (0, _) => CellVisibility::Nothing,
                    (1, mark) if mark > 0 => {
                        CellVisibility::One(u32::try_from(mark - 1).unwrap_or(0))
                    }
                    _ => CellVisibility::Anything,
                });
            }
        }
        cells
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_count_the_rectangles_that_overlap_them() {
        let mut grid = CellGrid {
            shift: 1,
            columns: 4,
            rows: 3,
            differences: vec![(0, 0); 20],
        };
        grid.add(
            PixelRect {
                x: [0, 4],
                y: [0, 2],
            },
            1,
        );
        grid.add(
            PixelRect {
                x: [3, 8],
                y: [1, 6],
            },
            0,
        );
        let (nothing, one, any) = (
            CellVisibility::Nothing,
            CellVisibility::One(0),
            CellVisibility::Anything,
        );
        let wanted = [
            [one, any, any, any],
            [nothing, any, any, any],
            [nothing, any, any, any],
        ];
        assert_eq!(grid.cells(), wanted.concat());
    }

    #[test]
    fn a_pixel_is_inside_a_polygon_with_a_margin() {
        let square = convex(vec![[0.0, 0.0], [0.0, 5.0], [5.0, 5.0], [5.0, 0.0]]).unwrap();
        assert!(is_inside(&square, [1, 1]) && is_inside(&square, [3, 3]));
        assert!(
            !is_inside(&square, [0, 1])
                && !is_inside(&square, [4, 1])
                && !is_inside(&square, [9, 9])
        );
        assert!(
            convex(vec![[0.0, 0.0], [9.0, 0.0], [2.0, 2.0], [0.0, 9.0]]).is_none(),
            "a dart is not convex"
        );
    }

    #[test]
    fn a_polygon_is_taken_in_either_order_unless_it_is_smaller_than_a_pixel() {
        let square = |side: f64| {
            vec![
                [3.0, 2.0],
                [3.0 + side, 2.0],
                [3.0 + side, 2.0 + side],
                [3.0, 2.0 + side],
            ]
        };
        let reversed = |side: f64| square(side).into_iter().rev().collect::<Vec<_>>();
        for polygon in [square(4.0), reversed(4.0)] {
            let polygon = convex(polygon).unwrap();
            assert!(
                edges(&polygon).all(|edge| area(edge, [5.0, 4.0]) == 8.0),
                "the middle is to the left"
            );
        }
        assert!(convex(square(1.0)).is_none() && convex(reversed(1.0)).is_none());
        assert!(convex(square(1.01)).is_some() && convex(reversed(1.01)).is_some());
    }
}
