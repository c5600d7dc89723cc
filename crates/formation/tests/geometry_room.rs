//! How many robots find room on fragments, rho_hat from each other.
#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]
use core::f64::consts::{PI, TAU};
use nalgebra::Vector2;
use proptest::prelude::*;
use trench_formation::curve::{Curve, CurveShape, Interval, Placed};
use trench_formation::hull::{Obstacle, Outline, Shape};
use trench_formation::seek::{Fragments, Room};

fn at(x: f64, y: f64) -> Vector2<f64> {
    Vector2::new(x, y)
}

fn curve(shape: CurveShape) -> Curve {
    Curve::new(&shape, false, false).unwrap()
}

fn line(length: f64) -> Curve {
    curve(CurveShape::Line(at(0.0, 0.0), at(length, 0.0)))
}

fn check(segment: &Curve, fragments: &[Interval], pitch: f64, (found, most): (usize, usize)) {
    assert_eq!(Room::count(segment, fragments, pitch, 100), Room { found, most }, "{fragments:?}");
}

/// Four small discs on 10 m leave five fragments, each with a place for one robot; but 4 m from each other no more than three stand.
#[test]
fn neighbouring_fragments_share_their_places() {
    let segment = line(10.0);
    let discs = [2.0, 4.0, 6.0, 8.0];
    let discs = (1..).zip(discs).map(|(id, x)| Obstacle { id, shape: Shape::new(&[at(x, 0.0)], 0.1).unwrap() });
    let discs: Vec<Obstacle> = discs.collect();
    let outlines: Vec<Outline<'_>> = discs.iter().map(|disc| disc.shape.outline()).collect();
    let placed = Placed::new(&segment, Default::default());
    let fragments = Fragments::find(&placed, (0.0, 10.0), &outlines, 0.1, 0.1);
    assert_eq!(fragments.intervals().len(), 5, "{fragments:?}");
    check(&segment, fragments.intervals(), 4.0, (3, 3));
}

#[test]
fn places_on_straight_segments() {
    check(&line(10.0), &[(0.0, 10.0)], 4.0, (3, 3));
    check(&line(12.0), &[(0.0, 12.0)], 4.0, (4, 4));
    check(&line(9.0), &[(0.0, 9.0)], 0.1, (91, 91));
    check(&line(50.0), &[(0.0, 50.0)], 0.1, (100, 100));
    check(&line(10.0), &[], 4.0, (0, 0));
    check(&line(10.0), &[(0.0, 3.5), (3.9, 4.1), (7.8, 7.95)], 4.0, (2, 2));
    check(&line(10.0), &[(0.0, 3.5), (3.9, 4.1), (7.8, 8.1)], 4.0, (3, 3));
}

/// n chords of 2 R sin(pi/n) go round. The arcs over them are longer: by its length the open arc would have room for eight.
#[test]
fn places_on_circles_are_a_chord_apart() {
    let round = |sweep: f64| curve(CurveShape::Arc { centre: at(1.0, 2.0), radius: 5.0, start_angle: 0.4, sweep });
    let of = |circle: &Curve, chord: f64| {
        let Room { found, most } = Room::count(circle, &[(0.0, circle.length())], chord, 100);
        (found, most)
    };
    let chord = 10.0 * (PI / 7.0).sin();
    assert_eq!(of(&round(TAU), chord * 0.999), (7, 7));
    assert!(round(0.99 * TAU).length() > 7.1 * chord);
    assert_eq!(of(&round(0.99 * TAU), chord * 0.999), (7, 7));
    assert_eq!(of(&round(PI), 9.99), (2, 2));
    assert_eq!(of(&round(PI), 10.01), (1, 1));
}

