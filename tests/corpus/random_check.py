"""Random planar models through the real binary and the independent checker beside the tree.

random_check.py --symcell PROGRAM --writer PROGRAM [--kind loops|cells] [--first SEED] [--count N]
                [--jobs N]

Kinds: loops round the centre with things between; cells of grids (combs, gears, islands, segments
that end inside others). Exit 77 (skipped) where the checker or its packages are absent.
"""
import argparse
import sys

import random_runs
from random_runs import FAILED, INVALID, VALID, Outcome

ANGLES = ("20", "25", "30", "33")
KINDS = ("loops", "cells")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    random_runs.add_options(parser, KINDS, 24)
    options = parser.parse_args()
    if reason := random_runs.skip_reason():
        print(f"SKIPPED: {reason}")
        return random_runs.SKIPPED

    def check(seed, base, folder):
        model, angle = base.with_suffix(".json"), ANGLES[seed % len(ANGLES)]
        cell, full, stats = (folder / name for name in ("cell.vtu", "full.vtu", "stats.json"))
        # The checker asks for every vertex of the model.
        error = random_runs.mesh([options.symcell, "mesh", model, "--keep-vertices",
                                  "--min-angle", angle, "--cell", cell, "--full", full,
                                  "--stats", stats, "--time-limit", "60"], 120)
        if error:
            return Outcome(FAILED, error)
        # Random corners are often narrower than the bound, so edges across them are exempt.
        wrong = random_runs.faults([cell, "--full", full, "--model", model, "--stats", stats,
                                    "--min-angle", angle, "--exempt-seditious", "--delaunay",
                                    "strict"], 300)
        return Outcome(INVALID, random_runs.described(wrong)) if wrong else Outcome(VALID)

    return random_runs.run_seeds(options, check)


if __name__ == "__main__":
    sys.exit(main())
