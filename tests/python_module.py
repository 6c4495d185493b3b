"""Uses the Python module, and holds it against the command.

usage: python_module.py --command SCAN2FEA --scan SCAN.ply --readme README.md      with the module on PYTHONPATH
Prints what is wrong, one line each; exit status 1 if anything is, 77 where NumPy or the module is not installed.
"""
import argparse
import gc
import json
import os
import pickle
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from functools import partial

from expectations import expect, wrong

try:
    import numpy
    import scan2fea
except ImportError as error:
    print(error)
    sys.exit(77)


def by_command(command, *arguments):
    done = subprocess.run([command, *arguments], capture_output=True, text=True, check=False)
    expect(done.returncode == 0, f"{arguments} succeeds: {done.stderr}")
    return json.loads(done.stdout)


# Without what differs from one run to the next: who called, what is written, how long it took.
def comparable(figures):
    kept = {name: value for name, value in figures.items() if name not in ("command", "outputs")}
    kept["stages"] = [{name: value for name, value in stage.items() if name not in ("seconds", "peak_bytes")}
                      for stage in figures.get("stages", [])]
    return json.dumps(kept, sort_keys=True)


def contents(file):
    with open(file, "rb") as stream:
        return stream.read()


# Points of a ball and its triangles: an octahedron, each triangle in four, again and again.
def ball(times, radius=10.0):
    points = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    cells = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    for _ in range(times):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                middles[key] = len(points)
                points.append(tuple((p + q) / 2 for p, q in zip(points[a], points[b])))
            return middles[key]

        for a, b, c in cells:
            d, e, f = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, d, f), (d, b, e), (f, e, c), (d, e, f)]
        cells = finer
    points = numpy.array(points, float)
    return radius * points / numpy.linalg.norm(points, axis=1)[:, None], numpy.array(cells)


def compare_with_command(command, scan, folder):
    options = ["--faces", "1500", "--order", "2", "--unit", "mm", "--effort", "low", "--set", "fixed=z<5"]
    keywords = {"faces": 1500, "order": 2, "unit": "mm", "effort": "low", "set": ["fixed=z<5"]}
    file = os.path.join(folder, "command.vtu")
    told = by_command(command, "run", scan, "-o", file, "--json", "-", *options)
    of_file = scan2fea.run(scan, **keywords)
    expect(comparable(of_file.figures) == comparable(told), "run's figures are the command's")
    of_mesh = scan2fea.run(scan2fea.read(scan), **keywords)
    expect(comparable(of_mesh.figures) == comparable(told), "of a mesh in memory, too")
    for extension in ("vtu", "inp", "med", "msh"):
        theirs, ours = (os.path.join(folder, f"{who}.{extension}") for who in ("theirs", "ours"))
        subprocess.run([command, "run", scan, "-o", theirs, "--quiet", *options], check=True) if extension == "inp" \
            else None
        scan2fea.write(of_mesh.mesh, ours)
        if extension == "inp":
            expect(contents(theirs) == contents(ours), "the bytes of an .inp are the command's")
        expect(scan2fea.read(ours).points.shape == of_mesh.mesh.points.shape, f"{extension} holds all points")
    expect(contents(file) == contents(os.path.join(folder, "ours.vtu")), "the bytes of a .vtu are the command's")

    inp = os.path.join(folder, "ours.inp")
    told = by_command(command, "check", inp, "--reference", scan, "--json", "-")
    expect(comparable(scan2fea.check(inp, reference=scan)) == comparable(told), "check's figures are the command's")
    checked = scan2fea.check(scan2fea.read(inp), reference=scan2fea.read(scan))
    expect(comparable(checked) == comparable(told), "of meshes in memory, too")
    return of_mesh


def compare_faces(command, folder):
    part = os.path.join(folder, "dome.ply")
    points, cells = ball(3)
    scan2fea.write((numpy.maximum(points, [-20, -20, 0]), cells), part)  # flat below
    told = by_command(command, "faces", part, "--json", "-")
    named = scan2fea.faces(scan2fea.read(part))
    expect(comparable(named.figures) == comparable(told), "the figures of faces are the command's")
    expect([len(rows) for rows in named.mesh.face_sets.values()] == [face["triangles"] for face in told["faces"]],
           "each face is a set of so many triangles")
    expect({face["kind"] for face in told["faces"]} == {"plane", "sphere"}, "of a dome, the plane and the sphere")


