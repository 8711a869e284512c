"""Calls of the service, by the standard library alone."""

from __future__ import annotations

import json
import os
import shutil
import time
import urllib.error
import urllib.parse
import urllib.request
import uuid
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Callable, Dict, Iterator, Mapping, Optional, Tuple, Union

from .arrays import MeshArrays

# A file's path, its bytes, or a JSON model as a dictionary.
Model = Union[str, "os.PathLike[str]", bytes, Mapping[str, Any]]
OnProgress = Callable[["Progress"], None]

DEFAULT_SERVER = "http://127.0.0.1:8080"
_FIRST_POLL_S, _LONGEST_POLL_S, _POLL_GROWTH = 0.03, 1.0, 1.5


class Problem(Exception):
    """What the service says is wrong: `code`, `detail`, `status`, and the whole document."""

    def __init__(self, document: Mapping[str, Any]) -> None:
        self.document = dict(document)
        self.code: str = document.get("code", "unknown")
        self.detail: str = document.get("detail", "")
        self.status: int = document.get("status", 0)
        super().__init__(f"{self.code}: {self.detail}")


class JobFailed(Problem):
    """The model could not be meshed as asked."""


class JobCancelled(Exception):
    """Somebody cancelled the job."""


@dataclass(frozen=True)
class Progress:
    """Of a running job. fraction: 0 to 1; elements: of the cell so far; quality: share that keeps all bounds."""

    state: str
    fraction: float
    phase: str
    elements: int
    quality: float


class Client:
    """A service at `server` (default: $SYMCELL_SERVER, else http://127.0.0.1:8080), with an API `key` if it wants
    one (default: $SYMCELL_KEY)."""

    def __init__(self, server: Optional[str] = None, key: Optional[str] = None, timeout_s: float = 300) -> None:
        self.server = (server or os.environ.get("SYMCELL_SERVER") or DEFAULT_SERVER).rstrip("/")
        self.key = key or os.environ.get("SYMCELL_KEY")
        self.timeout_s = timeout_s

    def mesh(self, model: Model, *, progress: Optional[OnProgress] = None, **options: Any) -> "Mesh":
        """Meshes a model and waits. Options are the service's own (fold, max_volume, min_angle, ...).

        Raises JobFailed with what is wrong, Problem if the request is refused. Ctrl-C cancels the job.
        """
        job = self.submit(model, **options)
        try:
            return job.wait(progress)
        except KeyboardInterrupt:
            job.cancel()
            raise

    def submit(self, model: Model, **options: Any) -> "Job":
        """Begins meshing and does not wait."""
        return Job(self, self._post_model("/v1/jobs/form", model, options))

    def inspect(self, model: Model, **options: Any) -> Dict[str, Any]:
        """Fold, axis, symmetry error and size of a model, without meshing."""
        return self._post_model("/v1/inspect/form", model, options)

    def job(self, job_id: str) -> "Job":
        return Job(self, self.get_json(f"/v1/jobs/{job_id}"))

    def jobs(self, state: Optional[str] = None) -> Iterator["Job"]:
        """All jobs, newest first."""
        query = {"state": state} if state else {}
        while True:
            page = self.get_json("/v1/jobs?" + urllib.parse.urlencode(query))
            for document in page["jobs"]:
                yield Job(self, document)
            if page["next_cursor"] is None:
                return
            query["cursor"] = page["next_cursor"]

    # --- HTTP ---

    def open(self, method: str, path: str, body: Optional[bytes] = None,
             headers: Optional[Mapping[str, str]] = None) -> BinaryIO:
        """The answer as a stream. Raises Problem for what is not a success."""
        request = urllib.request.Request(self.server + path, data=body, method=method, headers=dict(headers or {}))
        if self.key:
            request.add_header("Authorization", f"Bearer {self.key}")
        try:
            answer: BinaryIO = urllib.request.urlopen(request, timeout=self.timeout_s)
            return answer
        except urllib.error.HTTPError as error:
            text = error.read()
            try:
                document = json.loads(text)
            except ValueError:
                document = {"code": "unknown", "detail": text.decode(errors="replace"), "status": error.code}
            raise Problem(document) from None

    def get_json(self, path: str) -> Dict[str, Any]:
        with self.open("GET", path) as answer:
            document: Dict[str, Any] = json.load(answer)
            return document

    def _post_model(self, path: str, model: Model, options: Mapping[str, Any]) -> Dict[str, Any]:
        name, content = _read_model(model)
        boundary = uuid.uuid4().hex
        head = (f"--{boundary}\r\nContent-Disposition: form-data; name=\"options\"\r\n\r\n{json.dumps(dict(options))}\r\n"
                f"--{boundary}\r\nContent-Disposition: form-data; name=\"model\"; filename=\"{name}\"\r\n"
                "Content-Type: application/octet-stream\r\n\r\n").encode()
        body = head + content + f"\r\n--{boundary}--\r\n".encode()
        with self.open("POST", path, body, {"Content-Type": f"multipart/form-data; boundary={boundary}"}) as answer:
            document: Dict[str, Any] = json.load(answer)
            return document


