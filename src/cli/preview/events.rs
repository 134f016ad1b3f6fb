//! Server-sent events for the page: the state, each time it has changed. The number of subscribers
//! is limited; a new one replaces the oldest, which gets a last event. No thread wakes up while
//! nothing changes.

use super::preview_state::PreviewState;
use serde_json::Value;
use std::sync::Arc;

/// The most streams of events at a time: a browser opens six connections to a server, and some must
/// be left for pictures.
pub(super) const MOST: usize = 4;

/// The last event of a replaced subscriber.
const GIVES_WAY: &str = "event: full\ndata:\n\n";

/// A stream of events, which ends when it is dropped.
pub(super) struct Subscriber {
    preview_state: Arc<PreviewState>,
    number: u64,
    /// The last version sent.
    since: Option<u64>,
    is_ended: bool,
}

/// The next item of a stream of events.
pub(super) enum EventStreamItem {
    /// The state, and its version.
    Color(u64, Value),
    /// The subscriber was replaced.
    GaveWay,
    /// There will be no more.
    Ended,
}

impl Subscriber {
    /// A new stream.
    pub(super) fn new(preview_state: &Arc<PreviewState>) -> Self {
        Self {
            number: preview_state.admit(),
            preview_state: Arc::clone(preview_state),
            since: None,
            is_ended: false,
        }
    }
}

impl Iterator for Subscriber {
    type Item = String;

    /// Waits for the next event.
    fn next(&mut self) -> Option<String> {
        if self.is_ended {
            return None;
        }
        match self.preview_state.wait(self.number, self.since) {
            EventStreamItem::Color(version, reported) => {
                self.since = Some(version);
                Some(format!("data: {reported}\n\n"))
            }
            EventStreamItem::GaveWay => {
                self.is_ended = true;
                Some(GIVES_WAY.to_owned())
            }
            EventStreamItem::Ended => None,
        }
    }
}

impl Drop for Subscriber {
    fn drop(&mut self) {
        self.preview_state.dismiss(self.number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_stream_gives_way_and_a_place_that_is_left_is_free() {
        let preview_state = Arc::new(PreviewState::default());
        let mut streams: Vec<_> = (0..MOST).map(|_| Subscriber::new(&preview_state)).collect();
        drop(streams.pop());
        streams.push(Subscriber::new(&preview_state));
        for stream in &mut streams {
            assert!(stream.next().unwrap().starts_with("data: {"));
        }
        let mut newest = Subscriber::new(&preview_state);
        assert_eq!(streams[0].next().as_deref(), Some(GIVES_WAY));
        assert_eq!(streams[0].next(), None);
        preview_state.show(|_| ());
        for stream in streams.iter_mut().skip(1).chain([&mut newest]) {
            assert!(stream.next().unwrap().starts_with("data: {"));
        }
        preview_state.end();
        assert_eq!(newest.next(), None);
    }
}
