"""Random solids through the real binary and the independent checker beside the tree.

random_solid_check.py --symcell PROGRAM --writer PROGRAM [--kind KIND]
                      [--first SEED] [--count N] [--jobs N]

Kinds: bodies (prisms, frustums, blocks, ...), layers (stacks of prisms: ribs, pockets, islands,
partitions) and tabs (bodies with tabs and pockets on their sides) as facets, PLC JSON; surfaces and
tab_surfaces, layers and tabs as triangles, STL.

The checker exempts from the radius-edge bound what touches a small angle of the input only; a mesh
that has others and says so in its statistics (near_small_feature) is reported, and holds.
Exit 77 (skipped) where the checker or its packages are absent.
"""
import argparse
import json
import sys

import random_runs
from random_runs import FAILED, INVALID, VALID, Outcome

KINDS = ("bodies", "layers", "tabs", "surfaces", "tab_surfaces")
# Volume of the model over the number: bounds on the volume of elements.
SHARES = (None, 300, 2000)
RADIUS_EDGE = 1.414


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    random_runs.add_options(parser, KINDS, 12)
    options = parser.parse_args()
    if reason := random_runs.skip_reason():
        print(f"SKIPPED: {reason}")
        return random_runs.SKIPPED

    def check(seed, base, folder):
        fold, volume, _ = base.with_suffix(".txt").read_text().split(" ", 2)
        surface = options.kind.endswith("surfaces")
        model, share = base.with_suffix(".stl" if surface else ".json"), SHARES[seed % len(SHARES)]
        cell, full, stats = (folder / name for name in ("cell.vtu", "full.vtu", "stats.json"))
        mesh = [options.symcell, "mesh", model, "--cell", cell, "--full", full, "--stats", stats,
                "--radius-edge", RADIUS_EDGE, "--time-limit", "120"]
        verify = [cell, "--full", full, "--model", model, "--stats", stats, "--radius-edge",
                  RADIUS_EDGE + 1e-3]
        if share:
            bound = float(volume) / share
            mesh += ["--max-volume", repr(bound)]
            verify += ["--max-volume", repr(bound * (1 + 1e-9))]
        # Detection may find another axis, of a higher fold.
        if surface:
            mesh += ["--fold", fold]
        if error := random_runs.mesh(mesh, 150):
            return Outcome(FAILED, error)
        told = json.loads(stats.read_text())
        if told["symmetry"]["fold"] % int(fold) != 0:
            return Outcome(INVALID, f"fold {told['symmetry']['fold']} instead of {fold}")
        failed = random_runs.faults(verify, 300)
        excused = {x["reason"]: x["elements"] for x in told.get("exempt", [])}
        near = excused.get("near_small_feature", 0)
        serious = [c for c in failed if c["name"] != "quality.radius-edge" or not near]
        if serious:
            return Outcome(INVALID, random_runs.described(serious))
        return Outcome(VALID, "", f"{near} near small features" if failed else "")

    return random_runs.run_seeds(options, check)


if __name__ == "__main__":
    sys.exit(main())
