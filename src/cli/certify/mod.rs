//! `rtc certify`: renders a picture, and says of each pixel whether its values are proven.

mod report;

use super::args::CertifyArgs;
use super::interrupt::Interrupt;
use super::output::{self, Output};
use super::progress::RenderProgress;
use super::render::kind;
use super::reporter::Reporter;
use super::{Failure, input, simd};
pub(super) use report::CertificateReport;
use rtc_color::quantize8;
use rtc_image::{BackgroundFill, FileFormat, Image, Picture};
use rtc_passes::Overrides;
use rtc_pipeline::{OutputTransform, PictureSetup, RenderObserver};
use rtc_render::{Film, Values};
use rtc_study::{PixelCertificate, certify};
use std::path::Path;

/// Certifies a picture and reports the result.
pub(super) fn run(args: &CertifyArgs) -> Result<(), Failure> {
    let mut reporter = Reporter::beside_result(&args.reporter);
    let outcome = carry_out(args, &mut reporter);
    reporter.finish()?;
    let report = outcome?;
    if args.format.is_json() {
        output::print_json(&report.json()?)?;
    } else if !args.reporter.quiet || !report.agrees() {
        output::print(&report.to_text())?;
    }
    match report.agrees() {
        true => Ok(()),
        false => Err(Failure::Reported),
    }
}

/// Renders and certifies the picture, and writes it with its map.
fn carry_out(args: &CertifyArgs, reporter: &mut Reporter) -> Result<CertificateReport, Failure> {
    // Validate the scene in the requested size.
    let mut setup = setup(args)?;
    let mut input = input::staged(&args.scene, &args.reading, &args.stage)?;
    input.use_threads(setup.threads);
    let mut subject = input::subject(&mut setup, &mut input, reporter)?;
    let mode = &subject.validated.scene.settings().mode;
    if setup.look.values(mode) != Values::Display {
        return Err(refused(
            "only pictures of the Whitted integrator and of first hits, without exposure and tone \
            map",
        ));
    }
    let window = setup.window(&subject.validated.lowered.scene)?;
    let output = Output::open(&args.output, &input)?;
    let flags = args.flags.as_deref();
    let flags = flags.map(|path| Output::open(path, &input)).transpose()?;
    let interrupt = Interrupt::listen()?;
    // Render the picture.
    let progress = RenderProgress::start(window.pixels() as u64, reporter.is_quiet());
    let is_stopped = || interrupt.is_raised();
    let observer = RenderObserver {
        on_step: &|step| progress.step(step),
        is_stopped: &is_stopped,
    };
    let traced = setup.trace(&mut subject, (window, input.rays()), &observer);
    progress.finish();
    let Film {
        image,
        coverage,
        counts,
    } = traced?.film;
    let rendered = image.pixels.iter().map(|pixel| pixel.map(quantize8));
    let rendered = rendered.collect::<Vec<_>>();
    // Evaluate it again.
    let scene = &subject.validated.lowered.scene;
    let certified = certify(scene, setup.threads, &is_stopped);
    let certified = certified
        .map_err(|error| Failure::Failed(format!("can't start threads: {error}")))?
        .ok_or(Failure::Interrupted)?;
    let report = CertificateReport::new(
        [&args.scene, &args.output],
        window.width,
        (&certified, &rendered),
    );
    let map = map_of(&image, &certified, &rendered);
    // Write the picture and the map.
    let film = (image, coverage, &counts);
    let picture = setup.develop(&mut subject, film, &[], &mut input, &is_stopped)?;
    input::report_diagnostics(&mut input, reporter)?;
    let bytes = setup.encode(&picture, &subject)?;
    output.commit(&bytes, &interrupt)?;
    if let Some(flags) = flags {
        let bytes = Picture::opaque(map).encode(FileFormat::Png8);
        let bytes = bytes.map_err(|error| Failure::Failed(error.to_string()))?;
        flags.commit(&bytes, &interrupt)?;
    }
    Ok(report)
}

/// The setup of the picture, which has 8 bits a channel.
fn setup(args: &CertifyArgs) -> Result<PictureSetup, Failure> {
    let files = [Some(args.output.as_path()), args.flags.as_deref()];
    if files.into_iter().flatten().any(output::is_stdout) {
        let message = "standard output is for the report; give the pictures names";
        return Err(Failure::Failed(message.to_owned()));
    }
    let form = kind(&args.output, None)?;
    if !matches!(form, FileFormat::Png8 | FileFormat::Webp) {
        return Err(refused("only 8-bit files without loss: .png and .webp"));
    }
    if let Some(flags) = &args.flags
        && kind(flags, None)? != FileFormat::Png8
    {
        return Err(Failure::Failed("the map is a .png".to_owned()));
    }
    let look = OutputTransform::new(form, None, None, BackgroundFill::Film, &[]);
    let look = look.map_err(|message| Failure::Failed(message.to_owned()))?;
    Ok(PictureSetup {
        overrides: Overrides {
            size: args.size,
            ..Overrides::default()
        },
        threads: args.threads.count(),
        simd: simd::level()?,
        ..PictureSetup::new(look)
    })
}

fn refused(what: &str) -> Failure {
    Failure::Failed(format!("this picture can't be certified: {what}"))
}

/// The map of the flagged pixels, over the darkened picture.
fn map_of(image: &Image, certified: &[PixelCertificate], rendered: &[[u8; 3]]) -> Image {
    const RED: [f64; 3] = [1.0, 0.0, 0.0];
    const YELLOW: [f64; 3] = [1.0, 1.0, 0.0];
    const MAGENTA: [f64; 3] = [1.0, 0.0, 1.0];
    const BLUE: [f64; 3] = [0.0, 0.4, 0.8];
    let pixels = image.pixels.iter().zip(certified).zip(rendered);
    let color = |((pixel, certificate), rendered): ((&[f64; 3], &PixelCertificate), &[u8; 3])| {
        if !certificate.agrees(*rendered) {
            MAGENTA
        } else if certificate.is_proven() && certificate.is_close != [false; 3] {
            BLUE
        } else if certificate.is_proven() {
            pixel.map(|channel| 0.3 * channel.clamp(0.0, 1.0))
        } else if certificate.doubts.is_rounding() {
            RED
        } else {
            YELLOW
        }
    };
    Image {
        width: image.width,
        height: image.height,
        pixels: pixels.map(color).collect(),
    }
}

/// A file as on the command line.
fn named(path: &Path) -> String {
    path.display().to_string()
}
