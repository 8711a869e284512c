"""A PostgreSQL server of Debian's for one test, on a Unix socket in a folder of its own."""

import os
import pathlib
import pwd
import shutil
import signal
import subprocess
import tempfile


def programs():
    """The folder of initdb and postgres; None where there is none."""
    found = sorted(pathlib.Path("/usr/lib/postgresql").glob("*/bin/initdb"))
    return found[-1].parent if found else None


class Postgres:
    def __init__(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="symcell-pg-", dir="/tmp"))
        self.process = None
        self.user = "root"
        if os.geteuid() == 0:  # it does not run as root
            self.user = "nobody"
            entry = pwd.getpwnam(self.user)
            os.chown(self.folder, entry.pw_uid, entry.pw_gid)
        self.run("initdb", "-D", str(self.folder / "data"), "-U", "symcell", "-A", "trust", "--no-sync", "-E", "UTF8")
        self.start()

    def command(self, program, *arguments):
        command = [str(programs() / program), *arguments]
        return ["setpriv", "--reuid", self.user, "--clear-groups", *command] if self.user == "nobody" else command

    def run(self, program, *arguments):
        subprocess.run(self.command(program, *arguments), check=True, capture_output=True, cwd="/")

    def start(self):
        with open(self.folder / "log", "ab") as log:
            self.process = subprocess.Popen(
                self.command("postgres", "-D", str(self.folder / "data"), "-k", str(self.folder), "-c",
                             "listen_addresses=", "-c", "max_connections=200"),
                stdout=subprocess.DEVNULL, stderr=log, cwd="/")
        for _ in range(600):
            ready = subprocess.run(["pg_isready", "-h", str(self.folder), "-U", "symcell"], capture_output=True,
                                   check=False)
            if ready.returncode == 0:
                return self
            if self.process.poll() is not None:
                break
            subprocess.run(["sleep", "0.1"], check=True)
        raise AssertionError((self.folder / "log").read_text())

    @property
    def url(self):
        return f"postgresql:///postgres?host={self.folder}&user=symcell"

    def query(self, sql):
        done = subprocess.run(["psql", "-h", str(self.folder), "-U", "symcell", "-d", "postgres", "-tAc", sql],
                              capture_output=True, text=True, check=True)
        return done.stdout.strip()

    def kill(self):
        """As a machine that fails."""
        self.process.send_signal(signal.SIGQUIT)
        self.process.wait(timeout=60)

    def remove(self):
        if self.process.poll() is None:
            self.kill()
        shutil.rmtree(self.folder, ignore_errors=True)
