//! One robot's dynamic law from tick to tick.

use super::around::moved;
use super::{Around, DynamicLaw, DynamicSettings, Frame};
use trench_formation::Vector2;
use trench_formation::curve::Placed;
use trench_formation::kinematics::PointState;
use trench_formation::laws::{Attracting, Attraction, GoalMotion, GoalTracking, Push, Steered};
use trench_formation::seek::{LeaderView, Seeker, Sought};
use trench_formation::trench::ConstantDamping;

/// Step of the integration, s.
const STEP: f64 = 1e-3;

/// Outcome of a tick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Driven {
    /// Mean velocity of the steered point until the next tick, m/s, map.
    pub(crate) mean: Vector2<f64>,
    /// Its velocity at the end.
    pub(crate) end: Vector2<f64>,
    /// Mean acceleration, m/s^2.
    pub(crate) acceleration: Vector2<f64>,
    /// What the law said at the beginning.
    pub(crate) steered: Steered,
    /// Power of all that the stability argument leaves out, at the beginning: V per second.
    pub(crate) limited: f64,
    /// The point that draws the robot, m; none while the attraction is suspended.
    pub(crate) drawn: Option<Vector2<f64>>,
    /// Whether speed or acceleration were cut.
    pub(crate) cut: bool,
}

/// What draws a robot now.
#[derive(Debug, Clone, Copy)]
struct Drawing {
    foot: GoalMotion,
    draws: bool,
    tangent: Vector2<f64>,
}

/// What one robot remembers.
#[derive(Debug, Clone, Default)]
pub(crate) struct Agent {
    seeker: Seeker,
}

impl Agent {
    /// Integrates the law from `robot`, the steered point's state, for `duration` seconds.
    pub(crate) fn drive(
        &mut self,
        settings: &DynamicSettings,
        around: &Around<'_>,
        robot: PointState,
        duration: f64,
    ) -> Driven {
        let steps = (duration / STEP).round().max(1.0) as u32;
        let (mut state, mut time, mut cut) = (robot, 0.0, false);
        let mut first = None;
        for _ in 0..steps {
            let frame = around.frame.after(time);
            let drawing = self.drawing(settings, around, &frame, state, time);
            let steered = steer(settings, around, (&frame, time), state, drawing);
            let reference = if settings.law.seeks(around.rank) { drawing.foot } else { moved(around.goal, time) };
            let (applied, acted) = within(settings, state, steered.acceleration, reference);
            cut |= acted;
            first.get_or_insert_with(|| {
                let limited = (applied - steered.acceleration).dot(&(state.velocity - reference.velocity));
                (steered, drawing.draws.then_some(drawing.foot.position), limited)
            });
            state = state.advanced_semi_implicit(applied, STEP);
            time += STEP;
        }
        let rest = Steered { acceleration: Vector2::zeros(), lyapunov: 0.0, lyapunov_rate: 0.0 };
        let (steered, drawn, limited) = first.unwrap_or((rest, None, 0.0));
        let (mean, end) = ((state.position - robot.position) / time, state.velocity);
        Driven { mean, end, acceleration: (end - robot.velocity) / time, steered, limited, drawn, cut }
    }

    fn drawing(
        &mut self,
        settings: &DynamicSettings,
        around: &Around<'_>,
        frame: &Frame,
        robot: PointState,
        time: f64,
    ) -> Drawing {
        let goal = moved(around.goal, time);
        let to_goal = Drawing { foot: goal, draws: true, tangent: Vector2::zeros() };
        let Some(curve) = around.segment.filter(|_| settings.law.seeks(around.rank)) else { return to_goal };
        let (segment, motion) = (Placed::new(curve, frame.map_from_segment()), frame.motion());
        let leader = around.ahead.last().filter(|_| settings.law.is_chained()).map(|leader| {
            let position = leader.state.position + time * leader.state.velocity;
            let speed = (leader.state.velocity - motion.at(position).velocity).norm();
            (LeaderView { position, distance: leader.deviation, speed }, settings.zoning.radii())
        });
        let whole = ((0.0, curve.length()), around.fragments);
        match self.seeker.seek(&settings.seeking, &segment, whole, robot.position, leader) {
            Sought::Point(foot) => Drawing { foot: motion.at(foot.point), draws: true, tangent: foot.tangent },
            Sought::Tie | Sought::NoFragment => {
                Drawing { foot: motion.at(robot.position), draws: false, tangent: Vector2::zeros() }
            }
        }
    }
}

