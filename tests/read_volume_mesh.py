"""Reads a mesh with a library that knows nothing of scan2fea and prints what the tests compare.

usage: read_volume_mesh.py meshio|vtk|gmsh|dolfinx FILE
prints: mesh NODES TETRAHEDRA VOLUME LARGEST_MIDPOINT_ERROR, and for each set that the library tells: set NAME SIZE

The last figure of the mesh is the largest distance of a mid-edge node from the middle of its edge, by the library's own
order of nodes: it is zero for straight edges only if the writer's order is right. Sizes of sets are in elements, faces
or nodes. Exit status 77: the library is not installed.
"""
import sys
import xml.etree.ElementTree

EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))  # of meshio's and VTK's quadratic tetrahedron
GMSH_EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3))


def bits(values):
    """Of faces of a cell, each a bit."""
    return sum(bin(int(value)).count("1") for value in values)


def sizes_of_arrays(arrays):
    sets = {}
    for name, values in arrays:
        kind, _, plain = name.partition(" ")
        if kind in ("node_set", "element_set"):
            sets[plain] = int(numpy.count_nonzero(values))
        elif kind == "face_set":
            sets[plain] = bits(values)
    return sets


def names_of_tags(name):
    """The field data that scan2fea writes as meshio does."""
    names = {}
    for information in xml.etree.ElementTree.parse(name).iter("Information"):
        for entry in xml.etree.ElementTree.fromstring(information.text):
            names[int(entry.text)] = entry.get("key")
    return names


def by_meshio(name):
    import meshio

    mesh = meshio.read(name)
    sets = sizes_of_arrays((key, numpy.concatenate(value)) for key, value in mesh.cell_data.items())
    sets.update(sizes_of_arrays(mesh.point_data.items()))
    for key, members in list(mesh.point_sets.items()) + list(mesh.cell_sets.items()):
        sets[key] = sum(len(block) for block in members if block is not None) if isinstance(members, list) else len(members)
    if name.endswith(".msh"):
        tags = numpy.concatenate(mesh.cell_data["gmsh:physical"])
        for key, (tag, _) in mesh.field_data.items():
            sets[key] = int((tags == tag).sum())
    elif name.endswith(".med"):
        for families, values in ((mesh.cell_tags, mesh.cell_data["cell_tags"]), (mesh.point_tags, [mesh.point_data["point_tags"]])):
            for tag, groups in families.items():
                for group in groups:
                    sets[group] = sets.get(group, 0) + sum(int((block == tag).sum()) for block in values)
    elif name.endswith(".xdmf"):
        facets = meshio.read(name.replace(".xdmf", "_facets.xdmf"))
        for file, values in ((name, mesh.cell_data["cell_tags"]), (name.replace(".xdmf", "_facets.xdmf"), facets.cell_data["facet_tags"])):
            for tag, key in names_of_tags(file).items():
                sets[key] = sum(int((block == tag).sum()) for block in values)
    elif name.endswith(".bdf"):
        for tag in set(numpy.concatenate(mesh.cell_data["nastran:ref"])):
            sets[f"property_{tag}"] = sum(int((block == tag).sum()) for block in mesh.cell_data["nastran:ref"])
    kind = "tetra10" if "tetra10" in mesh.cells_dict else "tetra"
    cells = mesh.cells_dict[kind]
    if name.endswith(".med"):  # MED turns tetrahedra the other way round, and meshio leaves them so
        cells = cells[:, [0, 2, 1, 3] + ([6, 5, 4, 7, 9, 8] if kind == "tetra10" else [])]
    return mesh.points, cells, sets, EDGES


def exodus_by_vtk(name):
    """One grid from its blocks; sides and sets by what the reader makes of them."""
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkExodusIIReader()
    reader.SetFileName(name)
    reader.UpdateInformation()
    sets, kinds = {}, {}
    for kind in (reader.ELEM_BLOCK, reader.SIDE_SET, reader.NODE_SET, reader.ELEM_SET):
        for i in range(reader.GetNumberOfObjects(kind)):
            reader.SetObjectStatus(kind, i, 1)
            sets[reader.GetObjectName(kind, i).split(" ID:")[0].removeprefix("Unnamed ")] = reader.GetNumberOfEntriesInObject(kind, i)
    reader.Update()
    blocks = reader.GetOutput().GetBlock(0)  # the element blocks
    points, cells = [], []
    for i in range(blocks.GetNumberOfBlocks()):
        grid = blocks.GetBlock(i)
        kind = {10: 4, 24: 10}[grid.GetCellType(0)]
        cells.append(vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, kind) + sum(len(p) for p in points))
        points.append(vtk_to_numpy(grid.GetPoints().GetData()))
    sides = reader.GetOutput().GetBlock(4)
    for i in range(sides.GetNumberOfBlocks()):
        grid = sides.GetBlock(i)
        key = sides.GetMetaData(i).Get(vtk.vtkCompositeDataSet.NAME()).split(" ID:")[0].removeprefix("Unnamed ")
        corners = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(grid.GetNumberOfCells(), -1)[:, :3]
        a, b, c = (vtk_to_numpy(grid.GetPoints().GetData())[corners[:, k]] for k in range(3))
        sets["area_of_" + key] = float(numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2)
    # Each block has points of its own.
    unique, index = numpy.unique(numpy.concatenate(points), axis=0, return_inverse=True)
    return unique, index.reshape(-1)[numpy.concatenate(cells)], sets, EDGES


