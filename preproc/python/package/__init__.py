"""From a scanned surface to a finite-element mesh: the sub-commands of scan2fea on NumPy arrays.

    import scan2fea
    result = scan2fea.run("scan.ply", edge_length=1.5, order=2, unit="mm")
    result.mesh.points, result.mesh.cells      # (n, 3) float64, (m, 10) int32
    result.figures["volume_mesh"]["scaled_jacobian"]["min"]
    scan2fea.write(result.mesh, "part.inp")

Points are (n, 3) in model units, cells (m, 3) triangles, (m, 4) or (m, 10) tetrahedra. Options are the command's, with
_ for -; so are figures, files and failures. See help(scan2fea.run).
"""
import atexit as _atexit

from . import _scan2fea
from ._calls import (Result, check, enrich, faces, mesh, read, reconstruct, repair, run, simplify, surface,
                     tetrahedralize, write)
from ._errors import (Cancelled, Error, GateFailed, InvalidInput, IoError, MeshingFailed, MeshWarning, NotMeshable,
                      OutOfTime, WrongUsage)
from ._others import from_pyvista, to_meshio, to_pyvista
from ._scan2fea import Mesh

__version__ = _scan2fea.version
__all__ = ["Mesh", "Result", "mesh", "read", "write", "run", "surface", "repair", "reconstruct", "enrich", "simplify",
           "tetrahedralize", "faces", "check", "to_meshio", "to_pyvista", "from_pyvista", "Error", "WrongUsage",
           "InvalidInput", "NotMeshable", "OutOfTime", "MeshingFailed", "IoError", "Cancelled", "GateFailed",
           "MeshWarning"]

_atexit.register(_scan2fea.wait_for_ending)
