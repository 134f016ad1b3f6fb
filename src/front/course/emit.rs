//! The IR back to text.

use crate::ir::Scene;

/// Writes the scene in the canonical spelling with a `Camera`.
///
/// # Errors
/// The reason, in words, why the scene can't be said in this format.
pub fn emit(_scene: &Scene) -> Result<String, String> {
    Err("not yet".to_owned())
}

/// Three numbers as a flow list.
pub(super) fn triple([x, y, z]: [f64; 3]) -> String {
    format!("[{}, {}, {}]", number(x), number(y), number(z))
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    let plain = format!("{value}");
    let scientific = format!("{value:e}");
    if plain.len() <= scientific.len() + 4 { plain } else { scientific }
}
