"""Inputs that must be refused clearly: the corpus beside the source tree, sent over HTTP."""

import json
import time
import unittest

from symcell_server import CORPUS, Server, corpus_entries, square

# What the corpus calls a class, where our name differs.
OUR_CODES = {
    "resource_limit": {"element_limit", "time_limit", "memory_limit", "too_large", "body_too_large"},
    "overflow": {"coordinate_range", "non_finite"},
    "not_stl": {"unknown_format"},
}


def right_codes(entry):
    codes = set()
    for name in [entry["expected_error_class"], *entry.get("other_classes_also_right", [])]:
        codes |= OUR_CODES.get(name, {name})
    return codes


def may_be_meshed(entry):
    return any(not word.startswith("clear_error") for word in entry.get("acceptable", []))


@unittest.skipUnless(corpus_entries(), f"no corpus at {CORPUS}")
class BadInputsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(max_elements=2_000_000, time_limit=8).start()

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()

    def send(self, entry):
        """The problem document, or the finished job where there is none."""
        body = (CORPUS / entry["file"]).read_bytes()
        query = f"fold={entry['request']['fold']}"
        for name, values in entry["request"].get("axis", {}).items():
            if entry["kind"] != "pslg2d":
                query += f"&axis_{name}=" + ",".join(str(value) for value in values)
        if entry["kind"] == "pslg2d" and "b19" in entry["file"]:
            options = json.loads(body).get("options", {})
            query += "".join(f"&{name}={value}" for name, value in options.items()) or "&max_area=1e-30"
        answer = self.server.request("POST", f"/v1/jobs?{query}", body,
                                     {"Content-Type": "application/octet-stream"})
        if answer.status == 202:
            job = self.server.finished(answer.json()["id"], entry["must"]["no_hang_seconds"] + 5)
            return job.get("error", job)
        self.assertIn(answer.status, (400, 413, 415, 422), answer.body)
        self.assertEqual(answer.headers["Content-Type"], "application/problem+json")
        return answer.json()

    def test_every_bad_input_is_refused_clearly_and_soon(self):
        for entry in corpus_entries():
            with self.subTest(entry["file"]):
                began = time.monotonic()
                problem = self.send(entry)
                self.assertLess(time.monotonic() - began, entry["must"]["no_hang_seconds"] + 5)
                if "code" not in problem:
                    self.assertTrue(may_be_meshed(entry), problem)
                    continue
                self.assertIn(problem["code"], right_codes(entry), problem["detail"])
                self.assertGreater(len(problem["detail"]), 10)
                self.assertEqual(self.server.get("/healthz").status, 200)

    def test_the_server_still_meshes_afterwards(self):
        job = self.server.finished(self.server.submit(square())["id"])
        self.assertEqual(job["state"], "succeeded")

    def test_folds_that_are_none(self):
        for fold in (0, -3, 2.5, "four", 1000000007, None, [], True):
            answer = self.server.post_json("/v1/jobs", {"model": square(), "options": {"fold": fold}})
            if fold is None:
                continue  # null is "not given"
            self.assertEqual(answer.status, 400, (fold, answer.body))
            self.assertIn(answer.json()["code"], ("bad_fold", "wrong_type", "bad_option"))


if __name__ == "__main__":
    unittest.main()
