//! What can be wrong with a command line.

/// An argument that is not understood.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum UsageError {
    /// Not an argument of a node.
    #[error("unknown argument `{0}`; ROS arguments stand behind --ros-args, see --help")]
    Unknown(String),
    /// The last argument wants a value.
    #[error("{0} wants a value behind it")]
    MissingValue(String),
    /// Not `from:=to`.
    #[error("`-r {0}` is no remapping; write -r from:=to, -r __node:=name or -r __ns:=/namespace")]
    Remap(String),
    /// Not `name:=value`.
    #[error("`-p {0}` sets no parameter; write -p name:=value or -p node:name:=value")]
    Parameter(String),
    /// Not a level.
    #[error("`--log-level {0}` names no level; write debug, info, warn, error or fatal, or logger:=level")]
    LogLevel(String),
    /// Not a list of namespaces, each different from the others.
    #[error("`--namespaces {0}` names no namespaces; write each once: --namespaces \"[robot1, robot2]\"")]
    Namespaces(String),
    /// ROS_DOMAIN_ID is not a domain.
    #[error("ROS_DOMAIN_ID is `{0}`; write a whole number from 0 to 232")]
    Domain(String),
    /// Security is asked for, which this build has none of.
    #[error(
        "ROS_SECURITY_ENABLE is true, but DDS Security is not in this build: build with --features dds-security, unset it, or use Zenoh with \
         TLS (docs/nodes/runtime.md)"
    )]
    SecurityNotBuilt,
    /// Security is asked for over Zenoh.
    #[error(
        "ROS_SECURITY_ENABLE is true, but Zenoh does not go by it: unset it, and give Zenoh TLS and access control (docs/nodes/runtime.md)"
    )]
    SecurityOfZenoh,
    /// Security is asked for, but not where its files are.
    #[error(
        "ROS_SECURITY_ENABLE is true, but ROS_SECURITY_KEYSTORE names no folder: make one (ros2 security create_keystore) and name it"
    )]
    NoKeystore,
    /// A file of the enclave cannot be read.
    #[error(
        "{file}: {problem}; make the enclave (ros2 security create_enclave KEYSTORE NAME) and name it by --ros-args --enclave NAME or \
         ROS_SECURITY_ENCLAVE_OVERRIDE"
    )]
    Enclave {
        /// The file.
        file: String,
        /// What the system says.
        problem: String,
    },
    /// Not the name of an enclave.
    #[error("`--enclave {0}` names no enclave; write an absolute name such as /robot1")]
    EnclaveName(String),
    /// RMW_IMPLEMENTATION names none that is known.
    #[error(
        "RMW_IMPLEMENTATION is `{0}`; write rmw_zenoh_cpp for Zenoh, rmw_fastrtps_cpp or rmw_cyclonedds_cpp (or nothing) for DDS"
    )]
    RmwImplementation(String),
}
