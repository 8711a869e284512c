"""Random symmetric solids through the real binary and the independent checker beside the tree.

random_solid_check.py --symcell PROGRAM --writer PROGRAM [--first SEED] [--count N]

The checker excuses from the radius-edge bound what touches a small angle of the input only; a mesh
that has others and says so in its statistics (near_small_feature) is told, and holds.
Exit 77 (skipped) where the checker or its packages are absent.
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHECKER = ROOT.parent / "shared" / "tools" / "meshcheck.py"
# Volume of the model over the number: bounds on the volume of elements.
SHARES = (None, 300, 2000)
RADIUS_EDGE = 1.414


def check(symcell, model, folder, share):
    """(text of what is wrong with the mesh of one model, empty if nothing is; a remark)."""
    fold, volume, _ = model.with_suffix(".txt").read_text().split(" ", 2)
    cell, full, stats = (folder / name for name in ("cell.vtu", "full.vtu", "stats.json"))
    mesh = [symcell, "mesh", model, "--cell", cell, "--full", full, "--stats", stats, "--quiet",
            "--radius-edge", str(RADIUS_EDGE), "--time-limit", "120"]
    verify = [sys.executable, CHECKER, cell, "--full", full, "--model", model, "--stats", stats,
              "--radius-edge", str(RADIUS_EDGE + 1e-3), "--json"]
    if share:
        bound = float(volume) / share
        mesh += ["--max-volume", repr(bound)]
        verify += ["--max-volume", repr(bound * (1 + 1e-9))]
    done = subprocess.run([str(x) for x in mesh], capture_output=True, text=True, timeout=150)
    if done.returncode != 0:
        return f"exit status {done.returncode}: {done.stderr.strip()}", ""
    told = json.loads(stats.read_text())
    if told["symmetry"]["fold"] % int(fold) != 0:
        return f"fold {told['symmetry']['fold']} instead of {fold}", ""
    checked = subprocess.run([str(x) for x in verify], capture_output=True, text=True, timeout=300)
    if checked.returncode == 0:
        return "", ""
    try:
        report = json.loads(checked.stdout)
    except json.JSONDecodeError:
        return checked.stdout.strip() + checked.stderr.strip(), ""
    excused = {x["reason"]: x["elements"] for x in told.get("exempt", [])}
    failed = [c for c in report["checks"] if c["status"] == "fail"]
    serious = [c for c in failed if c["name"] != "quality.radius-edge"
               or not excused.get("near_small_feature")]
    lines = [f"{c['name']}: {c.get('worst')} (limit {c.get('limit')}) {c.get('detail', '')}"
             for c in serious]
    remark = "" if serious == failed else f"{excused['near_small_feature']} near small features"
    return "; ".join(lines), remark


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--symcell", required=True)
    parser.add_argument("--writer", required=True)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=12)
    options = parser.parse_args()
    try:
        import numpy, scipy  # noqa: F401  the checker's
    except ImportError as error:
        print(f"SKIPPED: {error}")
        return 77
    if not CHECKER.exists():
        print("SKIPPED: ../shared is absent")
        return 77
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([options.writer, folder, str(options.first), str(options.count)], check=True)
        for seed in range(options.first, options.first + options.count):
            model = folder / f"random_{seed}.json"
            share = SHARES[seed % len(SHARES)]
            wrong, remark = check(options.symcell, model, folder, share)
            what = model.with_suffix(".txt").read_text().split(" ", 2)[2].strip()
            print(f"{model.stem} ({what}), volume / {share}: {wrong or 'holds'}"
                  f"{' (' + remark + ')' if remark else ''}", flush=True)
            failed += bool(wrong)
    print(f"{failed} of {options.count} models failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
