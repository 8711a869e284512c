"""npm packages for tests: installed from a checked-in lock file into the build folder, once a lock file.

SYMCELL_NPM_DIR names the folder; without npm, or where its registry cannot be reached, the tests that
need packages are skipped.
"""

import hashlib
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from symcell_server import ROOT


def installed(folder):
    """Copies `folder`, which has package.json and package-lock.json, to the build folder and installs its
    packages there. Returns the copy; raises unittest.SkipTest where that cannot be."""
    npm = shutil.which("npm")
    if not npm:
        raise unittest.SkipTest("npm is not installed (Debian: npm)")
    source = ROOT / folder
    lock = hashlib.sha256((source / "package-lock.json").read_bytes()).hexdigest()
    base = pathlib.Path(os.environ.get("SYMCELL_NPM_DIR") or tempfile.gettempdir()) / folder.replace("/", "_")
    shutil.copytree(source, base, dirs_exist_ok=True, ignore=shutil.ignore_patterns("node_modules"))
    stamp = base / "node_modules" / ".symcell-lock"
    if stamp.exists() and stamp.read_text() == lock:
        return base
    done = subprocess.run([npm, "ci", "--prefer-offline", "--ignore-scripts"], cwd=base,
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise unittest.SkipTest("npm ci could not install the packages: " + done.stderr[-500:])
    stamp.write_text(lock)
    return base
