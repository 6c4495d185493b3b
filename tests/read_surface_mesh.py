"""Reads a surface with a library that knows nothing of scan2fea and prints what the tests compare.

usage: read_surface_mesh.py meshio|vtk FILE
prints: surface POINTS TRIANGLES AREA VOLUME, and for each set that the library tells: set NAME SIZE. VOLUME is that which
the triangles enclose, positive where they look outwards. Exit status 77: the library is not installed.
"""
import sys


def by_vtk(name):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    if name.endswith(".exo"):
        reader = vtk.vtkExodusIIReader()
        reader.SetFileName(name)
        reader.UpdateInformation()
        arrays = {}
        for kind, word in ((reader.NODE_SET, "node_set "), (reader.ELEM_SET, "face_set ")):
            for i in range(reader.GetNumberOfObjects(kind)):
                key = word + reader.GetObjectName(kind, i).split(" ID:")[0].removeprefix("Unnamed ")
                arrays[key] = numpy.ones(reader.GetNumberOfEntriesInObject(kind, i))
        reader.Update()
        grid = reader.GetOutput().GetBlock(0).GetBlock(0)
        triangles = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 3)
        return vtk_to_numpy(grid.GetPoints().GetData()), triangles, arrays
    reader = vtk.vtkXMLPolyDataReader() if name.endswith(".vtp") else vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    data = reader.GetOutput()
    cells = data.GetPolys() if name.endswith(".vtp") else data.GetCells()
    arrays = {}
    for part in (data.GetCellData(), data.GetPointData()):
        for i in range(part.GetNumberOfArrays()):
            arrays[part.GetArrayName(i)] = vtk_to_numpy(part.GetArray(i))
    triangles = vtk_to_numpy(cells.GetConnectivityArray()).reshape(-1, 3)
    return vtk_to_numpy(data.GetPoints().GetData()), triangles, arrays


def by_meshio(name):
    import meshio

    mesh = meshio.read(name)
    arrays = {key: numpy.concatenate(value) for key, value in mesh.cell_data.items()}
    arrays.update(mesh.point_data)
    for key, value in list(mesh.cell_sets_dict.items()):
        arrays["face_set " + key] = numpy.ones(sum(len(members) for members in value.values()))
    for key, members in mesh.point_sets.items():
        arrays["node_set " + key] = numpy.ones(len(members))
    return mesh.points, mesh.cells_dict["triangle"], arrays


try:
    import numpy

    points, triangles, arrays = {"meshio": by_meshio, "vtk": by_vtk}[sys.argv[1]](sys.argv[2])
except ImportError:
    sys.exit(77)

a, b, c = (points[triangles[:, k]] for k in range(3))
normals = numpy.cross(b - a, c - a) / 2
for key, values in arrays.items():
    kind, _, plain = key.partition(" ")
    if kind in ("node_set", "face_set"):
        print("set", plain, int(numpy.count_nonzero(values)))
print("surface", len(points), len(triangles), repr(float(numpy.linalg.norm(normals, axis=1).sum())),
      repr(float((a * normals).sum() / 3)))
