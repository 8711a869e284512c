"""Solids over HTTP: PLC JSON and STL in; cell, full mesh and statistics out, looked at by a checker
that shares no code with the mesher (shared/tools/meshcheck.py, where it is there)."""

import gzip
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from symcell_server import ROOT, Server, box, until

CHECKER = ROOT.parent / "shared" / "tools" / "meshcheck.py"
HEXNUT = ROOT / "docs" / "examples" / "hexnut.json"
GEAR = ROOT / "docs" / "examples" / "gear.stl"


@unittest.skipUnless(shutil.which("curl"), "curl is not installed")
class SolidResultsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(workers=1).start()
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="symcell-e2e-"))

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()
        shutil.rmtree(cls.folder)

    def curl(self, path, *arguments):
        result = subprocess.run(
            ["curl", "-s", "-S", "--fail-with-body", *arguments, f"http://127.0.0.1:{self.server.port}{path}"],
            capture_output=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return result.stdout

    def meshed(self, path, *arguments):
        """The succeeded job's document; its results are in the folder."""
        job = json.loads(self.curl(path, *arguments))
        job = self.server.finished(job["id"], 200)
        self.assertEqual(job["state"], "succeeded", job.get("error"))
        for part in ("cell", "full"):
            for name in ("vtu", "json", "msh", "stl"):
                self.curl(f"/v1/jobs/{job['id']}/{part}?format={name}", "-o", str(self.folder / f"{part}.{name}"))
        self.curl(f"/v1/jobs/{job['id']}/statistics", "-o", str(self.folder / "statistics.json"))
        return job

    def check(self, model, *arguments):
        if not CHECKER.exists():
            return
        done = subprocess.run(
            [sys.executable, CHECKER, self.folder / "cell.vtu", "--full", self.folder / "full.vtu",
             "--stats", self.folder / "statistics.json", "--model", model, *arguments],
            capture_output=True, text=True, timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-1000:])

    def counts(self):
        statistics = json.loads((self.folder / "statistics.json").read_text())
        for part in ("cell", "full"):
            mesh = json.loads((self.folder / f"{part}.json").read_text())
            self.assertEqual(mesh["dimension"], 3)
            self.assertEqual(len(mesh["elements"]), statistics[part]["elements"])
            self.assertEqual(len(mesh["nodes"]), statistics[part]["nodes"])
        self.assertEqual(statistics["full"]["elements"],
                         statistics["cell"]["elements"] * statistics["symmetry"]["fold"])
        return statistics

    def test_a_plc(self):
        job = self.meshed("/v1/jobs?max_volume=2", "--data-binary", f"@{HEXNUT}")
        self.assertEqual(job["model"]["format"], "plc_json")
        statistics = self.counts()
        self.assertEqual(statistics["symmetry"]["fold"], 6)
        self.assertLessEqual(statistics["cell"]["max_radius_edge"], 1.414)
        self.check(HEXNUT, "--radius-edge", "1.415", "--max-volume", "2")
        self.assertIn(b"$Periodic", (self.folder / "cell.msh").read_bytes())

    def test_an_stl_as_the_manual_says(self):
        job = self.meshed("/v1/jobs?max_volume=10", "--data-binary", f"@{GEAR}",
                          "-H", "Content-Type: model/stl")
        self.assertEqual(job["model"]["format"], "stl")
        self.assertEqual(self.counts()["symmetry"]["fold"], 17)
        self.check(GEAR, "--radius-edge", "1.415", "--max-volume", "10")

    def test_formats_of_the_other_kind_are_refused(self):
        job = self.server.finished(self.server.submit(box())["id"])
        answer = self.server.get(f"/v1/jobs/{job['id']}/cell?format=svg")
        self.assertEqual(answer.status, 406)
        self.assertIn("planar", answer.json()["detail"])
        self.assertEqual(self.server.get(f"/v1/jobs/{job['id']}/full", Accept="image/svg+xml").status, 406)

    def test_what_an_stl_is_called_does_not_matter(self):
        packed = self.folder / "gear.stl.gz"
        packed.write_bytes(gzip.compress(GEAR.read_bytes()))
        for arguments in (["--data-binary", f"@{GEAR}"],
                          ["--data-binary", f"@{GEAR}", "-H", "Content-Type: application/octet-stream"],
                          ["--data-binary", f"@{GEAR}", "-H", "Content-Type: application/sla"],
                          ["--data-binary", f"@{packed}", "-H", "Content-Type: model/stl"],
                          ["--data-binary", f"@{packed}", "-H", "Content-Encoding: gzip"],
                          ["-F", f"model=@{GEAR}"], ["-F", f"model=@{packed};filename=part"],
                          ["-T", str(GEAR), "-X", "POST"]):
            with self.subTest(arguments):
                found = json.loads(self.curl("/v1/inspect", *arguments))
                self.assertEqual((found["type"], found["fold"], found["watertight"]), ("surface", 17, True))

    def test_a_broken_stl_is_told_at_once(self):
        cut = self.folder / "cut.stl"
        cut.write_bytes(GEAR.read_bytes()[:1000])
        answer = self.server.request("POST", "/v1/jobs", cut.read_bytes(), {"Content-Type": "model/stl"})
        self.assertEqual(answer.status, 400, answer.body)
        self.assertIn(answer.json()["code"], ("truncated", "count_mismatch"))

    def test_events_tell_phases_and_elements(self):
        # Large enough that its refinement lasts longer than the 250 ms between two events.
        job = self.server.submit(json.loads(HEXNUT.read_text()), {"max_volume": 0.001})
        blocks = self.server.get(f"/v1/jobs/{job['id']}/events").text().split("\n\n")
        events = [dict(line.split(": ", 1) for line in block.splitlines() if ": " in line)
                  for block in blocks if block.startswith("event: ")]
        self.assertEqual(json.loads(events[-1]["data"])["state"], "succeeded")
        progress = [json.loads(e["data"]) for e in events if e["event"] == "progress"]
        self.assertIn("refine", {p["phase"] for p in progress})
        self.assertTrue([p for p in progress if p["elements"] > 1000], progress)
        fractions = [p["fraction"] for p in progress]
        self.assertEqual(fractions, sorted(fractions))

    def test_a_meshing_solid_is_cancelled_within_a_second(self):
        job = self.server.submit(json.loads(HEXNUT.read_text()), {"max_volume": 1e-4})
        until(lambda: self.server.job(job["id"])["progress"]["elements"] > 1000, "it refines")
        self.server.request("POST", f"/v1/jobs/{job['id']}/cancel")
        until(lambda: self.server.job(job["id"])["state"] == "cancelled", "cancelled", 2)


if __name__ == "__main__":
    unittest.main()
