//! Audits of pictures: random tiles are rendered again and compared bit by bit, and all metadata
//! are checked.
//!
//! A picture keeps a Merkle tree over the tiles of its film ([`MerkleTree`]), whose root covers its
//! metadata, too. An audit chooses among the nodes that the file keeps, each of which covers one
//! tile or several adjacent ones.

mod claim;
mod part;

use super::output_transform::{ClippedValues, ResolvedOutputTransform};
use super::{PictureSetup, RayCounter, RenderError, RenderObserver, RenderSubject, Renderer};
use rayon::prelude::*;
use rtc_image::{
    MerkleTree, Picture, PictureMetadata, PixelLayers, TILE, TileHash, WrittenPicture, samples,
    tile_count,
};
use rtc_math::{mix, to_u32};
use rtc_render::{
    AnyWorld, Aov, Background, Crop, PartialFilm, PixelObserver, RenderSelection, Tiles, Values,
};
use rtc_study::least_faults;
use rtc_valid::Mode;
use std::ops::Range;

const _: () = assert!(TILE == Tiles::SIDE, "a tile of a file is one of a film");

/// If no tile differs, the bound on differing tiles is wrong for at most one seed in this many: a
/// confidence of 98 %.
pub const ODDS: u64 = 50;

/// The number of tiles to draw, and the seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileDraw {
    /// The number, or all if there are fewer.
    pub tiles: u64,
    /// The seed.
    pub seed: u64,
}

/// A difference between a picture's metadata and the facts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AuditSubject {
    /// Its root, which is not that of its hashes and its metadata.
    Root,
    /// Its scene.
    Scene,
    /// Its settings.
    Settings,
    /// Its view, `worldToCamera`.
    View,
    /// How large it is.
    Size,
    /// The film values of a tile, by their hash.
    Values,
    /// The samples of a tile, by their hash.
    Samples,
    /// The bytes of its file, where all tiles and metadata are right.
    File,
}

/// A difference between a picture's metadata and the facts.
#[derive(Clone, Debug, PartialEq)]
pub struct AuditFinding {
    /// The subject.
    pub subject: AuditSubject,
    /// The number of the drawn tile, row by row from 0.
    pub tile: Option<u64>,
    /// Its first pixels, as many as there are in its first row of tiles.
    pub area: Option<Crop>,
    /// The first pixel that differs, where that is known.
    pub pixel: Option<[u32; 2]>,
    /// The value in the picture or its metadata.
    pub stated: String,
    /// The actual value.
    pub anew: String,
}

/// The result of an audit.
#[derive(Clone, Debug, PartialEq)]
pub struct AuditResult {
    /// The number of tiles.
    pub all: u64,
    /// The number of tiles of a film that each node covers.
    pub film_tiles: u64,
    /// The indices of the chosen tiles, ascending.
    pub drawn: Vec<u64>,
    /// What differs.
    pub findings: Vec<AuditFinding>,
    /// If none differs, fewer tiles than this differ, with a confidence of 1 − 1/[`ODDS`].
    pub fewer_than: Option<u64>,
    /// The settings of the picture that its scene has otherwise: name, value of the picture, value
    /// of the scene.
    pub settings: Vec<[String; 3]>,
}

impl AuditResult {
    /// The report on a picture whose metadata contradict themselves or the scene.
    fn refuted(findings: Vec<AuditFinding>) -> Self {
        Self {
            all: 0,
            film_tiles: 1,
            drawn: Vec::new(),
            findings,
            fewer_than: None,
            settings: Vec::new(),
        }
    }
}

/// The numbers of the drawn tiles, ascending: those of the least ranks, which the seed shuffles.
fn drawn(all: usize, draw: TileDraw) -> Vec<usize> {
    let mut order: Vec<usize> = (0..all).collect();
    let seed = mix(draw.seed);
    order.sort_by_cached_key(|index| mix(seed ^ *index as u64));
    order.truncate(usize::try_from(draw.tiles).unwrap_or(usize::MAX));
    order.sort_unstable();
    order
}

/// The errors in the metadata of a picture by themselves.
fn contradiction(tree: &MerkleTree, metadata: &PictureMetadata) -> Option<AuditFinding> {
    let anew = tree.root_of(metadata);
    (anew != tree.root()).then(|| finding(AuditSubject::Root, tree.root(), anew))
}

fn finding(subject: AuditSubject, stated: impl ToString, anew: impl ToString) -> AuditFinding {
    AuditFinding {
        subject,
        tile: None,
        area: None,
        pixel: None,
        stated: stated.to_string(),
        anew: anew.to_string(),
    }
}

