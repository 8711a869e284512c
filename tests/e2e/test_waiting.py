"""A thousand callers that wait for their jobs and two hundred event streams at once: they take no thread, and
nobody else notices."""

import json
import pathlib
import re
import resource
import selectors
import socket
import time
import unittest

from symcell_server import Server, long_options, square, until, without_sanitizer

WAITING, STREAMS = 1000, 200


def status_of(pid, name):
    return int(re.search(rf"{name}:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])


class WaitingTest(unittest.TestCase):
    def setUp(self):
        soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
        if hard < 2 * (WAITING + STREAMS):
            self.skipTest("too few descriptors")
        resource.setrlimit(resource.RLIMIT_NOFILE, (hard, hard))
        self.addCleanup(resource.setrlimit, resource.RLIMIT_NOFILE, (soft, hard))
        # One address has half of the places at most: more than are needed here.
        self.server = Server(workers=1, queue_limit=5000, max_connections_per_client=4096, log_level="warning")
        self.addCleanup(self.server.remove)
        self.connections = []
        self.addCleanup(lambda: [connection.close() for connection in self.connections])

    def connect(self, request):
        connection = socket.create_connection(("127.0.0.1", self.server.port))
        connection.sendall(request)
        connection.setblocking(False)
        self.connections.append(connection)
        return connection

    def submission(self, options, wait):
        body = json.dumps({"model": square(), "options": options})
        return (f"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
                f"Prefer: wait={wait}\r\nContent-Length: {len(body)}\r\n\r\n{body}").encode()

    def open_streams(self):
        text = self.server.get("/metrics").text()
        return int(re.search(r"symcell_streams_open (\d+)", text)[1])

    def answers(self, connections, patience_s):
        """What came from each until it had an answer of its length, or its end."""
        texts = {connection: b"" for connection in connections}
        left = set(connections)
        deadline = time.monotonic() + patience_s
        with selectors.DefaultSelector() as selector:
            for connection in connections:
                selector.register(connection, selectors.EVENT_READ)
            while left and time.monotonic() < deadline:
                for key, _ in selector.select(0.5):
                    connection = key.fileobj
                    piece = connection.recv(65536)
                    texts[connection] += piece
                    head, _, body = texts[connection].partition(b"\r\n\r\n")
                    length = re.search(rb"Content-Length: (\d+)", head)
                    if not piece or (length and len(body) >= int(length[1])) or body.endswith(b"0\r\n\r\n"):
                        left.discard(connection)
                        selector.unregister(connection)
        self.assertFalse(left, f"{len(left)} without an answer")
        return texts

    def slowest_probe(self, count):
        times = []
        for _ in range(count):
            begin = time.monotonic()
            self.assertEqual(self.server.get("/healthz").status, 200)
            times.append(time.monotonic() - begin)
        return sorted(times)[int(0.95 * (count - 1))]

    @without_sanitizer
    def test_waiting_callers_and_streams_take_no_thread(self):
        self.server.start()
        blocker = self.server.submit(square(), long_options())["id"]
        self.server.reaches(blocker, "running")
        pid = self.server.process.pid
        before_kb, threads_before = status_of(pid, "VmRSS"), status_of(pid, "Threads")
        waiting = [self.connect(self.submission({"max_area": 0.1}, 60)) for _ in range(WAITING)]
        streams = [self.connect(f"GET /v1/jobs/{blocker}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
                   for _ in range(STREAMS)]
        until(lambda: self.open_streams() == WAITING + STREAMS, "all wait")
        slowest = self.slowest_probe(100)
        grown_kb = status_of(pid, "VmRSS") - before_kb
        threads = status_of(pid, "Threads") - threads_before
        print(f"{WAITING} waiting, {STREAMS} streams: /healthz {slowest * 1e3:.1f} ms, "
              f"+{grown_kb / 1024:.1f} MiB, +{threads} threads", flush=True)
        self.assertLess(slowest, 0.25)  # 0.05 on a machine with nothing else to do
        self.assertLess(grown_kb, 64 * 1024)
        self.assertLess(threads, 100)
        self.server.request("POST", f"/v1/jobs/{blocker}/cancel")
        for text in self.answers(streams, 30).values():
            self.assertIn(b"event: end", text)
        for text in self.answers(waiting, 60).values():
            self.assertTrue(text.startswith(b"HTTP/1.1 201 "), text[:200])
            self.assertIn(b'"state": "succeeded"', text)
        until(lambda: self.open_streams() == 0, "no place is taken any more")

    def test_a_wait_ends_with_its_time_and_the_connection_goes_on(self):
        self.server.start()
        blocker = self.server.submit(square(), long_options())["id"]
        self.server.reaches(blocker, "running")
        connection = self.connect(self.submission({}, 1) + b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")
        time.sleep(0.3)
        texts = self.answers([connection], 10)
        text = texts[connection]
        self.assertTrue(text.startswith(b"HTTP/1.1 202 "), text[:100])
        self.assertIn(b"Preference-Applied: wait=1", text)
        self.assertIn(b"Location: /v1/jobs/", text)
        self.assertEqual(text.count(b"X-Request-Id"), 1 + text.count(b"HTTP/1.1 200"))
        until(lambda: b"HTTP/1.1 200" in text or self.more_of(connection, texts), "the next request is answered")

    def more_of(self, connection, texts):
        try:
            texts[connection] += connection.recv(65536)
        except BlockingIOError:
            return False
        return b"HTTP/1.1 200" in texts[connection]

    def test_a_server_that_stops_answers_those_who_wait(self):
        self.server.start()
        blocker = self.server.submit(square(), long_options())["id"]
        self.server.reaches(blocker, "running")
        waiting = self.connect(self.submission({}, 60))
        stream = self.connect(f"GET /v1/jobs/{blocker}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        until(lambda: self.open_streams() == 2, "both wait")
        self.server.process.terminate()
        texts = self.answers([waiting, stream], 20)
        self.assertTrue(texts[waiting].startswith(b"HTTP/1.1 202 "), texts[waiting][:100])
        self.assertTrue(texts[stream].endswith(b"0\r\n\r\n"), texts[stream][-100:])
        self.assertEqual(self.server.process.wait(timeout=30), 0)

    def test_a_client_that_leaves_frees_its_place(self):
        self.server.start()
        blocker = self.server.submit(square(), long_options())["id"]
        self.server.reaches(blocker, "running")
        stream = self.connect(f"GET /v1/jobs/{blocker}/events HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
        until(lambda: self.open_streams() == 1, "it waits")
        stream.close()
        until(lambda: self.open_streams() == 0, "its place is free", 20)


if __name__ == "__main__":
    unittest.main()
