"""Changes of the formation during a run of the matrix (`changes`), each at its time after t0, whatever fault is on then."""

import json
import subprocess
import sys
import threading
import time
from pathlib import Path

from hosts import BASE
from launched import Launched


# How long who asks for changes may take to go, s.
FAREWELL = 10.0


class Changes:
    """Somebody at the base station who asks for them (change.py)."""

    def __init__(self, run: dict, launched: Launched):
        self.wanted = sorted(run.get("changes", []), key=lambda change: change["at"])
        self.problems: list[str] = []
        self.process, self.thread = None, None
        if not self.wanted and "late" not in run:
            return
        self.process = launched.run(BASE, [sys.executable, str(Path(__file__).with_name("change.py"))], "change")
        if self.process.stdout.readline() != "ready\n":
            raise RuntimeError("nobody can ask for another formation: see change.log")

    def ask(self, **request) -> None:
        """Waits for the answer."""
        self.process.stdin.write(json.dumps(request) + "\n")
        self.process.stdin.flush()
        if not json.loads(self.process.stdout.readline() or "false"):
            self.problems.append(f"nobody granted {request}")

    def begin(self, t0: float) -> None:
        """From now on they are asked for at their times after t0 (s, wall clock)."""
        if self.wanted:
            self.thread = threading.Thread(target=self._conduct, args=(t0,))
            self.thread.start()

    def _conduct(self, t0: float) -> None:
        for change in self.wanted:
            time.sleep(max(0.0, t0 + change["at"] - time.time()))
            self.ask(**{name: value for name, value in change.items() if name != "at"})

    def end(self) -> None:
        """Waits for the last one."""
        if self.thread:
            self.thread.join()
        if self.process:
            self.process.stdin.close()
            try:
                self.process.wait(FAREWELL)
            except subprocess.TimeoutExpired:
                # Of rclpy: a thread of Fast DDS 3.2.2 was seen to read one sample of ros_discovery_info again and again that its pool had taken back
                # (all zeros), after those who wrote it had left. It had nothing to do any more.
                self.process.kill()
                self.process.wait()
