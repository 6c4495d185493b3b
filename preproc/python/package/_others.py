"""Meshes of other libraries, none of which is needed before it is used."""
import numpy

from ._calls import mesh
from ._errors import InvalidInput

_names = {3: "triangle", 4: "tetra", 10: "tetra10"}
_vtk_types = {4: 10, 10: 24}


def to_meshio(mesh):
    """A meshio.Mesh with the points and cells, which are no copies but of second order, and the sets."""
    import meshio

    blocks = [] if mesh.kind == "cloud" else [(_names[mesh.cells.shape[1]], mesh.cells)]
    sets = {name: [rows] for name, rows in (mesh.face_sets if mesh.kind == "surface" else mesh.element_sets).items()}
    if mesh.kind == "volume" and mesh.face_sets:  # their triangles are a block of their own
        blocks.append(("triangle", mesh.triangles))
        none = numpy.empty(0, numpy.int32)
        sets = {name: [rows[0], none] for name, rows in sets.items()}
        sets.update({name: [sets[name][0] if name in sets else none, rows] for name, rows in mesh.face_sets.items()})
    return meshio.Mesh(mesh.points, blocks, point_sets=mesh.node_sets, cell_sets=sets)


def _rows(cells):
    return numpy.hstack([numpy.full((len(cells), 1), cells.shape[1], numpy.int64), cells]).ravel()


def to_pyvista(mesh):
    """A pyvista.PolyData of a surface or a cloud, a pyvista.UnstructuredGrid of tetrahedra.

    Sets of elements, or of a surface's triangles, become cell arrays of 0 and 1; sets of nodes point arrays.
    """
    import pyvista

    if mesh.kind == "volume":
        types = numpy.full(len(mesh.cells), _vtk_types[mesh.cells.shape[1]], numpy.uint8)
        dataset = pyvista.UnstructuredGrid(_rows(mesh.cells), types, mesh.points)
    elif mesh.kind == "surface":
        dataset = pyvista.PolyData(mesh.points, _rows(mesh.cells))
    else:
        return pyvista.PolyData(mesh.points)

    def marked(count, rows):
        marks = numpy.zeros(count, numpy.uint8)
        marks[rows] = 1
        return marks

    for name, rows in (mesh.face_sets if mesh.kind == "surface" else mesh.element_sets).items():
        dataset.cell_data[name] = marked(len(mesh.cells), rows)
    for name, rows in mesh.node_sets.items():
        dataset.point_data[name] = marked(len(mesh.points), rows)
    return dataset


def from_pyvista(dataset, *, unit=""):
    """A Mesh of a pyvista.PolyData (polygons are cut into triangles) or UnstructuredGrid of tetrahedra or triangles."""
    points = numpy.asarray(dataset.points, numpy.float64)
    if hasattr(dataset, "cells_dict"):
        cells = {kind: rows for kind, rows in dataset.cells_dict.items() if len(rows) > 0}
        if len(cells) != 1 or not set(cells) <= {5, 10, 24}:
            raise InvalidInput("the grid holds other cells than tetrahedra of one order, or triangles",
                               what="the grid holds other cells than tetrahedra of one order, or triangles",
                               value=f"VTK's types {sorted(cells)}")
        return mesh(points, next(iter(cells.values())), unit=unit)
    faces = numpy.asarray(dataset.triangulate().faces)
    return mesh(points, faces.reshape(-1, 4)[:, 1:] if faces.size else None, unit=unit)
