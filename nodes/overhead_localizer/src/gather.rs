//! Frames of several cameras, exposed together, become one look at the field.

use crate::intake::Sighting;
use crate::track::MapDisc;
use trench_core::{RosTime, Steady};
use trench_msgs::builtin_interfaces::Time;

/// Two cameras' sightings nearer than this are of one disc, m: discs of one colour are 80 mm apart at least, robots that
/// touch included.
const SAME: f64 = 0.03;
/// How long the frames of the other cameras are waited for, s.
const PATIENCE: f64 = 0.012;
/// A clock that runs back this far, s, was set anew: less is a frame out of order.
const SET_BACK: f64 = 1.0;

/// Puts the frames of an exposure together.
pub(crate) struct Gather {
    cameras: usize,
    /// Stamps that differ by less are of one exposure, s.
    together: f64,
    open: Option<Exposure>,
    /// The last exposure that was closed.
    last: Option<RosTime>,
    /// What each camera stamped last.
    stamps: Vec<Option<RosTime>>,
    /// Exposures so far.
    count: u64,
    /// Frames that did not come in time.
    pub(crate) missing: u64,
}

struct Exposure {
    stamp: Time,
    came: Steady,
    /// Of each camera whose frame has come.
    sightings: Vec<Option<Vec<Sighting>>>,
}

/// A look at the whole field.
pub(crate) struct Look {
    /// Of the frame that came first.
    pub(crate) stamp: Time,
    /// Counts from 1.
    pub(crate) number: u64,
    /// Each once, whatever number of cameras saw it.
    pub(crate) discs: Vec<MapDisc>,
}

impl Gather {
    pub(crate) fn new(cameras: usize, together: f64) -> Self {
        Self { cameras, together, open: None, last: None, stamps: vec![None; cameras], count: 0, missing: 0 }
    }

    /// Whether a frame of this camera with this stamp is wanted. A clock was set back if this camera's own was: one whose clock is
    /// behind the others' is late, with every frame.
    pub(crate) fn wants(&mut self, camera: usize, stamp: RosTime) -> bool {
        let before = self.stamps.get_mut(camera).and_then(|last| last.replace(stamp));
        let was_set = before.is_some_and(|before| stamp.seconds_since(before) < -SET_BACK);
        if let Some(open) = &self.open {
            let later = stamp.seconds_since(RosTime::from(&open.stamp));
            if later.abs() <= self.together {
                return open.sightings.get(camera).is_some_and(Option::is_none);
            }
            return later > 0.0 || (was_set && later < -SET_BACK);
        }
        self.last.is_none_or(|last| {
            let later = stamp.seconds_since(last);
            later > self.together || (was_set && later < -SET_BACK)
        })
    }

    /// Takes a frame that is wanted; gives the looks that are complete with it, or that it makes too late.
    pub(crate) fn take(&mut self, at: Steady, camera: usize, stamp: Time, sightings: &[Sighting]) -> Vec<Look> {
        let mut looks = Vec::new();
        let is_other =
            |open: &Exposure| RosTime::from(&stamp).seconds_since(RosTime::from(&open.stamp)).abs() > self.together;
        if self.open.as_ref().is_some_and(is_other) {
            looks.extend(self.close());
        }
        let cameras = self.cameras;
        let open = self.open.get_or_insert_with(|| Exposure { stamp, came: at, sightings: vec![None; cameras] });
        if let Some(place) = open.sightings.get_mut(camera) {
            *place = Some(sightings.to_vec());
        }
        if open.sightings.iter().all(Option::is_some) {
            looks.extend(self.close());
        }
        looks
    }

    /// When the open exposure is closed, whoever is missing.
    pub(crate) fn deadline(&self) -> Option<Steady> {
        self.open.as_ref().map(|open| open.came.plus_seconds(PATIENCE))
    }

    /// The look whose deadline has passed.
    pub(crate) fn overdue(&mut self, at: Steady) -> Option<Look> {
        if self.deadline()? <= at { self.close() } else { None }
    }

    fn close(&mut self) -> Option<Look> {
        let open = self.open.take()?;
        self.last = Some(RosTime::from(&open.stamp));
        self.count += 1;
        self.missing += open.sightings.iter().filter(|frame| frame.is_none()).count() as u64;
        let frames: Vec<Vec<Sighting>> = open.sightings.into_iter().flatten().collect();
        Some(Look { stamp: open.stamp, number: self.count, discs: merged(&frames) })
    }
}

