"""What is made to be looked at: GLB by Khronos' validator, packed JSON by node."""

import json
import subprocess
import tempfile
import unittest
from pathlib import Path

import npm_packages
from symcell_server import ROOT, binary

EXAMPLES = ROOT / "docs" / "examples"


def mesh(model, *arguments):
    subprocess.run([binary(), "mesh", "--quiet", model, *arguments], check=True, capture_output=True)


class GlbTest(unittest.TestCase):
    def test_a_validator_finds_no_fault(self):
        packages = npm_packages.installed("tests/page")
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for model in ("gear.stl", "motor.json", "hexnut.json"):
                for order in ("1", "2"):
                    cell, full = (Path(folder) / f"{model}-{order}-{part}.glb" for part in ("cell", "full"))
                    mesh(EXAMPLES / model, "--order", order, "--cell", cell, "--full", full)
                    files += [cell, full]
            done = subprocess.run(["node", packages / "validate_glb.mjs", *files], check=True,
                                  capture_output=True, text=True)
            self.assertEqual(json.loads(done.stdout), {str(file): [] for file in files})


class PackedJsonTest(unittest.TestCase):
    def test_it_is_small(self):
        with tempfile.TemporaryDirectory() as folder:
            sizes = {}
            for packed in ("false", "true", "exact"):
                file = Path(folder) / f"{packed}.json"
                mesh(EXAMPLES / "flange.json", "--max-area", "0.02", "--packed", packed, "--cell", file)
                sizes[packed] = file.stat().st_size
            # 41 bytes a triangle as text become 18 and 24.
            self.assertLess(sizes["true"], 0.46 * sizes["false"], sizes)
            self.assertLess(sizes["exact"], 0.6 * sizes["false"], sizes)


if __name__ == "__main__":
    unittest.main()
