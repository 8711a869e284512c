#!/usr/bin/python3
"""Runs `symcell verify` and meshcheck.py, which share no code, on good and on damaged meshes.

    verify_agrees.py --symcell BINARY [--models p2_04,...] [--jobs N]

Models of the corpus beside the source tree are meshed and their VTU files damaged in one way at a
time. Wherever meshcheck.py fails, verify must fail; wherever both meshes are as the mesher made
them, both must agree. Damage that neither sees is reported. Exit code 77: skipped.
"""

import argparse
import concurrent.futures
import importlib.util
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import warnings

from run_corpus import SHARED, SKIPPED, run

CHECKER = SHARED / "tools" / "meshcheck.py"
# Model, options of the mesher: plane and solid, axis inside and not, fold 1 and 2, quadratic,
# regions, parts, surfaces; and models that the mesher may get wrong.
CASES = [
    ("2d/p2_04_flange_n8_offcentre.json", []),
    ("2d/p2_06_motor_materials_n6.json", ["--order", "2"]),
    ("2d/p2_05_four_pads_disjoint_n4.json", []),
    ("2d/p2_08_yinyang_n2_segment_through_centre.json", ["--fold", "1"]),
    ("3d/p3_01_hexnut_n6.json", []),
    ("3d/p3_04_three_materials_n8.json", []),
    ("3d/p3_05_four_blocks_n4_small1e-3.json", []),
    ("3d/p3_08_box_baffles_n2.json", ["--order", "2"]),
    ("3d/p3_06_cube_n3_body_diagonal.json", []),
    ("3d/p3_02_starprism_n5_tip12deg.json", ["--fold", "1"]),
    ("3d/r3_03_bracket_n4.stl", []),
    ("csg/box_one_tab.off", []),
]
CSG = "csg"


def load(path, name):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


# ---------------------------------------------------------------------------- meshes as Python has them
class Mesh:
    """Points, elements and attributes of a VTU file, as lists that damage may change."""

    def __init__(self, vtu):
        self.points = vtu.P.tolist()
        self.elements = vtu.conn.tolist()
        self.kind, self.dim = vtu.kind, vtu.dim
        self.corners = vtu.dim + 1
        self.edges = [tuple(e) for e in vtu.mid_edges]
        self.point_data = {k: v.tolist() for k, v in vtu.point_data.items()}
        self.cell_data = {k: v.tolist() for k, v in vtu.cell_data.items()}
        self.field = {k: v.ravel().tolist() for k, v in vtu.field.items()}

    def write(self, path):
        def array(name, values, kind, components=1):
            text = " ".join(repr(float(v)) if kind == "Float64" else str(int(v)) for v in values)
            return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
                    f'NumberOfTuples="{len(values) // components}" format="ascii">{text}</DataArray>')
        flat = [c for p in self.points for c in p]
        nodes = [n for e in self.elements for n in e]
        k = len(self.elements[0])
        lines = ['<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" '
                 'header_type="UInt64"><UnstructuredGrid><FieldData>',
                 array("fold", self.field["fold"], "Int32")]
        lines += [array(name, self.field[name], "Float64", 3)
                  for name in ("axis_origin", "axis_direction")]
        lines += [f'</FieldData><Piece NumberOfPoints="{len(self.points)}" '
                  f'NumberOfCells="{len(self.elements)}"><PointData>']
        lines += [array(name, v, "Int32") for name, v in self.point_data.items()
                  if len(v) == len(self.points) and not isinstance(v[0], list)]
        lines += ["</PointData><CellData>"]
        lines += [array(name, v, "Int32") for name, v in self.cell_data.items()
                  if not isinstance(v[0], list) and isinstance(v[0], int)]
        lines += ["</CellData><Points>", array("Points", flat, "Float64", 3), "</Points><Cells>",
                  array("connectivity", nodes, "Int32"),
                  array("offsets", [k * (i + 1) for i in range(len(self.elements))], "Int32"),
                  array("types", [self.kind] * len(self.elements), "UInt8"),
                  "</Cells></Piece></UnstructuredGrid></VTKFile>"]
        path.write_text("\n".join(lines))

    def add_point(self, p):
        self.points.append(list(p))
        for v in self.point_data.values():
            v.append(-1)
        return len(self.points) - 1

    def remove(self, elements):
        gone = set(elements)
        keep = [i for i in range(len(self.elements)) if i not in gone]
        self.elements = [self.elements[i] for i in keep]
        for name, v in self.cell_data.items():
            self.cell_data[name] = [v[i] for i in keep]
        self.drop_unused()

    def drop_unused(self):
        used = sorted({n for e in self.elements for n in e})
        new = {n: i for i, n in enumerate(used)}
        self.points = [self.points[n] for n in used]
        self.elements = [[new[n] for n in e] for e in self.elements]
        for name, v in self.point_data.items():
            kept = [v[n] for n in used]
            if name == "lower_to_higher":
                kept = [new.get(j, -1) for j in kept]
            self.point_data[name] = kept

    def pairs(self):
        return [i for i, j in enumerate(self.point_data.get("lower_to_higher", [])) if j >= 0]

    def of_node(self, node):
        return [i for i, e in enumerate(self.elements) if node in e]

    def boundary_nodes(self):
        faces = {}
        for e in self.elements:
            for i in range(self.corners):
                key = tuple(sorted(e[:self.corners][:i] + e[:self.corners][i + 1:]))
                faces[key] = faces.get(key, 0) + 1
        return {n for face, count in faces.items() if count == 1 for n in face}


