"""The pages in a browser (tests/page/page_test.mjs), and what was downloaded there in programs that read meshes."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import npm_packages
from symcell_server import ROOT, Server
from test_access import keys

try:
    import meshio
except ImportError:
    meshio = None

# Some 40 s on two free processors, several times that where others are at work.
NODE_TIMEOUT_S = 840


class PageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.chromium = shutil.which("chromium")
        if not cls.chromium:
            raise unittest.SkipTest("no chromium (Debian: chromium)")
        cls.packages = npm_packages.installed("tests/page")
        cls.server = Server(workers=2).start()
        if "assets/" not in cls.server.get("/").text():
            cls.server.remove()
            raise unittest.SkipTest("the program was built without its pages (npm was missing)")
        cls.shared = Server(workers=1, cors_origin="*").start()
        cls.locked = Server(workers=1)
        cls.key = keys(cls.locked, "create", "--name", "page")
        cls.locked.start()

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()
        cls.shared.remove()
        cls.locked.remove()

    def test_people_come_to_their_meshes(self):
        with tempfile.TemporaryDirectory() as downloads:
            environment = {**os.environ, "SYMCELL_URL": f"http://127.0.0.1:{self.server.port}",
                           "SYMCELL_SHARED_URL": f"http://127.0.0.1:{self.shared.port}",
                           "SYMCELL_LOCKED_URL": f"http://127.0.0.1:{self.locked.port}",
                           "SYMCELL_KEY_TEXT": self.key, "SYMCELL_CHROMIUM": self.chromium, "SYMCELL_DOWNLOADS": downloads,
                           "SYMCELL_GEAR": str(ROOT / "docs" / "examples" / "gear.stl"),
                           "SYMCELL_FLANGE": str(ROOT / "docs" / "examples" / "flange.json")}
            done = subprocess.run(["node", "--test", "--test-reporter=spec", "page_test.mjs"], cwd=self.packages,
                                  env=environment, capture_output=True, text=True, timeout=NODE_TIMEOUT_S,
                                  check=False)
            print(done.stdout)
            self.assertEqual(done.returncode, 0, done.stdout[-6000:] + done.stderr[-2000:])
            self.read_downloads(Path(downloads))

    def read_downloads(self, folder):
        """Others read what was downloaded, and find as many tetrahedra in every format."""
        if meshio is None:
            self.skipTest("no meshio (Debian: python3-meshio)")
        for part in ("cell", "full"):
            counts = {}
            for ending in ("vtu", "msh", "inp"):
                mesh = meshio.read(folder / f"{part}.{ending}")
                counts[ending] = sum(len(block.data) for block in mesh.cells if block.type == "tetra")
            self.assertEqual(len(set(counts.values())), 1, counts)
            self.assertGreater(counts["vtu"], 100)
            self.assertGreater(len(meshio.read(folder / f"{part}.stl").cells[0].data), 100)


if __name__ == "__main__":
    unittest.main()
