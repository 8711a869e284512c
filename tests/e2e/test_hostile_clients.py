"""What clients send that mean harm or know no better, one after the other to one server: each gets a 4xx or 5xx
that it may have, or the end of its connection, in time; and the server goes on as if nothing had been."""

import contextlib
import gzip
import itertools
import json
import re
import socket
import time
import unittest
import zlib

from symcell_server import Server, square, until

PATIENCE_S = 5  # for what is refused at once
HOST = b"Host: localhost\r\n"
BODY = json.dumps({"model": square()}).encode()


def post(headers, body=b"", path=b"/v1/jobs", version=b"HTTP/1.1"):
    return b"POST " + path + b" " + version + b"\r\n" + HOST + headers + b"\r\n" + body


def get(path, headers=b"", method=b"GET", version=b"HTTP/1.1"):
    return method + b" " + path + b" " + version + b"\r\n" + HOST + headers + b"\r\n"


def plain(body=BODY, headers=b"Content-Type: application/json\r\n"):
    return post(headers + b"Content-Length: %d\r\n" % len(body), body)


def chunked(chunks, headers=b"Content-Type: application/json\r\n"):
    return post(headers + b"Transfer-Encoding: chunked\r\n", chunks)


REFUSED = "refused"  # 4xx or 5xx, or the end of the connection without an answer
ANY = "any"  # an answer or an end: the next client must find nothing changed


def bad_heads():
    yield "no request", b"\r\n\r\n\r\n", ANY
    yield "one word", b"GET\r\n\r\n", REFUSED
    yield "two words", b"GET /\r\n\r\n", REFUSED
    yield "version 0.9", b"GET / HTTP/0.9\r\n" + HOST + b"\r\n", REFUSED
    yield "version 2.0", b"GET / HTTP/2.0\r\n" + HOST + b"\r\n", REFUSED
    yield "version abc", b"GET / HTTP/a.b\r\n" + HOST + b"\r\n", REFUSED
    yield "preface of HTTP/2", b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", REFUSED
    yield "TLS hello", bytes.fromhex("16030100c8010000c40303") + bytes(200), REFUSED
    yield "binary", bytes(range(256)) * 4 + b"\r\n\r\n", REFUSED
    yield "no Host", b"GET /healthz HTTP/1.1\r\n\r\n", REFUSED
    yield "two Hosts", get(b"/healthz", HOST), REFUSED
    yield "another Host", b"GET /v1/jobs HTTP/1.1\r\nHost: evil.example\r\n\r\n", REFUSED
    yield "Host with a path", b"GET /v1/jobs HTTP/1.1\r\nHost: localhost/evil\r\n\r\n", REFUSED
    yield "space before the colon", get(b"/healthz", b"X-A : b\r\n"), REFUSED
    yield "space before a length's colon", post(b"Content-Length : 5\r\n", b"hello"), REFUSED
    yield "folded line", get(b"/healthz", b"X-A: b\r\n c\r\n"), REFUSED
    yield "line without colon", get(b"/healthz", b"X-A\r\n"), REFUSED
    yield "name of nothing", get(b"/healthz", b": b\r\n"), REFUSED
    yield "NUL in a name", get(b"/healthz", b"X-\0A: b\r\n"), REFUSED
    yield "NUL in a value", get(b"/healthz", b"X-A: b\0c\r\n"), REFUSED
    yield "CR in a value", get(b"/healthz", b"X-A: b\rc\r\n"), REFUSED
    yield "bare line feeds", b"GET /healthz HTTP/1.1\nHost: localhost\n\n", ANY
    yield "a long line", get(b"/" + b"a" * 70_000), REFUSED
    yield "a long header", get(b"/healthz", b"X-A: " + b"b" * 70_000 + b"\r\n"), REFUSED
    yield "many headers", get(b"/healthz", b"".join(b"X-%d: b\r\n" % i for i in range(5000))), REFUSED
    yield "method of symbols", get(b"/", method=b"G@T"), REFUSED
    yield "long method", get(b"/", method=b"A" * 5000), REFUSED
    yield "CONNECT", b"CONNECT evil.example:443 HTTP/1.1\r\n" + HOST + b"\r\n", REFUSED
    yield "TRACE", get(b"/", method=b"TRACE"), REFUSED
    yield "absolute form", get(b"http://evil.example/v1/jobs"), ANY
    yield "asterisk", get(b"*"), REFUSED
    yield "Range of nonsense", get(b"/openapi.yaml", b"Range: bytes=9-1,a-b,--\r\n"), ANY
    yield "thousand ranges", get(b"/openapi.yaml", b"Range: bytes=" + b",".join([b"0-"] * 1000) + b"\r\n"), ANY
    yield "range beyond 64 bits", get(b"/openapi.yaml", b"Range: bytes=99999999999999999999-\r\n"), ANY
    yield "units of eggs", get(b"/openapi.yaml", b"Range: eggs=0-1\r\n"), ANY
    yield "odd Accept-Encoding", get(b"/openapi.yaml", b"Accept-Encoding: " + b"gzip;q=0.0000001," * 500 + b"\r\n"), ANY
    yield "long If-None-Match", get(b"/v1/jobs/x/cell", b"If-None-Match: " + b'"a",' * 5000 + b"\r\n"), REFUSED
    yield "Upgrade", get(b"/healthz", b"Connection: Upgrade\r\nUpgrade: websocket\r\n"), ANY
    yield "bad key", get(b"/v1/jobs", b"Authorization: Bearer " + b"x" * 4000 + b"\r\n"), REFUSED
    yield "basic auth", get(b"/v1/jobs", b"Authorization: Basic eDp4\r\n"), REFUSED
    yield "odd traceparent", get(b"/healthz", b"traceparent: 00-" + b"z" * 300 + b"\r\n"), ANY
    yield "odd request id", get(b"/healthz", b"X-Request-Id: \"><script>\r\n"), ANY
    yield "expectation of mercy", post(b"Expect: mercy\r\nContent-Length: 1\r\n", b"x"), REFUSED


