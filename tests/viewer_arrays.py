"""Reads the arrays of VTU and VTP files as ParaView and PyVista do, and holds them against `check` and against VTK.

usage: viewer_arrays.py --command SCAN2FEA --scan SCAN.ply
Prints what is wrong, one line each; exit status 1 if anything is, 77 where VTK is not installed.
"""
import argparse
import json
import os
import subprocess
import sys
import tempfile

from expectations import expect, wrong

try:
    import meshio
    import numpy
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkFiltersCore import vtkImplicitPolyDataDistance
    from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
    from vtkmodules.vtkIOPLY import vtkPLYReader
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
except ImportError:
    print("python3-vtk9 or python3-meshio is not installed")
    sys.exit(77)


class Grid:
    def __init__(self, file):
        reader = vtkXMLPolyDataReader() if file.endswith(".vtp") else vtkXMLUnstructuredGridReader()
        reader.SetFileName(file)
        reader.Update()
        self.data = reader.GetOutput()

    @staticmethod
    def arrays(data):
        return {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}

    def cells(self):
        return self.arrays(self.data.GetCellData())

    def points(self):
        return self.arrays(self.data.GetPointData())

    # What the numbers of `face` stand for.
    def faces(self):
        sets = [name[len("face_set "):] for name in self.cells() if name.startswith("face_set ")]
        return [name for name in sets if name not in ("FILLED", "ENRICHED")]

    # One of VTK's measures, of each cell.
    def by_vtk(self, measure):
        return numpy.array([measure(self.data.GetCell(c)) for c in range(self.data.GetNumberOfCells())])

    def coordinates(self):
        return vtk_to_numpy(self.data.GetPoints().GetData())


def agree(own, others, what):
    expect(numpy.allclose(own, others, rtol=1e-9, atol=1e-9), f"{what} is VTK's, {numpy.abs(own - others).max()}")


class Command:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def __call__(self, *arguments, code=0):
        done = subprocess.run([self.program, *arguments], cwd=self.folder, capture_output=True, text=True)
        expect(done.returncode == code, f"{arguments} ends with {code}, not {done.returncode}: {done.stderr}")
        return done

    def check(self, *arguments):
        return json.loads(self("check", *arguments, "--json", "-", "--quiet").stdout)

    def grid(self, name):
        return Grid(os.path.join(self.folder, name))


# The worst element by the arrays is the one that `check` names, with its figures.
def worst_is_the_same(cells, checked, by, figures):
    worst = checked["worst_elements"]["elements"][0]
    element = int(numpy.argmin(cells[by]))
    expect(element == worst["element"], f"the worst by {by} is {worst['element']}, not {element}")
    for array, figure in figures.items():
        expect(cells[array][element] == worst[figure], f"its {array} is {worst[figure]}, not {cells[array][element]}")


# Of each tetrahedron at its six edges.
def dihedral_angles(corners):
    angles = []
    for i, j, k, l in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)):
        along = corners[:, j] - corners[:, i]
        first, second = (numpy.cross(along, corners[:, m] - corners[:, i]) for m in (k, l))
        cosine = (first * second).sum(axis=1) / numpy.linalg.norm(first, axis=1) / numpy.linalg.norm(second, axis=1)
        angles.append(numpy.degrees(numpy.arccos(cosine)))
    return numpy.array(angles)


