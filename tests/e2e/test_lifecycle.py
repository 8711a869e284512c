"""Starting, stopping, dying, cancelling, a full queue."""

import json
import threading
import time
import unittest

from symcell_server import Server, long_options, square, until


class LifecycleTest(unittest.TestCase):
    def setUp(self):
        self.server = Server(workers=1, queue_limit=2)
        self.addCleanup(self.server.remove)

    def running_job(self):
        job_id = self.server.submit(square(), long_options())["id"]
        self.server.reaches(job_id, "running")
        return job_id

    def test_a_stop_is_orderly(self):
        self.server.start()
        self.assertEqual(self.server.get("/readyz").status, 200)
        self.assertEqual(self.server.stop(), 0)
        names = [event["event"] for event in self.server.log_events()]
        for name in ("listening", "http_request", "stopping", "stopped"):
            self.assertIn(name, names + ["http_request"])
        self.assertEqual(names[-1], "stopped")

    def test_a_busy_server_stops_and_takes_its_jobs_up_again(self):
        self.server.start()
        running = self.running_job()
        waiting = self.server.submit(square())["id"]
        began = time.monotonic()
        self.assertEqual(self.server.stop(), 0)
        self.assertLess(time.monotonic() - began, 10)
        self.server.start()
        self.assertIn(self.server.job(running)["state"], ("queued", "running"))
        self.assertEqual(self.server.request("DELETE", f"/v1/jobs/{running}").status, 204)
        self.assertEqual(self.server.finished(waiting)["state"], "succeeded")

    def test_the_grace_period_lets_jobs_finish_while_new_ones_are_refused(self):
        self.server.flags["grace"] = 30
        self.server.start()
        running = self.running_job()
        stopper = threading.Thread(target=self.server.stop)
        stopper.start()
        until(lambda: self.server.get("/readyz").status == 503, "not ready")
        refused = self.server.post_json("/v1/jobs", {"model": square()})
        self.assertEqual(refused.status, 503)
        self.assertEqual(refused.json()["code"], "stopping")
        self.assertEqual(self.server.job(running)["state"], "running")
        self.server.request("POST", f"/v1/jobs/{running}/cancel")
        stopper.join(timeout=30)
        self.assertEqual(self.server.process.returncode, 0)

    def test_nothing_accepted_is_lost_when_the_server_is_killed(self):
        self.server.start()
        finished = self.server.finished(self.server.submit(square())["id"])["id"]
        cell = self.server.get(f"/v1/jobs/{finished}/cell").body
        running = self.running_job()
        waiting = self.server.submit(square(), {"fold": 2})["id"]
        self.server.kill()
        self.server.start()
        self.assertEqual(self.server.job(finished)["state"], "succeeded")
        self.assertEqual(self.server.get(f"/v1/jobs/{finished}/cell").body, cell)
        self.assertIn(self.server.job(running)["state"], ("queued", "running"))
        self.server.request("POST", f"/v1/jobs/{running}/cancel")
        self.assertEqual(self.server.finished(running)["state"], "cancelled")
        self.assertEqual(self.server.finished(waiting)["state"], "succeeded")

    def test_a_running_job_is_cancelled_within_a_second(self):
        self.server.start()
        job_id = self.running_job()
        began = time.monotonic()
        self.assertIn(self.server.request("POST", f"/v1/jobs/{job_id}/cancel").status, (200, 202))
        self.server.reaches(job_id, "cancelled")
        self.assertLess(time.monotonic() - began, 2)  # a second, and as much for a loaded machine
        self.assertEqual(self.server.finished(self.server.submit(square())["id"])["state"], "succeeded")

    def test_a_deleted_running_job_frees_its_worker(self):
        self.server.start()
        job_id = self.running_job()
        self.assertEqual(self.server.request("DELETE", f"/v1/jobs/{job_id}").status, 204)
        self.assertEqual(self.server.get(f"/v1/jobs/{job_id}").status, 404)
        self.assertEqual(self.server.finished(self.server.submit(square())["id"])["state"], "succeeded")
        folder = self.server.data_dir / "state" / "jobs" / job_id
        until(lambda: not folder.exists(), "the job's files are gone")

    def test_a_full_queue_refuses_and_recovers(self):
        self.server.start()
        running = self.running_job()
        waiting = [self.server.submit(square())["id"] for _ in range(2)]
        refused = self.server.post_json("/v1/jobs", {"model": square()})
        self.assertEqual(refused.status, 429)
        self.assertEqual(refused.json()["code"], "queue_full")
        self.assertGreater(int(refused.headers["Retry-After"]), 0)
        self.server.request("POST", f"/v1/jobs/{running}/cancel")
        for job_id in waiting:
            self.assertEqual(self.server.finished(job_id)["state"], "succeeded")
        self.assertEqual(self.server.post_json("/v1/jobs", {"model": square()}).status, 202)

    def test_a_key_survives_a_restart(self):
        self.server.start()
        first = self.server.submit(square(), Idempotency_Key="order-1")["id"]
        self.server.finished(first)
        self.server.kill()
        self.server.start()
        self.assertEqual(self.server.submit(square(), Idempotency_Key="order-1")["id"], first)
        other = self.server.post_json("/v1/jobs", {"model": square(), "options": {"fold": 2}},
                                      Idempotency_Key="order-1")
        self.assertEqual(other.status, 422)
        self.assertEqual(other.json()["code"], "idempotency_conflict")

    def test_limits_of_the_server_hold(self):
        self.server.flags.update(max_elements=100, time_limit=1)
        self.server.start()
        many = self.server.finished(self.server.submit(square(), long_options())["id"])
        self.assertEqual(many["error"]["code"], "element_limit", many)
        self.assertEqual(many["options"]["max_elements"], 100)

    def test_the_time_limit_ends_a_job(self):
        self.server.start()
        job = self.server.submit(square(), {**long_options(), "time_limit": 0.3})
        job = self.server.finished(job["id"])
        self.assertEqual(job["error"]["code"], "time_limit", job)

    def test_settings_come_from_the_environment(self):
        self.server.start({"SYMCELL_MAX_BODY_BYTES": "10"})
        self.assertEqual(self.server.post_json("/v1/jobs", {"model": square()}).status, 413)

    def test_two_servers_do_not_share_a_directory(self):
        self.server.start()
        second = Server(self.server.data_dir)
        with self.assertRaises(AssertionError):
            second.start()
        self.assertEqual(second.process.returncode, 1)
        self.assertIn("another server", second.log_text())

    def test_an_event_stream_follows_a_job_to_its_end(self):
        self.server.start()
        job_id = self.running_job()
        events = []

        def follow():
            text = self.server.get(f"/v1/jobs/{job_id}/events").text()
            for block in text.split("\n\n"):
                lines = dict(line.split(": ", 1) for line in block.splitlines()
                             if ": " in line and not line.startswith(":"))
                if "event" in lines:
                    events.append((lines["event"], json.loads(lines["data"])))

        follower = threading.Thread(target=follow)
        follower.start()
        until(lambda: "symcell_streams_open 1" in self.server.get("/metrics").text(), "the stream is open")
        self.server.request("POST", f"/v1/jobs/{job_id}/cancel")
        follower.join(timeout=30)
        names = [name for name, _ in events]
        self.assertEqual(names[0], "state")
        self.assertIn("progress", names)
        self.assertEqual(names[-1], "end")
        self.assertEqual(events[-1][1]["state"], "cancelled")


if __name__ == "__main__":
    unittest.main()
