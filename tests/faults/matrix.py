"""The fault matrix: what matrix.yaml says."""

import yaml

from launched import ROOT

FILE = ROOT / "tests" / "faults" / "matrix.yaml"


def runs() -> list[dict]:
    """All runs, each with its faults."""
    return yaml.safe_load(FILE.read_text(encoding="utf-8"))["runs"]


def run(name: str) -> dict:
    """The run of this name."""
    return next(run for run in runs() if run["name"] == name)
