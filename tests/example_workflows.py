"""Runs the workflows of examples/ as their users do, and holds what they find against what must be true.

usage: example_workflows.py --examples FOLDER --command SCAN2FEA --scans FOLDER_OF_SCANS shell|scans|convergence|material
Prints what is wrong; exit status 1 if anything is, 77 where CalculiX or matplotlib is missing.
"""
import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile

from expectations import expect, wrong


def run(*line, status=0):
    done = subprocess.run([str(part) for part in line], capture_output=True, text=True, check=False)
    print(done.stdout)
    expect(done.returncode == status, f"{line[0]} ends with {done.returncode}, not {status}:\n{done.stderr[-3000:]}")
    return done.stdout


def expect_picture(file):
    from matplotlib import image
    pixels = image.imread(file)
    colours = {tuple(pixel) for row in pixels for pixel in row}
    expect(pixels.shape[1] >= 600 and len(colours) > 100, f"{file} shows something")


def number(pattern, text):
    found = re.search(pattern, text)
    expect(found is not None, f"{pattern} is told")
    return float(found[1]) if found else float("nan")


def shell(asked, folder):
    told = run(f"{asked.examples}/workflow", f"{asked.examples}/bracket.ply", folder, asked.command)
    expect(number(r"first elastic frequency: ([\d.]+) Hz", told) > 100, "the seventh mode strains the part")
    expect_picture(os.path.join(folder, "mode.png"))
    few = os.path.join(folder, "few.ply")
    run(asked.command, "surface", f"{asked.examples}/bracket.ply", "-o", few, "--faces", 500, "--quiet")
    stopped = os.path.join(folder, "stopped")
    run(f"{asked.examples}/workflow", few, stopped, asked.command, status=1)
    expect(not os.path.exists(os.path.join(stopped, "part.inp")), "a scan that misses a gate is not meshed")


def scans(asked, folder):
    broken = os.path.join(folder, "broken.stl")
    with open(broken, "w", encoding="ascii") as stl:
        stl.write("solid x\nfacet normal 0 0\n")
    given = [f"{asked.examples}/bracket.ply", *(f"{asked.scans}/{name}.off" for name in ("bunny00", "camel", "fandisk")), broken]
    results = os.path.join(folder, "results")
    run(f"{asked.examples}/mesh_scans", results, *given, status=1)
    with open(os.path.join(results, "summary.csv"), encoding="utf-8", newline="") as table:
        rows = list(csv.DictReader(table))
    expect([row["scan"] for row in rows] == [os.path.basename(scan) for scan in given], "each scan has its row")
    expect([row["result"] == "good" for row in rows] == [True] * 4 + [False], "the broken one alone is not meshed")
    expect("broken.stl:3" in rows[-1]["result"], f"and why is told: {rows[-1]['result']}")
    meshes = {name for name in os.listdir(results) if name.endswith(".inp")}
    expect(meshes == {"bracket.inp", "bunny00.inp", "camel.inp", "fandisk.inp"}, f"there are {meshes}")


def convergence(asked, folder):
    told = run(f"{asked.examples}/convergence", folder)
    expect(abs(number(r"order ([\d.]+)", told) - 2) < 0.5, "4-node tetrahedra converge with the square of their size")
    expect(abs(number(r"estimate is ([-+.\d]+) %", told)) < 1, "Richardson's estimate is what finer elements give")
    expect_picture(os.path.join(folder, "convergence.png"))


# What the measurements were made with.
def material(asked, folder):
    told = run(f"{asked.examples}/fit_material", folder)
    expect(abs(number(r"\nE ([\d.]+) MPa", told) / 71000 - 1) < 0.01, "Young's modulus is found")
    expect(abs(number(r"\nE .*ratio ([\d.]+),", told) - 0.33) < 0.01, "and Poisson's ratio")


def main():
    parser = argparse.ArgumentParser()
    for name in ("examples", "command", "scans"):
        parser.add_argument("--" + name, required=True)
    workflows = {function.__name__: function for function in (shell, scans, convergence, material)}
    parser.add_argument("workflow", choices=workflows)
    asked = parser.parse_args()
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        print("skipped: python3-matplotlib is not installed")
        sys.exit(77)
    if not shutil.which("ccx"):
        print("skipped: calculix-ccx is not installed")
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        workflows[asked.workflow](asked, folder)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
