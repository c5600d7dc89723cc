"""Several runs of the matrix at a time, each a process with a domain, shared memory, folders and network of its own."""

import itertools
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import history
import verdict

# ROS domains whose ports are below those that the kernel gives away.
DOMAINS = 100
# How often processes are looked at, s.
GLANCE = 0.2
# How long a run may take beyond its duration, s: to start, to be judged, and what it waits for at its end. Who takes longer hangs.
BEYOND = 240.0
# What a run takes of the machine, on one host and on several, and what each of the jobs at once may take. On two cores three jobs are four
# runs on one host or two on several: with three of these the kernel itself brought bytes over a pseudo-terminal up to 0.1 s late.
LIGHT, SEVERAL, WHOLE = 3, 6, 4


@dataclass
class Job:
    """A run of the matrix with a seed."""

    run: dict
    seed: int
    process: subprocess.Popen | None = None
    began: float = 0.0
    hurried: bool = False

    def folder(self, results: Path) -> Path:
        """Where its results are."""
        return results / self.run["name"] / str(self.seed)

    def hurry(self) -> None:
        """Ends a run that hangs, by an interrupt at first, so that it cleans up."""
        late = time.monotonic() - self.began - float(self.run["arguments"]["duration"]) - BEYOND
        if late > BEYOND:
            os.killpg(self.process.pid, signal.SIGKILL)
        elif late > 0.0 and not self.hurried:
            self.hurried = True
            self.process.send_signal(signal.SIGINT)

    def cost(self) -> int:
        """What it takes of the machine."""
        return SEVERAL if "hosts" in self.run else LIGHT


def free_domains() -> Iterator[int]:
    """ROS domains that nobody on this machine is in, again and again."""
    for number in itertools.count(os.getpid()):
        domain = 1 + number % DOMAINS
        port = f":{7400 + 250 * domain:04X} "
        if port not in Path("/proc/net/udp").read_text(encoding="ascii"):
            yield domain


class Company:
    """Carries runs out, so many at a time as `at_once` jobs may take of the machine."""

    def __init__(self, results: Path, binaries: Path, at_once: int):
        self.results, self.binaries, self.at_once = results, binaries, at_once
        self.domains = free_domains()
        self.failed = False

    def conduct(self, jobs: list[Job]) -> None:
        """All jobs: side by side those that may, then those that must be alone, then those that failed side by side."""
        for job in jobs:
            history.put_by(job.run, self._kept(job))
            shutil.rmtree(self._kept(job), ignore_errors=True)
        together = [job for job in jobs if self.at_once > 1 and not job.run.get("alone")]
        # The longest first, so that none is left over at the end.
        together.sort(key=lambda job: -float(job.run["arguments"]["duration"]))
        self._carry_out(together, self.at_once)
        again = [job for job in together if not self._passed(job)]
        self._carry_out([job for job in jobs if job not in together], 1)
        for job in again:
            self._keep(job)
        self._carry_out(again, 1)
        self.failed |= not all(self._passed(job) for job in jobs)

    def _carry_out(self, jobs: list[Job], at_once: int) -> None:
        waiting, running = list(jobs), []
        try:
            while waiting or running:
                left = WHOLE * at_once - sum(job.cost() for job in running)
                fitting = next((job for job in waiting if not running or job.cost() <= left), None)
                if fitting:
                    waiting.remove(fitting)
                    running.append(self._start(fitting))
                    continue
                time.sleep(GLANCE)
                for job in running:
                    job.hurry()
                for job in [job for job in running if job.process.poll() is not None]:
                    running.remove(job)
                    self._end(job, at_once > 1)
        finally:
            for job in running:
                job.process.send_signal(signal.SIGINT)
            for job in running:
                job.process.wait()

    def _start(self, job: Job) -> Job:
        folder = job.folder(self.results)
        history.put_by(job.run, folder)
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        program = Path(__file__).with_name("conduct.py")
        with open(folder / "conduct.log", "w", encoding="utf-8") as log:
            job.process = subprocess.Popen(
                [sys.executable, str(program), str(self.binaries), str(folder), job.run["name"], str(job.seed)],
                env=os.environ | {"ROS_DOMAIN_ID": str(next(self.domains))}, stdout=log, stderr=log,
                # An interrupt from the terminal comes through us alone.
                start_new_session=True,
            )
        job.began = time.monotonic()
        return job

    def _end(self, job: Job, in_company: bool) -> None:
        folder = job.folder(self.results)
        if not (folder / "verdicts.json").exists():
            said = (folder / "conduct.log").read_text(encoding="utf-8", errors="replace").strip().splitlines()
            problem = f"the run broke off: {said[-1] if said else 'without a word'}"
            verdict.write(folder, job.seed, [verdict.Verdict(fault["name"], job.run["name"], [problem]) for fault in job.run["faults"]])
        for told in verdict.read(folder)["verdicts"]:
            line = verdict.Verdict(**told).line()
            print(f"{line}{' (in company: again alone)' if in_company and told['problems'] else ''}", flush=True)

    def _keep(self, job: Job) -> None:
        """Keeps what came of it in company, for the table and for who wants to know why."""
        job.folder(self.results).rename(self._kept(job))

    def _kept(self, job: Job) -> Path:
        return job.folder(self.results).with_name(f"{job.seed}{verdict.IN_COMPANY}")

    def _passed(self, job: Job) -> bool:
        return all(not told["problems"] for told in verdict.read(job.folder(self.results))["verdicts"])
