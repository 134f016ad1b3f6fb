//! The cache of finished pictures: `--cache DIR`.
//!
//! There are two kinds of entries. A *picture* is found by the hash of its scene as it is rendered
//! and of all settings; the scene must be read for that. A *request* is found by the path of the
//! scene and by the arguments; it lists the files that were read and the paths that were tried, and
//! names the picture. If none of them has changed, nothing is read but their bytes.
//!
//! Messages are never lost: a request keeps them as they were printed, and they are printed again.
//! A picture whose pixels gave a warning is taken only by its own request, because the warning
//! names the scene.

use super::super::project::Project;
use super::super::reporter::{self, ReportedMessage, Reporter};
use super::super::{Failure, args, interrupt::Interrupt, output::Output};
use super::layers::{self, LayerFiles};
use super::{FinishedPicture, RenderSetup};
use rtc_ir::Scene;
use rtc_pipeline::{
    CacheFolder, CacheKey, CacheMiss, Input, PictureSetup, RenderSubject, scene_digest,
};
use rtc_render::SimdLevel;
use rtc_source::{Loader, ReadRecord, SourceMap};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The most bytes of the folder, unless the user says otherwise.
const LIMIT: u64 = 1 << 30;

/// The largest file of a scene that is compared, in bytes.
const MAX_FILE: u64 = 1 << 30;

/// A folder of finished pictures, for one command.
pub(super) struct PictureCache {
    folder: CacheFolder,
    scene: PathBuf,
    reading: args::ReadArgs,
    /// All that the picture depends on except files and the place where the command runs.
    request: String,
    /// The entry of the request; standard input has none.
    key: Option<CacheKey>,
    /// The number of files of a picture: itself, then its layers.
    files: usize,
}

/// An entry of a request.
#[derive(Deserialize, Serialize)]
struct CachedRequest {
    /// The paths that were tried, each with its canonical path.
    lookups: BTreeMap<PathBuf, Option<PathBuf>>,
    /// The SHA-256 of each file, by canonical path.
    files: BTreeMap<PathBuf, [u8; 32]>,
    /// The messages about the scene and its picture.
    messages: Vec<ReportedMessage>,
    /// The entry of the picture.
    picture: String,
}

/// The head of an entry of a picture; the bytes of its files follow.
#[derive(Deserialize, Serialize)]
struct CachedPicture {
    size: [u32; 2],
    /// The text about its quality, if that is known.
    quality: Option<String>,
    /// Whether its pixels gave warnings, which only the entry of its request has.
    has_warnings: bool,
    /// The object of `--message-format json`.
    object: Map<String, Value>,
    /// The length of each file: the picture, then its layers.
    lengths: Vec<usize>,
}

/// A finished picture of a request.
struct RecalledPicture {
    picture: CachedPicture,
    files: Vec<Vec<u8>>,
    messages: Vec<ReportedMessage>,
    /// The files that it depends on.
    read: SourceMap,
}

impl PictureCache {
    /// The cache of a command, if one is requested and can be used.
    pub(super) fn open(
        setup: &RenderSetup,
        file: &Path,
        args: &args::RenderArgs,
        reporter: &mut Reporter,
    ) -> Result<Option<Self>, Failure> {
        // Flags come before the settings of the project.
        let project = Project::of(file, &args.reading)?;
        let (own, own_limit) = project.as_ref().map(Project::cache).unwrap_or_default();
        let Some(path) = args.cache.clone().or(own) else {
            return Ok(None);
        };
        if let Some(reason) = obstacle(args) {
            reporter.note(&format!("cache: not used: {reason}"));
            return Ok(None);
        }
        let limit = args.cache_limit.or(own_limit).unwrap_or(LIMIT);
        let folder = match CacheFolder::at(&path, limit) {
            Ok(folder) => folder,
            Err(error) => {
                let path = path.display();
                reporter.warn(&format!("warning: no cache in `{path}`: {error}"));
                return Ok(None);
            }
        };
        // The request, without what changes no byte.
        let picture = settings(&setup.picture);
        let style = reporter.style();
        let request = format!("{picture} {:?} {:?} {style}", args.stage, args.reading);
        let mut cache = Self {
            folder,
            scene: file.to_owned(),
            reading: args.reading.clone(),
            request,
            key: None,
            files: 1 + layers::separate(&setup.picture.look).len(),
        };
        cache.key = cache.request_key(project.as_ref());
        reporter.record();
        Ok(Some(cache))
    }

