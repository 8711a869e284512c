"""Solids in every format, through the service: the same part comes out of each."""

import gzip
import json
import struct
import unittest

from symcell_server import Server

# A square frustum, 4-fold about the z axis; its volume is 28/3.
VERTICES = [[2, 2, 0], [-2, 2, 0], [-2, -2, 0], [2, -2, 0],
            [1, 1, 1], [-1, 1, 1], [-1, -1, 1], [1, -1, 1]]
FACES = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
VOLUME = 28 / 3
AXIS = "axis_origin=0,0,0&axis_direction=0,0,1"


def triangles():
    return [(f[0], f[i], f[i + 1]) for f in FACES for i in (1, 2)]


def binary_stl():
    corners = b"".join(struct.pack("<3f", 0, 0, 0) + b"".join(
        struct.pack("<3f", *VERTICES[v]) for v in t) + b"\0\0" for t in triangles())
    return b"solid frustum".ljust(80) + struct.pack("<I", 12) + corners


def ascii_stl():
    facets = "".join("facet normal 0 0 0\nouter loop\n" + "".join(
        "vertex {} {} {}\n".format(*VERTICES[v]) for v in t) + "endloop\nendfacet\n"
        for t in triangles())
    return f"solid frustum\n{facets}endsolid frustum\n".encode()


def numbers(lists, before=""):
    return "".join(before + " ".join(str(c) for c in entry) + "\n" for entry in lists)


def off():
    faces = [[len(f), *f] for f in FACES]
    return ("OFF\n8 6 12\n" + numbers(VERTICES) + numbers(faces)).encode()


def obj():
    faces = [[v + 1 for v in f] for f in FACES]
    return ("# frustum\n" + numbers(VERTICES, "v ") + numbers(faces, "f ")).encode()


def ply():
    head = ("ply\nformat binary_big_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
            "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n")
    body = b"".join(struct.pack(">3f", *v) for v in VERTICES)
    return head.encode() + body + b"".join(struct.pack(">B4i", 4, *f) for f in FACES)


def tetgen_poly():
    vertices = [[i, *v] for i, v in enumerate(VERTICES)]
    facets = "".join(f"1 0 3\n4 {a} {b} {c} {d}\n" for a, b, c, d in FACES)
    return ("8 3 0 0\n" + numbers(vertices) + "6 1\n" + facets + "0\n0\n").encode()


def smesh():
    vertices = [[i + 1, *v] for i, v in enumerate(VERTICES)]
    facets = [[4, *(v + 1 for v in f), 3] for f in FACES]
    return ("8 3 0 0\n" + numbers(vertices) + "6 1\n" + numbers(facets) + "0\n0\n").encode()


def plc():
    return {"type": "plc", "vertices": VERTICES,
            "facets": [{"polygons": [f], "marker": 3} for f in FACES]}


FORMATS = [
    # bytes, media type as sent, name of the format, media type as sent back, ending
    (binary_stl(), "model/stl", "stl", "model/stl", ".stl"),
    (ascii_stl(), "application/sla", "stl", "model/stl", ".stl"),
    (off(), "application/octet-stream", "off", "model/vnd.off", ".off"),
    (obj(), "model/obj", "obj", "model/obj", ".obj"),
    (ply(), "application/octet-stream", "ply", "model/ply", ".ply"),
    (tetgen_poly(), "text/plain", "tetgen_poly", "text/plain", ".poly"),
    (smesh(), "application/octet-stream", "smesh", "text/plain", ".smesh"),
    (json.dumps(plc()).encode(), "application/octet-stream", "plc_json", "application/json", ".json"),
]


class SolidsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server().start()

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()

    def post(self, path, body, media_type):
        return self.server.request("POST", path, body, {"Content-Type": media_type})

    def check(self, job):
        self.assertEqual(job["state"], "succeeded", job.get("error"))
        statistics = job["statistics"]
        self.assertEqual(statistics["symmetry"]["fold"], 4)
        self.assertAlmostEqual(statistics["cell"]["volume"] * 4, VOLUME, places=6)
        self.assertNotIn("area", statistics["cell"])
        self.assertEqual(statistics["repairs"], [])
        self.assertIsNone(statistics["settings"]["min_angle"])
        self.assertEqual(statistics["settings"]["max_volume"], 0.1)

    def test_every_format_gives_the_part(self):
        for body, media_type, name, sent_back, ending in FORMATS:
            for packed in (False, True):
                with self.subTest(f"{name} {media_type} {'gzip' if packed else ''}"):
                    sent = gzip.compress(body) if packed else body
                    answer = self.post(f"/v1/jobs?{AXIS}&fold=4&max_volume=0.1", sent, media_type)
                    self.assertEqual(answer.status, 202, answer.body)
                    job = self.server.finished(answer.json()["id"])
                    self.check(job)
                    self.assertEqual(job["model"]["format"], name)
                    model = self.server.get(f"/v1/jobs/{job['id']}/model")
                    self.assertEqual(model.body, body)
                    self.assertEqual(model.headers["Content-Type"].split(";")[0], sent_back)
                    self.assertIn(ending, model.headers["Content-Disposition"])

    def test_a_plc_in_the_envelope(self):
        options = {"fold": 4, "max_volume": 0.1, "axis_origin": [0, 0, 5],
                   "axis_direction": [0, 0, -2], "radius_edge": 1.6}
        job = self.server.finished(self.server.submit(plc(), options)["id"])
        self.check(job)
        self.assertEqual(job["options"]["axis_direction"], [0, 0, -2])

    def test_symmetry_is_found(self):
        for body, media_type, name, _, _ in FORMATS:
            with self.subTest(name):
                answer = self.post("/v1/inspect", body, media_type)
                self.assertEqual(answer.status, 200, answer.body)
                found = answer.json()
                self.assertEqual(found["dimension"], 3)
                self.assertEqual(found["fold"], 4)
                self.assertTrue(found["watertight"])
                self.assertIsNone(found["problem"])

    def test_options_of_the_other_kind_are_refused(self):
        for option in ("min_angle=20", "max_area=1", "center=0,0", "axis_origin=0,0"):
            answer = self.post(f"/v1/jobs?{option}", binary_stl(), "model/stl")
            self.assertEqual(answer.status, 400, (option, answer.body))
            name = option.split("=")[0] if option != "axis_origin=0,0" else "center"
            self.assertEqual(answer.json()["errors"][0]["pointer"], f"/options/{name}")

    def test_axes_that_are_none(self):
        for direction in ("0,0,0", "nan,0,1", "0,1", "z"):
            answer = self.post(f"/v1/jobs?axis_direction={direction}", binary_stl(), "model/stl")
            self.assertEqual((answer.status, answer.json()["code"]), (400, "bad_axis"), direction)


if __name__ == "__main__":
    unittest.main()