/// Rejects pictures of another version.
fn check_software(metadata: &PictureMetadata) -> Result<(), RenderError> {
    let own = super::setup::SOFTWARE;
    let words = || format!("it is by `{}`, and this is `{own}`", metadata.software);
    match metadata.software == own {
        true => Ok(()),
        false => Err(RenderError::Refused(words())),
    }
}

/// The differences of the metadata from scene, settings and view.
fn differing(
    stated: &PictureMetadata,
    anew: &PictureMetadata,
    has_view: bool,
) -> Vec<AuditFinding> {
    let texts = [
        (AuditSubject::Scene, &stated.scene, &anew.scene),
        (AuditSubject::Settings, &stated.settings, &anew.settings),
    ];
    let differing = texts.into_iter().filter(|(_, stated, anew)| stated != anew);
    let mut findings: Vec<_> = differing
        .map(|(subject, stated, anew)| finding(subject, stated, anew))
        .collect();
    if has_view && stated.world_to_camera != anew.world_to_camera {
        let words = |metadata: &PictureMetadata| {
            format!("{:?}", metadata.world_to_camera.unwrap_or_default())
        };
        findings.push(finding(AuditSubject::View, words(stated), words(anew)));
    }
    findings
}

/// The layers that have these channels.
fn layers_of(channels: &[String]) -> Result<Vec<Aov>, RenderError> {
    let has = |name: &&'static str| channels.iter().any(|channel| channel == name);
    let all = Aov::ALL.into_iter();
    let aovs: Vec<Aov> = all.filter(|aov| aov.channels().iter().all(has)).collect();
    let count: usize = aovs.iter().map(|aov| aov.channels().len()).sum();
    match count == channels.len() && aovs.iter().all(|aov| !aov.is_of_samples()) {
        true => Ok(aovs),
        false => Err(RenderError::Refused(
            "it has layers that are not made tile by tile".to_owned(),
        )),
    }
}

/// A picture whose metadata were found to be sound in themselves.
pub struct PictureAudit<'p> {
    picture: &'p WrittenPicture,
    tree: &'p MerkleTree,
}

impl<'p> PictureAudit<'p> {
    /// Checks the metadata of a picture without its scene; returns the setup that renders it again.
    ///
    /// # Errors
    /// If it can't be audited; the inner error if it contradicts itself.
    pub fn open(
        picture: &'p WrittenPicture,
    ) -> Result<Result<(Self, PictureSetup), AuditResult>, RenderError> {
        let refused = |words: &str| RenderError::Refused(words.to_owned());
        let tree = picture.tree.as_ref().ok_or_else(|| {
            refused(
                "it has no hashes of its tiles: it was made with `--no-metadata` or by another \
                 program",
            )
        })?;
        if !picture.metadata.layer.is_empty() {
            return Err(refused("it is a layer; audit the picture beside it"));
        }
        if let Some(finding) = contradiction(tree, &picture.metadata) {
            return Ok(Err(AuditResult::refuted(vec![finding])));
        }
        check_software(&picture.metadata)?;
        let layers = layers_of(&picture.layers)?;
        let setup = claim::setup(&picture.metadata.settings, picture.form, &layers)?;
        Ok(Ok((Self { picture, tree }, setup)))
    }

    /// Audits the picture against its scene, which `setup` has validated: each tile takes at most
    /// `rays` rays.
    ///
    /// # Errors
    /// If the picture can't be rendered again.
    pub fn run(
        &self,
        setup: &PictureSetup,
        subject: &mut RenderSubject,
        (draw, rays): (TileDraw, u64),
        observer: &RenderObserver<'_>,
    ) -> Result<AuditResult, RenderError> {
        let Self { picture, tree } = self;
        // The metadata of scene, settings and size.
        let scene = &subject.validated.lowered.scene;
        let metadata = setup.metadata(scene);
        let mut findings = differing(&picture.metadata, &metadata, picture.form.is_linear());
        let window = setup.window(scene)?;
        let size = [window.width, window.height];
        if size != picture.size || !tree.fits(size) {
            let words = |[width, height]: [u32; 2]| format!("{width}×{height}");
            findings.push(finding(
                AuditSubject::Size,
                words(picture.size),
                words(size),
            ));
        }
        if !findings.is_empty() {
            return Ok(AuditResult::refuted(findings));
        }
        check_mode(subject)?;
        // The drawn tiles.
        let nodes = drawn(tree.nodes().len(), draw);
        let count = tile_count(size);
        let anew = TileRenderer::new(setup, subject, window, rays)?;
        let made = anew.on_threads(&nodes, |node| {
            let tiles = tree.tiles(*node, count);
            self.compare(*node, tiles, &anew, observer)
        })?;
        let all = tree.nodes().len() as u64;
        let mut findings: Vec<_> = made.into_iter().flatten().collect();
        if findings.is_empty() && !picture.is_exact {
            let stated = "bytes of another program, which may change how it is shown";
            let anew = "the bytes that rtc writes for its pixels and its metadata";
            findings.push(finding(AuditSubject::File, stated, anew));
        }
        let fewer_than = findings
            .is_empty()
            .then(|| least_faults(all, nodes.len() as u64, ODDS));
        Ok(AuditResult {
            all,
            film_tiles: tree.tiles_of_node() as u64,
            drawn: nodes.iter().map(|node| *node as u64).collect(),
            findings,
            fewer_than: fewer_than.flatten(),
            settings: subject.replaced.clone(),
        })
    }