    /// The key of the request now, with its project.
    fn request_key(&self, project: Option<&Project>) -> Option<CacheKey> {
        if self.scene.as_os_str() == "-" {
            return None;
        }
        let root = self.reading.asset_root.clone();
        let root = root.or_else(|| project.and_then(Project::asset_root));
        let root = root.and_then(|root| fs::canonicalize(root).ok());
        // Messages have the path as it is written.
        let places = (
            &self.scene,
            fs::canonicalize(&self.scene).ok()?,
            std::env::current_dir().ok()?,
            std::env::home_dir(),
            root,
        );
        let places = format!("{places:?}");
        let project = project.map(Project::identity).unwrap_or_default();
        let parts = [
            self.request.as_bytes(),
            places.as_bytes(),
            project.as_bytes(),
        ];
        Some(CacheKey::of("request", &parts))
    }

    /// The picture of the request if nothing has changed since, else the reason.
    fn recall(&self) -> Result<RecalledPicture, String> {
        let key = self.key.ok_or("standard input has no request")?;
        let entry = self.folder.get(key).map_err(|miss| match miss {
            CacheMiss::Absent => "no such request gave a picture".to_owned(),
            CacheMiss::Damaged | CacheMiss::Unreadable(_) => miss.to_string(),
        })?;
        let request: CachedRequest =
            serde_json::from_slice(&entry).map_err(|_| CacheMiss::Damaged.to_string())?;
        // Compare where the paths lead, then the bytes.
        let record = ReadRecord {
            lookups: request.lookups,
            ..ReadRecord::default()
        };
        if !record.leads_there() {
            return Err("a file came, went or moved".to_owned());
        }
        let map = SourceMap::default().recording();
        for path in request.files.keys() {
            // Reading records the hash; what can't be read has none.
            let _ = Loader.bytes(path, MAX_FILE, &map);
        }
        let now = map.record().unwrap_or_default().files;
        let is_same = |(path, hash): &(&PathBuf, &[u8; 32])| now.get(*path) == Some(*hash);
        if let Some((path, _)) = request.files.iter().find(|file| !is_same(file)) {
            return Err(format!("`{}` has changed", path.display()));
        }
        let are_harmless = request.messages.iter().all(ReportedMessage::is_harmless);
        let key = CacheKey::parse(&request.picture).filter(|_| are_harmless);
        let key = key.ok_or(CacheMiss::Damaged.to_string())?;
        let (picture, files) = self.picture(key)?;
        Ok(RecalledPicture {
            picture,
            files,
            messages: request.messages,
            read: map,
        })
    }

    /// The picture of a key with its files, or the reason why there is none.
    fn picture(&self, key: CacheKey) -> Result<(CachedPicture, Vec<Vec<u8>>), String> {
        let entry = self.folder.get(key).map_err(|miss| match miss {
            CacheMiss::Absent => "no picture of this scene and these settings".to_owned(),
            CacheMiss::Damaged | CacheMiss::Unreadable(_) => miss.to_string(),
        })?;
        unpacked(&entry, self.files).ok_or_else(|| CacheMiss::Damaged.to_string())
    }

    /// Keeps an entry; a failure is a warning.
    fn keep(&self, key: CacheKey, bytes: &[u8], interrupt: &Interrupt, reporter: &mut Reporter) {
        if let Err(error) = self.folder.put(key, bytes, interrupt)
            && !interrupt.is_raised()
        {
            reporter.warn(&format!("warning: the cache is not written: {error}"));
        }
    }

    /// Keeps the request of a picture with its messages, unless something changed on the way.
    fn keep_request(
        &self,
        (record, messages): (Option<ReadRecord>, Option<Vec<ReportedMessage>>),
        picture: CacheKey,
        interrupt: &Interrupt,
        reporter: &mut Reporter,
    ) -> Result<(), Failure> {
        let project = Project::of(&self.scene, &self.reading)?;
        let key = self
            .key
            .filter(|key| Some(*key) == self.request_key(project.as_ref()));
        let record = record.filter(|record| !record.has_changed);
        let (Some(key), Some(record), Some(messages)) = (key, record, messages) else {
            return Ok(());
        };
        let ReadRecord {
            lookups,
            files,
            has_changed: _,
        } = record;
        let request = CachedRequest {
            lookups,
            files,
            messages,
            picture: picture.to_string(),
        };
        // A path that is no UTF-8 has no JSON.
        if let Ok(entry) = serde_json::to_vec(&request) {
            self.keep(key, &entry, interrupt, reporter);
        }
        Ok(())
    }

