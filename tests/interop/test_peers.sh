#!/bin/sh
# The peers against each other: each must see, read and change what peer_robot.py offers.
# usage: eval "$(scripts/ros-venv --env)"; tests/interop/test_peers.sh
set -eu
cd "$(dirname -- "$0")"
export ROS_DOMAIN_ID="${ROS_DOMAIN_ID:-87}"
python3 peer_robot.py --timeout 60 &
robot=$!
trap 'kill "$robot" 2>/dev/null || true' EXIT

check() {
    expected=$1
    shift
    output=$(python3 "$@")
    case $output in
        *"$expected"*) echo "ok: $*" ;;
        *) echo "FAILED: $*: $output lacks $expected" >&2; exit 1 ;;
    esac
}

check '"/robot1/odom": {"types": ["nav_msgs/msg/Odometry"]' peer_graph.py --wait-for /robot1/peer_robot --wait-for /robot1/odom
check '"state": 1' peer_echo.py /run_state trench_msgs/msg/RunState --qos reliable,transient_local,1
check '"frame_number": 7' peer_echo.py /team_state trench_msgs/msg/TeamState --count 10
check '"covariance"' peer_echo.py /robot1/odom nav_msgs/msg/Odometry
check '"value": 0.1' peer_param.py /robot1/peer_robot get gains.k1
check '"successful": true' peer_param.py /robot1/peer_robot set gains.k1 0.2
check '"value": 0.2' peer_param.py /robot1/peer_robot get gains.k1
check '"gains.k1"' peer_param.py /robot1/peer_robot list
check '"message": "armed"' peer_service.py /robot1/peer_robot/arm
echo '{"data": true}' | check '"published": ' peer_publish.py /emergency_stop std_msgs/msg/Bool
wait "$robot"
trap - EXIT
echo "ok: peer_robot.py stopped"
