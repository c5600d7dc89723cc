//! The table that `trench sim` writes: one line a robot and time.

use super::{GoalSample, Pose, Run, Track};

/// What is wrong with a table.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum CsvError {
    /// A column is missing.
    #[error("line 1: the column {0} is missing; t, robot, x, y, theta, v, omega, goal_x, goal_y are needed")]
    Column(&'static str),
    /// A field is not a number.
    #[error("line {line}: {column} is {value:?}, which is no finite number")]
    Number {
        /// From 1.
        line: usize,
        /// The column's name.
        column: &'static str,
        /// What stands there.
        value: String,
    },
}

/// The columns with numbers; `robot` is the only other one.
const NUMBERS: [&str; 8] = ["t", "x", "y", "theta", "v", "omega", "goal_x", "goal_y"];

impl Run {
    /// Reads a run from the text of a table with the columns `t` (s), `robot`, `x`, `y` (m), `theta` (rad), `v` (m/s),
    /// `omega` (rad/s), `goal_x`, `goal_y` (m, empty where there is no goal), in any order.
    ///
    /// # Errors
    /// When a column is missing or a field is no finite number, with its line.
    pub fn from_csv(text: &str) -> Result<Self, CsvError> {
        let mut lines = text.lines().enumerate();
        let header: Vec<&str> = lines.next().map_or(Vec::new(), |(_, line)| line.split(',').map(str::trim).collect());
        let place = |column| header.iter().position(|&name| name == column).ok_or(CsvError::Column(column));
        let robot_place = place("robot")?;
        let mut places = [0; NUMBERS.len()];
        for (at, column) in places.iter_mut().zip(NUMBERS) {
            *at = place(column)?;
        }
        let mut run = Self { is_ground_truth: true, ..Self::default() };
        for (index, line) in lines.filter(|(_, line)| !line.trim().is_empty()) {
            let fields: Vec<&str> = line.split(',').map(str::trim).collect();
            let field = |at: usize| fields.get(at).copied().unwrap_or_default();
            let mut values = [None; NUMBERS.len()];
            for ((value, &at), column) in values.iter_mut().zip(&places).zip(NUMBERS) {
                *value = number(field(at), index + 1, column)?;
            }
            let track = run.robots.entry(field(robot_place).to_owned()).or_default();
            take(track, values);
        }
        run.robots.values_mut().for_each(Track::sort);
        Ok(run)
    }
}

impl Run {
    /// The run as the table that [`Run::from_csv`] reads, ordered by robot and time; the goal of a line is the one in
    /// force at its time.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut text = "t,robot,x,y,theta,v,omega,goal_x,goal_y\n".to_owned();
        for (robot, track) in &self.robots {
            for pose in &track.poses {
                let Pose { time, x, y, theta, v, omega } = *pose;
                let goal = track.goal_at(time).map_or(",".to_owned(), |[x, y]| format!("{x},{y}"));
                text += &format!("{time:.6},{robot},{x},{y},{theta},{v},{omega},{goal}\n");
            }
        }
        text
    }
}

/// A number; nothing for an empty field of a goal.
fn number(text: &str, line: usize, column: &'static str) -> Result<Option<f64>, CsvError> {
    if text.is_empty() && column.starts_with("goal") {
        return Ok(None);
    }
    let value = text.parse().ok().filter(|value: &f64| value.is_finite());
    value.map(Some).ok_or_else(|| CsvError::Number { line, column, value: text.to_owned() })
}

fn take(track: &mut Track, values: [Option<f64>; NUMBERS.len()]) {
    let [time, x, y, theta, v, omega, goal_x, goal_y] = values;
    let (Some(time), Some(x), Some(y), Some(theta), Some(v), Some(omega)) = (time, x, y, theta, v, omega) else {
        return; // `number` lets nothing but goals be empty.
    };
    track.poses.push(Pose { time, x, y, theta, v, omega });
    if let (Some(goal_x), Some(goal_y)) = (goal_x, goal_y) {
        let mut goal = GoalSample { time, position: [goal_x, goal_y], ..GoalSample::default() };
        // A table says no velocities: the step from the last line does.
        if let Some(last) = track.goals.last_mut()
            && time > last.time
        {
            let step = time - last.time;
            last.velocity = [(goal_x - last.position[0]) / step, (goal_y - last.position[1]) / step];
            last.remaining = step;
        }
        goal.time = time;
        track.goals.push(goal);
    }
}
