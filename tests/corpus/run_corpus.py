#!/usr/bin/python3
"""Meshes the model corpus beside the source tree with the real program and has every mesh checked.

The corpus and meshcheck.py, a checker that shares no code with the mesher, live in the folder
`shared` next to the source tree; without it, or what the checker needs, the run is skipped (exit
code 77).

    run_corpus.py meshes --symcell BINARY [--angles 20,30] [--models p2_01,...] [--jobs N]
    run_corpus.py bad --symcell BINARY

`meshes` ends with a table of the full meshes' triangles, n * cell, each against what Triangle 1.6
needs for the same model (peers.json), and the geometric means over exactly symmetric models.
"""

import argparse
import concurrent.futures
import importlib.util
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
SHARED = SOURCE.parent / "shared"
SKIPPED = 77
ANGLES = (20, 25, 30, 33, 35, 38, 40)

# Real parts are symmetric to their makers' tolerance only, and some models need a word more.
MESH_OPTIONS = {
    "r1_01": ["--symmetry-tolerance", "2e-4", "--fold", "10"],
    "r1_02": ["--symmetry-tolerance", "2e-4"],
}
CHECK_OPTIONS = {
    "r1_01": ["--model-tol", "1.6e-4", "--measure-tol", "1e-3"],
    "r1_02": ["--model-tol", "1.6e-4", "--measure-tol", "1e-3"],
}
# Symmetric in shape only: one sector's outline stands for all, and the checker asks for every vertex of
# the model. It judges these with all of them kept; without, our own verify compares the outlines.
SHAPE_ONLY = {"p2_13", "r1_01", "r1_02"}
# Elements across corners narrower than the bound, which touch no input vertex.
ACROSS_SMALL_ANGLES = {"p2_01", "p2_08"}
# Symmetric in its geometry, not in its attributes: one more run with those ignored.
ASYMMETRIC_ATTRIBUTES = {"p2_08"}

# What the corpus calls a class, where our name differs.
OUR_CODES = {
    "resource_limit": {"element_limit", "time_limit", "memory_limit", "too_large"},
    "overflow": {"coordinate_range", "non_finite"},
    "not_stl": {"unknown_format"},
    "inverted_orientation": set(),  # repaired
    "inconsistent_orientation": set(),
}
# One input stands for three requests.
FURTHER_AXES = {"b27_axis_zero_vector": ["nan,0,1", "0,1"]}


def short_name(name):
    return "_".join(name.split("_")[:2])


def run(command, seconds=300, memory_mb=None):
    def limit():
        if memory_mb:
            resource.setrlimit(resource.RLIMIT_AS, (memory_mb << 20, memory_mb << 20))

    return subprocess.run([str(part) for part in command], capture_output=True, text=True,
                          timeout=seconds, preexec_fn=limit, check=False)


class Task:
    """One model at one angle bound."""

    def __init__(self, model, angle, ignore_markers=False):
        self.model = model
        self.name = short_name(model.stem)
        self.angle = angle
        self.ignore_markers = ignore_markers
        self.label = model.stem + (" (markers ignored)" if ignore_markers else "")

    def mesh_and_check(self, symcell):
        """(triangles of the full mesh, what failed)."""
        with tempfile.TemporaryDirectory() as folder:
            cell, full, stats = (os.path.join(folder, f) for f in
                                 ("cell.vtu", "full.vtu", "stats.json"))
            command = [symcell, "mesh", self.model, "--min-angle", self.angle, "--cell", cell,
                       "--full", full, "--stats", stats, *MESH_OPTIONS.get(self.name, [])]
            if self.ignore_markers:
                command.append("--ignore-markers")
            if self.name in SHAPE_ONLY:
                wrong = self.verify(symcell, command, cell, full)
                if wrong:
                    return None, wrong
                command.append("--keep-vertices")
            done = run(command)
            if done.returncode != 0:
                return None, f"exit code {done.returncode}: {done.stderr.strip()}"
            with open(stats, encoding="utf-8") as file:
                triangles = json.load(file)["full"]["elements"]
            return triangles, self.check(cell, full, stats)

    def verify(self, symcell, command, cell, full):
        for step in (command, [symcell, "verify", cell, "--full", full, "--model", self.model, "-q"]):
            done = run(step)
            if done.returncode != 0:
                return f"exit code {done.returncode}: {(done.stdout + done.stderr).strip()}"
        return None

    def check(self, cell, full, stats):
        command = [sys.executable, SHARED / "tools" / "meshcheck.py", cell, "--full", full,
                   "--model", self.model, "--stats", stats, "--min-angle", self.angle,
                   "--delaunay", "strict", "--json", *CHECK_OPTIONS.get(self.name, [])]
        if self.name in ACROSS_SMALL_ANGLES:
            command.append("--exempt-seditious")
        done = run(command)
        if done.returncode == 0:
            return None
        try:
            report = json.loads(done.stdout)
        except ValueError:
            return f"meshcheck: exit code {done.returncode}: {(done.stdout + done.stderr)[-500:]}"
        failed = [c for c in report["checks"] if c["status"] == "fail"]
        return "; ".join(f"{c['name']} worst {c['worst']} limit {c['limit']} at {c['entity']} "
                         f"({c['detail']})" for c in failed)


def geometric_mean(ratios):
    return math.exp(sum(math.log(r) for r in ratios) / len(ratios))


def corpus_json(name):
    with open(SHARED / "corpus" / name, encoding="utf-8") as file:
        return json.load(file)


