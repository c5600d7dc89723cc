//! Parameters of the dynamic laws.

use super::DynamicLaw;
use super::potentials::{self, potential, zoning};
use super::remedies::{self, remedies};
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_formation::agent::{Action, AgentSettings, Encroaching};
use trench_formation::laws::{Capability, NearestAttraction, QueueFollowing};
use trench_formation::seek::{LeaderRule, SeekSettings};
use trench_formation::stability::{Coupling, InputToState, input_to_state};
use trench_formation::trench::{AnyTrench, check_admissibility};
use trench_formation::zoning::{ObstaclePotential, Zoning};
use trench_plan::{TRENCH_RANGE, TRENCH_SHAPES, trench_from_parameters};

/// A dynamic law with all it needs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DynamicSettings {
    pub(crate) law: DynamicLaw,
    pub(crate) agent: AgentSettings<AnyTrench>,
    /// m, from the axle forward to the point that is steered.
    pub(crate) look_ahead: f64,
    pub(crate) capability: Capability,
    /// m/s, below which a robot that has arrived rests.
    pub(crate) rest_speed: f64,
    /// s, for which a robot ahead that is silent is believed to go on.
    pub(crate) leader_age: f64,
    /// a and b of (8.26) for a robot of a chain under the queue law; none under other laws.
    pub(crate) growth: Option<InputToState>,
    /// Whether the safety filter leads the robot round what blocks its way to the point that draws it.
    pub(crate) detours: bool,
}

/// Chains with less damping than this (1/s) and none towards their leaders whip (6.5, 7.10).
const LEAST_CHAIN_DAMPING: f64 = 2.0;

/// Of A.19, as `trench check` has it.
const THETA: f64 = 0.5;

pub(crate) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    let mut all = vec![
        P::double("look_ahead", 0.05, "m, from the axle to the point that dynamic laws steer").range(0.005, 1.0),
        P::double("motion.speed", 0.2, "m/s, of that point relative to the segment").range(0.001, 10.0),
        P::double("motion.acceleration", 0.35, "m/s^2, of that point relative to the segment").range(0.001, 100.0),
        P::double("motion.rest_speed", 0.004, "m/s, slower than this the robot rests").range(0.0, 1.0),
        P::string(
            "trench.shape",
            "hyperbolic",
            "Phi: hyperbolic, quadratic, saturated, conic, square_root, critical (for damping), or written: table, potential, slope",
        ),
        P::double("trench.alpha", 0.3, "m/s^2, pull of the trench far from its bottom").range(1e-6, 1e6),
        P::double("trench.a", 0.3, "m, width of its bottom").range(1e-6, 1e6),
        P::string(
            "trench.formula",
            "0.3*(sqrt(x^2 + 0.09) - 0.3)",
            "in x (m): Phi (shape potential, m^2/s^2) or its slope (m/s^2)",
        ),
        P::double_list(
            "trench.table",
            &[0.0, 0.0, 0.3, 0.3],
            "shape table: pairs of x (m) and slope (m/s^2), straight between them",
        ),
        P::double("damping", 2.0, "1/s, k").range(0.0, 1000.0),
        P::double("queue.position_gain", 1.0, "1/s^2, first element of K of (8.11)").range(1e-6, 1000.0),
        P::double("queue.velocity_gain", 2.0, "1/s, second element of K of (8.11)").range(1e-6, 1000.0),
        P::double("leader_damping", 0.0, "1/s, c: damping relative to the leader besides").range(0.0, 1000.0),
        P::double_list(
            "zoned.direction",
            &[],
            "direction of attraction of (6.1) in the segment's frame; []: across the segment",
        ),
        P::bool("zoned.compensates", true, "the delta terms of (6.1), which oblique directions need"),
        P::string(
            "encroaching",
            "obstacles",
            "what takes parts of the segment away: nothing, obstacles, robots (both), robots_apart (both, and a robot joins what is near of obstacles, no whole walls), places (obstacles, and where robots ahead mean to stand)",
        ),
        P::double("seek.room", 0.1, "m, shorter fragments do not qualify").range(0.0, 1e6),
        P::double("seek.transit_margin", 0.05, "m, by which another nearest point must be nearer").range(0.0, 1e6),
        P::double("seek.settled_distance", 0.05, "m, a leader this near to its segment has settled").range(1e-6, 1e6),
        P::double("seek.settled_speed", 0.03, "m/s, and no faster than this").range(1e-6, 1e6),
        P::bool("seek.whole_while_far", true, "the whole segment counts while the leader is in zone 4 or farther"),
        P::bool("safety.detours", true, "under dynamic laws the safety filter leads round what blocks the way too"),
        P::double("age.leader", 0.4, "s, a silent robot ahead is believed to go on; then the follower slows and stops")
            .range(0.01, 10.0),
    ];
    all.extend(potentials::descriptors());
    all.extend(remedies::descriptors());
    all
}

impl DynamicSettings {
    /// The speed (m/s, relative to the segment) at which the trench's pull and the damping balance, within the limits.
    pub(crate) fn pace(&self, action: &Action, follows: bool) -> f64 {
        let law = &self.agent.law;
        let damping = if follows { law.damping + law.leader_damping } else { law.damping };
        (action.forces.trench.norm().min(self.capability.acceleration) / damping).min(self.capability.speed)
    }

