//! From an incoming message to discs on the map.

use crate::refusal::{Dropped, Refusal};
use crate::settings::{Input, Pattern, Settings};
use crate::track::MapDisc;
use crate::vision::coded::{CodeReader, CodedPad, MIDDLE};
use crate::vision::{Colour, Detector, Disc, Expectation, Frame, decode};
use trench_core::{Qos, RosTime, Subscribe};
use trench_msgs::Message;
use trench_msgs::builtin_interfaces::Time;
use trench_msgs::msg::{Disc as DiscMessage, DiscArray, PadArray};
use trench_msgs::sensor_msgs::{CompressedImage, Image, ImageView};
use trench_msgs::std_msgs::HeaderView;
use trench_optics::{Camera, Overhead, Pad, Pixel};

/// More discs than any detector finds pads for: such a message is broken.
const MOST_DISCS: usize = 1024;

/// A disc, and how far inside its camera's picture it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sighting {
    pub(crate) disc: MapDisc,
    /// From its edge to the picture's, pixels; not below 1.
    pub(crate) inside: f64,
}

/// Reads messages of the kind that the settings ask for.
pub(crate) struct Intake {
    camera: Camera,
    pad_height: f64,
    /// Of a disc in the picture, pixels.
    radius: f64,
    input: Input,
    detector: Detector,
    /// Of coded pads: the colour of their middles, and who reads them.
    codes: Option<(Colour, CodeReader)>,
    coded: Vec<CodedPad>,
    /// Pixels of frames that cannot be read in place.
    room: Vec<u8>,
    found: Vec<Disc>,
}

impl Intake {
    /// None if the camera could not see any pad.
    pub(crate) fn new(settings: &Settings, view: &Overhead) -> Option<Self> {
        let (camera, pad) = (view.camera.clone(), &settings.team.pad);
        let middle = match settings.pattern {
            Pattern::Discs => None,
            Pattern::Coded(colour) => Some(colour),
        };
        let disc_diameter = if middle.is_some() { MIDDLE } else { pad.disc_diameter };
        let expectation = Expectation::new(&camera, &Pad { disc_diameter, ..*pad })?;
        let detector = Detector::new(&settings.colours, expectation);
        let detector = if middle.is_some() { detector.of_single_discs() } else { detector };
        let codes = middle.map(|colour| (colour, CodeReader::new(camera.clone(), pad.height)));
        let (pad_height, input, radius) = (pad.height, settings.input, 0.5 * expectation.width);
        let (room, found, coded) = (Vec::new(), Vec::new(), Vec::new());
        Some(Self { camera, pad_height, radius, input, detector, codes, coded, room, found })
    }

    /// What it reads.
    pub(crate) fn subscription(input: Input, view: &Overhead) -> Subscribe {
        let read = |topic: &str, type_info| Subscribe::of_type(view.topic(topic), type_info, Qos::SENSOR);
        match input {
            Input::Image => read("image_raw", Image::TYPE),
            Input::Compressed => read("image_raw/compressed", CompressedImage::TYPE),
            Input::Detections => read("detections", DiscArray::TYPE),
            Input::Pads => read("pads", PadArray::TYPE),
        }
    }

    /// Puts the discs of a message into `discs`, unless `is_new` refuses its stamp; gives the stamp and what `is_new` said.
    ///
    /// # Errors
    /// With the reason, when the message is not what it should be, or `is_new` says that it does not count.
    pub(crate) fn take(
        &mut self,
        cdr: &[u8],
        is_new: impl FnOnce(RosTime) -> Result<Option<f64>, Refusal>,
        discs: &mut Vec<Sighting>,
    ) -> Result<Option<(Time, f64)>, Dropped> {
        match self.input {
            Input::Image => {
                let image = ImageView::decode(cdr).map_err(|error| error.to_string())?;
                self.frame(&image, is_new, discs)
            }
            Input::Compressed => {
                let packed = CompressedImage::decode(cdr).map_err(|error| error.to_string())?;
                let image = decode(&packed.data)?;
                let (width, height) = image.dimensions();
                let frame = ImageView {
                    header: HeaderView { stamp: packed.header.stamp, frame_id: &packed.header.frame_id },
                    height,
                    width,
                    encoding: "rgb8",
                    is_bigendian: 0,
                    step: 3 * width,
                    data: image.as_raw(),
                };
                self.frame(&frame, is_new, discs)
            }
            Input::Detections => self.detections(cdr, is_new, discs),
            Input::Pads => Err("pads are no discs".to_owned().into()),
        }
    }

    /// The coded pads of the last frame.
    pub(crate) fn coded(&self) -> &[CodedPad] {
        &self.coded
    }

    fn size(&self) -> [usize; 2] {
        let lens = self.camera.lens();
        [lens.width as usize, lens.height as usize]
    }

    fn frame(
        &mut self,
        image: &ImageView<'_>,
        is_new: impl FnOnce(RosTime) -> Result<Option<f64>, Refusal>,
        discs: &mut Vec<Sighting>,
    ) -> Result<Option<(Time, f64)>, Dropped> {
        let (size, stamp) = ([image.width as usize, image.height as usize], image.header.stamp);
        let frame = Frame::new(self.size(), image.encoding, size, image.step as usize, image.data, &mut self.room)
            .map_err(|error| error.to_string())?;
        let Some(interval) = is_new(RosTime::from(&stamp))? else { return Ok(None) };
        self.detector.detect(frame, &mut self.found);
        if let Some((colour, reader)) = &self.codes {
            self.found.retain(|disc| disc.colour == *colour);
            let light = self.detector.light();
            self.coded.clear();
            self.coded.extend(self.found.iter().filter_map(|disc| reader.read(frame, light, disc.centre)));
        }
        discs.clear();
        discs.extend(self.found.iter().filter_map(|disc| self.sighting(disc.colour, disc.centre)));
        Ok(Some((stamp, interval)))
    }

    fn sighting(&self, colour: Colour, centre: Pixel) -> Option<Sighting> {
        let disc = MapDisc::seen(&self.camera, self.pad_height, colour, centre)?;
        let [width, height] = self.size().map(|size| size as f64 - 1.0);
        let Pixel { u, v } = centre;
        let inside = u.min(v).min(width - u).min(height - v) - self.radius;
        Some(Sighting { disc, inside: inside.max(1.0) })
    }

    /// Takes the discs that another detector found.
    fn detections(
        &self,
        cdr: &[u8],
        is_new: impl FnOnce(RosTime) -> Result<Option<f64>, Refusal>,
        discs: &mut Vec<Sighting>,
    ) -> Result<Option<(Time, f64)>, Dropped> {
        let message = DiscArray::decode(cdr).map_err(|error| error.to_string())?;
        if message.discs.len() > MOST_DISCS {
            return Err(format!("more than {MOST_DISCS} discs").into());
        }
        discs.clear();
        for DiscMessage { colour, u, v, .. } in message.discs {
            let colour = match colour {
                DiscMessage::COLOUR_YELLOW => Colour::Yellow,
                DiscMessage::COLOUR_BLUE => Colour::Blue,
                other => return Err(format!("a disc has the colour {other}, it must be 0 or 1").into()),
            };
            if !(u.is_finite() && v.is_finite()) {
                return Err("a disc's place is not finite".to_owned().into());
            }
            discs.extend(self.sighting(colour, Pixel { u, v }));
        }
        Ok(is_new(RosTime::from(&message.header.stamp))?.map(|interval| (message.header.stamp, interval)))
    }
}
