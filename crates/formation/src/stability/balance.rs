//! Watching a Lyapunov function while a robot runs.
//!
//! A.10, A.12 and A.18 prove V' <= 0 while what the robot goes by rests in the segment's frame and the robot does what the law says.
//! Everything else is an input (chapter 8), and V may grow by what the inputs bring in, and by no more:
//!
//! V(t) <= V(t0) + integral of max(0, V' of the law + sum over the inputs of max(0, power)) + what cannot be measured.
//!
//! [`Balance`] judges that over a sliding window.
use std::collections::VecDeque;

/// Where what is in V may come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Input {
    /// The law itself: what it takes out makes up for what the others bring in at the same time, not for more.
    Law,
    /// The leader: Psi' of its zones times its speed in the segment's frame.
    Leader,
    /// The other robots ahead.
    Robots,
    /// Obstacles.
    Obstacles,
    /// The segment's frame or the goal point: what it does otherwise than was expected.
    Frame,
    /// Limits of speed and acceleration.
    Limits,
    /// The safety filter.
    Safety,
}

impl Input {
    /// All.
    pub const ALL: [Self; 7] =
        [Self::Law, Self::Leader, Self::Robots, Self::Obstacles, Self::Frame, Self::Limits, Self::Safety];

    /// Its name, for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Law => "law",
            Self::Leader => "leader",
            Self::Robots => "robots",
            Self::Obstacles => "obstacles",
            Self::Frame => "frame",
            Self::Limits => "limits",
            Self::Safety => "safety",
        }
    }
}

/// What each input brought in, in units of V.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Supply([f64; Input::ALL.len()]);

impl Supply {
    /// Adds what `input` brought in; only the law may take out.
    pub fn add(&mut self, input: Input, amount: f64) {
        self.0[input as usize] += if input == Input::Law { amount } else { amount.max(0.0) };
    }

    /// From all inputs and the law: what is taken out is no credit for later.
    pub fn total(&self) -> f64 {
        self.0.iter().sum::<f64>().max(0.0)
    }

    /// The input that brought in most, the first of equals.
    pub fn greatest(&self) -> Input {
        let brought = |input: Input| self.0[input as usize].max(0.0);
        let more = |best: Input, other: Input| if brought(other) > brought(best) { other } else { best };
        Input::ALL.into_iter().fold(Input::Law, more)
    }

    /// The sum of both.
    #[must_use]
    pub fn with(mut self, other: &Self) -> Self {
        self.0.iter_mut().zip(other.0).for_each(|(sum, amount)| *sum += amount);
        self
    }
}

/// A moment of V.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// s, from any fixed beginning.
    pub time: f64,
    /// V.
    pub value: f64,
    /// What the inputs brought in since the moment before.
    pub supply: Supply,
    /// By how much V may be measured wrongly.
    pub uncertainty: f64,
    /// What it may grow by besides for each second, because the robot follows its commands within a tolerance only.
    pub drift: f64,
}

/// What can be said of V.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balanced {
    /// V may be at most this.
    pub bound: f64,
    /// -1, 0 or 1: how V changed over the window, 0 within what cannot be measured.
    pub sign: i8,
    /// The input that brought in most over the window.
    pub term: Input,
    /// Whether V has been within its bound, but for moments.
    pub holds: bool,
}

/// V over the last moments.
#[derive(Debug, Clone, PartialEq)]
pub struct Balance {
    window: f64,
    patience: f64,
    moments: VecDeque<Moment>,
    beyond_since: Option<f64>,
}

impl Balance {
    /// Looks back for `window` seconds. V is out of balance once it was beyond its bound for `patience` seconds.
    pub fn new(window: f64, patience: f64) -> Self {
        Self { window, patience, moments: VecDeque::new(), beyond_since: None }
    }

    /// V is another function from now on: another law, another nearest point, another leader.
    pub fn restart(&mut self) {
        self.moments.clear();
        self.beyond_since = None;
    }

