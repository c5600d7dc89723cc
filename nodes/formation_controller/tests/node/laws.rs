//! Laws, gains and trenches: what is refused, and what may change while the controller runs.

use crate::bench::{Bench, LAWS, formation, leader, make, parameters};
use trench_formation::kinematics::Pose;
use trench_msgs::msg::{LeaderState, Stability};

#[test]
fn gains_outside_the_stable_zone_are_refused_with_the_equation() {
    let refused = |overrides| make(overrides).map(drop).unwrap_err();
    let error = refused(&[("gains.k1", "0.1"), ("gains.k2", "1.0"), ("gains.k3", "9.0")]);
    assert!(error.contains("gains.k3 = 9"), "{error}");
    assert!(error.contains("K3 < K1 + 2 c1 K2") && error.contains("4.3.1"), "{error}");
    assert!(refused(&[("gains.k2", "-1.0")]).contains("K2 > 0"));
    assert!(make(&[("gains.k3", "50.0"), ("refuse_unstable_gains", "false")]).is_ok());
}

/// The robot looks a quarter turn away from its goal: under K2 = -3 it would turn away from it.
#[test]
fn a_refused_change_leaves_the_old_gains_in_force() {
    let turns_by = |change: Option<(&str, bool)>| {
        let mut bench = Bench::new();
        bench.pose = Pose::new(1.0, 0.9, 1.5);
        if let Some((k2, refuse)) = change {
            let refuse = if refuse { "true" } else { "false" };
            let change = parameters(&[("gains.k2", k2), ("refuse_unstable_gains", refuse)]).unwrap();
            assert_eq!(bench.core.set_parameters(&change).is_err(), refuse == "true" && k2 == "-3.0");
        }
        bench.drive(1);
        bench.last_command().twist.angular.z
    };
    let before = turns_by(None);
    assert!(before < -0.5, "towards its goal: {before}");
    assert_eq!(turns_by(Some(("-3.0", true))), before, "what is refused");
    assert!(turns_by(Some(("-3.0", false))) > 0.5, "what is allowed would turn it away");
    assert!(turns_by(Some(("0.5", true))) > before, "what is admissible is in force at once");
}

#[test]
fn dynamic_laws_outside_the_theory_are_refused_with_their_equation() {
    let refused = |overrides: &[(&str, &str)]| make(overrides).map(drop).unwrap_err();
    assert!(refused(&[("law", "chain"), ("damping", "1.0")]).contains("(7.13) with k = 1 < 2"));
    assert!(refused(&[("law", "goal"), ("damping", "0.0")]).contains("(5.1) needs k > 0"));
    assert!(refused(&[("law", "chain"), ("zones.radii", "[0.3, 0.2, 0.4, 0.5, 1.0]")]).contains("6.2.2"));
    assert!(make(&[("law", "chain"), ("damping", "1.0"), ("refuse_unstable_gains", "false")]).is_ok());
}

#[test]
fn trenches_may_be_written() {
    let refused = |shape: &str, formula: &str| {
        let overrides = [("law", "goal"), ("trench.shape", shape), ("trench.formula", formula)];
        make(&overrides).map(drop).unwrap_err()
    };
    assert!(refused("potential", "2*abs(x").contains("trench.formula"));
    assert!(refused("potential", "sqrt(abs(x))").contains("infinitely steep at x = 0"));
    assert!(refused("potential", "2*abs(x) + 3*(1 - cos(x))").contains("Definition 5.2.1"));
    assert!(refused("slope", "1/x").contains("is not finite at x = 0"));
    assert!(make(&[("law", "goal"), ("trench.shape", "potential"), ("trench.formula", "0.4*abs(x)")]).is_ok());
    assert!(make(&[("law", "goal"), ("trench.shape", "slope"), ("trench.formula", "0.3*tanh(4*x)")]).is_ok());
    let table = |rows: &str| make(&[("law", "chain"), ("trench.shape", "table"), ("trench.table", rows)]).map(drop);
    assert_eq!(table("[0.0, 0.0, 0.5, 0.4]"), Ok(()));
    assert!(table("[0.0, 0.0, 0.5]").unwrap_err().contains("odd number"));
    assert!(table("[0.0, 0.0, 0.5, 0.4, 0.3, 0.4]").unwrap_err().contains("row 3"));
    assert!(table("[0.0, 0.0, 1.0, 4.0, 1.0, 1.0]").unwrap_err().contains("not regular"));
}

