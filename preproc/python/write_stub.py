"""Writes the stub of the Python package: its functions with all options that the command declares, for editors and mypy.

usage: write_stub.py __init__.pyi        with the package on PYTHONPATH
"""
import inspect
import sys
import types

# Not needed to ask for the options; pip builds without it.
sys.modules.setdefault("numpy", types.ModuleType("numpy"))
import scan2fea
from scan2fea import _calls

HEAD = '''# Written from the command's options by write_stub.py.
from os import PathLike
from typing import Any, Callable, Literal, NamedTuple, Optional, Sequence, Union

import numpy
from numpy.typing import ArrayLike, NDArray

Path = Union[str, bytes, "PathLike[str]", "PathLike[bytes]"]
Number = Union[int, float, str]
MeshLike = Union["Mesh", Path, tuple[ArrayLike, ArrayLike], tuple[ArrayLike]]
Progress = Callable[[dict[str, Any]], object]
Rows = dict[str, ArrayLike]
__version__: str

class Mesh:
    @property
    def kind(self) -> Literal["surface", "volume", "cloud"]: ...
    @property
    def order(self) -> int: ...
    @property
    def unit(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def points(self) -> NDArray[numpy.float64]: ...
    @property
    def cells(self) -> NDArray[numpy.int32]: ...
    @property
    def triangles(self) -> NDArray[numpy.int32]: ...
    @property
    def node_sets(self) -> dict[str, NDArray[numpy.int32]]: ...
    @property
    def face_sets(self) -> dict[str, NDArray[numpy.int32]]: ...
    @property
    def element_sets(self) -> dict[str, NDArray[numpy.int32]]: ...

class Result(NamedTuple):
    mesh: Mesh
    figures: dict[str, Any]
    warnings: list[str]

def mesh(points: ArrayLike, cells: Optional[ArrayLike] = None, *, unit: str = "", name: str = "mesh",
         node_sets: Optional[Rows] = None, face_sets: Optional[Rows] = None,
         element_sets: Optional[Rows] = None) -> Mesh: ...
def read(file: Path, *, unit: str = "") -> Mesh: ...
def to_meshio(mesh: Mesh) -> Any: ...
def to_pyvista(mesh: Mesh) -> Any: ...
def from_pyvista(dataset: Any, *, unit: str = "") -> Mesh: ...
'''

RETURNS = {"check": "dict[str, Any]", "write": "None"}
LEADING = {"check": "mesh: MeshLike", "write": "mesh: MeshLike, file: Path", "run": "scan: Union[MeshLike, list[MeshLike]]"}
REFERENCE = "reference: Union[MeshLike, list[MeshLike], None] = None"


def type_of(option):
    if not option["value"]:
        return "bool"
    if option["choices"] and len(option["choices"]) == len(option["value"].split("|")):
        one = f"Literal[{', '.join(repr(choice) for choice in option['choices'])}]"
        if all(choice.replace(".", "").isdigit() for choice in option["choices"]):
            one = "Number"  # order=2
    elif "FILE" in option["value"] or option["value"] == "DIR":
        one = "Path"
    else:
        one = "Number"
    if option["at_a_time"] > 1:
        return "Union[Sequence[float], Sequence[Sequence[float]]]"
    return f"Union[{one}, Sequence[{one}]]" if option["is_repeatable"] else one


def signature(command, function):
    name = function.__name__
    keywords = [] if name == "write" else ["progress: Optional[Progress] = None"]
    if name in ("check", "write"):
        keywords.append(REFERENCE)
    keywords += [f"{option['name']}: Optional[{type_of(option)}] = None"
                 for option in _calls._options_of(command).values()
                 if not (name == "write" and option["name"] == "output")]
    lines = ",\n    ".join([LEADING.get(name, "scan: MeshLike"), "*"] + keywords)
    return f"def {name}(\n    {lines},\n) -> {RETURNS.get(name, 'Result')}: ...\n"


# Of the errors and of the warning.
def class_of(kind):
    base = kind.__bases__[0].__name__
    parts = {
        scan2fea.Error: "    what: str\n    where: str\n    value: str\n    limit: str\n    advice: str\n"
                        "    at: Optional[tuple[float, float, float]]\n    exit_code: int\n",
        scan2fea.GateFailed: "    figures: dict[str, Any]\n",
    }
    return f"class {kind.__name__}({base}):" + ("\n" + parts[kind] if kind in parts else " ...\n")


errors = [value for value in vars(scan2fea).values() if inspect.isclass(value) and issubclass(value, Exception)]
errors.sort(key=lambda kind: len(kind.__mro__))
with open(sys.argv[1], "w", encoding="utf-8") as stub:
    stub.write(HEAD)
    stub.writelines(signature(*item) for item in _calls.functions.items())
    stub.writelines(class_of(kind) for kind in errors)
