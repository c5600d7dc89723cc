//! Answering the parameter services.

use super::ParameterService;
use super::list::list;
use super::store::{Accept, Store};
use super::value::{describe, kind, to_message};
use trench_config::{ParameterDescriptor, Parameters};
use trench_core::RosTime;
use trench_msgs::cdr::CdrError;
use trench_msgs::rcl_interfaces::{
    DescribeParametersRequest, DescribeParametersResponse, GetParameterTypesRequest, GetParameterTypesResponse,
    GetParametersRequest, GetParametersResponse, ListParametersRequest, ListParametersResponse, Parameter,
    ParameterDescriptor as DescriptorMessage, ParameterEvent, ParameterType, ParameterValue as ValueMessage,
    SetParametersAtomicallyRequest, SetParametersAtomicallyResponse, SetParametersRequest, SetParametersResponse,
    SetParametersResult,
};
use trench_msgs::{Encode, Message};

/// The parameters of a running node. No I/O: requests in, responses and events out.
#[derive(Debug)]
pub(crate) struct ParameterServer {
    node: String,
    store: Store,
}

/// What a request leads to.
#[derive(Debug)]
pub(crate) struct Reply {
    /// The response message.
    pub(crate) response: Vec<u8>,
    /// What /parameter_events says of it, if something changed.
    pub(crate) event: Option<ParameterEvent>,
}

impl ParameterServer {
    /// For the node with this full name.
    pub(crate) fn new(node: String, declared: Vec<ParameterDescriptor>, values: Parameters) -> Self {
        Self { node, store: Store { declared, values } }
    }

    /// The event that tells of all parameters when the node starts.
    pub(crate) fn birth(&self, at: RosTime) -> ParameterEvent {
        let new_parameters = self.store.values.iter().map(|(name, value, _)| parameter(name, to_message(value)));
        ParameterEvent {
            stamp: at.into(),
            node: self.node.clone(),
            new_parameters: new_parameters.collect(),
            ..Default::default()
        }
    }

    /// Answers a request; `accept` is the core's say in a change.
    pub(crate) fn answer(
        &mut self,
        service: ParameterService,
        request: &[u8],
        at: RosTime,
        accept: Accept<'_>,
    ) -> Result<Reply, CdrError> {
        let plain = |response: &dyn Encode| Ok(Reply { response: response.to_cdr(), event: None });
        match service {
            ParameterService::Describe => {
                let names = DescribeParametersRequest::decode(request)?.names;
                plain(&DescribeParametersResponse {
                    descriptors: names.iter().map(|name| self.describe(name)).collect(),
                })
            }
            ParameterService::Get => {
                let names = GetParametersRequest::decode(request)?.names;
                plain(&GetParametersResponse { values: names.iter().map(|name| self.value(name)).collect() })
            }
            ParameterService::GetTypes => {
                let names = GetParameterTypesRequest::decode(request)?.names;
                plain(&GetParameterTypesResponse { types: names.iter().map(|name| self.kind(name)).collect() })
            }
            ParameterService::List => {
                let request = ListParametersRequest::decode(request)?;
                let names = self.store.values.iter().map(|(name, ..)| name);
                plain(&ListParametersResponse { result: list(names, &request) })
            }
            ParameterService::Set => {
                let wanted = SetParametersRequest::decode(request)?.parameters;
                let mut changed = Vec::new();
                let results = wanted.into_iter().map(|one| self.set(vec![one], accept, &mut changed)).collect();
                Ok(Reply { response: SetParametersResponse { results }.to_cdr(), event: self.event(at, changed) })
            }
            ParameterService::SetAtomically => {
                let wanted = SetParametersAtomicallyRequest::decode(request)?.parameters;
                let mut changed = Vec::new();
                let result = self.set(wanted, accept, &mut changed);
                let response = SetParametersAtomicallyResponse { result }.to_cdr();
                Ok(Reply { response, event: self.event(at, changed) })
            }
        }
    }

    fn set(&mut self, wanted: Vec<Parameter>, accept: Accept<'_>, changed: &mut Vec<Parameter>) -> SetParametersResult {
        let result = self.store.set(wanted.clone(), accept);
        if result.successful {
            changed.extend(wanted);
        }
        result
    }

    fn event(&self, at: RosTime, changed_parameters: Vec<Parameter>) -> Option<ParameterEvent> {
        let node = self.node.clone();
        (!changed_parameters.is_empty()).then(|| ParameterEvent {
            stamp: at.into(),
            node,
            changed_parameters,
            ..Default::default()
        })
    }

    /// A parameter that does not exist is described by its name alone, as rclcpp does where it may not refuse.
    fn describe(&self, name: &str) -> DescriptorMessage {
        self.store
            .descriptor(name)
            .map_or_else(|| DescriptorMessage { name: name.to_owned(), ..Default::default() }, describe)
    }

    fn value(&self, name: &str) -> ValueMessage {
        self.store.value(name).map_or_else(ValueMessage::default, to_message)
    }

    fn kind(&self, name: &str) -> u8 {
        self.store.value(name).map_or(ParameterType::PARAMETER_NOT_SET, kind)
    }
}

fn parameter(name: &str, value: ValueMessage) -> Parameter {
    Parameter { name: name.to_owned(), value }
}

#[cfg(test)]
mod tests;
