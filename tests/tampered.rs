//! Pictures in memory, and what a dishonest or a broken machine may do to them: for suites and
//! benches that audit them.

use rtc::internals::image::{
    BackgroundFill, FileFormat, MerkleTree, Picture, PictureHeader, TileHash, WrittenFile,
    WrittenPicture,
};
use rtc::internals::math::mix;
use rtc::internals::passes::{IntegratorChoice, ViewAndLight};
use rtc::internals::pipeline::{
    AuditResult, Input, Options, OutputTransform, PictureAudit, PictureSetup, RenderError,
    RenderObserver, RenderSubject, TileDraw,
};
use rtc::internals::render::{Aov, Crop, SimdLevel};
use std::path::PathBuf;

/// A side of a tile.
const TILE: u32 = 16;

/// Never stops.
pub(crate) const OBSERVER: RenderObserver<'static> = RenderObserver {
    on_step: &|_| (),
    is_stopped: &|| false,
};

/// How a picture is made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recipe {
    /// A scene of the repo.
    pub(crate) scene: &'static str,
    pub(crate) form: FileFormat,
    pub(crate) background: BackgroundFill,
    pub(crate) layers: &'static [Aov],
    pub(crate) size: [u32; 2],
    pub(crate) crop: Option<Crop>,
    /// Paths a pixel, if paths are traced.
    pub(crate) paths: Option<u32>,
}

impl Recipe {
    pub(crate) const fn of(scene: &'static str, form: FileFormat) -> Self {
        Self {
            scene,
            form,
            background: BackgroundFill::Film,
            layers: &[],
            size: [70, 43],
            crop: None,
            paths: None,
        }
    }
}

/// All forms, looks and kinds of paths that differ in what is compared.
pub(crate) fn recipes() -> Vec<Recipe> {
    let glass = |form| Recipe::of("glass.yaml", form);
    let crop = Crop {
        x: 5,
        y: 7,
        width: 50,
        height: 33,
    };
    vec![
        glass(FileFormat::Png8),
        Recipe {
            crop: Some(crop),
            ..glass(FileFormat::Png16)
        },
        glass(FileFormat::Webp),
        Recipe {
            layers: &[Aov::Normal, Aov::Depth],
            background: BackgroundFill::Transparent,
            ..glass(FileFormat::Exr)
        },
        Recipe {
            paths: Some(3),
            ..glass(FileFormat::ExrHalf)
        },
        // Framed, exposed and lit by the program.
        Recipe {
            paths: Some(2),
            background: BackgroundFill::Transparent,
            ..Recipe::of("vase.glb", FileFormat::Png8)
        },
    ]
}

/// Numbers below a bound, one after another.
pub(crate) fn numbers(mut seed: u64) -> impl FnMut(u64) -> u64 {
    move |bound| {
        seed = seed.wrapping_add(0x9E37_79B9_7F4A_7C15);
        mix(seed) % bound
    }
}

/// A setup and its scene, validated and lit.
pub(crate) struct ValidatedScene {
    pub(crate) setup: PictureSetup,
    pub(crate) subject: RenderSubject,
}

/// The setup of a recipe.
pub(crate) fn setup(recipe: &Recipe) -> PictureSetup {
    let Recipe {
        form,
        background,
        layers,
        size,
        crop,
        paths,
        ..
    } = *recipe;
    let look = OutputTransform::new(form, None, None, background, layers).unwrap();
    let mut setup = PictureSetup::new(look);
    setup.overrides.size = Some(size);
    setup.overrides.spp = paths;
    setup.crop = crop;
    setup
}

/// The scene of a recipe in a setup.
pub(crate) fn validated(recipe: &Recipe, mut setup: PictureSetup) -> ValidatedScene {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    let path = path.join("scenes").join(recipe.scene);
    let mut input = Input::file(&path, Options::default());
    input.stage(ViewAndLight {
        integrator: recipe.paths.map(|_| IntegratorChoice::Path),
        ..ViewAndLight::default()
    });
    let loaded = input.load().unwrap();
    let mut subject = setup.validate(loaded, &mut input).unwrap().unwrap();
    setup.light(&mut subject, &mut input, &OBSERVER).unwrap();
    ValidatedScene { setup, subject }
}

