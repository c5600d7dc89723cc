//! A Video4Linux2 camera.
//!
//! Drivers hand a frame over when its last row has been read out. The device is asked for it every half millisecond from
//! shortly before it is expected, so that the moment is known to that; how long before the middle of the exposure was is
//! a constant of the camera (`exposure_delay`). A frame whose moment is not known is dropped.

use super::controls::Controls;
use super::decode::{self, decode};
use super::{FrameSource, SourceError, Taken};
use crate::frame::{Encoding, Frame};
use linuxvideo::format::{PixFormat, PixelFormat as FourCc};
use linuxvideo::stream::ReadStream;
use linuxvideo::{Device, Fract};
use std::io;
use trench_core::{RosTime, Steady, Times};

/// What the device is asked to send.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PixelFormat {
    /// Pixels as they are.
    Raw(Encoding),
    /// A JPEG image a frame; decoded to rgb8 here.
    Jpeg,
}

impl PixelFormat {
    fn code(self) -> FourCc {
        match self {
            Self::Raw(Encoding::Rgb8) => FourCc::RGB3,
            Self::Raw(Encoding::Bgr8) => FourCc::BGR3,
            Self::Raw(Encoding::Yuv422Yuy2) => FourCc::YUYV,
            Self::Jpeg => FourCc::MJPG,
        }
    }
}

/// How long between two looks at a device that should have a frame, s.
const LOOK: f64 = 0.0005;
/// How long before the expected moment the looks begin, s.
const EARLY: f64 = 0.003;
/// A frame's arrival is known if a look so long before, s, was in vain.
const KNOWN: f64 = 0.002;
/// How long a device may send nothing, s; then it is opened anew.
const SILENCE: f64 = 2.0;
/// How long until a device that is away is looked for again, s.
const RETRY: f64 = 0.5;

/// A camera that may vanish and come back.
pub struct DeviceSource {
    path: String,
    size: [u32; 2],
    rate: f64,
    format: PixelFormat,
    exposure_delay: f64,
    controls: Controls,
    open: Option<Open>,
    next_look: Steady,
}

struct Open {
    stream: ReadStream,
    step: u32,
    rhythm: Rhythm,
}

impl DeviceSource {
    /// The camera at `path`: frames of `size` (width, height), `rate` of them a second.
    #[must_use]
    pub fn new(path: &str, size: [u32; 2], rate: f64, format: PixelFormat, exposure_delay: f64) -> Self {
        let controls = Controls::default();
        Self { path: path.to_owned(), size, rate, format, exposure_delay, controls, open: None, next_look: Steady(0) }
    }

    fn open(&self, now: Steady) -> io::Result<Open> {
        let [width, height] = self.size;
        let device = Device::open(&self.path)?.video_capture(PixFormat::new(width, height, self.format.code()))?;
        let given = device.format();
        if [given.width(), given.height()] != self.size || given.pixel_format() != self.format.code() {
            return Err(io::Error::other(format!(
                "it offers {} x {} {}, not {width} x {height} {}",
                given.width(),
                given.height(),
                given.pixel_format(),
                self.format.code()
            )));
        }
        self.controls.apply(&self.path).map_err(io::Error::other)?;
        let step = given.bytes_per_line();
        let asked = Fract::new(1000, (1000.0 * self.rate) as u32);
        // A driver that has one rate only refuses to be asked.
        let interval = device.set_frame_interval(asked).unwrap_or(asked);
        let period = f64::from(interval.numerator()) / f64::from(interval.denominator().max(1));
        Ok(Open { stream: device.into_stream()?, step, rhythm: Rhythm::new(now, period) })
    }

