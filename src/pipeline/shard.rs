//! A shard of a picture: the film and layers of some shares of the work, with a description of the
//! picture. Shards of one picture can be merged in any order; together they equal one render, bit
//! for bit.

mod file;
mod render;

pub(super) use file::with_valid_checksums;
pub use file::{MAX_SHARES, hash_of_file};

use super::{ResolvedOutputTransform, ShardDivision, ShardPlan, picture_diagnostics};
use rtc_diag::Diagnostic;
use rtc_image::{MerkleTree, Picture, PictureMetadata, PixelLayers, TileHash, WorldToCamera};
use rtc_plan::Arithmetic;
use rtc_render::{Aov, Crop, FilmError, PartialFilm, RayCounts, Tiles};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;

/// The description of a shard.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct ShardHeader {
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
    /// The crop window: x, y, width, height.
    window: [u32; 4],
    layers: Vec<Aov>,
    by: ShardDivision,
    /// The number of shares of the picture.
    count: u32,
    /// The shares in this shard, ascending.
    shares: Vec<u32>,
    /// The arguments of the command that made it, without shard and output.
    command: Vec<String>,
    /// The hashes of the pictures that were finished before, in a sequence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    finished: Vec<String>,
    /// The length in bytes of the progressive state, for a picture that is refined as a whole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    growth: Option<u64>,
    /// The hashes of its tiles, in its file alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tiles: Option<ShardTiles>,
}

/// A Merkle tree over the tiles of a shard, whose root covers the description of its picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct ShardTiles {
    root: String,
    /// For each tile with samples, the hash of its sums and layers, in the order of the film.
    leaves: Vec<String>,
}

/// The settings that a shard was rendered with.
pub(super) struct ShardSource<'a> {
    pub(super) metadata: PictureMetadata,
    pub(super) look: ResolvedOutputTransform,
    pub(super) arithmetic: Arithmetic,
    pub(super) aovs: &'a [Aov],
}

/// A shard of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderShard {
    head: ShardHeader,
    film: PartialFilm,
    /// The values of the layers by tile index, pixel after pixel; empty without layers.
    layers: BTreeMap<usize, Vec<f32>>,
    /// The progressive state, for a picture that is refined as a whole.
    growth: Vec<u8>,
}

/// Why a shard can't be read or merged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShardError {
    /// The bytes are not a shard.
    NotAPart,
    /// The format version is not supported.
    Version(u32),
    /// The bytes are damaged.
    Damaged(&'static str),
    /// The film can't be read or added.
    Film(FilmError),
    /// The shards belong to different pictures, with the difference.
    OtherPicture(String),
    /// These shares are in both, and others are not.
    Overlap(Vec<u32>),
    /// These shares are missing, and the number of all.
    Missing(Vec<u32>, u32),
}

