//! Files that say what goes wrong on the bed, and when (docs/nodes/testbed.md).
//!
//! ```yaml
//! faults:
//!   - {kind: slip, from: 10.0, to: 15.0, robots: [robot2], left: 0.0, right: 0.0}
//!   - {kind: frozen, from: 20.0, to: 20.5}
//! ```

use trench_config::{ConfigError, yaml, yaml::Map};
use trench_optics::Pose2;
use trench_sim::{Fault, FaultKind, Faults, FrameFault, Intrusion};

/// Kinds with a name in files.
const KINDS: [&str; 23] = [
    "slip",
    "carried",
    "battery",
    "silent",
    "parted",
    "loss",
    "covered",
    "stopped",
    "frozen",
    "black",
    "half",
    "late",
    "every",
    "far",
    "forged",
    "replayed",
    "corrupted",
    "missed",
    "switched_off",
    "doubled",
    "recorded",
    "untold",
    "blind",
];

/// Reads the text of such a file; `file` names it in errors.
pub(crate) fn parse(file: &str, text: &str, names: &[String]) -> Result<Faults, ConfigError> {
    let root = yaml::parse(file, text)?;
    let top = root.map()?;
    let faults = top.list("faults")?.iter().map(|node| fault(&node.map()?, names)).collect::<Result<_, _>>()?;
    top.finish()?;
    Ok(Faults::new(faults))
}

fn fault(map: &Map<'_>, names: &[String]) -> Result<Fault, ConfigError> {
    let (from, to) = (map.f64("from")?, map.f64("to")?);
    if !(from >= 0.0 && to > from && to.is_finite()) {
        return Err(map.error("to", "is not after from, or from is before the start", "write seconds, from < to"));
    }
    let kind = match map.str("kind")? {
        "slip" => FaultKind::Slip { robots: robots(map, names)?, grip: [share(map, "left")?, share(map, "right")?] },
        "carried" => {
            let [x, y, theta]: [f64; 3] = map.get("pose")?;
            if !(x + y + theta).is_finite() {
                return Err(map.error("pose", "is not finite", "write x, y (m) and heading (rad)"));
            }
            let name = map.str("robot")?;
            FaultKind::Carried { robot: index(map, "robot", name, names)?, pose: Pose2 { x, y, theta } }
        }
        "battery" => {
            let volts = map.f64("volts")?;
            if !(0.0..=65.0).contains(&volts) {
                return Err(map.error("volts", "is no such battery's voltage", "write 0 to 65"));
            }
            FaultKind::Battery { robots: robots(map, names)?, millivolts: (1e3 * volts) as u16 }
        }
        "silent" => FaultKind::Silent { robots: robots(map, names)? },
        "parted" => FaultKind::Parted { robots: robots(map, names)? },
        "far" => FaultKind::Far { robots: robots(map, names)? },
        "forged" => FaultKind::Intruder(Intrusion::Forged),
        "replayed" => FaultKind::Intruder(Intrusion::Replayed),
        "corrupted" => FaultKind::Intruder(Intrusion::Corrupted),
        "recorded" => FaultKind::Intruder(Intrusion::Recorded),
        "switched_off" => FaultKind::Off { robots: robots(map, names)? },
        "doubled" => {
            let (robot, like) = (map.str("robot")?, map.str("like")?);
            FaultKind::Doubled { robot: index(map, "robot", robot, names)?, like: index(map, "like", like, names)? }
        }
        "missed" => FaultKind::Missed { robots: robots(map, names)?, share: share(map, "share")? },
        "loss" => FaultKind::Loss { loss: share(map, "loss")? },
        "covered" => FaultKind::Covered { robots: robots(map, names)? },
        "stopped" => FaultKind::Frames(FrameFault::Stopped),
        "frozen" => FaultKind::Frames(FrameFault::Frozen),
        "black" => FaultKind::Frames(FrameFault::Black),
        "half" => FaultKind::Frames(FrameFault::Half),
        "late" => {
            let delay = map.f64("delay")?;
            if !(0.0..=10.0).contains(&delay) {
                return Err(map.error("delay", "is no delay of a frame", "write 0 to 10 s"));
            }
            FaultKind::Frames(FrameFault::Late((1e9 * delay) as u64))
        }
        "every" => {
            let frames: i64 = map.get("frames")?;
            let frames = u64::try_from(frames).ok().filter(|frames| *frames > 0);
            let frames = frames.ok_or_else(|| map.error("frames", "is not positive", "write 6: each sixth comes"))?;
            FaultKind::Frames(FrameFault::Every(frames))
        }
        "untold" => FaultKind::Untold,
        "blind" => FaultKind::Blind { robots: robots(map, names)? },
        _ => return Err(map.error("kind", "is no fault", format!("write one of {}", KINDS.join(", ")))),
    };
    map.finish()?;
    let nanoseconds = |seconds: f64| (1e9 * seconds) as u64;
    Ok(Fault { from: nanoseconds(from), to: nanoseconds(to), kind })
}

