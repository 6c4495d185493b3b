"""Writes a ball's surface and a box of tetrahedra with VTK and meshio, in all ways in which they save by default or on
request, into FOLDER. Exit status 77: a library is not installed.

usage: write_vtk_files.py FOLDER
"""
import sys

try:
    import meshio
    import numpy
    import vtk
except ImportError:
    sys.exit(77)

folder = sys.argv[1]
sphere = vtk.vtkSphereSource()
sphere.SetThetaResolution(24)
sphere.SetPhiResolution(16)
sphere.Update()

image = vtk.vtkImageData()
image.SetDimensions(4, 3, 3)
tetrahedra = vtk.vtkDataSetTriangleFilter()
tetrahedra.SetInputData(image)
tetrahedra.Update()


def write(writer, name, data, compressor, mode):
    writer.SetFileName(f"{folder}/{name}")
    writer.SetInputData(data)
    {"none": writer.SetCompressorTypeToNone, "zlib": writer.SetCompressorTypeToZLib, "lz4": writer.SetCompressorTypeToLZ4}[
        compressor
    ]()
    {"appended": writer.SetDataModeToAppended, "ascii": writer.SetDataModeToAscii, "binary": writer.SetDataModeToBinary}[
        mode.split("-")[0]
    ]()
    writer.SetEncodeAppendedData(mode == "appended-base64")
    writer.SetBlockSize(32768 if compressor == "zlib" else 1024)  # several blocks
    writer.Write()


for compressor in ("none", "zlib", "lz4"):
    for mode in ("appended-base64", "appended-raw", "binary", "ascii"):
        write(vtk.vtkXMLPolyDataWriter(), f"ball-{compressor}-{mode}.vtp", sphere.GetOutput(), compressor, mode)
        write(vtk.vtkXMLUnstructuredGridWriter(), f"box-{compressor}-{mode}.vtu", tetrahedra.GetOutput(), compressor, mode)
strips = vtk.vtkStripper()
strips.SetInputData(sphere.GetOutput())
strips.Update()
write(vtk.vtkXMLPolyDataWriter(), "ball-strips.vtp", strips.GetOutput(), "zlib", "appended-raw")
for version in (42, 51):
    for kind, binary in (("ascii", False), ("binary", True)):
        for writer, data, name in (
            (vtk.vtkPolyDataWriter(), sphere.GetOutput(), "ball"),
            (vtk.vtkPolyDataWriter(), strips.GetOutput(), "ball-strips"),
            (vtk.vtkUnstructuredGridWriter(), tetrahedra.GetOutput(), "box"),
        ):
            writer.SetFileName(f"{folder}/{name}-{version}-{kind}.vtk")
            writer.SetFileVersion(version)
            writer.SetInputData(data)
            writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
            writer.Write()
box = meshio.read(f"{folder}/box-none-ascii.vtu")
for name, options in (("box-meshio.vtu", {}), ("box-meshio-ascii.vtu", {"binary": False}), ("box-meshio.vtk", {})):
    meshio.write(f"{folder}/{name}", meshio.Mesh(box.points, box.cells), **options)
meshio.write(f"{folder}/box-meshio-42.vtk", meshio.Mesh(box.points, box.cells), file_format="vtk42")
