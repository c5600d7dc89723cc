use super::*;
use crate::noise::Gaussian;

/// Runs the filter on `runs` motions drawn from its own model and gives the mean normalised estimation error squared.
/// Honest covariances make it 5, the number of states.
fn mean_nees(noise: [f64; 3], motion: Motion, runs: u64) -> f64 {
    let dt = 0.04;
    let spread = Matrix3::from_diagonal(&Vector3::from(noise.map(|sigma| sigma * sigma)));
    let (mut sum, mut count) = (0.0, 0.0);
    for run in 0..runs {
        let mut random = Gaussian::new(run);
        let (mut pose, mut v, mut omega) = (Pose2 { x: 1.0, y: 1.0, theta: 3.0 }, 0.1, 0.5);
        let measure = |pose: Pose2, random: &mut Gaussian| Pose2 {
            x: pose.x + noise[0] * random.next(),
            y: pose.y + noise[1] * random.next(),
            theta: wrap(pose.theta + noise[2] * random.next()),
        };
        let mut filter = Filter::new(measure(pose, &mut random), noise);
        for step in 0..60 {
            // White noise on the accelerations, in steps much shorter than a frame.
            let short = dt / 20.0;
            for _ in 0..20 {
                let kick = libm::sqrt(short);
                v += motion.acceleration * kick * random.next();
                omega += motion.turning * kick * random.next();
                let slip = motion.slip * kick * random.next();
                let (sine, cosine) = (libm::sin(pose.theta), libm::cos(pose.theta));
                pose = Pose2 {
                    x: pose.x + v * short * cosine - slip * sine,
                    y: pose.y + v * short * sine + slip * cosine,
                    theta: wrap(pose.theta + omega * short),
                };
            }
            filter.predict(dt, &motion);
            filter.update(measure(pose, &mut random), &spread);
            if step >= 10 {
                let state = filter.state();
                let error = Vector5::new(
                    state.pose.x - pose.x,
                    state.pose.y - pose.y,
                    wrap(state.pose.theta - pose.theta),
                    state.v - v,
                    state.omega - omega,
                );
                sum += error.dot(&(state.covariance.try_inverse().unwrap() * error));
                count += 1.0;
            }
        }
    }
    sum / count
}

#[test]
fn covariances_are_honest() {
    let motion = Motion::default();
    for noise in [[3.5e-5, 3.5e-5, 9e-4], [0.46e-3, 0.49e-3, 0.0122]] {
        let nees = mean_nees(noise, motion, 200);
        assert!((4.6..5.5).contains(&nees), "noise {noise:?}: mean NEES {nees}");
    }
}

#[test]
fn headings_wrap() {
    let check = |angle: f64, expected: f64| assert!((wrap(angle) - expected).abs() < 1e-12, "{angle}: {}", wrap(angle));
    let pi = std::f64::consts::PI;
    check(0.0, 0.0);
    check(pi, pi);
    check(-pi, pi);
    check(3.0 * pi, pi);
    check(7.0, 7.0 - 2.0 * pi);
    check(-4.0, 2.0 * pi - 4.0);
}

#[test]
fn doubt_about_an_unseen_robot_grows_to_a_limit() {
    let mut filter = Filter::new(Pose2::default(), [1e-4; 3]);
    let sigma = |filter: &Filter| filter.state().covariance[(0, 0)].sqrt();
    for _ in 0..25 {
        filter.rest(0.04);
    }
    assert!((sigma(&filter) - 0.1).abs() < 1e-3, "{}", sigma(&filter));
    filter.rest(1e6);
    assert_eq!(sigma(&filter), 1.0);
}
