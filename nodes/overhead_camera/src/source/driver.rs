//! What a camera's driver does for us: Video4Linux2's.

use super::controls::Controls;
use linuxvideo::format::{PixFormat, PixelFormat as FourCc};
use linuxvideo::stream::ReadStream;
use linuxvideo::{Device, Fract};
use std::io;

/// What a device is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wanted {
    /// Width and height.
    pub(super) size: [u32; 2],
    /// Frames a second.
    pub(super) rate: f64,
    pub(super) code: FourCc,
}

/// A device that sends what was asked for.
pub(super) struct Streaming {
    pub(super) buffers: Box<dyn Buffers>,
    /// Bytes a row.
    pub(super) step: u32,
    /// From frame to frame, s, as the device says.
    pub(super) period: f64,
}

/// Opens devices.
pub(super) trait Driver: Send {
    /// # Errors
    /// With the reason, when there is no such device, or it does not send this.
    fn open(&self, path: &str, wanted: Wanted, controls: &Controls) -> io::Result<Streaming>;
}

/// The buffers that a device fills.
pub(super) trait Buffers: Send {
    /// Whether one is full.
    fn is_ready(&self) -> io::Result<bool>;

    /// Shows a full one, and whether the device says that it is damaged; then it is filled anew.
    fn take(&mut self, show: &mut dyn FnMut(&[u8], bool)) -> io::Result<()>;
}

/// The kernel's.
pub(super) struct Video4Linux2;

impl Driver for Video4Linux2 {
    fn open(&self, path: &str, Wanted { size, rate, code }: Wanted, controls: &Controls) -> io::Result<Streaming> {
        let [width, height] = size;
        let device = Device::open(path)?.video_capture(PixFormat::new(width, height, code))?;
        let given = device.format();
        if [given.width(), given.height()] != size || given.pixel_format() != code {
            return Err(io::Error::other(format!(
                "it offers {} x {} {}, not {width} x {height} {code}",
                given.width(),
                given.height(),
                given.pixel_format(),
            )));
        }
        controls.apply(path).map_err(io::Error::other)?;
        let step = given.bytes_per_line();
        let asked = Fract::new(1000, (1000.0 * rate) as u32);
        // A driver that has one rate only refuses to be asked.
        let interval = device.set_frame_interval(asked).unwrap_or(asked);
        let period = f64::from(interval.numerator()) / f64::from(interval.denominator().max(1));
        Ok(Streaming { buffers: Box::new(device.into_stream()?), step, period })
    }
}

impl Buffers for ReadStream {
    fn is_ready(&self) -> io::Result<bool> {
        Ok(!self.will_block()?)
    }

    fn take(&mut self, show: &mut dyn FnMut(&[u8], bool)) -> io::Result<()> {
        self.dequeue(|view| {
            show(&view, view.is_error());
            Ok(())
        })
    }
}
