//! Resource limits of one run. A resource is charged before memory is allocated or work is done.
//!
//! Most limits grow with the number of bytes read, so a large file may need more than a small one.
//! All files of a run share one budget, which the [`super::SourceMap`] holds.

use std::fmt::{self, Write as _};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A resource of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resource {
    /// Bytes of decoded files, without textures.
    Memory,
    /// Bytes of textures, with the sizes that their files declare.
    Textures,
    /// Pixels of all decoded images, and of the picture.
    Pixels,
    /// Vertices generated, counted for every primitive, morph target and pose.
    Vertices,
    /// Surfaces placed: primitives times their instances.
    Surfaces,
    /// Values in the texts of scenes and assets.
    Nodes,
    /// Diagnostics that are stored; further ones are only counted.
    Findings,
    /// Rays of a picture.
    Rays,
}

/// A resource: its name and its default limit.
struct LimitRow {
    resource: Resource,
    name: &'static str,
    base: u64,
    /// The growth of the limit per KiB read.
    per_kib: u64,
    /// An additional growth per KiB, and the limit up to which it applies.
    first: (u64, u64),
    description: &'static str,
}

const MIB: u64 = 1 << 20;
/// No additional growth.
const NONE: (u64, u64) = (0, 0);

/// The default limits, in the order of [`Resource`].
const TABLE: [LimitRow; COUNT] = [
    LimitRow {
        resource: Resource::Memory,
        name: "memory",
        base: 192 * MIB,
        per_kib: 32 << 10,
        first: NONE,
        description: "bytes of what files become: vertices, data decompressed, parts of the IR, \
            the picture of an environment",
    },
    // Ordinary images need at most one byte for some hundred pixels, and many of them 2 GiB
    // together.
    LimitRow {
        resource: Resource::Textures,
        name: "textures",
        base: 192 * MIB,
        per_kib: 32 << 10,
        first: (MIB, 2048 * MIB),
        description: "bytes of textures, as large as their files say that they are",
    },
    LimitRow {
        resource: Resource::Pixels,
        name: "pixels",
        base: 1 << 28,
        per_kib: 0,
        first: NONE,
        description: "pixels of all images decoded, and of the picture",
    },
    LimitRow {
        resource: Resource::Vertices,
        name: "vertices",
        base: 1 << 24,
        per_kib: 1 << 10,
        first: NONE,
        description: "vertices made, each as often as it is made: for every primitive, morph \
            target and pose",
    },
    LimitRow {
        resource: Resource::Surfaces,
        name: "surfaces",
        base: 1 << 20,
        per_kib: 1 << 6,
        first: NONE,
        description: "surfaces: primitives times their instances",
    },
    LimitRow {
        resource: Resource::Nodes,
        name: "nodes",
        base: 1 << 21,
        per_kib: 1 << 10,
        first: NONE,
        description: "values in the texts of scenes and assets; aliases count each time",
    },
    LimitRow {
        resource: Resource::Findings,
        name: "findings",
        base: 10_000,
        per_kib: 0,
        first: NONE,
        description: "findings kept; further ones are counted",
    },
    LimitRow {
        resource: Resource::Rays,
        name: "rays",
        base: 1 << 32,
        per_kib: 0,
        first: NONE,
        description: "rays of a picture",
    },
];

const COUNT: usize = 8;

impl Resource {
    /// All resources, in the order of the table.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.resource)
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().name
    }

    fn row(self) -> &'static LimitRow {
        &TABLE[self as usize]
    }
}

/// The limit of each resource.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// The limits that override the defaults.
    set_limits: [Option<u64>; COUNT],
    /// Upper bounds of the defaults.
    max_defaults: [Option<u64>; COUNT],
}

impl Limits {
    /// No limits at all.
    pub const NONE: Self = Self {
        set_limits: [Some(u64::MAX); COUNT],
        max_defaults: [None; COUNT],
    };

    /// Sets one limit.
    pub fn set(&mut self, resource: Resource, limit: u64) {
        self.set_limits[resource as usize] = Some(limit);
    }

    /// Lowers a default limit. A limit that was set has priority.
    pub fn lower(&mut self, resource: Resource, limit: u64) {
        let max = &mut self.max_defaults[resource as usize];
        *max = Some(max.map_or(limit, |max| max.min(limit)));
    }

    /// The limit of a resource after `read` bytes were read.
    #[must_use]
    pub fn of(&self, resource: Resource, read: u64) -> u64 {
        let LimitRow {
            base,
            per_kib,
            first: (first, until),
            ..
        } = resource.row();
        let grown = |per_kib: u64| u128::from(read) * u128::from(per_kib) / 1024;
        let base = u128::from(*base);
        let first_part = (base + grown(*first)).min(base.max(u128::from(*until)));
        let max = self.max_defaults[resource as usize].unwrap_or(u64::MAX);
        let all = u64::try_from(first_part + grown(*per_kib))
            .unwrap_or(u64::MAX)
            .min(max);
        self.set_limits[resource as usize].unwrap_or(all)
    }
}

