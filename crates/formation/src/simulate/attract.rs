//! What draws the robots of a simulated chain.
use super::remedy::{Asked, Drawn, Surroundings};
use super::{ChainSimulation, Encroaching, ScenarioError};
use crate::Vector2;
use crate::curve::Placed;
use crate::hull::{ApparentObstacle, Outline};
use crate::laws::{Attracting, GoalMotion};
use crate::seek::{Fragments, LeaderView, Sought, apparent_obstacles};
use crate::trench::Trench;

impl<T: Trench> ChainSimulation<T> {
    /// What draws a robot: its goal or nearest point, unless a remedy asks for something else.
    pub(super) fn attract(&mut self, index: usize) -> Attracting {
        let (map_from_segment, motion) = self.frame;
        let robot = self.robots[index].position;
        let goal = self.scenario.team_goal.filter(|_| index == 0);
        let drawn = match goal.map(|goal| map_from_segment.transform_point(&goal.into()).coords) {
            Some(goal) => Drawn::Goal(goal),
            None => match self.seek(index) {
                Sought::Point(foot) => Drawn::To(foot),
                Sought::Tie | Sought::NoFragment => return Attracting { foot: motion.at(robot), draws: false },
            },
        };
        let target = match drawn {
            Drawn::Goal(goal) => goal,
            Drawn::To(foot) => foot.point,
        };
        self.deviations[index] = (target - robot).norm();
        match self.remedy(index, drawn) {
            Asked::Attraction => Attracting { foot: motion.at(target), draws: true },
            Asked::Suspension => Attracting { foot: motion.at(robot), draws: false },
            Asked::Point(point) => Attracting { foot: GoalMotion::at_rest(point), draws: true },
        }
    }

    fn remedy(&mut self, index: usize, drawn: Drawn) -> Asked {
        let scenario = &self.scenario;
        let Some(remedies) = &scenario.remedies else { return Asked::Attraction };
        let around = Surroundings {
            remedies,
            time: self.steps as f64 * scenario.step,
            step: scenario.step,
            segment: Placed::new(&scenario.segment, self.frame.0),
            real: &scenario.obstacles,
            apparent: &self.obstacles,
            potential: &scenario.potential,
        };
        self.remedies[index].update(&around, self.robots[index].position, drawn)
    }

    fn seek(&mut self, index: usize) -> Sought {
        let scenario = &self.scenario;
        let segment = Placed::new(&scenario.segment, self.frame.0);
        let leader = index.checked_sub(1).map(|leader| {
            let state = self.seen[leader];
            let speed = (state.velocity - self.frame.1.at(state.position).velocity).norm();
            let view = LeaderView { position: state.position, distance: self.deviations[leader], speed };
            (view, scenario.zoning.radii())
        });
        let whole = (0.0, scenario.segment.length());
        let fragments = &self.fragments[index.min(self.fragments.len() - 1)];
        self.seekers[index].seek(&scenario.seeking, &segment, (whole, fragments), self.robots[index].position, leader)
    }

    pub(super) fn find_fragments(&mut self) -> Result<(), ScenarioError> {
        let scenario = &self.scenario;
        let whole = (0.0, scenario.segment.length());
        let segment = Placed::new(&scenario.segment, self.frame.0);
        let find = |obstacles: &[ApparentObstacle]| {
            let outlines: Vec<Outline<'_>> = obstacles.iter().map(|obstacle| obstacle.shape.outline()).collect();
            Fragments::find(&segment, whole, &outlines, scenario.potential.cut(), scenario.seeking.room)
        };
        self.fragments = match scenario.encroaching {
            Encroaching::Nothing => vec![Fragments::whole(whole)],
            Encroaching::Obstacles => vec![find(&self.obstacles)],
            Encroaching::ObstaclesAndRobots(radius) => {
                let positions: Vec<Vector2<f64>> = self.seen.iter().map(|state| state.position).collect();
                let of_robot = |index: usize| {
                    apparent_obstacles(&scenario.obstacles, &positions[..index], radius, scenario.clearance)
                };
                (0..positions.len()).map(|index| Ok(find(&of_robot(index)?))).collect::<Result<_, ScenarioError>>()?
            }
        };
        Ok(())
    }
}