def bad_lengths():
    for length in (b"-1", b"+5", b"5,5", b"5, 6", b"0x5", b"5.0", b"abc", b"", b"99999999999999999999999",
                   b"18446744073709551616", b"1 2", b"\x00"):
        yield f"length {length!r}", post(b"Content-Length: " + length + b"\r\n", b"hello"), REFUSED
    yield "two lengths", post(b"Content-Length: 5\r\nContent-Length: 6\r\n", b"hello!"), REFUSED
    yield "length and coding", post(b"Content-Length: 5\r\nTransfer-Encoding: chunked\r\n", b"0\r\n\r\n"), REFUSED
    for coding in (b"identity", b"gzip, chunked", b"chunked, chunked", b"chunked, gzip", b"xchunked", b"chunked\x0b"):
        yield f"coding {coding!r}", post(b"Transfer-Encoding: " + coding + b"\r\n", b"0\r\n\r\n"), REFUSED
    yield "coding of HTTP/1.0", post(b"Transfer-Encoding: chunked\r\n", b"0\r\n\r\n", version=b"HTTP/1.0"), REFUSED
    yield "half a terabyte", post(b"Content-Length: 549755813888\r\n"), REFUSED


def bad_chunks():
    for size in (b"-1", b"+1", b"0x1", b"g", b"", b" 1", b"1 ", b"FFFFFFFFFFFFFFFFF", b"7fffffffffffffff",
                 b"1" * 100, b"1;" + b"x" * 20_000):
        yield f"chunk {size[:20]!r}", chunked(size + b"\r\nA\r\n0\r\n\r\n"), REFUSED
    yield "chunk without its end", chunked(b"1\r\nAB\r\n0\r\n\r\n"), REFUSED
    yield "chunk with a bare feed", chunked(b"1\nA\n0\n\n"), REFUSED
    yield "long trailer", chunked(b"0\r\n" + b"X: " + b"y" * 200_000 + b"\r\n\r\n"), REFUSED


