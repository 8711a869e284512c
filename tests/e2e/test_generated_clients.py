"""Clients that others' generators make of openapi.yaml, used as they come: a file is uploaded with an option
and gives the mesh that the command makes of it."""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import npm_packages
from symcell_server import ROOT, Server, binary

GEAR = ROOT / "docs" / "examples" / "gear.stl"


class GeneratedClientsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = npm_packages.installed("tests/clients")
        cls.server = Server(workers=2).start()
        cls.url = f"http://127.0.0.1:{cls.server.port}"

    @classmethod
    def tearDownClass(cls):
        cls.server.remove()

    def run_tool(self, name, *arguments):
        """Runs one of the packages' programs; returns what it printed."""
        environment = {**os.environ, "SYMCELL_URL": self.url, "SYMCELL_DESCRIPTION": str(ROOT / "openapi.yaml"),
                       "SYMCELL_ORVAL_CLIENT": str(self.folder / "orval" / "api.ts"), "NO_COLOR": "1",
                       "REDOCLY_TELEMETRY": "off"}
        done = subprocess.run([self.folder / "node_modules" / ".bin" / name, *arguments], cwd=self.folder,
                              env=environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"{name}: {done.stdout[-3000:]}{done.stderr[-3000:]}")
        return done.stdout

    def elements_by_command(self):
        with tempfile.TemporaryDirectory() as folder:
            statistics = pathlib.Path(folder) / "statistics.json"
            subprocess.run([binary(), "mesh", GEAR, "--max-volume", "10", "--stats", statistics],
                           check=True, capture_output=True)
            return json.loads(statistics.read_text())["cell"]["elements"]

    def test_clients_of_hey_api_and_orval_upload_a_file_with_an_option(self):
        self.run_tool("openapi-ts", "-i", str(ROOT / "openapi.yaml"), "-o", "hey", "-c",
                      "@hey-api/client-fetch")
        self.run_tool("orval", "--config", "orval.config.mjs")
        # Type errors count: the types must fit this use of them.
        self.run_tool("tsc", "--noEmit", "--target", "es2022", "--module", "esnext", "--moduleResolution",
                      "bundler", "--strict", "--skipLibCheck", "--types", "node", "use_clients.mts")
        self.run_tool("esbuild", "use_clients.mts", "--bundle", "--platform=node", "--format=esm",
                      "--outfile=use_clients.mjs")
        program = self.folder / "use_clients.mjs"
        done = subprocess.run(["node", program, GEAR, self.url], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        expected = self.elements_by_command()
        self.assertEqual(json.loads(done.stdout), {
            f"{client} {form}": expected for client in ("hey-api", "orval") for form in ("file", "form")})

    def test_the_description_passes_a_linter(self):
        self.run_tool("redocly", "lint", str(ROOT / "openapi.yaml"))

    def test_types_are_made_of_the_description(self):
        self.run_tool("openapi-typescript", str(ROOT / "openapi.yaml"), "-o", "schema.ts")
        self.run_tool("tsc", "--noEmit", "--strict", "schema.ts")


if __name__ == "__main__":
    unittest.main()
