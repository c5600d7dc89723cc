"""A small rclpy node that offers what the other peers ask for, to test them against each other: latched and streaming
topics, a parameter, a Trigger service; it ends when /emergency_stop says true."""

from nav_msgs.msg import Odometry
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from trench_msgs.msg import RunState, TeamState

import rclpy

import peer


def main() -> None:
    arguments = peer.parser(__doc__)
    given = arguments.parse_args()
    rclpy.init()
    node = Node("peer_robot", namespace="/robot1")
    node.declare_parameter("gains.k1", 0.1)
    latched = node.create_publisher(RunState, "/run_state", peer.qos("reliable,transient_local,1"))
    latched.publish(RunState(state=RunState.ARMED, reason="peer"))
    odometry = node.create_publisher(Odometry, "odom", 10)
    team = node.create_publisher(TeamState, "/team_state", 10)
    stopped = []
    node.create_subscription(Bool, "/emergency_stop", lambda stop: stop.data and stopped.append(stop), 1)

    def arm(_, response: Trigger.Response) -> Trigger.Response:
        response.success, response.message = True, "armed"
        return response

    node.create_service(Trigger, "~/arm", arm)

    def tick() -> None:
        odometry.publish(Odometry())
        team.publish(TeamState(frame_number=7))

    node.create_timer(0.05, tick)
    if not peer.spin_until(node, lambda: bool(stopped), given.timeout):
        peer.fail(f"/emergency_stop did not come within {given.timeout} s")
    peer.report({"stopped": True})


if __name__ == "__main__":
    main()
