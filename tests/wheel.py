"""Builds and installs the wheel as a user does, by `pip install .` without a package index, and uses what was installed.

usage: wheel.py --project FOLDER --command SCAN2FEA
Compiled by ccache's memory of the build before, it takes less than a minute. Prints what is wrong; exit status 1 if
anything is, 77 where Python's venv, its development files or pybind11 are missing.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile

from expectations import expect, wrong

# In a module of its own: processes that are spawned import it anew.
USE = '''
import multiprocessing, sys, scan2fea

def mesh(faces):
    made = scan2fea.run(sys.argv[1], faces=faces, unit="mm", threads=1).mesh
    scan2fea.write(made, f"part{faces}.inp")
    scan2fea.write(made, f"part{faces}.med")
    assert (scan2fea.read(f"part{faces}.med").cells == made.cells).all()
    return len(made.cells)

if __name__ == "__main__":
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        print(scan2fea.__file__, *pool.map(mesh, (500, 1000)))
'''


# PyVista's way to find the accessor, from 0.48 on.
PYVISTA = """
import importlib.metadata, sys
import numpy, pyvista

for point in importlib.metadata.entry_points(group="pyvista.accessors"):
    point.load()
import scan2fea

scan = scan2fea.to_pyvista(scan2fea.read(sys.argv[1]))
quads = pyvista.PolyData(  # a cube
    numpy.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float),
    [4, 0, 2, 3, 1, 4, 4, 5, 7, 6, 4, 0, 1, 5, 4, 4, 1, 3, 7, 5, 4, 3, 2, 6, 7, 4, 2, 0, 4, 6])
surface = scan.scan2fea.surface(faces=800)
mesh = surface.scan2fea.tetrahedralize()
figures = mesh.scan2fea.check(reference=scan2fea.from_pyvista(surface))
assert abs(figures["deviation"]["volume_difference_pct"]) < 1e-6, figures["deviation"]
assert type(mesh).__name__ == "UnstructuredGrid" and type(surface).__name__ == "PolyData"
assert abs(quads.scan2fea.check()["surface"]["volume"] - 1) < 1e-12
print(len(mesh.celltypes))
"""


def run(*line, **keywords):
    done = subprocess.run(line, capture_output=True, text=True, check=False, **keywords)
    expect(done.returncode == 0, f"{' '.join(line)} ends with {done.returncode}:\n{done.stdout[-3000:]}{done.stderr}")
    return done.stdout


def contents(file):
    with open(file, "rb") as stream:
        return stream.read()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--project", required=True)
    parser.add_argument("--command", required=True)
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        python = os.path.join(folder, "venv", "bin", "python")
        # NumPy is Debian's.
        if subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", os.path.join(folder, "venv")],
                          capture_output=True, check=False).returncode != 0:
            print("skipped: python3-venv is not installed")
            sys.exit(77)
        run(python, "-m", "pip", "install", "--no-index", asked.project)
        if wrong:
            sys.exit(1)

        scan = os.path.join(asked.project, "examples", "bracket.ply")
        with open(os.path.join(folder, "use.py"), "w", encoding="utf-8") as use:
            use.write(USE)
        place, *counts = run(python, "use.py", scan, cwd=folder).split() or [""]
        expect(place.startswith(os.path.join(folder, "venv")), f"what was installed is imported, not {place}")
        expect(len(counts) == 2 and all(int(count) > 0 for count in counts), "two processes make tetrahedra")
        for faces in ("500", "1000"):
            made = os.path.join(folder, "by_command.inp")
            run(asked.command, "run", scan, "-o", made, "--faces", faces, "--unit", "mm", "--force", "--quiet")
            expect(contents(made) == contents(os.path.join(folder, f"part{faces}.inp")),
                   f"the mesh of {faces} faces has the command's bytes")

        # Where there is none, a stand-in of its interface.
        stand_ins = os.path.join(os.path.dirname(os.path.abspath(__file__)), "stand_ins")
        with open(os.path.join(folder, "pyvista_use.py"), "w", encoding="utf-8") as use:
            use.write(PYVISTA)
        has_pyvista = subprocess.run([python, "-c", "import pyvista"], capture_output=True, check=False).returncode == 0
        told = run(python, "pyvista_use.py", scan, cwd=folder,
                   env={**os.environ, **({} if has_pyvista else {"PYTHONPATH": stand_ins})})
        expect(told.strip().isdigit(), f"datasets of PyVista have the functions: {told}")

        if shutil.which("mypy"):
            typed = os.path.join(folder, "typed.py")
            with open(typed, "w", encoding="utf-8") as text:
                text.write("import scan2fea\nscan2fea.run('scan.ply', edge_lenght=1.5)\n")
            told = subprocess.run(["mypy", "--python-executable", python, "--cache-dir", os.path.join(folder, "mypy"), typed],
                                  capture_output=True, text=True, check=False).stdout
            expect("typed.py:2: error" in told and "1 error" in told, f"mypy finds the installed types: {told}")
        run(python, "-m", "pip", "uninstall", "--yes", "scan2fea")
        left = [name for _, _, files in os.walk(os.path.dirname(os.path.dirname(place))) for name in files if "scan2fea" in name]
        expect(left == [], f"nothing is left when it is uninstalled: {left}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
