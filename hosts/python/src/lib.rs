//! The module `rtc._rtc`: the scenes of the library `rtc` for Python, which `python/rtc` makes pleasant. Renders
//! let other threads of Python run, and end at Ctrl-C.

mod builder;
mod findings;
mod picture;

use findings::{SceneError, raised, told};
use picture::Picture;
use pyo3::prelude::*;
use rtc::{Aov, Effort, Error, Format, Options, Progress, Reading, Tone};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// How long a signal waits at most.
const WAIT: Duration = Duration::from_millis(50);

/// A scene that was read or built.
#[pyclass]
struct Scene(rtc::Scene);

/// How a scene is read, from what Python names it by.
#[derive(Default, FromPyObject)]
struct ReadingWords {
    #[pyo3(item)]
    strict: bool,
    #[pyo3(item)]
    lenient: bool,
    #[pyo3(item)]
    asset_root: Option<PathBuf>,
    #[pyo3(item)]
    time: Option<f64>,
    #[pyo3(item)]
    animation: Option<String>,
    #[pyo3(item)]
    variant: Option<String>,
    #[pyo3(item)]
    camera: Option<String>,
}

/// How a picture is made, from what Python names it by.
#[derive(FromPyObject)]
struct PictureWords {
    #[pyo3(item)]
    format: String,
    #[pyo3(item)]
    size: Option<(u32, u32)>,
    #[pyo3(item)]
    spp: Option<u32>,
    #[pyo3(item)]
    supersampling: Option<u32>,
    #[pyo3(item)]
    depth: Option<u32>,
    #[pyo3(item)]
    settings: BTreeMap<String, String>,
    #[pyo3(item)]
    target_error: Option<f64>,
    #[pyo3(item)]
    threads: usize,
    #[pyo3(item)]
    max_rays: Option<u64>,
    #[pyo3(item)]
    exposure: Option<f64>,
    #[pyo3(item)]
    tonemap: Option<String>,
    #[pyo3(item)]
    transparent: bool,
    #[pyo3(item)]
    orbit: Option<(f64, f64)>,
    #[pyo3(item)]
    aovs: Vec<String>,
}

impl ReadingWords {
    fn reading(self) -> Reading {
        let mut reading = Reading::new().strict(self.strict).lenient(self.lenient);
        if let Some(folder) = self.asset_root {
            reading = reading.asset_root(folder);
        }
        if let Some(time) = self.time {
            reading = reading.time(time);
        }
        if let Some(name) = self.animation {
            reading = reading.animation(name);
        }
        if let Some(name) = self.variant {
            reading = reading.variant(name);
        }
        if let Some(name) = self.camera {
            reading = reading.camera(name);
        }
        reading
    }
}

impl PictureWords {
    fn options(&self) -> PyResult<Options> {
        let mut options = Options::new()
            .format(format(&self.format)?)
            .threads(self.threads);
        if let Some((width, height)) = self.size {
            options = options.size(width, height);
        }
        if let Some(paths) = self.spp {
            options = options.samples(paths);
        }
        if let Some(side) = self.supersampling {
            options = options.supersampling(side);
        }
        if let Some(bounces) = self.depth {
            options = options.depth(bounces);
        }
        if let Some(levels) = self.target_error {
            options = options.target_error(levels);
        }
        if let Some(rays) = self.max_rays {
            options = options.max_rays(rays);
        }
        if let Some(stops) = self.exposure {
            options = options.exposure(stops);
        }
        if let Some(name) = &self.tonemap {
            options = options.tonemap(tone(name)?);
        }
        if self.transparent {
            options = options.transparent();
        }
        if let Some((azimuth, elevation)) = self.orbit {
            options = options.orbit(azimuth, elevation);
        }
        for (name, value) in &self.settings {
            options = options.set(name, value);
        }
        for name in &self.aovs {
            options = options.layer(aov(name)?);
        }
        Ok(options)
    }
}

#[pymethods]
impl Scene {
    /// The scene in a file.
    #[staticmethod]
    fn open(py: Python<'_>, path: PathBuf, reading: ReadingWords) -> PyResult<Self> {
        let reading = reading.reading();
        let scene = py.detach(|| reading.open(path));
        scene.map(Self::new).map_err(|error| raised(py, &error))
    }

    /// The scene at a path among files in memory.
    #[staticmethod]
    fn of_files(
        py: Python<'_>,
        path: &str,
        files: BTreeMap<String, Vec<u8>>,
        reading: ReadingWords,
    ) -> PyResult<Self> {
        let reading = reading.reading();
        let scene = py.detach(|| reading.from_files(path, files));
        scene.map(Self::new).map_err(|error| raised(py, &error))
    }

