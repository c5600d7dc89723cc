//! Hulls against closed forms and against combining by brute force.
#![expect(clippy::unwrap_used, reason = "a failed construction is a failed test")]
use core::f64::consts::PI;
use nalgebra::Vector2;
use proptest::prelude::*;
use trench_formation::hull::{ApparentObstacle, HullError, Obstacle, Shape, combine};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn disc(id: u32, x: f64, y: f64, radius: f64) -> Obstacle {
    Obstacle { id, shape: Shape::new(&[at(x, y)], radius).unwrap() }
}

fn members(combined: &[ApparentObstacle]) -> Vec<Vec<u32>> {
    combined.iter().map(|hull| hull.members.clone()).collect()
}

#[test]
fn two_unit_discs_become_a_stadium() {
    let discs = [disc(7, 0.0, 0.0, 1.0), disc(3, 3.0, 0.0, 1.0)];
    let combined = combine(&discs, 1.0 + 1e-12).unwrap();
    assert_eq!(combined.len(), 1);
    assert_eq!((combined[0].id, combined[0].members.as_slice()), (3, [3, 7].as_slice()));
    assert!((combined[0].shape.area() - (PI + 6.0)).abs() < 1e-9);
    assert_eq!(combine(&discs, 1.0).unwrap().len(), 2, "a separation equal to the clearance lets a robot pass");
}

#[test]
fn discs_of_different_radii_are_contained() {
    let discs = [disc(0, 0.0, 0.0, 2.0), disc(1, 4.0, 0.0, 1.0)];
    let hull = &combine(&discs, 1.5).unwrap()[0].shape;
    // Two tangents and two arcs; the angle between tangent and axis is asin(1/4).
    let tilt = 0.25_f64.asin();
    let exact = 3.0 * 15.0_f64.sqrt() + (PI / 2.0 + tilt) * 4.0 + (PI / 2.0 - tilt);
    assert!(hull.area() >= exact && hull.area() < exact * 1.005, "{} {exact}", hull.area());
}

#[test]
fn a_combined_hull_reaches_what_its_members_do_not() {
    let thin =
        |id: u32, from: Vector2<f64>, to: Vector2<f64>| Obstacle { id, shape: Shape::new(&[from, to], 0.0).unwrap() };
    let wall = [thin(0, at(0.0, 0.0), at(-5.0, 5.0)), thin(1, at(0.1, 0.0), at(5.1, 5.0))];
    let between = disc(2, 0.05, 4.0, 0.1);
    assert_eq!(members(&combine(&[wall[0].clone(), between.clone()], 0.5).unwrap()), [vec![0], vec![2]]);
    assert_eq!(members(&combine(&[wall[1].clone(), between.clone()], 0.5).unwrap()), [vec![1], vec![2]]);
    let all = [between, wall[1].clone(), wall[0].clone()];
    assert_eq!(members(&combine(&all, 0.5).unwrap()), [vec![0, 1, 2]]);
}

#[test]
fn unusable_obstacles_are_refused() {
    let check = |points: &[Vector2<f64>], radius: f64, expected: HullError| {
        assert_eq!(Shape::new(points, radius).unwrap_err(), expected);
    };
    check(&[], 1.0, HullError::NoPoints);
    check(&[at(0.0, 0.0), at(f64::NAN, 0.0)], 1.0, HullError::NotFinite(1));
    check(&[at(0.0, 0.0)], -1.0, HullError::Negative { what: "the radius", value: -1.0 });
    check(&[at(0.0, 0.0), at(1.0, 1.0), at(2.0, 2.0)], 0.0, HullError::NoArea);
    check(&[at(0.0, 0.0), at(1.0, 1.0), at(1.0, 0.0), at(0.0, 1.0)], 0.0, HullError::SelfCrossing(0, 2));
    let crossing = HullError::SelfCrossing(0, 2).to_string();
    assert!(crossing.contains("put the corners in order"));
    assert_eq!(combine(&[disc(4, 0.0, 0.0, 1.0), disc(4, 9.0, 0.0, 1.0)], 1.0), Err(HullError::DuplicateId(4)));
    assert!(combine(&[], f64::NAN).is_err());
}

#[test]
fn a_concave_polygon_becomes_its_hull() {
    let crescent = [at(0.0, 0.0), at(4.0, 0.0), at(4.0, 4.0), at(2.0, 1.0), at(0.0, 4.0)];
    let shape = Shape::new(&crescent, 0.0).unwrap();
    assert_eq!(shape.outline().points, [at(0.0, 0.0), at(4.0, 0.0), at(4.0, 4.0), at(0.0, 4.0)]);
    assert_eq!(shape.area(), 16.0);
    let inside = shape.outline().approach(at(2.0, 3.5));
    assert!((inside.gap + 0.5).abs() < 1e-15 && (inside.towards - at(0.0, -1.0)).norm() < 1e-15);
    let corner = shape.outline().approach(at(7.0, 8.0));
    assert!((corner.gap - 5.0).abs() < 1e-15 && (corner.towards - at(-0.6, -0.8)).norm() < 1e-15);
}