/// A picture that was made.
pub(crate) struct Made {
    pub(crate) recipe: Recipe,
    pub(crate) picture: Picture,
    head: PictureHeader,
}

impl Made {
    pub(crate) fn new(recipe: Recipe) -> Self {
        Self::with(recipe, (1, SimdLevel::best()))
    }

    /// Made on so many threads, with these instructions.
    pub(crate) fn with(recipe: Recipe, (threads, simd): (usize, SimdLevel)) -> Self {
        let form = recipe.form;
        let setup = PictureSetup {
            threads,
            simd,
            ..setup(&recipe)
        };
        let ValidatedScene { setup, mut subject } = validated(&recipe, setup);
        let window = setup.window(&subject.validated.lowered.scene).unwrap();
        let traced = setup.trace(&mut subject, (window, u64::MAX), &OBSERVER);
        let film = traced.unwrap().film;
        let input = &mut Input::reader(String::new(), &b""[..], Options::default());
        let sums = (film.image, film.coverage, &film.counts);
        let picture = setup.develop(&mut subject, sums, &[], input, &|| false);
        let picture = picture.unwrap();
        let head = PictureHeader {
            metadata: setup.metadata(&subject.validated.lowered.scene),
            ..PictureHeader::of(&picture, form)
        };
        let made = Self {
            recipe,
            picture,
            head,
        };
        let file = setup.encode(&made.picture, &subject).unwrap();
        assert!(file == made.head.encode(&made.picture).unwrap());
        made
    }

    /// The file as it is read.
    pub(crate) fn written(&self) -> WrittenPicture {
        read(&self.file()).unwrap()
    }

    /// The bytes of the file.
    pub(crate) fn file(&self) -> Vec<u8> {
        self.head.encode(&self.picture).unwrap()
    }

    /// How many tiles its film has.
    pub(crate) fn tiles(&self) -> usize {
        self.picture.tiles.len()
    }

    /// The tile with a pixel.
    fn tile_of(&self, pixel: usize) -> u64 {
        let width = self.picture.image.width;
        let (x, y) = (pixel as u32 % width, pixel as u32 / width);
        u64::from(y / TILE * width.div_ceil(TILE) + x / TILE)
    }

    /// The file with one bit of one sample flipped, and the tile of it. `random` gives numbers.
    pub(crate) fn with_flipped_sample(
        &self,
        random: &mut impl FnMut(u64) -> u64,
    ) -> (WrittenPicture, u64) {
        let mut picture = self.picture.clone();
        let pixel = random(picture.image.pixels.len() as u64) as usize;
        let channels = picture.layers.names.len();
        let channel = random(3 + channels as u64) as usize;
        if channel >= 3 {
            // A layer of 32 bits; bits of the fraction, so that it stays a number.
            let value = &mut picture.layers.values[pixel * channels + channel - 3];
            *value = f32::from_bits(value.to_bits() ^ 1 << random(22));
        } else {
            let value = &mut picture.image.pixels[pixel][channel];
            *value = flipped(*value, self.recipe.form, random);
        }
        let bytes = self.head.encode(&picture).unwrap();
        (read(&bytes).unwrap(), self.tile_of(pixel))
    }

    /// The file with one flipped bit in each of so many tiles.
    pub(crate) fn with_damaged_tiles(&self, count: u64) -> WrittenPicture {
        let (mut picture, all) = (self.picture.clone(), self.tiles() as u64);
        let [width, columns] = [picture.image.width, picture.image.width.div_ceil(TILE)];
        for index in 0..count {
            let tile = (index * all / count) as u32;
            let [x, y] = [tile % columns, tile / columns].map(|at| at * TILE);
            let value = &mut picture.image.pixels[(y * width + x) as usize][0];
            *value = flipped(*value, self.recipe.form, &mut |bound| bound / 2);
        }
        read(&self.head.encode(&picture).unwrap()).unwrap()
    }

