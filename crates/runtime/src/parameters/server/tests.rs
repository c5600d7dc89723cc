use super::*;
use trench_config::params;

fn server() -> ParameterServer {
    let declared = vec![
        ParameterDescriptor::double("gains.k1", 0.1, "1/s").range(0.0, 10.0),
        ParameterDescriptor::integer("robots", 4, "how many").range(1.0, 20.0).read_only(),
        ParameterDescriptor::string("frame", "map", "reference"),
    ];
    let values = params::resolve(&[], "/", "node", &declared).unwrap();
    ParameterServer::new("/node".to_owned(), declared, values)
}

fn double(name: &str, value: f64) -> Parameter {
    let value = ValueMessage { r#type: ParameterType::PARAMETER_DOUBLE, double_value: value, ..Default::default() };
    Parameter { name: name.to_owned(), value }
}

fn set(server: &mut ParameterServer, wanted: Vec<Parameter>) -> (Vec<SetParametersResult>, Option<ParameterEvent>) {
    let request = SetParametersRequest { parameters: wanted }.to_cdr();
    let reply = server.answer(ParameterService::Set, &request, RosTime(5), &mut |_| Ok(())).unwrap();
    (SetParametersResponse::decode(&reply.response).unwrap().results, reply.event)
}

#[test]
fn a_change_is_told_and_kept() {
    let mut server = server();
    let (results, event) = set(&mut server, vec![double("gains.k1", 0.5)]);
    assert!(results[0].successful, "{}", results[0].reason);
    let event = event.unwrap();
    assert_eq!((event.node.as_str(), event.changed_parameters), ("/node", vec![double("gains.k1", 0.5)]));
    assert_eq!(server.value("gains.k1").double_value, 0.5);
}

#[test]
fn what_is_refused_names_the_remedy() {
    let mut server = server();
    let integer = |name: &str, integer_value| Parameter {
        name: name.to_owned(),
        value: ValueMessage { r#type: ParameterType::PARAMETER_INTEGER, integer_value, ..Default::default() },
    };
    let mut check = |wanted: Parameter, expected: &str| {
        let (results, event) = set(&mut server, vec![wanted]);
        assert!(!results[0].successful && event.is_none());
        assert!(results[0].reason.contains(expected), "{}", results[0].reason);
    };
    check(double("gains.k1", 11.0), "out of range; write a value from 0 to 10");
    check(double("gains.k1", f64::NAN), "not a finite number");
    check(integer("gains.k1", 1), "write 1.0");
    check(integer("robots", 5), "fixed once the node runs");
    check(double("gains.k", 1.0), "gains.k1");
    check(Parameter { name: "frame".to_owned(), ..Default::default() }, "cannot be unset");
}

#[test]
fn the_core_can_refuse_and_an_atomic_change_is_all_or_nothing() {
    let mut server = server();
    let refuse = |values: &Parameters| Err(values.error("gains.k1", "is outside the stable zone", "write 0.2"));
    let wanted = vec![double("gains.k1", 0.5)];
    let request = SetParametersAtomicallyRequest { parameters: wanted }.to_cdr();
    let mut refuse = refuse;
    let reply = server.answer(ParameterService::SetAtomically, &request, RosTime(0), &mut refuse).unwrap();
    let result = SetParametersAtomicallyResponse::decode(&reply.response).unwrap().result;
    assert!(!result.successful && result.reason.contains("outside the stable zone; write 0.2"), "{}", result.reason);

    let wanted = vec![double("gains.k1", 0.5), double("nothing", 1.0)];
    let request = SetParametersAtomicallyRequest { parameters: wanted }.to_cdr();
    let reply = server.answer(ParameterService::SetAtomically, &request, RosTime(0), &mut |_| Ok(())).unwrap();
    assert!(reply.event.is_none());
    assert_eq!(server.value("gains.k1").double_value, 0.1);
}

#[test]
fn looking_at_parameters() {
    let mut server = server();
    let mut ask = |service, request: Vec<u8>| server.answer(service, &request, RosTime(0), &mut |_| Ok(())).unwrap();
    let names = vec!["robots".to_owned(), "ghost".to_owned()];
    let reply = ask(ParameterService::Describe, DescribeParametersRequest { names: names.clone() }.to_cdr());
    let described = DescribeParametersResponse::decode(&reply.response).unwrap().descriptors;
    assert!(described[0].read_only);
    assert_eq!((described[0].integer_range[0].from_value, described[0].integer_range[0].to_value), (1, 20));
    assert_eq!((described[1].name.as_str(), described[1].r#type), ("ghost", ParameterType::PARAMETER_NOT_SET));
    let reply = ask(ParameterService::GetTypes, GetParameterTypesRequest { names }.to_cdr());
    let types = GetParameterTypesResponse::decode(&reply.response).unwrap().types;
    assert_eq!(types, [ParameterType::PARAMETER_INTEGER, ParameterType::PARAMETER_NOT_SET]);
}

#[test]
fn a_broken_request_is_an_error() {
    assert!(server().answer(ParameterService::Set, &[0, 1, 0, 0, 9], RosTime(0), &mut |_| Ok(())).is_err());
}
