#!/usr/bin/python3
"""Meshes every valid solid of the corpus beside the source tree and has the meshes checked.

    solid_corpus.py --symcell BINARY [--shares none,2000,40000] [--models p3_01,...] [--jobs N]

`--shares`: the bound on an element's volume is the model's volume over this number. Fold and axis
are those of the manifest; meshcheck.py shares no code with the mesher. Ends with a table of the full
meshes' tetrahedra, n * cell, each against what TetGen 1.5 needs for the same model (peers.json), and
the geometric means over the models whose count does not depend on the tessellation.

Real files that are dirty may be refused. Elements near small features that do not touch them, which
the checker does not exempt and the statistics count, are reported and hold. Exit code 77: skipped.
"""

import argparse
import concurrent.futures
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile

from run_corpus import SHARED, SKIPPED, corpus_json, geometric_mean, run

RADIUS_EDGE = 1.414
DEFAULT_SHARES = "none,2000"
# Reasons that meshcheck.py does not know.
UNKNOWN_EXCUSES = {"near_small_feature"}
# TetGen keeps the long thin triangles of other tessellations, which would flatter us.
COUNTED = ("p3_", "r3_01", "r3_03", "s3_01", "s3_03", "s3_08")
PEER_NAMES = {2000: "coarse", 40000: "fine"}


def model_file(entry, folder):
    """Path of the model as the checker reads it: unpacked."""
    path = SHARED / "corpus" / entry["file"]
    if path.suffix != ".gz":
        return path
    unpacked = pathlib.Path(folder) / path.stem
    with open(unpacked, "wb") as file:
        subprocess.run(["gzip", "-dc", path], stdout=file, check=True)
    return unpacked


def mesh_and_check(symcell, entry, share):
    """(tetrahedra of the full mesh, what failed, a remark)."""
    axis = {key: ",".join(repr(c) for c in value) for key, value in entry["axis"].items()
            if key in ("origin", "direction")}
    with tempfile.TemporaryDirectory() as folder:
        model = model_file(entry, folder)
        cell, full, stats = (os.path.join(folder, f) for f in
                             ("cell.vtu", "full.vtu", "stats.json"))
        command = [symcell, "mesh", model, "--fold", entry["fold"], "--axis-origin=" + axis["origin"],
                   "--axis-direction=" + axis["direction"], "--radius-edge", RADIUS_EDGE,
                   "--cell", cell, "--full", full, "--stats", stats]
        check = [sys.executable, SHARED / "tools" / "meshcheck.py", cell, "--full", full,
                 "--model", model, "--stats", stats, "--fold", entry["fold"],
                 "--radius-edge", RADIUS_EDGE + 1e-3, "--json"]
        if share:
            bound = entry["volume"] / share
            command += ["--max-volume", repr(bound)]
            check += ["--max-volume", repr(bound * (1 + 1e-9))]
        done = run(command, 900)
        if done.returncode != 0:
            refused = entry["valid"] == "dirty" and done.returncode == 3
            told = done.stderr.strip().splitlines()[:1]
            return None, None if refused else f"exit code {done.returncode}: {told}", f"refused: {told}"
        with open(stats, encoding="utf-8") as file:
            told = json.load(file)
        excused = sum(e["elements"] for e in told["exempt"] if e["reason"] in UNKNOWN_EXCUSES)
        wrong, remark = judge(run(check, 900), excused)
        return told["full"]["elements"], wrong, remark


def judge(checked, excused):
    if checked.returncode == 0:
        return None, ""
    try:
        report = json.loads(checked.stdout)
    except ValueError:
        return f"meshcheck: exit code {checked.returncode}: {(checked.stdout + checked.stderr)[-300:]}", ""
    failed = [c for c in report["checks"] if c["status"] == "fail"]
    serious = [c for c in failed if c["name"] != "quality.radius-edge" or not excused]
    wrong = "; ".join(f"{c['name']} worst {c['worst']} limit {c['limit']} at {c['entity']} "
                      f"({c['detail']})" for c in serious)
    return wrong or None, "" if len(serious) == len(failed) else f"{excused} near small features"


def print_table(entries, shares, counts):
    peers = corpus_json("peers.json")["tetgen_full"]
    width = max(len(entry["id"]) for entry in entries)
    print("\nTetrahedra of the full mesh (ratio to TetGen's):")
    print(" " * width + "".join(f"{'V / ' + str(share) if share else 'no bound':>18}" for share in shares))
    ratios = {share: [] for share in shares}
    for entry in entries:
        row = []
        for share in shares:
            count = counts.get((entry["id"], share))
            peer = peers.get(entry["id"], {}).get(PEER_NAMES.get(share), {}).get("tets")
            ratio = count / peer if count and peer else None
            if ratio and entry["id"].startswith(COUNTED):
                ratios[share].append(ratio)
            row.append(f"{count or '-':>10}" + (f" ({ratio:.3f})" if ratio else " " * 8))
        print(f"{entry['id']:<{width}}" + "".join(row))
    means = [f"{geometric_mean(r):>10.3f} of{len(r):>3}  " if r else " " * 18 for r in ratios.values()]
    print(f"{'geometric mean':<{width}}" + "".join(means))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--symcell", required=True)
    parser.add_argument("--shares", default=DEFAULT_SHARES)
    parser.add_argument("--models")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    args = parser.parse_args()
    if not SHARED.is_dir():
        print("SKIPPED: ../shared is absent")
        return SKIPPED
    missing = [name for name in ("numpy", "scipy") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"SKIPPED: meshcheck.py needs {' and '.join(missing)}")
        return SKIPPED
    shares = [None if word == "none" else int(word) for word in args.shares.split(",")]
    wanted = args.models.split(",") if args.models else None
    entries = [entry for entry in corpus_json("manifest.json")["files"]
               if entry["kind"] in ("plc3d", "stl3d") and entry["valid"] is not False
               and (not wanted or any(entry["id"].startswith(w) for w in wanted))]
    tasks = [(entry, share) for entry in entries for share in shares]
    counts, failures = {}, 0
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        results = pool.map(lambda task: mesh_and_check(args.symcell, *task), tasks)
        for (entry, share), (count, wrong, remark) in zip(tasks, results):
            counts[entry["id"], share] = count
            failures += wrong is not None
            if wrong or remark:
                print(f"{'FAILED' if wrong else 'ok'} {entry['id']}, V / {share}: {wrong or remark}",
                      flush=True)
    print_table(entries, shares, counts)
    print(f"\n{len(tasks)} meshes, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
