"""What came of a fault, and where that is kept."""

import datetime
import json
from dataclasses import asdict, dataclass, field
from pathlib import Path

# Behind the seed in the name of the folder of a run that failed beside others and was run again alone.
IN_COMPANY = "-in-company"


@dataclass
class Verdict:
    """What came of one fault."""

    fault: str
    run: str
    problems: list[str] = field(default_factory=list)
    diagnosed: float | None = None
    stood: float | None = None
    rested: float | None = None
    recovered: float | None = None
    formed: float | None = None

    @property
    def passed(self) -> bool:
        """Whether every criterion holds."""
        return not self.problems

    def line(self) -> str:
        """For the terminal."""
        times = [("diagnostic", self.diagnosed), ("still", self.stood), ("rest", self.rested), ("driven", self.recovered), ("formed", self.formed)]
        told = ", ".join(f"{name} {value:.2f} s" for name, value in times if value is not None)
        return f"{'pass' if self.passed else 'FAIL'}  {self.fault}: {told or '-'}{''.join(f'; {p}' for p in self.problems)}"


def write(folder: Path, seed: int, verdicts: list[Verdict]) -> None:
    """Keeps what came of a run."""
    date = datetime.datetime.now(datetime.UTC).strftime("%F %H:%M")
    document = {"date": date, "seed": seed, "verdicts": [asdict(verdict) for verdict in verdicts]}
    (folder / "verdicts.json").write_text(json.dumps(document, indent=1), encoding="utf-8")


def read(folder: Path) -> dict:
    """What came of a run: date, seed, verdicts."""
    return json.loads((folder / "verdicts.json").read_text(encoding="utf-8"))
