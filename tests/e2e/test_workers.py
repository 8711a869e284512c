"""Worker processes: what happens to a job, and to everything else, when one crashes, loops, takes all
memory, or is killed. Faults on purpose: see server/worker/worker_main.hpp."""

import os
import pathlib
import re
import signal
import subprocess
import time
import unittest

from symcell_server import Server, binary, box, long_options, square, until, without_sanitizer

CRASH, ABORT, HANG, MEMORY, EXIT, RIGHTS = 1001, 1002, 1003, 1004, 1005, 1006
FAULTS = f"crash={CRASH},abort={ABORT},hang={HANG},memory={MEMORY},exit={EXIT},rights={RIGHTS}"


def processes():
    """{pid: (parent, command line)} of all live processes."""
    found = {}
    for entry in pathlib.Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            status = (entry / "status").read_text()
            command = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode()
        except OSError:
            continue
        if re.search(r"^State:\s+Z", status, re.M):
            continue
        found[int(entry.name)] = (int(re.search(r"^PPid:\s+(\d+)", status, re.M)[1]), command)
    return found


def workers_of(server_pid):
    return sorted(pid for pid, (parent, command) in processes().items()
                  if parent == server_pid and command.startswith("symcell worker"))


def cpu_ticks(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return int(fields[11]) + int(fields[12])


def limits_of(pid):
    return pathlib.Path(f"/proc/{pid}/limits").read_text()


class WorkersTest(unittest.TestCase):
    def start(self, **flags):
        self.server = Server(workers=1, **flags)
        self.addCleanup(self.server.remove)
        self.server.start({"SYMCELL_WORKER_FAULTS": FAULTS})
        until(lambda: len(self.workers()) == 2, "the workers are started ahead")
        return self.server

    def workers(self):
        return workers_of(self.server.process.pid)

    def busy_worker(self, but=()):
        """The worker that took a job last, as the log shows, once it is none of `but`."""
        def find():
            took = [e["pid"] for e in self.server.log_events() if e["event"] == "worker_took"]
            return took[-1] if took and took[-1] not in but else None
        return until(find, "a worker took the job")

    def running(self, options):
        job_id = self.server.submit(square(), options)["id"]
        self.server.reaches(job_id, "running")
        return job_id

    def faulty(self, seed, **options):
        return self.server.finished(self.server.submit(square(), {"seed": seed, **options})["id"])

    def assert_works(self):
        job = self.server.finished(self.server.submit(square())["id"])
        self.assertEqual(job["state"], "succeeded", job)

    def ends(self, reason):
        text = self.server.get("/metrics").text()
        return int(re.search(rf'symcell_worker_ends_total{{reason="{reason}"}} (\d+)', text)[1])

    @without_sanitizer
    def test_a_crash_is_the_job_s_error_and_nobody_else_s(self):
        server = self.start()
        for seed, word in ((CRASH, "SIGSEGV"), (ABORT, "SIGABRT"), (EXIT, "status 3")):
            job = self.faulty(seed)
            self.assertEqual(job["state"], "failed")
            self.assertEqual(job["error"]["code"], "worker_crashed", job)
            self.assertIn(word, job["error"]["detail"])
        self.assert_works()
        self.assertEqual(self.ends("crash"), 3)
        self.assertEqual(server.get("/readyz").status, 200)
        until(lambda: len(self.workers()) == 2, "the crashed workers are replaced")
        self.assertIn("worker_ended", [event["event"] for event in server.log_events()])
        inspected = server.post_json("/v1/inspect", {"model": square(), "options": {"seed": CRASH}})
        self.assertEqual(inspected.status, 500)
        self.assertEqual(inspected.json()["code"], "worker_crashed")
        self.assertEqual(server.post_json("/v1/inspect", {"model": square()}).status, 200)

    def large_worker(self, but=()):
        """The busy worker, once it has so much memory that the kernel might kill it for that."""
        worker = self.busy_worker(but)

        def is_large():
            status = pathlib.Path(f"/proc/{worker}/status").read_text()
            return int(re.search(r"VmHWM:\s+(\d+) kB", status)[1]) > 200 * 1024
        until(is_large, "the worker is large")
        return worker

    def test_small_workers_may_be_killed_more_often_for_the_cause_is_another(self):
        self.start()
        job_id = self.running({"seed": HANG, "time_limit": 60})
        killed = set()
        for _ in range(8):
            victim = self.busy_worker(killed)
            killed.add(victim)
            os.kill(victim, signal.SIGKILL)
        self.busy_worker(killed)
        self.assertEqual(self.server.job(job_id)["state"], "running")
        self.assertEqual(self.ends("outside"), 8)

    def test_a_worker_killed_from_outside_is_tried_again_but_not_for_ever(self):
        self.start()
        job_id = self.running(long_options())
        killed = set()
        for _ in range(3):
            self.assertEqual(self.server.job(job_id)["state"], "running")
            victim = self.large_worker(killed)
            killed.add(victim)
            os.kill(victim, signal.SIGKILL)
        job = self.server.finished(job_id)
        self.assertEqual(job["error"]["code"], "worker_crashed", job)
        self.assertIn("SIGKILL", job["error"]["detail"])
        self.assert_works()
        self.assertEqual(self.ends("outside"), 3)

    def test_killed_workers_are_counted_across_deaths_of_the_server_which_are_not(self):
        self.start()
        job_id = self.running(long_options())
        killed = set()

        def kill_worker():
            self.server.reaches(job_id, "running")
            victim = self.large_worker(killed)
            killed.add(victim)
            os.kill(victim, signal.SIGKILL)

        for _ in range(4):
            killed.add(self.busy_worker(killed))
            self.server.kill()
            self.server.start({"SYMCELL_WORKER_FAULTS": FAULTS})
            self.server.reaches(job_id, "running")
        kill_worker()
        kill_worker()
        killed.add(self.busy_worker(killed))
        self.server.kill()
        self.server.start({"SYMCELL_WORKER_FAULTS": FAULTS})
        kill_worker()
        job = self.server.finished(job_id)
        self.assertEqual(job["error"]["code"], "worker_crashed", job)
        self.assertIn("SIGKILL", job["error"]["detail"])

    @without_sanitizer
    def test_the_memory_limit_is_told(self):
        self.start(worker_memory=200 << 20)
        job = self.faulty(MEMORY)
        self.assertEqual(job["error"]["code"], "memory_limit", job)
        self.assertIn("200 MiB", job["error"]["detail"])
        # Not the hook alone: a mesh that needs more than there is.
        job = self.server.finished(self.server.submit(square(), long_options())["id"])
        self.assertEqual(job["error"]["code"], "memory_limit", job)
        self.assert_works()
        self.assertEqual(self.ends("memory_limit"), 2)

    def test_a_loop_that_hears_nothing_ends_at_its_time_limit(self):
        self.start()
        began = time.monotonic()
        job = self.faulty(HANG, time_limit=0.5)
        self.assertEqual(job["error"]["code"], "time_limit", job)
        self.assertIn("0.5 s", job["error"]["detail"])
        self.assertLess(time.monotonic() - began, 4)
        self.assert_works()
        self.assertEqual(self.ends("time_limit"), 1)

    @without_sanitizer
    def test_the_processor_limit_is_the_kernel_s(self):
        self.start(cpu_limit=1)
        job = self.faulty(HANG)
        self.assertEqual(job["error"]["code"], "time_limit", job)
        self.assertIn("processor time", job["error"]["detail"])
        self.assert_works()

    def test_a_loop_that_hears_nothing_is_cancelled_within_a_second(self):
        self.start()
        job_id = self.running({"seed": HANG})
        worker = self.busy_worker()
        began = time.monotonic()
        self.assertIn(self.server.request("POST", f"/v1/jobs/{job_id}/cancel").status, (200, 202))
        self.server.reaches(job_id, "cancelled")
        self.assertLess(time.monotonic() - began, 1.5)  # a second, and half of one for a loaded machine
        self.assertNotIn(worker, self.workers())
        self.assert_works()

    def test_an_orderly_cancel_costs_no_worker(self):
        self.start()
        before = self.workers()
        job_id = self.running(long_options())
        self.server.request("POST", f"/v1/jobs/{job_id}/cancel")
        self.server.reaches(job_id, "cancelled")
        self.assert_works()
        self.assertEqual(self.workers(), before)
        self.assertEqual(self.ends("cancelled"), 0)

    def test_no_worker_outlives_a_killed_server(self):
        self.start()
        self.running({"seed": HANG})
        busy = self.busy_worker()
        workers = self.workers()
        self.assertIn(busy, workers)
        self.server.kill()
        until(lambda: not set(workers) & set(processes()), "all workers are gone", 5)

    def test_no_worker_outlives_a_stopped_server(self):
        self.start()
        self.running({"seed": HANG})
        workers = self.workers()
        self.assertEqual(self.server.stop(), 0)
        self.assertFalse(set(workers) & set(processes()))

    def test_a_stopped_server_runs_the_job_of_a_stuck_worker_again(self):
        self.start()
        job_id = self.running({"seed": HANG})
        self.assertEqual(self.server.stop(), 0)
        self.server.start()  # without the faults
        self.assertEqual(self.server.finished(job_id)["state"], "succeeded")

    def test_workers_are_replaced_after_their_share_of_jobs(self):
        self.start(worker_jobs=3)
        before = set(self.workers())
        for _ in range(8):
            self.assert_works()
        until(lambda: len(self.workers()) == 2, "there are as many as before")
        self.assertNotEqual(before, set(self.workers()))
        self.assertGreaterEqual(self.ends("retired"), 2)

    def test_workers_hold_nothing_of_the_server_s(self):
        self.start()
        self.running(long_options())
        # A spare worker may be starting still: it limits itself once it runs.
        no_core = re.compile(r"Max core file size\s+1\s+1\s")
        until(lambda: all(no_core.search(limits_of(pid)) for pid in self.workers()), "no worker writes a core file")
        for pid in self.workers():
            targets = {name: os.readlink(f"/proc/{pid}/fd/{name}") for name in os.listdir(f"/proc/{pid}/fd")}
            self.assertEqual(len([t for t in targets.values() if t.startswith("socket:")]), 1, targets)
            self.assertFalse([t for t in targets.values() if "sqlite" in t or t.endswith("/lock")], targets)
            status = pathlib.Path(f"/proc/{pid}/status").read_text()
            self.assertRegex(status, r"SigBlk:\s+0+\n")
            if not os.environ.get("SYMCELL_SANITIZE"):
                until(lambda: re.search(r"Seccomp:\s+2\n", pathlib.Path(f"/proc/{pid}/status").read_text()),
                      "system calls are filtered")
            self.assertRegex(pathlib.Path(f"/proc/{pid}/status").read_text(), r"NoNewPrivs:\s+1\n")
            self.assertRegex(limits_of(pid), r"Max open files\s+64\s+64\s")
        busy = self.busy_worker()
        until(lambda: re.search(r"Max file size\s+\d+\s", limits_of(busy)) or os.environ.get("SYMCELL_SANITIZE"),
              "files have a largest size")

    @without_sanitizer
    def test_workers_can_do_nothing_but_mesh(self):
        self.start()
        job = self.faulty(RIGHTS)
        self.assertEqual(job["state"], "succeeded", job)
        self.assertEqual(self.server.finished(self.server.submit(box())["id"])["state"], "succeeded")

    def test_closed_standard_streams_do_no_harm(self):
        server = Server(workers=1)
        self.addCleanup(server.remove)
        port_file = server.data_dir / "port"
        server.process = subprocess.Popen(
            ["sh", "-c", 'exec "$@" <&- >&- 2>&-', "sh", binary(), "serve", "--port", "0", "--port-file",
             str(port_file), "--data-dir", str(server.data_dir / "state")])
        server.log = open(server.data_dir / "log", "ab")
        until(port_file.exists, "the server listens")
        server.port = int(port_file.read_text())
        job = server.finished(server.submit(square())["id"])
        self.assertEqual(job["state"], "succeeded", job)

    def test_progress_comes_from_the_worker(self):
        self.start()
        job_id = self.running(long_options())
        until(lambda: self.server.job(job_id)["progress"].get("elements", 0) > 1000, "elements are reported")
        self.assertEqual(self.server.job(job_id)["progress"]["phase"], "refine")


if __name__ == "__main__":
    unittest.main()
