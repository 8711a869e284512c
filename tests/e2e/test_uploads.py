"""The ways curl sends a model."""

import gzip
import json
import pathlib
import re
import shutil
import socket
import subprocess
import tempfile
import unittest

from symcell_server import Server, square, without_sanitizer


@unittest.skipUnless(shutil.which("curl"), "curl is not installed")
class UploadsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(max_body_bytes=1_000_000).start()
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="symcell-e2e-"))
        cls.model = cls.folder / "square.json"
        cls.model.write_text(json.dumps(square()))
        cls.poly = cls.folder / "triangle.poly"
        cls.poly.write_text("3 2 0 0\n1 0 0\n2 1 0\n3 0.5 0.9\n3 0\n1 1 2\n2 2 3\n3 3 1\n0\n")

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()
        shutil.rmtree(cls.folder)

    def curl(self, path, *arguments):
        """(status, body)"""
        result = subprocess.run(
            ["curl", "-s", "-S", "-w", "\n%{http_code}", *arguments,
             f"http://127.0.0.1:{self.server.port}{path}"],
            capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 0, result.stderr)
        body, status = result.stdout.rsplit("\n", 1)
        return int(status), body

    def accepted(self, path, *arguments):
        status, body = self.curl(path, *arguments)
        self.assertEqual(status, 202, body)
        job = self.server.finished(json.loads(body)["id"])
        self.assertEqual(job["state"], "succeeded", job)
        return job

    def test_data_binary_as_the_manual_says(self):
        job = self.accepted("/v1/jobs?max_area=0.05&min_angle=25", "--data-binary", f"@{self.model}")
        self.assertEqual(job["options"]["max_area"], 0.05)

    def test_a_poly_file_with_several_types(self):
        for media_type in ("text/plain", "application/octet-stream", "application/x-poly"):
            self.accepted("/v1/jobs", "--data-binary", f"@{self.poly}", "-H", f"Content-Type: {media_type}")

    def test_a_form(self):
        job = self.accepted("/v1/jobs", "-F", f"model=@{self.model}", "-F", 'options={"fold":2}')
        self.assertEqual(job["options"]["fold"], 2)
        self.assertEqual(job["model"]["name"], "square.json")

    def test_json(self):
        request = self.folder / "request.json"
        request.write_text(json.dumps({"model": square(), "options": {"fold": 4}}))
        self.accepted("/v1/jobs", "-H", "Content-Type: application/json", "-d", f"@{request}")

    def test_a_drawing_of_one_pole(self):
        drawing = pathlib.Path(__file__).parent.parent / "data" / "models" / "motor_pole.dxf"
        for arguments in (["-H", "Content-Type: image/vnd.dxf"], []):
            job = self.accepted("/v1/jobs?sector=4&order=2&chord_error=0.01",
                                "--data-binary", f"@{drawing}", *arguments)
            self.assertEqual(job["model"]["format"], "dxf")
            self.assertEqual(job["statistics"]["symmetry"]["fold"], 4)
            status, body = self.curl(f"/v1/jobs/{job['id']}/cell?format=json")
            self.assertEqual(status, 200)
            self.assertIn("magnets", json.loads(body)["marker_names"].values())

    def test_a_drawing_that_is_cut_off(self):
        cut = self.folder / "cut.dxf"
        cut.write_text("0\nSECTION\n2\nENTITIES\n0\nLINE\n10\n0\n")
        status, body = self.curl("/v1/jobs", "--data-binary", f"@{cut}")
        self.assertEqual(status, 400, body)
        self.assertIn("LINE of line 5", json.loads(body)["detail"])

    def test_chunked(self):
        self.accepted("/v1/jobs", "-T", str(self.model), "-X", "POST",
                      "-H", "Transfer-Encoding: chunked", "-H", "Content-Type: application/octet-stream")

    def test_gzip_as_coding_and_as_file(self):
        packed = self.folder / "square.json.gz"
        packed.write_bytes(gzip.compress(self.model.read_bytes()))
        self.accepted("/v1/jobs", "--data-binary", f"@{packed}", "-H", "Content-Encoding: gzip")
        self.accepted("/v1/jobs", "-F", f"model=@{packed}")

    def test_a_long_body_without_content_type(self):
        long_model = self.folder / "long.json"
        long_model.write_text(" " * 20_000 + json.dumps(square()))
        self.accepted("/v1/jobs", "--data-binary", f"@{long_model}", "-H", "Content-Type:")

    def test_too_much_is_refused_however_it_comes(self):
        big = self.folder / "big.json"
        big.write_bytes(b" " * 3_000_000)
        packed = self.folder / "big.json.gz"
        packed.write_bytes(gzip.compress(big.read_bytes()))
        for arguments in (["--data-binary", f"@{big}"],
                          ["-T", str(big), "-X", "POST", "-H", "Transfer-Encoding: chunked"],
                          ["-F", f"model=@{big}"],
                          ["--data-binary", f"@{packed}", "-H", "Content-Encoding: gzip"],
                          ["--data-binary", f"@{packed}"]):
            status, body = self.curl("/v1/jobs", *arguments)
            self.assertEqual(status, 413, (arguments, body))
            self.assertEqual(json.loads(body)["code"], "body_too_large")

    @without_sanitizer
    def test_a_large_body_takes_no_memory(self):
        server = Server(workers=1).start()
        self.addCleanup(server.remove)
        large = self.folder / "large.json"
        with large.open("wb") as file:
            file.write(json.dumps(square()).encode())
            for _ in range(100):
                file.write(b" " * 1_000_000)
        for arguments in (["-T", str(large), "-X", "POST", "-H", "Content-Type: application/octet-stream",
                           "-H", "Idempotency-Key: large"],
                          ["-F", f"model=@{large}"]):
            result = subprocess.run(["curl", "-s", "-S", *arguments, f"http://127.0.0.1:{server.port}/v1/jobs"],
                                    capture_output=True, text=True, timeout=60)
            job = json.loads(result.stdout)
            self.assertEqual(server.finished(job["id"])["state"], "succeeded", job)
            self.assertEqual(len(server.get(f"/v1/jobs/{job['id']}/model").body), large.stat().st_size)
        status = pathlib.Path(f"/proc/{server.process.pid}/status").read_text()
        peak_kib = int(re.search(r"VmHWM:\s+(\d+)", status)[1])
        self.assertLess(peak_kib, 50 * 1024)

    def test_foreign_types_are_refused(self):
        status, body = self.curl("/v1/jobs", "--data-binary", f"@{self.model}", "-H", "Content-Type: image/png")
        self.assertEqual(status, 415, body)

    def test_an_open_surface_is_the_jobs_error(self):
        stl = self.folder / "part.stl"
        stl.write_text("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                       "vertex 0 1 0\nendloop\nendfacet\nendsolid a\n")
        status, body = self.curl("/v1/jobs?max_volume=10", "--data-binary", f"@{stl}",
                                 "-H", "Content-Type: model/stl")
        self.assertEqual(status, 202, body)
        job = self.server.finished(json.loads(body)["id"])
        self.assertEqual((job["state"], job["error"]["code"]), ("failed", "not_watertight"), job)

    def test_a_post_without_any_body_does_not_hang(self):
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=10) as connection:
            connection.sendall(b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
            answer = b""
            while piece := connection.recv(4096):
                answer += piece
        self.assertTrue(answer.startswith(b"HTTP/1.1 400 "), answer)
        self.assertIn(b"empty_file", answer)

    def test_a_client_that_leaves_in_the_middle_does_no_harm(self):
        for _ in range(50):
            with socket.create_connection(("127.0.0.1", self.server.port), timeout=10) as connection:
                connection.sendall(b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100000\r\n\r\nhalf")
        self.assertEqual(self.server.get("/healthz").status, 200)
        self.accepted("/v1/jobs", "--data-binary", f"@{self.model}")


if __name__ == "__main__":
    unittest.main()