/// There and back a metre beside: 21 m have six places 4 m apart along the way, three in the plane.
#[test]
fn strands_beside_each_other_have_one_row_of_places() {
    let hairpin = curve(CurveShape::Polyline(vec![at(0.0, 0.0), at(10.0, 0.0), at(10.0, 1.0), at(0.0, 1.0)]));
    let Room { found, most } = Room::count(&hairpin, &[(0.0, 21.0)], 4.0, 100);
    assert_eq!(found, 3);
    assert!((3..=6).contains(&most), "{most}");
    // A zigzag within 3 m has room for one robot that needs 4 m, however long it is.
    let teeth = (0..40).map(|index| at(0.05 * f64::from(index), f64::from(index % 2) * 2.5)).collect();
    let zigzag = curve(CurveShape::Polyline(teeth));
    assert!(zigzag.length() > 90.0);
    check(&zigzag, &[(0.0, zigzag.length())], 4.0, (1, 1));
}

/// What a pitch too small for arc lengths does is end.
#[test]
fn counting_ends() {
    let far = [(9e11, 9e11 + 4.0)];
    assert!(Room::count(&line(1e12), &far, 1e-6, 1000).found <= 1000);
    assert_eq!(Room::count(&line(1e12), &[(0.0, 1e12)], 1e-3, 1000), Room { found: 1000, most: 1000 });
}

proptest! {
    /// On a line the greedy count from the left is the largest there is, and both bounds are it.
    #[test]
    fn bounds_meet_on_lines(cuts in prop::collection::vec(0.01..3.0_f64, 2..16), pitch in 0.3..4.0_f64) {
        let mut ends = cuts.clone();
        for index in 1..ends.len() {
            ends[index] += ends[index - 1];
        }
        let fragments: Vec<Interval> = ends.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect();
        let segment = line(60.0);
        let (mut greedy, mut next) = (0, 0.0_f64);
        for (from, to) in &fragments {
            next = next.max(*from);
            while next <= *to {
                greedy += 1;
                next += pitch;
            }
        }
        prop_assert_eq!(Room::count(&segment, &fragments, pitch, 1000), Room { found: greedy, most: greedy });
    }

    /// On a wave no subset of many points of it is larger than the upper bound: the subset is found by another order.
    #[test]
    fn no_more_than_the_most(amplitude in 0.1..3.0_f64, pitch in 0.4..4.0_f64, seed in 0_usize..97) {
        let wave = curve(CurveShape::Sinusoid {
            origin: at(0.0, 0.0), direction: 0.3, length: 12.0, amplitude, wavelength: 3.0, phase: 0.2,
        });
        let points: Vec<_> = (0..97).map(|index| {
            wave.at(wave.length() * ((index * 31 + seed) % 97) as f64 / 96.0).point
        }).collect();
        let mut kept: Vec<Vector2<f64>> = Vec::new();
        for point in points {
            if kept.iter().all(|other| (other - point).norm() >= pitch) {
                kept.push(point);
            }
        }
        let room = Room::count(&wave, &[(0.0, wave.length())], pitch, 1000);
        prop_assert!(kept.len() <= room.most && room.found <= room.most, "{} {room:?}", kept.len());
    }
}

/// A fragment across the point where a circle begins has as many places as the same one elsewhere.
#[test]
fn places_across_the_beginning_of_a_closed_curve() {
    let arc = |start_angle: f64| curve(CurveShape::Arc { centre: at(0.0, 0.0), radius: 10.0, start_angle, sweep: TAU });
    let disc = [Obstacle { id: 1, shape: Shape::new(&[at(-10.0, 0.0)], 18.6).unwrap() }];
    for (start, pieces) in [(0.0, 2), (PI, 1)] {
        let segment = arc(start);
        let (placed, outlines) = (Placed::new(&segment, Default::default()), [disc[0].shape.outline()]);
        let fragments = Fragments::find(&placed, segment.domain(), &outlines, 0.1, 5.0);
        let intervals = fragments.intervals();
        assert_eq!((intervals.len(), segment.count_fragments(intervals)), (pieces, 1), "{fragments:?}");
        for (pitch, places) in [(1.9, 8), (4.0, 4), (8.0, 2), (14.0, 1)] {
            check(&segment, intervals, pitch, (places, places));
        }
    }
}
