#!/usr/bin/env python3
"""What meshes are worth to a solver: frequencies of two parts by CalculiX, written to docs/analysis.md.

    /usr/bin/python3 tests/bench/analysis.py [SYMCELL]

Of each part a sector cut by planes is meshed by Gmsh (M1, as it is done by hand), and the part by symcell: a
cell at the same largest edge, one at M1's count of nodes, and the full mesh of the first. All are quadratic, and are
compared with the mean of a fine sector of Gmsh's and a fine cell. Needs gmsh, ccx, python3-meshio, python3-numpy and
python3-matplotlib; SYMCELL (build/release/symcell) must read STEP.
"""

import json
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import meshio
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SYMCELL = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build/release/symcell")
STEEL = (210000.0, 0.3, 7.85e-9)  # MPa, 1, t/mm3
PART_NAMES = {"disc6": "Disc of six holes", "ring12": "Ring of twelve scallops"}

# Gmsh's OpenCASCADE: volume 1 is the part, about z; the bore is held.
PARTS = {
    "disc6": dict(fold=6, bore=10, edge=5.0, fine=2.2, geo="""
Cylinder(1) = {0,0,0, 0,0,10, 50};
Cylinder(2) = {0,0,-1, 0,0,12, 10};
holes() = {2};
For k In {0:5}
  v = newv; Cylinder(v) = {30*Cos(k*Pi/3),30*Sin(k*Pi/3),-1, 0,0,12, 6}; holes() += {v};
EndFor
BooleanDifference(1000) = { Volume{1}; Delete; }{ Volume{holes()}; Delete; };
"""),
    "ring12": dict(fold=12, bore=25, edge=5.0, fine=2.2, geo="""
Cylinder(1) = {0,0,0, 0,0,8, 60};
Cylinder(2) = {0,0,8, 0,0,12, 38};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {0,0,-1, 0,0,30, 25};
holes() = {4};
For k In {0:11}
  v = newv; Cylinder(v) = {60*Cos(k*Pi/6),60*Sin(k*Pi/6),-1, 0,0,10, 7}; holes() += {v};
EndFor
BooleanDifference(1000) = { Volume{3}; Delete; }{ Volume{holes()}; Delete; };
"""),
}