    /// All that is to be said of it, as dictionaries.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<Py<PyAny>>> {
        let findings = py.detach(|| self.0.check());
        findings.iter().map(|finding| told(py, finding)).collect()
    }

    /// Its picture; `on_progress` is called with the share that is done, `on_picture` with the
    /// picture so far.
    fn render(
        &self,
        py: Python<'_>,
        words: PictureWords,
        on_progress: Option<Py<PyAny>>,
        on_picture: Option<Py<PyAny>>,
    ) -> PyResult<Picture> {
        let (mut options, format) = (words.options()?, format(&words.format)?);
        let state = Arc::new(RenderState::default());
        state
            .is_wanted
            .store(on_picture.is_some(), Ordering::Relaxed);
        if on_progress.is_some() || on_picture.is_some() {
            let state = Arc::clone(&state);
            options = options.on_progress(move |progress| state.report(progress));
        }
        let report = |py: Python<'_>| {
            if let Some(report) = &on_progress {
                report.call1(py, (state.share(),))?;
            }
            if let (Some(show), Some(made)) = (&on_picture, state.take_picture()) {
                show.call1(py, (Picture::new(made, format),))?;
                state.is_wanted.store(true, Ordering::Relaxed);
            }
            Ok(())
        };
        let picture = beside(py, &report, |stop| self.0.render_until(&options, stop))?;
        Ok(Picture::new(picture, format))
    }

    /// A copy, to be changed.
    fn copy(&self) -> Self {
        Self(self.0.clone())
    }

    /// What accuracy costs in time, as JSON.
    fn cost(&self, py: Python<'_>, effort: &str) -> PyResult<String> {
        let effort = match effort {
            "quick" => Effort::Quick,
            "normal" => Effort::Normal,
            "thorough" => Effort::Thorough,
            _ => return Err(unknown("effort", effort, "quick, normal, thorough")),
        };
        let cost = beside(py, &|_| Ok(()), |stop| self.0.cost_until(effort, stop))?;
        Ok(cost.json())
    }
}

/// What the threads of a render tell the thread of Python.
#[derive(Default)]
struct RenderState {
    /// The bits of the share that is done.
    share: AtomicU64,
    /// Whether the next report is to bring the picture so far.
    is_wanted: AtomicBool,
    picture: Mutex<Option<rtc::Picture>>,
}

impl RenderState {
    fn report(&self, progress: Progress<'_>) {
        self.share.store(progress.done.to_bits(), Ordering::Relaxed);
        if self.is_wanted.swap(false, Ordering::Relaxed) {
            let picture = progress.picture();
            self.is_wanted.store(picture.is_none(), Ordering::Relaxed);
            *self.lock() = picture;
        }
    }

    fn share(&self) -> f64 {
        f64::from_bits(self.share.load(Ordering::Relaxed))
    }

    fn take_picture(&self) -> Option<rtc::Picture> {
        self.lock().take()
    }

    fn lock(&self) -> MutexGuard<'_, Option<rtc::Picture>> {
        self.picture.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Does some work beside the thread of Python, which reports progress and looks for signals meanwhile.
fn beside<T: Send>(
    py: Python<'_>,
    report: &dyn Fn(Python<'_>) -> PyResult<()>,
    work: impl FnOnce(&(dyn Fn() -> bool + Sync)) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let is_stopped = AtomicBool::new(false);
    let stop = || is_stopped.load(Ordering::Relaxed);
    thread::scope(|scope| {
        let (sender, receiver) = channel();
        scope.spawn(|| {
            let done = work(&stop);
            // Whoever was stopped by a signal does not wait for it.
            let _ = sender.send(done);
            drop(sender);
        });
        let receiver = Mutex::new(receiver);
        let wait = || {
            let receiver = receiver.lock().unwrap_or_else(|poison| poison.into_inner());
            receiver.recv_timeout(WAIT)
        };
        loop {
            match py.detach(wait) {
                Ok(done) => {
                    report(py)?;
                    return done.map_err(|error| raised(py, &error));
                }
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(signal) = py.check_signals().and_then(|()| report(py)) {
                        is_stopped.store(true, Ordering::Relaxed);
                        return Err(signal);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    let words = "internal error: the work ended without a result";
                    return Err(SceneError::new_err(words));
                }
            }
        }
    })
}

impl Scene {
    fn new(scene: rtc::Scene) -> Self {
        Self(scene)
    }
}

fn format(name: &str) -> PyResult<Format> {
    match name {
        "png" => Ok(Format::Png),
        "png16" => Ok(Format::Png16),
        "exr" => Ok(Format::Exr),
        "exr16" => Ok(Format::ExrHalf),
        _ => Err(unknown("format", name, "png, png16, exr, exr16")),
    }
}

fn tone(name: &str) -> PyResult<Tone> {
    match name {
        "none" => Ok(Tone::None),
        "srgb" => Ok(Tone::Srgb),
        "agx" => Ok(Tone::Agx),
        "pbr-neutral" => Ok(Tone::PbrNeutral),
        _ => Err(unknown("tonemap", name, "none, srgb, agx, pbr-neutral")),
    }
}

/// A layer by its name.
fn aov(name: &str) -> PyResult<Aov> {
    let all = [
        Aov::Albedo,
        Aov::Normal,
        Aov::Depth,
        Aov::Uv,
        Aov::Instance,
        Aov::Position,
        Aov::Error,
        Aov::Samples,
        Aov::Undersampled,
    ];
    let found = all.into_iter().find(|aov| aov.name() == name);
    found.ok_or_else(|| {
        unknown(
            "layer",
            name,
            "albedo, normal, depth, uv, instance, position, error, samples, unmet",
        )
    })
}

fn unknown(what: &str, name: &str, all: &str) -> PyErr {
    pyo3::exceptions::PyValueError::new_err(format!("no {what} `{name}`; there are {all}"))
}

/// The command line of the words given, the first being the name of the program; its exit code.
#[pyfunction]
fn command(py: Python<'_>, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| rtc::run(words))
}

#[pymodule]
fn _rtc(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("SceneError", module.py().get_type::<SceneError>())?;
    module.add_class::<Scene>()?;
    module.add_class::<builder::Builder>()?;
    module.add_class::<Picture>()?;
    module.add_function(wrap_pyfunction!(builder::material_values, module)?)?;
    module.add_function(wrap_pyfunction!(command, module)?)
}
