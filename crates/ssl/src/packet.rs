//! SSL-Vision's packets: protobuf messages of its `messages_robocup_ssl_*.proto`. Lengths are millimetres there and metres
//! here, the origin is wherever the cameras were calibrated to.

use prost::Message;

/// SSL_WrapperPacket. The geometry of the field is passed over.
#[derive(Clone, PartialEq, Message)]
pub struct Packet {
    /// What one camera saw.
    #[prost(message, optional, tag = "1")]
    pub detection: Option<Frame>,
}

/// SSL_DetectionFrame: what one camera saw.
#[derive(Clone, PartialEq, Message)]
pub struct Frame {
    /// Counts the camera's frames.
    #[prost(uint32, required, tag = "1")]
    pub frame_number: u32,
    /// When it was exposed, s of the vision computer's clock.
    #[prost(double, required, tag = "2")]
    pub t_capture: f64,
    /// When it was sent, s.
    #[prost(double, required, tag = "3")]
    pub t_sent: f64,
    /// Which camera.
    #[prost(uint32, required, tag = "4")]
    pub camera_id: u32,
    /// Balls.
    #[prost(message, repeated, tag = "5")]
    pub balls: Vec<Ball>,
    /// Robots of the yellow team.
    #[prost(message, repeated, tag = "6")]
    pub robots_yellow: Vec<Robot>,
    /// Robots of the blue team.
    #[prost(message, repeated, tag = "7")]
    pub robots_blue: Vec<Robot>,
}

/// SSL_DetectionBall.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Ball {
    /// 0..1
    #[prost(float, required, tag = "1")]
    pub confidence: f32,
    /// pixel^2
    #[prost(uint32, optional, tag = "2")]
    pub area: Option<u32>,
    /// mm
    #[prost(float, required, tag = "3")]
    pub x: f32,
    /// mm
    #[prost(float, required, tag = "4")]
    pub y: f32,
    /// mm
    #[prost(float, optional, tag = "5")]
    pub z: Option<f32>,
    /// Column.
    #[prost(float, required, tag = "6")]
    pub pixel_x: f32,
    /// Row.
    #[prost(float, required, tag = "7")]
    pub pixel_y: f32,
}

/// SSL_DetectionRobot.
#[derive(Clone, Copy, PartialEq, Message)]
pub struct Robot {
    /// 0..1
    #[prost(float, required, tag = "1")]
    pub confidence: f32,
    /// By the pattern on its top.
    #[prost(uint32, optional, tag = "2")]
    pub robot_id: Option<u32>,
    /// mm
    #[prost(float, required, tag = "3")]
    pub x: f32,
    /// mm
    #[prost(float, required, tag = "4")]
    pub y: f32,
    /// rad
    #[prost(float, optional, tag = "5")]
    pub orientation: Option<f32>,
    /// Column.
    #[prost(float, required, tag = "6")]
    pub pixel_x: f32,
    /// Row.
    #[prost(float, required, tag = "7")]
    pub pixel_y: f32,
    /// mm
    #[prost(float, optional, tag = "8")]
    pub height: Option<f32>,
}

/// Whose robots are meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Team {
    /// Yellow.
    Yellow,
    /// Blue.
    Blue,
}

/// A robot whose pattern was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// By its pattern.
    pub id: u32,
    /// m
    pub x: f64,
    /// m
    pub y: f64,
    /// rad
    pub theta: f64,
    /// 0..1
    pub confidence: f64,
}

/// Why bytes are no packet.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PacketError {
    /// They are no protobuf of this kind.
    #[error("it is no packet of SSL-Vision: {0}")]
    Protobuf(String),
    /// A number is NaN or infinite.
    #[error("a robot's place is not finite")]
    NotFinite,
}

/// A packet of robots of one team, as SSL-Vision sends it; `capture` and `sent` in s.
#[must_use]
pub fn packet_of(robots: &[Seen], team: Team, frame_number: u32, [capture, sent]: [f64; 2]) -> Vec<u8> {
    let robot = |seen: &Seen| Robot {
        confidence: seen.confidence as f32,
        robot_id: Some(seen.id),
        x: (1e3 * seen.x) as f32,
        y: (1e3 * seen.y) as f32,
        orientation: Some(seen.theta as f32),
        pixel_x: 0.0,
        pixel_y: 0.0,
        height: None,
    };
    let robots: Vec<Robot> = robots.iter().map(robot).collect();
    let (robots_yellow, robots_blue) = match team {
        Team::Yellow => (robots, Vec::new()),
        Team::Blue => (Vec::new(), robots),
    };
    let frame = Frame {
        frame_number,
        t_capture: capture,
        t_sent: sent,
        camera_id: 0,
        balls: Vec::new(),
        robots_yellow,
        robots_blue,
    };
    Packet { detection: Some(frame) }.encode_to_vec()
}

