"""Client of the Symcell service.

    import symcell
    mesh = symcell.mesh("part.stl", max_volume=10)
    mesh.cell.points, mesh.cell.elements        # numpy arrays
    mesh.full.to_meshio().write("full.xdmf")

Needs the standard library and numpy; meshio and PyVista where their methods are called.
"""

from .client import Client, Job, JobCancelled, JobFailed, Mesh, Problem, Progress, inspect, mesh
from .arrays import Array, MeshArrays

__all__ = ["Array", "Client", "Job", "JobCancelled", "JobFailed", "Mesh", "MeshArrays", "Problem", "Progress",
           "inspect", "mesh"]
__version__ = "0.1.0"
