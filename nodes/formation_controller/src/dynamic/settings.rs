//! Parameters of the dynamic laws.

use super::DynamicLaw;
use super::trench::{SHAPES, named};
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_formation::laws::{Capability, GoalTracking, NearestAttraction, ZonedAttraction};
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::trench::{ConstantDamping, CriticallyDamped, HyperbolicDamping, check_admissibility};
use trench_formation::zoning::{Edge, ObstaclePotential, Radii, Sharpness, Zoning};

/// What encroaches on a robot's segment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encroaching {
    Nothing,
    Obstacles,
    ObstaclesAndRobots,
}

/// A dynamic law with all it needs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DynamicSettings {
    pub(crate) law: DynamicLaw,
    /// m, from the axle forward to the point that is steered.
    pub(crate) look_ahead: f64,
    pub(crate) capability: Capability,
    pub(crate) zoning: Zoning,
    pub(crate) potential: ObstaclePotential,
    pub(crate) clearance: f64,
    pub(crate) seeking: SeekSettings,
    pub(crate) encroaching: Encroaching,
    /// m/s, below which a robot that has arrived rests.
    pub(crate) rest_speed: f64,
    /// s, for which a robot ahead that is silent is believed to go on.
    pub(crate) leader_age: f64,
    /// Whether the safety filter leads the robot round what blocks its way to the point that draws it.
    pub(crate) detours: bool,
}

/// Chains with less damping than this (1/s) and none towards their leaders whip (6.5, 7.10).
const LEAST_CHAIN_DAMPING: f64 = 2.0;

/// Trenches are looked at up to this distance, m.
const TRENCH_RANGE: f64 = 100.0;

pub(crate) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    vec![
        P::double("look_ahead", 0.05, "m, from the axle to the point that dynamic laws steer").range(0.005, 1.0),
        P::double("motion.speed", 0.2, "m/s, of that point under dynamic laws").range(0.001, 10.0),
        P::double("motion.acceleration", 0.35, "m/s^2, of that point").range(0.001, 100.0),
        P::double("motion.rest_speed", 0.004, "m/s, slower than this the robot rests").range(0.0, 1.0),
        P::string("trench.shape", "hyperbolic", "Phi: hyperbolic, quadratic, saturated, conic, square_root"),
        P::double("trench.alpha", 0.3, "m/s^2, pull of the trench far from its bottom").range(1e-6, 1e6),
        P::double("trench.a", 0.3, "m, width of its bottom").range(1e-6, 1e6),
        P::double("damping", 2.0, "1/s, k").range(0.0, 1000.0),
        P::double("leader_damping", 0.0, "1/s, c: damping relative to the leader besides").range(0.0, 1000.0),
        P::double_list("zones.radii", &[0.20, 0.26, 0.34, 0.45, 1.2], "m, borders of the five zones (Figure 6.1)"),
        P::double("zones.repulsion", 0.001, "m^3/s^2, alpha of Psi_hat").range(1e-9, 1e9),
        P::double("zones.attraction", 0.002, "m^3/s^2, beta of Psi_check").range(1e-9, 1e9),
        P::bool("zones.continuous", true, "forces begin at 0 at the edge of a zone; false: they jump, as printed"),
        P::double("zones.full_acceleration", 0.6, "m/s^2, beyond the poles and at most").range(1e-6, 1e9),
        P::double("obstacles.pole", 0.14, "m, gap between the steered point and an obstacle at the pole")
            .range(0.0, 1e6),
        P::double("obstacles.cut", 0.26, "m, gap at which the repulsion begins").range(0.0, 1e6),
        P::double("obstacles.strength", 0.002, "m^3/s^2").range(1e-9, 1e9),
        P::double("obstacles.clearance", 0.3, "m, robots ahead join hulls that are nearer than this (7.8)")
            .range(0.0, 1e6),
        P::string("encroaching", "obstacles", "what encroaches on the segment: nothing, obstacles, robots (both)"),
        P::double("seek.room", 0.1, "m, shorter fragments do not qualify").range(0.0, 1e6),
        P::double("seek.transit_margin", 0.05, "m, by which another nearest point must be nearer").range(0.0, 1e6),
        P::double("seek.settled_distance", 0.05, "m, a leader this near to its segment has settled").range(1e-6, 1e6),
        P::double("seek.settled_speed", 0.03, "m/s, and no faster than this").range(1e-6, 1e6),
        P::bool("seek.whole_while_far", true, "the whole segment counts while the leader is in zone 4 or farther"),
        P::bool("safety.detours", true, "under dynamic laws the safety filter leads round what blocks the way too"),
        P::double("age.leader", 0.4, "s, a silent robot ahead is believed to go on; then the follower slows and stops")
            .range(0.01, 10.0),
    ]
}

impl DynamicSettings {
    /// The settings, if `law` names a dynamic law.
    pub(crate) fn read(parameters: &Parameters) -> Result<Option<Self>, ConfigError> {
        let double = |name: &str| parameters.f64(name);
        let Some(law) = law(parameters)? else { return Ok(None) };
        let seeking = SeekSettings {
            room: double("seek.room")?,
            transit_margin: double("seek.transit_margin")?,
            settled_distance: double("seek.settled_distance")?,
            settled_speed: double("seek.settled_speed")?,
            leader_rule: if parameters.bool("seek.whole_while_far")? {
                LeaderRule::WholeSegmentWhileFar
            } else {
                LeaderRule::StepSix
            },
        };
        let capability = Capability { speed: double("motion.speed")?, acceleration: double("motion.acceleration")? };
        Ok(Some(Self {
            law,
            look_ahead: double("look_ahead")?,
            capability,
            zoning: zoning(parameters)?,
            potential: potential(parameters)?,
            clearance: double("obstacles.clearance")?,
            seeking,
            encroaching: encroaching(parameters)?,
            rest_speed: double("motion.rest_speed")?,
            leader_age: double("age.leader")?,
            detours: parameters.bool("safety.detours")?,
        }))
    }
}