    /// Takes the next moment.
    pub fn observe(&mut self, moment: Moment) -> Balanced {
        let Moment { time, value, .. } = moment;
        if self.moments.back().is_some_and(|last| last.time >= time) {
            self.restart();
        }
        self.moments.push_back(moment);
        while self.moments.get(1).is_some_and(|second| time - second.time >= self.window) {
            self.moments.pop_front();
        }
        let first = self.moments.front().copied().unwrap_or(moment);
        // What the first moment's inputs brought in is in its value already.
        let brought: f64 = self.moments.iter().skip(1).map(|moment| moment.supply.total()).sum();
        let parts = self.moments.iter().skip(1).fold(Supply::default(), |sum, moment| sum.with(&moment.supply));
        let drift: f64 = self
            .moments
            .iter()
            .zip(self.moments.iter().skip(1))
            .map(|(a, b)| a.drift.max(b.drift) * (b.time - a.time))
            .sum();
        let unsure = first.uncertainty + moment.uncertainty + drift;
        let bound = first.value + brought + unsure;
        let change = value - first.value;
        let sign = if change.abs() <= unsure {
            0
        } else if change > 0.0 {
            1
        } else {
            -1
        };
        // A value that is no number is within no bound.
        if value <= bound {
            self.beyond_since = None;
        }
        let beyond = if value <= bound { None } else { Some(*self.beyond_since.get_or_insert(time)) };
        let holds = beyond.is_none_or(|since| time - since < self.patience);
        Balanced { bound, sign, term: parts.greatest(), holds }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// V of a robot at 30 Hz, with what an input brings in a tick.
    fn run(value: impl Fn(f64) -> f64, brings: f64) -> Vec<Balanced> {
        let mut balance = Balance::new(1.0, 0.2);
        let moment = |tick: u32| {
            let mut supply = Supply::default();
            supply.add(Input::Leader, brings);
            let time = f64::from(tick) / 30.0;
            Moment { time, value: value(time), supply, uncertainty: 0.01, drift: 0.0 }
        };
        (0..90).map(|tick| balance.observe(moment(tick))).collect()
    }

    #[test]
    fn falling_is_in_balance() {
        let seen = run(|time| libm::exp(-time), 0.0);
        assert!(seen.iter().all(|one| one.holds));
        assert_eq!(seen[60].sign, -1);
        assert!((seen[60].bound - libm::exp(-1.0) - 0.02).abs() < 1e-9, "{:?}", seen[60]);
    }

    #[test]
    fn rising_needs_an_input() {
        let rises = |time: f64| 1.0 + 0.3 * time;
        let seen = run(rises, 0.0);
        assert!(seen[5].holds && !seen[20].holds && seen[60].sign == 1, "{:?}", &seen[..30]);
        let fed = run(rises, 0.01);
        assert!(fed.iter().all(|one| one.holds));
        assert_eq!(fed[60].term, Input::Leader);
    }

    /// What the law takes out while an input brings in counts, what it took out before does not.
    #[test]
    fn the_law_makes_up_for_what_comes_in_at_the_same_time() {
        let of = |law: f64, leader: f64| {
            let mut supply = Supply::default();
            supply.add(Input::Law, law);
            supply.add(Input::Leader, leader);
            (supply.total(), supply.greatest())
        };
        assert_eq!(of(-0.25, 0.75), (0.5, Input::Leader));
        assert_eq!(of(-1.0, 0.75), (0.0, Input::Leader));
        assert_eq!(of(0.5, -1.0), (0.5, Input::Law));
    }

    #[test]
    fn what_is_no_number_is_out_of_balance() {
        assert!(!run(|_| f64::NAN, 0.0)[20].holds);
    }

    #[test]
    fn noise_is_neither_rise_nor_fall() {
        let seen = run(|time| 1.0 + 0.005 * libm::sin(40.0 * time), 0.0);
        assert!(seen.iter().all(|one| one.holds && one.sign == 0));
    }

    #[test]
    fn another_function_begins_anew() {
        let mut balance = Balance::new(1.0, 0.2);
        let moment = |time, value| Moment { time, value, supply: Supply::default(), uncertainty: 0.0, drift: 0.0 };
        balance.observe(moment(0.0, 1.0));
        balance.restart();
        assert_eq!(balance.observe(moment(0.1, 9.0)).bound, 9.0);
        assert_eq!(balance.observe(moment(0.0, 5.0)).bound, 5.0, "a clock that ran back");
    }
}
