//! Runs scenario files: the theory headless, without node cores.

use super::SimError;
use super::progress::Progress;
use super::sink::Sink;
use super::threads::Threads;
use crate::command::say;
use std::fmt::{self, Display};
use std::path::Path;
use std::time::Instant;
use trench_bag::run::Run;
use trench_check::Verdict;
use trench_scenario::{
    CaseSummary, ChangeSummary, DivergedSummary, LyapunovSummary, Measures, OutsideSummary, Scenario, Simulation,
    Summary, Transits, WheelSummary,
};

mod messages;

/// Transits of a robot that people are told the times of; programs are told of a hundred.
const TRANSITS: usize = 8;

/// Collisions of a case that people are told; programs are told of all.
const COLLISIONS: usize = 20;

/// A run and what is to be said of it.
pub(crate) struct Done {
    pub(crate) run: Run,
    pub(crate) summary: Summary,
}

/// How to run a scenario.
#[derive(Clone, Copy)]
pub(crate) struct Manner<'a> {
    /// Where its bag goes.
    pub(crate) bag: Option<&'a Path>,
    /// Whether to tell how far it is.
    pub(crate) progress: bool,
    /// How many work at it.
    pub(crate) threads: usize,
}

/// Runs a scenario to its end; `text` is its file, which goes into the bag.
pub(crate) fn run(scenario: &Scenario, text: &str, manner: Manner<'_>) -> Result<Done, SimError> {
    let Manner { bag, progress, threads } = manner;
    let mut simulation = Simulation::new(scenario)?.with(Threads(threads));
    let mut measures = Measures::new(scenario);
    let mut sink = Sink::new(bag)?;
    let publisher = messages::Publisher::new(scenario);
    publisher.begin(text, &mut sink);
    let (mut samples, timing) = (Vec::new(), scenario.timing);
    let steps = (timing.duration / timing.step).round() as u64;
    let (began, mut line) = (Instant::now(), Progress::new(progress));
    for step in 0..=steps {
        if step > 0 {
            simulation.step()?;
        }
        let is_recorded = step % timing.record_every == 0 || step == steps;
        if is_recorded || !simulation.tells_itself() {
            // V is measured at every step.
            simulation.sample(true, &mut samples)?;
        }
        measures.take(scenario, &simulation, &samples);
        let ends = measures.diverged().is_some();
        if ends && !is_recorded {
            simulation.sample(true, &mut samples)?;
        }
        if is_recorded || ends {
            publisher.publish(&simulation, &samples, &mut sink);
        }
        if ends {
            break;
        }
        line.at(|| format!("{:.0} of {:.0} s simulated", simulation.time(), timing.duration));
    }
    let took = began.elapsed().as_secs_f64();
    line.clear();
    if progress {
        eprintln!("{:.1} s simulated in {took:.3} s: {:.0} times real time", timing.duration, timing.duration / took);
    }
    Ok(Done { run: sink.finish()?, summary: measures.summary(scenario, &samples) })
}

/// Says how it went, and what nobody could have made go well.
pub(crate) fn tell(summary: &Summary, infeasible: &[Verdict], json: bool) {
    if json {
        let mut told = serde_json::json!(summary);
        told["infeasible"] = serde_json::json!(infeasible);
        say(format_args!("{told:#}\n"));
    } else {
        say(Told(summary));
    }
}

struct Told<'a>(&'a Summary);

/// m, or nothing where nothing draws a robot.
fn metres(value: f64) -> String {
    if value.is_finite() { format!("{value:.6}") } else { "-".to_owned() }
}

impl Display for Told<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Summary { name, section, duration, step, diverged, cases } = self.0;
        let section = if section.is_empty() { String::new() } else { format!(" (section {section})") };
        writeln!(formatter, "{name}{section}: {duration} s in steps of {step} s")?;
        if let Some(DivergedSummary { time, robot, distance, limit, remedy }) = diverged {
            writeln!(
                formatter,
                "diverged after {time:.2} s: {robot} was {distance:.4e} m out, beyond {limit:.0} m, a thousand times all that the file speaks of; {remedy}"
            )?;
        }
        if let Some(first) = self.0.first_collision() {
            writeln!(
                formatter,
                "collided: {first}; no obstacle stops a robot in a simulation, and this run is none that robots can make: make the obstacles' \
                 repulsion stronger, what draws robots weaker or the step smaller, or write `limits` and `safety`"
            )?;
        }
        cases.iter().try_for_each(|case| tell_case(formatter, case))
    }
}