def compare_stages(command, folder):
    surface = os.path.join(folder, "ball.ply")
    scan2fea.write(ball(3), surface)
    mesh = scan2fea.read(surface)
    for stage, keywords in (("repair", {}), ("enrich", {"sampling_radius": 1}), ("simplify", {"faces": 300}),
                            ("reconstruct", {}), ("surface", {"edge_length": 2.5}), ("tetrahedralize", {"order": 2})):
        options = [part for name, value in keywords.items() for part in ("--" + name.replace("_", "-"), str(value))]
        file = os.path.join(folder, f"{stage}.{'msh' if stage == 'tetrahedralize' else 'ply'}")
        told = by_command(command, stage, surface, "-o", file, "--json", "-", *options)
        made = getattr(scan2fea, stage)(mesh, **keywords)
        ours = os.path.join(folder, "ours-" + os.path.basename(file))
        scan2fea.write(made.mesh, ours)
        expect(contents(file) == contents(ours), f"{stage} makes the command's bytes")
        for name in ("surface", "deviation", "volume_mesh"):
            expect(made.figures.get(name) == told.get(name), f"{stage}'s figures of {name} are the command's")


def look_at_arrays(mesh):
    points, cells = mesh.points, mesh.cells
    expect(points.dtype == numpy.float64 and points.ndim == 2 and points.shape[1] == 3, "points are (n, 3) float64")
    expect(cells.dtype == numpy.int32 and cells.shape[1] == 10, "cells of second order are (m, 10) int32")
    expect(cells.min() == 0 and cells.max() == len(points) - 1, "cells are rows of points")
    expect(points.base is mesh and numpy.shares_memory(points, mesh.points), "points are a view")
    expect(not points.flags.writeable, "a view is not to be written")
    a, b, c, d = (points[cells[:, i]] for i in range(4))
    volumes = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a) / 6
    expect((volumes > 0).all(), "tetrahedra are positive")
    middles = numpy.abs(points[cells[:, 4]] - (a + b) / 2).max()
    expect(middles < numpy.abs(b - a).max() / 2, "the fifth node is between the first two")
    area = numpy.cross(*(points[mesh.triangles[:, i]] - points[mesh.triangles[:, 0]] for i in (1, 2)))
    expect(numpy.abs(area.sum(axis=0)).max() < 1e-9 * numpy.abs(area).sum(), "the boundary is closed")
    expect(len(mesh.face_sets["fixed"]) > 0, "a set that was asked for has triangles")
    first_order = scan2fea.tetrahedralize(scan2fea.mesh(*ball(2))).mesh
    expect(first_order.cells.base is first_order and first_order.cells.shape[1] == 4, "cells of first order are a view")
    kept, before = first_order.points, first_order.points.copy()
    del first_order
    gc.collect()
    expect((kept == before).all(), "a view keeps its mesh")