def bad_bodies():
    for name, body in (("empty", b""), ("null", b"null"), ("a number", b"1e999"), ("not JSON", b"{"), ("deep", b"[" * 100_000),
                       ("deep in model", b'{"model":' + b'{"a":' * 50_000), ("not UTF-8", b'{"model":"\xff\xfe"}'),
                       ("a lone surrogate", b'{"model":"\\ud800"}'), ("doubled", b'{"model":{},"model":{}}'),
                       ("unknown member", b'{"model":{},"evil":1}'),
                       ("NaN", b'{"model":{"type":"pslg","vertices":[[NaN,0]],"segments":[]}}'),
                       ("huge exponent", b'{"model":{"type":"pslg","vertices":[[1e999,0]],"segments":[]}}'),
                       ("many digits", b'{"model":{"type":"pslg","vertices":[[' + b"1" * 50_000 + b',0]],"segments":[]}}'),
                       ("huge index", b'{"model":{"type":"pslg","vertices":[[0,0],[1,0],[0,1]],"segments":[[4294967296,0]]}}'),
                       ("options bomb", b'{"model":{},"options":' + b'{"a":' * 5000 + b"1" + b"}" * 5000 + b"}"),
                       ("option of NaN", json.dumps({"model": square(), "options": {"max_area": "NaN"}}).encode()),
                       ("negative area", json.dumps({"model": square(), "options": {"max_area": -1}}).encode()),
                       ("huge limits", json.dumps({"model": square(), "options": {"max_elements": 10**30}}).encode())):
        yield f"body: {name}", plain(body), REFUSED
    for kind in (b"application/xml", b"image/png", b"multipart/form-data", b"multipart/form-data; boundary=",
                 b"multipart/form-data; boundary=" + b"b" * 5000, b"application/json; charset=" + b"x" * 5000):
        yield f"type {kind[:40]!r}", plain(b"<x/>", b"Content-Type: " + kind + b"\r\n"), REFUSED
    form = b"Content-Type: multipart/form-data; boundary=b\r\n"
    for name, body in (("no parts", b"--b--\r\n"), ("no end", b"--b\r\nContent-Disposition: form-data; name=\"model\"\r\n\r\nx"),
                       ("unknown part", b"--b\r\nContent-Disposition: form-data; name=\"evil\"\r\n\r\nx\r\n--b--\r\n"),
                       ("no name", b"--b\r\nContent-Disposition: form-data\r\n\r\nx\r\n--b--\r\n"),
                       ("long header", b"--b\r\nContent-Disposition: form-data; name=\"" + b"x" * 100_000 + b"\"\r\n\r\nx\r\n--b--\r\n"),
                       ("many parts", b"--b\r\nContent-Disposition: form-data; name=\"options\"\r\n\r\n{}\r\n" * 1000 + b"--b--\r\n")):
        yield f"form: {name}", plain(body, form), REFUSED
    zipped = b"Content-Type: application/json\r\nContent-Encoding: gzip\r\n"
    for name, body in (("not gzip", b"hello"), ("cut off", gzip.compress(BODY)[:-9]), ("empty", b""),
                       ("damaged", gzip.compress(BODY)[:20] + b"\xff" * 20), ("bomb", gzip.compress(bytes(200 << 20), 9)),
                       ("bomb in a bomb", gzip.compress(gzip.compress(bytes(50 << 20), 9), 9)),
                       ("zlib", zlib.compress(BODY))):
        yield f"gzip: {name}", plain(body, zipped), REFUSED
    for coding in (b"br", b"deflate", b"gzip, gzip", b"zstd"):
        yield f"coding {coding!r}", plain(BODY, b"Content-Type: application/json\r\nContent-Encoding: " + coding + b"\r\n"), REFUSED
    yield "gzip file that is a bomb", plain(gzip.compress(bytes(200 << 20), 9), b"Content-Type: model/stl\r\n"), REFUSED
    for name, headers in (("key of control characters", b"Idempotency-Key: a\x01b\r\n"), ("long key", b"Idempotency-Key: " + b"k" * 300 + b"\r\n"),
                          ("webhook to a file", b"Webhook-Url: file:///etc/passwd\r\n"),
                          ("webhook to metadata", b"Webhook-Url: http://169.254.169.254/\r\n"),
                          ("page of another site", b"Origin: http://evil.example\r\n")):
        yield name, plain(BODY, b"Content-Type: application/json\r\n" + headers), REFUSED


def bad_paths():
    for path in (b"/../etc/passwd", b"/..%2f..%2fetc/passwd", b"/%2e%2e/%2e%2e/etc/passwd", b"/v1/jobs/../../etc/passwd",
                 b"/v1/jobs/..%00", b"/v1/jobs/%00", b"/v1/jobs/" + b"a" * 30_000, b"/v1/jobs/01//cell", b"//", b"/%",
                 b"/%zz", b"/v1/jobs/%ff%fe", b"/v1/jobs/'%20OR%201=1--", b"/v1/jobs/..;/keys", b"/v1/jobs/{id}",
                 b"/v1/jobs/01m8p42qfjwkwxrqhcbcvyghre/model/../../../jobs.sqlite", b"/symcell-data", b"/jobs.sqlite",
                 b"/.git/config", b"/v1/jobs/%2e%2e%2fjobs.sqlite/model", b"\\", b"/v1/jobs/\xc0\xae\xc0\xae"):
        yield f"path {path[:40]!r}", get(path), REFUSED
    for query in (b"limit=-1", b"limit=99999999999999999999", b"limit=1e3", b"cursor=abc", b"state=%00", b"state=evil"):
        yield f"query {query!r}", get(b"/v1/jobs?" + query), REFUSED
    yield "thousands of parameters", get(b"/v1/jobs?" + b"&".join(b"a%d=1" % i for i in range(5000))), ANY


class HostileClientsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(workers=1, max_body_bytes=64 << 20, log_level="warning")
        cls.addClassCleanup(cls.server.remove)
        cls.server.start()

    def talk(self, request, patience_s=PATIENCE_S, closes=False):
        """What comes back until the connection ends or an answer is whole; None: neither in time."""
        with socket.create_connection(("127.0.0.1", self.server.port), timeout=patience_s) as connection:
            with contextlib.suppress(OSError):
                connection.sendall(request)
            text = b""
            deadline = time.monotonic() + patience_s
            while time.monotonic() < deadline:
                try:
                    piece = connection.recv(65536)
                except TimeoutError:
                    return None
                except OSError:
                    return text
                if not piece:
                    return text
                text += piece
                head, found, body = text.partition(b"\r\n\r\n")
                length = re.search(rb"Content-Length: (\d+)", head)
                if not closes and found and length and len(body) >= int(length[1]):
                    return text
        return None

    def check(self, cases):
        count = 0
        for name, request, expected in cases:
            count += 1
            with self.subTest(name):
                text = self.talk(request)
                if text is None and request.startswith(b"\r\n"):
                    continue  # it may wait for a request still
                self.assertIsNotNone(text, "no answer and no end")
                if expected == REFUSED and text:
                    self.assertRegex(text[:13], rb"^HTTP/1\.1 [45]\d\d")
                    self.assertNotRegex(text[:13], rb"^HTTP/1\.1 500", text[-300:])
                self.assertNotIn(b"root:", text)
                self.assertEqual(self.server.get("/healthz").status, 200)
        print(f"{count} checks", flush=True)

    def tearDown(self):
        self.assertIsNone(self.server.process.poll())
        job = self.server.finished(self.server.submit(square())["id"])
        self.assertEqual(job["state"], "succeeded")

    def test_heads(self):
        self.check(bad_heads())

    def test_lengths(self):
        self.check(bad_lengths())

    def test_chunks(self):
        self.check(bad_chunks())

    def test_bodies(self):
        self.check(bad_bodies())

    def test_paths(self):
        self.check(bad_paths())

    def test_an_answer_is_not_taken_apart_by_what_follows(self):
        # A second request hidden in the first one's body is a body.
        hidden = b"GET /v1/keys HTTP/1.1\r\nHost: localhost\r\n\r\n"
        text = self.talk(plain(hidden) + get(b"/healthz", b"Connection: close\r\n"), closes=True)
        self.assertEqual(text.count(b"HTTP/1.1 "), 2, text)

    def test_slow_and_silent_clients_hold_nobody_up(self):
        connections = []
        self.addCleanup(lambda: [connection.close() for connection in connections])
        head = post(b"Content-Type: application/json\r\nContent-Length: 1000000\r\n")
        for request in itertools.islice(itertools.cycle([b"", b"GET", head, head + b"{", chunked(b"5\r\nab"), get(b"/openapi.yaml")[:-2]]), 300):
            connection = socket.create_connection(("127.0.0.1", self.server.port))
            connection.sendall(request)
            connections.append(connection)
        for connection in connections[::3]:
            connection.shutdown(socket.SHUT_WR)
        for _ in range(20):
            begin = time.monotonic()
            self.assertEqual(self.server.get("/healthz").status, 200)
            self.assertLess(time.monotonic() - begin, 1)
        job = self.server.finished(self.server.submit(square())["id"])
        self.assertEqual(job["state"], "succeeded")

    def test_clients_that_never_read_hold_nobody_up(self):
        connections = []
        self.addCleanup(lambda: [connection.close() for connection in connections])
        for _ in range(50):
            connection = socket.socket()
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
            connection.connect(("127.0.0.1", self.server.port))
            connection.settimeout(0.5)
            with contextlib.suppress(OSError):
                connection.sendall(get(b"/openapi.yaml") * 50)
            connections.append(connection)
        begin = time.monotonic()
        self.assertEqual(self.server.get("/healthz").status, 200)
        self.assertLess(time.monotonic() - begin, 1)
        for connection in connections:
            connection.close()
        until(lambda: self.server.get("/v1/jobs").status == 200, "others are served", 30)


if __name__ == "__main__":
    unittest.main()