    /// Takes the frame that is ready, if one is.
    fn look(&mut self, now: Times, give: &mut dyn FnMut(Frame<'_>)) -> io::Result<Result<Taken, SourceError>> {
        let Some(open) = &mut self.open else { return Ok(Ok(Taken::NotYet)) };
        let is_there = !open.stream.will_block()?;
        let (is_known, next_look) = open.rhythm.look(now.steady, is_there);
        self.next_look = next_look;
        match (is_there, is_known) {
            (true, true) => {}
            (true, false) => {
                open.stream.dequeue(|_| Ok(()))?;
                return Ok(Ok(Taken::NotYet));
            }
            (false, _) if open.rhythm.silence(now.steady) < SILENCE => return Ok(Ok(Taken::NotYet)),
            (false, _) => return Err(io::Error::other(format!("no frame for {SILENCE} s"))),
        }
        let exposed = now.ros.plus_seconds(-self.exposure_delay);
        let (step, format, size) = (open.step, self.format, self.size);
        let damaged = || SourceError::Frame("the camera says that a frame is damaged".to_owned());
        open.stream.dequeue(|view| {
            Ok(if view.is_error() { Err(damaged()) } else { hand_over(&view, exposed, step, format, size, give) })
        })
    }
}

/// When to look for the next frame.
#[derive(Debug, Clone, Copy)]
struct Rhythm {
    last_frame: Steady,
    last_in_vain: Option<Steady>,
    /// Seconds from a frame to the first look for the next.
    wait: f64,
    longest_wait: f64,
}

impl Rhythm {
    /// For a device that says that its frames are `period` (s) apart.
    fn new(now: Steady, period: f64) -> Self {
        Self { last_frame: now, last_in_vain: None, wait: period - EARLY, longest_wait: 2.0 * period }
    }

    /// Takes the result of a look; says whether the arrival of the frame that is there is known, and when to look again.
    fn look(&mut self, now: Steady, is_there: bool) -> (bool, Steady) {
        if !is_there {
            self.last_in_vain = Some(now);
            return (false, now.plus_seconds(LOOK));
        }
        let is_known = self.last_in_vain.take().is_some_and(|look| now.seconds_since(look) <= KNOWN);
        let interval = now.seconds_since(self.last_frame);
        // A frame that was there before it was expected: the device is faster than it says.
        self.wait = if is_known { (interval - EARLY).clamp(0.0, self.longest_wait) } else { 0.5 * self.wait };
        self.last_frame = now;
        (is_known, now.plus_seconds(self.wait))
    }

