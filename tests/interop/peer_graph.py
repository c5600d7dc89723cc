"""Prints nodes, topics with their types and ends, and services, as `ros2 node list`, `ros2 topic list -t` and
`ros2 service list` see them."""

import peer


def ends(infos) -> list[dict]:
    """The publishers or subscribers of a topic."""
    return [
        {
            "node": f"{info.node_namespace.rstrip('/')}/{info.node_name}",
            "type": info.topic_type,
            "reliability": info.qos_profile.reliability.name.lower(),
            "durability": info.qos_profile.durability.name.lower(),
        }
        for info in infos
    ]


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("--wait-for", action="append", default=[], metavar="NAME",
                           help="a node or topic that must be there (may be repeated)")
    arguments.add_argument("--settle", type=float, default=1.0, help="seconds to look at the least (default: 1)")
    given = arguments.parse_args()
    with peer.node("peer_graph") as node:
        def nodes() -> list[str]:
            return sorted({f"{space.rstrip('/')}/{name}" for name, space in node.get_node_names_and_namespaces()})

        def missing() -> list[str]:
            present = {name for name, _ in node.get_topic_names_and_types()} | set(nodes())
            return [name for name in given.wait_for if name not in present]

        peer.spin_until(node, lambda: False, given.settle)
        if not peer.spin_until(node, lambda: not missing(), given.timeout):
            peer.fail(f"not seen within {given.timeout} s: {', '.join(missing())}")
        topics = {
            name: {
                "types": sorted(types),
                "publishers": ends(node.get_publishers_info_by_topic(name)),
                "subscribers": ends(node.get_subscriptions_info_by_topic(name)),
            }
            for name, types in sorted(node.get_topic_names_and_types())
        }
        services = {name: sorted(types) for name, types in sorted(node.get_service_names_and_types())}
        own = "/peer_graph"
        peer.report({"nodes": [name for name in nodes() if name != own], "topics": topics, "services": services})


if __name__ == "__main__":
    main()
