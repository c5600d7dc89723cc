//! Several robots at once, in the lanes of vector instructions, while nothing but their leaders is near them: of thousands, most.
use super::attract::Tie;
use super::surroundings::Moment;
use super::{Agent, AgentSettings, Method};
use crate::Vector2;
use crate::curve::Curve;
use crate::kinematics::PointState;
use crate::lanes::{LANES, Lanes, Plane, Vectors};
use crate::laws::{Push, Seen, Steered, Terms, Unpushed};
use crate::seek::LeaderRule;
use crate::trench::Trench;

/// What robots side by side see.
pub(crate) struct Side<'a> {
    /// Time of the tick, s.
    pub(crate) time: f64,
    pub(crate) moment: &'a Moment<'a>,
    /// Their leaders at the tick, and the distances of these from what draws them, m.
    pub(crate) leaders: [PointState; LANES],
    pub(crate) deviations: [f64; LANES],
    /// Whether a robot has a leader, and no robot ahead or obstacle acts on it besides.
    pub(crate) alone: [bool; LANES],
}

/// What robots side by side do, in the lanes that `told` is set in: bit for bit what [`Agent::act_at`] says.
pub(crate) struct Abreast<L> {
    told: u32,
    steered: Vectors<L>,
    lyapunov: L,
    lyapunov_rate: L,
    power: L,
    applied: Vectors<L>,
    cut: u32,
    foot: Vectors<L>,
    deviation: L,
}

impl<L: Lanes> Abreast<L> {
    /// Whether it tells what the robot in a lane does.
    #[inline(always)]
    pub(crate) fn tells(&self, lane: usize) -> bool {
        self.told & (1 << lane) != 0
    }

    /// What the leader brings into the Lyapunov function, m^2/s^3.
    #[inline(always)]
    pub(crate) fn power(&self, lane: usize) -> f64 {
        self.power.to_array()[lane]
    }

    /// What the law says.
    #[inline(always)]
    pub(crate) fn steered(&self, lane: usize) -> Steered {
        Steered {
            acceleration: self.steered.to_array()[lane],
            lyapunov: self.lyapunov.to_array()[lane],
            lyapunov_rate: self.lyapunov_rate.to_array()[lane],
        }
    }

    /// What limits leave of it, m/s^2, and whether they cut.
    #[inline(always)]
    pub(crate) fn applied(&self, lane: usize) -> (Vector2<f64>, bool) {
        (self.applied.to_array()[lane], self.cut & (1 << lane) != 0)
    }

    /// The nearest point, which draws the robot, and its distance, m.
    #[inline(always)]
    pub(crate) fn drawn(&self, lane: usize) -> (Vector2<f64>, f64) {
        (self.foot.to_array()[lane], self.deviation.to_array()[lane])
    }
}

impl<T: Trench> Agent<T> {
    /// Lets what the robot will be told of the segment come nearer to the processor.
    #[inline]
    pub(crate) fn call_for(&self, curve: &Curve) {
        curve.call_for(self.seeker.warm());
    }

    /// [`Self::act_at`] for a step of `step` (s), for robots under the same settings of which it is quickly told; none if there are none.
    #[inline(always)]
    pub(crate) fn act_abreast<L: Lanes>(
        settings: &AgentSettings<T>,
        agents: &mut [Self; LANES],
        robots: &[PointState; LANES],
        side: &Side<'_>,
        step: f64,
    ) -> Option<Abreast<L>> {
        let Moment { since, segment, motion } = side.moment;
        let plain = settings.method == Method::Nearest
            && settings.remedies.is_none()
            && !settings.encroaching.tells_places()
            && (motion.turn_rate, motion.turn_acceleration) == (0.0, 0.0);
        if !plain || side.alone == [false; LANES] {
            return None;
        }
        let (position, velocity) =
            (Vectors::<L>::of(robots.map(|robot| robot.position)), Vectors::of(robots.map(|robot| robot.velocity)));
        let feet = segment.nearest_abreast(position, agents.each_ref().map(|agent| agent.seeker.warm()))?;
        let seeking = &settings.seeking;
        let keeps = core::array::from_fn(|lane| {
            side.alone[lane]
                && agents[lane].tie == Tie::Whole
                && agents[lane].seeker.keeps(seeking, &agents[lane].fragments, feet.arc_length[lane])
        });
        let mut told = feet.known & L::mask(keeps);
        // Zones.
        let (radii, splat) = (settings.zoning.radii(), L::splat);
        let leader = Vectors::of(side.leaders.map(|leader| leader.coasted(*since).position));
        let leader_velocity = Vectors::of(side.leaders.map(|leader| leader.velocity));
        let apart = (leader - position).norm();
        let (inner, outer) = (splat(radii.rho_hat).is_at_most(apart), apart.is_at_most(splat(radii.rho)));
        if seeking.leader_rule == LeaderRule::WholeSegmentWhileFar {
            told = told & outer;
        }
        let under_way = splat(seeking.settled_distance).is_below(L::new(side.deviations));
        told = told & (under_way | (leader - feet.point).norm().is_below(splat(radii.rho_check)));
        // The law.
        let still = Vectors::splat(motion.origin.velocity);
        let frame = Vectors::splat(motion.origin.acceleration);
        let Unpushed { acceleration, trench, mut lyapunov, lyapunov_rate } = settings.law.unpushed(&Seen {
            robot: (position, velocity),
            foot: [feet.point, still, frame],
            draws: true,
            leader_velocity: Some(leader_velocity - still + still),
        });
        let mut walls = Vectors::splat(Vector2::zeros());
        if !(inner & outer).is_whole() {
            let (position, leader) = (position.to_array(), leader.to_array());
            let pushes = core::array::from_fn::<_, LANES, _>(|lane| {
                Push::of_leader(&settings.zoning, position[lane], leader[lane])
            });
            walls = Vectors::of(pushes.map(|push| push.force));
            lyapunov = lyapunov + L::new(pushes.map(|push| push.value));
        }
        let (steered, power) = (acceleration + walls, walls.dot(&(leader_velocity - still)));
        // Limits, where they cut nothing.
        let wanted = steered - frame;
        let (mut applied, mut differs) = (steered, 0);
        if let Some(limits) = settings.limits {
            let terms = Terms { walls, attraction: trench, damping: wanted - walls - trench };
            let (cut, whole) = limits.whole(velocity - still, &terms, step);
            told = told & whole;
            applied = cut + frame;
            differs = (cut.x.is_not(wanted.x) | cut.y.is_not(wanted.y)).bits();
        }
        let (told, deviation) = (told.bits(), (feet.point - position).norm());
        let (now, distances) = (side.time + since, deviation.to_array());
        for (lane, agent) in agents.iter_mut().enumerate() {
            if told & (1 << lane) != 0 {
                agent.seeker.keep(feet.arc_length[lane]);
                agent.arrived = distances[lane] <= seeking.settled_distance;
                agent.last = Some(now);
            }
        }
        Some(Abreast {
            told,
            steered,
            lyapunov,
            lyapunov_rate,
            power,
            applied,
            cut: differs,
            foot: feet.point,
            deviation,
        })
    }
}
