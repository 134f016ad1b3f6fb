//! Findings as dictionaries, and the errors of the library as the exception that holds them.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rtc::{Diagnostic, Error, Severity};

pyo3::create_exception!(
    rtc,
    SceneError,
    PyValueError,
    "A scene that can't be read or rendered; `findings` says what was found in it."
);

/// A finding as a dictionary.
pub(crate) fn told(py: Python<'_>, finding: &Diagnostic) -> PyResult<Py<PyAny>> {
    let dict = PyDict::new(py);
    let place = finding.primary.as_ref().map(|label| &label.location);
    let severity = match finding.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    };
    dict.set_item("code", finding.code)?;
    dict.set_item("severity", severity)?;
    dict.set_item("message", &finding.message)?;
    dict.set_item("file", place.map(|place| place.file.as_str()))?;
    dict.set_item("line", place.and_then(|place| place.line))?;
    dict.set_item("column", place.and_then(|place| place.column))?;
    let hints: Vec<&str> = finding
        .hints
        .iter()
        .map(|hint| hint.text.as_str())
        .collect();
    dict.set_item("hints", hints)?;
    dict.set_item("path", &finding.path)?;
    dict.set_item("text", finding.to_string())?;
    Ok(dict.into_any().unbind())
}

/// The exception of an error.
pub(crate) fn raised(py: Python<'_>, error: &Error) -> PyErr {
    with_findings(py, error.to_string(), error.diagnostics())
}

/// The exception of a scene that is not valid.
pub(crate) fn invalid(py: Python<'_>, found: &[Diagnostic]) -> PyErr {
    let is_error = |found: &&Diagnostic| found.severity == Severity::Error;
    let first = found.iter().find(is_error).map(Diagnostic::short);
    with_findings(py, first.unwrap_or_default(), found)
}

fn with_findings(py: Python<'_>, message: String, found: &[Diagnostic]) -> PyErr {
    let findings = found.iter().map(|finding| told(py, finding));
    let raised = SceneError::new_err(message);
    let set = findings
        .collect::<PyResult<Vec<_>>>()
        .and_then(|findings| raised.value(py).setattr("_findings", findings));
    match set {
        Ok(()) => raised,
        Err(other) => other,
    }
}