    /// Renders the tiles of a node again and compares values and samples.
    fn compare(
        &self,
        node: usize,
        tiles: Range<usize>,
        anew: &TileRenderer<'_>,
        observer: &RenderObserver<'_>,
    ) -> Result<Option<AuditFinding>, RenderError> {
        let Self { picture, tree } = self;
        let (mut hashes, mut differing) = (Vec::new(), None);
        let mut parts = [Vec::new(), Vec::new()];
        // Render each area of the tiles anew.
        let areas = stretches(picture.size, tiles);
        for area in &areas {
            let made = anew.picture(*area, observer)?;
            let corner = [area.x, area.y];
            let stated = picture.part(corner, [area.width, area.height]);
            let own = samples(&made, picture.form);
            let pixel = own.len() / area.pixels();
            // Find the first sample that differs.
            let first = stated.iter().zip(&own).position(|(a, b)| a != b);
            let is_other = first.is_some() || stated.len() != own.len();
            let place = |byte| {
                let index = to_u32(byte / pixel);
                [area.x + index % area.width, area.y + index / area.width]
            };
            differing = differing.or(is_other.then(|| first.map(place)));
            parts[0].extend(stated);
            parts[1].extend(own);
            hashes.extend(made.tiles);
        }
        // The node of the hash tree must be that of the new tiles.
        let with_place = |finding| AuditFinding {
            tile: Some(node as u64),
            area: areas.first().copied(),
            pixel: differing.flatten(),
            ..finding
        };
        let hash = MerkleTree::node(hashes);
        if hash != tree.nodes()[node] {
            let finding = finding(AuditSubject::Values, tree.nodes()[node], hash);
            return Ok(Some(with_place(finding)));
        }
        // The samples in the file must be the new ones too.
        Ok(differing.map(|_| {
            let [stated, own] = parts.map(|samples| TileHash::of_tile(&samples));
            with_place(finding(AuditSubject::Samples, stated, own))
        }))
    }
}

/// The brightness of a distance depends on all others.
fn check_mode(subject: &RenderSubject) -> Result<(), RenderError> {
    match subject.validated.scene.settings().mode {
        Mode::Depth => Err(RenderError::Refused(
            "it is a depth buffer, in which the brightness of a pixel depends on all others"
                .to_owned(),
        )),
        Mode::Phong | Mode::Normal | Mode::Gooch(_) | Mode::Path(_) => Ok(()),
    }
}

/// The rectangles of some tiles of a picture of this size, in their order: one for each row of
/// tiles.
fn stretches([width, height]: [u32; 2], tiles: Range<usize>) -> Vec<Crop> {
    let columns = width.div_ceil(TILE) as usize;
    let mut found = Vec::new();
    let mut first = tiles.start;
    while first < tiles.end {
        let (row, column) = (first / columns, first % columns);
        let end = tiles.end.min((row + 1) * columns);
        let (x, y) = (to_u32(column) * TILE, to_u32(row) * TILE);
        let area = Crop {
            x,
            y,
            width: to_u32(end - first) * TILE,
            height: TILE,
        };
        found.push(area.within(width, height));
        first = end;
    }
    found
}

/// Renders parts of a picture again.
struct TileRenderer<'s> {
    renderer: &'s Renderer,
    /// The world for the layers, if it is a different one.
    unpruned: Option<AnyWorld>,
    look: ResolvedOutputTransform,
    aovs: Vec<Aov>,
    window: Crop,
    job: RenderSelection<'static>,
    rays: u64,
}

