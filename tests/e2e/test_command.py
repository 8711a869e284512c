"""`symcell mesh` when its mesher crashes, is stuck, or is interrupted: exit codes, and what is left."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from symcell_server import binary, long_options, square, until, without_sanitizer
from test_workers import cpu_ticks, processes


class CommandTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="symcell-e2e-"))
        self.addCleanup(shutil.rmtree, self.folder)
        model = self.folder / "square.json"
        model.write_text(json.dumps(square()))
        flags = [text for name, value in long_options().items()
                 for text in ("--" + name.replace("_", "-"), str(value))]
        self.command = [binary(), "mesh", str(model), "--cell", str(self.folder / "cell.vtu"), *flags]

    def start(self, *more):
        self.process = subprocess.Popen([*self.command, *more], stderr=subprocess.PIPE, text=True)
        self.addCleanup(self.process.kill)

        def meshing_child():
            children = [pid for pid, (parent, _) in processes().items() if parent == self.process.pid]
            return children[0] if children and cpu_ticks(children[0]) > 5 else None
        self.child = until(meshing_child, "the child meshes")

    def end(self):
        _, text = self.process.communicate(timeout=30)
        self.assertEqual([file.name for file in self.folder.iterdir()], ["square.json"])
        return self.process.returncode, text

    @without_sanitizer
    def test_a_crash_is_an_error(self):
        self.start()
        os.kill(self.child, signal.SIGSEGV)
        code, text = self.end()
        self.assertEqual(code, 1)
        self.assertIn("worker_crashed", text)
        self.assertIn("SIGSEGV", text)

    def test_an_interrupt_ends_it_also_where_nobody_listens(self):
        for stuck in (False, True):
            self.start()
            if stuck:
                os.kill(self.child, signal.SIGSTOP)
            began = time.monotonic()
            self.process.send_signal(signal.SIGINT)
            code, text = self.end()
            self.assertEqual(code, 1)
            self.assertIn("cancelled", text)
            self.assertLess(time.monotonic() - began, 2.5)

    def test_a_standard_output_that_takes_nothing_is_an_error(self):
        model, cell = self.folder / "square.json", self.folder / "cell.json"
        subprocess.run([binary(), "mesh", str(model), "--cell", str(cell)], check=True, stderr=subprocess.DEVNULL)
        for command in (["mesh", str(model), "--format", "vtu"], ["convert", str(cell), "--format", "vtu"]):
            with open("/dev/full", "w") as full:
                ended = subprocess.run([binary(), *command, "--cell", "-"], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(ended.returncode, 1, ended.stderr)
            self.assertIn("standard output", ended.stderr)
            self.assertIn("No space left", ended.stderr)

    def test_the_time_limit_ends_what_is_stuck(self):
        self.start("--time-limit", "1")
        os.kill(self.child, signal.SIGSTOP)
        code, text = self.end()
        self.assertEqual(code, 4)
        self.assertIn("time_limit", text)

    @without_sanitizer
    def test_the_memory_limit_is_told(self):
        self.start("--memory-limit", "100")
        code, text = self.end()
        self.assertEqual(code, 4)
        self.assertIn("memory_limit", text)

    def test_the_child_dies_with_the_command(self):
        self.start()
        self.process.kill()
        until(lambda: self.child not in processes(), "the child is gone", 5)
        self.process.communicate(timeout=30)


if __name__ == "__main__":
    unittest.main()