/// A limit that would be exceeded; displays as a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LimitExceeded {
    /// The resource.
    pub resource: Resource,
    /// The total amount that would be needed.
    pub total: u64,
    /// The limit.
    pub limit: u64,
}

impl fmt::Display for LimitExceeded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            resource,
            total,
            limit,
        } = *self;
        match resource {
            Resource::Memory | Resource::Textures => {
                write!(
                    f,
                    "it would take {} of {}, and the limit is {}",
                    ByteSize(total),
                    resource.name(),
                    ByteSize(limit)
                )
            }
            Resource::Pixels
            | Resource::Vertices
            | Resource::Surfaces
            | Resource::Nodes
            | Resource::Findings
            | Resource::Rays => write!(
                f,
                "it would make {total} {}, and the limit is {limit}",
                resource.name()
            ),
        }
    }
}

impl LimitExceeded {
    /// A hint on how to raise the limit.
    #[must_use]
    pub fn hint(&self) -> String {
        format!(
            "`--limit {}=…` changes the limit, `--allow-huge` removes all of them",
            self.resource.name()
        )
    }
}

/// A number of bytes, displayed with a unit.
struct ByteSize(u64);

impl fmt::Display for ByteSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            bytes @ 0..MIB => write!(f, "{bytes} bytes"),
            bytes => write!(f, "{} MiB", bytes.div_ceil(MIB)),
        }
    }
}

/// The amounts that a run has used so far.
#[derive(Debug, Default)]
pub struct Budget {
    limits: Limits,
    read: AtomicU64,
    spent: [AtomicU64; COUNT],
}

impl Budget {
    /// An unused budget.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            ..Self::default()
        }
    }

    /// Records that bytes were read; most limits grow with them.
    pub fn read(&self, bytes: usize) {
        self.read.fetch_add(bytes as u64, Relaxed);
    }

    /// Charges an amount of a resource.
    ///
    /// # Errors
    /// If that would exceed the limit; nothing is charged in this case.
    pub fn charge(&self, resource: Resource, amount: u64) -> Result<(), LimitExceeded> {
        let limit = self.limit(resource);
        let spend = |spent: u64| spent.checked_add(amount).filter(|total| *total <= limit);
        let spent = self.spent[resource as usize].fetch_update(Relaxed, Relaxed, spend);
        spent.map(|_| ()).map_err(|spent| LimitExceeded {
            resource,
            total: spent.saturating_add(amount),
            limit,
        })
    }

    /// Checks whether an amount of a resource remains, without charging it.
    ///
    /// # Errors
    /// If less remains.
    pub fn has(&self, resource: Resource, amount: u64) -> Result<(), LimitExceeded> {
        let limit = self.limit(resource);
        let total = self.spent[resource as usize]
            .load(Relaxed)
            .saturating_add(amount);
        if total <= limit {
            Ok(())
        } else {
            Err(LimitExceeded {
                resource,
                total,
                limit,
            })
        }
    }

    /// The limit of a resource after the bytes read so far.
    #[must_use]
    pub fn limit(&self, resource: Resource) -> u64 {
        self.limits.of(resource, self.read.load(Relaxed))
    }

    /// The remaining amount of a resource.
    #[must_use]
    pub fn remaining(&self, resource: Resource) -> u64 {
        self.limit(resource)
            .saturating_sub(self.spent[resource as usize].load(Relaxed))
    }
}

/// The page `schema/limits.md`.
#[must_use]
pub fn page() -> String {
    let mut page = "\
# Limits

The resource limits of a run, printed by `rtc schema limits`. Resources are charged before memory
is taken, for all files of a run together; shared ones are charged once. Limits grow with the bytes
of files, of each once, not with what these are unpacked to. `--limit NAME=NUMBER` sets a limit
(`KiB`, `MiB` and `GiB` may follow the number), `--allow-huge` removes all of them.

| name | limit | and for every KiB read | resource |
| --- | ---: | --- | --- |
"
    .to_owned();
    for LimitRow {
        resource: _,
        name,
        base,
        per_kib,
        first: (first, until),
        description,
    } in TABLE
    {
        let more = match (per_kib, first) {
            (0, _) => String::new(),
            (_, 0) => per_kib.to_string(),
            _ => format!("{per_kib}, and {first} up to {until}"),
        };
        // Writing to a string does not fail.
        let _ = writeln!(page, "| `{name}` | {base} | {more} | {description} |");
    }
    page + include_str!("untrusted.md")
}

#[cfg(test)]
mod tests;