def make_of_arrays():
    points, cells = ball(2)
    for kind in (numpy.int32, numpy.int64, numpy.uint32):
        mesh = scan2fea.mesh(points, cells.astype(kind), unit="mm", face_sets={"top": [0, 1]})
        expect((mesh.cells == cells).all() and (mesh.points == points).all(), f"arrays of {kind} come back")
        expect(list(mesh.face_sets["top"]) == [0, 1] and mesh.unit == "mm", "so do sets and unit")
    filled = scan2fea.tetrahedralize((points, cells))
    again = scan2fea.mesh(filled.mesh.points, filled.mesh.cells, element_sets={"all": range(len(filled.mesh.cells))})
    expect(scan2fea.check(again)["volume_mesh"] == filled.figures["volume_mesh"], "tetrahedra of arrays are the same")
    for bad in (cells - 1, cells + 1):
        try:
            scan2fea.mesh(points, bad)
            expect(False, "an index out of range is refused")
        except scan2fea.InvalidInput as error:
            expect("cells[" in error.where and error.value in ("-1", str(len(points))), f"with its place: {error}")
    with numpy.errstate(invalid="ignore"):
        points[7, 1] = numpy.nan
    try:
        scan2fea.mesh(points, cells)
        expect(False, "a coordinate that is no number is refused")
    except scan2fea.InvalidInput as error:
        expect(error.where == "mesh: points[7]", f"with its place: {error}")
    for bad in ((points[:, :2], cells), (points, cells.astype(float)), (points, cells[:, :2])):
        failure(TypeError, scan2fea.mesh, *bad)
    points, cells = ball(2)
    for bad in (numpy.arange(len(cells)) > 5, [0.0, 1.0], None, 3, "top"):
        failure(TypeError, scan2fea.mesh, points, cells, face_sets={"top": bad})
    for bad in ([0], {1: [0]}):
        failure(TypeError, scan2fea.mesh, points, cells, face_sets=bad)
    failure(TypeError, scan2fea.mesh, points, cells, element_sets={"all": [0]})
    failure(TypeError, scan2fea.mesh, filled.mesh.points, filled.mesh.cells, face_sets={"all": [0]})
    failure(TypeError, scan2fea.mesh, points, node_sets={"all": [0]})
    sets = scan2fea.mesh(points, cells, node_sets={"none": [], "caf\udce9": [2]}, face_sets={"of numpy": cells[:2, 0]})
    expect(set(sets.node_sets) == {"none", "caf\udce9"} and len(sets.node_sets["none"]) == 0, "any name and no rows do")


def failure(kind, call, *arguments, **keywords):
    try:
        call(*arguments, **keywords)
    except kind as error:
        return error
    expect(False, f"{call.__name__} {keywords} raises {kind.__name__}")
    return kind("nothing was raised", {}) if kind is scan2fea.GateFailed else kind("nothing was raised")


def tell_errors(command, scan, folder):
    mesh = scan2fea.mesh(*ball(2))
    error = failure(scan2fea.WrongUsage, scan2fea.run, scan, edge_length=1e6)
    done = subprocess.run([command, "run", scan, "-o", os.path.join(folder, "none.inp"), "--edge-length", "1000000"],
                          capture_output=True, text=True, check=False)
    expect(done.stderr.strip().endswith("scan2fea: " + str(error)), f"the message is the command's: {error}")
    expect(error.where == "--edge-length" and error.value and error.limit and error.advice, "it has its parts")
    expect(error.exit_code == done.returncode == 2, "and the exit code")
    error = failure(scan2fea.WrongUsage, scan2fea.run, mesh, edge_lenght=1)
    expect("edge_length" in error.value, f"a mistyped option is answered: {error}")
    error = failure(scan2fea.WrongUsage, scan2fea.run, mesh, faces=100, ratio=0.5)
    expect("excludes" in error.what, f"two sizes are one too many: {error}")
    failure(scan2fea.WrongUsage, scan2fea.run, mesh, deck="static")
    failure(scan2fea.WrongUsage, scan2fea.run, mesh, quiet=True)
    failure(TypeError, scan2fea.run, mesh, faces={})
    failure(TypeError, scan2fea.run, mesh, input="scan.ply")
    failure(TypeError, scan2fea.simplify, [mesh, mesh])
    failure(TypeError, scan2fea.run, None)
    error = failure(TypeError, scan2fea.check, scan2fea.simplify(mesh, faces=60))
    expect("Result" in str(error), f"a Result is no mesh, and its mesh is one: {error}")
    failure(ValueError, scan2fea.write, mesh, os.path.join(folder, "cut\0.ply"))
    expect(not os.path.exists(os.path.join(folder, "cut")), "no file of half a name")
    error = failure(scan2fea.InvalidInput, scan2fea.read, os.path.join(folder, "missing.ply"))
    expect("missing.ply" in error.where and error.exit_code == 3, f"a missing file is told: {error}")
    failure(scan2fea.InvalidInput, scan2fea.check, scan2fea.mesh(ball(1)[0]))
    file = os.path.join(folder, "exists.inp")
    scan2fea.write(scan2fea.tetrahedralize(mesh).mesh, file)
    before = contents(file)
    expect(failure(scan2fea.IoError, scan2fea.write, mesh, file).exit_code == 6, "an output that exists is kept")
    expect(contents(file) == before, "as it was")
    error = failure(scan2fea.GateFailed, scan2fea.simplify, mesh, faces=60, require=["edge_ratio.mean<=0.5"])
    expect(error.exit_code == 1 and error.figures["gates"][0]["pass"] is False, "a gate that fails has its figures")
    # As multiprocessing does with what is raised elsewhere, which hangs where that fails.
    again = pickle.loads(pickle.dumps(error))
    expect((type(again), str(again), vars(again)) == (type(error), str(error), vars(error)), "it goes between processes")
    error = failure(scan2fea.WrongUsage, scan2fea.run, mesh, edge_length=1e6)
    again = pickle.loads(pickle.dumps(error))
    expect((type(again), str(again), vars(again)) == (type(error), str(error), vars(error)), "and so do others")
    expect(issubclass(scan2fea.OutOfTime, scan2fea.NotMeshable), "classes are those of the library")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        points, cells = ball(2, radius=1e-4)
        told = scan2fea.run((points, cells), unit="mm", faces=100).warnings
    expect(told and [str(w.message) for w in caught] == told, "warnings are Python's, and in the result")


