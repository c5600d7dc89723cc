//! As far as robots may go until they have to be looked at again.

use crate::course::LANES;
use trench_formation::Vector2;
use wide::f64x4;

/// Rooms about robots side by side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rooms {
    /// Where they were looked at, m.
    x: f64x4,
    y: f64x4,
    /// m^2; 0: at once.
    squared: f64x4,
}

impl Rooms {
    pub(crate) fn none() -> Self {
        let zero = f64x4::splat(0.0);
        Self { x: zero, y: zero, squared: zero }
    }

    /// Which robots have to be looked at again, now that they are there: bits by lane.
    #[inline(always)]
    pub(crate) fn left(&self, x: f64x4, y: f64x4) -> u32 {
        let (x, y) = (x - self.x, y - self.y);
        // What is no number is in no room.
        !(x * x + y * y).simd_lt(self.squared).to_bitmask() & ((1 << LANES) - 1)
    }

    /// The robot in a lane was looked at where it is, and has so much room (m) from there.
    pub(crate) fn set(&mut self, lane: usize, position: Vector2<f64>, room: f64) {
        let room = (room - rounding(position)).max(0.0);
        self.x.as_mut_array()[lane] = position.x;
        self.y.as_mut_array()[lane] = position.y;
        self.squared.as_mut_array()[lane] = room * room;
    }
}

/// What rounding may do to ways from there is far less, m.
pub(crate) fn rounding(position: Vector2<f64>) -> f64 {
    1e-9 * (1.0 + position.norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_leaves_its_room_is_told() {
        let mut rooms = Rooms::none();
        let at = |x: [f64; 4]| (f64x4::new(x), f64x4::splat(1.0));
        let (x, y) = at([1.0, 2.0, 3.0, f64::NAN]);
        assert_eq!(rooms.left(x, y), 0b1111);
        for lane in 0..LANES {
            rooms.set(lane, Vector2::new(1.0 + lane as f64, 1.0), [0.5, 0.5, f64::INFINITY, -1.0][lane]);
        }
        assert_eq!(rooms.left(x, y), 0b1000);
        let (x, y) = at([1.4, 1.4, 1e9, 4.0]);
        assert_eq!(rooms.left(x, y), 0b1010);
    }
}
