//! The long texts of codes and rules.

/// The long text of a code of diagnostics such as `VA002`, with an example and its fix, or of a
/// rule that an [`Effect`](super::Effect) names; `None` if there is none.
///
/// ```
/// let text = rtc::explain("VA002").unwrap();
/// assert!(text.starts_with("## VA002 (error)"));
/// assert_eq!(rtc::explain("VA000"), None);
/// ```
#[must_use]
pub fn explain(code: &str) -> Option<String> {
    rtc_pipeline::explanation(code)
}
