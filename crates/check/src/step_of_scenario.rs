//! Whether the step of a scenario is short enough for its laws.

use crate::Verdict;
use crate::chatter_of_scenario::{Felt, with_chatter};
use crate::scenario::{RANGE, least_sine, named};
use crate::step::Stiff;
use crate::verdict::number;
use crate::walls_of_scenario::least_turn;
use trench_formation::kinematics::Polar;
use trench_formation::laws::{GoalTracking, PointLaw};
use trench_formation::simulate::Integration;
use trench_formation::trench::{Damping, Trench};
use trench_formation::zoning::{ObstaclePotential, Zoning};
use trench_scenario::{GoalCase, GoalLaw, Regulating, RegulatingCase, Scenario, Task};

const EQUATION: &str = "|lambda| h within the method's stability: 2.785 (rk4, real), h k + h^2 K/2 < 2 (semi-implicit Euler), h < 2/k and 2 k/K (held)";
/// Distances at which laws are looked at, evenly in their logarithm, from a micrometre on.
const LOOKS: u32 = 240;

/// Where a law is stiffest, for people.
type Named = (String, Stiff);

/// Judges the step, by case where there are several; nothing of launch files, which bring their own.
pub(crate) fn step(subject: &str, scenario: &Scenario) -> Vec<Verdict> {
    let (h, method) = (scenario.timing.step, scenario.timing.integration);
    let of = |name: &str, laws: Vec<Named>, walls: Option<String>| judged(name, (h, method), laws, walls);
    let chatters = |verdict, felt: &Felt<'_>| with_chatter(verdict, felt, scenario.tolerance, (h, method));
    let mut verdicts: Vec<Verdict> = match &scenario.task {
        Task::Regulating(task) => {
            let cases = task.cases.iter();
            cases.filter_map(|case| of(&named(subject, &case.name), rates(task, case), None)).collect()
        }
        Task::GoalTracking(task) => {
            let judged = |case: &GoalCase| {
                let verdict = of(&named(subject, &case.name), of_goal(&case.law), None)?;
                let GoalLaw::Trench(GoalTracking { trench, damping }) = &case.law else { return Some(verdict) };
                let damping = |x: f64| damping.coefficient(x);
                let limits = case.bounds.map(|bounds| bounds.limits);
                Some(chatters(verdict, &Felt { trench, damping: &damping, sine: 1.0, limits }))
            };
            task.cases.iter().filter_map(judged).collect()
        }
        Task::Directed(task) => {
            let (law, sine) = (&task.chain.law, least_turn(&task.chain));
            let damping = law.damping + law.leader_damping;
            let walls = walls((h, method), damping, &law.zoning, None);
            let felt = Felt { trench: &law.trench, damping: &|_| law.damping, sine, limits: None };
            let verdict = of(subject, of_trench(&law.trench, |_| damping, sine), walls);
            verdict.map(|verdict| chatters(verdict, &felt)).into_iter().collect()
        }
        Task::Nearest(task, _) => {
            let (law, sine) = (&task.law, least_sine(task));
            let damping = law.damping + law.leader_damping;
            let obstacles = (!task.obstacles.is_empty()).then_some(&task.potential);
            let walls = walls((h, method), damping, &task.zoning, obstacles);
            let limits = task.options.limits;
            let felt = Felt { trench: &law.trench, damping: &|_| law.damping, sine, limits };
            let verdict = of(subject, of_trench(&law.trench, |_| damping, sine), walls);
            verdict.map(|verdict| chatters(verdict, &felt)).into_iter().collect()
        }
        Task::Queue(task) => {
            let law = task.queue.law;
            let text = format!("K = ({}, {})", number(law.position_gain), number(law.velocity_gain));
            let laws = vec![(text, Stiff::Second(law.position_gain, law.velocity_gain))];
            of(subject, laws, None).into_iter().collect()
        }
        Task::Launch(_) => Vec::new(),
    };
    for case in scenario.compared.iter().flat_map(|compared| &compared.cases) {
        let stiff = Stiff::Second(case.course.pull, case.course.damping);
        let laws = vec![("the attraction".to_owned(), stiff)];
        verdicts.extend(judged(&named(subject, &case.name), (h, Integration::SemiImplicitEuler), laws, None));
    }
    verdicts
}

/// The law with the shortest of all longest steps.
fn judged(subject: &str, (h, method): (f64, Integration), laws: Vec<Named>, walls: Option<String>) -> Option<Verdict> {
    let longest = |(_, stiff): &Named| stiff.longest_step(method);
    let worst = laws.into_iter().min_by(|one, other| longest(one).total_cmp(&longest(other)))?;
    let most = longest(&worst);
    let (name, stiff) = worst;
    let called = match method {
        Integration::RungeKutta => "rk4",
        Integration::SemiImplicitEuler => "semi_implicit_euler",
        Integration::Exact => "exact",
    };
    let found = format!("{name}: |lambda| up to {} 1/s, h = {} s", number(stiff.largest()), number(h));
    if h > most {
        let finding = format!(
            "{found}: {called} follows it in steps below {} s alone, beyond that errors grow from step to step; make step {} or less",
            number(most),
            number(0.5 * most)
        );
        return Some(Verdict::new("step", subject, false, finding, EQUATION));
    }
    let finding = format!("{found}, and {called} is stable below {} s", number(most));
    let verdict = Verdict::new("step", subject, true, finding, EQUATION);
    Some(match walls {
        Some(walls) => Verdict { note: true, finding: format!("{}. {walls}", verdict.finding), ..verdict },
        None => verdict,
    })
}

