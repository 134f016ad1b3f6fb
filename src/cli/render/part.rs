//! One share of a picture, for `rtc merge` to put together with the others.

use super::super::progress::{self, RenderProgress};
use super::super::{Failure, args, interrupt::Interrupt, reporter, reporter::Reporter, typed};
use super::{RenderSetup, beside_here, halted};
use rtc_pipeline::{Input, RenderObserver, RenderSubject, ShardDivision, ShardPlan};
use rtc_study::RenderGoal;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A share as it will be rendered.
pub(super) struct PartSetup {
    shares: ShardPlan,
    /// The picture that it is of.
    picture: PathBuf,
    /// The arguments of the command without the share and the output.
    command: Vec<String>,
}

impl PartSetup {
    /// The requested share, if any.
    pub(super) fn new(
        args: &args::RenderArgs,
        typed: &[OsString],
    ) -> Result<Option<Self>, Failure> {
        let Some([index, count]) = args.part else {
            return Ok(None);
        };
        let trouble = |message: &str| Err(Failure::Failed(message.to_owned()));
        if has_goal(args) {
            return trouble(
                "a part can't estimate the error of the whole picture; set its samples with \
                `--spp` or `--supersampling` instead of a target",
            );
        }
        let is_one = args.frames.is_some_and(|[first, last]| first == last);
        if args.turntable.is_some() && !is_one {
            return trouble("a part is of one picture; say of which by `--frames 3..3`");
        }
        let is_part = |output: &PathBuf| output.extension().is_some_and(|it| it == "rtp");
        if args.output.as_ref().is_some_and(|output| !is_part(output)) {
            return trouble(
                "a part is no picture yet; name it .rtp, and the picture by `--picture`",
            );
        }
        Ok(Some(Self {
            shares: ShardPlan {
                by: args.parts_by.into(),
                first: index,
                last: index,
                count,
            },
            picture: args.picture.clone().map_or_else(|| beside_here(args), Ok)?,
            command: typed::without(typed, &["--part", "--output", "-o"]),
        }))
    }

    /// The picture that it is of.
    pub(super) fn picture(&self) -> &Path {
        &self.picture
    }

    /// The name of the scene with the share and `.rtp`, in the current folder.
    pub(super) fn beside_here(&self, args: &args::RenderArgs) -> Result<PathBuf, Failure> {
        let ShardPlan { first, count, .. } = self.shares;
        let picture = beside_here(args)?;
        Ok(picture.with_extension(format!("{first}-of-{count}.rtp")))
    }
}

/// Whether the picture has a target instead of a number of samples.
fn has_goal(args: &args::RenderArgs) -> bool {
    args.goal() != RenderGoal::default()
}

impl RenderSetup {
    /// Renders one share of the picture and writes it.
    pub(super) fn shoot_part(
        &self,
        part: &PartSetup,
        subject: &mut RenderSubject,
        input: &mut Input,
        reporter: &mut Reporter,
        interrupt: &Interrupt,
    ) -> Result<(), Failure> {
        // Count the pixels of the share.
        let (window, output) = self.ready(subject, &self.output, input)?;
        let ShardPlan {
            by, first, count, ..
        } = part.shares;
        let pixels = match by {
            ShardDivision::Tiles => window.pixels() as u64 / u64::from(count),
            ShardDivision::Samples => window.pixels() as u64,
        };
        let progress = RenderProgress::start(pixels, reporter.is_quiet());
        let observer = RenderObserver {
            on_step: &|step| progress.step(step),
            is_stopped: &|| interrupt.is_raised(),
        };
        // Render the share and save its film.
        let order = (part.shares, window, input.rays());
        let made = self.picture.part(subject, order, &observer);
        let elapsed = progress.finish();
        let made = match made {
            Ok(made) => made.made_by(part.command.clone()),
            Err(error) => return halted(error, input, reporter),
        };
        output.commit(&made.save(), interrupt)?;
        if !reporter.is_quiet() {
            let path = self.output.display();
            let work = progress::summary(made.counts().rays(), elapsed);
            reporter::print_message(&format!("{path}: share {first} of {count}, {work}"));
        }
        Ok(())
    }
}
