"""Keys by the command, TLS, and what an open server is bound to."""

import http.client
import json
import os
import shutil
import signal
import ssl
import subprocess
import tempfile
import unittest

from symcell_server import Server, binary, square, until


def keys(server, *arguments):
    """Runs `symcell keys`; returns what it prints."""
    done = subprocess.run([binary(), "keys", *arguments, "--data-dir", str(server.data_dir / "state")],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stdout.strip()


class KeysTest(unittest.TestCase):
    def setUp(self):
        self.server = Server()
        self.addCleanup(self.server.remove)

    def status(self, key=None):
        headers = {"Authorization": "Bearer " + key} if key else {}
        return self.server.request("GET", "/v1/jobs", headers=headers).status

    def test_a_key_is_made_before_the_first_start_used_and_revoked(self):
        key = keys(self.server, "create", "--name", "Jo", "--requests-per-minute", "100")
        self.server.start()
        self.assertEqual(self.status(), 401)
        self.assertEqual(self.status(key), 200)
        answer = self.server.post_json("/v1/jobs", {"model": square()}, X_API_Key=key, Prefer="wait=30")
        self.assertEqual(answer.status, 201)
        self.assertIn("RateLimit", answer.headers)
        listed = keys(self.server, "list")
        self.assertIn("Jo", listed)
        self.assertNotIn(key, listed)
        secret = key.split("_", 2)[2]
        for file in (self.server.data_dir / "state").glob("jobs.sqlite*"):
            self.assertNotIn(secret.encode(), file.read_bytes(), file)
        keys(self.server, "revoke", listed.split()[0])
        until(lambda: self.status(key) == 401, "the revoked key is refused")
        # Who used which key, and who was refused, stands in the log; keys themselves do not.
        log = self.server.log_text()
        self.assertNotIn(secret, log)
        used = [event for event in self.server.log_events() if event.get("key") == listed.split()[0]]
        self.assertIn("job_accepted", [event["event"] for event in used])
        self.assertTrue(all(event["client"] == "127.0.0.1" for event in used if "client" in event))
        self.assertIn("caller_refused", [event["event"] for event in self.server.log_events()])

    def test_a_key_made_while_the_server_runs_is_asked_for(self):
        self.server.start()
        self.assertEqual(self.status(), 200)
        key = keys(self.server, "create", "--name", "x")
        until(lambda: self.status() == 401, "keys are asked for")
        self.assertEqual(self.status(key), 200)

    def test_wrong_usage_is_told(self):
        for arguments in (["create"], ["create", "--name", "x", "--scope", "write"], ["revoke", "none"]):
            with self.assertRaises(AssertionError):
                keys(self.server, *arguments)


class OpenServerTest(unittest.TestCase):
    def test_an_address_for_all_needs_keys_unless_it_is_said_otherwise(self):
        for flags, status in (({}, 401), ({"insecure_open": "true"}, 200)):
            server = Server(host="0.0.0.0")
            self.addCleanup(server.remove)
            server.start({"SYMCELL_" + name.upper(): value for name, value in flags.items()})
            self.assertEqual(server.get("/v1/jobs").status, status)
            self.assertEqual(server.get("/healthz").status, 200)


@unittest.skipUnless(shutil.which("openssl"), "no openssl to make certificates with")
class TlsTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="symcell-tls-")
        self.addCleanup(shutil.rmtree, self.folder)
        self.make_certificate("one")
        self.server = Server(tls_certificate=self.folder + "/cert.pem", tls_key=self.folder + "/key.pem")
        self.addCleanup(self.server.remove)
        self.server.start()

    def make_certificate(self, name):
        subprocess.run(["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256",
                        "-nodes", "-days", "2", "-subj", f"/CN={name}", "-addext", "subjectAltName=IP:127.0.0.1",
                        "-keyout", self.folder + "/key.pem", "-out", self.folder + "/cert.pem"],
                       check=True, capture_output=True)

    def connection(self):
        context = ssl.create_default_context(cafile=self.folder + "/cert.pem")
        return http.client.HTTPSConnection("127.0.0.1", self.server.port, timeout=30, context=context)

    def subject(self):
        connection = self.connection()
        connection.connect()
        name = dict(part[0] for part in connection.sock.getpeercert()["subject"])["commonName"]
        connection.close()
        return name

    def test_jobs_go_through_tls(self):
        connection = self.connection()
        body = json.dumps({"model": square(), "options": {"max_area": 1e-4}})
        for _ in range(3):  # on one connection
            connection.request("POST", "/v1/jobs", body, {"Content-Type": "application/json", "Prefer": "wait=30"})
            job = json.loads(connection.getresponse().read())
            self.assertEqual(job["state"], "succeeded")
            connection.request("GET", job["links"]["full"])
            mesh = connection.getresponse()
            self.assertGreater(len(mesh.read()), 100_000)
        # A body that is more than the server waits for without a thread.
        large = "# " + "x" * 3_000_000 + "\n4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n"
        connection.request("POST", "/v1/jobs", large, {"Content-Type": "text/plain", "Prefer": "wait=30"})
        answer = connection.getresponse()
        self.assertEqual((answer.status, json.loads(answer.read())["state"]), (201, "succeeded"))

    def test_plain_talk_is_cut_off_and_old_versions_are_refused(self):
        with self.assertRaises((http.client.HTTPException, ConnectionError)):
            self.server.get("/healthz")
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
        context.maximum_version = ssl.TLSVersion.TLSv1_1
        with self.assertRaises((ssl.SSLError, ConnectionError)):
            http.client.HTTPSConnection("127.0.0.1", self.server.port, context=context, timeout=10).connect()
        self.assertEqual(self.subject(), "one")

    def test_certificates_are_read_again_on_a_signal(self):
        self.make_certificate("two")
        self.server.process.send_signal(signal.SIGHUP)
        until(lambda: "reloaded" in self.server.log_text(), "reloaded")
        self.assertEqual(self.subject(), "two")
        with open(self.folder + "/key.pem", "w") as file:
            file.write("no key")
        self.server.process.send_signal(signal.SIGHUP)
        until(lambda: "not_reloaded" in self.server.log_text(), "told")
        self.assertEqual(self.subject(), "two")

    def test_files_that_are_no_certificate_are_told(self):
        for flags in ({"tls_certificate": self.folder + "/none"},
                      {"tls_certificate": os.devnull, "tls_key": os.devnull}):
            server = Server(**flags)
            self.addCleanup(server.remove)
            with self.assertRaises(AssertionError):
                server.start()


if __name__ == "__main__":
    unittest.main()
