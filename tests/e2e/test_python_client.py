"""The Python client against the real server; its notebook's code as well, where matplotlib is there."""

import json
import os
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

from symcell_server import ROOT, Server, long_options, square

CLIENT = ROOT / "api" / "clients" / "python"
sys.path.insert(0, str(CLIENT))
try:
    import numpy as np
    import symcell
except ImportError:
    np = symcell = None
try:
    import meshio
except ImportError:
    meshio = None

GEAR = ROOT / "docs" / "examples" / "gear.stl"
FLANGE = ROOT / "docs" / "examples" / "flange.json"


@unittest.skipUnless(np, "numpy is not installed (Debian: python3-numpy)")
class PythonClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server(workers=1).start()
        cls.url = f"http://127.0.0.1:{cls.server.port}"

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()

    def test_a_file_becomes_arrays(self):
        told = []
        mesh = symcell.mesh(GEAR, server=self.url, max_volume=10, progress=told.append)
        self.assertEqual(told[-1].fraction, 1)
        self.assertEqual(mesh.fold, 17)
        cell, full = mesh.cell, mesh.full
        self.assertEqual(cell.elements.shape, (mesh.statistics["cell"]["elements"], 4))
        self.assertEqual(len(full.points), mesh.statistics["full"]["nodes"])
        p = full.points[full.elements]
        volumes = np.einsum("ij,ij->i", np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), p[:, 3] - p[:, 0]) / 6
        self.assertGreater(volumes.min(), 0)
        self.assertAlmostEqual(volumes.sum(), 17 * mesh.statistics["cell"]["volume"], places=6)
        self.assertEqual(set(full.sector), set(range(17)))
        # Turned once about the axis the lower bound is the higher one: as far as rounding goes.
        axis, angle = cell.axis_direction, 2 * np.pi / 17
        arm = cell.points[cell.lower] - cell.axis_origin
        turned = (arm * np.cos(angle) + np.cross(axis, arm) * np.sin(angle)
                  + np.outer(arm @ axis, axis) * (1 - np.cos(angle)) + cell.axis_origin)
        self.assertLess(np.abs(turned - cell.points[cell.higher]).max(), 1e-12)

    def test_models_are_bytes_and_dictionaries_too(self):
        mesh = symcell.mesh(square(), server=self.url, max_area=0.02, order=2)
        self.assertEqual(mesh.cell.elements.shape[1], 6)
        self.assertEqual(len(mesh.full.group(1)), len(mesh.full.boundary))
        with self.assertRaises(KeyError):
            mesh.full.group("rim")
        again = symcell.mesh(json.dumps(square()).encode(), server=self.url, max_area=0.02, order=2)
        np.testing.assert_array_equal(mesh.cell.points, again.cell.points)
        self.assertEqual(symcell.inspect(FLANGE, server=self.url)["fold"], 8)

    def test_what_is_wrong_is_raised(self):
        with self.assertRaises(symcell.Problem) as refused:
            symcell.mesh(square(), server=self.url, max_volume=1)
        self.assertEqual(refused.exception.code, "bad_option")
        with self.assertRaises(symcell.JobFailed) as failed:
            symcell.mesh(square(), server=self.url, fold=3)
        self.assertEqual(failed.exception.code, "not_symmetric")

    def test_jobs_are_cancelled_and_listed(self):
        client = symcell.Client(self.url)
        job = client.submit(square(), **long_options())
        threading.Timer(0.3, job.cancel).start()
        with self.assertRaises(symcell.JobCancelled):
            job.wait()
        self.assertIn(job.id, [listed.id for listed in client.jobs()])
        job.delete()
        self.assertNotIn(job.id, [listed.id for listed in client.jobs()])

    @unittest.skipUnless(meshio, "meshio is not installed (Debian: python3-meshio)")
    def test_files_and_meshio(self):
        mesh = symcell.mesh(FLANGE, server=self.url)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "full.vtu"
            mesh.save(path, part="full")
            saved, made = meshio.read(path), mesh.full.to_meshio()
            np.testing.assert_array_equal(saved.points, made.points)
            np.testing.assert_array_equal(saved.cells_dict["triangle"], made.cells_dict["triangle"])
            mesh.save(Path(folder) / "cell.inp", material="steel")
            self.assertIn("*MATERIAL", (Path(folder) / "cell.inp").read_text().upper())

    def test_the_notebook_runs(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no matplotlib (Debian: python3-matplotlib)")
        matplotlib.use("Agg")
        notebook = json.loads((CLIENT / "notebooks" / "cell.ipynb").read_text())
        lines = "\n".join("".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code")
        done = subprocess.run([sys.executable, "-c", "import matplotlib; matplotlib.use('Agg')\n" + lines],
                              cwd=CLIENT / "notebooks", capture_output=True, text=True, check=False,
                              env={**os.environ, "SYMCELL_SERVER": self.url, "PYTHONPATH": str(CLIENT)})
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])


if __name__ == "__main__":
    unittest.main()
