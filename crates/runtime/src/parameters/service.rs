//! The six services of a node's parameters.

/// One of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ParameterService {
    Describe,
    Get,
    GetTypes,
    List,
    Set,
    SetAtomically,
}

impl ParameterService {
    /// All of them.
    pub(crate) const ALL: [Self; 6] =
        [Self::Describe, Self::Get, Self::GetTypes, Self::List, Self::Set, Self::SetAtomically];

    /// Its name below the node's.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Describe => "describe_parameters",
            Self::Get => "get_parameters",
            Self::GetTypes => "get_parameter_types",
            Self::List => "list_parameters",
            Self::Set => "set_parameters",
            Self::SetAtomically => "set_parameters_atomically",
        }
    }

    /// Its type.
    pub(crate) fn type_name(self) -> &'static str {
        match self {
            Self::Describe => "rcl_interfaces/srv/DescribeParameters",
            Self::Get => "rcl_interfaces/srv/GetParameters",
            Self::GetTypes => "rcl_interfaces/srv/GetParameterTypes",
            Self::List => "rcl_interfaces/srv/ListParameters",
            Self::Set => "rcl_interfaces/srv/SetParameters",
            Self::SetAtomically => "rcl_interfaces/srv/SetParametersAtomically",
        }
    }
}
