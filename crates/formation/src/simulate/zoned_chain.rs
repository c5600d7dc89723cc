//! A chain that approaches a straight segment along directions of attraction, under (6.1): the simulation of 6.5.
use super::integrate::Integrator;
use super::links::Links;
use super::{Integration, QueueChange};
use crate::Vector2;
use crate::kinematics::PointState;
use crate::laws::{Attraction, GoalMotion, GoalTracking, Push, Steered, ZonedAttraction};
use crate::trench::{ConstantDamping, Trench};

/// What 6.5 simulates.
#[derive(Debug, Clone, PartialEq)]
pub struct ZonedChainScenario<T> {
    /// A point of the segment, m.
    pub origin: Vector2<f64>,
    /// Unit vector along the segment.
    pub tangent: Vector2<f64>,
    /// Unit vectors in the directions of attraction, one a robot; not along the segment. The chain leader's is not used.
    pub directions: Vec<Vector2<f64>>,
    /// Where the chain leader goes by (5.3), m.
    pub team_goal: Vector2<f64>,
    /// Robots by rank at time 0.
    pub robots: Vec<PointState>,
    /// (6.1); its trench and damping are the chain leader's too.
    pub law: ZonedAttraction<T>,
}

/// A chain under way.
#[derive(Debug, Clone)]
pub struct ZonedChain<T> {
    scenario: ZonedChainScenario<T>,
    robots: Vec<PointState>,
    integrator: Integrator,
    links: Links,
    step: f64,
    steps: u64,
}

impl<T: Trench + Clone> ZonedChain<T> {
    /// Robots at their start. Robots beyond the directions given have none and are only damped.
    pub fn new(scenario: ZonedChainScenario<T>, method: Integration, step: f64) -> Self {
        let robots = scenario.robots.clone();
        let integrator = Integrator::new(method, step, robots.len());
        let mut chain = Self { scenario, robots, integrator, links: Links::default(), step, steps: 0 };
        chain.look_for_links();
        chain
    }

    /// Advances by one step.
    pub fn step(&mut self) {
        let (scenario, mut ahead) = (&self.scenario, Vec::with_capacity(self.robots.len()));
        self.integrator.advance(&mut self.robots, 0.0, |_, robots, rates| {
            ahead.clear();
            for (index, (robot, rate)) in robots.iter().zip(rates).enumerate() {
                *rate = scenario.steer(robots, index, &ahead).acceleration;
                ahead.push(robot.position);
            }
        });
        self.steps += 1;
        self.look_for_links();
    }

    /// Who hears whom is for people alone: the law looks at each stage of a step itself.
    fn look_for_links(&mut self) {
        let reach = self.scenario.law.zoning.radii().rho_bar;
        self.links.look(self.steps as f64 * self.step, &self.robots, (reach, reach), &[]);
    }

    /// What befell the links between robots and their leaders so far, in time.
    pub fn changes(&self) -> &[QueueChange] {
        self.links.changes()
    }

    /// What the law says of the robot at `index` (0 is the chain leader) where it is now.
    pub fn steered(&self, index: usize) -> Steered {
        let ahead: Vec<Vector2<f64>> = self.robots.iter().take(index).map(|robot| robot.position).collect();
        self.scenario.steer(&self.robots, index, &ahead)
    }

    /// Power that leader and robots ahead bring into the Lyapunov function of the robot at `index` besides its rate: Psi' d_hat . v of
    /// each, m^2/s^3.
    pub fn power(&self, index: usize) -> f64 {
        let (zoning, robot) = (&self.scenario.law.zoning, self.robots[index].position);
        let of = |push: Push, other: &PointState| push.force.dot(&other.velocity);
        let Some((leader, ahead)) = self.robots[..index].split_last() else { return 0.0 };
        let heard = (leader.position - robot).norm() <= zoning.radii().rho_bar;
        let led = if heard { of(Push::of_leader(zoning, robot, leader.position), leader) } else { 0.0 };
        led + ahead.iter().map(|other| of(Push::of_robot_ahead(zoning, robot, other.position), other)).sum::<f64>()
    }

    /// The point that attracts a robot: the team goal for the chain leader.
    pub fn point_of_attraction(&self, index: usize) -> Vector2<f64> {
        let scenario = &self.scenario;
        if index == 0 { scenario.team_goal } else { scenario.attraction(self.robots[index], index).point }
    }

    /// Seconds simulated.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.step
    }

    /// Robots by rank.
    pub fn robots(&self) -> &[PointState] {
        &self.robots
    }
}

impl<T: Trench + Clone> ZonedChainScenario<T> {
    /// The point of attraction of a robot; a robot without a direction attracts itself where it is.
    pub fn attraction(&self, robot: PointState, index: usize) -> Attraction {
        let direction = self.directions.get(index);
        let found = direction.and_then(|direction| Attraction::on_line(robot, *direction, self.origin, self.tangent));
        found.unwrap_or(Attraction { point: robot.position, velocity: robot.velocity })
    }

    fn steer(&self, robots: &[PointState], index: usize, ahead: &[Vector2<f64>]) -> Steered {
        let robot = robots[index];
        let Some(leader) = index.checked_sub(1) else {
            let law = GoalTracking {
                trench: self.law.trench.clone(),
                damping: ConstantDamping { coefficient: self.law.damping },
            };
            return law.steer(robot, GoalMotion::at_rest(self.team_goal));
        };
        // Beyond rho_bar it does not hear its leader.
        let hears = (robots[leader].position - robot.position).norm() <= self.law.zoning.radii().rho_bar;
        self.law.steer(robot, self.attraction(robot, index), hears.then_some(robots[leader]), &ahead[..leader])
    }
}
