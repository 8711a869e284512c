"""STEP and IGES through the program and the service: files that tests/cad writes."""

import gzip
import json
import pathlib
import subprocess
import tempfile
import unittest

from symcell_server import Server, binary

PARTS = pathlib.Path(binary()).parent / "tests" / "cad" / "parts"


def part(name):
    return (PARTS / name).read_bytes()


def form(files, fields):
    """A multipart body, and its media type."""
    border = "part-of-a-form"
    body = b""
    for name, (file_name, data) in files.items():
        body += (f'--{border}\r\nContent-Disposition: form-data; name="{name}"; filename="{file_name}"\r\n\r\n'
                 ).encode() + data + b"\r\n"
    for name, value in fields.items():
        body += f'--{border}\r\nContent-Disposition: form-data; name="{name}"\r\n\r\n{value}\r\n'.encode()
    return body + f"--{border}--\r\n".encode(), f"multipart/form-data; boundary={border}"


@unittest.skipUnless((PARTS / "disc.step").exists(), "this build has no OpenCASCADE")
class CadTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server().start()

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()

    def check(self, answer, name):
        self.assertEqual(answer.status, 202, answer.body)
        job = self.server.finished(answer.json()["id"])
        self.assertEqual(job["state"], "succeeded", job.get("error"))
        self.assertEqual(job["model"]["format"], name)
        self.assertEqual(job["statistics"]["symmetry"]["fold"], 6)
        return job

    def test_bodies_of_every_form(self):
        for file, media_type, name in (("disc.step", "model/step", "step"),
                                       ("disc.step", "application/octet-stream", "step"),
                                       ("disc_solid.igs", "model/iges", "iges")):
            for path in ("/v1/jobs", "/v1/jobs/file"):
                with self.subTest(f"{file} {media_type} {path}"):
                    job = self.check(self.server.request("POST", path, part(file), {"Content-Type": media_type}),
                                     name)
            model = self.server.get(f"/v1/jobs/{job['id']}/model")
            self.assertEqual(model.body, part(file))
            self.assertEqual(model.headers["Content-Type"].split(";")[0], f"model/{name}")
        self.check(self.server.request("POST", "/v1/jobs/file", gzip.compress(part("disc.step")),
                                       {"Content-Type": "model/step"}), "step")

    def test_a_form(self):
        body, media_type = form({"model": ("disc.STP", part("disc.step"))},
                                {"options": json.dumps({"sizes": "bore=2"})})
        for path in ("/v1/jobs", "/v1/jobs/form"):
            self.check(self.server.request("POST", path, body, {"Content-Type": media_type}), "step")

    def test_inspection(self):
        answer = self.server.request("POST", "/v1/inspect", part("coloured.step"), {"Content-Type": "model/step"})
        self.assertEqual(answer.status, 200, answer.body)
        groups = {g["name"]: g for g in answer.json()["groups"]}
        self.assertIn("shaft seat", groups, answer.body)
        self.assertEqual(groups["shaft seat"]["color"], "#ff0000")

    def test_what_crashes_the_reader_ends_nothing_else(self):
        whole = part("disc.step").decode()
        circular = "".join(
            line if " = AXIS2_PLACEMENT_3D('',#" not in line
            else f"{line.split(' ')[0]} = AXIS2_PLACEMENT_3D('',{line.split(' ')[0]},#1,#1);\n"
            for line in whole.splitlines(keepends=True))
        for text in (circular, whole[:len(whole) // 2], whole.replace("CARTESIAN_POINT('',(", "CARTESIAN_POINT('',(1.E300,"),
                     "ISO-10303-21;\n"):
            answer = self.server.request("POST", "/v1/jobs", text.encode(), {"Content-Type": "model/step"})
            self.assertEqual(answer.status // 100, 4, answer.body)
            self.assertIn("STEP", answer.json()["detail"])
        self.check(self.server.request("POST", "/v1/jobs", part("disc.step"), {"Content-Type": "model/step"}),
                   "step")

    def test_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            cell, full = f"{folder}/cell.vtu", f"{folder}/full.vtu"
            subprocess.run([binary(), "mesh", PARTS / "disc.step", "--cell", cell, "--full", full], check=True,
                           capture_output=True)
            verified = subprocess.run([binary(), "verify", cell, "--full", full, "--model", PARTS / "disc.step"],
                                      capture_output=True, text=True)
            self.assertEqual(verified.returncode, 0, verified.stdout + verified.stderr)
        version = subprocess.run([binary(), "--version"], capture_output=True, text=True, check=True).stdout
        self.assertRegex(version, r"STEP and IGES: OpenCASCADE \d+\.\d+")


if __name__ == "__main__":
    unittest.main()