# ------------------------------------------------------------------------------------------- damage
def node_moved(cell, full, rng, by):
    which = rng.randrange(len(full.points))
    size = max(abs(c) for p in full.points for c in p)
    full.points[which][rng.randrange(full.dim)] += by * size


def both(change):
    """The same change to cell and full mesh, for fold 1 only, where they are one."""
    def damage(cell, full, rng):
        if full.field["fold"][0] != 1:
            return False
        state = rng.getstate()
        change(cell, rng)
        rng.setstate(state)
        change(full, rng)
        full.cell_data["cell_element"] = list(range(len(full.elements)))
        full.cell_data["sector"] = [0] * len(full.elements)
        return True
    return damage


def crack(mesh, rng):
    """An element is divided at the middle of a facet, its neighbour not: a hanging node."""
    if mesh.edges:
        return
    inner = set(range(len(mesh.points))) - mesh.boundary_nodes()
    best = max(range(len(mesh.elements)), key=lambda i: (len(inner & set(mesh.elements[i])), rng.random()))
    nodes = mesh.elements[best]
    opposite = next((i for i, n in enumerate(nodes) if n not in inner), rng.randrange(mesh.corners))
    face = [n for i, n in enumerate(nodes) if i != opposite]
    middle = mesh.add_point([sum(mesh.points[n][c] for n in face) / len(face) for c in range(3)])
    parts = [[middle if m == n else m for m in nodes] for n in face]
    mesh.elements[best] = parts[0]
    for part in parts[1:]:
        mesh.elements.append(part)
        for v in mesh.cell_data.values():
            v.append(v[best])


def hole(mesh, rng):
    mesh.remove([rng.randrange(len(mesh.elements))])


def cavity(mesh, rng):
    inner = sorted(set(n for e in mesh.elements for n in e[:mesh.corners]) - mesh.boundary_nodes())
    if inner:
        mesh.remove(mesh.of_node(rng.choice(inner)))