def _read_model(model: Model) -> Tuple[str, bytes]:
    if isinstance(model, Mapping):
        return "model.json", json.dumps(model).encode()
    if isinstance(model, bytes):
        return "model", model
    path = Path(model)
    # What would end the header is no part of a name that anybody needs.
    return path.name.translate({ord(c): "_" for c in '"\\\r\n'}), path.read_bytes()


class Job:
    """A job of the service; `document` is what it said last."""

    def __init__(self, client: Client, document: Dict[str, Any]) -> None:
        self.client = client
        self.document = document
        self.id: str = document["id"]

    @property
    def state(self) -> str:
        return str(self.document["state"])

    @property
    def finished(self) -> bool:
        return self.state not in ("queued", "running")

    @property
    def progress(self) -> Progress:
        told = self.document["progress"]
        return Progress(self.state, told["fraction"], told["phase"], told["elements"], told["quality"])

    def refresh(self) -> "Job":
        self.document = self.client.get_json(f"/v1/jobs/{self.id}")
        return self

    def wait(self, progress: Optional[OnProgress] = None) -> "Mesh":
        """Waits for the end; `progress` is called whenever something is new. Raises JobFailed, JobCancelled."""
        told: Optional[Progress] = None
        pause = _FIRST_POLL_S
        while True:
            if progress and self.progress != told:
                told = self.progress
                progress(told)
            if self.finished:
                break
            time.sleep(pause)
            pause = min(pause * _POLL_GROWTH, _LONGEST_POLL_S)
            self.refresh()
        if self.state == "failed":
            raise JobFailed(self.document["error"])
        if self.state == "cancelled":
            raise JobCancelled(self.id)
        if "statistics" not in self.document:
            self.refresh()  # of a list, which tells less
        return Mesh(self)

    def cancel(self) -> None:
        self.client.open("POST", f"/v1/jobs/{self.id}/cancel", b"").close()

    def delete(self) -> None:
        self.client.open("DELETE", f"/v1/jobs/{self.id}").close()


class Mesh:
    """The mesh of a finished job. `cell` and `full` are fetched when they are first asked for."""

    def __init__(self, job: Job) -> None:
        self.job = job
        self.statistics: Dict[str, Any] = job.document["statistics"]
        self.warnings: "list[Dict[str, str]]" = job.document.get("warnings", [])
        self._parts: Dict[str, MeshArrays] = {}

    @property
    def fold(self) -> int:
        return int(self.statistics["symmetry"]["fold"])

    @property
    def cell(self) -> MeshArrays:
        """One symmetry cell."""
        return self._part("cell")

    @property
    def full(self) -> MeshArrays:
        """All sectors, nodes shared."""
        return self._part("full")

    def save(self, path: Union[str, "os.PathLike[str]"], part: str = "cell", format: Optional[str] = None,
             **parameters: Any) -> None:
        """Writes a mesh file in a format of the service: by `format`, else by the path's ending.

        `parameters` are those of the format, such as material="steel" of inp.
        """
        query = {"format": format or Path(path).suffix.lstrip("."), **parameters}
        address = f"/v1/jobs/{self.job.id}/{part}?{urllib.parse.urlencode(query)}"
        with self.job.client.open("GET", address) as answer, open(path, "wb") as file:
            shutil.copyfileobj(answer, file)

    def _part(self, part: str) -> MeshArrays:
        if part not in self._parts:
            document = self.job.client.get_json(f"/v1/jobs/{self.job.id}/{part}?format=json&packed=exact")
            self._parts[part] = MeshArrays.from_packed(document)
        return self._parts[part]

    def __repr__(self) -> str:
        figures = self.statistics["cell"]
        return f"<symcell.Mesh {self.fold}-fold, {figures['elements']} elements a cell, job {self.job.id}>"


def mesh(model: Model, *, server: Optional[str] = None, key: Optional[str] = None,
         progress: Optional[OnProgress] = None, **options: Any) -> Mesh:
    """Meshes a model and waits: `mesh("part.stl", max_volume=10)`. See Client."""
    return Client(server, key).mesh(model, progress=progress, **options)


def inspect(model: Model, *, server: Optional[str] = None, key: Optional[str] = None, **options: Any) -> Dict[str, Any]:
    """Fold, axis, symmetry error and size of a model, without meshing."""
    return Client(server, key).inspect(model, **options)