impl<'s> TileRenderer<'s> {
    fn new(
        setup: &PictureSetup,
        subject: &'s mut RenderSubject,
        window: Crop,
        rays: u64,
    ) -> Result<Self, RenderError> {
        let mode = &subject.validated.scene.settings().mode;
        let look = setup.look.resolve(mode);
        let values: Values = setup.look.values(mode);
        let background: Background = setup.look.background();
        let (_, renderer) = setup.renderer(subject)?;
        let aovs = setup.look.aovs.clone();
        let unpruned = renderer.world.unpruned().filter(|_| !aovs.is_empty());
        Ok(Self {
            renderer,
            unpruned,
            look,
            aovs,
            window,
            job: RenderSelection {
                values,
                background,
                clamp: setup.clamp,
                ..RenderSelection::default()
            },
            rays,
        })
    }

    /// Does some work on all threads, in the order of `items`.
    fn on_threads<T: Send>(
        &self,
        items: &[usize],
        work: impl Fn(&usize) -> Result<T, RenderError> + Sync + Send,
    ) -> Result<Vec<T>, RenderError> {
        let threads = &self.renderer.threads;
        threads.install(|| items.par_iter().map(work).collect())
    }

    /// The picture of a part of the crop, by its position in it.
    fn picture(&self, area: Crop, observer: &RenderObserver<'_>) -> Result<Picture, RenderError> {
        let area = Crop {
            x: self.window.x + area.x,
            y: self.window.y + area.y,
            ..area
        };
        let job = RenderSelection {
            crop: Some(area),
            ..self.job
        };
        let film = self.counted(area, observer, |on_pixel| {
            self.renderer.world.render(&job, on_pixel)
        })?;
        let layers = self.layers(&job, observer)?;
        let losses = &mut ClippedValues::default();
        Ok(self.look.show(film.image, film.coverage, layers, losses))
    }

    /// The sums of some samples of a part of the picture, or of all.
    fn sums(
        &self,
        area: Crop,
        samples: Option<Range<u32>>,
        observer: &RenderObserver<'_>,
    ) -> Result<PartialFilm, RenderError> {
        let job = RenderSelection {
            crop: Some(area),
            ..self.job
        };
        let mut fault = None;
        let film = self.counted(area, observer, |on_pixel| {
            let film = self.renderer.world.render_part(&job, samples, on_pixel);
            film.unwrap_or_else(|error| {
                fault = Some(RenderError::Refused(error.to_string()));
                None
            })
        });
        fault.map_or(film, Err)
    }

    /// Renders with a limit on rays.
    fn counted<T>(
        &self,
        area: Crop,
        observer: &RenderObserver<'_>,
        render: impl FnOnce(&PixelObserver<'_>) -> Option<T>,
    ) -> Result<T, RenderError> {
        let counter = RayCounter::new(self.rays, area);
        let made = render(&|step| {
            (observer.on_step)(step);
            !(observer.is_stopped)() && counter.step(step)
        });
        if counter.ran_out().is_some() {
            let words = "a tile takes more rays than the limit of the run";
            return Err(RenderError::Refused(words.to_owned()));
        }
        made.ok_or(RenderError::Stopped)
    }

    fn layers(
        &self,
        job: &RenderSelection,
        observer: &RenderObserver<'_>,
    ) -> Result<PixelLayers, RenderError> {
        if self.aovs.is_empty() {
            return Ok(PixelLayers::default());
        }
        let on_pixel = |_| !(observer.is_stopped)();
        let world = self.unpruned.as_ref().unwrap_or(&self.renderer.world);
        let layers = world.layers(&self.aovs, job, &on_pixel);
        layers.ok_or(RenderError::Stopped)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_draw_is_of_different_tiles_and_depends_on_the_seed() {
        let draw = |tiles, seed| drawn(100, TileDraw { tiles, seed });
        assert_eq!(draw(500, 1), (0..100).collect::<Vec<_>>());
        assert!(draw(0, 1).is_empty());
        let some = draw(30, 1);
        assert!(some.len() == 30 && some.is_sorted_by(|a, b| a < b));
        assert_ne!(some, draw(30, 2));
        // Each tile is drawn about as often as any other.
        let mut counts = [0; 100];
        (0..2000).for_each(|seed| draw(10, seed).iter().for_each(|tile| counts[*tile] += 1));
        // 200 times, with a standard deviation of 13.4.
        assert!(
            counts.iter().all(|count| (130..=270).contains(count)),
            "{counts:?}"
        );
    }

    #[test]
    fn stretches_are_the_tiles_row_by_row() {
        let area = |x, y, width, height| Crop {
            x,
            y,
            width,
            height,
        };
        assert_eq!(stretches([40, 20], 1..2), [area(16, 0, 16, 16)]);
        assert_eq!(
            stretches([40, 20], 1..6),
            [area(16, 0, 24, 16), area(0, 16, 40, 4)]
        );
    }
}
