//! Limits and charges.

use super::*;

#[test]
fn the_table_is_in_the_order_of_the_resources() {
    assert!(
        TABLE
            .iter()
            .enumerate()
            .all(|(index, row)| row.resource as usize == index)
    );
}

#[test]
fn what_is_charged_is_within_the_limit_and_nothing_is_charged_beyond_it() {
    let budget = Budget::default();
    assert_eq!(budget.charge(Resource::Surfaces, 1 << 20), Ok(()));
    let exceeded = budget.charge(Resource::Surfaces, 64).unwrap_err();
    assert_eq!((exceeded.total, exceeded.limit), ((1 << 20) + 64, 1 << 20));
    budget.read(1024);
    assert_eq!(
        (
            budget.charge(Resource::Surfaces, 64),
            budget.remaining(Resource::Surfaces)
        ),
        (Ok(()), 0)
    );
    assert!(
        Budget::new(Limits::NONE)
            .charge(Resource::Memory, u64::MAX)
            .is_ok()
    );
}

#[test]
fn what_is_lowered_is_never_raised_but_by_what_is_set() {
    let mut limits = Limits::default();
    limits.lower(Resource::Nodes, u64::MAX);
    assert_eq!(limits.of(Resource::Nodes, 0), 1 << 21);
    limits.lower(Resource::Nodes, 5);
    limits.lower(Resource::Nodes, 7);
    assert_eq!(limits.of(Resource::Nodes, 1 << 30), 5);
    limits.set(Resource::Nodes, 9);
    assert_eq!(limits.of(Resource::Nodes, 0), 9);
}

#[test]
fn textures_may_take_two_gib_if_their_files_are_no_smaller_than_such_files_are() {
    let limit = |read| Limits::default().of(Resource::Textures, read);
    assert_eq!(limit(1024), 193 * MIB + (32 << 10));
    // Eight JPEGs of 4096 × 4096 in 4.7 MB.
    assert!(limit(4_700_000) >= 2048 * MIB);
    assert_eq!(limit(1 << 30), 2048 * MIB + (32 << 30));
}

#[test]
fn a_limit_asked_for_counts_whatever_is_read() {
    let mut limits = Limits::default();
    limits.set(Resource::Memory, 1 << 21);
    let budget = Budget::new(limits);
    budget.read(1 << 20);
    let exceeded = budget
        .charge(Resource::Memory, (2 << 20) + 1)
        .unwrap_err()
        .to_string();
    assert_eq!(
        exceeded,
        "it would take 3 MiB of memory, and the limit is 2 MiB"
    );
}
