//! The six services of a node's parameters.

use trench_msgs::rcl_interfaces::{
    DescribeParameters, GetParameterTypes, GetParameters, ListParameters, SetParameters, SetParametersAtomically,
};
use trench_msgs::{ServiceInfo, service_info};

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
    pub(crate) fn info(self) -> ServiceInfo {
        match self {
            Self::Describe => service_info::<DescribeParameters>(),
            Self::Get => service_info::<GetParameters>(),
            Self::GetTypes => service_info::<GetParameterTypes>(),
            Self::List => service_info::<ListParameters>(),
            Self::Set => service_info::<SetParameters>(),
            Self::SetAtomically => service_info::<SetParametersAtomically>(),
        }
    }
}