fn tell_case(formatter: &mut fmt::Formatter<'_>, case: &CaseSummary) -> fmt::Result {
    let seconds = |time: Option<f64>| time.map_or("never".to_owned(), |time| format!("after {time:.2} s"));
    let though = if case.collisions.is_empty() { "" } else { ", but robots went through obstacles:" };
    writeln!(formatter, "\n{}: all conform {}{though}", case.label, seconds(case.conforms_after))?;
    for collision in case.collisions.iter().take(COLLISIONS) {
        writeln!(formatter, "  {collision}")?;
    }
    if let Some(more) = case.collisions.len().checked_sub(COLLISIONS).filter(|more| *more > 0) {
        writeln!(formatter, "  and {more} more")?;
    }
    if let Some(closest) = case.closest_pair {
        let forbidden = case.in_zone_1.map_or(String::new(), |seconds| format!(", {seconds:.3} s in zone 1"));
        writeln!(formatter, "  closest pair {closest:.4} m{forbidden}")?;
    }
    for obstacle in &case.obstacles {
        let (id, gap) = (obstacle.id, obstacle.least_gap);
        if gap < 0.0 {
            writeln!(formatter, "  obstacle {id}: a robot was inside the obstacle, {:.4} m from its edge", -gap)?;
        } else if gap == 0.0 {
            writeln!(formatter, "  obstacle {id}: a robot went through it")?;
        } else {
            writeln!(formatter, "  obstacle {id}: no robot nearer than {gap:.4} m")?;
        }
    }
    if let Some(after) = case.neutral_after {
        writeln!(formatter, "  leaders in neutral zones for good after {after:.2} s")?;
    }
    for OutsideSummary { robot, leader, zone, distance, why } in &case.outside_neutral {
        let zone = if *zone == 6 { "beyond all zones".to_owned() } else { format!("in zone {zone}") };
        writeln!(formatter, "  {leader} is {zone} of {robot}, {distance:.4} m away: {why}")?;
    }
    let laws = || case.robots.iter().filter_map(|robot| Some((robot, robot.lyapunov?)));
    if let Some((robot, most)) = laws().max_by(|(_, a), (_, b)| a.greatest_rise.total_cmp(&b.greatest_rise)) {
        let of =
            |value: fn(&LyapunovSummary) -> f64| laws().map(|(_, law)| value(&law)).fold(f64::NEG_INFINITY, f64::max);
        let (greatest, last) = (of(|law| law.greatest), of(|law| law.last));
        let (rate, by_law) =
            (of(|law| law.greatest_rate.unwrap_or(f64::NEG_INFINITY)), of(|law| law.greatest_rate_of_law));
        let rate = if rate.is_finite() { format!("{rate:.4}") } else { "-".to_owned() };
        let (rise, name) = (most.greatest_rise, &robot.name);
        writeln!(formatter, "  V of the laws: {greatest:.4} at most, {last:.4} at the end")?;
        writeln!(
            formatter,
            "  V measured, less what others bring in: rises by {rise:.4} at most ({name}), by {rate} a second at most; by the laws' formula {by_law:.4}"
        )?;
    }
    for ChangeSummary { time, robot, change, rank } in &case.changes {
        let rank = rank.map_or(String::new(), |rank| format!(" as rank {rank}"));
        writeln!(formatter, "  after {time:.2} s {robot} {change}{rank}")?;
    }
    writeln!(formatter, "  robot          x (m)     y (m)   error (m)  conforms (s)  leader (m)  phi (rad)  effort")?;
    for robot in &case.robots {
        let [x, y] = robot.position;
        let optional =
            |value: Option<f64>, digits: usize| value.map_or("-".to_owned(), |value| format!("{value:.digits$}"));
        writeln!(
            formatter,
            "  {:<10} {x:>9.4} {y:>9.4} {:>11} {:>13} {:>11} {:>10} {:>7}",
            robot.name,
            metres(robot.error),
            robot.conforms_after.map_or("never".to_owned(), |time| format!("{time:.2}")),
            optional(robot.leader_distance, 4),
            optional(robot.misalignment, 5),
            optional(robot.effort, 3),
        )?;
    }
    for robot in &case.robots {
        if let Some(since) = robot.no_fragment_since {
            let name = &robot.name;
            writeln!(
                formatter,
                "  {name} has been drawn nowhere since {since:.2} s: no qualified fragment is left (7.5.1)"
            )?;
        }
        if let Some(Transits { count: count @ 1.., first }) = &robot.transits {
            let times: Vec<String> =
                first.iter().take(TRANSITS).map(|transit| format!("{:.2}", transit.time)).collect();
            let more = if *count > TRANSITS { ", ..." } else { "" };
            writeln!(
                formatter,
                "  transits of {} (Definition 7.2.1): {count}, after {}{more} s",
                robot.name,
                times.join(", ")
            )?;
        }
        if let Some(WheelSummary { greatest_torque, saturated }) = robot.wheels {
            let name = &robot.name;
            writeln!(
                formatter,
                "  wheels of {name}: up to {greatest_torque:.4} N m wanted, saturated for {saturated:.3} s"
            )?;
        }
    }
    Ok(())
}