/// A trench with its damping, at all distances: its second derivative, and what it is across the way to its bottom. Along a direction it is
/// steeper by the sine of the angle to the segment.
fn of_trench(trench: &dyn Trench, damping: impl Fn(f64) -> f64, sine: f64) -> Vec<Named> {
    let distances = (0..=LOOKS).map(|look| 1e-6 * libm::pow(RANGE / 1e-6, f64::from(look) / f64::from(LOOKS)));
    let of = |x: f64| {
        let (here, beyond) = (trench.slope(x), trench.slope(1.001 * x));
        let stiffness = ((beyond - here) / (0.001 * x)).max(if kinks(trench) { 0.0 } else { here / x }) / sine;
        let text = format!("K = {} 1/s^2, k = {} 1/s of the trench", number(stiffness), number(damping(x)));
        (text, Stiff::Second(stiffness.max(0.0), damping(x)))
    };
    distances.map(of).filter(|(_, stiff)| stiff.largest() > 0.0).collect()
}

/// Whether it is a corner where it is least: no step is short enough there, and how far robots chatter is told beside.
fn kinks(trench: &dyn Trench) -> bool {
    let bottom = trench.slopes(0.0);
    bottom.left != bottom.right
}

fn of_goal(law: &GoalLaw) -> Vec<Named> {
    match law {
        GoalLaw::Trench(law) => of_trench(&law.trench, |x| law.damping.coefficient(x), 1.0),
        GoalLaw::Conventional(law) => vec![("xi and k".to_owned(), Stiff::Second(law.strength, law.damping))],
        GoalLaw::Velocity(law) => {
            vec![("alpha_p and alpha_v".to_owned(), Stiff::Second(2.0 * law.position, 2.0 * law.velocity))]
        }
    }
}

/// The largest rates of r and phi under a law of chapter 4, as far off as robots start.
fn rates(task: &Regulating, case: &RegulatingCase) -> Vec<Named> {
    let far = task.starts.iter().map(|start| Polar::of(start.0, task.goal).distance).fold(1e-3, f64::max);
    let mut largest = [0.0_f64; 2];
    for look in 1..=LOOKS {
        let misalignment = core::f64::consts::PI * f64::from(look) / f64::from(LOOKS);
        for distance in [1e-3, far] {
            let polar = Polar { distance, misalignment };
            let rates = polar.rates(case.law.twist(polar));
            largest[0] = largest[0].max(-rates.distance / distance);
            largest[1] = largest[1].max(-rates.misalignment / misalignment);
        }
    }
    let named = ["the distance to the goal point", "phi"].into_iter().zip(largest);
    named.filter(|(_, rate)| *rate > 0.0).map(|(name, rate)| (name.to_owned(), Stiff::First(rate))).collect()
}

/// Walls have no largest slope but that at which their force is cut: how near to a pole one must not come by this step, where it is too long
/// for them.
fn walls(
    (h, method): (f64, Integration),
    damping: f64,
    zoning: &Zoning,
    obstacles: Option<&ObstaclePotential>,
) -> Option<String> {
    let radii = zoning.radii();
    let near = |width: f64, force: &dyn Fn(f64) -> f64| {
        let depths = (1..=LOOKS).map(|look| width * libm::pow(1e-6, f64::from(look) / f64::from(LOOKS)));
        let is_too_stiff = |depth: &f64| {
            let stiffness = (force(0.999 * depth) - force(*depth)).abs() / (0.001 * depth);
            h > Stiff::Second(stiffness, damping).longest_step(method)
        };
        depths.into_iter().find(is_too_stiff)
    };
    let mut found = Vec::new();
    let zones = [
        near(radii.rho_hat - radii.rho_underbar, &|depth| zoning.force(radii.rho_underbar + depth)),
        near(radii.rho_check - radii.rho, &|depth| zoning.force(radii.rho_check - depth)),
    ];
    if let Some(depth) = zones.into_iter().flatten().reduce(f64::max) {
        found.push(format!("{} m before the poles of zones", number(depth)));
    }
    let before = |potential: &ObstaclePotential| {
        near(potential.cut() - potential.pole(), &|depth| potential.force(potential.pole() + depth))
    };
    if let Some(depth) = obstacles.and_then(before) {
        found.push(format!("{} m before those of obstacles", number(depth)));
    }
    (!found.is_empty()).then(|| {
        format!("Barriers are steeper than this step follows from {} on: who comes as near is thrown back faster than it came", found.join(", "))
    })
}
