//! Whether a formation has room: on the field, and for bodies beside each other.

use trench_formation::Vector2;
use trench_plan::{Frame, Plan};

/// What a formation has to fit.
#[derive(Debug, Clone)]
pub(crate) struct Room {
    /// Low corner and high corner, m; none: formations may be anywhere.
    pub(crate) field: Option<[f64; 4]>,
    /// m
    pub(crate) body_radius: f64,
}

/// A place: its queue's name, and where it is in the formation's frame, m.
type Place<'a> = (&'a str, Vector2<f64>);

impl Room {
    /// Refuses a formation in the map with places outside the field (one in the target's frame goes where the target goes), and one with
    /// places where two bodies would overlap.
    ///
    /// # Errors
    /// Which places those are.
    pub(crate) fn admit(&self, plan: &Plan) -> Result<(), String> {
        let places: Vec<Place<'_>> = plan
            .queues
            .iter()
            .flat_map(|queue| queue.places.iter().map(|place| (queue.name.as_str(), queue.curve.at(place.end).point)))
            .collect();
        if plan.frame == Frame::Map
            && let Some((queue, point)) = places.iter().find(|(_, point)| !self.is_inside(*point))
        {
            return Err(format!("a place of queue {queue} at ({:.3}, {:.3}) is outside the field", point.x, point.y));
        }
        match closest(&places) {
            Some((gap, [one, other])) if gap < 2.0 * self.body_radius => Err(format!(
                "places of {} and {} are {gap:.3} m apart: two bodies need {:.3} m",
                one,
                other,
                2.0 * self.body_radius
            )),
            _ => Ok(()),
        }
    }

    fn is_inside(&self, point: Vector2<f64>) -> bool {
        self.field.is_none_or(|[low_x, low_y, high_x, high_y]| {
            (low_x..=high_x).contains(&point.x) && (low_y..=high_y).contains(&point.y)
        })
    }
}

/// The least distance between two places, m, and their queues.
fn closest<'a>(places: &[Place<'a>]) -> Option<(f64, [&'a str; 2])> {
    let pairs =
        places.iter().enumerate().flat_map(|(index, one)| places[..index].iter().map(move |other| (other, one)));
    pairs.map(|(one, other)| ((one.1 - other.1).norm(), [one.0, other.0])).min_by(|a, b| a.0.total_cmp(&b.0))
}