fn law(parameters: &Parameters) -> Result<Option<DynamicLaw>, ConfigError> {
    let double = |name: &str| parameters.f64(name);
    let (alpha, a, damping) = (double("trench.alpha")?, double("trench.a")?, double("damping")?);
    let leader_damping = double("leader_damping")?;
    let trench = named(parameters.str("trench.shape")?, alpha, a)
        .ok_or_else(|| parameters.error("trench.shape", "is no trench", SHAPES))?;
    let tracking = || GoalTracking { trench: trench.clone(), damping: ConstantDamping { coefficient: damping } };
    let nearest = || NearestAttraction { trench: trench.clone(), damping, leader_damping };
    let law = match parameters.str("law")? {
        "goal" => DynamicLaw::Goal(tracking()),
        "goal_damped" => {
            let damping = HyperbolicDamping { alpha: 2.0 * damping, a };
            DynamicLaw::GoalDamped(GoalTracking { trench: CriticallyDamped(damping), damping })
        }
        "goal_at_rest" => DynamicLaw::GoalAtRest(tracking()),
        "zoned" => {
            let zoning = zoning(parameters)?;
            DynamicLaw::Zoned(ZonedAttraction {
                trench: trench.clone(),
                zoning,
                damping,
                leader_damping,
                compensates: true,
            })
        }
        "nearest" => DynamicLaw::Nearest(nearest()),
        "chain" => DynamicLaw::Chain(nearest()),
        _ => return Ok(None),
    };
    check_admissibility(&trench, TRENCH_RANGE).map_err(|error| {
        let problem = format!("is not admissible for {} (Definition 5.2.1): {error}", law.equation());
        parameters.error("trench.shape", problem, SHAPES)
    })?;
    if damping <= 0.0 {
        let problem =
            format!("law {} needs k > 0: without it V' = -k |d'|^2 is 0 and robots swing for ever", law.equation());
        return Err(parameters.error("damping", problem, "write 2.0"));
    }
    Ok(Some(law))
}

/// Whether chains are damped enough; else the refusal.
///
/// # Errors
/// When they are not, with the equation and what would do.
pub(crate) fn check_damping(parameters: &Parameters, law: &DynamicLaw) -> Result<(), ConfigError> {
    let (damping, leader) = (parameters.f64("damping")?, parameters.f64("leader_damping")?);
    if !law.is_chained() || damping >= LEAST_CHAIN_DAMPING || leader >= 1.0 {
        return Ok(());
    }
    let equation = law.equation();
    let problem =
        format!("{equation} with k = {damping} < 2: chains whip against the walls of their zones (6.5, 7.10)");
    let remedy =
        "write 2.0 or more, or leader_damping 1.0 or more, or set refuse_unstable_gains to false to be warned only";
    Err(parameters.error("damping", problem, remedy))
}

fn edge(parameters: &Parameters) -> Result<Edge, ConfigError> {
    Ok(if parameters.bool("zones.continuous")? { Edge::Continuous } else { Edge::Jump })
}

fn zoning(parameters: &Parameters) -> Result<Zoning, ConfigError> {
    let [underbar, hat, rho, check, bar] = parameters.f64_array("zones.radii")?;
    let remedy = "write rho_underbar < rho_hat < rho < rho_check <= rho_bar, for example [0.20, 0.26, 0.34, 0.45, 1.2]";
    let radii = Radii::new(underbar, hat, rho, check, bar)
        .map_err(|error| parameters.error("zones.radii", error.to_string(), remedy))?;
    let strength = (parameters.f64("zones.repulsion")?, parameters.f64("zones.attraction")?);
    let full = parameters.f64("zones.full_acceleration")?;
    Zoning::new(radii, strength, Sharpness::One, edge(parameters)?, full)
        .map_err(|error| parameters.error("zones.repulsion", error.to_string(), "write a positive number"))
}

fn potential(parameters: &Parameters) -> Result<ObstaclePotential, ConfigError> {
    let (pole, cut) = (parameters.f64("obstacles.pole")?, parameters.f64("obstacles.cut")?);
    let (strength, full) = (parameters.f64("obstacles.strength")?, parameters.f64("zones.full_acceleration")?);
    ObstaclePotential::new(pole, cut, strength, Sharpness::One, edge(parameters)?, full)
        .map_err(|error| parameters.error("obstacles.cut", error.to_string(), format!("write more than {pole}")))
}

fn encroaching(parameters: &Parameters) -> Result<Encroaching, ConfigError> {
    match parameters.str("encroaching")? {
        "nothing" => Ok(Encroaching::Nothing),
        "obstacles" => Ok(Encroaching::Obstacles),
        "robots" => Ok(Encroaching::ObstaclesAndRobots),
        _ => Err(parameters.error("encroaching", "is nothing that encroaches", "write nothing, obstacles or robots")),
    }
}
