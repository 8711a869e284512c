"""Random symmetric models through the real binary and the independent checker beside the tree.

random_check.py --symcell PROGRAM --writer PROGRAM [--count N]
Exit 77 (skipped) where the checker or its packages are absent.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

ANGLES = ["20", "25", "30", "33"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
CHECKER = ROOT.parent / "shared" / "tools" / "meshcheck.py"


def check(symcell, model, angle, folder):
    """Text of what is wrong with the mesh of one model, empty if nothing is."""
    cell, full, stats = (folder / name for name in ("cell.vtu", "full.vtu", "stats.json"))
    mesh = subprocess.run(
        [symcell, "mesh", model, "--min-angle", angle, "--cell", cell, "--full", full,
         "--stats", stats, "--quiet"], capture_output=True, text=True, timeout=120)
    if mesh.returncode != 0:
        return f"exit status {mesh.returncode}: {mesh.stderr.strip()}"
    # Random corners are often narrower than the bound, so edges across them are excused.
    checked = subprocess.run(
        [sys.executable, CHECKER, cell, "--full", full, "--model", model, "--stats", stats,
         "--min-angle", angle, "--exempt-seditious", "--delaunay", "strict", "--quiet"],
        capture_output=True, text=True, timeout=120)
    return "" if checked.returncode == 0 else checked.stdout.strip() + checked.stderr.strip()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--symcell", required=True)
    parser.add_argument("--writer", required=True)
    parser.add_argument("--count", type=int, default=24)
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
        subprocess.run([options.writer, folder, str(options.count)], check=True)
        for number, model in enumerate(sorted(folder.glob("random_*.json"))):
            angle = ANGLES[number % len(ANGLES)]
            wrong = check(options.symcell, model, angle, folder)
            print(f"{model.stem} at {angle} degrees: {wrong or 'holds'}", flush=True)
            failed += bool(wrong)
    print(f"{failed} of {options.count} models failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