fn robots(map: &Map<'_>, names: &[String]) -> Result<Vec<usize>, ConfigError> {
    let robots: Vec<String> = map.get("robots")?;
    robots.iter().map(|name| index(map, "robots", name, names)).collect()
}

fn index(map: &Map<'_>, key: &str, name: &str, names: &[String]) -> Result<usize, ConfigError> {
    names
        .iter()
        .position(|known| known == name)
        .ok_or_else(|| map.error(key, format!("{name} is no robot"), format!("write some of {}", names.join(", "))))
}

fn share(map: &Map<'_>, key: &str) -> Result<f64, ConfigError> {
    let share = map.f64(key)?;
    if (0.0..=1.0).contains(&share) { Ok(share) } else { Err(map.error(key, "is no share", "write 0 to 1")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(line: &str) -> Result<Faults, String> {
        let names = ["robot1".to_owned(), "robot2".to_owned()];
        parse("faults.yaml", &format!("faults:\n- {line}\n"), &names).map_err(|error| error.to_string())
    }

    #[test]
    fn every_kind_is_read() {
        let rest = [
            ("slip", "robots: [robot2], left: 0.0, right: 1.0"),
            ("carried", "robot: robot1, pose: [1.0, 1.0, 0.5]"),
            ("battery", "robots: [robot1], volts: 6.1"),
            ("silent", "robots: [robot1]"),
            ("parted", "robots: [robot1, robot2]"),
            ("loss", "loss: 0.3"),
            ("covered", "robots: [robot1]"),
            ("stopped", ""),
            ("frozen", ""),
            ("black", ""),
            ("half", ""),
            ("late", "delay: 0.2"),
            ("every", "frames: 6"),
            ("far", "robots: [robot2]"),
            ("forged", ""),
            ("replayed", ""),
            ("corrupted", ""),
            ("missed", "robots: [robot1], share: 0.2"),
            ("switched_off", "robots: [robot1]"),
            ("doubled", "robot: robot1, like: robot2"),
            ("recorded", ""),
            ("untold", ""),
            ("blind", "robots: [robot2]"),
        ];
        assert_eq!(rest.map(|(kind, _)| kind), KINDS);
        for (kind, rest) in rest {
            let line = format!("{{kind: {kind}, from: 1.0, to: 2.0, {rest}}}");
            let faults = read(&line).unwrap_or_else(|error| unreachable!("{error}"));
            let names = |time| faults.at(time).map(FaultKind::name).collect::<Vec<_>>();
            assert_eq!((names(999_999_999), names(1_000_000_000)), (vec![], vec![kind]), "{line}");
        }
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let check = |line: &str, expected: &str| {
            let error = read(line).map(drop).unwrap_err();
            assert!(error.contains("faults.yaml:2") && error.contains(expected), "{error}");
        };
        check("{kind: rust, from: 1.0, to: 2.0}", "is no fault");
        check("{kind: black, from: 2.0, to: 1.0}", "is not after from");
        check("{kind: silent, from: 1.0, to: 2.0, robots: [robot7]}", "robot7 is no robot");
        check("{kind: blind, from: 1.0, to: 2.0}", "robots");
        check("{kind: untold, from: 1.0, to: 2.0, robots: [robot1]}", "robots");
        check("{kind: loss, from: 1.0, to: 2.0, loss: 1.5}", "is no share");
        check("{kind: black, from: 1.0, to: 2.0, delay: 1.0}", "delay");
    }
}
