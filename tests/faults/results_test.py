"""Shows what is made of results: what is kept of them from run to run, the pages of the documentation, and the sample that scripts/test takes.

usage: python -m unittest results_test, in this folder and the environment of scripts/ros-venv; scripts/test does that.
"""

import json
import tempfile
import unittest
from pathlib import Path

import history
import matrix
import recovery
import run
import table
from verdict import IN_COMPANY


class Kept(unittest.TestCase):
    """Results from run to run."""

    RUNS = [{"name": "a-run", "faults": [{"name": "a-fault", "unnamed": "a test"}]}]

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results, self.file = Path(folder.name), Path(folder.name) / "faults.jsonl"

    def run_of(self, date: str, *problems: str, seed: str = "1") -> None:
        """What a run leaves in its folder, which the next one empties."""
        kept = self.results / "a-run" / seed
        history.put_by(self.RUNS[0], kept)
        kept.mkdir(parents=True, exist_ok=True)
        told = {"fault": "a-fault", "run": "a-run", "problems": problems}
        document = {"date": date, "seed": 1, "commit": "c", "verdicts": [told]}
        (kept / "verdicts.json").write_text(json.dumps(document), encoding="utf-8")

    def attempts(self) -> list[bool]:
        """What is known after the table was written."""
        return history.attempts_of("a-fault", history.merged(self.RUNS, self.results, self.file))

    def test_what_failed_and_passes_the_next_time_has_not_passed_always(self):
        self.run_of("2026-11-28 07:45", "contact: robot1 touches robot2", "a second one")
        self.assertEqual(self.attempts(), [False])
        self.run_of("2026-11-28 08:45")
        self.assertEqual(self.attempts(), [False, True])
        # Nothing is counted twice, on another machine neither, which has the file alone.
        self.assertEqual(self.attempts(), [False, True])
        self.results = self.results / "elsewhere"
        self.assertEqual(self.attempts(), [False, True])
        self.run_of("2026-11-28 09:45", "contact")
        self.run_of("2026-11-28 10:45")
        self.assertEqual(self.attempts(), [False, True, False, True])
        [document] = map(json.loads, self.file.read_text(encoding="utf-8").splitlines())
        self.assertEqual([attempt["problems"]["a-fault"] for attempt in document["attempts"]], ["contact: robot1 touches robot2", "", "contact"])

    def test_what_failed_beside_others_stays_an_attempt(self):
        self.run_of("2026-11-28 07:45", "contact", seed=f"1{IN_COMPANY}")
        self.run_of("2026-11-28 07:46")
        self.assertEqual(sorted(self.attempts()), [False, True])
        history.put_by(self.RUNS[0], self.results / "a-run" / f"1{IN_COMPANY}")
        (self.results / "a-run" / f"1{IN_COMPANY}" / "verdicts.json").unlink()
        self.run_of("2026-11-28 08:46")
        self.assertEqual(sorted(self.attempts()), [False, True, True])


class Sample(unittest.TestCase):
    """What scripts/test takes by turns."""

    RUNS = [run for run in matrix.runs() if run.get("sample")]

    def test_it_has_many_kinds_of_faults_and_takes_no_longer_than_before(self):
        faults = [fault for run in self.RUNS for fault in run["faults"]]
        wanted = ("kill", "ends", "pause", "publish", "network", "serial", "clock", "bed", "bag", "quits")
        self.assertEqual([key for key in wanted if not any(key in fault for fault in faults)], [])
        self.assertLessEqual({"loss", "forged", "replayed", "far", "frozen", "black", "covered"}, {fault["bed"]["kind"] for fault in faults if "bed" in fault})
        self.assertLessEqual(max(float(run["arguments"]["duration"]) for run in self.RUNS), 50.0)

    def test_over_the_turns_each_run_comes_with_each_seed(self):
        turns = len(self.RUNS) * run.SEEDS
        jobs = [job for turn in range(turns) for job in run.sampled(self.RUNS, turn)]
        self.assertEqual(len(jobs), run.SAMPLE * turns)
        self.assertEqual({job.seed for job in jobs[: len(self.RUNS)]}, {1}, "all runs come with a seed before the next one")
        for wanted in self.RUNS:
            self.assertEqual({job.seed for job in jobs if job.run == wanted}, {1, 2, 3}, wanted["name"])


class Pages(unittest.TestCase):
    """Pages of the documentation that are made of results."""

    def test_the_page_of_faults_counts_changes_that_fall_into_faults(self):
        faults = [
            {"at": 5.0, "for": 2.0}, {"at": 10.0, "kill": "rf_bridge"}, {"at": 20.0, "clock": 1.0}, {"bed": {"from": 31.0, "to": 33.0}},
        ]

        def within(*times: float) -> int:
            return table.changes_within({"faults": faults, "changes": [{"at": at} for at in times]})

        self.assertEqual([within(at) for at in (4.9, 5.0, 7.0, 7.1, 10.5, 11.1, 20.9, 29.9, 30.0, 32.0, 32.1)], [0, 1, 1, 0, 1, 0, 1, 0, 1, 1, 0])
        self.assertEqual(within(6.0, 6.5, 31.0), 2)
        self.assertEqual(table.changes_within({"faults": faults}), 0)

    def test_the_page_of_faults_says_who_failed_before(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "FAULTS.md"
            (Path(folder) / "BENCHMARKS.md").write_text(recovery.BEGIN + recovery.END, encoding="utf-8")
            document = {"run": "kills", "seed": 1, "in_company": False, "commit": "c", "date": "2026-11-28 10:00"}
            failed = {"date": "2026-11-28 09:00", "commit": "c", "in_company": False, "problems": {"kill-bridge": "contact"}}
            told = document | {"verdicts": [{"fault": "kill-bridge", "problems": []}], "attempts": [failed]}
            page.with_name("faults.jsonl").write_text(json.dumps(told) + "\n", encoding="utf-8")
            table.write(matrix.runs(), Path(folder) / "none", page)
            rows = page.read_text(encoding="utf-8").splitlines()
            self.assertIn("| pass | 1 of 1 | 1 of 2 |", next(row for row in rows if row.startswith("| kill-bridge |")))
            self.assertEqual([row for row in rows if any(word in row for word in ("CHANGING", "SHAPED", "WITHIN", "RECORDED", "RUNS", "FAULTS "))], [])

    def test_the_benchmarks_say_what_the_results_of_the_matrix_say(self):
        docs = matrix.ROOT / "docs"
        told = [json.loads(line) for line in (docs / "faults.jsonl").read_text(encoding="utf-8").splitlines()]
        rows = recovery.rows(told)
        for victim in ("rf_bridge (kill-bridge)", "router (zenoh-kill-router, hosts-zenoh)", "view (kill-view)", "launcher (kill-launcher)"):
            self.assertIn(f"| {victim} |", rows)
        page = (docs / "BENCHMARKS.md").read_text(encoding="utf-8")
        self.assertIn(recovery.BEGIN + recovery.HEAD + rows + recovery.END, page)


if __name__ == "__main__":
    unittest.main()
