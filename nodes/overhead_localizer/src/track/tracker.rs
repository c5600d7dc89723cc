//! The team: every robot's identity, status and filter from frame to frame.

use super::filter::{Filter, Motion, State};
use super::identity::Hypotheses;
use super::one_disc;
use super::pairing::{self, MapDisc, Pair};
use super::recall;
use super::settings::{Names, Settings};
use super::strangers::{self, Strangers};
use super::turns::{self, Turn, Turns};
use crate::noise::Gaussian;
use nalgebra::{Matrix3, Vector3};
use trench_optics::Pose2;

/// What is known of a robot in the present frame; numbers as in trench_msgs/RobotState.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Status {
    /// Not seen for longer than the hold time, or never.
    Lost = 0,
    /// Seen in this frame.
    Tracked = 1,
    /// Not seen in this frame, carried forward.
    Predicted = 2,
    /// Which robot it is, is in doubt.
    Ambiguous = 3,
}

/// One robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// Its name.
    pub name: String,
    /// What is known of it in the present frame.
    pub status: Status,
    /// Its estimate; None until it is first placed.
    pub filter: Option<Filter>,
    /// Since it was last seen, s; infinite if it never was.
    pub unseen: f64,
    pub(super) in_doubt: bool,
    /// Whether it was seen in the previous frame.
    pub(super) was_seen: bool,
    /// Whether one of its discs was seen in the last frame, and not the other.
    pub(super) half_seen: bool,
    /// Whether its pad's code was read in this frame.
    pub(super) code_read: bool,
}

/// A pad as another vision system has found it: where, and the robot (its place among the tracks) if its code was read.
pub type NamedPose = (Pose2, Option<usize>);

/// Follows all robots of a team.
#[derive(Debug, Clone)]
pub struct Tracker {
    settings: Settings,
    pub(super) tracks: Vec<Track>,
    /// What a former life knew, until the first pad is seen.
    pub(super) remembered: Option<Vec<Track>>,
    pub(super) measurement: Matrix3<f64>,
    strangers: Strangers,
    turns: Turns,
    turn: Option<Turn>,
    unnamed: Vec<[f64; 2]>,
    noise: Gaussian,
}

/// How well a given start pose is known, m, m, rad: robots are put there by hand.
const START_SIGMA: [f64; 3] = [0.06, 0.06, 0.3];
/// Innovations beyond this squared distance (3 degrees of freedom, one in a million) are no noise: the robot starts, stops
/// or is pushed. Then it may move so many times more freely; if even that does not explain it, it was lifted, and what was
/// known of its speed is void.
const PUSHED: f64 = 31.0;
const FREER: f64 = 10.0;

impl Tracker {
    /// A tracker that has seen nothing yet; `seed` is for the noise of [`Settings::added_sigma`].
    #[must_use]
    pub fn new(settings: Settings, seed: u64) -> Self {
        let measurement = measurement(&settings);
        let mut tracker = Self {
            tracks: Vec::new(),
            remembered: None,
            measurement,
            strangers: Strangers::default(),
            turns: Turns::default(),
            turn: None,
            unnamed: Vec::new(),
            noise: Gaussian::new(seed),
            settings,
        };
        tracker.reset();
        tracker
    }

    /// Forgets all identities: they are found anew from the start poses or by order.
    pub fn reset(&mut self) {
        self.strangers = Strangers::default();
        self.turn = None;
        self.turns.encourage();
        self.remembered = None;
        let unplaced = |robot: &super::settings::Robot| Track {
            name: robot.name.clone(),
            status: Status::Lost,
            filter: robot.start.map(|pose| Filter::new(pose, START_SIGMA)),
            unseen: f64::INFINITY,
            in_doubt: false,
            was_seen: false,
            half_seen: false,
            code_read: false,
        };
        self.tracks = self.settings.robots.iter().map(unplaced).collect();
    }

    /// Takes other settings for the same robots.
    pub fn tune(&mut self, settings: Settings) {
        self.measurement = measurement(&settings);
        self.settings = settings;
    }

    /// All robots, ordered as in the settings.
    #[must_use]
    pub fn tracks(&self) -> &[Track] {
        &self.tracks
    }

    /// Places (m) of pads of the present frame that are no robot's yet: of one that was carried there, before it is known which, or
    /// of one that is not of the team.
    #[must_use]
    pub fn unnamed(&self) -> &[[f64; 2]] {
        &self.unnamed
    }

    /// What is asked of whom, to find out which robot it is; good for the present frame.
    #[must_use]
    pub fn turn(&self) -> Option<Turn> {
        self.turn
    }

    /// From an exposure to the wheels that obey what it led to, s, by the turns seen so far, and their number.
    #[must_use]
    pub fn delay(&self) -> Option<(f64, usize)> {
        self.turns.delay()
    }

