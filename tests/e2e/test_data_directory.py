"""Whose a data directory is, and what becomes of results whose database is gone."""

import os
import unittest

from symcell_server import Server, square


class DataDirectoryTest(unittest.TestCase):
    def setUp(self):
        self.server = Server(workers=1)
        self.addCleanup(self.server.remove)
        self.state = self.server.data_dir / "state"

    def files_below(self, folder):
        return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))

    def test_a_folder_of_the_user_s_is_refused_untouched(self):
        letters = self.server.data_dir / "letters"
        letters.mkdir()
        (letters / "dear").write_text("dear")
        (self.state / "jobs" / "2024").mkdir(parents=True)
        (self.state / "jobs" / "2024" / "report").write_text("report")
        (self.state / "incoming").mkdir()
        (self.state / "incoming" / "photo").write_text("photo")
        os.symlink(letters, self.state / "jobs" / "letters")
        mode = (self.state / "jobs").stat().st_mode
        before = self.files_below(self.server.data_dir)
        with self.assertRaises(AssertionError):
            self.server.start()
        self.assertEqual(self.server.process.returncode, 1)
        self.assertIn("left as it is", self.server.log_text())
        (self.server.data_dir / "log").unlink()
        self.assertEqual(self.files_below(self.server.data_dir), before)
        self.assertEqual((self.state / "jobs").stat().st_mode, mode)

    def test_a_lost_database_costs_no_result(self):
        self.server.start()
        job_id = self.server.finished(self.server.submit(square())["id"])["id"]
        cell = (self.state / "jobs" / job_id / "cell").read_bytes()
        self.assertEqual(self.server.stop(), 0)
        for file in self.state.glob("jobs.sqlite*"):
            file.unlink()
        self.server.start()
        self.assertEqual(self.server.get(f"/v1/jobs/{job_id}").status, 404)
        kept = list(self.state.glob(f"quarantine/*/jobs/{job_id}/cell"))
        self.assertEqual([path.read_bytes() for path in kept], [cell])
        events = {event["event"]: event for event in self.server.log_events()}
        self.assertIn(job_id, events["quarantined"]["what"])
        self.assertEqual(events["quarantine_filled"]["count"], 1)
        self.assertEqual(self.server.finished(self.server.submit(square())["id"])["state"], "succeeded")


if __name__ == "__main__":
    unittest.main()
