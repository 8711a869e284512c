"""Messages about finished jobs: signed, tried again, and sent nowhere they should not go."""

import base64
import hashlib
import hmac
import http.server
import json
import tempfile
import threading
import unittest

from symcell_server import Server, square, until

SECRET = b"0123456789abcdef0123456789abcdef"
TRACE = "00-0123456789abcdef0123456789abcdef-0123456789abcdef-01"


class Receiver(http.server.ThreadingHTTPServer):
    """Answers with the statuses given, then with 204."""

    def __init__(self, *statuses):
        self.statuses = list(statuses)
        self.got = []

        class Handler(http.server.BaseHTTPRequestHandler):
            def do_POST(self):
                body = self.rfile.read(int(self.headers["Content-Length"]))
                self.server.got.append((self.path, dict(self.headers), body))
                status = self.server.statuses.pop(0) if self.server.statuses else 204
                self.send_response(status)
                if status == 302:
                    self.send_header("Location", "/elsewhere")
                self.end_headers()

            def log_message(self, *_):
                pass

        super().__init__(("127.0.0.1", 0), Handler)
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def address(self, path="/hook"):
        return f"http://127.0.0.1:{self.server_address[1]}{path}"


class WebhooksTest(unittest.TestCase):
    def start(self, **flags):
        secret = tempfile.NamedTemporaryFile("w", suffix=".secret")
        self.addCleanup(secret.close)
        secret.write("whsec_" + base64.b64encode(SECRET).decode() + "\n")
        secret.flush()
        server = Server(webhook_secret_file=secret.name, webhook_host="127.0.0.1", **flags)
        self.addCleanup(server.remove)
        return server

    def receiver(self, *statuses):
        receiver = Receiver(*statuses)
        self.addCleanup(receiver.server_close)
        self.addCleanup(receiver.shutdown)
        return receiver

    def test_a_message_is_signed_and_carries_the_trace(self):
        server = self.start().start({"SYMCELL_WEBHOOK_PRIVATE": "true"})
        receiver = self.receiver()
        job = server.submit(square(), Webhook_Url=receiver.address("/hook?x=1"), traceparent=TRACE)
        until(lambda: receiver.got, "a message")
        path, headers, body = receiver.got[0]
        headers = {name.lower(): value for name, value in headers.items()}
        self.assertEqual(path, "/hook?x=1")
        message = json.loads(body)
        self.assertEqual(message["type"], "job.finished")
        self.assertEqual((message["data"]["id"], message["data"]["state"]), (job["id"], "succeeded"))
        signed = ".".join([headers["webhook-id"], headers["webhook-timestamp"], body.decode()]).encode()
        wanted = base64.b64encode(hmac.new(SECRET, signed, hashlib.sha256).digest()).decode()
        self.assertEqual(headers["webhook-signature"], "v1," + wanted)
        self.assertEqual(headers["traceparent"], TRACE)
        # The message is noted once its answer has been read, which is after the receiver has it.
        until(lambda: '"webhook"' in server.log_text(), "the message is noted")
        events = server.log_events()
        trace = TRACE.split("-")[1]
        for name in ("job_accepted", "job_started", "job_finished", "webhook"):
            self.assertEqual([e["trace"] for e in events if e["event"] == name], [trace], name)

    def test_what_fails_is_tried_again_over_a_death_of_the_server(self):
        server = self.start().start({"SYMCELL_WEBHOOK_PRIVATE": "true"})
        receiver = self.receiver(500)
        server.submit(square(), Webhook_Url=receiver.address())
        until(lambda: receiver.got, "a message")
        until(lambda: '"failed"' in server.log_text(), "the failure is noted")
        server.kill()
        server.start({"SYMCELL_WEBHOOK_PRIVATE": "true"})
        until(lambda: len(receiver.got) == 2, "the second try", 90)
        ids = {message[1]["webhook-id"] for message in receiver.got}
        self.assertEqual(len(ids), 1, "the same message")

    def test_redirects_are_not_followed(self):
        server = self.start().start({"SYMCELL_WEBHOOK_PRIVATE": "true"})
        receiver = self.receiver(302)
        server.submit(square(), Webhook_Url=receiver.address())
        until(lambda: "answered 302" in server.log_text(), "told")
        self.assertEqual([path for path, _, _ in receiver.got], ["/hook"])

    def test_private_and_unknown_hosts_are_refused(self):
        server = self.start().start()
        for address in ("http://127.0.0.1/", "http://other.example/", "ftp://127.0.0.1/"):
            answer = server.post_json("/v1/jobs", {"model": square()}, Webhook_Url=address)
            self.assertEqual((answer.status, answer.json()["code"]), (422, "webhook_refused"), address)


if __name__ == "__main__":
    unittest.main()
