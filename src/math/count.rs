//! Counts and indices as `u32`.

/// A count or an index as `u32`, at most `u32::MAX`: budgets reject more.
#[must_use]
pub fn to_u32(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
