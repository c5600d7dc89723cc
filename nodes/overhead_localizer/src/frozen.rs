//! A camera that shows the same picture again and again, with fresh stamps: robots must not be driven by it.

use crate::intake::Sighting;

/// The last picture, and how often it has come again.
#[derive(Debug, Clone, Default)]
pub(crate) struct Frozen {
    last: Vec<Sighting>,
    repeats: u32,
}

impl Frozen {
    /// Takes what a frame shows; gives whether the same, to the last bit, was in `most` frames before it. The noise of pixels
    /// makes no two pictures of a real camera equal, whether robots move or not. 0: never.
    pub(crate) fn look(&mut self, sightings: &[Sighting], most: u32) -> bool {
        if sightings.is_empty() || self.last != sightings {
            self.repeats = 0;
            self.last.clear();
            self.last.extend_from_slice(sightings);
            return false;
        }
        self.repeats = self.repeats.saturating_add(1);
        most > 0 && self.repeats >= most
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::MapDisc;
    use crate::vision::Colour;
    use nalgebra::Point2;

    #[test]
    fn equal_pictures_are_no_news() {
        let disc = |inside: f64| {
            let disc = MapDisc { colour: Colour::Yellow, position: Point2::new(1.0, 1.0) };
            Sighting { disc, inside }
        };
        let (one, other) = ([disc(1.0), disc(2.0)], [disc(1.0), disc(3.0)]);
        let mut frozen = Frozen::default();
        let looks = [&one, &one, &one, &one, &other, &one].map(|picture| frozen.look(picture, 3));
        assert_eq!(looks, [false, false, false, true, false, false]);
        assert!((0..9).all(|_| !frozen.look(&[], 3)), "nothing is seen: that is another matter");
        assert!((0..9).all(|_| !frozen.look(&one, 0)), "not asked for");
    }
}
