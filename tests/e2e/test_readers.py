"""Files for other programs, read by those that are installed: groups, counts, areas and volumes are
those of the mesh."""

import importlib.util
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from solver_models import prism, ring
from symcell_server import binary

try:
    import meshio
except ImportError:
    meshio = None


def importable(name):
    return importlib.util.find_spec(name) is not None


def measure(points, element):
    """Length, area or volume of a simplex by its corners."""
    p = [points[i] for i in element]
    if len(p) == 2:
        return math.dist(*p)
    u, v = ([b - a for a, b in zip(p[0], q)] for q in p[1:3])
    cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    if len(p) == 3:
        return math.sqrt(sum(c * c for c in cross)) / 2
    w = [b - a for a, b in zip(p[0], p[3])]
    return sum(a * b for a, b in zip(cross, w)) / 6


class ReadersTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="symcell-readers-"))
        self.addCleanup(shutil.rmtree, self.folder)

    def files(self, model, order, *endings):
        """Cell and full mesh in these formats, with our JSON of each."""
        path = self.folder / "model.json"
        path.write_text(json.dumps(model))
        for ending in ("json", *endings):
            encoding = ["--encoding", "ascii"] if ending == "vtp" else []
            subprocess.run([binary(), "mesh", str(path), "-q", "--order", order, *encoding,
                            "--cell", str(self.folder / ("cell." + ending)),
                            "--full", str(self.folder / ("full." + ending))],
                           check=True, capture_output=True)
        for part in ("cell", "full"):
            ours = json.loads((self.folder / (part + ".json")).read_text())
            for ending in endings:
                yield ours, ending, self.folder / (part + "." + ending)

    def check(self, ours, theirs):
        dimension = ours["dimension"]
        self.assertEqual(len(theirs.points), len(ours["nodes"]))
        kinds = ("tetra", "tetra10") if dimension == 3 else ("triangle", "triangle6")
        elements = [list(row) for block in theirs.cells if block.type in kinds for row in block.data]
        self.assertEqual(len(elements), len(ours["elements"]))
        corners = dimension + 1
        whole = sum(measure(theirs.points, row[:corners]) for row in elements)
        points = [p + [0.0] * (3 - dimension) for p in ours["nodes"]]
        expected = sum(measure(points, row[:corners]) for row in ours["elements"])
        self.assertAlmostEqual(whole / expected, 1, 9)
        # Some readers number the points anew: they are known by their places.
        def place(point):
            return tuple(round(float(c), 7) + 0.0 for c in point)
        known = {place(p): i for i, p in enumerate(points)}
        self.number = [known[place(p)] for p in theirs.points]
        self.assertTrue({tuple(sorted(self.number[i] for i in row)) for row in elements} ==
                        {tuple(sorted(row)) for row in ours["elements"]})

    @unittest.skipUnless(meshio, "meshio is not installed (Debian: python3-meshio)")
    def test_meshio_reads_decks(self):
        for model in (prism(3), ring(3), prism(3, True)):
            for order in ("1", "2"):
                for ours, ending, path in self.files(model, order, "inp", "bdf"):
                    if ending == "inp" and order == "2" and model["type"] == "pslg":
                        continue  # meshio knows no CPS6
                    with self.subTest(path=path.name, order=order):
                        mesh = meshio.read(path, file_format="abaqus" if ending == "inp" else "nastran")
                        self.check(ours, mesh)
                        if ending != "inp":
                            continue
                        nodes = {n for b in ours["boundary"] if b["marker"] == 2 for n in b["nodes"]}
                        self.assertEqual({self.number[i] for i in mesh.point_sets["boundary_2"]}, nodes)

    def check_groups(self, ours, theirs):
        """Lengths, areas and volumes by group, corners only."""
        points = [p + [0.0] * (3 - ours["dimension"]) for p in ours["nodes"]]
        d, expected, found = ours["dimension"], {}, {}
        for facet in ours["boundary"]:
            name = f"boundary_{facet['marker']}"
            expected[name] = expected.get(name, 0) + measure(points, facet["nodes"][:d])
        for element, region in zip(ours["elements"], ours["regions"]):
            name = f"region_{region}"
            expected[name] = expected.get(name, 0) + measure(points, element[:d + 1])
        for side in ("lower", "higher"):
            for facet in ours[side + "_facets"] if "sector" not in ours else []:
                name = side + "_bound"
                expected[name] = expected.get(name, 0) + measure(points, facet[:d])
        names = {(int(dim), int(tag)): name for name, (tag, dim) in theirs.field_data.items()}
        for block, tags in zip(theirs.cells, theirs.cell_data["gmsh:physical"]):
            dimension = d if block.type in ("tetra", "tetra10") or d == 2 and block.type in (
                "triangle", "triangle6") else d - 1
            for row, tag in zip(block.data, tags):
                name = names[dimension, int(tag)]
                found[name] = found.get(name, 0) + measure(theirs.points, row[:dimension + 1])
        self.assertEqual(sorted(found), sorted(expected))
        for name, value in expected.items():
            self.assertAlmostEqual(found[name] / value, 1, 9, name)

    @unittest.skipUnless(meshio, "meshio is not installed (Debian: python3-meshio)")
    def test_meshio_reads_msh_of_both_versions(self):
        for model in (prism(3), ring(3)):
            for order in ("1", "2"):
                for ours, ending, path in self.files(model, order, "msh", "msh2"):
                    with self.subTest(path=path.name, order=order):
                        mesh = meshio.read(path, file_format="gmsh")
                        self.check(ours, mesh)
                        tags = [tag for tag, _ in mesh.field_data.values()]
                        self.assertEqual(len(set(tags)), len(tags))
                        self.assertEqual(mesh.field_data["boundary_2"][0], 2)
                        self.check_groups(ours, mesh)

    @unittest.skipUnless(shutil.which("gmsh"), "Gmsh is not installed (Debian: gmsh)")
    def test_gmsh_reads_msh2_and_bdf(self):
        for model in (prism(3), ring(3)):
            # Of quadratic elements Gmsh reads the corners alone from bdf.
            both = [*self.files(model, "2", "msh2"), *self.files(model, "1", "bdf")]
            for ours, ending, path in both:
                with self.subTest(path=path.name):
                    again = self.folder / "again.msh"
                    run = subprocess.run(["gmsh", "-v", "3", "-save", "-format", "msh2", "-o", str(again),
                                          str(path)], capture_output=True, text=True)
                    self.assertNotIn("Error", run.stdout + run.stderr)
                    text = again.read_text()
                    self.assertEqual(int(text.split("$Nodes\n")[1].split()[0]), len(ours["nodes"]))
                    if ending == "msh2":
                        names = path.read_text().split("$EndPhysicalNames")[0].split("$PhysicalNames")[1]
                        for name in names.splitlines()[1:]:
                            self.assertIn(name, text)

    def ask(self, code, path):
        """What a program says on a file: some print, some end the process they are in."""
        run = subprocess.run([sys.executable, "-W", "ignore", "-c", code, str(path)],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run.stdout + run.stderr

    @unittest.skipUnless(importable("netgen"), "Netgen is not installed (Debian: python3-netgen)")
    def test_netgen_knows_our_names(self):
        code = """if True:
            import sys
            from netgen.read_gmsh import ReadGmsh
            mesh = ReadGmsh(sys.argv[1][:-4])
            print("RESULT", len(mesh.Points()), len(mesh.Elements3D()),
                  *(mesh.GetBCName(i) for i in range(int(sys.argv[1][-5]))), mesh.GetMaterial(1),
                  mesh.GetMaterial(2))"""
        for ours, _, path in self.files(prism(3), "1", "msh2"):
            groups = sorted({b["marker"] for b in ours["boundary"]})
            names = (["lower_bound", "higher_bound"] if path.name.startswith("cell") else []) + [
                f"boundary_{m}" for m in groups]
            # Netgen wants the ending .msh and takes the name without it.
            renamed = path.with_name(f"{path.stem}{len(names)}.msh")
            path.rename(renamed)
            said = self.ask(code, renamed).split("RESULT ")[1].split()
            self.assertEqual(said, [str(len(ours["nodes"])), str(len(ours["elements"])), *names,
                                    "region_1", "region_2"])

    @unittest.skipUnless(importable("getfem"), "GetFEM is not installed (Debian: python3-getfem)")
    def test_getfem_reads_without_a_message(self):
        code = """if True:
            import sys, getfem
            mesh = getfem.Mesh("import", "gmsh", sys.argv[1])
            print("RESULT", mesh.nbpts(), *mesh.regions())"""
        for model in (prism(3), ring(3)):
            for order in ("1", "2"):
                for ours, _, path in self.files(model, order, "msh2"):
                    said = self.ask(code, path)
                    self.assertTrue(said.startswith("RESULT "), said)
                    tags = said.split()[2:]
                    self.assertEqual(int(said.split()[1]), len(ours["nodes"]))
                    expected = {b["marker"] for b in ours["boundary"]} | set(ours["regions"])
                    self.assertGreaterEqual(len(set(tags)), len(expected))

    @unittest.skipUnless(importable("vtk"), "VTK is not installed (Debian: python3-vtk9)")
    def test_vtk_measures_the_sides(self):
        code = """if True:
            import sys, vtk
            reader = vtk.vtkXMLPolyDataReader()
            reader.SetFileName(sys.argv[1])
            reader.Update()
            data = reader.GetOutput()
            side, areas = data.GetCellData().GetArray("side"), [0.0] * 4
            for i in range(data.GetNumberOfCells()):
                areas[int(side.GetValue(i))] += data.GetCell(i).ComputeArea()
            print("RESULT", data.GetNumberOfPoints(), *areas)"""
        for order in ("1", "2"):
            areas = {}
            for ours, _, path in self.files(prism(3), order, "vtp"):
                said = self.ask(code, path).split("RESULT ")[1].split()
                self.assertEqual(int(said[0]), len(ours["nodes"]))
                areas[path.stem] = [float(a) for a in said[1:]]
            self.assertAlmostEqual(areas["cell"][1], areas["cell"][2], 9)
            self.assertEqual(areas["full"][1:3], [0, 0])
            for side in (0, 3):
                self.assertAlmostEqual(3 * areas["cell"][side], areas["full"][side], 9)


if __name__ == "__main__":
    unittest.main()
