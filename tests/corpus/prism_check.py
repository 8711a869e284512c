"""Cells cut from hand-made quotient meshes through the independent checker beside the tree.

prism_check.py --writer PROGRAM
Exit 77 (skipped) where the checker or its packages are absent.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

from random_runs import CHECKER, SKIPPED, skip_reason



def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--writer", required=True)
    options = parser.parse_args()
    if reason := skip_reason():
        print(f"SKIPPED: {reason}")
        return SKIPPED
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        subprocess.run([options.writer, folder], check=True)
        models = sorted(folder.glob("*.json"), key=lambda p: int(p.stem))
        for model in models:
            checked = subprocess.run(
                [sys.executable, CHECKER, model.with_suffix(".cell.vtu"), "--full",
                 model.with_suffix(".full.vtu"), "--model", model, "--quiet"],
                capture_output=True, text=True, timeout=120)
            good = checked.returncode == 0
            failed += not good
            print(model.stem, "ok" if good else checked.stdout + checked.stderr)
    return 1 if failed or not models else 0


if __name__ == "__main__":
    sys.exit(main())