    /// Says with `-v` whether the picture was there, and why.
    fn report_use(&self, reporter: &Reporter, message: &str) {
        reporter.note(&format!("cache: `{}`: {message}", self.scene.display()));
    }
}

impl RenderSetup {
    /// Writes the picture from the cache if no file of the request has changed; false if it must be
    /// rendered.
    pub(super) fn recall(
        &self,
        cache: &PictureCache,
        reporter: &mut Reporter,
    ) -> Result<bool, Failure> {
        match cache.recall() {
            Ok(RecalledPicture {
                picture,
                files,
                messages,
                read,
            }) => {
                let interrupt = Interrupt::listen()?;
                reporter.report_again(&messages)?;
                self.write_cached(&picture, &files, &read, (reporter, &interrupt))?;
                cache.report_use(reporter, "hit: no file has changed");
                Ok(true)
            }
            Err(reason) => {
                cache.report_use(reporter, &format!("to be read: {reason}"));
                Ok(false)
            }
        }
    }

    /// Takes the picture of a scene from the cache, or renders and keeps it.
    pub(super) fn render_cached(
        &self,
        cache: &PictureCache,
        subject: &mut RenderSubject,
        (input, reporter, interrupt): (&mut Input, &mut Reporter, &Interrupt),
    ) -> Result<(), Failure> {
        let scene = &subject.validated.lowered.scene;
        let key = picture_key(&self.picture, scene, input.rays());
        let kept = cache.picture(key).and_then(|(picture, files)| {
            let reason = "its pixels give warnings, which name the scene";
            let is_silent = !picture.has_warnings;
            is_silent
                .then_some((picture, files))
                .ok_or(reason.to_owned())
        });
        let messages = match kept {
            Ok((picture, files)) => {
                self.write_cached(&picture, &files, input.map(), (reporter, interrupt))?;
                cache.report_use(reporter, "hit: the same scene and settings");
                reporter.take_record()
            }
            Err(reason) => {
                let warnings = reporter.warnings();
                let (files, made) =
                    self.make_picture(subject, &self.output, input, reporter, interrupt)?;
                cache.report_use(reporter, &format!("miss: {reason}"));
                let messages = reporter.take_record();
                let entry = packed(&made, &files, reporter.warnings() > warnings);
                cache.keep(key, &entry, interrupt, reporter);
                messages
            }
        };
        let read = input.map().record();
        cache.keep_request((read, messages), key, interrupt, reporter)
    }

    /// Writes the files of a picture from the cache, and reports it.
    fn write_cached(
        &self,
        picture: &CachedPicture,
        files: &[Vec<u8>],
        read: &SourceMap,
        (reporter, interrupt): (&Reporter, &Interrupt),
    ) -> Result<(), Failure> {
        let output = Output::open_unless_read(&self.output, read)?;
        let layers = LayerFiles::open(&self.picture.look, &self.output, read)?;
        let (first, rest) = files
            .split_first()
            .expect("an entry has as many files as its picture");
        output.commit(first, interrupt)?;
        layers.commit(rest, interrupt)?;
        if !reporter.is_quiet() {
            match reporter.tells_objects() {
                true => reporter::print_object(&picture.object(&self.output)),
                false => reporter::print_message(&picture.text(&self.output)),
            }
        }
        Ok(())
    }
}

impl CachedPicture {
    /// The object about the picture at its new place.
    fn object(&self, output: &Path) -> String {
        let mut object = self.object.clone();
        object.insert("output".to_owned(), json!(output.display().to_string()));
        object.insert("cached".to_owned(), json!(true));
        json!({ "rendered": object }).to_string()
    }

    /// The message about the picture at its new place.
    fn text(&self, output: &Path) -> String {
        let [width, height] = self.size;
        let line = format!("{}: {width}×{height}, from the cache", output.display());
        let lines = [Some(line), self.quality.clone()];
        lines.into_iter().flatten().collect::<Vec<_>>().join("\n")
    }
}

