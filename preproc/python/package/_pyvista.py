"""`dataset.scan2fea` in PyVista, from 0.48 on, which finds this by the entry point `pyvista.accessors`."""
import pyvista

from . import _calls
from ._others import from_pyvista, to_pyvista


@pyvista.register_dataset_accessor("scan2fea", pyvista.DataSet)
class Accessor:
    """The functions of scan2fea on this dataset, with their keywords: `mesh.scan2fea.run(faces=12000).plot()`.

    Those that make a mesh give it as a dataset (to_pyvista), `check` and `faces` what the functions give.
    """

    def __init__(self, dataset):
        self._dataset = dataset

    def check(self, **options):
        return _calls.check(from_pyvista(self._dataset), **options)

    def faces(self, **options):
        return _calls.faces(from_pyvista(self._dataset), **options)


def _add(function):
    def method(self, **options):
        return to_pyvista(function(from_pyvista(self._dataset), **options).mesh)

    method.__name__ = function.__name__
    method.__doc__ = f"scan2fea.{function.__name__} of this dataset, as a dataset."
    setattr(Accessor, function.__name__, method)


for _function in (_calls.run, _calls.surface, _calls.repair, _calls.reconstruct, _calls.enrich, _calls.simplify,
                  _calls.tetrahedralize):
    _add(_function)
