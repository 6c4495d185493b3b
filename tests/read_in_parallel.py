"""Reads a mesh in parts by several processes, each its own part, as solvers do, and tells what they find together.

usage: mpirun -n N python3 read_in_parallel.py vtk PART.pvtu
       mpirun -n N python3 read_in_parallel.py elmer FOLDER/mesh.header
       mpirun -n N python3 read_in_parallel.py dolfinx FOLDER HEADER     FOLDER has part.xdmf and part_facets.xdmf; HEADER
                                                            is export/xdmf.hpp, whose example is what is run
Prints: mesh NODES TETRAHEDRA VOLUME ERROR, one line `set NAME SIZE` for each set, and one `part ELEMENTS` for each
process. NODES are those of the whole mesh, shared ones counted once; the volume and the sizes are sums over the
processes. ERROR: what ought to be 0, as how far shared nodes are apart. Exit status 77: a library is not installed.
"""
import os
import sys

try:
    import numpy
    from mpi4py import MPI
except ImportError:
    sys.exit(77)

comm = MPI.COMM_WORLD


def volume_of(points, cells):
    a, b, c, d = (points[cells[:, k]] for k in range(4))
    return float(numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a).sum() / 6)


def numbers_in_several(own):
    """Those of `own` that another process has, too."""
    of_others = [set(numbers) for rank, numbers in enumerate(comm.allgather(own.tolist())) if rank != comm.rank]
    return {int(n) for n in own if any(int(n) in others for others in of_others)}


def gaps_between(places):
    """The largest distance between the places that two processes have for one node; `places` by its number."""
    largest, seen = 0.0, {}
    for of_one in comm.allgather(places):
        for number, place in of_one.items():
            largest = max(largest, float(numpy.abs(seen.setdefault(number, place) - place).max()))
    return largest


def report(nodes, cells, volume, error, sets):
    """All but the error are of this process; the nodes are numbers in the whole mesh."""
    whole = len(set().union(*comm.allgather(set(int(n) for n in nodes))))
    parts = comm.gather(cells, 0)
    volume, error = comm.allreduce(volume), comm.allreduce(error, MPI.MAX)
    sums = {name: comm.allreduce(sets.get(name, 0)) for name in sorted(set().union(*comm.allgather(set(sets))))}
    if comm.rank > 0:
        return
    for name, size in sums.items():
        print("set", name, size)
    for part in parts:
        print("part", part)
    print("mesh", whole, sum(parts), repr(volume), repr(error))


def by_vtk(name):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader

    reader = vtkXMLPUnstructuredGridReader()
    reader.SetFileName(name)
    reader.UpdateInformation()
    reader.UpdatePiece(comm.rank, comm.size, 0)
    grid = reader.GetOutput()
    points, of_cells = grid.GetPointData(), grid.GetCellData()
    nodes = vtk_to_numpy(points.GetGlobalIds())
    elements = vtk_to_numpy(of_cells.GetGlobalIds())
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)
    places = vtk_to_numpy(grid.GetPoints().GetData())
    error = gaps_between({int(n): place for n, place in zip(nodes, places)})
    if numbers_in_several(elements) or (vtk_to_numpy(of_cells.GetArray("part")) != comm.rank).any():
        error = 1.0
    first_of = {}  # the process that counts a node
    for rank, of_one in enumerate(comm.allgather(nodes.tolist())):
        for n in of_one:
            first_of.setdefault(n, rank)
    own = numpy.array([first_of[int(n)] == comm.rank for n in nodes])
    sets = {}
    for k in range(of_cells.GetNumberOfArrays()):
        kind, _, key = of_cells.GetArrayName(k).partition(" ")
        values = vtk_to_numpy(of_cells.GetArray(k))
        if kind == "face_set":
            sets[key] = sum(bin(int(v)).count("1") for v in values)
        elif kind == "element_set":
            sets[key] = int(numpy.count_nonzero(values))
    for k in range(points.GetNumberOfArrays()):
        kind, _, key = points.GetArrayName(k).partition(" ")
        if kind == "node_set":
            sets[key] = int(numpy.count_nonzero(vtk_to_numpy(points.GetArray(k))[own]))
    report(nodes, len(cells), volume_of(places, cells), error, sets)


def numbers_of(line):
    return [int(word) for word in line.split()]


