//! Which network a process joins.

use super::TransportError;
use super::dds::Participant;
use super::network::{GraphWatch, Network};
use super::zenoh::Session;
use std::path::Path;

/// The networks there are. Chosen as every ROS 2 process chooses, by RMW_IMPLEMENTATION, so that one variable in a shell
/// or one `set_env` in a launch file moves Trench's nodes and everybody else's alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Backend {
    /// As Fast DDS, Cyclone DDS and their like speak it.
    Dds,
    /// As rmw_zenoh speaks it.
    Zenoh,
}

/// A network and who watches its graph.
pub(crate) type Joined = (Box<dyn Network>, Box<dyn GraphWatch>);

impl Backend {
    /// What RMW_IMPLEMENTATION asks for; the wrong text where it is none that is known.
    pub(crate) fn of(variable: Option<&str>) -> Result<Self, String> {
        match variable.unwrap_or_default() {
            "rmw_zenoh_cpp" => Ok(Self::Zenoh),
            ""
            | "rmw_fastrtps_cpp"
            | "rmw_fastrtps_dynamic_cpp"
            | "rmw_cyclonedds_cpp"
            | "rmw_connextdds"
            | "rmw_gurumdds_cpp" => Ok(Self::Dds),
            other => Err(other.to_owned()),
        }
    }

    /// Joins a ROS domain; over DDS as the `enclave` in this folder, if there is one.
    pub(crate) fn join(self, domain: u16, enclave: Option<&Path>) -> Result<Joined, TransportError> {
        match self {
            Self::Dds => {
                let participant = Participant::join(domain, enclave)?;
                let graph = participant.status();
                Ok((Box::new(participant), graph))
            }
            Self::Zenoh => {
                let (session, graph) = Session::join(domain)?;
                Ok((Box::new(session), graph))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Backend;

    #[test]
    fn the_network_is_named_as_ros_names_it() {
        let check = |variable, expected| assert_eq!(Backend::of(variable), expected, "{variable:?}");
        check(None, Ok(Backend::Dds));
        check(Some(""), Ok(Backend::Dds));
        check(Some("rmw_cyclonedds_cpp"), Ok(Backend::Dds));
        check(Some("rmw_zenoh_cpp"), Ok(Backend::Zenoh));
        check(Some("zenoh"), Err("zenoh".to_owned()));
    }
}
