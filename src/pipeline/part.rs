//! A part of a picture: the sums and layers of some shares, and what they are shares of. Parts of one
//! picture are merged in any order; together they are the picture of one render, bit for bit.

mod difference;
mod file;
mod render;
mod resume;

pub(super) use file::mended;
pub use file::{MOST, hash_of_file};

use super::{ResolvedOutputTransform, ShardPlan, SharedBy, findings};
use rtc_diag::Diagnostic;
use rtc_image::{Layers, Origin, Picture, WorldToCamera};
use rtc_plan::Arithmetic;
use rtc_render::{Aov, Counts, Crop, FilmError, PartialFilm, Tiles};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

/// What a part is of, and which shares it holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct PartHead {
    /// The program and its version.
    software: String,
    /// The hash of the scene.
    scene: String,
    /// The settings of the render.
    settings: Value,
    /// The view.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    world_to_camera: Option<WorldToCamera>,
    look: ResolvedOutputTransform,
    arithmetic: Arithmetic,
    /// The part of the picture wanted: x, y, width, height.
    window: [u32; 4],
    layers: Vec<Aov>,
    by: SharedBy,
    /// How many shares the picture has.
    count: u32,
    /// Those that are here, ascending.
    shares: Vec<u32>,
    /// The words of the command that made it, but for share and output.
    command: Vec<String>,
    /// The hashes of the pictures that were finished before, of one that is one of many.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    finished: Vec<String>,
    /// How many bytes say how far it has grown, of one that grows as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    growth: Option<u64>,
}

/// What a part was made by.
pub(super) struct Made<'a> {
    pub(super) origin: Origin,
    pub(super) look: ResolvedOutputTransform,
    pub(super) arithmetic: Arithmetic,
    pub(super) aovs: &'a [Aov],
}

/// A part of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct PicturePart {
    head: PartHead,
    film: PartialFilm,
    /// The values of the layers in the tiles of the shares, by the number of the tile, pixel after
    /// pixel; none without layers.
    layers: BTreeMap<usize, Vec<f32>>,
    /// How far it has grown, of one that grows as a whole.
    growth: Vec<u8>,
}

/// Why a part can't be read, or parts not be merged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PartError {
    /// The bytes are something else.
    NotAPart,
    /// The bytes are of another version of the format.
    Version(u32),
    /// The bytes are damaged.
    Damaged(&'static str),
    /// The film within can't be read or added.
    Film(FilmError),
    /// The parts are of different pictures; in this they differ.
    OtherPicture(String),
    /// These shares are in both, beside others that are not.
    Overlap(Vec<u32>),
    /// These shares are missing, of so many.
    Missing(Vec<u32>, u32),
}

impl fmt::Display for PartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotAPart => write!(f, "it is no part of a picture"),
            Self::Version(version) => write!(f, "version {version} of parts is unknown"),
            Self::Damaged(what) => write!(f, "it is damaged: {what}"),
            Self::Film(error) => error.fmt(f),
            Self::OtherPicture(what) => write!(f, "it is a part of another picture: {what}"),
            Self::Overlap(shares) => write!(f, "{} in two of the parts", are(shares)),
            Self::Missing(shares, count) => write!(f, "of {count} shares {} missing", are(shares)),
        }
    }
}

impl std::error::Error for PartError {}

/// A word as a shell reads it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%@".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Numbers and a verb that fits.
fn are(shares: &[u32]) -> String {
    /// No more than so many are named.
    const MOST: usize = 12;
    let words: Vec<String> = shares.iter().take(MOST).map(u32::to_string).collect();
    match shares {
        [one] => format!("{one} is"),
        _ if shares.len() > MOST => {
            format!("{} and {} more are", words.join(", "), shares.len() - MOST)
        }
        _ => format!("{} are", words.join(", ")),
    }
}

impl PicturePart {
    /// The part of some shares, as rendered; `layers` are those of the whole window, of which their
    /// tiles count.
    pub(super) fn new(
        made: Made<'_>,
        (shares, window): (ShardPlan, Crop),
        film: PartialFilm,
        layers: &Layers,
    ) -> Self {
        let Made {
            origin:
                Origin {
                    software,
                    scene,
                    settings,
                    world_to_camera,
                    layer: _,
                },
            look,
            arithmetic,
            aovs,
        } = made;
        let Crop {
            x,
            y,
            width,
            height,
        } = window;
        let head = PartHead {
            software,
            scene,
            settings: serde_json::from_str(&settings).unwrap_or(Value::String(settings)),
            world_to_camera,
            look,
            arithmetic,
            window: [x, y, width, height],
            layers: aovs.to_vec(),
            by: shares.by,
            count: shares.count,
            shares: (shares.first..=shares.last).collect(),
            command: Vec::new(),
            finished: Vec::new(),
            growth: None,
        };
        let values = |area| {
            let rows = head.rows(area);
            rows.flat_map(|row| &layers.values[row]).copied().collect()
        };
        let tiles = head.tiles();
        Self {
            layers: tiles.map(|(tile, area)| (tile, values(area))).collect(),
            head,
            film,
            growth: Vec::new(),
        }
    }

    /// The part, as made by a command: its words, but for the share and the output.
    #[must_use]
    pub fn made_by(mut self, words: Vec<String>) -> Self {
        self.head.command = words;
        self
    }

