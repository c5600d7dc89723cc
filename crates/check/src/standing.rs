//! What stands or moves in a field.

use crate::gaps::shape;
use crate::verdict::number;
use trench_formation::Vector2;
use trench_formation::hull::Shape;

/// Places looked at on the way of an obstacle that moves.
const LOOKS: u32 = 48;
/// Pieces of each rounded corner where points of an outline are compared.
const STEPS: usize = 16;

/// An obstacle, with the places that it passes.
#[derive(Debug, Clone, PartialEq)]
pub struct Standing {
    /// For people.
    pub name: String,
    /// Its convex hull where it begins, frame `map`.
    pub shape: Shape,
    corners: Vec<Vector2<f64>>,
    /// From where it begins, m; the first is zero.
    ways: Vec<Vector2<f64>>,
}

/// A straight edge of the field: the inward normal, and the component along it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    inward: Vector2<f64>,
    at: f64,
}

impl Place {
    /// The edges of a field by their names.
    pub(crate) fn edges([[low_x, high_x], [low_y, high_y]]: [[f64; 2]; 2]) -> [(&'static str, Self); 4] {
        [
            ("left", Self { inward: Vector2::x(), at: low_x }),
            ("right", Self { inward: -Vector2::x(), at: -high_x }),
            ("lower", Self { inward: Vector2::y(), at: low_y }),
            ("upper", Self { inward: -Vector2::y(), at: -high_y }),
        ]
    }
}

impl Standing {
    /// The obstacle with this number in its file: corners (m, frame `map`) grown by a radius, on a way through `places` (m, from where it
    /// begins). Nothing for corners that are none.
    pub fn new(number_in_file: u32, corners: &[Vector2<f64>], radius: f64, places: &[Vector2<f64>]) -> Option<Self> {
        let shape = shape(corners, radius)?;
        let middle = corners.iter().sum::<Vector2<f64>>() / corners.len() as f64;
        let what = match corners.len() {
            1 => "disc",
            2 => "wall",
            _ => "polygon",
        };
        let name = format!("{what} {number_in_file} at [{}, {}]", number(middle.x), number(middle.y));
        Some(Self { name, shape, corners: corners.to_vec(), ways: ways(places) })
    }

    /// The least and the greatest gap to another, m, wherever on their ways both are.
    pub(crate) fn gap_range(&self, other: &Self) -> (f64, f64) {
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for way in &self.ways {
            for way_of_other in &other.ways {
                let Ok(moved) = self.shape.moved(way - way_of_other) else { continue };
                let gap = moved.outline().gap(&other.shape.outline());
                (least, most) = (least.min(gap), most.max(gap));
            }
        }
        (least, most)
    }

    /// The least and the greatest gap to an edge of the field, m.
    pub(crate) fn edge_gap(&self, edge: Place) -> (f64, f64) {
        let outline = self.shape.outline();
        let lowest = outline.points.iter().map(|point| point.dot(&edge.inward)).fold(f64::INFINITY, f64::min);
        let gaps = self.ways.iter().map(|way| lowest + way.dot(&edge.inward) - outline.radius - edge.at);
        gaps.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), gap| (least.min(gap), most.max(gap)))
    }

    /// The middle of the gap to another, where they are nearest on their ways.
    pub(crate) fn middle_of_gap(&self, other: &Self) -> Vector2<f64> {
        let mut best = (f64::INFINITY, Vector2::zeros());
        // Both ways round: a corner of either may face a side of the other.
        for (one, another) in [(self, other), (other, self)] {
            for way in &one.ways {
                for point in one.shape.outline().boundary(STEPS) {
                    for way_of_another in &another.ways {
                        let here = point + way;
                        let approach = another.shape.outline().approach(here - way_of_another);
                        if approach.gap < best.0 {
                            best = (approach.gap, here + 0.5 * approach.gap * approach.towards);
                        }
                    }
                }
            }
        }
        best.1
    }

    /// The middle of the gap before an edge, where it is nearest.
    pub(crate) fn middle_before(&self, edge: Place) -> Vector2<f64> {
        let boundary = self.shape.outline().boundary(STEPS);
        let points = self.ways.iter().flat_map(|way| boundary.iter().map(move |point| point + way));
        let height = |point: &Vector2<f64>| point.dot(&edge.inward) - edge.at;
        let nearest = points.min_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or_default();
        nearest - 0.5 * height(&nearest) * edge.inward
    }

    /// Whether its hull, where it begins, comes nearer to a point than `distance` (m).
    pub(crate) fn is_within(&self, point: Vector2<f64>, distance: f64) -> bool {
        self.shape.outline().approach(point).gap < distance - 1e-9
    }

    /// The widest mouth that its own hull closes, m: between neighbours on the boundary of the hull, past corners that are within.
    pub(crate) fn mouth(&self) -> Option<f64> {
        let outline = self.shape.outline();
        let is_within = |corner: &Vector2<f64>| outline.approach(*corner).gap < -outline.radius - 1e-9;
        let first = self.corners.iter().position(|corner| !is_within(corner))?;
        let (mut last, mut passed, mut widest) = (self.corners[first], false, 0.0_f64);
        for step in 1..=self.corners.len() {
            let corner = self.corners[(first + step) % self.corners.len()];
            if is_within(&corner) {
                passed = true;
                continue;
            }
            if passed {
                widest = widest.max((corner - last).norm() - 2.0 * outline.radius);
            }
            (last, passed) = (corner, false);
        }
        (widest > 0.0).then_some(widest)
    }
}

/// Points along the way through places.
fn ways(places: &[Vector2<f64>]) -> Vec<Vector2<f64>> {
    let mut ways = vec![Vector2::zeros()];
    let mut from = Vector2::zeros();
    for place in places {
        ways.extend((1..=LOOKS).map(|look| from + f64::from(look) / f64::from(LOOKS) * (place - from)));
        from = *place;
    }
    ways
}
