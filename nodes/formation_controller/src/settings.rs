//! The controller's parameters.

use crate::Law;
use crate::dynamic::{self, DynamicSettings, check_damping};
use crate::face::Faces;
use crate::monitor::{self, MonitorSettings};
use std::sync::Arc;
use trench_config::{ConfigError, ParameterDescriptor, Parameters};
use trench_formation::Vector2;
use trench_formation::kinematics::{Axle, Ramp};
use trench_formation::laws::{DeadBand, Direct, Family, Nominal, Robust, Tracking};
use trench_formation::safety::{SafetyFilter, SafetyParameters};
use trench_formation::stability::StableZone;

/// Everything a tick needs to know that does not change from tick to tick.
#[derive(Debug, Clone)]
pub(crate) struct Settings {
    pub(crate) robot: String,
    pub(crate) team: Vec<String>,
    /// The parameter `law`.
    pub(crate) law_name: String,
    pub(crate) law: Law,
    /// The dynamic law, if `law` names one.
    pub(crate) dynamic: Option<Arc<DynamicSettings>>,
    pub(crate) dead_band: DeadBand,
    pub(crate) axle: Axle,
    pub(crate) max_wheel_speed: f64,
    pub(crate) ramp: Ramp,
    pub(crate) command_delay: f64,
    pub(crate) use_measured_delay: bool,
    pub(crate) pose_age_limit: f64,
    pub(crate) information_age_limit: f64,
    pub(crate) goal_age_limit: f64,
    pub(crate) obstacle_age_limit: f64,
    pub(crate) leader_state_age_limit: f64,
    /// Silence of the whole queue after which the robot looks for it, s.
    pub(crate) team_age_limit: f64,
    /// Whether the radio's reach decides whose leader states count.
    pub(crate) team_link_by_radio: bool,
    pub(crate) watchdog: f64,
    pub(crate) needs_mapper: bool,
    pub(crate) safety_enabled: bool,
    pub(crate) safety: SafetyFilter,
    /// s, the longest for which a command may act.
    pub(crate) period: f64,
    pub(crate) body_radius: f64,
    pub(crate) field: Vec<Vector2<f64>>,
    pub(crate) stamped: bool,
    /// When the robot turns the way the formation faces.
    pub(crate) faces: Faces,
    pub(crate) monitor: MonitorSettings,
    /// s, between two pictures; 0: none.
    pub(crate) picture_period: f64,
}

/// The names `law` may have.
const LAWS: &str = "one of: robust (3.13), nominal (3.10), direct (3.9), family (4.4), goal (5.1), goal_damped (5.2), \
                    goal_at_rest (5.3), zoned (6.1), nearest (7.4), chain (7.13), queue (8.11)";

