"""The sub-commands as functions. Their options are those that the command declares: none is named here."""
import json
import os
import textwrap
import warnings
from typing import NamedTuple

import numpy

from . import _scan2fea
from ._errors import GateFailed, MeshWarning


class Result(NamedTuple):
    """What a call gives: `mesh`, the `figures` that `--json` of the command writes, and `warnings`, one line each."""

    mesh: object
    figures: dict
    warnings: list


def mesh(points, cells=None, *, unit="", name="mesh", node_sets=None, face_sets=None, element_sets=None):
    """A mesh of arrays, which are copied.

    points: (n, 3) float64, model units.
    cells: (m, 3) triangles, counter-clockwise seen from outside, or (m, 4) or (m, 10) tetrahedra, integers; the nodes in
        the middle of edges are in the order of VTK, Abaqus and meshio. Without cells it is a point cloud.
    unit: of length, "mm"; name: what messages call it.
    node_sets, face_sets, element_sets: {name: rows} of points, triangles (of a surface), tetrahedra; of a mask take
        numpy.flatnonzero.

    Of tetrahedra, points that none uses are left out. Raises InvalidInput for what is no mesh.
    """
    points = numpy.asarray(points)
    cells = numpy.empty((0, 0), numpy.int64) if cells is None else numpy.asarray(cells)
    if points.ndim != 2 or points.shape[1] != 3 or points.dtype.kind not in "fiu":
        raise TypeError(f"points are an array of numbers of shape (n, 3), not {points.dtype} {points.shape}")
    if cells.ndim != 2 or cells.shape[1] not in (0, 3, 4, 10) or cells.dtype.kind not in "iu":
        raise TypeError(f"cells are an array of integers of shape (m, 3), (m, 4) or (m, 10), not {cells.dtype} {cells.shape}")
    corners = cells.shape[1]
    return _scan2fea.mesh_of_arrays(
        numpy.ascontiguousarray(points, numpy.float64), numpy.ascontiguousarray(cells, numpy.int64), os.fsencode(unit),
        os.fsencode(name), _sets("node_sets", node_sets, corners > 0), _sets("face_sets", face_sets, corners == 3),
        _sets("element_sets", element_sets, corners > 3))


# {name: list of rows}. An array of True and False would be rows 0 and 1.
def _sets(kind, sets, are_taken):
    rows = {}
    for name, given in dict(sets or {}).items():
        members = numpy.asarray(given)
        if not are_taken:
            raise TypeError(f"{kind}: a mesh with such cells takes none, and so not {name!r}")
        if members.ndim != 1 or (members.size > 0 and members.dtype.kind not in "iu"):
            raise TypeError(f"{kind}: a set is a list of rows, and {name!r} is {members.dtype} {members.shape}")
        rows[os.fsencode(name)] = members.tolist()
    return rows


def _is_path(given):
    return isinstance(given, (str, bytes, os.PathLike))


def _path(given):
    name = os.fsencode(given)
    if b"\0" in name:  # which would end it
        raise ValueError("embedded null byte")
    return name


# As a list of meshes or None, and one of the names by which messages call them.
def _sources(given):
    several = given if isinstance(given, list) else [given]
    for one in several:
        if not (_is_path(one) or isinstance(one, _scan2fea.Mesh) or (isinstance(one, tuple) and len(one) < 3)):
            raise TypeError(f"a Mesh, a file's name or (points, cells) is needed, not {type(one).__name__}")
    meshes = [None if _is_path(one) else one if isinstance(one, _scan2fea.Mesh) else mesh(*one) for one in several]
    return meshes, [_path(one if held is None else held.name) for one, held in zip(several, meshes)]


def _text(value):
    if isinstance(value, (bool, numpy.bool_)):
        return b"true" if value else b"false"
    if _is_path(value):
        return _path(value)
    number = float(value) if isinstance(value, (float, numpy.floating)) else value
    if isinstance(number, float) and number.is_integer() and abs(number) < 1e15:
        number = int(number)
    if not isinstance(number, (int, float, numpy.integer)):
        raise TypeError(f"an option takes text, numbers, True or False, or lists of these, not {type(value).__name__}")
    return repr(number).encode() if isinstance(number, float) else str(number).encode()


# What the option takes at a time, as often as it is given: set=["a=z<1", "b=z>9"], size_ball=[0, 0, 0, 5, 1] or a list
# of such.
def _values(name, value, at_a_time):
    if isinstance(value, numpy.ndarray):
        value = value.tolist()
    if not isinstance(value, (list, tuple)):
        return [[_text(value)]]
    if at_a_time > 1 and value and not isinstance(value[0], (list, tuple)):
        value = [value]
    return [[_text(part) for part in (one if isinstance(one, (list, tuple)) else [one])] for one in value]


_declared = {}


def _options_of(command):
    if command not in _declared:
        _declared[command] = {option["name"]: option for option in _scan2fea.options(command)}
    return _declared[command]


def _keywords(command, options):
    declared = _options_of(command)
    keywords = []
    for name, value in options.items():
        if value is None:
            continue
        values = _values(name, value, declared[name]["at_a_time"] if name in declared else 1)
        if values:
            keywords.append((name, values))
    return keywords