    /// The settings, if `law` names a dynamic law.
    pub(crate) fn read(parameters: &Parameters) -> Result<Option<Self>, ConfigError> {
        let Some(law) = DynamicLaw::named(parameters.str("law")?) else { return Ok(None) };
        let double = |name: &str| parameters.f64(name);
        let capability = Capability { speed: double("motion.speed")?, acceleration: double("motion.acceleration")? };
        let (zoning, potential) = (zoning(parameters)?, potential(parameters)?);
        let agent = AgentSettings {
            law: NearestAttraction {
                trench: trench(law, parameters)?,
                damping: damping(law, parameters)?,
                leader_damping: double("leader_damping")?,
            },
            method: law.method(parameters)?,
            zoning,
            potential,
            clearance: double("obstacles.clearance")?,
            seeking: seeking(parameters)?,
            encroaching: encroaching(parameters, &zoning, &potential)?,
            remedies: remedies(parameters)?,
            limits: Some(capability),
            sidesteps: parameters.bool("remedies.sidesteps")?,
        };
        Ok(Some(Self {
            law,
            agent,
            look_ahead: double("look_ahead")?,
            capability,
            rest_speed: double("motion.rest_speed")?,
            leader_age: double("age.leader")?,
            growth: growth(law, parameters)?,
            detours: parameters.bool("safety.detours")?,
        }))
    }
}

fn trench(law: DynamicLaw, parameters: &Parameters) -> Result<AnyTrench, ConfigError> {
    let trench = match law.own_trench(parameters)? {
        Some(trench) => trench,
        None => trench_from_parameters(parameters)?,
    };
    check_admissibility(&trench, TRENCH_RANGE).map_err(|error| {
        let problem = format!("is not admissible for {} (Definition 5.2.1): {error}", law.equation());
        parameters.error("trench.shape", problem, TRENCH_SHAPES)
    })?;
    Ok(trench)
}

fn damping(law: DynamicLaw, parameters: &Parameters) -> Result<f64, ConfigError> {
    let damping = law.damping(parameters)?;
    if damping <= 0.0 {
        let problem =
            format!("law {} needs k > 0: without it V' = -k |d'|^2 is 0 and robots swing for ever", law.equation());
        return Err(parameters.error("damping", problem, "write 2.0"));
    }
    Ok(damping)
}

/// Whether chains are damped enough; else the refusal.
///
/// # Errors
/// When they are not, with the equation and what would do.
pub(crate) fn check_damping(parameters: &Parameters, settings: &DynamicSettings) -> Result<(), ConfigError> {
    let law = &settings.agent.law;
    if !settings.law.is_zoned() || law.damping >= LEAST_CHAIN_DAMPING || law.leader_damping >= 1.0 {
        return Ok(());
    }
    let (equation, damping) = (settings.law.equation(), law.damping);
    let problem =
        format!("{equation} with k = {damping} < 2: chains whip against the walls of their zones (6.5, 7.10)");
    let remedy =
        "write 2.0 or more, or leader_damping 1.0 or more, or set refuse_unstable_gains to false to be warned only";
    Err(parameters.error("damping", problem, remedy))
}

/// Of the second robot of a chain whose robots all have these gains: the first has the same a, and nobody ahead.
fn growth(law: DynamicLaw, parameters: &Parameters) -> Result<Option<InputToState>, ConfigError> {
    if law != DynamicLaw::Queue {
        return Ok(None);
    }
    let gains = ("queue.position_gain", "queue.velocity_gain");
    let queue = QueueFollowing { position_gain: parameters.f64(gains.0)?, velocity_gain: parameters.f64(gains.1)? };
    let bounds = input_to_state(&[queue.model(), queue.model()], Coupling::Realisable, THETA);
    let refuse = |problem: String| parameters.error(gains.1, problem, "write a positive gain, for example 2.0");
    Ok(bounds.map_err(|error| refuse(error.to_string()))?.last().copied())
}

fn seeking(parameters: &Parameters) -> Result<SeekSettings, ConfigError> {
    let double = |name: &str| parameters.f64(name);
    Ok(SeekSettings {
        room: double("seek.room")?,
        transit_margin: double("seek.transit_margin")?,
        settled_distance: double("seek.settled_distance")?,
        settled_speed: double("seek.settled_speed")?,
        leader_rule: if parameters.bool("seek.whole_while_far")? {
            LeaderRule::WholeSegmentWhileFar
        } else {
            LeaderRule::StepSix
        },
    })
}

fn encroaching(
    parameters: &Parameters,
    zoning: &Zoning,
    potential: &ObstaclePotential,
) -> Result<Encroaching, ConfigError> {
    match parameters.str("encroaching")? {
        "nothing" => Ok(Encroaching::Nothing),
        "obstacles" => Ok(Encroaching::Obstacles),
        "robots" => Ok(Encroaching::ObstaclesAndRobots(parameters.f64("body.radius")?)),
        "robots_apart" => Ok(Encroaching::ObstaclesAndRobotsApart(parameters.f64("body.radius")?)),
        // With the obstacles' cut about it a place takes all of its zone 2.
        "places" => Ok(Encroaching::ObstaclesAndPlaces((zoning.radii().rho_hat - potential.cut()).max(0.0))),
        _ => Err(parameters.error(
            "encroaching",
            "is nothing that encroaches",
            "write nothing, obstacles, robots, robots_apart or places",
        )),
    }
}