def run(command, folder, log):
    begin = time.monotonic()
    done = subprocess.run([str(c) for c in command], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{log}: {' '.join(map(str, command))}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    return time.monotonic() - begin, done.stdout


def write_step(part, folder):
    geo = 'SetFactory("OpenCASCADE");\n' + PARTS[part]["geo"]
    (folder / f"{part}.geo").write_text(geo + f'Save "{part}.step";\n')
    run(["gmsh", "-0", f"{part}.geo", "-o", f"{part}.step", "-format", "step"], folder, part)
    return folder / f"{part}.step"


def planar_sector(part, edge, folder, name):
    """A quadratic sector by Gmsh with bounds that match; its time."""
    fold = PARTS[part]["fold"]
    half = math.pi / fold
    wedge = f"""
// Half a sector on both sides of the x axis: holes and scallops are not cut.
Point(9001) = {{0,0,-5}};
Point(9002) = {{200*Cos({half}),-200*Sin({half}),-5}};
Point(9003) = {{200*Cos({half}),200*Sin({half}),-5}};
Line(9001) = {{9001,9002}}; Line(9002) = {{9002,9003}}; Line(9003) = {{9003,9001}};
Curve Loop(9001) = {{9001,9002,9003}}; Plane Surface(9001) = {{9001}};
w() = Extrude {{0,0,60}} {{ Surface{{9001}}; }};
BooleanIntersection(2000) = {{ Volume{{1000}}; Delete; }}{{ Volume{{w(1)}}; Delete; }};
e = 1e-3;
lower() = {{}}; higher() = {{}};
s() = Boundary {{ Volume{{2000}}; }};
For i In {{0:#s()-1}}
  b() = BoundingBox Surface{{Abs(s(i))}};
  // A bound runs through the origin's direction: its box has the ratio of the angle.
  If (Abs(b(0)*Sin({half})+b(4)*Cos({half})) < 1e-4 && Abs(b(3)*Sin({half})+b(1)*Cos({half})) < 1e-4)
    lower() += {{Abs(s(i))}};
  EndIf
  If (Abs(b(0)*Sin({half})-b(1)*Cos({half})) < 1e-4 && Abs(b(3)*Sin({half})-b(4)*Cos({half})) < 1e-4)
    higher() += {{Abs(s(i))}};
  EndIf
EndFor
Periodic Surface {{higher()}} = {{lower()}} Rotate {{ {{0,0,1}}, {{0,0,0}}, {2 * half} }};
Physical Volume(1) = {{2000}};
Physical Surface(2) = {{lower()}};
Physical Surface(3) = {{higher()}};
Mesh.CharacteristicLengthMax = {edge};
Mesh.CharacteristicLengthFromCurvature = 1;
Mesh.MinimumElementsPerTwoPi = 16;
Mesh.ElementOrder = 2;
Mesh.HighOrderOptimize = 1;
Mesh.Optimize = 1;
Mesh.SaveAll = 0;
"""
    geo = 'SetFactory("OpenCASCADE");\n' + PARTS[part]["geo"] + wedge
    (folder / f"{name}.geo").write_text(geo)
    seconds, _ = run(["gmsh", "-3", f"{name}.geo", "-format", "msh22", "-o", f"{name}.msh"], folder, name)
    return folder / f"{name}.msh", seconds


def deck_of_sector(part, path, diameters):
    """CalculiX's deck of a sector of Gmsh's."""
    mesh = meshio.read(path)
    fold, bore = PARTS[part]["fold"], PARTS[part]["bore"]
    tets = np.vstack([c.data for c in mesh.cells if c.type == "tetra10"])
    used = np.unique(tets)
    number = np.zeros(len(mesh.points), int)
    number[used] = np.arange(1, len(used) + 1)
    points = mesh.points
    sides = {2: set(), 3: set()}
    for cells, tags in zip(mesh.cells, mesh.cell_data["gmsh:physical"]):
        if cells.type != "triangle6":
            continue
        for triangle, tag in zip(cells.data, tags):
            sides[int(tag)].update(triangle.tolist())
    r = np.hypot(points[:, 0], points[:, 1])
    held = [n for n in used if abs(r[n] - bore) < 1e-4 and n not in sides[2]]
    out = ["*NODE, NSET=NALL"]
    out += [f"{number[n]},{points[n][0]:.13e},{points[n][1]:.13e},{points[n][2]:.13e}" for n in used]
    out.append("*ELEMENT, TYPE=C3D10, ELSET=EALL")
    for i, t in enumerate(tets):
        n = [str(number[v]) for v in t]
        out += [f"{i + 1}," + ",".join(n[:8]) + ",", ",".join(n[8:])]
    for name, side in (("L", 2), ("R", 3)):
        out.append(f"*SURFACE, NAME={name}, TYPE=NODE")
        out += [str(number[n]) for n in sorted(sides[side])]
    out.append("*NSET, NSET=HELD")
    out += [str(number[n]) for n in held]
    e, nu, rho = STEEL
    out += ["*MATERIAL, NAME=STEEL", "*ELASTIC", f"{e},{nu}", "*DENSITY", f"{rho}",
            "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL", "*BOUNDARY", "HELD,1,3",
            "*TIE, CYCLIC SYMMETRY, NAME=T, POSITION TOLERANCE=1e-3", "L,R",
            f"*CYCLIC SYMMETRY MODEL, N={fold}, TIE=T, ELSET=EALL", "0.,0.,0.,0.,0.,1.",
            "*STEP", "*FREQUENCY", "8", f"*SELECT CYCLIC SYMMETRY MODES, NMIN=0, NMAX={diameters}",
            "*NODE FILE", "U", "*END STEP"]
    return "\n".join(out) + "\n", len(used), len(tets)


def frequencies(text):
    """By nodal diameter, each mode once; None for a deck without."""
    found = {}
    for line in text.splitlines():
        if re.fullmatch(r"\s+\d+(\s+\d+)?(\s+[-+.\dE]+){4}", line):
            fields = line.split()
            found.setdefault(int(fields[0]) if len(fields) == 6 else None, []).append(float(fields[-2]))
    return {k: sorted(v)[::2] if k is not None else sorted(v) for k, v in found.items()}


def solve(deck, folder, name):
    (folder / f"{name}.inp").write_text(deck)
    seconds, said = run(["ccx", name], folder, name)
    if "*ERROR" in said:
        raise RuntimeError(said[said.index("*ERROR"):][:400])
    return frequencies((folder / f"{name}.dat").read_text()), seconds


def cell_of(step, folder, name, flags, full=False):
    """Deck(s) of symcell's, statistics and the time."""
    outputs = ["--cell", f"{name}.inp", "--stats", f"{name}.json"]
    if full:
        outputs += ["--full", f"{name}_full.inp"]
    seconds, _ = run([SYMCELL, "mesh", step, "-q", "--order", "2", "--analysis", "modal", "--material", "steel",
                      "--support", "bore", *outputs, *flags], folder, name)
    return json.loads((folder / f"{name}.json").read_text()), seconds


def lowest(found, count=6, diameters=None):
    """The lowest distinct modes: (diameter, order within it)."""
    all_modes = [(f, k, i) for k, fs in found.items() for i, f in enumerate(fs)
                 if diameters is None or k in diameters]
    return [(k, i) for _, k, i in sorted(all_modes)[:count]]


def part_tables(part, folder):
    p = PARTS[part]
    fold = p["fold"]
    top = fold // 2
    step = write_step(part, folder)
    rows = []

    def deck_text(name):
        text = (folder / f"{name}.inp").read_text()
        return re.sub(r"(\*FREQUENCY\n)\d+", r"\g<1>8", text)

    # The reference: what a fine sector and a fine cell agree on.
    fine, _ = planar_sector(part, p["fine"], folder, f"{part}_fine")
    deck, fine_nodes, _ = deck_of_sector(part, fine, top)
    fine_sector, _ = solve(deck, folder, f"{part}_fine")
    statistics, _ = cell_of(step, folder, f"{part}_ref", ["--fold", str(fold), "--max-edge", str(p["fine"])])
    fine_cell, _ = solve(deck_text(f"{part}_ref"), folder, f"{part}_ref")
    wanted = lowest(fine_sector)
    reference = {m: (fine_sector[m[0]][m[1]] + fine_cell[m[0]][m[1]]) / 2 for m in wanted}
    apart = max(abs(fine_sector[k][i] / fine_cell[k][i] - 1) for k, i in wanted)

    def add(label, nodes, elements, found, mesher, solver):
        errors = [abs(found[k][i] / reference[k, i] - 1) for k, i in wanted]
        rows.append((label, nodes, elements, [found[k][i] for k, i in wanted], max(errors),
                     sum(errors) / len(errors), mesher, solver))

    sector, mesher = planar_sector(part, p["edge"], folder, f"{part}_m1")
    deck, nodes, elements = deck_of_sector(part, sector, top)
    found, solver = solve(deck, folder, f"{part}_m1")
    add("M1: sector by Gmsh", nodes, elements, found, mesher, solver)

    statistics, mesher = cell_of(step, folder, f"{part}_cell", ["--fold", str(fold), "--max-edge", str(p["edge"])], True)
    found, solver = solve(deck_text(f"{part}_cell"), folder, f"{part}_cell")
    add("cell, same largest edge", statistics["cell"]["nodes"], statistics["cell"]["elements"], found, mesher, solver)

    same, mesher_same = cell_of(step, folder, f"{part}_same",
                                ["--fold", str(fold), "--elements", str(elements), "--chord-error", "0.02"])
    found, solver_same = solve(deck_text(f"{part}_same"), folder, f"{part}_same")
    add("cell, M1's count of elements", same["cell"]["nodes"], same["cell"]["elements"], found, mesher_same, solver_same)

    text = (folder / f"{part}_cell_full.inp").read_text()
    text = re.sub(r"(\*FREQUENCY\n)\d+", r"\g<1>30", text)
    full, solver_full = solve(text, folder, f"{part}_cell_full")
    # The full mesh does not say which diameter: the nearest to the cell's is meant.
    by_cell = frequencies((folder / f"{part}_cell.dat").read_text())
    nearest = {}
    for k, i in wanted:
        nearest.setdefault(k, {})[i] = min(full[None], key=lambda f: abs(f - by_cell[k][i]))
    add("full mesh of the first cell", statistics["full"]["nodes"], statistics["full"]["elements"], nearest, mesher,
        solver_full)
    return rows, wanted, [reference[m] for m in wanted], apart, (fine_nodes, top)


def draw_mode(folder, part, target):
    """A mode of nodal diameter 2 on the full part, by symcell transfer and matplotlib."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    name = f"{part}_mode"
    step = folder / f"{part}.step"
    run([SYMCELL, "mesh", step, "-q", "--order", "1", "--fold", PARTS[part]["fold"], "--max-edge", PARTS[part]["edge"],
         "--cell", f"{name}.inp", "--analysis", "modal", "--material", "steel", "--support", "bore"], folder, name)
    run([SYMCELL, "mesh", step, "-q", "--order", "1", "--fold", PARTS[part]["fold"], "--max-edge", PARTS[part]["edge"],
         "--cell", f"{name}_cell.json"], folder, name)
    run(["ccx", name], folder, name)
    _, listed = run([SYMCELL, "transfer", f"{name}.frd", "--cell", f"{name}_cell.json", "--list"], folder, name)
    wanted = None
    for line in listed.splitlines():
        found = re.match(r"\s*(\d+).*\b2\b", line)
        if "diameter 2" in line or re.search(r"nodal.diameter\D+2\b", line):
            wanted = re.match(r"\s*(\d+)", line).group(1)
            break
        del found
    run([SYMCELL, "transfer", f"{name}.frd", "--cell", f"{name}_cell.json", "--result", wanted or "1", "--full",
         f"{name}.vtu", "--encoding", "ascii"], folder, name)
    mesh = meshio.read(folder / f"{name}.vtu")
    u = mesh.point_data["displacement"]
    tets = np.vstack([c.data for c in mesh.cells if c.type == "tetra"])
    faces = np.vstack([tets[:, f] for f in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    outer = faces[first[count == 1]]
    size = np.linalg.norm(u, axis=1)
    scale = 0.12 * np.ptp(mesh.points[:, 0]) / size.max()
    place = mesh.points + scale * u
    figure = pyplot.figure(figsize=(7, 5.2), dpi=110)
    axes = figure.add_subplot(projection="3d")
    colours = matplotlib.colormaps["viridis"](size[outer].mean(axis=1) / size.max()) if hasattr(
        matplotlib, "colormaps") else pyplot.get_cmap("viridis")(size[outer].mean(axis=1) / size.max())
    normal = np.cross(place[outer[:, 1]] - place[outer[:, 0]], place[outer[:, 2]] - place[outer[:, 0]])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    light = 0.55 + 0.45 * np.abs(normal @ np.array([0.3, -0.4, 0.87]))
    colours[:, :3] *= light[:, None]
    axes.add_collection3d(Poly3DCollection(place[outer], facecolors=colours, edgecolors=(0, 0, 0, 0.25), linewidths=0.2))
    low, high = place.min(axis=0), place.max(axis=0)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_zlim(low[2], high[2])
    axes.set_box_aspect(high - low)
    axes.view_init(32, -55)
    axes.set_axis_off()
    figure.subplots_adjust(0, 0, 1, 1)
    figure.savefig(target)


def main():
    for program in ("gmsh", "ccx"):
        if not shutil.which(program):
            sys.exit(f"{program} is not installed")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="symcell-analysis-"))
    text = ["# Meshes in analysis", "",
            "By `tests/bench/analysis.py`, which anyone can run. Natural frequencies by CalculiX of two steel parts whose bore is",
            "held, quadratic elements. M1 is what is done by hand: a sector cut by planes, meshed by Gmsh with matched bounds and",
            "its own refinement at curves. The reference is the mean of a sector of Gmsh's and a cell that are both fine; errors are",
            "relative, of the six lowest modes. Times are wall-clock seconds on a machine that had other work.", ""]
    for part in PARTS:
        rows, wanted, reference, apart, (fine_nodes, _) = part_tables(part, folder)
        text += [f"## {PART_NAMES[part]}", "",
                 f"{PARTS[part]['fold']}-fold, M1 with {fine_nodes} nodes as one half of the reference; the two halves differ by"
                 f" {100 * apart:.3f} % at most.", "",
                 "| mesh | nodes | tetrahedra | largest error | mean error | mesher, s | solver, s |",
                 "| --- | --- | --- | --- | --- | --- | --- |"]
        for label, nodes, elements, _, worst, mean, mesher, solver in rows:
            text.append(f"| {label} | {nodes:,} | {elements:,} | {100 * worst:.3f} % | {100 * mean:.3f} % | {mesher:.1f} |"
                        f" {solver:.1f} |")
        text += ["", "| nodal diameter | " + " | ".join(str(k) for k, _ in wanted) + " |",
                 "| --- |" + " --- |" * len(wanted),
                 "| reference, Hz | " + " | ".join(f"{f:.1f}" for f in reference) + " |"]
        for label, _, _, found, *_ in rows:
            text.append(f"| {label} | " + " | ".join(f"{f:.1f}" for f in found) + " |")
        text.append("")
    draw_mode(folder, "disc6", ROOT / "docs/mode.png")
    text += ["## A mode on the whole part", "",
             "The cell's mode of nodal diameter 2, on the full mesh by `symcell transfer`:", "", "![](mode.png)", ""]
    (ROOT / "docs/analysis.md").write_text("\n".join(text))
    shutil.rmtree(folder)


if __name__ == "__main__":
    main()