/// Least distance between the boundaries by dense sampling of both.
fn sampled_gap(a: &Shape, b: &Shape) -> f64 {
    let boundary = |shape: &Shape| {
        let points = shape.outline().points.to_vec();
        let count = points.len();
        (0..count * 60)
            .map(|i| points[i / 60].lerp(&points[(i / 60 + 1) % count], (i % 60) as f64 / 60.0))
            .collect::<Vec<_>>()
    };
    let (first, second) = (boundary(a), boundary(b));
    let least = first.iter().flat_map(|p| second.iter().map(move |q| (p - q).norm())).fold(f64::INFINITY, f64::min);
    least - a.outline().radius - b.outline().radius
}

/// One pair at a time, in the order found, hulls from hulls: slow and plain.
fn combine_slowly(obstacles: &[Obstacle], clearance: f64) -> Vec<Vec<u32>> {
    let mut groups: Vec<(Vec<u32>, Shape)> = obstacles.iter().map(|o| (vec![o.id], o.shape.clone())).collect();
    'again: loop {
        for i in 0..groups.len() {
            for j in 0..i {
                if groups[i].1.outline().gap(&groups[j].1.outline()) < clearance {
                    let (ids, shape) = groups.remove(i);
                    groups[j].0.extend(ids);
                    let points = [shape.outline().points, groups[j].1.outline().points].concat();
                    groups[j].1 = hull_of(&points, shape.outline().radius);
                    continue 'again;
                }
            }
        }
        let mut sets: Vec<Vec<u32>> = groups
            .into_iter()
            .map(|(mut ids, _)| {
                ids.sort();
                ids
            })
            .collect();
        sets.sort();
        return sets;
    }
}

/// Gift wrapping, another algorithm than the one under test.
fn hull_of(points: &[Vector2<f64>], radius: f64) -> Shape {
    let start = points.iter().copied().min_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))).unwrap();
    let mut hull = vec![start];
    loop {
        let last = hull[hull.len() - 1];
        let mut next = *points.iter().find(|point| **point != last).unwrap();
        for point in points {
            let side = (next - last).perp(&(point - last));
            if side < 0.0 || (side == 0.0 && (point - last).norm() > (next - last).norm()) {
                next = *point;
            }
        }
        if next == start {
            return Shape::new(&hull, radius).unwrap();
        }
        hull.push(next);
    }
}

fn polygons(most: usize) -> impl Strategy<Value = Vec<Obstacle>> {
    let polygon = (0.0..10.0_f64, 0.0..10.0_f64, 0.1..0.8_f64, 3..8_usize, 0.0..6.0_f64);
    prop::collection::vec(polygon, 1..most).prop_map(|list| {
        let build = |(id, (x, y, size, corners, turn)): (usize, (f64, f64, f64, usize, f64))| {
            let corner = |i: usize| {
                let (sine, cosine) = libm::sincos(turn + i as f64 * 2.0 * PI / corners as f64);
                at(x + size * cosine, y + size * sine)
            };
            let points: Vec<_> = (0..corners).map(corner).collect();
            Obstacle { id: u32::try_from(id).unwrap(), shape: Shape::new(&points, 0.05).unwrap() }
        };
        list.into_iter().enumerate().map(build).collect()
    })
}

proptest! {
    #[test]
    fn combining_equals_brute_force(obstacles in polygons(25), clearance in 0.0..1.0_f64) {
        let combined = combine(&obstacles, clearance).unwrap();
        prop_assert_eq!(members(&combined), combine_slowly(&obstacles, clearance));
        for hull in &combined {
            for member in hull.members.iter().map(|id| &obstacles[*id as usize]) {
                for corner in member.shape.outline().points {
                    prop_assert!(hull.shape.outline().approach(*corner).gap <= -0.05 + 1e-12);
                }
            }
        }
    }

    #[test]
    fn the_order_of_the_input_does_not_matter(obstacles in polygons(25), turn in 0..25_usize, clearance in 0.0..1.0_f64) {
        let mut shuffled = obstacles.clone();
        shuffled.reverse();
        shuffled.rotate_left(turn % obstacles.len());
        prop_assert_eq!(combine(&obstacles, clearance), combine(&shuffled, clearance));
    }

    #[test]
    fn gaps_equal_sampled_ones(obstacles in polygons(6)) {
        for (index, first) in obstacles.iter().enumerate() {
            for second in &obstacles[..index] {
                let (gap, sampled) = (first.shape.outline().gap(&second.shape.outline()), sampled_gap(&first.shape, &second.shape));
                prop_assert!(gap <= sampled + 1e-12);
                prop_assert!(gap < -0.09 || gap >= sampled - 0.03, "{gap} {sampled}");
            }
        }
    }
}
