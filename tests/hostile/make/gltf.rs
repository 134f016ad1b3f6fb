//! Assets that are small and ask for much.

use super::Repro;

/// All of them.
pub(crate) fn all() -> Vec<Repro> {
    Vec::new()
}
