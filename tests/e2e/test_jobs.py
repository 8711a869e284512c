"""A job from socket to file, with the real mesher."""

import json
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree
import pathlib

from symcell_server import Server, binary, square, until


class JobsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server().start()
        cls.job = cls.server.finished(cls.server.submit(square(), {"max_area": 0.01})["id"])
        cls.path = cls.job["links"]["self"]

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()

    def test_the_square_is_meshed_with_its_symmetry(self):
        self.assertEqual(self.job["state"], "succeeded", self.job)
        statistics = self.job["statistics"]
        self.assertEqual(statistics["symmetry"]["fold"], 4)
        self.assertTrue(statistics["symmetry"]["detected"])
        self.assertAlmostEqual(statistics["cell"]["area"], 0.25, places=9)
        self.assertGreaterEqual(statistics["cell"]["min_angle_deg"], 30 - 1e-6)
        self.assertEqual(statistics["full"]["elements"], 4 * statistics["cell"]["elements"])
        self.assertEqual(self.server.get(self.path + "/statistics").json(), statistics)

    def test_meshes_agree_with_the_statistics(self):
        cell = self.server.get(self.path + "/cell?format=json").json()
        full = self.server.get(self.path + "/full", Accept="application/json").json()
        self.assertEqual(len(cell["elements"]), self.job["statistics"]["cell"]["elements"])
        self.assertEqual(len(full["elements"]), self.job["statistics"]["full"]["elements"])
        self.assertEqual(len(full["nodes"]), self.job["statistics"]["full"]["nodes"])
        self.assertEqual(sorted(set(full["sector"])), [0, 1, 2, 3])

    def test_every_format_can_be_read(self):
        svg = self.server.get(self.path + "/full?format=svg").text()
        self.assertTrue(xml.etree.ElementTree.fromstring(svg).tag.endswith("svg"))
        ascii_vtu = self.server.get(self.path + "/cell?format=vtu&encoding=ascii").text()
        self.assertEqual(xml.etree.ElementTree.fromstring(ascii_vtu).tag, "VTKFile")
        self.assertTrue(self.server.get(self.path + "/cell?format=msh").body.startswith(b"$MeshFormat"))

    def test_the_program_verifies_what_the_service_gives(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            for name in ("cell", "full"):
                (folder / f"{name}.vtu").write_bytes(self.server.get(f"{self.path}/{name}?format=vtu").body)
            (folder / "model.json").write_bytes(self.server.get(self.path + "/model").body)
            result = subprocess.run(
                [binary(), "verify", folder / "cell.vtu", "--full", folder / "full.vtu",
                 "--model", folder / "model.json"], capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_the_same_request_gives_the_same_bytes(self):
        again = self.server.finished(self.server.submit(square(), {"max_area": 0.01})["id"])
        for what in ("/cell?format=vtu", "/full?format=msh", "/full?format=json"):
            self.assertEqual(self.server.get(self.path + what).body,
                             self.server.get(again["links"]["self"] + what).body, what)

    def test_prefer_wait_gives_the_finished_job(self):
        answer = self.server.post_json("/v1/jobs", {"model": square()}, Prefer="wait=30")
        self.assertEqual(answer.status, 201, answer.body)
        self.assertEqual(answer.json()["state"], "succeeded")
        self.assertEqual(answer.headers["Location"], answer.json()["links"]["self"])

    def test_quadratic_elements(self):
        job = self.server.submit(square(), {"order": 2}, Prefer="wait=30")
        cell = self.server.get(job["links"]["cell"] + "?format=json").json()
        self.assertEqual(cell["order"], 2)
        self.assertEqual(len(cell["elements"][0]), 6)

    def test_geometric_errors_are_the_jobs(self):
        job = self.server.finished(self.server.submit(square(), {"fold": 3})["id"])
        self.assertEqual(job["state"], "failed")
        self.assertEqual(job["error"]["code"], "not_symmetric")
        self.assertEqual(job["error"]["status"], 422)

    def test_warnings_are_told_and_strict_refuses_them(self):
        uneven = square()
        uneven["vertices"][0] = [-0.5, -0.2]
        job = self.server.finished(self.server.submit(uneven)["id"])
        self.assertEqual([w["code"] for w in job["warnings"]], ["no_symmetry_found"])
        self.assertEqual(job["statistics"]["warnings"], job["warnings"])
        text = self.server.get(job["links"]["events"]).text()
        end = json.loads(text.split("event: end\ndata: ", 1)[1].split("\n", 1)[0])
        self.assertEqual(end["warnings"], job["warnings"])
        inspection = self.server.post_json("/v1/inspect", {"model": uneven}).json()
        self.assertEqual(inspection["warnings"], job["warnings"])

        strict = self.server.finished(self.server.submit(uneven, {"strict": True})["id"])
        self.assertEqual(strict["state"], "failed")
        self.assertEqual(strict["error"]["code"], "strict_warnings")
        self.assertEqual(strict["error"]["status"], 422)
        self.assertIn("no_symmetry_found", strict["error"]["detail"])
        even = self.server.finished(self.server.submit(square(), {"strict": True})["id"])
        self.assertEqual((even["state"], even["warnings"]), ("succeeded", []))

    def test_events_lead_to_the_end(self):
        text = self.server.get(self.path + "/events").text()
        end = [block for block in text.split("\n\n") if block.startswith("event: end\n")]
        self.assertEqual(len(end), 1, text)
        self.assertEqual(json.loads(end[0].split("data: ", 1)[1])["id"], self.job["id"])
        logged = until(lambda: [event for event in self.server.log_events()
                                if event.get("path") == self.path + "/events"],
                       "the stream stands in the log")
        self.assertGreater(logged[0]["bytes"], len(text))

    def test_inspect_finds_the_fold(self):
        answer = self.server.post_json("/v1/inspect", {"model": square()})
        self.assertEqual(answer.status, 200, answer.body)
        self.assertEqual(answer.json()["fold"], 4)
        self.assertAlmostEqual(answer.json()["area"], 1)

    def test_results_are_cached_and_compressed(self):
        first = self.server.get(self.path + "/full?format=json")
        etag = first.headers["ETag"]
        again = self.server.get(self.path + "/full?format=json", If_None_Match=etag)
        self.assertEqual((again.status, again.body), (304, b""))
        packed = self.server.get(self.path + "/full?format=json", Accept_Encoding="gzip")
        self.assertLess(len(packed.body), len(first.body))
        self.assertEqual(packed.text(), first.text())


if __name__ == "__main__":
    unittest.main()