    /// The command that makes a share, for a shell.
    #[must_use]
    pub fn command(&self, share: u32) -> String {
        let words = self.head.command.iter().map(|word| quoted(word));
        let words: Vec<String> = words.collect();
        let count = self.head.count;
        let words = words.join(" ");
        format!("rtc {words} --part {share}/{count} -o part-{share}.rtp")
    }

    /// The rays of its shares.
    #[must_use]
    pub fn counts(&self) -> Counts {
        self.film.counts()
    }

    /// The kind of picture that it is a part of.
    #[must_use]
    pub fn look(&self) -> &ResolvedOutputTransform {
        &self.head.look
    }

    /// Enough to make the same picture again.
    #[must_use]
    pub fn origin(&self) -> Origin {
        Origin {
            software: self.head.software.clone(),
            scene: self.head.scene.clone(),
            settings: self.head.settings.to_string(),
            world_to_camera: self.head.world_to_camera,
            layer: String::new(),
        }
    }

    /// The numbers of the shares that it holds, ascending, and of how many.
    #[must_use]
    pub fn shares(&self) -> (&[u32], u32) {
        (&self.head.shares, self.head.count)
    }

    /// The numbers of the shares that it does not hold, ascending.
    pub fn missing(&self) -> impl Iterator<Item = u32> {
        let is_missing = |share: &u32| self.head.shares.binary_search(share).is_err();
        (1..=self.head.count).filter(is_missing)
    }

    /// Adds another part of the same picture; one whose shares are here already changes nothing.
    ///
    /// # Errors
    /// If it is of another picture, or if some of its shares are here and others not. Then this part
    /// is as before.
    pub fn add(&mut self, other: Self) -> Result<(), PartError> {
        if let Some(what) = self.head.difference(&other.head) {
            return Err(PartError::OtherPicture(what));
        }
        if !other.growth.is_empty() {
            self.grow(other.growth);
        }
        let is_here = |share: &u32| self.head.shares.binary_search(share).is_ok();
        let both: Vec<u32> = other.head.shares.iter().copied().filter(is_here).collect();
        if both.len() == other.head.shares.len() {
            return Ok(());
        }
        if !both.is_empty() {
            return Err(PartError::Overlap(both));
        }
        self.film.add(other.film).map_err(PartError::Film)?;
        self.layers.extend(other.layers);
        self.head.shares.extend(other.head.shares);
        self.head.shares.sort_unstable();
        Ok(())
    }

    /// The picture of all parts, its rays, and what is found in it.
    ///
    /// # Errors
    /// If parts are missing.
    pub fn develop(&self) -> Result<(Picture, Counts, Vec<Diagnostic>), PartError> {
        let head = &self.head;
        let missing: Vec<u32> = self.missing().collect();
        if !missing.is_empty() {
            return Err(PartError::Missing(missing, head.count));
        }
        let film = self.film.develop().map_err(PartError::Film)?;
        let film = film.cut(head.crop());
        let mut found = Vec::new();
        if head.settings["crop"].is_null() && film.counts.hits == 0 {
            found.push(findings::nothing_in_view(None));
        }
        let sums = (film.image, film.coverage, film.counts.unnumbered);
        let (picture, lost) = head.look.finish(sums, self.whole_layers(), head.arithmetic);
        found.extend(lost);
        Ok((picture, film.counts, found))
    }

    /// The layers of all pixels.
    fn whole_layers(&self) -> Layers {
        let head = &self.head;
        let mut values = vec![0.0; head.crop().pixels() * head.channels()];
        for ((_, area), layers) in head.tiles().zip(self.layers.values()) {
            let pieces = layers.chunks_exact(area.width as usize * head.channels());
            for (row, piece) in head.rows(area).zip(pieces) {
                values[row].copy_from_slice(piece);
            }
        }
        Layers {
            names: head
                .layers
                .iter()
                .flat_map(|aov| aov.channels())
                .copied()
                .collect(),
            values,
        }
    }
}

impl PartHead {
    fn crop(&self) -> Crop {
        let [x, y, width, height] = self.window;
        Crop {
            x,
            y,
            width,
            height,
        }
    }

    /// How many numbers the layers have for each pixel.
    fn channels(&self) -> usize {
        self.layers.iter().map(|aov| aov.channels().len()).sum()
    }

    /// The tiles whose layers are here, with their numbers; none if there are no layers. They are
    /// shared out by tiles, even where samples are not.
    fn tiles(&self) -> impl Iterator<Item = (usize, Crop)> {
        let is_here = |area: &Crop| {
            let share = ShardPlan::of_tile(self.count, [area.x, area.y]);
            !self.layers.is_empty() && self.shares.binary_search(&share).is_ok()
        };
        let all = Tiles::of(self.crop()).enumerate();
        all.filter(move |(_, area)| is_here(area))
    }

    /// Where the numbers of each row of a tile stand among those of the whole window.
    fn rows(&self, area: Crop) -> impl Iterator<Item = Range<usize>> {
        let (window, channels) = (self.crop(), self.channels());
        let left = (area.x - window.x) as usize;
        (area.y..area.y + area.height).map(move |y| {
            let start = (y - window.y) as usize * window.width as usize + left;
            start * channels..(start + area.width as usize) * channels
        })
    }
}
