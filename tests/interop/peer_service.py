"""Calls a std_srvs/srv/Trigger, like `ros2 service call`."""

from std_srvs.srv import Trigger

import peer


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("service", help="for example /leader_assignment/arm")
    given = arguments.parse_args()
    with peer.node("peer_service") as node:
        client = node.create_client(Trigger, given.service)
        if not client.wait_for_service(timeout_sec=given.timeout):
            peer.fail(f"{given.service} is not there within {given.timeout} s")
        future = client.call_async(Trigger.Request())
        if not peer.spin_until(node, future.done, given.timeout):
            peer.fail(f"{given.service} does not answer within {given.timeout} s")
        peer.report(peer.plain(future.result()))


if __name__ == "__main__":
    main()
