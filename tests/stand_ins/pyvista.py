"""What scan2fea uses of PyVista, which Debian 12 does not have: its names, shapes and defaults, and nothing more."""
import numpy

_accessors = {}


def register_dataset_accessor(name, target_cls, *, override=False):
    def decorate(accessor):
        _accessors[name] = target_cls, accessor
        return accessor
    return decorate


class DataSet:
    def __init__(self, points):
        self.points = numpy.asarray(points)
        self.cell_data, self.point_data = {}, {}

    def __getattr__(self, name):
        target_cls, accessor = _accessors.get(name, (type(None), None))
        if not isinstance(self, target_cls):
            raise AttributeError(name)
        return accessor(self)


class PolyData(DataSet):
    """`faces`: of each polygon its number of corners, and these."""

    def __init__(self, points, faces=None):
        super().__init__(points)
        self.faces = numpy.empty(0, numpy.int64) if faces is None else numpy.asarray(faces)

    def triangulate(self):
        triangles = []
        rest = list(self.faces)
        while rest:
            corners, rest = rest[1:1 + rest[0]], rest[1 + rest[0]:]
            for k in range(1, len(corners) - 1):
                triangles += [3, corners[0], corners[k], corners[k + 1]]
        return PolyData(self.points, triangles)


class UnstructuredGrid(DataSet):
    """`cells`: as of polygons; of one type of VTK's alone, here."""

    def __init__(self, cells, celltypes, points):
        super().__init__(points)
        self.cells, self.celltypes = numpy.asarray(cells), numpy.asarray(celltypes)

    @property
    def cells_dict(self):
        rows = self.cells.reshape(len(self.celltypes), -1)[:, 1:]
        return {int(self.celltypes[0]): rows}
