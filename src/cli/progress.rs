//! The bar of a long render on a terminal, and the clock.

use crate::render::Counts;
use indicatif::{HumanCount, HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

/// Times a render and shows how far it is.
pub(super) struct Progress;