#[test]
fn directions_of_attraction_are_directions() {
    let directed = |direction: &str| make(&[("law", "zoned"), ("zoned.direction", direction)]).map(drop);
    assert_eq!(directed("[]").and(directed("[0.6, 0.8]")), Ok(()));
    assert!(directed("[0.0, 0.0]").unwrap_err().contains("is no direction"));
    assert!(directed("[1.0]").unwrap_err().contains("is no direction"));
}

/// Every law, one after the other, while the robot drives to its goal; a refused one in between changes nothing.
#[test]
fn laws_change_while_the_robot_drives() {
    let mut bench = Bench::new();
    formation(&mut bench);
    bench.pose = Pose::new(0.6, 1.1, 0.0);
    for law in LAWS {
        bench.core.set_parameters(&parameters(&[("law", law), ("team", "[robot1, robot2]")]).unwrap()).unwrap();
        let refused = bench.core.set_parameters(&parameters(&[("law", "chain"), ("damping", "0.5")]).unwrap());
        assert!(refused.unwrap_err().to_string().contains("k = 0.5 < 2"));
        for _ in 0..5 {
            leader(&mut bench);
            bench.drive(1);
        }
        let state: LeaderState = bench.out.last(bench.port("/robot1/leader_state")).unwrap();
        let said: Stability = bench.out.last(bench.port("/robot1/stability")).unwrap();
        assert_eq!((said.law.as_str(), said.holds), (law, true), "{said:?}");
        assert!(state.goal_distance > 0.0 && state.limited_by & LeaderState::LIMIT_STALE == 0, "{law}: {state:?}");
    }
}

/// Whatever law drives: what a controller refuses changes nothing, to the last bit; nor does what is of no use to this law.
#[test]
fn refused_changes_leave_every_law_as_it_was() {
    const OF_CHAINS: [&str; 3] = ["zones.radii", "obstacles.cut", "trench.shape"];
    let bad = [
        ("zones.radii", "[0.3, 0.2, 0.4, 0.5, 1.0]"),
        ("damping", "-1.0"),
        ("law", "magic"),
        ("obstacles.cut", "0.1"),
        ("trench.shape", "ditch"),
        ("trench.a", "0.0"),
    ];
    for law in LAWS {
        let driven = |change: Option<(&str, &str)>| {
            let mut bench = Bench::of(make(&[("team", "[robot1, robot2]"), ("law", law)]).unwrap());
            formation(&mut bench);
            bench.pose = Pose::new(0.6, 1.1, 0.0);
            for tick in 0..6 {
                leader(&mut bench);
                bench.drive(1);
                if tick == 2
                    && let Some(change) = change
                {
                    // What is of the wrong kind or out of range is refused before the node hears of it.
                    let set = parameters(&[("team", "[robot1, robot2]"), ("law", law), change])
                        .and_then(|set| bench.core.set_parameters(&set).map_err(|error| error.to_string()));
                    match set {
                        Err(refusal) => assert!(refusal.contains(change.0), "{law}, {change:?}: {refusal}"),
                        Ok(()) => assert!(law != "chain" && OF_CHAINS.contains(&change.0), "{law}: {change:?}"),
                    }
                }
            }
            bench.last_command()
        };
        let undisturbed = driven(None);
        bad.into_iter().for_each(|change| assert_eq!(driven(Some(change)), undisturbed, "{law}: {change:?}"));
    }
}
