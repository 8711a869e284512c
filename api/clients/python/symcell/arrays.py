"""A cell or a full mesh as numpy arrays, from the service's packed JSON, and on to other packages."""

from __future__ import annotations

import base64
from dataclasses import dataclass, field
from typing import Any, Dict, Optional

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

_TYPES = {"uint8": "<u1", "uint16": "<u2", "int32": "<i4", "uint32": "<u4", "int64": "<i8",
          "float32": "<f4", "float64": "<f8"}
# By dimension and order: of elements and of facets.
_MESHIO = {(2, 1): ("triangle", "line"), (2, 2): ("triangle6", "line3"),
           (3, 1): ("tetra", "triangle"), (3, 2): ("tetra10", "triangle6")}
_VTK = {"triangle": 5, "triangle6": 22, "tetra": 10, "tetra10": 24}


def unpack(packed: Dict[str, Any]) -> Array:
    """One packed array: of floats as they are, of integers as int64."""
    shape = tuple(packed["shape"])
    if "value" in packed:
        return np.full(shape, packed["value"], dtype=np.int64)
    data = base64.b64decode(packed["data"])
    if packed["type"] == "uint24":
        parts = np.frombuffer(data, dtype=np.uint8).reshape(-1, 3).astype(np.int64)
        return (parts[:, 0] | parts[:, 1] << 8 | parts[:, 2] << 16).reshape(shape)
    values = np.frombuffer(data, dtype=_TYPES[packed["type"]]).reshape(shape)
    return values.copy() if packed["type"].startswith("float") else values.astype(np.int64)


@dataclass
class MeshArrays:
    """Nodes, elements and groups. Indices count from 0; order 2 has mid-side nodes in VTK's order.

    points: (nodes, 3), z is 0 in the plane.          elements: (elements, 3, 6, 4 or 10)
    regions: (elements,)                               markers: (nodes,)
    boundary: (facets, 2, 3 or 6)                      boundary_markers: (facets,)
    lower, higher: (pairs,), nodes of the two bounds; turned by 360/fold degrees lower[i] is higher[i].
    sector, cell_element: (elements,), of a full mesh; None of a cell.
    """

    dimension: int
    order: int
    fold: int
    axis_origin: Array
    axis_direction: Array
    points: Array
    elements: Array
    regions: Array
    markers: Array
    boundary: Array
    boundary_markers: Array
    lower: Array
    higher: Array
    sector: Optional[Array] = None
    cell_element: Optional[Array] = None
    marker_names: Dict[int, str] = field(default_factory=dict)

    @classmethod
    def from_packed(cls, document: Dict[str, Any]) -> "MeshArrays":
        points = unpack(document["nodes"]).astype(np.float64)
        if "origin" in document:
            points += np.asarray(document["origin"], dtype=np.float64)
        if document["dimension"] == 2:
            points = np.column_stack([points, np.zeros(len(points))])
        elements = unpack(document["elements"])
        sector = cell_element = None
        if "cell_elements" in document:
            index = np.arange(len(elements))
            sector, cell_element = np.divmod(index, document["cell_elements"])
        return cls(
            dimension=document["dimension"], order=document["order"], fold=document["fold"],
            axis_origin=np.asarray(document["axis"]["origin"], dtype=np.float64),
            axis_direction=np.asarray(document["axis"]["direction"], dtype=np.float64),
            points=points, elements=elements, regions=unpack(document["regions"]), markers=unpack(document["markers"]),
            boundary=unpack(document["boundary"]), boundary_markers=unpack(document["boundary_markers"]),
            lower=unpack(document["lower"]), higher=unpack(document["higher"]),
            sector=sector, cell_element=cell_element,
            marker_names={int(marker): name for marker, name in document.get("marker_names", {}).items()})

    def group(self, marker: "int | str") -> Array:
        """Facets of a boundary group, by its number or its name."""
        if isinstance(marker, str):
            numbers = [number for number, name in self.marker_names.items() if name == marker]
            if not numbers:
                raise KeyError(f"there is no group {marker!r}; there are {sorted(self.marker_names.values())}")
            marker = numbers[0]
        facets: Array = self.boundary[self.boundary_markers == marker]
        return facets

    def to_meshio(self) -> Any:
        """A meshio.Mesh of the elements, with `marker`, `region` and, of a full mesh, `sector`."""
        import meshio  # type: ignore

        kind, _ = _MESHIO[self.dimension, self.order]
        cell_data = {"region": [self.regions]}
        if self.sector is not None:
            cell_data["sector"] = [self.sector]
        return meshio.Mesh(self.points, [(kind, self.elements)], point_data={"marker": self.markers},
                           cell_data=cell_data)

    def to_pyvista(self) -> Any:
        """A pyvista.UnstructuredGrid of the elements."""
        import pyvista  # type: ignore

        kind, _ = _MESHIO[self.dimension, self.order]
        corners = self.elements.shape[1]
        cells = np.column_stack([np.full(len(self.elements), corners), self.elements]).ravel()
        types = np.full(len(self.elements), _VTK[kind], dtype=np.uint8)
        grid = pyvista.UnstructuredGrid(cells, types, self.points)
        grid.point_data["marker"] = self.markers
        grid.cell_data["region"] = self.regions
        if self.sector is not None:
            grid.cell_data["sector"] = self.sector
        return grid