    /// The map has changed below the robots, as `moved` says: they are where they were seen, and keep their names. Where it
    /// says nothing the robot is looked for in the old place.
    pub fn remap(&mut self, moved: impl Fn(Pose2) -> Option<Pose2>) {
        for filter in self.tracks.iter_mut().filter_map(|track| track.filter.as_mut()) {
            if let Some(pose) = moved(filter.state().pose) {
                filter.place(pose);
            }
        }
    }

    /// Puts all names in doubt.
    pub fn doubt(&mut self) {
        self.tracks.iter_mut().for_each(|track| track.in_doubt = track.filter.is_some());
        self.turns.encourage();
    }

    /// Gives names to the pads nearest to places (m); other names keep their pads, or become doubtful where those are given
    /// away.
    ///
    /// # Errors
    /// With the reason, and nothing has changed.
    pub fn name(&mut self, names: &[(String, [f64; 2])]) -> Result<(), String> {
        let mut tracks = self.tracks.clone();
        let mut taken = Vec::new();
        for (name, [x, y]) in names {
            let distance = |pad: &usize| {
                let place = tracks[*pad].filter.as_ref().map(|filter| filter.state().pose).unwrap_or_default();
                libm::hypot(place.x - x, place.y - y)
            };
            let seen = (0..tracks.len()).filter(|pad| tracks[*pad].unseen == 0.0);
            let nearest = seen.min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let pad = nearest.filter(|pad| distance(pad) < self.settings.pad.body_diameter);
            let pad = pad.ok_or_else(|| format!("no pad is seen at ({x}, {y})"))?;
            let robot = tracks.iter().position(|track| track.name == *name);
            let robot = robot.ok_or_else(|| format!("no robot of the team is called {name}"))?;
            if taken.contains(&robot) || taken.contains(&pad) {
                return Err(format!("{name} is named twice, or its pad is"));
            }
            turns::give(&mut tracks, robot, pad, self.settings.hold);
            taken.push(robot);
        }
        self.tracks = tracks;
        Ok(())
    }

    /// Takes the discs of a frame exposed `dt` (s) after the previous one; gives the number of pads seen.
    pub fn step(&mut self, dt: f64, discs: &[MapDisc]) -> usize {
        self.choose(discs);
        for track in &mut self.tracks {
            track.advance(dt, &self.settings);
        }
        let pairs = self.pairs(discs);
        let matched = self.matched(&pairs);
        let sigma = self.settings.disc_sigma;
        one_disc::correct(&mut self.tracks, &matched, &pairs, discs, &self.settings.pad, sigma);
        self.close(dt, &pairs, &matched);
        pairs.len()
    }

    /// Takes the pads that another vision system has found in a frame exposed `dt` (s) after the previous one.
    pub fn step_pads(&mut self, dt: f64, pads: &[NamedPose]) {
        for track in &mut self.tracks {
            track.advance(dt, &self.settings);
            (track.half_seen, track.code_read) = (false, false);
        }
        let mut without_code = Vec::new();
        for (pose, robot) in pads {
            let pair = Pair { pose: *pose, gain: 0.0 };
            match robot.and_then(|robot| self.tracks.get_mut(robot)) {
                Some(track) => {
                    track.see(&pair, &self.measurement, &self.settings);
                    (track.in_doubt, track.code_read) = (false, true);
                }
                None => without_code.push(pair),
            }
        }
        let matched = self.matched(&without_code);
        self.close(dt, &without_code, &matched);
    }

    /// For each robot that was not seen yet its pad among `pairs`, which it takes.
    fn matched(&mut self, pairs: &[Pair]) -> Vec<Option<usize>> {
        let hypotheses = Hypotheses::new(&self.tracks, pairs, &self.measurement);
        let matched = hypotheses.best();
        let doubtful = hypotheses.doubtful(&matched);
        for (index, pair) in matched.iter().enumerate() {
            if let Some(pair) = pair {
                self.tracks[index].see(&pairs[*pair], &self.measurement, &self.settings);
                self.tracks[index].in_doubt |= doubtful[index];
            }
        }
        matched
    }

    /// Ends a frame: strangers, turns, statuses.
    fn close(&mut self, dt: f64, pairs: &[Pair], matched: &[Option<usize>]) {
        let unmatched: Vec<Pair> =
            (0..pairs.len()).filter(|index| !matched.contains(&Some(*index))).map(|index| pairs[index]).collect();
        self.strangers.place(&mut self.tracks, &unmatched, &self.settings, &self.measurement);
        self.resolve(unmatched.is_empty());
        if self.settings.names == Names::Turns {
            let Self { turns, tracks, settings, measurement, .. } = self;
            self.turn = turns.step(dt, tracks, &unmatched, settings.hold, measurement);
            self.resolve(unmatched.is_empty());
        }
        self.unnamed = strangers::unnamed(&self.tracks, &unmatched, 0.5 * self.settings.pad.body_diameter);
        self.settle();
    }

