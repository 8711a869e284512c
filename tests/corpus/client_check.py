#!/usr/bin/python3
"""Whether other programs take what symcell writes.

    client_check.py gmsh --symcell BINARY    Gmsh opens the .msh of a cell, keeps its periodic entities
    client_check.py xml --symcell BINARY     SVG, and VTU in ASCII, are well-formed XML

Exit code 77, "SKIPPED: ...", where Gmsh is not installed.
"""

import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

DATA = pathlib.Path(__file__).resolve().parents[1] / "data" / "models"
SKIPPED = 77


def mesh(symcell, model, *outputs):
    done = subprocess.run([symcell, "mesh", model, *outputs], capture_output=True, text=True,
                          timeout=120, check=False)
    if done.returncode != 0:
        sys.exit(f"symcell failed on {model.name}: {done.stderr}")


def check_gmsh(symcell, folder):
    if shutil.which("gmsh") is None:
        print("SKIPPED: gmsh is not installed")
        return SKIPPED
    for model in models("p2_*", "p3_*"):
        cell, again = folder / "cell.msh", folder / "again.msh"
        mesh(symcell, model, "--ignore-markers", "--order", "2", "--cell", cell)
        done = subprocess.run(["gmsh", "-", cell, "-save", "-format", "msh41", "-o", again],
                              capture_output=True, text=True, timeout=120, check=False)
        told = done.stdout + done.stderr
        if done.returncode != 0 or re.search(r"(?m)^Error\b", told):
            sys.exit(f"gmsh on {model.name}: {told}")
        before, after = periodic_nodes(cell), periodic_nodes(again)
        if not before or before != after:
            sys.exit(f"gmsh kept {after} of {before} periodic pairs of {model.name}")
        print(f"{model.name}: {before} pairs of nodes kept")
    return 0


def periodic_nodes(path):
    """How many pairs of nodes the section $Periodic lists."""
    lines = iter(path.read_text(encoding="utf-8").splitlines())
    if "$Periodic" not in lines:
        return 0
    pairs = 0
    for _ in range(int(next(lines))):
        next(lines)  # dimension, entity, its master
        next(lines)  # the affine map
        count = int(next(lines))
        pairs += count
        for _ in range(count):
            next(lines)
    return pairs


def check_xml(symcell, folder):
    for model in models("p2_*"):
        names = [folder / "cell.svg", folder / "full.svg", folder / "cell.vtu"]
        mesh(symcell, model, "--cell", names[0], "--full", names[1])
        mesh(symcell, model, "--vtu-encoding", "ascii", "--cell", names[2])
        for name in names:
            xml.etree.ElementTree.parse(name)
        print(f"{model.name}: well-formed")
    return 0


def models(*patterns):
    found = sorted(path for pattern in patterns for path in DATA.glob(pattern))
    if not found:
        sys.exit(f"no models in {DATA}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["gmsh", "xml"])
    parser.add_argument("--symcell", required=True)
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        check = check_gmsh if args.what == "gmsh" else check_xml
        return check(args.symcell, folder)


if __name__ == "__main__":
    sys.exit(main())
