//! Lasers that fall silent while their robots drive on: into what nobody sees.

use crate::team::Team;
use trench_core::Steady;
use trench_optics::Pose2;

/// A robot that moves no farther than this, m, stands: poses are noisy.
const STANDS: f64 = 0.05;

/// What counts of a laser's last scan that was taken.
#[derive(Debug, Clone, Copy)]
struct Sight {
    /// When it came.
    came: Steady,
    /// Where the robot was then.
    pose: Pose2,
}

/// The lasers that have spoken, by the places of their robots in the list.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    sights: Vec<Option<Sight>>,
}

impl Watch {
    /// A scan of a robot that was at `pose` has been taken.
    pub(crate) fn saw(&mut self, robot: usize, came: Steady, pose: Pose2) {
        if self.sights.len() <= robot {
            self.sights.resize(robot + 1, None);
        }
        self.sights[robot] = Some(Sight { came, pose });
    }

    /// A team state came. Of robots whose places are not known no scan can be taken: that is no silence of their lasers.
    pub(crate) fn excuse(&mut self, at: Steady, robots: &[String], team: &Team) {
        for (sight, name) in self.sights.iter_mut().zip(robots) {
            if let Some(sight) = sight.as_mut().filter(|_| team.newest(name).is_none()) {
                sight.came = at;
            }
        }
    }

    /// What is wrong if lasers have been silent for longer than `age` (s; 0: none ever is) and their robots have moved since.
    pub(crate) fn silence(&self, at: Steady, age: f64, robots: &[String], team: &Team) -> Option<String> {
        let silent = self.sights.iter().zip(robots).filter_map(|(sight, name)| {
            let Sight { came, pose } = (*sight)?;
            let (silent, now) = (at.seconds_since(came), team.newest(name)?);
            let moved = libm::hypot(now.x - pose.x, now.y - pose.y);
            let told = || format!("{name}'s laser is silent for {silent:.1} s and it has moved {moved:.2} m since");
            (silent > age && moved > STANDS).then(told)
        });
        let told = if age > 0.0 { silent.collect::<Vec<_>>() } else { Vec::new() };
        let they = if told.len() == 1 { "it speaks" } else { "they speak" };
        (!told.is_empty()).then(|| format!("{}: robots rest until {they} (age.scan)", told.join(", ")))
    }
}
