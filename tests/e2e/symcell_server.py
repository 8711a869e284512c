"""Starts the real program on a free port in a fresh data directory, and talks to it.

The program's path is in SYMCELL_BINARY. Nothing sleeps for a fixed time: `until` looks again and
again up to a deadline.
"""

import contextlib
import gzip
import http.client
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORPUS = ROOT.parent / "shared" / "corpus"
PATIENCE_S = 60


# Sanitizers need more memory than any limit allows and catch crashes themselves.
without_sanitizer = unittest.skipIf(os.environ.get("SYMCELL_SANITIZE"), "limits are off under a sanitizer")


def binary():
    path = os.environ.get("SYMCELL_BINARY")
    if not path or not os.access(path, os.X_OK):
        raise RuntimeError("set SYMCELL_BINARY to the symcell program")
    return path


def until(holds, what, patience_s=PATIENCE_S):
    """Returns the first true value of holds(); fails after the deadline."""
    deadline = time.monotonic() + patience_s
    while True:
        value = holds()
        if value:
            return value
        if time.monotonic() > deadline:
            raise AssertionError(f"still not so after {patience_s} s: {what}")
        time.sleep(0.02)


class Answer:
    def __init__(self, status, headers, body):
        self.status = status
        self.headers = headers
        self.body = body

    def json(self):
        return json.loads(self.body)

    def text(self):
        body = gzip.decompress(self.body) if self.headers.get("Content-Encoding") == "gzip" else self.body
        return body.decode()


class Server:
    """A running `symcell serve`. Flags are given as port=0 -> --port 0."""

    def __init__(self, data_dir=None, **flags):
        self.data_dir = pathlib.Path(data_dir or tempfile.mkdtemp(prefix="symcell-e2e-"))
        self.flags = {"workers": 2, "log_format": "json", "grace": 0,
                      "max_elements": 500_000_000, **flags}
        self.state_dir = self.data_dir / "state"
        self.process = None
        self.port = None

    def start(self, environment=None):
        port_file = self.data_dir / "port"
        with contextlib.suppress(FileNotFoundError):
            port_file.unlink()
        command = [binary(), "serve", "--port", "0", "--port-file", str(port_file),
                   "--data-dir", str(self.state_dir)]
        for name, value in self.flags.items():
            command += ["--" + name.replace("_", "-"), str(value)]
        self.log = open(self.data_dir / "log", "ab")
        self.process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=self.log,
            env={**os.environ, **(environment or {})})

        def listening():
            if self.process.poll() is not None:
                self.log.close()
                raise AssertionError("the server ended:\n" + self.log_text())
            return port_file.exists()

        until(listening, "the port file is written")
        self.port = int(port_file.read_text())
        return self

    def log_text(self):
        return (self.data_dir / "log").read_text()

    def log_events(self):
        """What was logged, but for a line that is being written."""
        whole, _, _ = self.log_text().rpartition("\n")
        return [json.loads(line) for line in whole.splitlines()]

    def stop(self):
        """SIGTERM; returns the exit code."""
        self.process.send_signal(signal.SIGTERM)
        code = self.process.wait(timeout=PATIENCE_S)
        self.log.close()
        return code

    def kill(self):
        self.process.kill()
        self.process.wait(timeout=PATIENCE_S)
        self.log.close()

    def remove(self):
        if self.process and self.process.poll() is None:
            self.kill()
        shutil.rmtree(self.data_dir, ignore_errors=True)

    def request(self, method, path, body=None, headers=None, timeout=PATIENCE_S):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=timeout)
        try:
            connection.request(method, path, body=body, headers=headers or {})
            answer = connection.getresponse()
            return Answer(answer.status, answer.headers, answer.read())
        finally:
            connection.close()

    def get(self, path, **headers):
        return self.request("GET", path, headers={k.replace("_", "-"): v for k, v in headers.items()})

    def post_json(self, path, document, **headers):
        return self.request("POST", path, json.dumps(document), {
            "Content-Type": "application/json",
            **{k.replace("_", "-"): v for k, v in headers.items()}})

    def submit(self, model, options=None, **headers):
        """Posts a job; returns its document."""
        answer = self.post_json("/v1/jobs", {"model": model, "options": options or {}}, **headers)
        assert answer.status in (201, 202), (answer.status, answer.body)
        return answer.json()

    def job(self, job_id):
        answer = self.get(f"/v1/jobs/{job_id}")
        assert answer.status == 200, (answer.status, answer.body)
        return answer.json()

    def finished(self, job_id, patience_s=PATIENCE_S):
        """Waits for the job's end; returns its document."""
        def over():
            document = self.job(job_id)
            return document if document["state"] not in ("queued", "running") else None
        return until(over, f"job {job_id} is finished", patience_s)

    def reaches(self, job_id, state):
        return until(lambda: self.job(job_id)["state"] == state, f"job {job_id} is {state}")


def square():
    return {"type": "pslg", "vertices": [[0, 0], [1, 0], [1, 1], [0, 1]],
            "segments": [[0, 1, 1], [1, 2, 1], [2, 3, 1], [3, 0, 1]]}


def box():
    """A box with a square base: 4-fold about the z axis."""
    return {"type": "plc",
            "vertices": [[x, y, z] for z in (0, 1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))],
            "facets": [{"polygons": [[0, 3, 2, 1]], "marker": 1}, {"polygons": [[4, 5, 6, 7]], "marker": 2},
                       *({"polygons": [[i, (i + 1) % 4, (i + 1) % 4 + 4, i + 4]], "marker": 3}
                         for i in range(4))]}


def long_options():
    """Options with which the square keeps a worker busy until it is stopped."""
    return {"max_area": 1e-8, "max_elements": 500_000_000, "fold": 1}


def corpus_entries():
    """Manifest entries of inputs that must be refused; None where there is no corpus."""
    manifest = CORPUS / "manifest.json"
    if not manifest.exists():
        return None
    entries = json.loads(manifest.read_text())["files"]
    return [entry for entry in entries if entry["file"].startswith("bad/")]
