//! From template to text.

use super::{Part, Template};
use crate::package;
use crate::scope::Scope;
use trench_config::did_you_mean;

const KNOWN: [&str; 4] = ["var", "env", "dirname", "find-pkg-share"];

/// What is wrong with a substitution, and what would be right.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) problem: String,
    pub(crate) remedy: String,
}

impl Failure {
    pub(crate) fn new(problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { problem: problem.into(), remedy: remedy.into() }
    }
}

impl Template {
    /// The text with all substitutions made, in `scope`.
    pub(crate) fn perform(&self, scope: &Scope) -> Result<String, Failure> {
        self.0
            .iter()
            .map(|part| match part {
                Part::Text(text) => Ok(text.clone()),
                Part::Call { name, arguments } => call(name, arguments, scope),
            })
            .collect()
    }
}

fn call(name: &str, arguments: &[Template], scope: &Scope) -> Result<String, Failure> {
    let performed = arguments.iter().map(|argument| argument.perform(scope)).collect::<Result<Vec<_>, _>>()?;
    let values: Vec<&str> = performed.iter().map(String::as_str).collect();
    match (name, values.as_slice()) {
        ("var", [variable]) => {
            scope.variables.get(*variable).cloned().ok_or_else(|| undefined_variable(variable, scope))
        }
        ("var", [variable, default]) => {
            Ok(scope.variables.get(*variable).map_or_else(|| (*default).to_owned(), Clone::clone))
        }
        ("env", [variable]) => scope.environment.get(*variable).cloned().ok_or_else(|| {
            let problem = format!("environment variable `{variable}` is not set");
            Failure::new(problem, format!("set it, or give a default: $(env {variable} default)"))
        }),
        ("env", [variable, default]) => {
            Ok(scope.environment.get(*variable).map_or_else(|| (*default).to_owned(), Clone::clone))
        }
        ("dirname", []) => Ok(scope.folder.clone()),
        ("find-pkg-share", [package]) => package::share(package, scope),
        (name, values) if KNOWN.contains(&name) => {
            let expected = match name {
                "var" => "$(var name) or $(var name default)",
                "env" => "$(env NAME) or $(env NAME default)",
                "dirname" => "$(dirname)",
                _ => "$(find-pkg-share package)",
            };
            Err(Failure::new(format!("`{name}` has {} arguments", values.len()), format!("write {expected}")))
        }
        (name, _) => Err(Failure::new(format!("unknown substitution `{name}`"), did_you_mean(name, KNOWN))),
    }
}

fn undefined_variable(variable: &str, scope: &Scope) -> Failure {
    let known = did_you_mean(variable, scope.variables.keys().map(String::as_str));
    Failure::new(format!("variable `{variable}` is not defined"), format!("declare it by `arg` or `let` ({known})"))
}
