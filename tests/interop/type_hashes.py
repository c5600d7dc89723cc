"""Prints the RIHS01 hashes of packages as their build for rclpy states them, one JSON object: to compare with
`cargo run -p trench_msgs --example type_hashes`.

usage: type_hashes.py [PACKAGE ...]   (default: trench_msgs)
"""

import json
import sys
from pathlib import Path

from ament_index_python.packages import get_package_share_directory


def hashes(package: str) -> dict[str, str]:
    """All types that the type descriptions of a package define itself."""
    found = {}
    for path in Path(get_package_share_directory(package)).glob("*/*.json"):
        for entry in json.loads(path.read_text()).get("type_hashes", []):
            if entry["type_name"].startswith(f"{package}/"):
                found[entry["type_name"]] = entry["hash_string"]
    return found


def main() -> None:
    found = {}
    for package in sys.argv[1:] or ["trench_msgs"]:
        found |= hashes(package)
    print(json.dumps(found, indent=1, sort_keys=True))


if __name__ == "__main__":
    main()