def print_table(tasks, counts, angles):
    peers = corpus_json("peers.json")["triangle_full_counts"]
    exact = {f["id"] for f in corpus_json("manifest.json")["files"]
             if f.get("symmetric_as") == "vertices"}
    labels = list(dict.fromkeys(task.label for task in tasks))
    width = max(map(len, labels))
    print("\nTriangles of the full mesh (ratio to Triangle's):")
    print(" " * width + "".join(f"{angle:>15}" for angle in angles))
    ratios = {angle: [] for angle in angles}
    for label in labels:
        row = []
        for angle in angles:
            count = counts.get((label, angle))
            peer = peers.get(label, {}).get(str(angle))
            ratio = count / peer if count and peer else None
            if ratio and label in exact:
                ratios[angle].append(ratio)
            row.append(f"{count or '-':>8}" + (f" ({ratio:.2f})" if ratio else " " * 7))
        print(f"{label:<{width}}" + "".join(row))
    means = [f"{geometric_mean(r):>8.3f}" + f" of{len(r):>3} " if r else " " * 15
             for r in ratios.values()]
    print(f"{'geometric mean':<{width}}" + "".join(means))


def mesh_all(args):
    wanted = args.models.split(",") if args.models else None
    angles = [int(angle) for angle in args.angles.split(",")] if args.angles else ANGLES
    tasks = []
    for model in sorted((SHARED / "corpus" / "2d").glob("*.json")):
        if wanted and not any(model.stem.startswith(w) for w in wanted):
            continue
        for angle in angles:
            tasks.append(Task(model, angle))
            if short_name(model.stem) in ASYMMETRIC_ATTRIBUTES:
                tasks.append(Task(model, angle, ignore_markers=True))
    counts, failures = {}, 0
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for task, (triangles, failed) in zip(
                tasks, pool.map(lambda task: task.mesh_and_check(args.symcell), tasks)):
            counts[task.label, task.angle] = triangles
            if failed:
                failures += 1
                print(f"FAILED {task.label} at {task.angle} degrees: {failed}", flush=True)
    print_table(tasks, counts, angles)
    print(f"\n{len(tasks)} meshes, {failures} failures")
    return 1 if failures else 0


def refuse_all(args):
    """Every bad input: the right class of error, in time and memory."""
    entries = [f for f in corpus_json("manifest.json")["files"] if f["valid"] is False]
    failures = count = 0
    for entry in entries:
        for request in requests_of(entry):
            began = time.monotonic()
            verdict = refuse(args.symcell, entry, request)
            took = time.monotonic() - began
            count += 1
            failures += verdict is not None
            print(f"{'FAILED' if verdict else 'ok':6} {entry['id']} {took:.2f} s {verdict or ''}")
    print(f"\n{count} bad inputs, {failures} failures")
    return 1 if failures else 0


def requests_of(entry):
    """The options of every request that the entry stands for."""
    options = ["--fold", entry["request"]["fold"]]
    if entry["kind"] == "pslg2d":
        return [options]
    axis = {key: ",".join(str(c) for c in value) for key, value in entry["request"]["axis"].items()}
    options.append("--axis-origin=" + axis["origin"])
    directions = [axis["direction"], *FURTHER_AXES.get(entry["id"], [])]
    return [[*options, "--axis-direction=" + direction] for direction in directions]


def refuse(symcell, entry, request):
    """What is wrong about the answer, None if nothing."""
    must = entry["must"]
    with tempfile.TemporaryDirectory() as folder:
        stats = os.path.join(folder, "stats.json")
        try:
            done = run([symcell, "mesh", SHARED / "corpus" / entry["file"], *request,
                        "--json-errors", "--cell", os.path.join(folder, "cell.vtu"),
                        "--stats", stats],
                       must["no_hang_seconds"], must["max_memory_mb"])
        except subprocess.TimeoutExpired:
            return "no answer in time"
        if done.returncode != 0:
            return judge_refusal(entry, done)
        with open(stats, encoding="utf-8") as file:
            return judge_mesh(entry, json.load(file))


def judge_mesh(entry, stats):
    """What is wrong about meshing a bad input, None if nothing."""
    others = [word for word in entry["acceptable"] if word != "clear_error"]
    if not others:
        return "meshed without complaint"
    for word in others:
        if not word.startswith("repair_by_flipping_volume_"):
            continue
        wanted = float(word.rsplit("_", 1)[1])
        volume = stats["cell"]["volume"] * stats["symmetry"]["fold"]
        if abs(volume - wanted) > 1e-6 * wanted:
            return f"repaired to a volume of {volume}, not {wanted}"
        if not stats["repairs"]:
            return "repaired without a word in the statistics"
    return None


def judge_refusal(entry, done):
    """What is wrong about the answer, None if nothing."""
    if done.returncode < 0 or "terminate" in done.stderr:
        return f"crashed: exit code {done.returncode}: {done.stderr[-300:]}"
    names = [entry["expected_error_class"], *entry.get("other_classes_also_right", [])]
    right = set().union(*(OUR_CODES.get(name, {name}) for name in names))
    try:
        problem = json.loads(done.stderr)
    except ValueError:
        return f"no JSON on standard error: {done.stderr[-300:]!r}"
    if problem["code"] not in right:
        return f"code {problem['code']}, not one of {sorted(right)}: {problem['detail']}"
    if done.returncode not in (2, 3, 4):
        return f"exit code {done.returncode}"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["meshes", "bad"])
    parser.add_argument("--symcell", required=True)
    parser.add_argument("--angles")
    parser.add_argument("--models")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    args = parser.parse_args()
    if not SHARED.is_dir():
        print("SKIPPED: ../shared is absent")
        return SKIPPED
    if args.what == "bad":
        return refuse_all(args)
    missing = [name for name in ("numpy", "scipy") if importlib.util.find_spec(name) is None]
    if missing:
        print(f"SKIPPED: meshcheck.py needs {' and '.join(missing)}")
        return SKIPPED
    return mesh_all(args)


if __name__ == "__main__":
    sys.exit(main())
