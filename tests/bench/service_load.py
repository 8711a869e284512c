#!/usr/bin/python3
"""How many small jobs a second the service takes, and how long each of them takes.

Starts the program on a free port in a new folder, and lets clients submit the same planar model, of some 500
triangles, one job after the other over a connection of their own, with `Prefer: wait`. Prints a line of JSON:

  jobs_per_s                of all clients together
  p50_ms, p99_ms            from a request's first byte to its answer's last
  overhead_ms               the same without the time that the job's statistics give for meshing, median
  server_ms, workers_ms     processor time a job, of the server and of its worker processes
  failed                    answers that are no finished job

  tests/bench/service_load.py build/release/symcell --clients 8 --seconds 20
"""

import argparse
import contextlib
import json
import os
import pathlib
import socket
import subprocess
import sys
import tempfile
import threading
import time

TICKS = os.sysconf("SC_CLK_TCK")


def request_of(max_area, plain):
    body = json.dumps({
        "model": {"type": "pslg", "vertices": [[0, 0], [1, 0], [1, 1], [0, 1]],
                  "segments": [[0, 1, 1], [1, 2, 1], [2, 3, 1], [3, 0, 1]]},
        "options": {"max_area": max_area, "fold": 1, "plain": plain}})
    return (f"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
            f"Prefer: wait=30\r\nContent-Length: {len(body)}\r\n\r\n{body}").encode()


def processor_s(pid):
    """Of the process, and of its children: those that are there and those that ended."""
    def times(name):
        fields = pathlib.Path(f"/proc/{name}/stat").read_text().rpartition(")")[2].split()
        return [int(field) / TICKS for field in fields[11:15]]
    user, system, children_user, children_system = times(pid)
    workers = children_user + children_system
    for name in os.listdir("/proc"):
        if not name.isdigit():
            continue
        try:
            text = pathlib.Path(f"/proc/{name}/stat").read_text()
            if int(text.rpartition(")")[2].split()[1]) == pid:
                workers += sum(times(name)[:2])
        except (OSError, ValueError, IndexError):
            continue
    return user + system, workers


class Client(threading.Thread):
    def __init__(self, port, request, end):
        super().__init__(daemon=True)
        self.port, self.request, self.end = port, request, end
        self.answers = []  # (seconds, seconds of meshing)
        self.failed = 0

    def run(self):
        with socket.create_connection(("127.0.0.1", self.port)) as connection:
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            reader = connection.makefile("rb")
            served = 0
            while time.monotonic() < self.end():
                begin = time.perf_counter()
                connection.sendall(self.request)
                status, closes, body = self.read_answer(reader)
                took = time.perf_counter() - begin
                served += 1
                if status != 201:
                    self.failed += 1
                else:
                    self.answers.append((took, body))
                if closes:
                    break
        if closes and time.monotonic() < self.end():
            self.run()

    @staticmethod
    def read_answer(reader):
        status = int(reader.readline().split()[1])
        length, closes = 0, False
        while (line := reader.readline().strip()):
            name, _, value = line.partition(b":")
            if name.lower() == b"content-length":
                length = int(value)
            if name.lower() == b"connection":
                closes = value.strip().lower() == b"close"
        return status, closes, reader.read(length)


@contextlib.contextmanager
def kept_or_temporary(folder):
    """A new folder in the one that is named, and kept: a file system that has just freed many files takes long
    to make others. Else one that goes."""
    if folder:
        yield tempfile.mkdtemp(dir=folder)
        return
    with tempfile.TemporaryDirectory() as temporary:
        yield temporary


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(len(values) * share))]


def measure(arguments, port, pid):
    end = [time.monotonic() + arguments.warm_up]
    request = request_of(arguments.max_area, arguments.plain)

    def run_clients(seconds):
        end[0] = time.monotonic() + seconds
        clients = [Client(port, request, lambda: end[0]) for _ in range(arguments.clients)]
        for client in clients:
            client.start()
        for client in clients:
            client.join()
        return clients

    run_clients(arguments.warm_up)
    server_before, workers_before = processor_s(pid)
    begin = time.monotonic()
    clients = run_clients(arguments.seconds)
    took = time.monotonic() - begin
    server_after, workers_after = processor_s(pid)
    answers = [answer for client in clients for answer in client.answers]
    jobs = max(1, len(answers))
    meshing = [json.loads(body)["statistics"]["timings_ms"]["total"] for _, body in answers]
    elements = json.loads(answers[0][1])["statistics"]["cell"]["elements"] if answers else 0
    return {
        "clients": arguments.clients,
        "triangles": elements,
        "jobs": len(answers),
        "jobs_per_s": round(len(answers) / took, 1),
        "p50_ms": round(percentile([s for s, _ in answers], 0.5) * 1e3, 1),
        "p99_ms": round(percentile([s for s, _ in answers], 0.99) * 1e3, 1),
        "meshing_ms": round(percentile(meshing, 0.5), 2),
        "overhead_ms": round(percentile([s * 1e3 - m for (s, _), m in zip(answers, meshing)], 0.5), 1),
        "server_ms": round((server_after - server_before) / jobs * 1e3, 2),
        "workers_ms": round((workers_after - workers_before) / jobs * 1e3, 2),
        "failed": sum(client.failed for client in clients),
        "load": os.getloadavg()[0],
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--clients", type=int, default=8)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--warm-up", type=float, default=2)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--max-area", type=float, default=0.0024, help="of the model, a unit square")
    parser.add_argument("--plain", action="store_true", help="refinement alone: the service, not the mesher")
    parser.add_argument("--folder", help="where the data directory is made, and kept")
    parser.add_argument("--flag", action="append", default=[], help="further flags of the server")
    parser.add_argument("--prefix", default="", help="a command to run the server under")
    arguments = parser.parse_args()
    with kept_or_temporary(arguments.folder) as folder:
        port_file = pathlib.Path(folder, "port")
        with open(pathlib.Path(folder, "log"), "wb") as log:
            server = subprocess.Popen(
                [*arguments.prefix.split(), arguments.program, "serve", "--port", "0", "--port-file",
                 str(port_file), "--data-dir", str(pathlib.Path(folder, "data")), "--workers",
                 str(arguments.workers), *arguments.flag], stdout=log, stderr=log)
        try:
            while not port_file.exists():
                if server.poll() is not None:
                    sys.exit(pathlib.Path(folder, "log").read_text())
                time.sleep(0.02)
            print(json.dumps(measure(arguments, int(port_file.read_text()), server.pid)))
        finally:
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