def by_vtk(name):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    if name.endswith(".exo"):
        return exodus_by_vtk(name)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(name)
    reader.Update()
    grid = reader.GetOutput()
    kind = {10: 4, 24: 10}[grid.GetCellType(0)]
    cells = vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, kind)
    arrays = []
    for data in (grid.GetCellData(), grid.GetPointData()):
        arrays += [(data.GetArrayName(i), vtk_to_numpy(data.GetArray(i))) for i in range(data.GetNumberOfArrays())]
    return vtk_to_numpy(grid.GetPoints().GetData()), cells, sizes_of_arrays(arrays), EDGES


def by_gmsh(name):
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(name)
    mesh = gmsh.model.mesh
    tags, coordinates, _ = mesh.getNodes()
    order = numpy.argsort(tags)
    points = coordinates.reshape(-1, 3)[order]
    index = numpy.zeros(int(tags.max()) + 1, dtype=int)
    index[tags[order]] = numpy.arange(len(order))
    sets = {}
    for dimension, tag in gmsh.model.getPhysicalGroups():
        key = gmsh.model.getPhysicalName(dimension, tag) or f"physical_{dimension}_{tag}"
        entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, tag)
        sets[key] = sum(len(block) for entity in entities for block in mesh.getElements(dimension, entity)[1])
    for kind, nodes in ((4, 4), (11, 10)):
        elements, connectivity = mesh.getElementsByType(kind)
        if len(elements):
            return points, index[connectivity].reshape(-1, nodes), sets, GMSH_EDGES
    raise ValueError("no tetrahedra")


def by_dolfinx(name):
    """Solves the patch test, too: a linear displacement on the boundary is the solution inside."""
    from mpi4py import MPI
    import dolfinx
    import ufl
    from dolfinx import fem
    from dolfinx.io import XDMFFile, gmshio

    comm = MPI.COMM_WORLD
    names = {}
    if name.endswith(".xdmf"):
        with XDMFFile(comm, name, "r", encoding=XDMFFile.Encoding.ASCII) as file:
            mesh = file.read_mesh(name="Grid")
            cells = file.read_meshtags(mesh, name="Grid")
        mesh.topology.create_connectivity(2, 3)
        mesh.topology.create_connectivity(2, 0)
        facets_name = name.replace(".xdmf", "_facets.xdmf")
        with XDMFFile(comm, facets_name, "r", encoding=XDMFFile.Encoding.ASCII) as file:
            facets = file.read_meshtags(mesh, name="facet_tags")
        names = {3: names_of_tags(name), 2: names_of_tags(facets_name)}
    else:
        import gmsh

        gmsh.initialize()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(name)
        groups = gmsh.model.getPhysicalGroups()
        names = {d: {t: gmsh.model.getPhysicalName(d, t) for k, t in groups if k == d} for d in (2, 3)}
        mesh, cells, facets = gmshio.model_to_mesh(gmsh.model, comm, 0)
    sets = {}
    for dimension, tags in ((3, cells), (2, facets)):
        for tag, key in names[dimension].items():
            sets[key] = int((tags.values == tag).sum())

    degree = 2 if mesh.geometry.x.shape[0] > 100 else 1
    space = fem.VectorFunctionSpace(mesh, ("CG", degree))
    exact = fem.Function(space)
    exact.interpolate(lambda x: numpy.stack((1e-3 * x[0] + 2e-3 * x[1], -3e-3 * x[2], 1e-3 * x[0] - 1e-3 * x[1])))
    mesh.topology.create_connectivity(2, 3)
    boundary = dolfinx.mesh.exterior_facet_indices(mesh.topology)
    condition = fem.dirichletbc(exact, fem.locate_dofs_topological(space, 2, boundary))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    strain = lambda w: ufl.sym(ufl.grad(w))
    stress = 2 * strain(u) + ufl.tr(strain(u)) * ufl.Identity(3)
    zero = fem.Constant(mesh, numpy.zeros(3))
    problem = fem.petsc.LinearProblem(
        ufl.inner(stress, strain(v)) * ufl.dx, ufl.inner(zero, v) * ufl.dx, bcs=[condition],
        petsc_options={"ksp_type": "preonly", "pc_type": "lu"})
    error = abs(problem.solve().x.array - exact.x.array).max()
    one = fem.Constant(mesh, 1.0)
    area = ufl.Measure("ds", domain=mesh, subdomain_data=facets)
    volume = fem.assemble_scalar(fem.form(one * ufl.dx))
    for tag, key in names[2].items():
        if key == "FIXED":
            print("set", "area_of_FIXED", repr(float(fem.assemble_scalar(fem.form(one * area(tag))))))
    for key, size in sets.items():
        print("set", key, size)
    # The error of the patch test stands where that of the mid-edge nodes does: a wrong order spoils it.
    print("mesh", mesh.geometry.x.shape[0], mesh.topology.index_map(3).size_local, repr(float(volume)), repr(float(error)))
    sys.exit(0)


try:
    import numpy

    points, cells, sets, edges = {"meshio": by_meshio, "vtk": by_vtk, "gmsh": by_gmsh, "dolfinx": by_dolfinx}[sys.argv[1]](
        sys.argv[2]
    )
except ImportError:
    sys.exit(77)

a, b, c, d = (points[cells[:, k]] for k in range(4))
volume = numpy.einsum("ij,ij->i", numpy.cross(b - a, c - a), d - a).sum() / 6
error = 0.0
if cells.shape[1] == 10:
    for k, (i, j) in enumerate(edges):
        middle = (points[cells[:, i]] + points[cells[:, j]]) / 2
        error = max(error, abs(points[cells[:, 4 + k]] - middle).max())
for key, size in sets.items():
    print("set", key, size)
print("mesh", len(points), len(cells), repr(float(volume)), repr(float(error)))
