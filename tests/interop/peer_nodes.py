"""Prints what each node has, as `ros2 node info` shows it: topics and services by name and type."""

import peer

KINDS = ("publisher", "subscriber", "service", "client")


def main() -> None:
    arguments = peer.parser(__doc__)
    arguments.add_argument("--wait-for", action="append", default=[], metavar="NODE",
                           help="a node that must be there (may be repeated)")
    arguments.add_argument("--settle", type=float, default=1.0, help="seconds to look at the least (default: 1)")
    arguments.add_argument("--announce", action="store_true", help="first print that it waits")
    given = arguments.parse_args()
    with peer.node("peer_nodes") as node:
        def nodes() -> dict[str, tuple[str, str]]:
            pairs = node.get_node_names_and_namespaces()
            return {f"{space.rstrip('/')}/{name}": (name, space) for name, space in pairs if name != "peer_nodes"}

        def ends(name: str, space: str) -> dict[str, dict[str, list[str]]]:
            asked = {kind: getattr(node, f"get_{kind}_names_and_types_by_node")(name, space) for kind in KINDS}
            return {kind: {topic: sorted(types) for topic, types in found} for kind, found in asked.items()}

        if given.announce:
            peer.report({"waits": True})
        peer.spin_until(node, lambda: False, given.settle)
        if not peer.spin_until(node, lambda: set(given.wait_for) <= nodes().keys(), given.timeout):
            peer.fail(f"not seen within {given.timeout} s: {', '.join(set(given.wait_for) - nodes().keys())}")
        peer.report({full: ends(*pair) for full, pair in nodes().items()})


if __name__ == "__main__":
    main()
