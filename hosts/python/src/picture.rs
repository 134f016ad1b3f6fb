//! A picture for Python: its numbers as arrays of bytes, which numpy reads and writes without a copy.

use crate::findings::raised;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes};
use rtc::{Aov, Format};
use std::path::PathBuf;

/// A picture that was rendered.
#[pyclass]
pub(crate) struct Picture {
    made: rtc::Picture,
    format: Format,
}

impl Picture {
    pub(crate) fn new(made: rtc::Picture, format: Format) -> Self {
        Self { made, format }
    }
}

#[pymethods]
impl Picture {
    /// Height, width, and channels: 3, or 4 with opacity.
    #[getter]
    fn shape(&self) -> (u32, u32, usize) {
        let channels = if self.made.alpha().is_some() { 4 } else { 3 };
        (self.made.height(), self.made.width(), channels)
    }

    /// All channels of all pixels as 32-bit floats of this machine.
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let alpha = |at: usize| self.made.alpha().map(|alpha| alpha[at]);
        let pixels = self.made.pixels().iter().enumerate();
        let values = pixels.flat_map(|(at, pixel)| {
            let color = pixel.map(|value| value as f32);
            color.into_iter().chain(alpha(at))
        });
        let (height, width, channels) = self.shape();
        array(py, height as usize * width as usize * channels, values)
    }

    /// Red, green, blue and opacity of all pixels in a byte each, as a display shows them.
    fn rgba8<'py>(&self, py: Python<'py>) -> Bound<'py, PyByteArray> {
        PyByteArray::new(py, &self.made.rgba8())
    }

    /// The values of a layer as 32-bit floats of this machine, and its channels.
    fn layer<'py>(
        &self,
        py: Python<'py>,
        name: &str,
    ) -> PyResult<(Bound<'py, PyByteArray>, usize)> {
        let aov: Aov = crate::aov(name)?;
        let values = self.made.layer(aov).unwrap_or_default();
        let values = array(py, values.len(), values.into_iter())?;
        Ok((values, aov.channels().len()))
    }

    /// The bytes of its file.
    fn encode<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| self.made.encode());
        let bytes = bytes.map_err(|error| raised(py, &error))?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// Writes its file, whole or not at all.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let saved = py.detach(|| self.made.save(path));
        saved.map_err(|error| raised(py, &error))
    }

    /// What the names of its files end in.
    #[getter]
    fn extension(&self) -> &'static str {
        self.format.extension()
    }

    /// The error that was promised, in grey levels.
    #[getter]
    fn error(&self) -> Option<f64> {
        self.made.error()
    }

    /// Rays: all, from the eye, of these with a hit, and to lights.
    #[getter]
    fn rays(&self) -> (u64, u64, u64, u64) {
        let counts = self.made.statistics();
        (
            counts.rays,
            counts.camera_rays,
            counts.hits,
            counts.shadow_rays,
        )
    }

    /// What was found about the scene and in the picture, as dictionaries.
    fn findings(&self, py: Python<'_>) -> PyResult<Vec<Py<PyAny>>> {
        let findings = self.made.diagnostics().iter();
        findings.map(|finding| crate::told(py, finding)).collect()
    }
}

/// An array of bytes with that many values, which are written nowhere else before.
fn array(
    py: Python<'_>,
    count: usize,
    values: impl Iterator<Item = f32>,
) -> PyResult<Bound<'_, PyByteArray>> {
    PyByteArray::new_with(py, count * size_of::<f32>(), |bytes| {
        let (places, _) = bytes.as_chunks_mut();
        for (place, value) in places.iter_mut().zip(values) {
            *place = value.to_ne_bytes();
        }
        Ok(())
    })
}
