//! Chains: the order of a team into leader-follower pairs, by the rule of 6.2.1.

use nalgebra::Vector2;

/// Distances that differ by less than this are equal, m: the tie-breaks of 6.2.1 would never act on measured positions
/// otherwise.
const TIE: f64 = 1e-9;

/// A robot that is to be put in order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate<'a> {
    /// Its name: the last tie-break, so that every robot computes the same chain.
    pub name: &'a str,
    /// Its position, m.
    pub position: Vector2<f64>,
    /// Its distance from the segment, m.
    pub segment_distance: f64,
}

/// Indices of `team` in the order r1, r2, ... of 6.2.1: r1 is the robot nearest to the team goal; the robot nearest to r1
/// becomes its follower r2, and so on. Ties go to the robot nearer to the segment, then to the lower name.
pub fn order(team: &[Candidate<'_>], team_goal: Vector2<f64>) -> Vec<usize> {
    let mut left: Vec<usize> = (0..team.len()).collect();
    let mut chain = Vec::with_capacity(team.len());
    let mut ahead = team_goal;
    while let Some(next) = nearest(team, &left, ahead) {
        ahead = team[left[next]].position;
        chain.push(left.remove(next));
    }
    chain
}

/// Index into `left` of the robot that follows what is at `ahead`.
fn nearest(team: &[Candidate<'_>], left: &[usize], ahead: Vector2<f64>) -> Option<usize> {
    let distance = |candidate: &Candidate<'_>| (candidate.position - ahead).norm();
    let least = left.iter().map(|&index| distance(&team[index])).min_by(f64::total_cmp)?;
    let tied = left.iter().enumerate().filter(|(_, index)| distance(&team[**index]) <= least + TIE);
    let beaten_by = |a: &Candidate<'_>, b: &Candidate<'_>| {
        let nearer = a.segment_distance - b.segment_distance;
        if nearer.abs() > TIE { nearer.total_cmp(&0.0) } else { a.name.cmp(b.name) }
    };
    tied.min_by(|(_, a), (_, b)| beaten_by(&team[**a], &team[**b])).map(|(place, _)| place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn names(team: &[Candidate<'_>], goal: Vector2<f64>) -> Vec<String> {
        order(team, goal).into_iter().map(|index| team[index].name.to_owned()).collect()
    }

    fn candidate(name: &str, x: f64, y: f64) -> Candidate<'_> {
        // The segment of 6.5 and 7.10 is the diagonal y = x.
        Candidate { name, position: Vector2::new(x, y), segment_distance: (x - y).abs() / core::f64::consts::SQRT_2 }
    }

    #[test]
    fn the_team_of_table_6_1() {
        let table = [
            ("r1", 26.0026, 29.7094),
            ("r2", 27.8260, 19.8633),
            ("r3", 25.4281, 16.7758),
            ("r4", 14.8357, 21.3381),
            ("r5", 14.2419, 15.1141),
            ("r6", 13.7641, 8.8730),
            ("r7", 12.3089, 4.2053),
            ("r8", 9.7197, 1.0574),
            ("r9", 1.5191, 3.0657),
            ("r10", 0.7206, -1.0582),
        ];
        let team: Vec<Candidate<'_>> = table.iter().map(|&(name, x, y)| candidate(name, x, y)).collect();
        let expected = ["r1", "r2", "r3", "r5", "r4", "r6", "r7", "r8", "r9", "r10"];
        assert_eq!(names(&team, Vector2::new(70.0, 70.0)), expected);
    }

    #[test]
    fn ties_go_to_the_nearer_to_the_segment_then_to_the_lower_name() {
        let team = [candidate("c", 0.0, 1.0), candidate("b", 1.0, 0.0), candidate("a", 0.5, -0.5)];
        // b and c are mirror images across the segment y = x, as near to it as each other: the name decides.
        assert_eq!(names(&team, Vector2::zeros())[0], "a");
        assert_eq!(names(&team[..2], Vector2::zeros()), ["b", "c"]);
        let team = [candidate("a", 0.0, 2.0_f64.sqrt()), candidate("b", 1.0, 1.0)];
        assert_eq!(names(&team, Vector2::zeros()), ["b", "a"], "b is on the segment");
    }

    #[test]
    fn nobody_is_no_chain() {
        assert!(order(&[], Vector2::zeros()).is_empty());
    }

    proptest! {
        #[test]
        fn everyone_once_whatever_the_order_they_are_named_in(
            points in proptest::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64), 1..12), shift in 0_usize..12,
        ) {
            let names_: Vec<String> = (0..points.len()).map(|index| format!("robot{index:02}")).collect();
            let mut team: Vec<Candidate<'_>> =
                points.iter().zip(&names_).map(|(&(x, y), name)| candidate(name, x, y)).collect();
            let chain = names(&team, Vector2::zeros());
            let mut sorted = chain.clone();
            sorted.sort();
            prop_assert_eq!(&sorted, &names_);
            let by = shift % team.len();
            team.rotate_left(by);
            prop_assert_eq!(names(&team, Vector2::zeros()), chain);
        }
    }
}
