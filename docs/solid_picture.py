#!/usr/bin/python3
"""Pictures and figures of meshes of solids, for the documents.

    solid_picture.py picture CELL.vtu OUT.svg [--full FULL.vtu] [--width PIXELS]
    solid_picture.py histogram NAME=MESH.vtu ...

picture: the cell seen from the side of its lower bound (red) and from that of its higher bound
(blue), before them the full mesh with the cell picked out, if it is given. histogram: rows of a
Markdown table of aspect ratios (longest edge / smallest height) in shares of the elements.
Meshes are tetrahedra in VTU files of symcell's own, `--encoding raw`. Needs numpy.
"""

import argparse
import re
import sys
import xml.etree.ElementTree

import numpy as np

DTYPES = {"Int32": "<i4", "Int64": "<i8", "Float64": "<f8", "UInt8": "u1"}
FACES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])  # outward
BINS = [1.5, 2, 2.5, 3, 4, 6, 10, 15]
NAMES = ["< 1.5", "1.5–2", "2–2.5", "2.5–3", "3–4", "4–6", "6–10", "10–15", "> 15"]
COLOURS = {"model": (198, 206, 216), "lower": (214, 36, 36), "higher": (36, 84, 214),
           "cell": (240, 178, 60)}
LIGHT = np.array([0.2, 0.4, 0.9])  # in the camera's frame: right, up, towards the eye


class Mesh:
    """Points, corners of the tetrahedra and the arrays by name."""

    def __init__(self, path):
        raw = open(path, "rb").read()
        cut = raw.find(b"<AppendedData")
        if cut < 0:
            sys.exit(f"{path}: no appended data; write it with --encoding raw")
        root = xml.etree.ElementTree.fromstring(raw[:cut] + b"</VTKFile>")
        if root.get("compressor"):
            sys.exit(f"{path} is compressed; write it with --encoding raw")
        data = raw[re.compile(rb"<AppendedData[^>]*>\s*_").search(raw, cut).end():]
        self.arrays = {}
        for element in root.iter("DataArray"):
            at = int(element.get("offset"))
            size = int(np.frombuffer(data, "<u8", 1, at)[0])
            values = np.frombuffer(data[at + 8:at + 8 + size], DTYPES[element.get("type")])
            width = int(element.get("NumberOfComponents", "1"))
            self.arrays[element.get("Name")] = values.reshape(-1, width) if width > 1 else values
        kind = int(self.arrays["types"][0])
        if kind not in (10, 24):
            sys.exit(f"{path} holds no tetrahedra")
        self.points = self.arrays["Points"]
        self.tets = self.arrays["connectivity"].reshape(-1, 4 if kind == 10 else 10)[:, :4]
        self.axis = self.arrays["axis_direction"].ravel()
        self.origin = self.arrays["axis_origin"].ravel()

    def boundary(self):
        """Faces of one element, outward, and those elements."""
        faces = self.tets[:, FACES].reshape(-1, 3)
        _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True,
                                    return_counts=True)
        once = np.sort(first[count == 1])
        return faces[once], once // 4


def bounds(mesh, faces):
    """"lower", "higher" or "model" for every boundary face of a cell."""
    images = mesh.arrays["lower_to_higher"][faces]
    index = {tuple(sorted(face)): i for i, face in enumerate(faces.tolist())}
    kinds = np.full(len(faces), "model", dtype="<U6")
    for i in np.flatnonzero((images >= 0).all(axis=1)):
        image = index.get(tuple(sorted(images[i].tolist())))
        if image is not None and image != i:
            kinds[i], kinds[image] = "lower", "higher"
    return kinds


def frame(mesh, cell):
    """The axis, the direction from it to the cell and the one across."""
    middle = cell.points.mean(axis=0) - mesh.origin
    radial = middle - (middle @ mesh.axis) * mesh.axis
    if np.linalg.norm(radial) < 1e-9 * np.ptp(cell.points, axis=0).max():
        radial = np.cross(mesh.axis, np.eye(3)[np.argmin(np.abs(mesh.axis))])
    radial /= np.linalg.norm(radial)
    return mesh.axis, radial, np.cross(mesh.axis, radial)


