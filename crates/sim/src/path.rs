//! Scripted motions: an obstacle goes from place to place at constant speed.

/// What happens at the last place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ending {
    /// It stays there.
    #[default]
    Stay,
    /// It goes back the way it came, and so on.
    Back,
    /// It goes straight to where it began, and round again.
    Round,
}

/// A way with whoever goes it.
#[derive(Debug, Clone, PartialEq)]
pub struct Path {
    /// The beginning and all places, m from the beginning.
    places: Vec<[f64; 2]>,
    /// m/s
    speed: f64,
    ending: Ending,
    /// Until it goes, s.
    wait: f64,
    offset: [f64; 2],
    /// Index of the place it makes for; none once it stays.
    next: Option<usize>,
    backwards: bool,
}

impl Path {
    /// Through `places` (m from the beginning) at `speed` (m/s), after `wait` seconds.
    #[must_use]
    pub fn new(places: &[[f64; 2]], speed: f64, ending: Ending, wait: f64) -> Self {
        let places: Vec<[f64; 2]> = [[0.0; 2]].into_iter().chain(places.iter().copied()).collect();
        let next = (places.len() > 1).then_some(1);
        Self { places, speed, ending, wait, offset: [0.0; 2], next, backwards: false }
    }

    /// All places in their order, m from the beginning: it goes straight from one to the next, and never elsewhere.
    #[must_use]
    pub fn places(&self) -> Vec<[f64; 2]> {
        let back = (self.ending == Ending::Round).then_some([0.0; 2]);
        self.places.iter().copied().chain(back).collect()
    }

    /// Goes on for `dt` seconds; gives how far it went, m, and how fast it goes, m/s.
    pub(crate) fn advance(&mut self, dt: f64) -> ([f64; 2], [f64; 2]) {
        if self.wait > 0.0 {
            self.wait -= dt;
            return ([0.0; 2], [0.0; 2]);
        }
        let before = self.offset;
        let (mut left, mut velocity) = (self.speed * dt, [0.0; 2]);
        // More places than there are cannot lie within one step, but for places that lie on each other.
        for _ in 0..=self.places.len() {
            let Some(place) = self.next.and_then(|next| self.places.get(next)).copied() else { break };
            let way = [place[0] - self.offset[0], place[1] - self.offset[1]];
            let distance = (way[0] * way[0] + way[1] * way[1]).sqrt();
            if distance > left {
                let direction = [way[0] / distance, way[1] / distance];
                self.offset = [self.offset[0] + left * direction[0], self.offset[1] + left * direction[1]];
                velocity = [self.speed * direction[0], self.speed * direction[1]];
                break;
            }
            self.offset = place;
            left -= distance;
            self.turn();
        }
        ([self.offset[0] - before[0], self.offset[1] - before[1]], velocity)
    }

    /// Chooses the place after the one that is reached.
    fn turn(&mut self) {
        let (Some(reached), last) = (self.next, self.places.len() - 1) else { return };
        if reached == 0 {
            self.backwards = false;
        }
        self.next = match self.ending {
            _ if self.backwards => Some(reached - 1),
            _ if reached < last => Some(reached + 1),
            Ending::Stay => None,
            Ending::Round => Some(0),
            Ending::Back => {
                self.backwards = true;
                Some(reached - 1)
            }
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where it is after each second, 1 ms a step.
    fn check(ending: Ending, wait: f64, expected: &[[f64; 2]]) {
        let mut path = Path::new(&[[2.0, 0.0], [2.0, 1.0]], 1.0, ending, wait);
        let mut place = [0.0; 2];
        for (second, expected) in expected.iter().enumerate() {
            for _ in 0..1000 {
                let (step, velocity) = path.advance(1e-3);
                place = [place[0] + step[0], place[1] + step[1]];
                let speed = velocity[0].hypot(velocity[1]);
                assert!(speed.abs() < 1e-9 || (speed - 1.0).abs() < 1e-9, "{velocity:?}");
            }
            let error = (place[0] - expected[0]).hypot(place[1] - expected[1]);
            assert!(error < 3e-3, "{ending:?} after {} s: {place:?}", second + 1);
        }
    }

    #[test]
    fn goes_through_all_places_and_ends_as_told() {
        let out = [[1.0, 0.0], [2.0, 0.0], [2.0, 1.0]];
        check(Ending::Stay, 0.0, &[&out[..], &[[2.0, 1.0], [2.0, 1.0]]].concat());
        check(Ending::Back, 0.0, &[&out[..], &[[2.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]].concat());
        let half = 2.0 / 5.0_f64.sqrt();
        check(Ending::Round, 0.0, &[&out[..], &[[2.0 - half, 1.0 - 0.5 * half]]].concat());
        check(Ending::Stay, 2.0, &[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]]);
    }

    #[test]
    fn places_that_lie_on_each_other_do_not_hang_it() {
        for ending in [Ending::Stay, Ending::Back, Ending::Round] {
            let mut path = Path::new(&[[0.0; 2], [0.0; 2]], 1.0, ending, 0.0);
            assert_eq!(path.advance(1.0), ([0.0; 2], [0.0; 2]));
        }
        assert_eq!(Path::new(&[], 1.0, Ending::Back, 0.0).advance(1.0), ([0.0; 2], [0.0; 2]));
    }
}