/// Each disc once: the mean of all cameras' sightings, weighted by how far inside their pictures it is, so that a robot
/// that leaves one picture is handed over without a jump however well the cameras agree.
fn merged(frames: &[Vec<Sighting>]) -> Vec<MapDisc> {
    struct Sum {
        disc: MapDisc,
        weight: f64,
        last_camera: usize,
    }
    let mut sums: Vec<Sum> = Vec::new();
    for (camera, frame) in frames.iter().enumerate() {
        for sighting in frame {
            let distance = |sum: &Sum| (sum.disc.position - sighting.disc.position).norm();
            let same = sums
                .iter_mut()
                .filter(|sum| sum.last_camera != camera && sum.disc.colour == sighting.disc.colour)
                .filter(|sum| distance(sum) < SAME)
                .min_by(|a, b| distance(a).total_cmp(&distance(b)));
            match same {
                Some(sum) => {
                    sum.weight += sighting.inside;
                    let share = sighting.inside / sum.weight;
                    sum.disc.position += share * (sighting.disc.position - sum.disc.position);
                    sum.last_camera = camera;
                }
                None => sums.push(Sum { disc: sighting.disc, weight: sighting.inside, last_camera: camera }),
            }
        }
    }
    sums.into_iter().map(|sum| sum.disc).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vision::Colour;
    use nalgebra::Point2;

    fn sighting(colour: Colour, x: f64, inside: f64) -> Sighting {
        Sighting { disc: MapDisc { colour, position: Point2::new(x, 0.0) }, inside }
    }

    fn stamp(milliseconds: i64) -> Time {
        RosTime(1_000_000 * milliseconds).into()
    }

    fn at(milliseconds: u64) -> Steady {
        Steady(1_000_000 * milliseconds)
    }

    #[test]
    fn frames_of_one_exposure_are_one_look() {
        let mut gather = Gather::new(2, 0.002);
        let yellow = [sighting(Colour::Yellow, 1.0, 100.0)];
        assert!(gather.take(at(0), 0, stamp(1000), &yellow).is_empty());
        assert!(!gather.wants(0, RosTime::from(&stamp(1000))) && gather.wants(1, RosTime::from(&stamp(1001))));
        let looks = gather.take(at(3), 1, stamp(1001), &[]);
        assert_eq!((looks.len(), looks[0].number, looks[0].discs.len(), gather.missing), (1, 1, 1, 0));
        assert!(!gather.wants(1, RosTime::from(&stamp(1001))) && !gather.wants(0, RosTime::from(&stamp(900))));
        assert!(gather.wants(0, RosTime::from(&stamp(-900))), "a clock set back");
    }

    #[test]
    fn a_camera_that_is_late_is_not_waited_for() {
        let mut gather = Gather::new(2, 0.002);
        gather.take(at(0), 0, stamp(1000), &[]);
        assert_eq!(gather.deadline(), Some(at(12)));
        assert!(gather.overdue(at(11)).is_none());
        assert!(gather.overdue(at(12)).is_some() && gather.missing == 1);
        assert!(!gather.wants(1, RosTime::from(&stamp(1000))), "too late");
        // The next exposure closes an open one.
        gather.take(at(40), 0, stamp(1040), &[]);
        let looks = gather.take(at(45), 0, stamp(1080), &[]);
        assert_eq!((looks.len(), looks[0].number, gather.missing), (1, 2, 2));
    }

    /// Two cameras, one 1.5 s behind the other: the one ahead goes on, and when both clocks are set back, both are followed.
    #[test]
    fn a_clock_that_is_behind_is_none_that_was_set_back() {
        let mut gather = Gather::new(2, 0.002);
        let mut wanted = |camera: usize, now: u64, milliseconds: i64| {
            let is_wanted = gather.wants(camera, RosTime::from(&stamp(milliseconds)));
            if is_wanted {
                gather.take(at(now), camera, stamp(milliseconds), &[]);
            }
            is_wanted
        };
        for frame in 0..50 {
            let now = 40 * frame as u64;
            assert!(wanted(0, now, 100_000 + 40 * frame), "frame {frame}");
            assert!(!wanted(1, now + 5, 98_500 + 40 * frame), "frame {frame}");
        }
        for frame in 0..50 {
            let now = 2000 + 40 * frame as u64;
            assert!(wanted(0, now, 50_000 + 40 * frame) && wanted(1, now + 5, 50_000 + 40 * frame), "frame {frame}");
        }
    }

    #[test]
    fn what_two_cameras_see_is_there_once_and_handed_over_without_a_jump() {
        // The cameras disagree by 4 mm. A disc goes from the one's picture into the other's.
        let place = |inside: f64| {
            let (west, east) = (sighting(Colour::Blue, 1.0, inside), sighting(Colour::Blue, 1.004, 101.0 - inside));
            let discs = merged(&[vec![west], vec![east]]);
            assert_eq!(discs.len(), 1);
            discs[0].position.x
        };
        let first = merged(&[vec![sighting(Colour::Blue, 1.0, 100.0)]])[0].position.x;
        let places: Vec<f64> = [first].into_iter().chain((1..=100).rev().map(|step| place(f64::from(step)))).collect();
        assert!(places.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 5e-5), "{places:?}");
        assert!((places[100] - 1.004).abs() < 5e-5);
        // Discs of other colours, of the same camera, or farther apart stay what they are.
        let near =
            [sighting(Colour::Blue, 1.0, 9.0), sighting(Colour::Blue, 1.01, 9.0), sighting(Colour::Yellow, 1.0, 9.0)];
        assert_eq!(merged(&[near.to_vec(), vec![sighting(Colour::Blue, 1.08, 9.0)]]).len(), 4);
    }
}
