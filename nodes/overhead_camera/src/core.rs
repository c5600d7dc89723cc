//! The camera as a state machine: looks at its source when that is due, frames out.

use crate::frame::Frame;
use crate::info::camera_info;
use crate::report::{PERIOD, Report};
use crate::settings::{Settings, controls};
use crate::source::{FrameSource, SourceError, Taken};
use trench_config::{ConfigError, Parameters};
use trench_core::{
    Advertise, Event, Health, Interface, Local, NodeContext, NodeCore, Qos, Sink, Steady, Times, resolve_name,
};
use trench_msgs::Message;
use trench_msgs::diagnostic_msgs::DiagnosticArray;
use trench_msgs::sensor_msgs::{CameraInfo, Image, ImageView};
use trench_msgs::std_msgs::HeaderView;
use trench_optics::Lens;

const IMAGE: usize = 0;
const DIAGNOSTICS: usize = 1;
const CAMERA_INFO: usize = 2;

/// Readers get so long, s, to take the last frame before the process and its shared memory end.
const LAST_LOOK: f64 = 0.5;
/// Most frames published in one turn: other events want theirs.
const AT_ONCE: usize = 4;

/// The node's core.
pub struct OverheadCamera {
    interface: Interface,
    settings: Settings,
    source: Box<dyn FrameSource>,
    report: Report,
    next_report: Steady,
    end: Option<Steady>,
}

impl OverheadCamera {
    /// A camera that has sent nothing yet.
    pub(crate) fn new(context: &NodeContext, settings: Settings, source: Box<dyn FrameSource>) -> Self {
        let name = resolve_name("~", &context.namespace, &context.name);
        Self {
            interface: interface(&settings, source.most_bytes()),
            report: Report::new(Health::new(name), DIAGNOSTICS),
            settings,
            source,
            next_report: Steady(0),
            end: None,
        }
    }

    /// Sends what is due.
    fn look(&mut self, at: Times, sink: &mut dyn Sink) {
        for _ in 0..AT_ONCE {
            let (settings, report, most) = (&self.settings, &mut self.report, self.source.most_bytes());
            let mut give = |frame: Frame<'_>| match send(&frame, settings, most, sink) {
                Ok(()) => report.sent(),
                Err(reason) => report.dropped(&reason, sink),
            };
            match self.source.take(at, &mut give) {
                Ok(Taken::Frame) => {}
                Ok(Taken::NotYet) => return,
                Ok(Taken::End) if self.end.is_none() => {
                    self.report.ended(sink);
                    self.end = Some(at.steady.plus_seconds(LAST_LOOK));
                    return;
                }
                Ok(Taken::End) => return,
                Err(SourceError::Frame(reason)) => self.report.dropped(&reason, sink),
                Err(SourceError::Away(reason)) => return self.report.fault(&reason, sink),
            }
        }
    }
}

/// Publishes a frame and its camera_info, pixels copied once: into the transport's memory.
fn send(frame: &Frame<'_>, settings: &Settings, most: usize, sink: &mut dyn Sink) -> Result<(), String> {
    let lens = settings.lens.as_ref();
    let expected = lens.map(|lens| [lens.width, lens.height]);
    frame.check(expected, most).map_err(|error| error.to_string())?;
    let header = HeaderView { stamp: frame.exposed.into(), frame_id: &settings.frame_id };
    let message = ImageView {
        header,
        height: frame.height,
        width: frame.width,
        encoding: frame.encoding.name(),
        is_bigendian: 0,
        step: frame.step,
        data: &[],
    };
    let length = message.encoded_len_with(frame.pixels.len());
    sink.publish_with(IMAGE, length, &mut |out| match message.encode_around(frame.pixels.len(), out) {
        Some(room) => {
            out[room].copy_from_slice(frame.pixels);
            length
        }
        None => 0,
    });
    if let Some(lens) = lens {
        sink.publish(CAMERA_INFO, &camera_info(frame.exposed, &settings.frame_id, lens));
    }
    Ok(())
}

fn interface(settings: &Settings, most_bytes: usize) -> Interface {
    let room = |encoding: &'static str| {
        let header = HeaderView { stamp: Default::default(), frame_id: &settings.frame_id };
        ImageView { header, height: 0, width: 0, encoding, is_bigendian: 0, step: 0, data: &[] }
            .encoded_len_with(most_bytes)
    };
    let image = Local::SharedMemoryOnly { max_len: room("yuv422_yuy2") };
    let advertise = |topic: &str, type_info, qos, local| Advertise { topic: topic.to_owned(), type_info, qos, local };
    let mut publications = vec![
        advertise("/overhead/image_raw", Image::TYPE, Qos::SENSOR, image),
        advertise("/diagnostics", DiagnosticArray::TYPE, Qos::RELIABLE, Local::NetworkOnly),
    ];
    let info = |_: &Lens| advertise("/overhead/camera_info", CameraInfo::TYPE, Qos::RELIABLE, Local::NetworkOnly);
    publications.extend(settings.lens.as_ref().map(info));
    Interface { publications, ..Interface::default() }
}

impl NodeCore for OverheadCamera {
    fn interface(&self) -> &Interface {
        &self.interface
    }

    fn handle(&mut self, at: Times, event: Event<'_>, sink: &mut dyn Sink) {
        match event {
            Event::Started => self.source.start(at.steady.plus_seconds(self.settings.start_delay)),
            Event::Wakeup if self.end.is_some_and(|end| at.steady >= end) => return sink.exit(0),
            Event::Wakeup => self.look(at, sink),
            _ => return,
        }
        self.report.publish(at, sink);
        self.next_report = at.steady.plus_seconds(PERIOD);
    }

    fn next_wakeup(&self) -> Option<Steady> {
        let look = if self.end.is_some() { self.end } else { self.source.next_look() };
        Some(look.map_or(self.next_report, |look| look.min(self.next_report)))
    }

    fn set_parameters(&mut self, parameters: &Parameters) -> Result<(), ConfigError> {
        // All others say what is opened at the start.
        let refused = |problem| parameters.error("controls", problem, "see `v4l2-ctl --list-ctrls` for what it takes");
        self.source.control(controls(parameters)?).map_err(refused)
    }
}
