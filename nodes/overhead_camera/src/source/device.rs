//! A Video4Linux2 camera.
//!
//! Drivers hand a frame over when its last row has been read out. The device is asked for it half a millisecond at a time
//! around the moment when it is expected, so that the moment is known to that; how long before the middle of the exposure
//! was is a constant of the camera (`exposure_delay`).

use super::decode::{self, decode};
use super::{FrameSource, SourceError, Taken};
use crate::frame::{Encoding, Frame};
use linuxvideo::format::{PixFormat, PixelFormat as FourCc};
use linuxvideo::stream::{ReadBufferView, ReadStream};
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
    open: Option<Open>,
    next_look: Steady,
}

struct Open {
    stream: ReadStream,
    step: u32,
    /// Seconds from one frame to the next.
    period: f64,
    last_frame: Steady,
}

impl DeviceSource {
    /// The camera at `path`: frames of `size` (width, height), `rate` of them a second.
    #[must_use]
    pub fn new(path: &str, size: [u32; 2], rate: f64, format: PixelFormat, exposure_delay: f64) -> Self {
        Self { path: path.to_owned(), size, rate, format, exposure_delay, open: None, next_look: Steady(0) }
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
        let step = given.bytes_per_line();
        let asked = Fract::new(1000, (1000.0 * self.rate) as u32);
        // A driver that has one rate only refuses to be asked.
        let interval = device.set_frame_interval(asked).unwrap_or(asked);
        let period = f64::from(interval.numerator()) / f64::from(interval.denominator().max(1));
        Ok(Open { stream: device.into_stream()?, step, period, last_frame: now })
    }

    /// Takes the frame that is ready, if one is.
    fn look(&mut self, now: Times, give: &mut dyn FnMut(Frame<'_>)) -> io::Result<Result<Taken, SourceError>> {
        let late = now.steady.seconds_since(self.next_look);
        self.next_look = now.steady.plus_seconds(LOOK);
        let Some(open) = &mut self.open else { return Ok(Ok(Taken::NotYet)) };
        if open.stream.will_block()? {
            return if now.steady.seconds_since(open.last_frame) < SILENCE {
                Ok(Ok(Taken::NotYet))
            } else {
                Err(io::Error::other(format!("no frame for {SILENCE} s")))
            };
        }
        open.last_frame = now.steady;
        self.next_look = now.steady.plus_seconds(open.period - EARLY);
        if late > 0.5 * open.period {
            // When this frame came is not known any more: better none than one with a wrong stamp.
            open.stream.dequeue(|_| Ok(()))?;
            return Ok(Ok(Taken::NotYet));
        }
        let exposed = now.ros.plus_seconds(-self.exposure_delay);
        let (step, format, size) = (open.step, self.format, self.size);
        open.stream.dequeue(|view| Ok(hand_over(&view, exposed, step, format, size, give)))
    }
}

fn hand_over(
    view: &ReadBufferView<'_>,
    exposed: RosTime,
    step: u32,
    format: PixelFormat,
    [width, height]: [u32; 2],
    give: &mut dyn FnMut(Frame<'_>),
) -> Result<Taken, SourceError> {
    if view.is_error() {
        return Err(SourceError::Frame("the camera says that a frame is damaged".to_owned()));
    }
    match format {
        PixelFormat::Jpeg => give(decode::frame(&decode(view, "a frame")?, exposed)),
        PixelFormat::Raw(encoding) => {
            let length = (step as usize).saturating_mul(height as usize);
            let pixels = view
                .get(..length)
                .ok_or_else(|| SourceError::Frame(format!("a frame has {} bytes, {length} are needed", view.len())))?;
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
}
