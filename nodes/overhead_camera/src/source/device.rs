//! A Video4Linux2 camera.
//!
//! Drivers hand a frame over when its last row has been read out. The device is asked for it every half millisecond from
//! shortly before it is expected, so that the moment is known to that; how long before the middle of the exposure was is
//! a constant of the camera (`exposure_delay`). A frame whose moment is not known is dropped.

use super::controls::Controls;
use super::decode::{self, decode};
use super::driver::{Driver, Streaming, Video4Linux2, Wanted};
use super::{FrameSource, SourceError, Taken};
use crate::frame::{Encoding, Frame};
use linuxvideo::format::PixelFormat as FourCc;
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
    driver: Box<dyn Driver>,
    open: Option<Open>,
    next_look: Steady,
}

struct Open {
    device: Streaming,
    rhythm: Rhythm,
}

impl DeviceSource {
    /// The camera at `path`: frames of `size` (width, height), `rate` of them a second.
    #[must_use]
    pub fn new(path: &str, size: [u32; 2], rate: f64, format: PixelFormat, exposure_delay: f64) -> Self {
        Self {
            path: path.to_owned(),
            size,
            rate,
            format,
            exposure_delay,
            controls: Controls::default(),
            driver: Box::new(Video4Linux2),
            open: None,
            next_look: Steady(0),
        }
    }

    fn open(&self, now: Steady) -> io::Result<Open> {
        let wanted = Wanted { size: self.size, rate: self.rate, code: self.format.code() };
        let device = self.driver.open(&self.path, wanted, &self.controls)?;
        Ok(Open { rhythm: Rhythm::new(now, device.period), device })
    }

    /// Takes the frame that is ready, if one is.
    fn look(&mut self, now: Times, give: &mut dyn FnMut(Frame<'_>)) -> io::Result<Result<Taken, SourceError>> {
        let Some(open) = &mut self.open else { return Ok(Ok(Taken::NotYet)) };
        let is_there = open.device.buffers.is_ready()?;
        let (is_known, next_look) = open.rhythm.look(now.steady, is_there);
        self.next_look = next_look;
        match (is_there, is_known) {
            (true, true) => {}
            (true, false) => {
                open.device.buffers.take(&mut |_, _| ())?;
                return Ok(Ok(Taken::NotYet));
            }
            (false, _) if open.rhythm.silence(now.steady) < SILENCE => return Ok(Ok(Taken::NotYet)),
            (false, _) => return Err(io::Error::other(format!("no frame for {SILENCE} s"))),
        }
        let exposed = now.ros.plus_seconds(-self.exposure_delay);
        let (step, format, size) = (open.device.step, self.format, self.size);
        let mut taken = Ok(Taken::NotYet);
        open.device.buffers.take(&mut |filled, is_damaged| {
            taken = if is_damaged {
                Err(SourceError::Frame("the camera says that a frame is damaged".to_owned()))
            } else {
                hand_over(filled, exposed, step, format, size, give)
            };
        })?;
        Ok(taken)
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
mod tests;
