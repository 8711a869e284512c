"""Decks run by CalculiX: no error, no warning, and what the cell gives is what the full mesh gives.

Debian: calculix-ccx. Without it these tests are skipped."""

import json
import math
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from solver_models import interlocked, prism, ring, tilted
from symcell_server import binary

# CalculiX prints seven digits.
AGREEMENT = 1e-6
# Below this share of the largest frequency a mode is a rigid motion and its frequency rounding.
RIGID = 1e-4


def modes(text):
    """Frequencies in cycles by nodal diameter (None: of a deck without) from a .dat file; the solver
    lists each mode of a nodal diameter twice."""
    found, cyclic = {}, False
    for line in text.splitlines():
        if "E I G E N V A L U E" in line:
            rows = []
        fields = line.split()
        if re.fullmatch(r"\s+\d+(\s+\d+)?(\s+[-+.\dE]+){4}", line):
            cyclic = len(fields) == 6
            diameter = int(fields[0]) if cyclic else None
            found.setdefault(diameter, []).append(float(fields[-2]))
    return {k: sorted(v)[::2] if k is not None else sorted(v) for k, v in found.items()}


def block(deck, card):
    """The lines under a card."""
    return re.search("^" + re.escape(card) + r"\n([^*]*)", deck, re.M).group(1)


def set_of(deck, name):
    return re.findall(r"\w+", block(deck, "*NSET, NSET=" + name))


def displacements(text):
    rows = [line.split() for line in text.splitlines()]
    return {int(r[0]): [float(x) for x in r[1:]] for r in rows if len(r) == 4 and r[0].isdigit()}


