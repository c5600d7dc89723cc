"""Lists, gets, sets or dumps (all at once) parameters of a node through the standard services, like `ros2 param`."""

import json

from rcl_interfaces.srv import GetParameters, ListParameters, SetParameters
from rclpy.parameter import Parameter, parameter_value_to_python

import peer


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("node", help="for example /robot1/formation_controller")
    arguments.add_argument("action", choices=["list", "get", "set", "dump"])
    arguments.add_argument("name", nargs="?")
    arguments.add_argument("value", nargs="?", help="JSON: true, 1, 1.0, \"text\", [1.0, 2.0]")
    given = arguments.parse_args()
    with peer.node("peer_param") as node:
        def call(service_type, name: str, request):
            client = node.create_client(service_type, f"{given.node}/{name}")
            if not client.wait_for_service(timeout_sec=given.timeout):
                peer.fail(f"{given.node}/{name} is not there within {given.timeout} s")
            future = client.call_async(request)
            if not peer.spin_until(node, future.done, given.timeout):
                peer.fail(f"{given.node}/{name} does not answer within {given.timeout} s")
            return future.result()

        if given.action == "dump":
            names = call(ListParameters, "list_parameters", ListParameters.Request()).result.names
            values = call(GetParameters, "get_parameters", GetParameters.Request(names=names)).values
            peer.report({name: peer.plain(parameter_value_to_python(value)) for name, value in zip(names, values, strict=True)})
        elif given.action == "list":
            names = call(ListParameters, "list_parameters", ListParameters.Request()).result.names
            peer.report({"names": sorted(names)})
        elif given.action == "get":
            values = call(GetParameters, "get_parameters", GetParameters.Request(names=[given.name])).values
            peer.report({"name": given.name, "value": peer.plain(parameter_value_to_python(values[0]))})
        else:
            parameter = Parameter(given.name, value=json.loads(given.value)).to_parameter_msg()
            answer = call(SetParameters, "set_parameters", SetParameters.Request(parameters=[parameter])).results[0]
            peer.report({"name": given.name, "successful": answer.successful, "reason": answer.reason})


if __name__ == "__main__":
    main()