fn steer(
    settings: &DynamicSettings,
    around: &Around<'_>,
    (frame, time): (&Frame, f64),
    robot: PointState,
    drawing: Drawing,
) -> Steered {
    let attracting = Attracting { foot: drawing.foot, draws: drawing.draws };
    let pushes = || pushes(settings, around, robot.position, time);
    let leader = around.ahead.last().filter(|_| settings.law.is_chained() && around.rank > 1);
    match &settings.law {
        DynamicLaw::Goal(law) => pushed(law.steer(robot, drawing.foot), pushes()),
        DynamicLaw::GoalDamped(law) => pushed(law.steer(robot, drawing.foot), pushes()),
        DynamicLaw::GoalAtRest(law) => pushed(law.steer(robot, GoalMotion::at_rest(drawing.foot.position)), pushes()),
        DynamicLaw::Nearest(law) | DynamicLaw::Chain(law) => {
            // Where the segment turns, robots at rest in it have different velocities: compared is what they do in it.
            let motion = frame.motion();
            let alike = leader.map(|leader| {
                let there = leader.state.position + time * leader.state.velocity;
                leader.state.velocity - motion.at(there).velocity + drawing.foot.velocity
            });
            law.steer(robot, attracting, alike, pushes())
        }
        DynamicLaw::Zoned(law) => match leader {
            Some(leader) if drawing.draws => {
                // The law is written for a segment at rest: seen from the segment's frame, robots move by less.
                let motion = frame.motion();
                let seen = |state: PointState| PointState {
                    velocity: state.velocity - motion.at(state.position).velocity,
                    ..state
                };
                let across = Vector2::new(-drawing.tangent.y, drawing.tangent.x);
                let point = drawing.foot.position;
                let attraction = Attraction::on_line(seen(robot), across, point, drawing.tangent);
                let attraction = attraction.unwrap_or(Attraction { point, velocity: Vector2::zeros() });
                let others: Vec<Vector2<f64>> = around.ahead[..around.ahead.len() - 1]
                    .iter()
                    .map(|other| other.state.position + time * other.state.velocity)
                    .collect();
                let there =
                    PointState { position: leader.state.position + time * leader.state.velocity, ..leader.state };
                let mut steered = law.steer(seen(robot), attraction, seen(there), &others);
                steered.acceleration += motion.at(robot.position).acceleration;
                pushed(steered, obstacle_pushes(settings, around, robot.position, time))
            }
            _ => {
                let damping = ConstantDamping { coefficient: law.damping };
                let goal = GoalTracking { trench: &law.trench, damping };
                pushed(goal.steer(robot, drawing.foot), pushes())
            }
        },
    }
}

fn pushed(mut steered: Steered, pushes: impl Iterator<Item = Push>) -> Steered {
    for push in pushes {
        steered.acceleration += push.force;
        steered.lyapunov += push.value;
    }
    steered
}

/// The terms of (7.12): zones of the leader and the robots ahead, and obstacles.
fn pushes<'a>(
    settings: &'a DynamicSettings,
    around: &'a Around<'_>,
    robot: Vector2<f64>,
    time: f64,
) -> impl Iterator<Item = Push> + 'a {
    let chained = settings.law.is_chained();
    let last = around.ahead.len().saturating_sub(1);
    let ahead = around.ahead.iter().enumerate().filter(move |_| chained).map(move |(index, other)| {
        let there = other.state.position + time * other.state.velocity;
        if index == last {
            Push::of_leader(&settings.zoning, robot, there)
        } else {
            Push::of_robot_ahead(&settings.zoning, robot, there)
        }
    });
    ahead.chain(obstacle_pushes(settings, around, robot, time))
}

fn obstacle_pushes<'a>(
    settings: &'a DynamicSettings,
    around: &'a Around<'_>,
    robot: Vector2<f64>,
    time: f64,
) -> impl Iterator<Item = Push> + 'a {
    around.hulls.iter().map(move |hull| Push::of_obstacle(&settings.potential, hull.approach(robot, time)))
}

/// The acceleration that the robot can follow: within its own limit, and none that makes it faster than its speed.
fn within(
    settings: &DynamicSettings,
    state: PointState,
    wanted: Vector2<f64>,
    reference: GoalMotion,
) -> (Vector2<f64>, bool) {
    let most = settings.capability.acceleration + reference.acceleration.norm();
    let cut = wanted.cap_magnitude(most);
    let next = state.velocity + STEP * cut;
    let speed = settings.capability.speed;
    if next.norm() > speed {
        // A robot that is too fast already slows down as its limit lets it.
        let slower = next.cap_magnitude(speed) - state.velocity;
        return ((slower / STEP).cap_magnitude(most), true);
    }
    (cut, cut != wanted)
}
