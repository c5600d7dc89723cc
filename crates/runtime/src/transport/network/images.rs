//! Which messages of a writer take the images' way.

use super::Lane;
use std::io;
use trench_core::{Durability, Qos, Reliability};

/// Messages from this length on, bytes, of topics of which some may be lost, let pass whatever else wants to go.
const IMAGE: usize = 8_000;

/// The way of a writer's images, once there are some; all that follows on their topic goes the same way, so that the order stays.
pub(crate) struct ImageWay<M> {
    qos: Qos,
    /// bit/s.
    rate: f64,
    state: State<M>,
}

enum State<M> {
    /// No image has come yet.
    Unused,
    Open(Lane<M>),
    /// The system has no socket or no thread for it: images go with everything else.
    Closed,
}

impl<M: Send + 'static> ImageWay<M> {
    /// For a topic of this quality.
    pub(crate) fn new(qos: Qos) -> Self {
        Self { qos, rate: f64::INFINITY, state: State::Unused }
    }

    /// Images may take so many bit/s; to be said before there are some.
    pub(crate) fn limit(&mut self, rate: f64) {
        self.rate = rate;
    }

    /// The lane of a message of so many bytes, if it takes this way; `open` makes it for a rate, bit/s.
    pub(crate) fn of(&mut self, length: usize, open: impl FnOnce(f64) -> io::Result<Lane<M>>) -> Option<&Lane<M>> {
        if matches!(self.state, State::Unused) && is_image(self.qos, length) {
            self.state = open(self.rate).map_or(State::Closed, State::Open);
        }
        if let State::Open(lane) = &self.state { Some(lane) } else { None }
    }
}

fn is_image(qos: Qos, length: usize) -> bool {
    qos.reliability == Reliability::BestEffort && qos.durability == Durability::Volatile && length >= IMAGE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_opens_the_way_and_all_that_follows_takes_it() {
        let check = |qos: Qos, lengths: &[usize], expected: &[bool]| {
            let mut way = ImageWay::<()>::new(qos);
            way.limit(1e6);
            let takes = lengths.iter().map(|length| {
                way.of(*length, |rate| {
                    assert_eq!(rate, 1e6);
                    Lane::open(drop)
                })
                .is_some()
            });
            assert_eq!(takes.collect::<Vec<_>>(), expected);
        };
        check(Qos::SENSOR, &[7_999, 8_000, 10], &[false, true, true]);
        check(Qos::RELIABLE, &[1_000_000], &[false]);
        check(Qos { reliability: Reliability::BestEffort, ..Qos::LATCHED }, &[1_000_000], &[false]);
        let mut way = ImageWay::<()>::new(Qos::SENSOR);
        assert!(way.of(8_000, |_| Err(io::ErrorKind::Other.into())).is_none());
    }
}