@unittest.skipUnless(shutil.which("ccx"), "CalculiX is not installed (Debian: calculix-ccx)")
class CalculixTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="symcell-decks-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def mesh(self, model, *flags):
        """Decks of cell and full mesh, as text."""
        path = self.folder / "model.json"
        path.write_text(json.dumps(model))
        subprocess.run([binary(), "mesh", str(path), "-q", "--cell", str(self.folder / "cell.inp"),
                        "--full", str(self.folder / "full.inp"), *flags], check=True)
        return [(self.folder / name).read_text() for name in ("cell.inp", "full.inp")]

    def solve(self, deck):
        (self.folder / "job.inp").write_text(deck)
        (self.folder / "job.dat").unlink(missing_ok=True)
        run = subprocess.run(["ccx", "job"], cwd=self.folder, capture_output=True, text=True)
        said = run.stdout.splitlines()
        told = [i for i, line in enumerate(said) if "*ERROR" in line or "*WARNING" in line]
        self.assertFalse(told, said[told[0]:told[0] + 5] if told else "")
        self.assertIn("Job finished", run.stdout)
        return (self.folder / "job.dat").read_text()

    def check_modes(self, n, axis_inside, order, model, *flags):
        cell, full = self.mesh(model, "--fold", str(n), "--order", str(order), "--analysis", "modal",
                               *flags)
        by_diameter = modes(self.solve(cell))
        self.assertEqual(sorted(by_diameter), list(range(n // 2 + 1)))
        # More of the full mesh than a deck asks for, but no more than the solver takes.
        held = set_of(full, set_of(full, "SUPPORT")[0]) if "SUPPORT" in full else []
        freedoms = 3 * (block(full, "*NODE, NSET=NALL").count("\n") - len(held))
        wanted = min(6 * n + 10, freedoms // 5 - 1)
        known = modes(self.solve(re.sub(r"\*FREQUENCY\n\d+", f"*FREQUENCY\n{wanted}", full)))[None]
        if axis_inside:
            # CalculiX itself is off there: the deck says so.
            self.assertIn("At 1 CalculiX", cell)
            by_diameter.pop(1)
        top = known[-1]
        expected = []
        for diameter, frequencies in by_diameter.items():
            copies = 1 if diameter == 0 or 2 * diameter == n else 2
            expected += [f for f in frequencies for _ in range(copies)]
        expected = sorted(f for f in expected if RIGID * top < f < top * (1 - AGREEMENT))
        self.assertGreater(len(expected), 1)
        if axis_inside:
            for f in expected:
                self.assertTrue(any(abs(f - g) <= AGREEMENT * g for g in known), (f, known))
            return
        # Every nodal diameter was computed up to here.
        complete = min(frequencies[-1] for frequencies in by_diameter.values())
        expected = [f for f in expected if f < complete * (1 - AGREEMENT)]
        known = [f for f in known if RIGID * top < f < complete * (1 - AGREEMENT)]
        self.assertEqual(len(expected), len(known))
        for f, g in zip(expected, known):
            self.assertLessEqual(abs(f - g), AGREEMENT * g)

    def test_modes_of_cell_and_full_mesh_agree(self):
        materials = "1=steel,2=70e3/0.33/2.7e-9"
        for n in (2, 3, 4, 6, 12, 17):
            for axis_inside in (False, True):
                for order in (1, 2):
                    with self.subTest(n=n, axis_inside=axis_inside, order=order):
                        held = ["--support", "3" if axis_inside else "boundary_1"]
                        self.check_modes(n, axis_inside, order, prism(n, axis_inside),
                                         "--material", materials, *held)

    def test_the_axis_may_lie_anywhere(self):
        self.check_modes(5, False, 1, prism(5, place=tilted), "--material", "steel",
                         "--support", "boundary_1")
        self.check_modes(5, True, 1, prism(5, True, place=tilted), "--material", "steel_si",
                         "--support", "3")

    def test_nodes_of_one_radius_and_height_are_tied_apart(self):
        for order in (1, 2):
            model = interlocked(5)
            flags = ["--material", "steel", "--support", "1", "--max-edge", "0.3"]
            self.check_modes(5, False, order, model, *flags)
            cell = (self.folder / "cell.inp").read_text()
            self.assertGreater(cell.count("*CYCLIC SYMMETRY MODEL"), 1)
            self.check_statics(model, "--order", str(order), *flags[2:], "--load", "2=1")

    def static_displacements(self, deck):
        deck = deck.replace("*NODE FILE\nU\n", "*NODE PRINT, NSET=NALL\nU\n")
        return displacements(self.solve(deck))

    def check_statics(self, model, *flags):
        """Every node of the cell moves as the full mesh's node at its place."""
        decks = self.mesh(model, "--analysis", "static", "--material", "steel", *flags)
        places, moves = [], []
        for deck in decks:
            rows = [line.split(", ") for line in block(deck, "*NODE, NSET=NALL").splitlines()]
            places.append({tuple(row[1:]): int(row[0]) for row in rows})
            moves.append(self.static_displacements(deck))
        largest = max(abs(x) for move in moves[1].values() for x in move)
        self.assertGreater(largest, 0)
        for place, node in places[0].items():
            for x, y in zip(moves[0][node], moves[1][places[1][place]]):
                self.assertLessEqual(abs(x - y), 2e-6 * largest, place)

    def test_loads_that_repeat_move_the_cell_as_the_full_mesh(self):
        for n in (2, 5):
            for axis_inside in (False, True):
                for order in ("1", "2"):
                    flags = ["--fold", str(n), "--order", order, "--load", "boundary_2=3,5=1"]
                    held = "3" if axis_inside else "1"
                    for place in (lambda p: p, tilted):
                        with self.subTest(n=n, axis_inside=axis_inside, order=order):
                            self.check_statics(prism(n, axis_inside, place), *flags,
                                               "--support", held)
                    # In the plane a part with its centre needs no more than what is held.
                    with self.subTest(planar=True, n=n, axis_inside=axis_inside, order=order):
                        model = ring(n, axis_inside)
                        if axis_inside:
                            # A circle within it is held.
                            first, count = len(model["vertices"]), 2 * n
                            model["vertices"] += [[math.cos(2 * math.pi * i / count),
                                                   math.sin(2 * math.pi * i / count)]
                                                  for i in range(count)]
                            model["segments"] += [[first + i, first + (i + 1) % count, 1]
                                                  for i in range(count)]
                        self.check_statics(model, "--fold", str(n), "--order", order, "--plane",
                                           "strain", "--load", "2=1", "--support", "1")

    def test_copies_that_do_not_touch_need_no_tie(self):
        model = {"type": "plc", "vertices": [], "facets": [], "holes": [], "regions": []}
        for k in range(3):
            c, s = math.cos(2 * math.pi * k / 3), math.sin(2 * math.pi * k / 3)
            first = len(model["vertices"])
            for x, y, z in ((2, 0, 0), (3, 0, 0), (3, 1, 0), (2, 1, 0),
                            (2, 0, 1), (3, 0, 1), (3, 1, 1), (2, 1, 1)):
                model["vertices"].append([c * x - s * y, s * x + c * y, z])
            model["facets"] += [{"polygons": [[first + i for i in face]], "marker": m}
                                for m, face in enumerate(((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4),
                                             (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)), 1)]
        cell, full = self.mesh(model, "--fold", "3", "--analysis", "modal", "--material", "steel",
                               "--max-edge", "0.7", "--support", "1")
        self.assertNotIn("*TIE", cell)
        self.assertIn("do not touch", cell)
        one, three = modes(self.solve(cell))[None], modes(self.solve(full))[None]
        for i, f in enumerate(three[:9]):
            self.assertAlmostEqual(f / one[i // 3], 1, 6)

    def test_the_mesh_alone_is_read(self):
        for model in (prism(4), ring(4)):
            for order in ("1", "2"):
                for deck in self.mesh(model, "--order", order, "--material", "steel"):
                    held = "boundary_1_support" if "boundary_1_support" in deck else "boundary_1"
                    self.solve(deck + f"*BOUNDARY\n{held}, 1, {len(model['vertices'][0])}\n"
                               "*STEP\n*FREQUENCY\n2\n*END STEP\n")


class RefusalsTest(unittest.TestCase):
    """What a deck cannot hold is told before anything is written."""

    def refused(self, model, code, word, *flags):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "model.json").write_text(json.dumps(model))
            run = subprocess.run([binary(), "mesh", "model.json", "-q", *flags], cwd=folder,
                                 capture_output=True, text=True)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertIn(word, run.stderr.splitlines()[0])
            self.assertEqual([file.name for file in folder.iterdir()], ["model.json"])

    def test_wrong_usage_is_told(self):
        deck = ("--cell", "cell.inp")
        self.refused(ring(3), 2, ".inp", "--cell", "cell.vtu", "--material", "steel")
        self.refused(ring(3), 2, "material=", *deck, "--analysis", "modal")
        self.refused(ring(3), 2, "wood", *deck, "--material", "wood")
        self.refused(prism(3), 2, "boundary_1", *deck, "--material", "steel", "--analysis", "modal",
                     "--support", "rim")
        self.refused(prism(3), 2, "region 2", *deck, "--material", "1=steel")
        self.refused(prism(3), 2, "inp", "--cell", "cell.bdf", "--material", "steel", "--analysis",
                     "modal")

    def test_what_the_solver_cannot_do_is_told(self):
        steel = ("--cell", "cell.inp", "--material", "steel")
        self.refused(ring(3), 3, "plane elements", *steel, "--analysis", "modal")
        self.refused(ring(3), 3, "plane=strain", *steel, "--analysis", "static", "--support", "1",
                     "--load", "2=1")

    def test_other_outputs_of_the_run_take_no_options(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "model.json").write_text(json.dumps(prism(3)))
            subprocess.run([binary(), "mesh", "model.json", "-q", "--cell", "cell.inp", "--full",
                            "full.vtu", "--material", "steel"], cwd=folder, check=True)
            self.assertTrue((folder / "full.vtu").stat().st_size)


if __name__ == "__main__":
    unittest.main()
