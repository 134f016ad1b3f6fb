//! The commands that the tasks of a job run: one for a part, one for the picture of all.

use super::super::args::{ArithmeticArg, BackgroundArg, FarmArgs};
use super::frames::JobFrames;
use clap::ValueEnum;
use rtc_image::BackgroundFill;
use rtc_pipeline::Exposure;
use rtc_render::Crop;
use rtc_source::Resource;

/// The arguments of the commands, without those that differ between tasks.
pub(super) struct JobCommands<'a> {
    frames: &'a JobFrames,
    /// The settings of the picture that are not part of the scene.
    look: Vec<String>,
    /// The resource limits of the run.
    limits: Vec<String>,
    parts: u32,
    by: String,
    threads: u16,
    picture: String,
    allows_huge: bool,
}

impl<'a> JobCommands<'a> {
    pub(super) fn new(args: &FarmArgs, frames: &'a JobFrames) -> Self {
        let limit = |(name, number): &(Resource, u64)| {
            ["--limit".to_owned(), format!("{}={number}", name.name())]
        };
        let mut limits: Vec<String> = args.reading.limit.iter().flat_map(limit).collect();
        if args.reading.allow_huge {
            limits.push("--allow-huge".to_owned());
        }
        Self {
            frames,
            look: look(args),
            limits,
            parts: args.parts,
            by: name(args.parts_by),
            threads: args.threads,
            picture: args.picture.clone(),
            allows_huge: args.reading.allow_huge,
        }
    }

    /// The command that renders the picture of a frame in one process.
    pub(super) fn whole(&self, frame: &str) -> Vec<String> {
        // A turntable numbers its views itself.
        let output = match self.frames {
            JobFrames::Turntable(..) => self.picture.clone(),
            JobFrames::One | JobFrames::Animation(..) => self.output(frame),
        };
        let output = ["-o".to_owned(), output];
        [self.render("", frame), output.to_vec()].concat()
    }

    /// The command that renders a part of the picture of a frame, in a folder that is given with a
    /// slash, or empty where it is the current one.
    pub(super) fn part(&self, folder: &str, frame: &str, part: &str) -> Vec<String> {
        let arguments = [
            "--picture",
            &self.picture,
            "--parts-by",
            &self.by,
            "--part",
            &format!("{part}/{}", self.parts),
            "--threads",
            &self.threads.to_string(),
            "-o",
            &format!("{folder}{}", self.name(frame, part)),
        ];
        let arguments = arguments.map(str::to_owned).to_vec();
        [self.render(folder, frame), arguments].concat()
    }

    /// The command that merges parts of the picture of a frame, whose names are given.
    pub(super) fn merge(&self, folder: &str, frame: &str, parts: &[String]) -> Vec<String> {
        let mut arguments = vec!["merge".to_owned()];
        arguments.extend(parts.iter().map(|name| format!("{folder}{name}")));
        if self.allows_huge {
            arguments.push("--allow-huge".to_owned());
        }
        arguments.extend(["-o".to_owned(), format!("{folder}{}", self.output(frame))]);
        arguments
    }

    /// The names of all parts of the picture of a frame.
    pub(super) fn names(&self, frame: &str) -> Vec<String> {
        let parts = 1..=self.parts;
        parts
            .map(|part| self.name(frame, &part.to_string()))
            .collect()
    }

    /// The name of a part.
    pub(super) fn name(&self, frame: &str, part: &str) -> String {
        match self.frames.range() {
            Some(_) => format!("part-{frame}-{part}.rtp"),
            None => format!("part-{part}.rtp"),
        }
    }

    /// The name of the picture of a frame.
    pub(super) fn output(&self, frame: &str) -> String {
        match (self.frames.range(), self.picture.rsplit_once('.')) {
            (Some(_), Some((stem, extension))) => format!("{stem}-{frame}.{extension}"),
            _ => self.picture.clone(),
        }
    }

    /// The arguments that the commands for a part and for the whole share.
    fn render(&self, folder: &str, frame: &str) -> Vec<String> {
        // The scene already has its light: a dark scene stays dark.
        let scene = format!("{folder}{}", self.frames.scene(frame));
        let scene = ["render", &scene, "--studio", "off"];
        let mut arguments = scene.map(str::to_owned).to_vec();
        arguments.extend_from_slice(&self.look);
        arguments.extend_from_slice(&self.limits);
        if let JobFrames::Turntable(_, count) = self.frames {
            let frames = format!("{frame}..{frame}");
            let turn = ["--turntable", &count.to_string(), "--frames", &frames];
            arguments.extend(turn.map(str::to_owned));
        }
        arguments
    }
}

/// The output settings that are not part of the scene.
fn look(args: &FarmArgs) -> Vec<String> {
    let mut arguments = Vec::new();
    let mut flag = |name: &str, value: String| arguments.push(format!("--{name}={value}"));
    // Each setting that is not the default becomes a flag.
    if let Some(Crop {
        x,
        y,
        width,
        height,
    }) = args.wanted.crop
    {
        flag("crop", format!("{x},{y},{width},{height}"));
    }
    if args.wanted.arithmetic != ArithmeticArg::default() {
        flag("arithmetic", name(args.wanted.arithmetic));
    }
    if let Some(map) = args.look.tonemap {
        flag("tonemap", name(map));
    }
    if let Some(Exposure::Stops(stops)) = args.look.exposure {
        flag("exposure", stops.to_string());
    }
    match args.look.background {
        BackgroundArg::Fill(BackgroundFill::Film) => {}
        BackgroundArg::Fill(BackgroundFill::Transparent) => {
            flag("background", "transparent".to_owned());
        }
        BackgroundArg::Fill(BackgroundFill::Color([r, g, b])) => {
            flag("background", format!("{r},{g},{b}"));
        }
        BackgroundArg::Color([r, g, b]) => flag("background", format!("#{r:02x}{g:02x}{b:02x}")),
    }
    if !args.look.aov.is_empty() {
        let layers: Vec<String> = args.look.aov.iter().copied().map(name).collect();
        flag("aov", layers.join(","));
    }
    if let Some(bits) = args.look.bits {
        flag("bits", name(bits));
    }
    arguments
}

/// A value as it is typed.
fn name<T: ValueEnum>(value: T) -> String {
    let value = value.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}