def by_elmer(header):
    """As ElmerSolver's manual says what is in the files of a part."""
    names = {}
    for line in open(header.replace("mesh.header", "mesh.names")):
        if line.startswith("! ") and " is " in line:
            kind, number, _, name = line[2:].split(None, 3)
            names[kind, int(number)] = name.strip()
    stem = os.path.join(os.path.dirname(header), f"partitioning.{comm.size}", f"part.{comm.rank + 1}.")
    head = [numbers_of(line) for line in open(stem + "header")]
    nodes = [line.split() for line in open(stem + "nodes")]
    elements = [numbers_of(line) for line in open(stem + "elements")]
    boundary = [numbers_of(line) for line in open(stem + "boundary")]
    shared = {line[0]: line for line in (numbers_of(line) for line in open(stem + "shared"))}

    kinds = {}
    for kind in [e[2] for e in elements] + [b[4] for b in boundary]:
        kinds[kind] = kinds.get(kind, 0) + 1
    expected_head = [[len(nodes), len(elements), len(boundary)], [len(kinds)]]
    expected_head += [[kind, kinds[kind]] for kind in sorted(kinds, reverse=True)] + [[len(shared), 0]]
    wrong = sorted(head) != sorted(expected_head)

    places = {int(n[0]): numpy.array([float(x) for x in n[2:5]]) for n in nodes}
    own_elements = {e[0] for e in elements}
    wrong = wrong or bool(numbers_in_several(numpy.array(sorted(own_elements))))
    wrong = wrong or {n for e in elements for n in e[3:]} != set(places)
    # A face has elements of this part, the corners of one of them, and no others.
    corners = {e[0]: set(e[3:]) for e in elements}
    for b in boundary:
        parents = [p for p in b[2:4] if p > 0]
        wrong = wrong or not parents or any(p not in own_elements or not set(b[5:]) <= corners[p] for p in parents)
    # Both sides of each shared node tell the same: who has it, and who owns it.
    wrong = wrong or numbers_in_several(numpy.array(sorted(places))) != set(shared)
    for other in comm.allgather(shared):
        for number, line in other.items():
            having = set(line[2:])
            wrong = wrong or line[1] != len(having) or (number in places) != (comm.rank + 1 in having)
            wrong = wrong or shared.get(number, line) != line
    index = {n: k for k, n in enumerate(sorted(places))}
    points = numpy.array([places[n] for n in sorted(places)])
    cells = numpy.array([[index[n] for n in e[3:7]] for e in elements])
    sets = {}
    for kind, entries in (("body", elements), ("boundary", [b for b in boundary if b[2] in own_elements])):
        for entry in entries:
            for name in names[kind, entry[1]].split("+"):
                sets[name] = sets.get(name, 0) + 1
    report(places, len(cells), volume_of(points, cells), max(gaps_between(places), float(wrong)), sets)


def example_in(header):
    """The lines of Python that follow `This keeps them`."""
    text = open(header).read().split("This keeps them", 1)[1].split("A tag is a number", 1)[0]
    return "\n".join(line[len("//   "):] for line in text.splitlines() if line.startswith("//   "))


def by_dolfinx(folder, header):
    """Keeps our parts, and solves the patch test: a linear displacement, held on one face and by its own traction on the
    others, all by facet tags, is the solution inside."""
    import xml.etree.ElementTree

    import dolfinx
    import ufl
    from dolfinx import fem
    from dolfinx.graph import create_adjacencylist as adjacencylist
    from dolfinx.io import XDMFFile
    from dolfinx.mesh import GhostMode, create_mesh

    os.chdir(folder)
    scope = dict(MPI=MPI, xml=xml, numpy=numpy, ufl=ufl, adjacencylist=adjacencylist, XDMFFile=XDMFFile,
                 GhostMode=GhostMode, create_mesh=create_mesh, text=XDMFFile.Encoding.ASCII)
    exec(example_in(header), scope)
    mesh, part = scope["mesh"], scope["part"]
    own = mesh.topology.index_map(3).size_local
    wrong = own != int((part == comm.rank).sum())
    mesh.topology.create_connectivity(2, 3)
    mesh.topology.create_connectivity(2, 0)
    with XDMFFile(comm, "part_facets.xdmf", "r", encoding=XDMFFile.Encoding.ASCII) as file:
        facets = file.read_meshtags(mesh, name="facet_tags")
    tags = {}
    for information in xml.etree.ElementTree.parse("part_facets.xdmf").iter("Information"):
        for entry in xml.etree.ElementTree.fromstring(information.text):
            tags[entry.get("key")] = int(entry.text)

    order = scope["domain"].ufl_coordinate_element().degree()
    space = fem.VectorFunctionSpace(mesh, ("CG", order))
    gradient = numpy.array([[1e-3, 2e-3, 0], [0, 0, -3e-3], [1e-3, -1e-3, 0]])
    exact = fem.Function(space)
    exact.interpolate(lambda x: gradient @ x)
    fixed = facets.indices[facets.values == tags["FIXED"]]
    condition = fem.dirichletbc(exact, fem.locate_dofs_topological(space, 2, fixed))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    strain = lambda w: ufl.sym(ufl.grad(w))
    stress = lambda e: 2 * e + ufl.tr(e) * ufl.Identity(3)
    traction = ufl.dot(stress(ufl.sym(ufl.as_matrix(gradient.tolist()))), ufl.FacetNormal(mesh))
    ds = ufl.Measure("ds", domain=mesh, subdomain_data=facets)
    others = sum((ufl.inner(traction, v) * ds(tag) for name, tag in tags.items() if name != "FIXED"), ufl.inner(traction, v) * ds(0))
    problem = fem.petsc.LinearProblem(
        ufl.inner(stress(strain(u)), strain(v)) * ufl.dx, others, bcs=[condition],
        petsc_options={"ksp_type": "preonly", "pc_type": "lu", "pc_factor_mat_solver_type": "mumps"})
    error = float(abs(problem.solve().x.array - exact.x.array).max())
    one = fem.Constant(mesh, 1.0)
    sets = {"area_of_" + name: float(fem.assemble_scalar(fem.form(one * ds(tag)))) for name, tag in tags.items()}
    volume = float(fem.assemble_scalar(fem.form(one * ufl.dx)))
    nodes = numpy.array(mesh.geometry.input_global_indices)
    report(nodes, own, volume, max(error, float(wrong)), sets)


try:
    {"vtk": by_vtk, "elmer": by_elmer, "dolfinx": by_dolfinx}[sys.argv[1]](*sys.argv[2:])
except ImportError:
    sys.exit(77)
except BaseException:
    import traceback

    traceback.print_exc()
    comm.Abort(1)