    /// Seconds since the last frame.
    fn silence(&self, now: Steady) -> f64 {
        now.seconds_since(self.last_frame)
    }
}

/// Makes a frame of what the driver filled its buffer with.
fn hand_over(
    filled: &[u8],
    exposed: RosTime,
    step: u32,
    format: PixelFormat,
    [width, height]: [u32; 2],
    give: &mut dyn FnMut(Frame<'_>),
) -> Result<Taken, SourceError> {
    match format {
        PixelFormat::Jpeg => give(decode::frame(&decode(filled, "a frame")?, exposed)),
        PixelFormat::Raw(encoding) => {
            let length = (step as usize).saturating_mul(height as usize);
            let pixels = filled.get(..length).ok_or_else(|| {
                SourceError::Frame(format!("a frame has {} bytes, {length} are needed", filled.len()))
            })?;
            give(Frame { exposed, width, height, step, encoding, pixels });
        }
    }
    Ok(Taken::Frame)
}

impl FrameSource for DeviceSource {
    fn most_bytes(&self) -> usize {
        // Drivers may pad rows, hardly ever to more than a page.
        let [width, height] = self.size;
        (3 * width as usize).next_multiple_of(4096) * height as usize
    }

    fn start(&mut self, at: Steady) {
        self.next_look = at;
    }

    fn take(&mut self, now: Times, give: &mut dyn FnMut(Frame<'_>)) -> Result<Taken, SourceError> {
        if now.steady < self.next_look {
            return Ok(Taken::NotYet);
        }
        if self.open.is_none() {
            self.next_look = now.steady.plus_seconds(RETRY);
            let opened = self.open(now.steady);
            self.open = Some(opened.map_err(|error| SourceError::Away(format!("cannot open {}: {error}", self.path)))?);
            self.next_look = now.steady.plus_seconds(LOOK);
            return Ok(Taken::NotYet);
        }
        self.look(now, give).unwrap_or_else(|error| {
            self.open = None;
            self.next_look = now.steady.plus_seconds(RETRY);
            Err(SourceError::Away(format!("{} broke: {error}", self.path)))
        })
    }

    fn control(&mut self, controls: Controls) -> Result<(), String> {
        if self.open.is_some() {
            controls.apply(&self.path)?;
        }
        self.controls = controls;
        Ok(())
    }

    fn next_look(&self) -> Option<Steady> {
        Some(self.next_look)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_that_is_none_is_looked_for_again() {
        for path in ["/dev/null", "/dev/no-such-camera"] {
            let mut source = DeviceSource::new(path, [768, 576], 30.0, PixelFormat::Jpeg, 0.0);
            source.start(Steady(5));
            let mut look = |nanoseconds| {
                let now = Times { ros: RosTime(0), steady: Steady(nanoseconds) };
                source.take(now, &mut |frame| panic!("{frame:?}")).map_err(|error| error.to_string())
            };
            assert_eq!(look(4), Ok(Taken::NotYet));
            for due in [5, 500_000_005] {
                let error = look(due).unwrap_err();
                assert!(error.starts_with(&format!("cannot open {path}: ")), "{error}");
                assert_eq!(look(due + 400_000_000), Ok(Taken::NotYet));
            }
        }
    }

    /// What becomes of a buffer: size, step, encoding and first bytes of the frame, or the reason why there is none.
    fn handed_over(filled: &[u8], step: u32, format: PixelFormat) -> Result<(u32, u32, Encoding, Vec<u8>), String> {
        let mut frame = None;
        let exposed = RosTime(7);
        let taken = hand_over(filled, exposed, step, format, [16, 8], &mut |given| {
            given.check(Some([16, 8]), 4096).unwrap();
            assert_eq!(given.exposed, exposed);
            frame = Some((given.width, given.step, given.encoding, given.pixels[..3].to_vec()));
        });
        taken.map_err(|error| error.to_string()).map(|taken| {
            assert_eq!(taken, Taken::Frame);
            frame.unwrap()
        })
    }

    #[test]
    fn buffers_become_frames() {
        let raw = PixelFormat::Raw;
        // Drivers' buffers are longer than their frames, and rows may be padded.
        assert_eq!(
            handed_over(&[9; 512], 32, raw(Encoding::Yuv422Yuy2)),
            Ok((16, 32, Encoding::Yuv422Yuy2, vec![9; 3]))
        );
        assert_eq!(handed_over(&[9; 512], 64, raw(Encoding::Rgb8)), Ok((16, 64, Encoding::Rgb8, vec![9; 3])));
        assert_eq!(
            handed_over(&[9; 511], 64, raw(Encoding::Bgr8)),
            Err("a frame has 511 bytes, 512 are needed".to_owned())
        );
        let mut jpeg = std::io::Cursor::new(Vec::new());
        let picture = image::RgbImage::from_pixel(16, 8, image::Rgb([90; 3]));
        picture.write_to(&mut jpeg, image::ImageFormat::Jpeg).unwrap();
        let jpeg = jpeg.into_inner();
        assert_eq!(handed_over(&jpeg, 0, PixelFormat::Jpeg), Ok((16, 48, Encoding::Rgb8, vec![90; 3])));
        assert!(handed_over(&jpeg[..20], 0, PixelFormat::Jpeg).unwrap_err().starts_with("a frame: "));
    }

    /// How many of the frames that arrive every `actual` (s) in ten seconds are taken, by a device that says `told`.
    fn taken(told: f64, actual: f64, hold_up: Option<f64>) -> (u32, u32) {
        let mut rhythm = Rhythm::new(Steady(0), told);
        let (mut now, mut taken, mut looks, mut held_up) = (Steady(0), 0, 0, hold_up);
        let mut arrivals = (1..).map(|frame| Steady((1e9 * actual * f64::from(frame)) as u64)).peekable();
        while now < Steady(10_000_000_000) {
            looks += 1;
            let arrival = arrivals.next_if(|arrival| *arrival <= now);
            let (is_known, next) = rhythm.look(now, arrival.is_some());
            if is_known {
                taken += 1;
                assert!(now.seconds_since(arrival.unwrap()) <= KNOWN, "stamped at {now:?}: {arrival:?}");
            }
            now = next.max(Steady(now.0 + 20_000));
            if let Some(seconds) = held_up.take_if(|_| now > Steady(5_000_000_000)) {
                now = now.plus_seconds(seconds);
            }
        }
        (taken, looks)
    }

    #[test]
    fn arrivals_are_known_whatever_the_device_says_of_its_rate() {
        let check = |told: f64, actual: f64, hold_up: Option<f64>, dropped: u32| {
            let (taken, looks) = taken(told, actual, hold_up);
            let frames = (10.0 / actual) as u32;
            assert!(taken + dropped >= frames - 1, "{taken} of {frames}, told {told} s, are {actual} s apart");
            assert!(looks < 12 * frames + 200, "{looks} looks for {frames} frames");
        };
        check(0.033, 0.033, None, 0);
        check(0.033, 0.0333, None, 0);
        check(0.033, 0.04, None, 0);
        check(0.04, 0.033, None, 1);
        check(0.1, 0.0167, None, 12);
        check(0.033, 0.0333, Some(0.15), 6);
    }
}
