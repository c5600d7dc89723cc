//! The hash of a service.

use crate::definition::{Base, Definition, Field, Service, Shape};
use crate::{Error, Library};

impl Library {
    /// The RIHS01 hash of a service: of a type with its request, its response and its introspection event as fields.
    ///
    /// # Errors
    /// When something it contains is missing; it needs `service_msgs/msg/ServiceEventInfo`.
    pub fn service_hash(&self, service: &Service) -> Result<String, Error> {
        let event = format!("{}_Event", service.name);
        let field = |name: &str, of: &str, shape| Field {
            name: name.to_owned(),
            base: Base::Nested(of.to_owned()),
            shape,
            default: None,
            comment: Vec::new(),
        };
        let definition = |name: &str, fields| Definition {
            name: name.to_owned(),
            comment: Vec::new(),
            constants: Vec::new(),
            fields,
            text: String::new(),
        };
        let mut library = self.clone();
        library.add_message(definition(
            &event,
            vec![
                field("info", "service_msgs/msg/ServiceEventInfo", Shape::Single),
                field("request", &service.request.name, Shape::Bounded(1)),
                field("response", &service.response.name, Shape::Bounded(1)),
            ],
        ))?;
        library.add_message(definition(
            &service.name,
            vec![
                field("request_message", &service.request.name, Shape::Single),
                field("response_message", &service.response.name, Shape::Single),
                field("event_message", &event, Shape::Single),
            ],
        ))?;
        library.hash(&service.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_service;

    #[test]
    fn the_hash_of_a_service_needs_its_event() {
        let service = parse_service("p/srv/Ask", "uint8 a\n---\nuint8 b").expect("valid");
        let mut library = Library::default();
        library.add_service(service.clone()).expect("new");
        let missing = Error::Missing {
            name: "p/srv/Ask_Event".to_owned(),
            missing: "service_msgs/msg/ServiceEventInfo".to_owned(),
        };
        assert_eq!(library.service_hash(&service), Err(missing));
    }
}
