//! Where a robot joins a chain (A.22, case 2.2).

use nalgebra::Vector2;

/// How many of the members stay ahead of a robot at `own` that joins a chain towards `goal`; `members` are their positions by rank (all m,
/// in one frame). It joins where it lengthens the chain least, measured from the team goal along the pairs; to the rear of equals. The
/// order of the others stays, so one pair at most is taken apart: the thesis asks for a sorting that leaves the rest where it is, and
/// distances along the pairs are what 6.2.1 orders by, too. (The distance to the team goal alone would send whoever stands at the end of a chain round a bend to its head.)
#[must_use]
pub fn joining(own: Vector2<f64>, goal: Vector2<f64>, members: &[Vector2<f64>]) -> usize {
    let (mut best, mut ahead) = ((f64::INFINITY, 0), goal);
    for (index, &behind) in members.iter().enumerate() {
        let detour = (own - ahead).norm() + (behind - own).norm() - (behind - ahead).norm();
        if detour <= best.0 {
            best = (detour, index);
        }
        ahead = behind;
    }
    // Behind the last there is no pair to take apart.
    if (own - ahead).norm() <= best.0 { members.len() } else { best.1 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(own: [f64; 2], members: &[[f64; 2]], expected: usize) {
        let members: Vec<Vector2<f64>> = members.iter().copied().map(Vector2::from).collect();
        assert_eq!(joining(own.into(), Vector2::zeros(), &members), expected, "{own:?}");
    }

    #[test]
    fn along_a_line_the_place_is_where_it_stands() {
        let line = [[-0.5, 0.0], [-1.0, 0.0], [-1.5, 0.0]];
        check([0.1, 0.0], &line, 0);
        check([-0.7, 0.1], &line, 1);
        check([-1.2, -0.1], &line, 2);
        check([-2.0, 0.3], &line, 3);
        check([3.0, 3.0], &[], 0);
    }

    /// Three quarters round a circle about (0, 1): the newcomer is nearer to the team goal than all but the first, and yet the last.
    #[test]
    fn round_a_bend_the_last_is_not_the_first() {
        let on_circle = |degrees: f64| [degrees.to_radians().sin(), 1.0 - degrees.to_radians().cos()];
        let bend: Vec<[f64; 2]> = [0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0].map(on_circle).to_vec();
        check(on_circle(315.0), &bend, 7);
    }
}