def volume(command, order):
    name = f"part-{order}.vtu"
    command("run", "scan.ply", "-o", name, "--faces", "3000", "--unit", "mm", "--quiet", "--order", str(order),
            "--set", "wall=plane(x<0.5)", "--set", "foot=z<3mm")
    grid, checked = command.grid(name), command.check(name, "--reference", "scan.ply")
    cells = grid.cells()
    worst_is_the_same(cells, checked, "scaled_jacobian", {n: n for n in
                      ("scaled_jacobian", "edge_ratio", "min_dihedral_deg", "max_dihedral_deg")})
    for array, figure in (("scaled_jacobian", "min"), ("scaled_jacobian", "mean")):
        value = getattr(cells[array], figure)()
        expect(abs(value - checked["volume_mesh"][array][figure]) < 1e-9, f"the {figure} of {array} is that of check")
    expect(cells["edge_ratio"].max() == checked["volume_mesh"]["edge_ratio"], "the largest edge ratio is that of check")
    expect(cells["max_dihedral_deg"].max() == checked["volume_mesh"]["max_dihedral_deg"], "and the largest dihedral angle")
    if order == 1:  # VTK has no measures of curved elements
        agree(cells["scaled_jacobian"], grid.by_vtk(vtkMeshQuality.TetScaledJacobian), "scaled_jacobian")
        agree(cells["edge_ratio"], grid.by_vtk(vtkMeshQuality.TetEdgeRatio), "edge_ratio")
        # VTK 9.1's TetMinAngle takes some of the normals inwards, and so supplements of dihedral angles.
        angles = dihedral_angles(grid.coordinates()[vtk_to_numpy(grid.data.GetCells().GetConnectivityArray()).reshape(-1, 4)])
        agree(cells["min_dihedral_deg"], angles.min(axis=0), "min_dihedral_deg")
        agree(cells["max_dihedral_deg"], angles.max(axis=0), "max_dihedral_deg")
    expect(grid.faces() == ["wall", "foot"], f"sets keep their order: {grid.faces()}")
    for number, face in enumerate(grid.faces(), 1):
        members = cells["face_set " + face] != 0
        expect(members.any() and set(cells["face"][members]) <= {1, number}, f"elements of {face} have its number")
    expect((cells["face"] == 0).any(), "elements inside have no face")
    deviations(grid, command)
    other = meshio.read(os.path.join(command.folder, name))
    for array, values in cells.items():
        expect(numpy.array_equal(other.cell_data[array][0], values), f"meshio reads {array}")


# Signed, from the scan, of the points at the surface alone; by VTK's own distance, too.
def deviations(grid, command):
    reader = vtkPLYReader()
    reader.SetFileName(os.path.join(command.folder, "scan.ply"))
    reader.Update()
    distance = vtkImplicitPolyDataDistance()
    distance.SetInput(reader.GetOutput())
    own, points = grid.points()["deviation"], grid.coordinates()
    outside = numpy.flatnonzero(~numpy.isnan(own))
    expect(0 < len(outside) < len(own), "points inside have no deviation")
    outside = outside[::40]  # VTK takes some milliseconds for one
    others = numpy.array([distance.EvaluateFunction(points[p]) for p in outside])
    expect(numpy.allclose(numpy.abs(own[outside]), numpy.abs(others), atol=1e-4), "its size is VTK's, whose points have 32 bits")
    clear = numpy.abs(others) > 0.02  # mm; of what is nearer, either side is right
    same = (numpy.sign(own[outside]) == numpy.sign(others))[clear]
    expect(len(same) > 0 and same.mean() > 0.99, f"its sign is VTK's but beside sharp edges, {same.mean()}")
    expect(grid.data.GetPointData().GetScalars().GetName() == "deviation", "viewers show it at first")


def surface(command):
    command("surface", "scan.ply", "-o", "part.vtp", "--faces", "3000", "--unit", "mm", "--quiet")
    grid, checked = command.grid("part.vtp"), command.check("part.vtp", "--reference", "scan.ply")
    cells = grid.cells()
    worst_is_the_same(cells, checked, "min_angle", {"min_angle": "min_angle_deg", "max_angle": "max_angle_deg",
                                                    "edge_ratio": "edge_ratio"})
    for array, measure in (("scaled_jacobian", vtkMeshQuality.TriangleScaledJacobian), ("edge_ratio", vtkMeshQuality.TriangleEdgeRatio),
                           ("min_angle", vtkMeshQuality.TriangleMinAngle), ("max_angle", vtkMeshQuality.TriangleMaxAngle)):
        agree(cells[array], grid.by_vtk(measure), array)
    expect(not numpy.isnan(grid.points()["deviation"]).any(), "all points of a surface have a deviation")