# False of NumPy is False, too.
def _told(progress):
    if progress is None:
        return None

    def tell(line):
        answer = progress(json.loads(line))
        return not isinstance(answer, (bool, numpy.bool_)) or bool(answer)

    return tell


def _warn(lines):
    for line in lines:
        warnings.warn(line, MeshWarning, stacklevel=4)


def _call(command, given, options, progress=None, reference=None):
    inputs, names = _sources(given)
    if not names or (len(names) > 1 and command != "run"):
        raise TypeError(f"{command} takes {'at least ' if command == 'run' else ''}one mesh, not {len(names)}")
    for name in ("input", "more"):
        if name in options:
            raise TypeError(f"{command} takes its meshes first, and no keyword {name}")
    keywords = [("input", [[names[0]]])] + ([("more", [[name] for name in names[1:]])] if names[1:] else [])
    references = []
    if reference is not None:
        references, names = _sources(reference)
        keywords.append(("reference", [[name] for name in names]))
    code, figures, made, told, failures = _scan2fea.call(
        command, keywords + _keywords(command, options), inputs, references, _told(progress))
    _warn(told)
    figures = json.loads(figures) if figures else {}
    if code != 0:
        raise GateFailed("\n".join(failures), figures)
    return Result(made, figures, told)


def read(file, *, unit=""):
    """The mesh that a file holds: a surface, tetrahedra or a point cloud, in any format that the command reads.

    unit: of length, where the file tells none. Returns a Mesh; warns of what of the file is not in it.
    """
    made, told = _scan2fea.read(_path(file), unit)
    _warn(told)
    return made


def check(mesh, *, reference=None, progress=None, **options):
    """Figures of a surface or a volume mesh, as a dictionary: what `scan2fea check --json` writes.

    mesh, reference: a Mesh, a file's name, or (points, cells). Raises GateFailed where a gate fails.
    """
    return _call("check", mesh, options, progress, reference).figures


def faces(scan, *, progress=None, **options):
    """The faces of a part: what each is, with the names that `set` takes.

    Returns a Result: the surface after repair, with a set for each face, and figures, `faces` among them.
    """
    return _call("faces", scan, options, progress)


def write(mesh, file, *, reference=None, **options):
    """Writes a mesh in the format of the extension, whole or not at all; the same bytes as the command's.

    mesh: a Mesh, a file's name (then it is converted), or (points, cells). Tetrahedra into a format of surfaces give
    their boundary. Viewers' files (.vtu, .vtp) also hold measures of each element and, of what was made here, each
    point's distance from what it was made of, or from `reference`. A file that exists is an error without force=True.
    """
    _call("convert", mesh, {**options, "output": file}, None, reference)


def _maker(command, text):
    def function(scan, *, progress=None, **options):
        return _call(command, scan, options, progress)

    function.__name__ = function.__qualname__ = command
    function.__doc__ = text + """

    scan: a Mesh, a file's name, or (points, cells); points are (n, 3) in model units.
    progress: called several times a second with a dictionary, {"stage": "simplify", "words": "laying triangles",
        "fraction": 0.43, "seconds": 2.1, "seconds_left": 2.7}; where it returns False the call raises Cancelled.
    Other keywords are the command's options, `edge_length=1.5` for `--edge-length 1.5`: numbers, text ("0.1%"), True,
    or lists where an option may be given several times. With `output` the mesh is written, too.

    Returns a Result. Raises Error, with the parts of its message, and GateFailed where a gate fails. Other threads of
    Python run meanwhile; an interrupt raises KeyboardInterrupt at once, and the work ends a little later by itself.
    """
    return function


run = _maker("run", "The whole chain: of a scan or a point cloud, or a list of bodies that touch, a volume mesh.")
surface = _maker("surface", "The surface stages alone: of a cloud reconstruct, then repair, enrich, simplify.")
repair = _maker("repair", "One stage: close, orient and clean a scanned surface.")
reconstruct = _maker("reconstruct", "One stage: a closed surface through the points of a cloud, or of a surface.")
enrich = _maker("enrich", "One stage: add points where the scanner left too few.")
simplify = _maker("simplify", "One stage: fewer and better triangles on a repaired surface.")
tetrahedralize = _maker("tetrahedralize", "One stage: fill a closed surface with tetrahedra, its triangles kept.")

functions = {"run": run, "surface": surface, "repair": repair, "reconstruct": reconstruct, "enrich": enrich,
             "simplify": simplify, "tetrahedralize": tetrahedralize, "faces": faces, "check": check, "convert": write}


def _option_text(option):
    value = f": {option['value']}" if option["value"] else ": True or False"
    default = f" (default {option['default']})" if option["default"] else ""
    return textwrap.fill(f"{option['name']}{value}. {option['text']}{default}", 100, initial_indent="    ",
                         subsequent_indent="        ")


# The options stand in the texts of all functions, as the command declares them.
for _name, _function in functions.items():
    _function.__doc__ += "\n    Options:\n" + "\n".join(
        _option_text(option) for option in _options_of(_name).values() if option["name"] != "output" or _name != "convert")
