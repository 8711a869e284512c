"""A job store that fails for a while: nothing is lost or stuck, and it is told."""

import sqlite3
import time
import unittest

from symcell_server import Server, long_options, square, until


class StoreFailuresTest(unittest.TestCase):
    def setUp(self):
        self.server = Server(workers=1)
        self.addCleanup(self.server.remove)
        self.server.start()

    def locked(self):
        """Holds the database as another process would; call the result to let go."""
        connection = sqlite3.connect(self.server.data_dir / "state" / "jobs.sqlite", isolation_level=None)
        self.addCleanup(connection.close)
        connection.execute("BEGIN IMMEDIATE")
        return lambda: connection.execute("ROLLBACK")

    def test_jobs_go_on_when_the_database_is_free_again(self):
        running = self.server.submit(square(), {**long_options(), "time_limit": 1.5})["id"]
        waiting = self.server.submit(square())["id"]
        self.server.reaches(running, "running")
        release = self.locked()
        time.sleep(8)  # longer than any statement waits for the lock
        self.assertEqual(self.server.get("/readyz").status, 503)
        self.assertEqual(self.server.get("/healthz").status, 200)
        self.assertEqual(self.server.job(running)["state"], "running")
        refused = self.server.post_json("/v1/jobs", {"model": square()})
        self.assertEqual(refused.status, 503)
        self.assertEqual(refused.json()["code"], "store_unavailable")
        release()
        self.assertEqual(self.server.finished(running, 10)["error"]["code"], "time_limit")
        self.assertEqual(self.server.finished(waiting, 10)["state"], "succeeded")
        until(lambda: self.server.get("/readyz").status == 200, "ready again")
        self.assertIn('symcell_store_errors_total{operation="apply"}', self.server.get("/metrics").text())
        events = [event["event"] for event in self.server.log_events()]
        self.assertIn("store_failed", events)
        self.assertIn("store_works_again", events)


if __name__ == "__main__":
    unittest.main()