/// The content of the entry of a picture: the length of its head, the head, the files.
fn packed(made: &FinishedPicture, files: &[Vec<u8>], has_warnings: bool) -> Vec<u8> {
    let head = CachedPicture {
        size: made.size(),
        quality: made.quality_text(),
        has_warnings,
        object: made.facts().as_object().cloned().unwrap_or_default(),
        lengths: files.iter().map(Vec::len).collect(),
    };
    let head = serde_json::to_vec(&head).expect("texts and numbers have JSON");
    let mut entry = (head.len() as u64).to_le_bytes().to_vec();
    entry.extend(head);
    files.iter().for_each(|file| entry.extend_from_slice(file));
    entry
}

/// The head and the files of an entry; `None` if it is none of a picture of so many files.
fn unpacked(entry: &[u8], count: usize) -> Option<(CachedPicture, Vec<Vec<u8>>)> {
    let (length, rest) = entry.split_first_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let (head, mut rest) = rest.split_at_checked(length)?;
    let head: CachedPicture = serde_json::from_slice(head).ok()?;
    let mut files = Vec::new();
    for length in &head.lengths {
        let (file, others) = rest.split_at_checked(*length)?;
        files.push(file.to_vec());
        rest = others;
    }
    let is_whole = rest.is_empty() && files.len() == count;
    is_whole.then_some((head, files))
}

/// The key of the picture of a scene as it is rendered, with at most this number of rays.
fn picture_key(setup: &PictureSetup, scene: &Scene, rays: u64) -> CacheKey {
    let settings = settings(setup);
    let parts = [
        &scene_digest(scene)[..],
        settings.as_bytes(),
        &rays.to_le_bytes(),
    ];
    CacheKey::of("picture", &parts)
}

/// The settings of a picture as text, without those that change no byte.
fn settings(setup: &PictureSetup) -> String {
    let setup = PictureSetup {
        threads: 0,
        simd: SimdLevel::named("scalar").expect("every machine has this level"),
        ..setup.clone()
    };
    format!("{setup:?}")
}

/// The reason why such a command does not use the cache, if any.
fn obstacle(args: &args::RenderArgs) -> Option<&'static str> {
    let obstacles = [
        (args.turntable.is_some(), "a turntable is many pictures"),
        (args.part.is_some(), "a part is no picture"),
        (
            args.checkpoint.is_some(),
            "a checkpoint keeps the work itself",
        ),
        (
            args.strips.is_some(),
            "a picture in strips is never whole in memory",
        ),
        (
            args.time_budget.is_some(),
            "the picture depends on the machine",
        ),
        (
            args.pruning.verify_effects,
            "`--verify-effects` is about rendering",
        ),
    ];
    let mut found = obstacles.into_iter().filter(|(is_so, _)| *is_so);
    found.next().map(|(_, reason)| reason)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An entry with this head and these bytes of files, which somebody wrote.
    fn entry(head: &Value, files: &[u8]) -> Vec<u8> {
        let head = head.to_string();
        [&(head.len() as u64).to_le_bytes(), head.as_bytes(), files].concat()
    }

    #[test]
    fn an_entry_that_is_no_picture_is_damaged() {
        let head = |lengths: Value, object: Value| {
            json!({ "size": [1, 1], "quality": null, "has_warnings": false, "object": object,
                "lengths": lengths })
        };
        let sound = entry(&head(json!([2, 1]), json!({})), b"abc");
        let (_, files) = unpacked(&sound, 2).unwrap();
        assert_eq!(files, [b"ab".to_vec(), b"c".to_vec()]);
        assert!(unpacked(&sound, 1).is_none() && unpacked(&sound, 3).is_none());
        for lengths in [
            json!([]),
            json!([9999]),
            json!([u64::MAX, u64::MAX]),
            json!([1, 1, 1]),
        ] {
            assert!(unpacked(&entry(&head(lengths.clone(), json!({})), b"abc"), 2).is_none());
        }
        for object in [json!([]), json!("a"), json!(1)] {
            assert!(unpacked(&entry(&head(json!([3]), object), b"abc"), 1).is_none());
        }
        assert!(unpacked(&u64::MAX.to_le_bytes(), 1).is_none());
    }

    #[test]
    fn messages_that_are_printed_again_have_colours_only() {
        let is_harmless = |text: &str| ReportedMessage::Warning(text.to_owned()).is_harmless();
        assert!(is_harmless("\x1b[1;31merror\x1b[0m: no\n\tmore"));
        for text in [
            "\x1b]0;title\x07",
            "\x1b[2J",
            "a\x1b",
            "\u{202e}",
            "\x1b[31",
            "\u{9b}31m",
        ] {
            assert!(!is_harmless(text), "{text:?}");
        }
    }
}