/// The robots of one team in a packet, those whose pattern and orientation were read, with the frame; None if the packet is of
/// something else.
///
/// # Errors
/// When the bytes are no packet.
pub fn frame_of(bytes: &[u8], team: Team) -> Result<Option<(Frame, Vec<Seen>)>, PacketError> {
    let packet = Packet::decode(bytes).map_err(|error| PacketError::Protobuf(error.to_string()))?;
    let Some(frame) = packet.detection else { return Ok(None) };
    let robots = match team {
        Team::Yellow => &frame.robots_yellow,
        Team::Blue => &frame.robots_blue,
    };
    let seen = robots.iter().filter_map(|robot| {
        Some(Seen {
            id: robot.robot_id?,
            x: 1e-3 * f64::from(robot.x),
            y: 1e-3 * f64::from(robot.y),
            theta: f64::from(robot.orientation?),
            confidence: f64::from(robot.confidence),
        })
    });
    let seen: Vec<Seen> = seen.collect();
    let finite = |seen: &Seen| (seen.x + seen.y + seen.theta + seen.confidence).is_finite();
    if !(seen.iter().all(finite) && (frame.t_capture + frame.t_sent).is_finite()) {
        return Err(PacketError::NotFinite);
    }
    Ok(Some((frame, seen)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEEN: Seen = Seen { id: 3, x: 1.25, y: -0.5, theta: 0.75, confidence: 0.5 };

    #[test]
    fn packets_have_the_bytes_of_the_league() {
        let packet = packet_of(&[SEEN], Team::Blue, 7, [1.5, 2.5]);
        // By hand: field 1 (length 55) of the wrapper; frame_number 7; two doubles; camera 0; one robot of 32 bytes.
        let float = |tag: u8, value: f32| [&[tag][..], &value.to_le_bytes()].concat();
        let robot = [
            float(0x0d, 0.5),
            vec![0x10, 3],
            float(0x1d, 1250.0),
            float(0x25, -500.0),
            float(0x2d, 0.75),
            float(0x35, 0.0),
            float(0x3d, 0.0),
        ]
        .concat();
        let double = |tag: u8, value: f64| [&[tag][..], &value.to_le_bytes()].concat();
        let head = [vec![0x08, 7], double(0x11, 1.5), double(0x19, 2.5), vec![0x20, 0]].concat();
        let frame = [head, vec![0x3a, robot.len() as u8], robot].concat();
        assert_eq!(packet, [vec![0x0a, frame.len() as u8], frame].concat());
    }

    #[test]
    fn what_is_sent_is_read_back() {
        let (frame, seen) = frame_of(&packet_of(&[SEEN], Team::Yellow, 9, [1.0, 2.0]), Team::Yellow).unwrap().unwrap();
        assert_eq!((frame.frame_number, seen.as_slice()), (9, &[SEEN][..]));
        let (_, others) = frame_of(&packet_of(&[SEEN], Team::Yellow, 9, [1.0, 2.0]), Team::Blue).unwrap().unwrap();
        assert_eq!(others, []);
    }

    #[test]
    fn bad_bytes_are_refused() {
        assert_eq!(frame_of(&[], Team::Blue), Ok(None));
        assert!(matches!(frame_of(&[0x0a, 200], Team::Blue), Err(PacketError::Protobuf(_))));
        let packet = packet_of(&[Seen { x: f64::NAN, ..SEEN }], Team::Blue, 7, [1.5, 2.5]);
        assert_eq!(frame_of(&packet, Team::Blue), Err(PacketError::NotFinite));
        // Any bytes are an answer, never a panic.
        let good = packet_of(&[SEEN, SEEN], Team::Blue, 7, [1.5, 2.5]);
        for place in 0..good.len() {
            let mut bytes = good.clone();
            bytes[place] ^= 0xff;
            let _ = frame_of(&bytes, Team::Blue);
            let _ = frame_of(&good[..place], Team::Blue);
        }
    }
}
