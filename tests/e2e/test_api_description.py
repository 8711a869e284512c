"""openapi.yaml against the real server: every operation is called, every example is sent, every
answer is of a described status, type and shape."""

import json
import re
import unittest

from openapi_check import Description
from symcell_server import ROOT, Server, box, long_options, square, until

try:
    import yaml
except ImportError:
    yaml = None


def error_codes():
    """Names of the library's error codes, from the source: the description must know them all."""
    source = (ROOT / "core" / "base" / "error.cpp").read_text()
    return set(re.findall(r'return "(\w+)";', source))


def encode(media_type, value):
    """(Content-Type, body) of an example."""
    if media_type == "application/json":
        return media_type, json.dumps(value).encode()
    if media_type == "multipart/form-data":
        boundary = "example-boundary"
        body = ""
        for name, part in value.items():
            text = part if isinstance(part, str) else json.dumps(part)
            file_name = '; filename="model.json"' if name == "model" else ""
            body += (f'--{boundary}\r\nContent-Disposition: form-data; name="{name}"{file_name}\r\n'
                     f"\r\n{text}\r\n")
        return f"{media_type}; boundary={boundary}", (body + f"--{boundary}--\r\n").encode()
    return media_type, value.encode()


@unittest.skipUnless(yaml, "PyYAML is not installed (Debian: python3-yaml)")
class ApiDescriptionTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.description = Description(yaml.safe_load((ROOT / "openapi.yaml").read_text()))
        cls.server = Server(workers=1, queue_limit=20).start()
        cls.finished = cls.server.finished(cls.server.submit(square())["id"])
        cls.solid = cls.server.finished(cls.server.submit(box())["id"])
        cls.called = set()

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()

    def operation(self, operation_id):
        for method, path, operation in self.description.operations():
            if operation["operationId"] == operation_id:
                return method, path, operation
        raise AssertionError(f"{operation_id} is not described")

    def call(self, operation_id, job_id="", query="", body=None, headers=None, status=None):
        """Calls the operation and checks the answer against its description."""
        method, path, operation = self.operation(operation_id)
        ApiDescriptionTest.called.add(operation_id)
        answer = self.server.request(method, path.replace("{id}", job_id) + query, body, headers)
        self.assertIn(str(answer.status), operation["responses"], (operation_id, answer.body[:500]))
        if status is not None:
            self.assertEqual(answer.status, status, (operation_id, answer.body[:500]))
        response = self.description.resolve(operation["responses"][str(answer.status)])
        for name, header in response.get("headers", {}).items():
            self.assertIn(name, answer.headers, operation_id)
        if answer.status == 206:
            return answer  # of whatever type the whole has
        content = response.get("content", {})
        media_type = answer.headers.get("Content-Type", "").split(";")[0]
        if not content:
            self.assertEqual(answer.body, b"", operation_id)
        else:
            self.assertIn(media_type, content, operation_id)
            if media_type in ("application/json", "application/problem+json"):
                faults = list(self.description.faults(answer.json(), content[media_type]["schema"]))
                self.assertEqual(faults, [], operation_id)
        return answer

    def post_examples(self, operation_id, status):
        _, _, operation = self.operation(operation_id)
        body = self.description.resolve(operation["requestBody"])
        answers = []
        for media_type, content in body["content"].items():
            for name, example in content["examples"].items():
                with self.subTest(f"{operation_id} {media_type} {name}"):
                    content_type, data = encode(media_type, example["value"])
                    answers.append(self.call(operation_id, body=data,
                                             headers={"Content-Type": content_type}, status=status))
        return answers

    def test_every_example_of_a_job_is_accepted_and_succeeds(self):
        for operation_id in ("createJob", "createJobFromFile", "createJobFromForm"):
            for answer in self.post_examples(operation_id, 202):
                job = self.server.finished(answer.json()["id"])
                self.assertEqual(job["state"], "succeeded", job.get("error"))
        self.call("createJob", body=json.dumps({"model": square()}), status=201,
                  headers={"Content-Type": "application/json", "Prefer": "wait=30"})

    def test_every_example_can_be_inspected(self):
        for operation_id in ("inspectModel", "inspectFile", "inspectForm"):
            self.post_examples(operation_id, 200)

    def test_models_are_drawn_with_what_is_known_of_them(self):
        def extras(answer):
            self.assertEqual(answer.body[:4], b"glTF")
            length = int.from_bytes(answer.body[12:16], "little")
            return json.loads(answer.body[20:20 + length])["scenes"][0]["extras"]

        for job in (self.finished, self.solid):
            drawn = extras(self.call("getSurface", job["id"], status=200))
            self.assertEqual(drawn["inspection"]["fold"], 4)
        self.call("getSurface", self.solid["id"], headers={"Accept": "image/png"}, status=406)
        headers = {"Content-Type": "application/json", "Accept": "model/gltf-binary"}
        self.assertIn("inspection", extras(self.call("inspectModel", body=json.dumps({"model": box()}),
                                                     headers=headers, status=200)))
        crossed = {**square(), "segments": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 3]]}
        drawn = self.call("inspectModel", body=json.dumps({"model": crossed}), headers=headers, status=200)
        self.assertEqual(extras(drawn)["problem"]["code"], "self_intersection")
        self.assertIn(b'"at fault"', drawn.body)

    def test_jobs_are_told_and_listed(self):
        self.call("getJob", self.finished["id"], status=200)
        self.call("listJobs", query="?state=succeeded&limit=10", status=200)
        self.call("listJobs", query="?limit=0", status=400)

    def test_results_come_in_every_described_type(self):
        for operation_id in ("getCell", "getFull"):
            for job, other_kind in ((self.finished, ("model/stl", "stl")),
                                    (self.solid, ("image/svg+xml", "svg"))):
                self.call_in_every_type(operation_id, job["id"], other_kind)
            etag = self.call(operation_id, self.finished["id"]).headers["ETag"]
            self.call(operation_id, self.finished["id"], headers={"If-None-Match": etag}, status=304)
            self.call(operation_id, self.finished["id"], "?format=dxf", status=400)
            self.call(operation_id, self.finished["id"], headers={"Accept": "image/png"}, status=406)
        self.call("getStatistics", self.finished["id"], status=200)
        self.call("getModel", self.finished["id"], status=200)
        for operation_id in ("getCell", "getFull", "getStatistics", "getModel"):
            self.call(operation_id, self.finished["id"], headers={"Range": "bytes=0-9"}, status=206)
            self.call(operation_id, self.finished["id"], headers={"Range": "bytes=999999999-"}, status=416)
        self.call("rerunJob", self.finished["id"], headers={"Prefer": "wait=30"}, status=201)
        self.call("rerunJob", self.finished["id"], headers={"Webhook-Url": "http://a.example/"}, status=422)
        self.call("followJob", self.finished["id"], status=200)

    def call_in_every_type(self, operation_id, job_id, other_kind):
        """`other_kind`: what shows only planar meshes, or only solids."""
        _, _, operation = self.operation(operation_id)
        for media_type in self.description.resolve(operation["responses"]["200"])["content"]:
            status = 406 if media_type in other_kind else 200
            answer = self.call(operation_id, job_id, headers={"Accept": media_type}, status=status)
            if status == 200:
                self.assertEqual(answer.headers["Content-Type"].split(";")[0], media_type)
        for parameter in operation["parameters"]:
            parameter = self.description.resolve(parameter)
            for value in parameter["schema"].get("enum", []):
                self.call(operation_id, job_id, f"?{parameter['name']}={value}",
                          status=406 if value in other_kind else 200)

    def test_unknown_jobs_are_described_problems(self):
        for _, path, operation in self.description.operations():
            if path.startswith("/v1/jobs/{id}"):
                self.call(operation["operationId"], "00000000000000000000000000", status=404)

    def test_unfinished_jobs_have_no_results_and_can_be_cancelled_and_deleted(self):
        job_id = self.server.submit(square(), long_options())["id"]
        for operation_id in ("getCell", "getFull", "getStatistics"):
            self.call(operation_id, job_id, status=409)
        self.call("cancelJob", job_id)
        until(lambda: self.server.job(job_id)["state"] == "cancelled", "cancelled")
        self.call("cancelJob", job_id, status=200)
        self.call("cancelJob", self.finished["id"], status=409)
        self.call("deleteJob", job_id, status=204)

    def test_refusals_are_described(self):
        send = {"Content-Type": "application/json"}
        for operation_id in ("createJob", "inspectModel", "createJobFromFile", "inspectFile",
                             "createJobFromForm", "inspectForm"):
            self.call(operation_id, body="{", headers=send, status=400)
            self.call(operation_id, body="x", headers={"Content-Type": "image/png"}, status=415)
        self.call("inspectModel", body=json.dumps({"model": square(), "options": {"fold": 3}}),
                  headers=send, status=422)

    def test_pages_and_probes_answer(self):
        for operation_id in ("getHealth", "getReadiness", "getMetrics", "getDescription", "getDocs",
                             "getPlainDocs", "getIndex"):
            self.call(operation_id, status=200)
        self.call("listKeys", status=200)
        self.call("getProblemType", "not_symmetric", status=200)
        self.call("getProblemType", "no_such_problem", status=404)

    def test_the_description_is_sound_and_complete(self):
        for reference in self.description.references():
            self.assertIsNotNone(self.description.resolve({"$ref": reference}), reference)
        codes = set(self.description.document["components"]["schemas"]["ProblemCode"]["enum"])
        self.assertLessEqual(error_codes(), codes)
        schema = {"$ref": "#/components/schemas/Job"}
        for name, example in self.description.document["components"]["examples"].items():
            self.assertEqual(list(self.description.faults(example["value"], schema)), [], name)

    def test_the_page_knows_every_operation(self):
        page = self.server.get("/docs/plain").text()
        for method, path, _ in self.description.operations():
            self.assertIn(f"<code>{method} {path}</code>", page)

    def test_options_described_are_the_programs(self):
        described = set(self.description.document["components"]["schemas"]["Options"]["properties"])
        settings = set(self.finished["statistics"]["settings"])
        self.assertLessEqual(settings, described)
        for operation_id in ("createJobFromFile", "inspectFile"):
            parameters = [self.description.resolve(parameter)
                          for parameter in self.operation(operation_id)[2]["parameters"]]
            in_query = {parameter["name"] for parameter in parameters if parameter["in"] == "query"}
            self.assertEqual(in_query, described, operation_id)
        page = self.server.get("/docs/plain").text()
        for name in described:
            self.assertIn(f"<code>{name}</code>", page)

    def test_options_may_come_as_an_object_in_the_query(self):
        body = json.dumps(square())
        answer = self.server.request(
            "POST", "/v1/jobs?options%5Bmax_area%5D=0.02&options%5Bfold%5D=2", body,
            {"Content-Type": "application/octet-stream", "Prefer": "wait=30"})
        self.assertEqual(answer.status, 201, answer.body)
        self.assertEqual(answer.json()["options"]["max_area"], 0.02)
        self.assertEqual(answer.json()["options"]["fold"], 2)

    def test_lists_tell_the_elements_of_finished_jobs(self):
        listed = {job["id"]: job for job in self.server.get("/v1/jobs?limit=500").json()["jobs"]}
        for job in (self.finished, self.solid):
            self.assertEqual(listed[job["id"]]["progress"]["elements"],
                             job["statistics"]["cell"]["elements"])

    @classmethod
    def every_operation(cls):
        return {operation["operationId"] for _, _, operation in cls.description.operations()}

    def test_zz_every_operation_has_been_called(self):
        # unittest runs in order of names: this one is the last.
        self.assertEqual(self.every_operation() - self.called, set())


if __name__ == "__main__":
    unittest.main()
