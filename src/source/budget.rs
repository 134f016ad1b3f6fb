//! What one run may take of the machine: a limit for each resource, charged before memory is taken
//! or work is done.
//!
//! Most limits grow with the bytes read, so that a large file may be large and a small one may not.
//! All files of a run draw on one budget, which the [`super::SourceMap`] holds.

use std::fmt::{self, Write as _};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// What a run takes of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resource {
    /// Bytes of what files become, textures aside.
    Memory,
    /// Bytes of textures, as large as their files say that they are.
    Textures,
    /// Pixels of all images decoded, and of the picture.
    Pixels,
    /// Vertices made, each as often as it is made: for every primitive, morph target and pose.
    Vertices,
    /// Surfaces placed: primitives times the instances of each.
    Surfaces,
    /// Values in the texts of scenes and assets.
    Nodes,
    /// Findings kept; further ones are counted.
    Findings,
    /// Rays of a picture.
    Rays,
}

/// One resource: its name, and the limit by default.
struct Row {
    resource: Resource,
    name: &'static str,
    base: u64,
    /// How much the limit grows for every KiB read.
    per_kib: u64,
    /// How much it grows for every KiB before that, and until which limit.
    first: (u64, u64),
    text: &'static str,
}

const MIB: u64 = 1 << 20;
/// A limit that grows alike for all that is read.
const NONE: (u64, u64) = (0, 0);

/// The limits by default, in the order of [`Resource`].
const TABLE: [Row; COUNT] = [
    Row {
        resource: Resource::Memory,
        name: "memory",
        base: 192 * MIB,
        per_kib: 32 << 10,
        first: NONE,
        text: "bytes of what files become: vertices, data decompressed, parts of the IR, the picture of an environment",
    },
    // Ordinary pictures take a byte for some hundred pixels at most, and many of them 2 GiB in all.
    Row {
        resource: Resource::Textures,
        name: "textures",
        base: 192 * MIB,
        per_kib: 32 << 10,
        first: (MIB, 2048 * MIB),
        text: "bytes of textures, as large as their files say that they are",
    },
    Row {
        resource: Resource::Pixels,
        name: "pixels",
        base: 1 << 28,
        per_kib: 0,
        first: NONE,
        text: "pixels of all images decoded, and of the picture",
    },
    Row {
        resource: Resource::Vertices,
        name: "vertices",
        base: 1 << 24,
        per_kib: 1 << 10,
        first: NONE,
        text: "vertices made, each as often as it is made: for every primitive, morph target and pose",
    },
    Row {
        resource: Resource::Surfaces,
        name: "surfaces",
        base: 1 << 20,
        per_kib: 1 << 6,
        first: NONE,
        text: "surfaces placed: primitives times the instances of each",
    },
    Row {
        resource: Resource::Nodes,
        name: "nodes",
        base: 1 << 21,
        per_kib: 1 << 10,
        first: NONE,
        text: "values in the texts of scenes and assets, those behind aliases each time",
    },
    Row {
        resource: Resource::Findings,
        name: "findings",
        base: 10_000,
        per_kib: 0,
        first: NONE,
        text: "findings kept; further ones are counted",
    },
    Row {
        resource: Resource::Rays,
        name: "rays",
        base: 1 << 32,
        per_kib: 0,
        first: NONE,
        text: "rays of a picture",
    },
];

const COUNT: usize = 8;

impl Resource {
    /// All of them, in the order of the table.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.resource)
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.row().name
    }

    fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }
}

/// How much a run may take of each resource.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// What was asked for instead of the default.
    asked: [Option<u64>; COUNT],
    /// What the default may be at most.
    most: [Option<u64>; COUNT],
}

impl Limits {
    /// No limits at all.
    pub const NONE: Self = Self {
        asked: [Some(u64::MAX); COUNT],
        most: [None; COUNT],
    };

    /// Sets one limit.
    pub fn set(&mut self, resource: Resource, limit: u64) {
        self.asked[resource as usize] = Some(limit);
    }

    /// Lowers one limit where it would be higher by default; one that is set goes before.
    pub fn lower(&mut self, resource: Resource, limit: u64) {
        let most = &mut self.most[resource as usize];
        *most = Some(most.map_or(limit, |own| own.min(limit)));
    }