    /// The pads of a frame as they are seen.
    pub(super) fn seen(&self, discs: &[MapDisc]) -> Vec<Pair> {
        let support = |pose| {
            let fits = self.tracks.iter().filter_map(|track| track.fit(pose, &self.measurement));
            fits.fold(0.0_f64, f64::max)
        };
        let mut pairs = pairing::pair(discs, &self.settings.pad, self.settings.spacing_tolerance, support);
        // A fixed order, so that equal frames get equal noise whatever order their discs came in.
        pairs.sort_by(|a, b| a.pose.x.total_cmp(&b.pose.x).then(a.pose.y.total_cmp(&b.pose.y)));
        pairs
    }

    /// The pads of a frame, with the noise that the settings ask for.
    fn pairs(&mut self, discs: &[MapDisc]) -> Vec<Pair> {
        let mut pairs = self.seen(discs);
        if self.settings.added_sigma.iter().any(|sigma| *sigma > 0.0) {
            let [sigma_x, sigma_y, sigma_theta] = self.settings.added_sigma;
            for Pair { pose, .. } in &mut pairs {
                pose.x += sigma_x * self.noise.next();
                pose.y += sigma_y * self.noise.next();
                pose.theta = super::filter::wrap(pose.theta + sigma_theta * self.noise.next());
            }
        }
        pairs
    }

    /// Ends the last doubt: when all are seen, and no pad besides, a single robot cannot be another.
    fn resolve(&mut self, no_strangers: bool) {
        let all_seen = no_strangers && self.tracks.iter().all(|track| track.unseen == 0.0);
        if all_seen && self.tracks.iter().filter(|track| track.in_doubt).count() == 1 {
            for track in &mut self.tracks {
                track.in_doubt = false;
            }
        }
    }

    /// Gives every robot its status.
    fn settle(&mut self) {
        for track in &mut self.tracks {
            track.status = match track {
                _ if track.is_missing(self.settings.hold) => Status::Lost,
                _ if track.in_doubt => Status::Ambiguous,
                _ if track.unseen > 0.0 => Status::Predicted,
                _ => Status::Tracked,
            };
        }
    }
}

/// The covariance of a measured pose: two discs, each off by the same in any direction, and the noise added.
fn measurement(settings: &Settings) -> Matrix3<f64> {
    let of_disc = settings.disc_sigma;
    let of_pose = [
        of_disc * std::f64::consts::FRAC_1_SQRT_2,
        of_disc * std::f64::consts::FRAC_1_SQRT_2,
        of_disc * std::f64::consts::SQRT_2 / settings.pad.disc_spacing,
    ];
    let added = settings.added_sigma.map(|sigma| sigma * sigma);
    let variance = |axis: usize| of_pose[axis] * of_pose[axis] + added[axis];
    Matrix3::from_diagonal(&Vector3::new(variance(0), variance(1), variance(2)))
}

impl Track {
    /// Carries the estimate over `dt` (s): in motion while held, at rest afterwards. Where no frame came for so long that all
    /// robots have stopped, those seen last stand where they stopped, unless somebody moved them.
    fn advance(&mut self, dt: f64, settings: &Settings) {
        self.was_seen = self.unseen == 0.0;
        let Some(filter) = &mut self.filter else { return };
        if self.unseen == f64::INFINITY {
            return;
        }
        if self.was_seen && dt > recall::STOPPING {
            let State { pose, v, omega, .. } = *filter.state();
            *filter = recall::expected(pose, [v, omega], dt, 0.0);
            self.unseen = dt;
            return;
        }
        let moving = if self.half_seen { dt } else { dt.min((settings.hold - self.unseen).max(0.0)) };
        if moving > 0.0 {
            filter.predict(moving, &settings.motion);
        }
        if dt > moving {
            filter.rest(dt - moving);
        }
        self.unseen += dt;
    }

    /// Whether nobody knows where it is: unseen for longer than `hold` (s), and not kept by one of its discs.
    pub(super) fn is_missing(&self, hold: f64) -> bool {
        self.unseen > hold && !(self.half_seen && self.unseen <= one_disc::LONGEST)
    }

    /// Takes a pad as this robot's.
    fn see(&mut self, pair: &Pair, measurement: &Matrix3<f64>, settings: &Settings) {
        let elapsed = self.unseen.min(settings.hold);
        self.unseen = 0.0;
        let Some(filter) = &mut self.filter else { return self.put(pair, measurement) };
        if filter.distance2(pair.pose, measurement) > PUSHED {
            let Motion { acceleration, turning, slip } = settings.motion;
            let freer = Motion { acceleration: FREER * acceleration, turning: FREER * turning, slip: FREER * slip };
            filter.disturb(elapsed, filter.state().pose.theta, &freer);
        }
        if filter.distance2(pair.pose, measurement) > PUSHED {
            return self.put(pair, measurement);
        }
        filter.update(pair.pose, measurement);
    }

    /// Starts the estimate anew at a pad.
    pub(super) fn put(&mut self, pair: &Pair, measurement: &Matrix3<f64>) {
        self.unseen = 0.0;
        let sigma = [0, 1, 2].map(|axis| libm::sqrt(measurement[(axis, axis)]));
        self.filter = Some(Filter::new(pair.pose, sigma));
    }
}