impl fmt::Display for ShardError {
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

impl std::error::Error for ShardError {}

/// An argument quoted for a shell.
fn quoted(argument: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+%@".contains(c);
    if !argument.is_empty() && argument.chars().all(is_plain) {
        argument.to_owned()
    } else {
        format!("'{}'", argument.replace('\'', "'\\''"))
    }
}

/// Numbers with the matching verb.
fn are(shares: &[u32]) -> String {
    /// The maximum number of shares that are listed.
    const MAX_SHARES: usize = 12;
    let arguments: Vec<String> = shares.iter().take(MAX_SHARES).map(u32::to_string).collect();
    match shares {
        [one] => format!("{one} is"),
        _ if shares.len() > MAX_SHARES => {
            format!(
                "{} and {} more are",
                arguments.join(", "),
                shares.len() - MAX_SHARES
            )
        }
        _ => format!("{} are", arguments.join(", ")),
    }
}

impl RenderShard {
    /// The shard of some shares, as rendered. `layers` covers the whole window; only the tiles of
    /// the shares are used.
    pub(super) fn new(
        made: ShardSource<'_>,
        (shares, window): (ShardPlan, Crop),
        film: PartialFilm,
        layers: &PixelLayers,
    ) -> Self {
        // The description of the picture.
        let ShardSource {
            metadata:
                PictureMetadata {
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
        let head = ShardHeader {
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
            tiles: None,
        };
        // Cut the layers into the tiles of the shares.
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

    /// Sets the arguments of the command that made it, without shard and output.
    #[must_use]
    pub fn made_by(mut self, arguments: Vec<String>) -> Self {
        self.head.command = arguments;
        self
    }

    /// The shell command that renders a share.
    #[must_use]
    pub fn command(&self, share: u32) -> String {
        let arguments = self.head.command.iter().map(|argument| quoted(argument));
        let arguments: Vec<String> = arguments.collect();
        let count = self.head.count;
        let arguments = arguments.join(" ");
        format!("rtc {arguments} --part {share}/{count} -o part-{share}.rtp")
    }

    /// The ray counts.
    #[must_use]
    pub fn counts(&self) -> RayCounts {
        self.film.counts()
    }

    /// The output transform of the picture.
    #[must_use]
    pub fn look(&self) -> &ResolvedOutputTransform {
        &self.head.look
    }

    /// The metadata that identifies the picture.
    #[must_use]
    pub fn metadata(&self) -> PictureMetadata {
        PictureMetadata {
            software: self.head.software.clone(),
            scene: self.head.scene.clone(),
            settings: self.head.settings.to_string(),
            world_to_camera: self.head.world_to_camera,
            layer: String::new(),
        }
    }

    /// The film.
    pub(super) fn film(&self) -> &PartialFilm {
        &self.film
    }

    /// The layers.
    pub(super) fn aovs(&self) -> &[Aov] {
        &self.head.layers
    }

    /// The arithmetic of intersections.
    pub(super) fn arithmetic(&self) -> Arithmetic {
        self.head.arithmetic
    }

    /// Whether it is a picture that is refined as a whole.
    pub(super) fn is_refined(&self) -> bool {
        self.head.growth.is_some()
    }

    /// Whether it has the layers of a tile.
    pub(super) fn has_layers(&self, tile: usize) -> bool {
        self.layers.contains_key(&tile)
    }

    /// The bytes of a tile: its sums and its layers.
    pub(super) fn tile_bytes(&self, tile: usize) -> Vec<u8> {
        let mut bytes = self.film.tile_bytes(tile);
        let layers = self.layers.get(&tile).into_iter().flatten();
        bytes.extend(layers.flat_map(|value| value.to_le_bytes()));
        bytes
    }

    /// The hashes of its tiles; none without metadata.
    fn hashed_tiles(&self) -> Option<ShardTiles> {
        let tiles = self.film.held_tiles();
        let leaves: Vec<TileHash> = tiles
            .map(|(tile, _)| TileHash::of_tile(&self.tile_bytes(tile)))
            .collect();
        let keeps = self.head.look.has_metadata() && !leaves.is_empty();
        keeps.then(|| ShardTiles {
            leaves: leaves.iter().map(TileHash::to_string).collect(),
            root: MerkleTree::new(leaves, &self.metadata()).root().to_string(),
        })
    }

    /// The indices of the shares in this shard, ascending, and the number of all.
    #[must_use]
    pub fn shares(&self) -> (&[u32], u32) {
        (&self.head.shares, self.head.count)
    }

    /// The indices of the missing shares, ascending.
    pub fn missing(&self) -> impl Iterator<Item = u32> {
        let is_missing = |share: &u32| self.head.shares.binary_search(share).is_err();
        (1..=self.head.count).filter(is_missing)
    }

    /// Merges another shard of the same picture; one whose shares are all present changes nothing.
    ///
    /// # Errors
    /// If it belongs to another picture, or only some of its shares are present. Then this shard is
    /// unchanged.
    pub fn add(&mut self, other: Self) -> Result<(), ShardError> {
        if let Some(what) = self.head.difference(&other.head) {
            return Err(ShardError::OtherPicture(what));
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
            return Err(ShardError::Overlap(both));
        }
        self.film.add(other.film).map_err(ShardError::Film)?;
        self.layers.extend(other.layers);
        self.head.shares.extend(other.head.shares);
        self.head.shares.sort_unstable();
        Ok(())
    }

    /// The picture, its ray counts and its diagnostics.
    ///
    /// # Errors
    /// If shares are missing.
    pub fn develop(&self) -> Result<(Picture, RayCounts, Vec<Diagnostic>), ShardError> {
        let head = &self.head;
        let missing: Vec<u32> = self.missing().collect();
        if !missing.is_empty() {
            return Err(ShardError::Missing(missing, head.count));
        }
        let film = self.film.develop().map_err(ShardError::Film)?;
        let film = film.cut(head.crop());
        let mut found = Vec::new();
        if head.settings["crop"].is_null() && film.counts.hits == 0 {
            found.push(picture_diagnostics::nothing_in_view(None));
        }
        let sums = (film.image, film.coverage, film.counts.unnumbered);
        let (picture, lost) = head.look.finish(sums, self.whole_layers(), head.arithmetic);
        found.extend(lost);
        Ok((picture, film.counts, found))
    }

    /// The layers of all pixels.
    fn whole_layers(&self) -> PixelLayers {
        let head = &self.head;
        let mut values = vec![0.0; head.crop().pixels() * head.channels()];
        for ((_, area), layers) in head.tiles().zip(self.layers.values()) {
            let pieces = layers.chunks_exact(area.width as usize * head.channels());
            for (row, piece) in head.rows(area).zip(pieces) {
                values[row].copy_from_slice(piece);
            }
        }
        PixelLayers {
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

impl ShardHeader {
    fn crop(&self) -> Crop {
        let [x, y, width, height] = self.window;
        Crop {
            x,
            y,
            width,
            height,
        }
    }

    /// The number of layer values per pixel.
    fn channels(&self) -> usize {
        self.layers.iter().map(|aov| aov.channels().len()).sum()
    }

    /// The tiles whose layers are here, with their indices; none without layers. Layers are divided
    /// by tiles even if samples are not.
    fn tiles(&self) -> impl Iterator<Item = (usize, Crop)> {
        let is_here = |area: &Crop| {
            let share = ShardPlan::of_tile(self.count, [area.x, area.y]);
            !self.layers.is_empty() && self.shares.binary_search(&share).is_ok()
        };
        let all = Tiles::of(self.crop()).enumerate();
        all.filter(move |(_, area)| is_here(area))
    }

    /// The range of each row of a tile in the values of the whole window.
    fn rows(&self, area: Crop) -> impl Iterator<Item = Range<usize>> {
        let (window, channels) = (self.crop(), self.channels());
        let left = (area.x - window.x) as usize;
        (area.y..area.y + area.height).map(move |y| {
            let start = (y - window.y) as usize * window.width as usize + left;
            start * channels..(start + area.width as usize) * channels
        })
    }
}

impl RenderShard {
    /// The crop window.
    #[must_use]
    pub fn window(&self) -> Crop {
        self.head.crop()
    }

    /// Sets the hashes of the files of finished pictures.
    #[must_use]
    pub fn after(mut self, finished: Vec<String>) -> Self {
        self.head.finished = finished;
        self
    }

    /// The hashes of the pictures that were finished before.
    #[must_use]
    pub fn finished(&self) -> &[String] {
        &self.head.finished
    }

    /// Sets the progressive state.
    pub fn grow(&mut self, growth: Vec<u8>) {
        self.head.growth = Some(growth.len() as u64);
        self.growth = growth;
    }

    /// Takes the progressive state out.
    #[must_use]
    pub fn take_growth(&mut self) -> Vec<u8> {
        self.head.growth = None;
        std::mem::take(&mut self.growth)
    }
}

impl ShardHeader {
    /// The first difference between the pictures of two shards, as a message.
    pub(super) fn difference(&self, other: &Self) -> Option<String> {
        let of = |name: &str, here: &dyn fmt::Display, there: &dyn fmt::Display| {
            Some(format!("{name}: {here} here, {there} there"))
        };
        if self.software != other.software {
            return of("program", &other.software, &self.software);
        }
        if let Some((name, here, there)) = differing(&other.settings, &self.settings) {
            return of(&name, &here, &there);
        }
        if self.scene != other.scene {
            return of("scene", &other.scene, &self.scene);
        }
        if (self.by, self.count) != (other.by, other.count) {
            let shares = |head: &Self| match head.by {
                ShardDivision::Tiles => format!("{} by tiles", head.count),
                ShardDivision::Samples => format!("{} by samples", head.count),
            };
            return of("shares", &shares(other), &shares(self));
        }
        let other_settings = |head: &Self| {
            (
                head.look.clone(),
                head.arithmetic,
                head.window,
                head.layers.clone(),
            )
        };
        let differ = other_settings(self) != other_settings(other);
        differ.then(|| "its look, its arithmetic or its layers".to_owned())
    }
}

/// The first member in which two JSON objects differ, with both values.
fn differing(here: &Value, there: &Value) -> Option<(String, String, String)> {
    if here == there {
        return None;
    }
    let (Value::Object(a), Value::Object(b)) = (here, there) else {
        return Some((String::new(), here.to_string(), there.to_string()));
    };
    let names = a.keys().chain(b.keys());
    let value = |map: &serde_json::Map<String, Value>, name: &String| {
        map.get(name).cloned().unwrap_or(Value::Null)
    };
    let mut differences = names.filter_map(|name| {
        let (inner, here, there) = differing(&value(a, name), &value(b, name))?;
        let dot = if inner.is_empty() { "" } else { "." };
        Some((format!("{name}{dot}{inner}"), here, there))
    });
    differences.next()
}