# What has no file has no hash: the page says so.
def write_report(folder):
    page = os.path.join(folder, "report")
    figures = scan2fea.check(scan2fea.mesh(*ball(1), name="a ball"), report=page, require=["edge_ratio.mean<=3"])
    with open(os.path.join(page, "report.json"), encoding="utf-8") as stream:
        expect(json.load(stream) == figures, "the report's figures are those that come back")
    line = ["scan2fea", "check", "a ball", "--report", page, "--require", "edge_ratio.mean<=3"]
    expect(figures["command"]["arguments"] == line, "it tells the command that does the same")
    expect(b"a ball" in contents(os.path.join(page, "report.html")), "and names the mesh")


def follow_progress(scan):
    told = []
    scan2fea.run(scan, faces=2000, effort="low", progress=told.append)
    fractions = [state["fraction"] for state in told]
    expect(len(told) > 2 and fractions == sorted(fractions), "progress never goes back")
    expect(all(0 <= f <= 1 for f in fractions) and {"stage", "words", "seconds_left"} <= set(told[-1]), "and has parts")
    expect(failure(scan2fea.Cancelled, scan2fea.run, scan, progress=lambda _: False).exit_code == 130, "False stops it")
    failure(scan2fea.Cancelled, scan2fea.run, scan, progress=lambda _: numpy.bool_(False))

    def broken(_):
        raise LookupError("of the callback")

    failure(LookupError, scan2fea.run, scan, progress=broken)


def interrupt(scan):
    sent = []

    def send():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(0.7, send).start()
    try:
        scan2fea.run(scan, deviation="0.02%", effort="high")
        expect(False, "an interrupt comes through")
    except KeyboardInterrupt:
        expect(time.monotonic() - sent[0] < 1, "an interrupt comes through within a second")


# The interpreter's lock is free meanwhile, and results are those of one after the other.
def use_threads(folder):
    points, cells = ball(2)

    def make(number):
        return scan2fea.run((points * (1 + number / 10), cells), faces=100 + 10 * number, order=1 + number % 2).mesh

    one_by_one = [make(number) for number in range(8)]
    with ThreadPoolExecutor(8) as pool:
        at_once = list(pool.map(make, range(8)))
    for number, (one, other) in enumerate(zip(one_by_one, at_once)):
        expect(one.points.tobytes() == other.points.tobytes() and one.cells.tobytes() == other.cells.tobytes(),
               f"mesh {number} has the same bytes in a thread")
    # MED's library is not made for threads.
    files = [os.path.join(folder, f"thread{number}.med") for number in range(24)]
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda file: scan2fea.write(one_by_one[1], file), files))
        read = list(pool.map(scan2fea.read, files))
    expect(all((mesh.cells == one_by_one[1].cells).all() for mesh in read), "files of threads hold their meshes")
    limited = scan2fea.run((points, cells), faces=100, threads=1).mesh
    expect(limited.points.tobytes() == one_by_one[0].points.tobytes(), "and by one thread")


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def look_for_leaks():
    points, cells = ball(1)

    def call(times):
        for number in range(times):
            mesh = scan2fea.mesh(points, cells)
            if number % 5 == 0:
                mesh = scan2fea.repair(mesh).mesh
            scan2fea.check(mesh)
            try:
                scan2fea.check(mesh, require="edge_ratio.mean<=0.5")
            except scan2fea.GateFailed:
                pass
        gc.collect()

    call(30)
    before = resident_bytes()
    call(300)
    expect(resident_bytes() <= 1.05 * before, f"memory stays: {before} and then {resident_bytes()} bytes")


