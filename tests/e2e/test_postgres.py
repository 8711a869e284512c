"""Servers that share their jobs in a PostgreSQL database and a folder."""

import pathlib
import shutil
import subprocess
import tempfile
import threading
import time
import unittest

from postgres_server import Postgres, programs
from symcell_server import Server, binary, long_options, square, until


@unittest.skipUnless(programs(), "no PostgreSQL server is installed")
class PostgresTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.postgres = Postgres()

    @classmethod
    def tearDownClass(cls):
        cls.postgres.remove()

    def setUp(self):
        self.shared = pathlib.Path(tempfile.mkdtemp(prefix="symcell-shared-"))
        self.addCleanup(shutil.rmtree, self.shared, True)
        if self.postgres.process.poll() is not None:
            self.postgres.start()
        self.postgres.query("DROP SCHEMA public CASCADE")
        self.postgres.query("CREATE SCHEMA public")

    def server(self, **flags):
        server = Server(store=self.postgres.url, **flags)
        server.state_dir = self.shared
        self.addCleanup(server.remove)
        return server.start()

    def test_one_answers_and_another_meshes(self):
        api = self.server(role="api")
        job = api.submit(square())
        time.sleep(1)
        self.assertEqual(api.job(job["id"])["state"], "queued")
        worker = self.server(role="worker")
        self.assertEqual(api.finished(job["id"])["state"], "succeeded")
        self.assertEqual(api.get(job["links"]["self"] + "/cell").status, 200)
        began = time.monotonic()
        answer = api.post_json("/v1/jobs", {"model": square()}, Prefer="wait=30")
        self.assertEqual(answer.status, 201)
        self.assertLess(time.monotonic() - began, 3, "word came at once, not by looking every few seconds")
        self.assertEqual(worker.get("/readyz").status, 200)
        self.assertEqual(worker.get("/v1/jobs").status, 404)

    def test_progress_and_cancel_cross_servers(self):
        api = self.server(role="api")
        worker = self.server(role="worker")
        job = api.submit(square(), long_options())["id"]
        until(lambda: api.job(job)["progress"]["elements"] > 0, "progress is seen")
        began = time.monotonic()
        api.request("POST", f"/v1/jobs/{job}/cancel")
        api.reaches(job, "cancelled")
        self.assertLess(time.monotonic() - began, 5)
        deleted = api.submit(square(), long_options())["id"]
        api.reaches(deleted, "running")
        self.assertEqual(api.request("DELETE", f"/v1/jobs/{deleted}").status, 204)
        until(lambda: "symcell_workers_busy 0" in worker.get("/metrics").text(), "its run has ended")
        until(lambda: not (self.shared / "jobs" / deleted).exists(), "its files are gone")

    def test_jobs_of_a_server_that_died_are_run_by_another_once(self):
        dying = self.server(workers=1)
        job = dying.submit(square(), {**long_options(), "time_limit": 40})["id"]
        dying.reaches(job, "running")
        dying.kill()
        other = self.server(workers=1)
        until(lambda: other.job(job)["state"] == "running" and
              self.postgres.query(f"SELECT attempt FROM symcell_jobs WHERE id = '{job}'") == "2",
              "taken up again", 60)
        other.request("POST", f"/v1/jobs/{job}/cancel")
        other.reaches(job, "cancelled")

    def test_nothing_is_lost_or_stuck_when_the_database_dies(self):
        server = self.server(workers=1)
        running = server.submit(square(), {**long_options(), "time_limit": 4})["id"]
        waiting = server.submit(square())["id"]
        server.reaches(running, "running")
        self.postgres.kill()
        until(lambda: server.get("/readyz").status == 503, "not ready", 30)
        self.assertEqual(server.get("/healthz").status, 200)
        self.assertEqual(server.post_json("/v1/jobs", {"model": square()}).status, 503)
        time.sleep(5)  # the job's end cannot be written
        self.postgres.start()
        until(lambda: server.get("/readyz").status == 200, "ready again", 30)
        self.assertEqual(server.finished(running)["error"]["code"], "time_limit")
        self.assertEqual(server.finished(waiting)["state"], "succeeded")

    def test_keys_are_those_of_the_database(self):
        servers = [self.server(), self.server()]
        made = subprocess.run([binary(), "keys", "create", "--name", "x", "--store", self.postgres.url],
                              capture_output=True, text=True, check=True).stdout.strip()
        for server in servers:
            until(lambda: server.get("/v1/jobs").status == 401, "keys are asked for")
            self.assertEqual(server.get("/v1/jobs", X_API_Key=made).status, 200)

    def test_many_clients_of_many_servers_get_each_job_once(self):
        servers = [self.server(workers=1, queue_limit=1000) for _ in range(3)]
        ids, lock = [], threading.Lock()

        def client(server):
            for i in range(10):
                job = server.submit(square(), {"max_area": 0.1 + i / 1000})["id"]
                with lock:
                    ids.append(job)

        threads = [threading.Thread(target=client, args=(server,)) for server in servers for _ in range(2)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for job in ids:
            self.assertEqual(servers[0].finished(job)["state"], "succeeded")
        self.assertEqual(self.postgres.query("SELECT max(attempt), count(*) FROM symcell_jobs"), f"1|{len(ids)}")
        runs = [server.log_text().count('"job_started"') for server in servers]
        self.assertEqual(sum(runs), len(ids))

    def test_another_folder_is_refused(self):
        self.server()
        self.shared = pathlib.Path(tempfile.mkdtemp(prefix="symcell-other-"))
        self.addCleanup(shutil.rmtree, self.shared, True)
        with self.assertRaises(AssertionError):
            self.server()


if __name__ == "__main__":
    unittest.main()
