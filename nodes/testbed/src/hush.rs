//! Faults of the node's own: what it does not say for a time, although it happens in the world.

/// One of them with its time, ns after the start.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Hush {
    pub(crate) from: u64,
    pub(crate) to: u64,
    pub(crate) what: Unsaid,
}

/// What is not said. Robots are indices.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Unsaid {
    /// Where obstacles are.
    Obstacles,
    /// What these robots' lasers see.
    Scans(Vec<usize>),
}

impl Unsaid {
    /// As files name it.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Obstacles => "untold",
            Self::Scans(_) => "blind",
        }
    }
}

/// All of them.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Hushes(pub(crate) Vec<Hush>);

impl Hushes {
    /// What is not said at `time` (ns after the start).
    pub(crate) fn at(&self, time: u64) -> impl Iterator<Item = &Unsaid> {
        self.0.iter().filter(move |hush| (hush.from..hush.to).contains(&time)).map(|hush| &hush.what)
    }

    /// Whether obstacles are told of at `time`.
    pub(crate) fn tell_obstacles(&self, time: u64) -> bool {
        !self.at(time).any(|what| *what == Unsaid::Obstacles)
    }

    /// Whether the laser of a robot is heard at `time`.
    pub(crate) fn tell_scans(&self, time: u64, robot: usize) -> bool {
        !self.at(time).any(|what| matches!(what, Unsaid::Scans(robots) if robots.contains(&robot)))
    }
}
