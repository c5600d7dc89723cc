//! The parameters in force and the rules for changing them.

use super::value::from_message;
use trench_config::{ConfigError, Origin, ParameterDescriptor, ParameterValue, Parameters};
use trench_msgs::rcl_interfaces::{Parameter, SetParametersResult};

/// Declarations and values of one node.
#[derive(Debug)]
pub(super) struct Store {
    pub(super) declared: Vec<ParameterDescriptor>,
    pub(super) values: Parameters,
}

/// The core's say in a change.
pub(crate) type Accept<'a> = &'a mut dyn FnMut(&Parameters) -> Result<(), ConfigError>;

impl Store {
    pub(super) fn descriptor(&self, name: &str) -> Option<&ParameterDescriptor> {
        self.declared.iter().find(|descriptor| descriptor.name == name)
    }

    pub(super) fn value(&self, name: &str) -> Option<&ParameterValue> {
        self.values.get(name).map(|(value, _)| value)
    }

    /// Changes all of `wanted` or, with a reason, none.
    pub(super) fn set(&mut self, wanted: Vec<Parameter>, accept: Accept<'_>) -> SetParametersResult {
        let changed = wanted.into_iter().try_fold(self.values.clone(), |mut values, parameter| {
            let (name, value) = self.check(parameter)?;
            values.insert(name, value, origin());
            Ok(values)
        });
        let accepted = changed.and_then(|values| match accept(&values) {
            Ok(()) => Ok(values),
            Err(error) => Err(error.to_string()),
        });
        match accepted {
            Ok(values) => {
                self.values = values;
                SetParametersResult { successful: true, reason: String::new() }
            }
            Err(reason) => SetParametersResult { successful: false, reason },
        }
    }

    /// Whether the node lets this parameter have this value.
    fn check(&self, wanted: Parameter) -> Result<(String, ParameterValue), String> {
        let name = wanted.name;
        let descriptor = self.descriptor(&name).ok_or_else(|| {
            let names = self.declared.iter().map(|descriptor| descriptor.name);
            format!("{name}: unknown parameter; {}", trench_config::did_you_mean(&name, names))
        })?;
        if descriptor.read_only {
            return Err(format!("{name} is fixed once the node runs; set it at the start and run the node again"));
        }
        let value = from_message(wanted.value).ok_or_else(|| format!("{name} cannot be unset; give it a value"))?;
        descriptor.check(&value, &origin()).map_err(|error| error.to_string())?;
        Ok((name, value))
    }
}

fn origin() -> Origin {
    Origin::new("parameter service", 0)
}
