"""Reads a mesh with a library that knows nothing of scan2fea and prints what the tests compare.

usage: read_volume_mesh.py meshio|vtk FILE
prints: nodes tetrahedra volume largest_midpoint_error

The last figure is the largest distance of a mid-edge node from the middle of its edge, by the library's own order of
nodes: it is zero for straight edges only if the writer's order is right. Exit status 77: the library is not installed.
"""
import sys

EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))  # of both libraries' quadratic tetrahedron


def by_meshio(name):
    import meshio

    mesh = meshio.read(name)
    kind = "tetra10" if "tetra10" in mesh.cells_dict else "tetra"
    return mesh.points, mesh.cells_dict[kind]


def by_vtk(name):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    kind = {10: 4, 24: 10}[grid.GetCellType(0)]
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, kind)
    return vtk_to_numpy(grid.GetPoints().GetData()), cells


try:
    import numpy

    points, cells = {"meshio": by_meshio, "vtk": by_vtk}[sys.argv[1]](sys.argv[2])
except ImportError:
    sys.exit(77)

a, b, c, d = (points[cells[:, k]] for k in range(4))
volume = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a).sum() / 6
error = 0.0
if cells.shape[1] == 10:
    for k, (i, j) in enumerate(EDGES):
        middle = (points[cells[:, i]] + points[cells[:, j]]) / 2
        error = max(error, abs(points[cells[:, 4 + k]] - middle).max())
print(len(points), len(cells), repr(float(volume)), repr(float(error)))
