"""The lowest eigenvalues (squares of angular frequencies) of a part of steel that is clamped at the faces FIXED, by
DOLFINx: mesh and facet tags from PART.xdmf, in millimetres, tonnes and newtons.

usage: modes_of_xdmf.py PART.xdmf ORDER COUNT DEGREE     prints one eigenvalue a line. DEGREE is that of the rule by which
masses are integrated. Exit status 77: DOLFINx is not installed.
"""
import sys
import xml.etree.ElementTree

try:
    import dolfinx
    import numpy
    import scipy.sparse
    import scipy.sparse.linalg
    import ufl
    from dolfinx import fem
    from dolfinx.io import XDMFFile
    from mpi4py import MPI
except ImportError:
    sys.exit(77)

name, order, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
young, poisson, density = 210e3, 0.3, 7.85e-9
with XDMFFile(MPI.COMM_WORLD, name, "r", encoding=XDMFFile.Encoding.ASCII) as file:
    mesh = file.read_mesh(name="Grid")
mesh.topology.create_connectivity(2, 3)
mesh.topology.create_connectivity(2, 0)
facets_name = name.replace(".xdmf", "_facets.xdmf")
with XDMFFile(MPI.COMM_WORLD, facets_name, "r", encoding=XDMFFile.Encoding.ASCII) as file:
    facets = file.read_meshtags(mesh, name="facet_tags")
fixed = []
for information in xml.etree.ElementTree.parse(facets_name).iter("Information"):
    for entry in xml.etree.ElementTree.fromstring(information.text):
        if "FIXED" in entry.get("key").split("+"):
            fixed.append(int(entry.text))

space = fem.VectorFunctionSpace(mesh, ("CG", order))
clamped = fem.locate_dofs_topological(space, 2, facets.indices[numpy.isin(facets.values, fixed)])
u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
mu, la = young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))
strain = lambda w: ufl.sym(ufl.grad(w))
stress = 2 * mu * strain(u) + la * ufl.tr(strain(u)) * ufl.Identity(3)


def matrix(form):
    a = fem.petsc.assemble_matrix(fem.form(form))
    a.assemble()
    rows, columns, values = a.getValuesCSR()
    return scipy.sparse.csr_matrix((values, columns, rows), shape=a.getSize())


stiffness, mass = matrix(ufl.inner(stress, strain(v)) * ufl.dx), matrix(
    density * ufl.inner(u, v) * ufl.dx(metadata={"quadrature_degree": int(sys.argv[4])})
)
free = numpy.setdiff1d(numpy.arange(stiffness.shape[0]), (3 * clamped[:, None] + numpy.arange(3)).ravel())
values = scipy.sparse.linalg.eigsh(
    stiffness[free][:, free].tocsc(), count, mass[free][:, free].tocsc(), sigma=0, return_eigenvectors=False
)
for value in sorted(values):
    print(repr(float(value)))