def polygons(mesh, faces, kinds, eye, up):
    """Visible faces from far to near: corners in the picture's plane, and fill colours."""
    eye = eye / np.linalg.norm(eye)
    right = np.cross(up, eye)
    right /= np.linalg.norm(right)
    camera = np.stack([right, np.cross(eye, right), eye])
    corners = mesh.points[faces] @ camera.T
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    front = np.flatnonzero(normals[:, 2] > 0)
    order = front[np.argsort(corners[front, :, 2].mean(axis=1), kind="stable")]
    light = 0.45 + 0.55 * np.clip(normals[order] @ (LIGHT / np.linalg.norm(LIGHT)), 0, 1)
    base = np.array([COLOURS[kind] for kind in kinds[order]])
    return corners[order, :, :2], np.rint(base * light[:, None]).astype(int)


def panel(shapes, colours, left, size):
    """SVG of one view in a square of `size` pixels; y points down."""
    low, high = shapes.min(axis=(0, 1)), shapes.max(axis=(0, 1))
    scale = 0.9 * size / (high - low).max()
    at = (shapes - 0.5 * (low + high)) * scale * [1, -1] + [left + size / 2, size / 2]
    line = min(0.6, 0.12 * scale * np.sqrt(np.median(np.abs(
        np.cross(shapes[:, 1] - shapes[:, 0], shapes[:, 2] - shapes[:, 0])))))
    rows = [f'<g stroke="#1b2733" stroke-width="{line:.2f}" stroke-linejoin="round">']
    for shape, colour in zip(at, colours):
        path = " ".join(f"{x:.1f},{y:.1f}" for x, y in shape)
        rows.append(f'<polygon fill="#{colour[0]:02x}{colour[1]:02x}{colour[2]:02x}" '
                    f'points="{path}"/>')
    return rows + ["</g>"]


def picture(options):
    cell = Mesh(options.cell)
    faces, _ = cell.boundary()
    kinds = bounds(cell, faces)
    axis, radial, across = frame(cell, cell)
    views = []
    if options.full:
        full = Mesh(options.full)
        shell, elements = full.boundary()
        sector = full.arrays["sector"][elements]
        views.append(polygons(full, shell, np.where(sector == 0, "cell", "model"),
                              radial + 0.2 * across + 0.9 * axis, axis))
    views.append(polygons(cell, faces, kinds, 0.3 * radial - across + 0.5 * axis, axis))
    views.append(polygons(cell, faces, kinds, 0.3 * radial + across + 0.5 * axis, axis))
    size = options.width / len(views)
    rows = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {options.width} {size:.0f}">']
    for i, (shapes, colours) in enumerate(views):
        rows += panel(shapes, colours, i * size, size)
    with open(options.out, "w", encoding="utf-8") as file:
        file.write("\n".join(rows + ["</svg>", ""]))


def aspects(mesh):
    p = [mesh.points[mesh.tets[:, i]] for i in range(4)]
    six = np.abs(np.einsum("ij,ij->i", np.cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]))
    longest = np.max([np.linalg.norm(p[i] - p[j], axis=1) for i in range(4) for j in range(i)],
                     axis=0)
    doubled = np.max([np.linalg.norm(np.cross(p[b] - p[a], p[c] - p[a]), axis=1)
                      for a, b, c in FACES], axis=0)
    return longest * doubled / six


def histogram(options):
    print("| mesh | tetrahedra | " + " | ".join(NAMES) + " | worst |")
    print("| --- | ---: |" + " ---: |" * (len(NAMES) + 1))
    for entry in options.meshes:
        name, _, path = entry.rpartition("=")
        values = aspects(Mesh(path))
        counts = np.bincount(np.digitize(values, BINS), minlength=len(NAMES))
        shares = " | ".join(f"{100 * n / len(values):.1f} %" if n else "0" for n in counts)
        print(f"| {name or path} | {len(values):,} | {shares} | {values.max():.1f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser("picture")
    one.add_argument("cell")
    one.add_argument("out")
    one.add_argument("--full")
    one.add_argument("--width", type=int, default=1200)
    one.set_defaults(run=picture)
    two = commands.add_parser("histogram")
    two.add_argument("meshes", nargs="+", metavar="NAME=MESH.vtu")
    two.set_defaults(run=histogram)
    options = parser.parse_args()
    options.run(options)


if __name__ == "__main__":
    main()
