"""Clients that are slow, idle or many: nobody else waits for them."""

import contextlib
import pathlib
import re
import socket
import threading
import time
import unittest

from symcell_server import Server, square, until

HEAD = "POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/plain\r\nContent-Length: 10000000\r\n\r\n"


class SlowClientsTest(unittest.TestCase):
    def setUp(self):
        self.server = Server(workers=1)
        self.addCleanup(self.server.remove)
        self.server.start()
        self.stack = contextlib.ExitStack()
        self.addCleanup(self.stack.close)

    def connect(self, *options):
        connection = self.stack.enter_context(socket.socket())
        for option in options:
            connection.setsockopt(*option)
        connection.settimeout(10)
        connection.connect(("127.0.0.1", self.server.port))
        return connection

    def memory_kb(self):
        status = pathlib.Path(f"/proc/{self.server.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status)[1])

    def assert_others_are_served(self):
        for path in ("/healthz", "/readyz", "/metrics", "/v1/jobs"):
            began = time.monotonic()
            self.assertEqual(self.server.get(path).status, 200)
            self.assertLess(time.monotonic() - began, 1, path)
        began = time.monotonic()
        job = self.server.post_json("/v1/jobs", {"model": square()}, Prefer="wait=20")
        self.assertEqual(job.status, 201, job.body)
        self.assertLess(time.monotonic() - began, 5)

    def test_slow_uploads_hold_nobody_up(self):
        uploads = [self.connect() for _ in range(40)]
        for upload in uploads:
            upload.sendall(HEAD.encode())
        stop = threading.Event()

        def trickle():  # 2 kB/s each
            while not stop.wait(0.5):
                for upload in uploads:
                    with contextlib.suppress(OSError):
                        upload.sendall(b"x" * 1000)

        thread = threading.Thread(target=trickle)
        thread.start()
        try:
            for _ in range(4):
                self.assert_others_are_served()
                time.sleep(0.5)
        finally:
            stop.set()
            thread.join()

    def test_idle_connections_cost_no_thread_and_little_memory(self):
        before = self.memory_kb()
        for i in range(800):
            connection = self.connect()
            if i % 2:
                connection.sendall(b"GET /healthz HTTP/1.1\r\n")  # and never the rest
        self.assert_others_are_served()
        self.assertLess(self.memory_kb() - before, 32 * 1024)

    def test_busy_connections_do_not_starve_others(self):
        stop = threading.Event()

        def ask():
            with contextlib.suppress(OSError):
                connection = self.connect()
                while not stop.is_set():
                    connection.sendall(b"GET /v1/jobs HTTP/1.1\r\nHost: localhost\r\n\r\n")
                    connection.recv(65536)

        threads = [threading.Thread(target=ask) for _ in range(20)]
        for thread in threads:
            thread.start()
        try:
            for _ in range(3):
                self.assert_others_are_served()
        finally:
            stop.set()
            for thread in threads:
                thread.join()

    def test_a_slow_reader_is_served_and_one_that_reads_nothing_is_cut(self):
        job = self.server.finished(self.server.submit(square(), {"max_area": 4e-6, "fold": 1})["id"])
        request = f"GET /v1/jobs/{job['id']}/full?format=vtu&encoding=ascii HTTP/1.1\r\nHost: localhost\r\n\r\n".encode()
        buffers = (socket.SOL_SOCKET, socket.SO_RCVBUF, 65536)
        slow, silent = self.connect(buffers), self.connect(buffers)
        slow.sendall(request)
        silent.sendall(request)
        in_flight = lambda: int(re.search(r"requests_in_flight (\d+)", self.server.get("/metrics").text())[1]) - 1
        until(lambda: in_flight() == 2, "both are being served")
        began = time.monotonic()
        while time.monotonic() - began < 45:
            self.assertTrue(slow.recv(5000), "the slow reader was cut")  # 20 kB/s
            time.sleep(0.25)
        self.assertEqual(in_flight(), 1)  # the silent one is gone


if __name__ == "__main__":
    unittest.main()
