//! Rust source from definitions: one module a package, one structure a message, one marker type a service.

mod documentation;
mod message;
mod rust_type;
mod service;
mod view;

use crate::definition::package_of;
use crate::{Error, Library};
use std::collections::{BTreeMap, BTreeSet};

/// What the generated source should look like.
#[derive(Debug, Clone)]
pub struct Settings<'a> {
    /// The package whose types live in the module `msg`; every other package gets a module of its name.
    pub own_package: &'a str,
    /// Messages that also get a borrowed form, as they and what they contain are large or frequent.
    pub views: &'a [&'a str],
}

/// What the parts of the generator share.
struct Context<'a> {
    library: &'a Library,
    own_package: &'a str,
    /// All messages with a borrowed form: those asked for and what they contain, if that holds strings or bytes.
    views: BTreeSet<String>,
}

/// The Rust source of all types of the library, to be included at the root of a crate that has `Encode`, `Message`,
/// `Service`, `ServiceInfo` and `TypeInfo` there, and `trench_rosidl` as dependency.
///
/// # Errors
/// When a definition is missing or uses what no Rust type here stands for.
pub fn generate(library: &Library, settings: &Settings) -> Result<String, Error> {
    let views = view::closure(library, settings.views)?;
    let context = Context { library, own_package: settings.own_package, views };
    let mut modules: BTreeMap<String, String> = BTreeMap::new();
    for definition in library.definitions() {
        let module = modules.entry(definition.package().to_owned()).or_default();
        *module += &message::generate(&context, definition)?;
        if context.views.contains(&definition.name) {
            *module += &view::generate(&context, definition)?;
        }
    }
    for service in library.services() {
        *modules.entry(package_of(&service.name).to_owned()).or_default() += &service::generate(&context, service)?;
    }
    let mut source = String::new();
    for (package, items) in &modules {
        let name = rust_type::module(&context, package);
        source += &format!("/// The types of the ROS 2 package `{package}`.\npub mod {name} {{\n{items}}}\n\n");
    }
    Ok(source + &registry(&context))
}

/// The lists of everything generated, ordered by name.
fn registry(context: &Context) -> String {
    let messages: Vec<String> =
        context.library.definitions().map(|definition| rust_type::path(context, &definition.name)).collect();
    let services = context.library.services().map(|service| rust_type::path(context, &service.name));
    let types: String = messages.iter().map(|path| format!("    <{path} as crate::Message>::TYPE,\n")).collect();
    let services: String = services.map(|path| format!("    crate::service_info::<{path}>(),\n")).collect();
    let calls: String = messages.iter().map(|path| format!("        $function::<${path}>();\n")).collect();
    format!(
        "static TYPES: &[&crate::TypeInfo] = &[\n{types}];\n\n\
         static SERVICES: &[crate::ServiceInfo] = &[\n{services}];\n\n\
         /// Calls a function `fn function<M: Message>()` for every message type, halves of services included.\n\
         #[macro_export]\n\
         macro_rules! for_every_message {{\n    ($function:ident) => {{\n{calls}    }};\n}}\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_message;

    fn source(text: &str, views: &[&str]) -> Result<String, Error> {
        let mut library = Library::default();
        library.add_message(parse_message("p/msg/Mine", text)?)?;
        library.add_message(parse_message("q/msg/Bytes", "uint8[] data")?)?;
        generate(&library, &Settings { own_package: "p", views })
    }

    #[test]
    fn names_that_rust_keeps_for_itself_are_escaped() {
        let source = source("uint8 type\nuint8 self", &[]).expect("valid");
        assert!(source.contains("pub r#type: u8,") && source.contains("pub self_: u8,"), "{source}");
    }

    #[test]
    fn comments_become_documentation_without_links() {
        let source = source("# See [3].\n\nuint8 a  # one of A_*", &[]).expect("valid");
        assert!(source.contains("/// See \\[3\\].\n"), "{source}");
        assert!(source.contains("    /// one of A\\_\\*\n    pub a: u8,"), "{source}");
    }

    #[test]
    fn borrowed_forms_reach_into_what_they_contain() {
        let source = source("uint8 a\nq/Bytes bytes\nstring s", &["p/msg/Mine"]).expect("valid");
        assert!(source.contains("pub struct MineView<'a>") && source.contains("pub struct BytesView<'a>"), "{source}");
        assert!(source.contains("pub bytes: crate::q::BytesView<'a>,"), "{source}");
    }

    #[test]
    fn what_has_no_rust_type_is_refused() {
        let check = |text: &str, views: &[&str], expected: &str| {
            assert_eq!(source(text, views).map_err(|error| error.to_string()), Err(expected.to_owned()));
        };
        check("wstring w", &[], "p/msg/Mine.w: a wstring is not supported");
        check("string<=3[] s", &[], "p/msg/Mine.s: a sequence of bounded strings is not supported");
        let borrowed = "a borrowed form of what is neither string, bytes nor of a fixed size";
        check("string s\nfloat64[] d", &["p/msg/Mine"], &format!("p/msg/Mine.d: {borrowed} is not supported"));
        check("Absent a", &[], "p/msg/Mine uses p/msg/Absent, whose definition is missing");
    }
}
