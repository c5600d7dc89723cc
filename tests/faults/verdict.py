"""What came of a fault, and where that is kept."""

import datetime
import json
import subprocess
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
    # How long the fault lasted, s: of a process that was killed, until it lived again.
    lasted: float | None = None
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
    document = {"date": date, "seed": seed, "commit": commit(), "verdicts": [asdict(verdict) for verdict in verdicts]}
    (folder / "verdicts.json").write_text(json.dumps(document, indent=1), encoding="utf-8")


def commit() -> str:
    """The commit that is tried, with a plus where files of it were changed; nothing outside of a repository."""
    describe = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--exclude=*", "--dirty=+"]
    return subprocess.run(describe, capture_output=True, text=True, check=False).stdout.strip()


def read(folder: Path) -> dict:
    """What came of a run: date, seed, commit, verdicts."""
    return json.loads((folder / "verdicts.json").read_text(encoding="utf-8"))