    /// The limit on a resource of a run that has read so many bytes.
    #[must_use]
    pub fn of(&self, resource: Resource, read: u64) -> u64 {
        let Row {
            base,
            per_kib,
            first: (first, until),
            ..
        } = resource.row();
        let grown = |per_kib: u64| u128::from(read) * u128::from(per_kib) / 1024;
        let base = u128::from(*base);
        let begun = (base + grown(*first)).min(base.max(u128::from(*until)));
        let most = self.most[resource as usize].unwrap_or(u64::MAX);
        let all = u64::try_from(begun + grown(*per_kib))
            .unwrap_or(u64::MAX)
            .min(most);
        self.asked[resource as usize].unwrap_or(all)
    }
}

/// A limit that would have been passed; prints as the reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exceeded {
    /// What there is not enough of.
    pub resource: Resource,
    /// How much it would have been in all.
    pub total: u64,
    /// How much it may be.
    pub limit: u64,
}

impl fmt::Display for Exceeded {
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
                    Size(total),
                    resource.name(),
                    Size(limit)
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

impl Exceeded {
    /// What to do about it.
    #[must_use]
    pub fn hint(&self) -> String {
        format!(
            "`--limit {}=…` sets another limit, `--allow-huge` lifts all of them",
            self.resource.name()
        )
    }
}

/// A number of bytes as people read it.
struct Size(u64);

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            bytes @ 0..MIB => write!(f, "{bytes} bytes"),
            bytes => write!(f, "{} MiB", bytes.div_ceil(MIB)),
        }
    }
}

/// What a run has taken so far.
#[derive(Debug, Default)]
pub struct Budget {
    limits: Limits,
    read: AtomicU64,
    spent: [AtomicU64; COUNT],
}

impl Budget {
    /// A budget of which nothing is spent.
    #[must_use]
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            ..Self::default()
        }
    }

    /// Takes down that so many bytes were read; most limits grow by it.
    pub fn read(&self, bytes: usize) {
        self.read.fetch_add(bytes as u64, Relaxed);
    }

    /// Charges so much of a resource, unless that would pass its limit.
    ///
    /// # Errors
    /// If there is not so much left; then nothing is charged.
    pub fn charge(&self, resource: Resource, amount: u64) -> Result<(), Exceeded> {
        let limit = self.limit(resource);
        let spend = |spent: u64| spent.checked_add(amount).filter(|total| *total <= limit);
        let spent = self.spent[resource as usize].fetch_update(Relaxed, Relaxed, spend);
        spent.map(|_| ()).map_err(|spent| Exceeded {
            resource,
            total: spent.saturating_add(amount),
            limit,
        })
    }

    /// Whether so much of a resource is left; nothing is charged.
    ///
    /// # Errors
    /// If there is not so much left.
    pub fn has(&self, resource: Resource, amount: u64) -> Result<(), Exceeded> {
        let limit = self.limit(resource);
        let total = self.spent[resource as usize]
            .load(Relaxed)
            .saturating_add(amount);
        if total <= limit {
            Ok(())
        } else {
            Err(Exceeded {
                resource,
                total,
                limit,
            })
        }
    }

    /// How much of a resource may be taken in all, by what was read so far.
    #[must_use]
    pub fn limit(&self, resource: Resource) -> u64 {
        self.limits.of(resource, self.read.load(Relaxed))
    }

    /// How much of a resource is left.
    #[must_use]
    pub fn left(&self, resource: Resource) -> u64 {
        self.limit(resource)
            .saturating_sub(self.spent[resource as usize].load(Relaxed))
    }
}

/// `schema/limits.md`.
#[must_use]
pub fn page() -> String {
    let mut page = "\
# Limits

What one run may take, printed by `rtc schema limits`. It is charged before memory is taken, for all files of a run
together, and what is used often is charged once if it is made once. `--limit NAME=NUMBER` sets a limit (`KiB`, `MiB`
and `GiB` may follow the number), `--allow-huge` lifts all of them.

| name | limit | and for every KiB read | of what |
| --- | ---: | --- | --- |
"
    .to_owned();
    for Row {
        resource: _,
        name,
        base,
        per_kib,
        first: (first, until),
        text,
    } in TABLE
    {
        let more = match (per_kib, first) {
            (0, _) => String::new(),
            (_, 0) => per_kib.to_string(),
            _ => format!("{per_kib}, and {first} up to {until}"),
        };
        // Writing to a string does not fail.
        let _ = writeln!(page, "| `{name}` | {base} | {more} | {text} |");
    }
    page + include_str!("strangers.md")
}

#[cfg(test)]
mod tests;