pub(crate) fn descriptors() -> Vec<ParameterDescriptor> {
    use ParameterDescriptor as P;
    let mut all = vec![
        P::string("robot", "", "name of the robot; empty: the namespace without its slash").read_only(),
        P::string_list("team", &[], "names of all robots whose leader states are heard").read_only(),
        P::string("law", "robust", LAWS),
        P::bool("feed_forward", true, "feed the goal point's velocity forward (robust alone)"),
        P::double("gains.k1", 1.0, "1/s, gain K1").range(0.0, 20.0),
        P::double("gains.k2", 2.5, "1/s, gain K2").range(-20.0, 20.0),
        P::double("gains.k3", 1.2, "1/s, gain K3 of (3.13)").range(-100.0, 100.0),
        P::integer("family.n", 0, "exponent n of (4.4)").range(0.0, 8.0),
        P::integer("family.p", 0, "exponent p of (4.4)").range(0.0, 8.0),
        P::integer("family.q", 0, "exponent q of (4.4); 1 and more do not reach the goal").range(0.0, 8.0),
        P::integer("family.s", 0, "exponent s of (4.4)").range(0.0, 8.0),
        P::bool("refuse_unstable_gains", true, "refuse gains outside the stable zone of 4.3.1; false: warn"),
        P::double("dead_band.hold", 0.003, "m, the robot rests nearer to its goal than this").range(0.0, 1.0),
        P::double("dead_band.resume", 0.006, "m, and drives again beyond this").range(0.0, 1.0),
        P::double("body.half_axle", 0.06, "m, Cd: wheel to the middle of the axle").range(0.001, 1.0),
        P::double("body.radius", 0.08, "m, of the disc that holds the robot").range(0.001, 1.0),
        P::double("wheels.max_speed", 0.29, "m/s, a wheel's largest speed").range(0.001, 10.0),
        P::double("wheels.pull_in_speed", 0.08, "m/s, up to which a wheel starts, stops and turns back at once")
            .range(0.0, 10.0),
        P::double("wheels.acceleration", 0.45, "m/s^2, a wheel's largest acceleration above it").range(0.01, 100.0),
        P::double("delay.command", 0.012, "s, from sending a command to the wheels obeying it").range(0.0, 1.0),
        P::bool(
            "delay.use_measured",
            true,
            "take the delay of the whole loop from /loop_delay, once the localizer knows it",
        ),
        P::double("age.pose", 0.12, "s, the oldest pose that may drive the robot").range(0.001, 10.0),
        P::double("age.information", 0.25, "s, since the robot was seen last: it is carried forward no longer")
            .range(0.001, 10.0),
        P::double("age.goal", 0.45, "s, silence of /goals after which the robot stops").range(0.001, 10.0),
        P::double("age.obstacles", 0.45, "s, silence of the mapper after which the robot stops").range(0.001, 10.0),
        P::double("age.leader_state", 0.3, "s, silence after which another robot counts as an obstacle")
            .range(0.001, 10.0),
        P::double("age.team", 1.0, "s, silence of its whole queue after which a follower looks for it (Remark 6.2.1)")
            .range(0.001, 60.0),
        P::string(
            "team_link",
            "radio",
            "radio: leader states count within the robot's radio reach; network: if they come",
        )
        .read_only(),
        P::double("watchdog", 0.05, "s, silence of /team_state after which the last one is used again")
            .range(0.001, 1.0),
        P::bool("safety.enabled", true, "pass commands through the safety filter; false only on an ideal bed"),
        P::bool("safety.needs_mapper", true, "stop while no obstacle mapper is heard"),
        P::double("safety.delay", 0.06, "s, from an exposure to the moment its command acts").range(0.0, 1.0),
        P::double("safety.period", 0.04, "s, for which a command acts: the longest interval between ticks")
            .range(0.001, 1.0),
        P::double("safety.braking", 0.4, "m/s^2, deceleration the wheels can always hold").range(0.01, 100.0),
        P::double("safety.detour_speed", 0.08, "m/s, least speed on a way round a blockage").range(0.001, 10.0),
        P::double("safety.margin", 0.01, "m, kept besides the rule, for errors of the vision").range(0.0, 1.0),
        P::double_list(
            "field",
            &[0.0, 0.0, 2.48, 1.83],
            "m, the field: x and y of its low corner, then of its high one",
        ),
        P::double("markers.period", 0.4, "s, between two pictures on /markers under dynamic laws; 0: none")
            .range(0.0, 60.0),
        P::string(
            "face",
            "anywhere",
            "which way a robot at rest faces: anywhere; formation: as that does, once it rests, too; arrived: so, if it has moved before",
        ),
        P::bool("stamped", true, "send geometry_msgs/TwistStamped; false: Twist").read_only(),
    ];
    all.extend(dynamic::descriptors());
    all.extend(monitor::descriptors());
    all
}

impl Settings {
    /// m, from the axle forward to the point that the law drives: 0 under the laws of chapter 4.
    pub(crate) fn look_ahead(&self) -> f64 {
        self.dynamic.as_ref().map_or(0.0, |settings| settings.look_ahead)
    }

    pub(crate) fn read(parameters: &Parameters, namespace: &str) -> Result<Self, ConfigError> {
        let double = |name: &str| parameters.f64(name);
        let robot = match parameters.str("robot")? {
            "" => namespace.trim_matches('/').to_owned(),
            name => name.to_owned(),
        };
        if robot.is_empty() {
            let remedy = "start the node in the robot's namespace (-r __ns:=/robot1) or set robot";
            return Err(parameters.error("robot", "the controller does not know its robot", remedy));
        }
        let dead_band = DeadBand { hold: double("dead_band.hold")?, resume: double("dead_band.resume")? };
        if dead_band.resume < dead_band.hold {
            let remedy = format!("set it to {} or more", dead_band.hold);
            return Err(parameters.error("dead_band.resume", "is smaller than dead_band.hold", remedy));
        }
        Ok(Self {
            robot,
            team: parameters.names("team")?.to_vec(),
            law_name: parameters.str("law")?.to_owned(),
            law: law(parameters, dead_band)?,
            dynamic: DynamicSettings::read(parameters)?.map(Arc::new),
            dead_band,
            axle: Axle { half_track: double("body.half_axle")? },
            max_wheel_speed: double("wheels.max_speed")?,
            ramp: Ramp { pull_in_speed: double("wheels.pull_in_speed")?, acceleration: double("wheels.acceleration")? },
            command_delay: double("delay.command")?,
            use_measured_delay: parameters.bool("delay.use_measured")?,
            pose_age_limit: double("age.pose")?,
            information_age_limit: double("age.information")?,
            goal_age_limit: double("age.goal")?,
            obstacle_age_limit: double("age.obstacles")?,
            leader_state_age_limit: double("age.leader_state")?,
            team_age_limit: double("age.team")?,
            team_link_by_radio: by_radio(parameters)?,
            watchdog: double("watchdog")?,
            needs_mapper: parameters.bool("safety.needs_mapper")?,
            safety_enabled: parameters.bool("safety.enabled")?,
            safety: safety(parameters)?,
            period: double("safety.period")?,
            body_radius: double("body.radius")?,
            field: field(parameters)?,
            stamped: parameters.bool("stamped")?,
            faces: faces(parameters)?,
            monitor: MonitorSettings::read(parameters)?,
            picture_period: double("markers.period")?,
        })
    }
}

