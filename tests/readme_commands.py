"""Runs the commands of the README as they stand there, each block of them in a folder with the scans that it names.

usage: readme_commands.py --command SCAN2FEA --scan SCAN.ply --readme README.md
Blocks whose commands are not the program's are run by other tests, and listed here: a new one is wrong until it is run
or listed. Prints what is wrong; exit status 1 if anything is, 77 where python3-gmsh or CalculiX is missing.
"""
import argparse
import gzip
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time

from expectations import expect, wrong

RUN_BY_OTHERS = ("git clone URL scan2fea && cd scan2fea\nexamples/quickstart", "tests/run", "cmake --build build/release --target packages")


def run(*line, **keywords):
    done = subprocess.run(line, capture_output=True, text=True, check=False, **keywords)
    if done.returncode != 0:
        sys.exit(f"{' '.join(line)}: {done.stderr}")


def write_las(points, file):
    """LAS 1.2, records of format 0, coordinates in steps of 1e-5 model units."""
    header = bytearray(227)
    header[0:4], header[24], header[25] = b"LASF", 1, 2
    struct.pack_into("<HI", header, 94, len(header), len(header))
    struct.pack_into("<HI", header, 105, 20, len(points))
    struct.pack_into("<3d", header, 131, 1e-5, 1e-5, 1e-5)
    with open(file, "wb") as las:
        las.write(header)
        for point in points:
            las.write(struct.pack("<3i8x", *(round(x * 1e5) for x in point)))


# A plate of 60 x 40 x 12 with a bore, and the pin in it.
def write_bodies(folder):
    import gmsh

    def write(make, name):
        gmsh.clear()
        make(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(2)
        gmsh.write(os.path.join(folder, name))

    def plate(occ):
        occ.cut([(3, occ.addBox(-30, -20, 0, 60, 40, 12))], [(3, occ.addCylinder(0, 0, -1, 0, 0, 14, 6.5))])

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 2)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 48)
    write(plate, "part.stl")
    shutil.copy(os.path.join(folder, "part.stl"), os.path.join(folder, "bracket.stl"))
    write(lambda occ: occ.addCylinder(0, 0, 0, 0, 0, 30, 6.5), "pin.stl")
    gmsh.finalize()


def write_inputs(command, scan, folder):
    """Everything that a block may find in its folder."""
    def path(name):
        return os.path.join(folder, name)

    shutil.copy(scan, path("scan.ply"))
    run(command, "convert", "scan.ply", "-o", "scan.stl", cwd=folder)
    with open(path("scan.stl"), "rb") as stl, gzip.open(path("scan.stl.gz"), "wb") as packed:
        shutil.copyfileobj(stl, packed)
    run(command, "convert", "scan.ply", "-o", "scan.obj", cwd=folder)
    with open(path("scan.obj"), encoding="ascii") as obj:
        write_las([[float(x) for x in line.split()[1:4]] for line in obj if line.startswith("v ")], path("cloud.las"))
    write_bodies(folder)
    run(command, "run", "scan.ply", "-o", "part.inp", "--unit", "mm", cwd=folder)
    run(command, "convert", "part.inp", "-o", "part.vtu", cwd=folder)
    shutil.copy(path("part.inp"), path("other.inp"))
    run(command, "convert", "part.inp", "-o", "other.msh", cwd=folder)


def run_block(block, inputs, path):
    made = set(re.findall(r"(?<!\S)(?:-o|>) (\S+)", block))
    with tempfile.TemporaryDirectory() as folder:
        for name in sorted(os.listdir(inputs)):
            if name not in made:
                shutil.copy(os.path.join(inputs, name), folder)
        start = time.monotonic()
        done = subprocess.run(["bash", "-euxo", "pipefail", "-c", block], cwd=folder, capture_output=True, text=True,
                              check=False, stdin=subprocess.DEVNULL, env={**os.environ, "PATH": path})
        print(f"{time.monotonic() - start:5.1f} s  {block.splitlines()[0]}", flush=True)
        expect(done.returncode == 0, f"it ends with {done.returncode}:\n{done.stderr}")
        for name in made - {"-"}:
            expect(os.path.exists(os.path.join(folder, name)), f"{name} is made")


def main():
    parser = argparse.ArgumentParser()
    for name in ("command", "scan", "readme"):
        parser.add_argument("--" + name, required=True)
    asked = parser.parse_args()
    try:
        import gmsh  # noqa: F401
    except ImportError:
        print("skipped: python3-gmsh is not installed")
        sys.exit(77)
    if not shutil.which("ccx"):
        print("skipped: calculix-ccx is not installed")
        sys.exit(77)
    with open(asked.readme, encoding="utf-8") as stream:
        text = stream.read()
    blocks = re.findall(r"^```sh\n(.*?)\n```$", text, re.DOTALL | re.MULTILINE)
    blocks += re.findall(r"`([^`\n]*(?:\| |<\()scan2fea [^`\n]*)`", text)  # through pipes, within a sentence
    path = os.path.dirname(os.path.abspath(asked.command)) + os.pathsep + os.environ["PATH"]
    ran = 0
    with tempfile.TemporaryDirectory() as inputs:
        write_inputs(os.path.abspath(asked.command), asked.scan, inputs)
        for block in blocks:
            if not block.startswith(RUN_BY_OTHERS):
                run_block(block, inputs, path)
                ran += 1
    expect(ran > 0, "the README has commands")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
