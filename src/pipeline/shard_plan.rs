//! Divides a picture among several renders, by tiles or by samples. The shares are disjoint and
//! together are the whole picture.

use rtc_render::{SAMPLES_OF_BLOCK, Tiles};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The division of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "camelCase")]
pub enum ShardDivision {
    /// Each share has some of the tiles, with all their samples.
    #[default]
    Tiles,
    /// Each share has some blocks of the samples of all pixels; path tracing only.
    Samples,
}

/// A range of shares of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardPlan {
    /// The division of the picture.
    pub by: ShardDivision,
    /// The first share, from 1.
    pub first: u32,
    /// The last share, at most `count`; less than the first if there are none.
    pub last: u32,
    /// The number of shares of the picture.
    pub count: u32,
}

impl ShardPlan {
    /// The tiles of the shares: those whose rank, a hash of their position, is in these of `count`
    /// equal intervals.
    #[must_use]
    pub fn tiles(&self) -> Tiles {
        Tiles::shares([self.first, self.last], self.count)
    }

    /// The index of the share, of `count`, that has the tile with this upper left pixel.
    #[must_use]
    pub fn of_tile(count: u32, [x, y]: [u32; 2]) -> u32 {
        let rank = Tiles::rank(0, [x, y].map(|at| at / Tiles::SIDE));
        // The last share whose lower bound does not exceed the rank.
        let before = ((u128::from(rank) + 1) * u128::from(count.max(1)) - 1) >> 64;
        u32::try_from(before).map_or(count, |before| before + 1)
    }

    /// The samples of the shares, of `all` samples per pixel, in whole blocks; empty if there are
    /// more shares than blocks.
    #[must_use]
    pub fn samples(&self, all: u32) -> Range<u32> {
        let blocks = u64::from(all.div_ceil(SAMPLES_OF_BLOCK));
        let border = |shares: u32| {
            let block = blocks * u64::from(shares) / u64::from(self.count.max(1));
            let sample = block * u64::from(SAMPLES_OF_BLOCK);
            u32::try_from(sample).map_or(all, |sample| sample.min(all))
        };
        border(self.first.saturating_sub(1))..border(self.last)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(by: ShardDivision, index: u32, count: u32) -> ShardPlan {
        ShardPlan {
            by,
            first: index,
            last: index,
            count,
        }
    }

    fn shares(by: ShardDivision, count: u32) -> impl Iterator<Item = ShardPlan> {
        (1..=count).map(move |index| one(by, index, count))
    }

    #[test]
    fn each_tile_is_in_one_share() {
        for count in [1, 2, 3, 7, 64, u32::MAX] {
            let last = one(ShardDivision::Tiles, count, count);
            assert_eq!(last.tiles().last, u64::MAX, "of {count}");
        }
        for count in [1, 2, 3, 7, 64] {
            let tiles: Vec<Tiles> = shares(ShardDivision::Tiles, count)
                .map(|share| share.tiles())
                .collect();
            assert_eq!(tiles[0].first, 0);
            for pair in tiles.windows(2) {
                assert_eq!(pair[0].last + 1, pair[1].first, "of {count}");
            }
        }
    }

    #[test]
    fn a_tile_knows_its_share() {
        for count in [1, 2, 7, 64, 1000] {
            for tile in (0..20).flat_map(|x| (0..20).map(move |y| [16 * x, 16 * y])) {
                let index = ShardPlan::of_tile(count, tile);
                let share = one(ShardDivision::Tiles, index, count);
                assert!((1..=count).contains(&index) && share.tiles().contain(tile));
            }
        }
    }

    #[test]
    fn each_block_of_samples_is_in_one_share() {
        for (all, count) in [(64, 1), (64, 4), (100, 7), (16, 64), (1, 2), (u32::MAX, 3)] {
            let samples = shares(ShardDivision::Samples, count).map(|share| share.samples(all));
            let end = samples.fold(0, |end, samples| {
                assert_eq!(samples.start, end, "of {count}");
                assert!(samples.end == all || samples.end.is_multiple_of(16));
                samples.end
            });
            assert_eq!(end, all);
        }
    }
}