    /// The file with one bit of version, scene or settings flipped, of those that keep it ASCII;
    /// with the root that fits them, if that is asked for.
    pub(crate) fn with_flipped_word(
        &self,
        random: &mut impl FnMut(u64) -> u64,
        fits: bool,
    ) -> WrittenPicture {
        let change = |written: &mut WrittenPicture| {
            let metadata = &mut written.metadata;
            let texts = [
                &mut metadata.software,
                &mut metadata.scene,
                &mut metadata.settings,
            ];
            let text = texts.into_iter().nth(random(3) as usize).unwrap();
            let mut bytes = std::mem::take(text).into_bytes();
            let at = random(bytes.len() as u64) as usize;
            bytes[at] ^= 1 << random(7);
            *text = String::from_utf8(bytes).unwrap();
        };
        self.with_other_words(change, fits)
    }

    /// The file with the hash of another tile in place of one; the root is that of these hashes.
    pub(crate) fn with_other_hash(
        &self,
        random: &mut impl FnMut(u64) -> u64,
    ) -> (WrittenPicture, u64) {
        let mut tiles = self.picture.tiles.clone();
        let tile = random(tiles.len() as u64);
        tiles[tile as usize] = TileHash::of_tile(&random(u64::MAX).to_le_bytes());
        let mut written = self.written();
        written.tree = Some(MerkleTree::new(tiles, &written.metadata).pruned());
        (written, tile)
    }

    /// The file whose metadata were changed; with the root that fits them, if that is asked for.
    pub(crate) fn with_other_words(
        &self,
        change: impl FnOnce(&mut WrittenPicture),
        fits: bool,
    ) -> WrittenPicture {
        let mut written = self.written();
        change(&mut written);
        if fits {
            let tiles = self.picture.tiles.clone();
            written.tree = Some(MerkleTree::new(tiles, &written.metadata).pruned());
        }
        written
    }
}

/// A sample with one bit flipped, as the form of its file has it.
fn flipped(value: f64, form: FileFormat, random: &mut impl FnMut(u64) -> u64) -> f64 {
    let whole = |most: f64, bits: u64| {
        let stored = (value.clamp(0.0, 1.0) * most) as u64 ^ 1 << bits;
        // In the middle between two steps.
        (stored as f64 + 0.5) / most
    };
    match form {
        FileFormat::Png8 | FileFormat::Webp | FileFormat::Jpeg => whole(255.0, random(8)),
        FileFormat::Png16 => whole(65_535.0, random(16)),
        FileFormat::Exr | FileFormat::Hdr => {
            f64::from(f32::from_bits((value as f32).to_bits() ^ 1 << random(22)))
        }
        // One of the ten bits of its fraction, if it is not among the smallest.
        FileFormat::ExrHalf => {
            let bits = (value.max(0.001) as f32).to_bits();
            f64::from(f32::from_bits(bits ^ 1 << (13 + random(10))))
        }
    }
}

/// The picture of a file.
pub(crate) fn read(bytes: &[u8]) -> Option<WrittenPicture> {
    WrittenFile::open(bytes, 1 << 24)
        .and_then(WrittenFile::decode)
        .ok()
}

/// Audits a picture against a scene of the repo, on so many threads.
pub(crate) fn audit(
    written: &WrittenPicture,
    recipe: &Recipe,
    draw: TileDraw,
    (threads, simd): (usize, SimdLevel),
) -> Result<AuditResult, RenderError> {
    let (audit, setup) = match PictureAudit::open(written)? {
        Ok(opened) => opened,
        Err(result) => return Ok(result),
    };
    let setup = PictureSetup {
        threads,
        simd,
        ..setup
    };
    let ValidatedScene { setup, mut subject } = validated(recipe, setup);
    audit.run(&setup, &mut subject, (draw, u64::MAX), &OBSERVER)
}