fn law(parameters: &Parameters, dead_band: DeadBand) -> Result<Law, ConfigError> {
    let (k1, k2, k3) = (parameters.f64("gains.k1")?, parameters.f64("gains.k2")?, parameters.f64("gains.k3")?);
    let exponent = |name: &str| parameters.i64(name).map(|value| value.unsigned_abs() as u32);
    let law = match parameters.str("law")? {
        "direct" => Law::Direct(Direct { k1, k2 }),
        "nominal" => Law::Nominal(Nominal { k1, k2 }),
        "family" => Law::Family(Family {
            k1,
            k2,
            n: exponent("family.n")?,
            p: exponent("family.p")?,
            q: exponent("family.q")?,
            s: exponent("family.s")?,
        }),
        "robust" if parameters.bool("feed_forward")? => {
            Law::Tracking(Tracking { gains: Robust { k1, k2, k3 }, dead_band })
        }
        "robust" => Law::Robust(Robust { k1, k2, k3 }),
        // Not in force while a dynamic law is.
        "goal" | "goal_damped" | "goal_at_rest" | "zoned" | "nearest" | "chain" | "queue" => {
            Law::Nominal(Nominal { k1, k2 })
        }
        _ => return Err(parameters.error("law", "is no law", LAWS)),
    };
    Ok(law)
}

fn by_radio(parameters: &Parameters) -> Result<bool, ConfigError> {
    match parameters.str("team_link")? {
        "radio" => Ok(true),
        "network" => Ok(false),
        _ => Err(parameters.error("team_link", "is no team link", "write radio or network")),
    }
}

fn faces(parameters: &Parameters) -> Result<Faces, ConfigError> {
    match parameters.str("face")? {
        "anywhere" => Ok(Faces::Never),
        "formation" => Ok(Faces::AtRest),
        "arrived" => Ok(Faces::Arrived),
        _ => Err(parameters.error("face", "says no way to face", "write anywhere, formation or arrived")),
    }
}

fn safety(parameters: &Parameters) -> Result<SafetyFilter, ConfigError> {
    let double = |name: &str| parameters.f64(name);
    let filter = SafetyFilter::new(SafetyParameters {
        radius: double("body.radius")?,
        half_axle: double("body.half_axle")?,
        delay: double("safety.delay")?,
        period: double("safety.period")?,
        braking: double("safety.braking")?,
        margin: double("safety.margin")?,
        detour_speed: double("safety.detour_speed")?,
    });
    filter.map_err(|error| {
        parameters.error(&format!("safety.{}", error.name), error.to_string(), format!("make it {}", error.expected))
    })
}

fn field(parameters: &Parameters) -> Result<Vec<Vector2<f64>>, ConfigError> {
    let [low_x, low_y, high_x, high_y] = parameters.f64_array("field")?;
    if high_x <= low_x || high_y <= low_y {
        return Err(parameters.error("field", "has no area", "write the low corner first: [0.0, 0.0, 2.48, 1.83]"));
    }
    let corner = Vector2::new;
    Ok(vec![corner(low_x, low_y), corner(high_x, low_y), corner(high_x, high_y), corner(low_x, high_y)])
}

/// Whether the gains lie in the stable zone of 4.3.1 (for (3.9), (3.10) and (4.4): K2 > 0); else the refusal.
///
/// # Errors
/// When they do not, with the bound, its equation, and the nearest admissible gain.
pub(crate) fn check_gains(parameters: &Parameters, settings: &Settings) -> Result<(), ConfigError> {
    if let Some(dynamic) = &settings.dynamic {
        return check_damping(parameters, dynamic);
    }
    let (k1, k2) = (parameters.f64("gains.k1")?, parameters.f64("gains.k2")?);
    let k3 = if parameters.str("law")? == "robust" { parameters.f64("gains.k3")? } else { k1 };
    let Err(violation) = StableZone::check(Robust { k1, k2, k3 }) else { return Ok(()) };
    let key = format!("gains.{}", violation.gain().to_lowercase());
    let remedy = match violation.nearest() {
        Some(gain) => format!("write {gain:.4}, or set refuse_unstable_gains to false to be warned only"),
        None => "write a finite number".to_owned(),
    };
    Err(parameters.error(&key, violation.to_string(), remedy))
}
