//! News for the page as server-sent events: what is shown, each time it has changed. Few follow at a
//! time; where one more comes, the one that has followed longest is told so and ends.
//! Nobody is woken while nothing changes.

use super::board::Board;
use serde_json::Value;
use std::sync::Arc;

/// The most streams of events at a time: a browser opens six connections to a server, and some must be
/// left for pictures.
pub(super) const MOST: usize = 4;

/// What a stream that gives way says last.
const GIVES_WAY: &str = "event: full\ndata:\n\n";

/// A stream of events, which ends when it is dropped.
pub(super) struct Follower {
    board: Arc<Board>,
    number: u64,
    /// The version that was told last.
    since: Option<u64>,
    is_ended: bool,
}

/// What there is for a stream of events.
pub(super) enum News {
    /// What is shown, and its version.
    Shown(u64, Value),
    /// Others took its place.
    GaveWay,
    /// There will be no more.
    Ended,
}

impl Follower {
    /// A new stream.
    pub(super) fn new(board: &Arc<Board>) -> Self {
        Self {
            number: board.admit(),
            board: Arc::clone(board),
            since: None,
            is_ended: false,
        }
    }
}

impl Iterator for Follower {
    type Item = String;

    /// Waits for the next event.
    fn next(&mut self) -> Option<String> {
        if self.is_ended {
            return None;
        }
        match self.board.wait(self.number, self.since) {
            News::Shown(version, told) => {
                self.since = Some(version);
                Some(format!("data: {told}\n\n"))
            }
            News::GaveWay => {
                self.is_ended = true;
                Some(GIVES_WAY.to_owned())
            }
            News::Ended => None,
        }
    }
}

impl Drop for Follower {
    fn drop(&mut self) {
        self.board.dismiss(self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_stream_gives_way_and_a_place_that_is_left_is_free() {
        let board = Arc::new(Board::default());
        let mut streams: Vec<_> = (0..MOST).map(|_| Follower::new(&board)).collect();
        drop(streams.pop());
        streams.push(Follower::new(&board));
        for stream in &mut streams {
            assert!(stream.next().unwrap().starts_with("data: {"));
        }
        let mut newest = Follower::new(&board);
        assert_eq!(streams[0].next().as_deref(), Some(GIVES_WAY));
        assert_eq!(streams[0].next(), None);
        board.show(|_| ());
        for stream in streams.iter_mut().skip(1).chain([&mut newest]) {
            assert!(stream.next().unwrap().starts_with("data: {"));
        }
        board.end();
        assert_eq!(newest.next(), None);
    }
}
