"""What a run of the matrix left for the judge."""

from dataclasses import dataclass
from pathlib import Path


@dataclass
class Evidence:
    """What a run left."""

    bag: Path
    # What the launcher of each host had said when that of the base station ended.
    logs: dict[str, str]
    exit_code: int
    memory: list[dict[str, int]]
    alive_after: float | None
    own_bag: Path
    # Of a second recorder, which begins a new file every so often.
    split_bag: Path
    binaries: Path
    seen: Path
    tap: Path
    spoken: Path
    refused: list[str]
    # What runs beside the launched processes, launchers of other hosts too, and had ended by then.
    missing: list[str]
    # Its files in shared memory, when all had ended.
    left: list[str]
