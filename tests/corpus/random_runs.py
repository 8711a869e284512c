"""Many random models, each meshed by the real binary and judged by the independent checker beside the
tree, in parallel: shared by random_check.py (planar) and random_solid_check.py.

Every model is determined by its kind and seed alone. A run ends with counts: valid; invalid, where the
binary ended well and the checker found a fault; failed, by error code. Each seed that is not valid is
reported in a line of its own.
"""
import collections
import concurrent.futures
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHECKER = ROOT.parent / "shared" / "tools" / "meshcheck.py"
SKIPPED = 77

VALID, INVALID, FAILED, LEFT_OUT = "valid", "invalid", "failed", "left out"
# `what`: the error code of what failed, the fault of what is invalid; `remark`: of what is valid.
Outcome = collections.namedtuple("Outcome", "kind what remark", defaults=("", ""))


def skip_reason():
    """Why nothing can be checked; empty if all is there."""
    if not CHECKER.exists():
        return "../shared is absent"
    missing = [name for name in ("numpy", "scipy") if importlib.util.find_spec(name) is None]
    return f"meshcheck.py needs {' and '.join(missing)}" if missing else ""


def add_options(parser, kinds, count):
    parser.add_argument("--symcell", required=True)
    parser.add_argument("--writer", required=True)
    parser.add_argument("--kind", choices=kinds, default=kinds[0])
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--count", type=int, default=count)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())


def mesh(command, seconds):
    """The error code of `symcell mesh ...`, None if it ended well."""
    command = [str(x) for x in command] + ["--json-errors", "--quiet"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return "no end"
    if done.returncode == 0:
        return None
    try:
        problem = json.loads(done.stderr)
        return f"{problem['code']}: {problem.get('detail', '')[:160]}"
    except (ValueError, KeyError):
        return f"exit status {done.returncode}: {done.stderr.strip()[-200:]}"


def faults(arguments, seconds):
    """The failed checks of meshcheck.py, each a dictionary; none if all hold."""
    command = [sys.executable, CHECKER] + list(arguments) + ["--json"]
    try:
        done = subprocess.run([str(x) for x in command], capture_output=True, text=True,
                              timeout=seconds)
    except subprocess.TimeoutExpired:
        return [{"name": "meshcheck", "detail": "no end"}]
    if done.returncode == 0:
        return []
    try:
        return [c for c in json.loads(done.stdout)["checks"] if c["status"] == "fail"]
    except (ValueError, KeyError):
        return [{"name": "meshcheck", "detail": (done.stdout + done.stderr)[-300:]}]


def described(checks):
    return "; ".join(f"{c['name']} worst {c.get('worst')} limit {c.get('limit')} "
                     f"({c.get('detail', '')[:160]})" for c in checks)


def run_seeds(options, check):
    """Calls check(seed, base path of the model's files, folder) for every seed; the exit status."""
    def one(seed):
        with tempfile.TemporaryDirectory() as name:
            subprocess.run([options.writer, name, options.kind, str(seed), "1"], check=True)
            base = pathlib.Path(name) / f"random_{seed}"
            text = base.with_suffix(".txt")
            if not text.exists():
                return seed, "", Outcome(LEFT_OUT)
            return seed, text.read_text().split(" ", 2)[2].strip(), check(seed, base,
                                                                         pathlib.Path(name))

    seeds = range(options.first, options.first + options.count)
    counts, codes = collections.Counter(), collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for seed, description, outcome in pool.map(one, seeds):
            counts[outcome.kind] += 1
            if outcome.kind == FAILED:
                codes[outcome.what.split(":")[0]] += 1
            if outcome.kind in (INVALID, FAILED) or outcome.remark:
                print(f"{outcome.kind}: {options.kind} {seed} ({description}): "
                      f"{outcome.what or outcome.remark}", flush=True)
    told = ", ".join(f"{code} {count}" for code, count in codes.most_common())
    print(f"{options.kind}: {counts[VALID]} valid, {counts[INVALID]} invalid, "
          f"{counts[FAILED]} failed{f' ({told})' if told else ''} of "
          f"{options.count - counts[LEFT_OUT]} models")
    return 1 if counts[INVALID] or counts[FAILED] else 0