def slit(mesh, rng):
    """Half of the elements at a node get a node of their own beside it."""
    node = rng.choice(mesh.elements[rng.randrange(len(mesh.elements))][:mesh.corners])
    own = mesh.of_node(node)
    if len(own) < 2:
        return
    other = mesh.add_point(mesh.points[node])
    for i in own[:len(own) // 2]:
        mesh.elements[i] = [other if n == node else n for n in mesh.elements[i]]


def pair_lost(cell, full, rng):
    cell.point_data["lower_to_higher"][rng.choice(cell.pairs())] = -1


def pairs_swapped(cell, full, rng):
    pairs = cell.point_data["lower_to_higher"]
    low = cell.pairs()
    if len(low) < 2:
        return False
    i, j = rng.sample(low, 2)
    pairs[i], pairs[j] = pairs[j], pairs[i]
    return True


def pair_made_up(cell, full, rng):
    pairs = cell.point_data["lower_to_higher"]
    free = [i for i, j in enumerate(pairs) if j < 0]
    pairs[rng.choice(free)] = rng.randrange(len(pairs))


def all_pairs_lost(cell, full, rng):
    cell.point_data["lower_to_higher"] = [-1] * len(cell.points)


def element_turned(cell, full, rng):
    e = full.elements[rng.randrange(len(full.elements))]
    e[0], e[1] = e[1], e[0]


def element_twice(cell, full, rng):
    full.elements.append(list(full.elements[0]))
    for v in full.cell_data.values():
        v.append(v[0])


def cell_element_lost(cell, full, rng):
    hole(cell, rng)


def element_lost_everywhere(cell, full, rng):
    """One element and all its copies: the cell and the full mesh agree."""
    lost = rng.randrange(len(cell.elements))
    gone = [i for i, c in enumerate(full.cell_data["cell_element"]) if c == lost]
    cell.remove([lost])
    full.remove(gone)
    full.cell_data["cell_element"] = [c - (c > lost) for c in full.cell_data["cell_element"]]


def sector_lost(cell, full, rng):
    full.remove([i for i, s in enumerate(full.cell_data["sector"]) if s == 0])


def region_changed(cell, full, rng):
    full.cell_data["region"][rng.randrange(len(full.elements))] += 5


def region_changed_everywhere(cell, full, rng):
    which = rng.randrange(len(cell.elements))
    cell.cell_data["region"][which] += 5
    for i, c in enumerate(full.cell_data["cell_element"]):
        if c == which:
            full.cell_data["region"][i] += 5


def sector_misnamed(cell, full, rng):
    full.cell_data["sector"][0] = full.cell_data["sector"][0] + 1


def unused_node(cell, full, rng):
    full.add_point(full.points[0][:2] + [full.points[0][2]])


def mid_node_moved(cell, full, rng):
    if not full.edges:
        return False
    e = full.elements[rng.randrange(len(full.elements))]
    a, b = full.edges[0]
    node, step = e[full.corners], 0.01
    full.points[node] = [m + step * (full.points[e[b]][i] - full.points[e[a]][i])
                         for i, m in enumerate(full.points[node])]
    return True


def mid_node_own(cell, full, rng):
    if not full.edges:
        return False
    e = full.elements[rng.randrange(len(full.elements))]
    e[full.corners] = full.add_point([c + 1e-7 for c in full.points[e[full.corners]]])
    return True


def moved_out(cell, full, rng):
    """A boundary node that every copy moves by: symmetric, but off the model."""
    inner = sorted(cell.boundary_nodes())
    pairs = cell.point_data["lower_to_higher"]
    free = [n for n in inner if pairs[n] < 0 and n not in pairs]
    if not free:
        return False
    node = rng.choice(free)
    origin, direction = cell.field["axis_origin"], cell.field["axis_direction"]
    step = 1e-4 * max(abs(c - o) for p in cell.points for c, o in zip(p, origin))
    at = tuple(cell.points[node])
    along = sum((c - o) * d for c, o, d in zip(at, origin, direction))
    out = [c - o - along * d for c, o, d in zip(at, origin, direction)]
    size = sum(c * c for c in out) ** 0.5
    factor = 1 + step / size
    def pushed(p):
        a = sum((c - o) * d for c, o, d in zip(p, origin, direction))
        return [o + a * d + factor * (c - o - a * d) for c, o, d in zip(p, origin, direction)]
    moved = set()
    for i, c in enumerate(full.cell_data["cell_element"]):
        for a, b in zip(cell.elements[c], full.elements[i]):
            if a == node:
                moved.add(b)
    for n in moved:
        full.points[n] = pushed(full.points[n])
    cell.points[node] = pushed(cell.points[node])
    return True


DAMAGE = {
    "none": lambda cell, full, rng: None,
    "node moved by 1e-6": lambda c, f, r: node_moved(c, f, r, 1e-6),
    "node moved by 1e-8": lambda c, f, r: node_moved(c, f, r, 1e-8),
    "crack": both(crack), "hole": both(hole), "cavity": both(cavity), "slit": both(slit),
    "pair lost": pair_lost, "pairs swapped": pairs_swapped, "pair made up": pair_made_up,
    "all pairs lost": all_pairs_lost, "element turned": element_turned,
    "element twice": element_twice, "cell element lost": cell_element_lost,
    "element lost everywhere": element_lost_everywhere, "sector lost": sector_lost,
    "region changed": region_changed, "region changed everywhere": region_changed_everywhere,
    "sector misnamed": sector_misnamed, "unused node": unused_node,
    "mid node moved": mid_node_moved, "mid node of its own": mid_node_own,
    "moved off the model": moved_out,
}
# Damage to pairs, where there are none.
NEEDS_PAIRS = {"pair lost", "pairs swapped", "all pairs lost"}


# ------------------------------------------------------------------------------------------- running
def verdicts(symcell, meshcheck, folder, model):
    """(whether meshcheck.py passes, whether verify does, what both reported)."""
    files = [str(folder / "cell.vtu"), "--full", str(folder / "full.vtu"), "--model", str(model)]
    try:
        theirs = meshcheck.verify(meshcheck.parser().parse_args(files)).failed()
    except Exception as error:  # a mesh that breaks the checker is no good mesh
        theirs = [repr(error)]
    ours = run([symcell, "verify", *files, "-q"], 600)
    text = f"meshcheck.py: {', '.join(theirs)}; verify: {ours.stdout.strip()[:300]}"
    return not theirs, ours.returncode == 0, text + ours.stderr.strip()[:200]


def look_at(symcell, meshcheck, model, options, names):
    """Findings of one model: list of (damage, what is wrong)."""
    findings, unseen, looked = [], [], 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        made = run([symcell, "mesh", model, "--cell", folder / "cell.vtu",
                    "--full", folder / "full.vtu"] + options, 900)
        if made.returncode != 0:
            return [], [], 0, f"no mesh: {made.stderr.strip().splitlines()[:1]}"
        good = verdicts(symcell, meshcheck, folder, model)
        if good[0] != good[1]:
            findings.append(("none", good[2]))
        cell, full = (meshcheck.read_vtu(folder / f) for f in ("cell.vtu", "full.vtu"))
        for index, (what, damage) in enumerate(DAMAGE.items()):
            if what not in names:
                continue
            c, f, rng = Mesh(cell), Mesh(full), random.Random(index)
            if what in NEEDS_PAIRS and not c.pairs():
                continue
            if damage(c, f, rng) is False or not c.elements or not f.elements:
                continue
            damaged = folder / "damaged"
            damaged.mkdir(exist_ok=True)
            c.write(damaged / "cell.vtu")
            f.write(damaged / "full.vtu")
            theirs, ours, text = verdicts(symcell, meshcheck, damaged, model)
            looked += 1
            if ours and not theirs:
                findings.append((what, "only meshcheck.py fails: " + text))
            if ours and theirs and what != "none" and good[0]:
                unseen.append(what)
            if what == "none" and ours != good[1]:
                findings.append((what, "written again, the mesh is judged otherwise: " + text))
    return findings, unseen, looked, ""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--symcell", required=True)
    parser.add_argument("--models", default="")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    if not CHECKER.exists():
        print(f"skipped: there is no {CHECKER}")
        return SKIPPED
    if any(importlib.util.find_spec(m) is None for m in ("numpy", "scipy")):
        print("skipped: meshcheck.py needs numpy and scipy")
        return SKIPPED
    meshcheck = load(CHECKER, "meshcheck")
    warnings.simplefilter("ignore")  # divisions by zero at damaged elements
    cases = [(SHARED / "corpus" / file, options, list(DAMAGE)) for file, options in CASES]
    for path in sorted((SHARED / "corpus" / CSG).glob("*")):
        cases.append((path, ["--fold", "1"] if "fold1" in path.name else [], []))
    wanted = arguments.models.split(",")
    cases = [c for c in cases if any(c[0].name.startswith(w) for w in wanted)]
    failed = total = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        jobs = [(c, pool.submit(look_at, arguments.symcell, meshcheck, *c)) for c in cases]
        for (model, options, _), job in jobs:
            findings, unseen, looked, remark = job.result()
            total += looked + 1
            print(f"{model.name} {' '.join(options)}: {looked} damaged meshes"
                  + (f"; neither sees: {', '.join(unseen)}" if unseen else "")
                  + (f"; {remark}" if remark else ""), flush=True)
            for what, text in findings:
                failed += 1
                print(f"  FAILED {what}: {text}")
    print(f"{total} meshes, {failed} disagreements")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