def meet_others(mesh):
    try:
        import meshio
    except ImportError:
        return
    theirs = scan2fea.to_meshio(mesh)
    expect(isinstance(theirs, meshio.Mesh) and theirs.cells[0].type == "tetra10", "meshio has the cells")
    expect((theirs.cells[0].data == mesh.cells).all() and numpy.shares_memory(theirs.points, mesh.points),
           "the same ones, and the points without a copy")
    expect((theirs.cell_sets["fixed"][1] == mesh.face_sets["fixed"]).all(), "and the sets of faces")


def follow_readme(readme, scan, folder):
    with open(readme, encoding="utf-8") as text:
        blocks = re.findall(r"```python\n(.*?)```", text.read(), re.DOTALL)
    expect(len(blocks) > 0, "the README has an example")
    for block in blocks:
        place = tempfile.mkdtemp(dir=folder)
        os.symlink(os.path.abspath(scan), os.path.join(place, "scan.ply"))
        done = subprocess.run([sys.executable, "-c", block], cwd=place, capture_output=True, text=True, check=False)
        expect(done.returncode == 0, f"the README's example runs: {done.stderr}")


def check_stub(folder):
    use = os.path.join(folder, "use.py")
    with open(use, "w", encoding="utf-8") as stream:
        stream.write("import scan2fea\n"
                     "made = scan2fea.run('scan.ply', edge_length=1.5, order=2, deviation=None, require=['a<=1'])\n"
                     "volume: float = made.figures['volume_mesh']['volume']\n"
                     "n: int = made.mesh.points.shape[0]\n"
                     "scan2fea.write(made.mesh, 'part.inp', force=True)\n"
                     "scan2fea.run('scan.ply', edge_lenght=1.5)\n"
                     "scan2fea.run('scan.ply', effort='much')\n")
    module = os.path.dirname(os.path.dirname(scan2fea.__file__))
    environment = {**os.environ, "MYPYPATH": module}
    try:
        done = subprocess.run(["mypy", "--strict", "--cache-dir", os.path.join(folder, "mypy"), use], cwd=folder,
                              env=environment, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return
    errors = re.findall(r"use.py:(\d+): error", done.stdout)
    expect(set(errors) == {"6", "7"} and not re.search(r"pyi:\d+: error", done.stdout),
           f"mypy finds the two mistakes and nothing else: {done.stdout}")


def main():
    parser = argparse.ArgumentParser()
    for name in ("command", "scan", "readme"):
        parser.add_argument("--" + name, required=True)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        def compare_runs():
            mesh = compare_with_command(asked.command, asked.scan, folder).mesh
            look_at_arrays(mesh)
            meet_others(mesh)

        steps = (compare_runs, partial(compare_faces, asked.command, folder),
                 partial(compare_stages, asked.command, folder), make_of_arrays,
                 partial(tell_errors, asked.command, asked.scan, folder), partial(write_report, folder), partial(follow_progress, asked.scan),
                 partial(interrupt, asked.scan), partial(use_threads, folder), look_for_leaks,
                 partial(follow_readme, asked.readme, asked.scan, folder), partial(check_stub, folder))
        for step in steps:
            start = time.monotonic()
            step()
            print(f"{getattr(step, 'func', step).__name__}: {time.monotonic() - start:.1f} s")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