# What somebody else wrote into a file is told when it is left out; what follows from the mesh is made again.
def conversions(command):
    told = command("convert", "part-1.vtu", "-o", "again.vtu").stderr
    expect("left out deviation" in told, f"a deviation that is lost is told: {told}")
    expect("edge_ratio" not in told, f"what is made again is not: {told}")
    first, again = command.grid("part-1.vtu"), command.grid("again.vtu")
    for name, values in first.cells().items():
        expect(numpy.array_equal(values, again.cells()[name]), f"{name} is the same after convert")
    expect("deviation" not in again.points(), "without a reference there is no deviation")
    told = command("convert", "part-1.vtu", "-o", "whole.vtu", "--reference", "scan.ply").stderr
    expect(told == "", f"with one nothing is lost: {told}")
    expect(numpy.array_equal(first.points()["deviation"], command.grid("whole.vtu").points()["deviation"], equal_nan=True),
           "and the deviation is the same")
    command("convert", "part-1.vtu", "-o", "metres.vtu", "--reference", "scan.ply", "--scale", "mm:m")
    agree(1000 * command.grid("metres.vtu").points()["deviation"][:100], first.points()["deviation"][:100], "in metres it")
    told = command("convert", "part-1.vtu", "-o", "part.inp", "--reference", "scan.ply", code=2).stderr
    expect("holds no distances" in told, f"a format without arrays takes no reference: {told}")


# A hole over which the scanner saw nothing.
def made_up(command):
    command("simplify", "open.ply", "-o", "closed.vtp", "--quiet", "--faces", "2000", code=0)
    command("run", "open.ply", "-o", "closed.vtu", "--quiet", "--faces", "2000")
    grid = command.grid("closed.vtu")
    middles = numpy.array([grid.coordinates()[[grid.data.GetCell(c).GetPointId(k) for k in range(4)]].mean(axis=0)
                           for c in numpy.flatnonzero(grid.cells()["made_up"] == 1)])
    expect(len(middles) > 0 and (middles[:, 2] > 5).all(), "elements under the filled hole, and no others, are marked")


def open_ball(file):
    rings, around = 24, 48
    points = [(0.0, 0.0, -10.0)]
    for i in range(1, rings):
        angle = numpy.pi * i / rings
        points += [(10 * numpy.sin(angle) * numpy.cos(a), 10 * numpy.sin(angle) * numpy.sin(a), -10 * numpy.cos(angle))
                   for a in 2 * numpy.pi * numpy.arange(around) / around]
    ring = lambda i, k: 1 + (i - 1) * around + k % around
    triangles = [(0, ring(1, k + 1), ring(1, k)) for k in range(around)]
    last = rings - 3  # the cap above is missing
    for i in range(1, last):
        for k in range(around):
            triangles += [(ring(i, k), ring(i, k + 1), ring(i + 1, k + 1)), (ring(i, k), ring(i + 1, k + 1), ring(i + 1, k))]
    with open(file, "w", encoding="ascii") as out:
        out.write(f"ply\nformat ascii 1.0\nelement vertex {ring(last, around - 1) + 1}\nproperty double x\nproperty double y\n"
                  f"property double z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
        out.writelines("%r %r %r\n" % tuple(map(float, p)) for p in points[:ring(last, around - 1) + 1])
        out.writelines("3 %d %d %d\n" % t for t in triangles)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", required=True)
    parser.add_argument("--scan", required=True)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        command = Command(os.path.abspath(arguments.command), folder)
        os.symlink(os.path.abspath(arguments.scan), os.path.join(folder, "scan.ply"))
        open_ball(os.path.join(folder, "open.ply"))
        volume(command, 1)
        volume(command, 2)
        surface(command)
        conversions(command)
        made_up(command)
    sys.exit(1 if wrong else 0)


main()
