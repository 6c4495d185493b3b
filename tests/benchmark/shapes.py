"""Closed surfaces that the scripts scan: written as OFF files."""
import math


def write_blob(path, levels=6, size=(50, 35, 40)):
    """An icosahedron subdivided and bent: smooth, and nowhere symmetric."""
    golden = (1 + math.sqrt(5)) / 2
    points = [(0, s, t * golden) for s in (1, -1) for t in (1, -1)]
    points = [p[k:] + p[:k] for k in range(3) for p in points]
    near = [[j for j, q in enumerate(points) if math.dist(p, q) < 2.1 and q != p] for p in points]
    faces = [(i, j, k) for i in range(12) for j in near[i] for k in near[i] if i < j < k and k in near[j]]
    faces = [f if determinant(*(points[i] for i in f)) > 0 else f[::-1] for f in faces]
    for _ in range(levels):
        middles, finer = {}, []
        for face in faces:
            between = []
            for a, b in zip(face, face[1:] + face[:1]):
                key = (min(a, b), max(a, b))
                if key not in middles:
                    middles[key] = len(points)
                    points.append(tuple((x + y) / 2 for x, y in zip(points[a], points[b])))
                between.append(middles[key])
            finer += [(face[k], between[k], between[k - 1]) for k in range(3)] + [tuple(between)]
        faces = finer
        points = [tuple(x / math.hypot(*p) for x in p) for p in points]
    with open(path, "w") as file:
        file.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        for x, y, z in points:
            r = 1 + 0.2 * math.sin(2 * x + 3 * y) * math.cos(3 * z)
            r += 0.1 * math.sin(5 * y - 4 * z + 1) * math.cos(3 * x)
            file.write(f"{size[0] * r * x:.9g} {size[1] * r * y:.9g} {size[2] * r * z:.9g}\n")
        for face in faces:
            file.write("3 %d %d %d\n" % face)


def determinant(a, b, c):
    return sum(a[i] * (b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3]) for i in range(3))


def write_torus(path, radius=40, tube=12, around=360, across=120):
    with open(path, "w") as file:
        file.write(f"OFF\n{around * across} {2 * around * across} 0\n")
        for i in range(around):
            for j in range(across):
                u, v = 2 * math.pi * i / around, 2 * math.pi * j / across
                far = radius + tube * math.cos(v)
                file.write(f"{far * math.cos(u):.9g} {far * math.sin(u):.9g} {tube * math.sin(v):.9g}\n")
        for i in range(around):
            for j in range(across):
                p, q = i * across + j, (i + 1) % around * across + j
                s, t = i * across + (j + 1) % across, (i + 1) % around * across + (j + 1) % across
                file.write(f"3 {p} {q} {t}\n3 {p} {t} {s}\n")


def write_box(path, x, y, z):
    corners = [(x * (i & 1), y * (i >> 1 & 1), z * (i >> 2)) for i in range(8)]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    with open(path, "w") as file:
        file.write("OFF\n8 12 0\n")
        for corner in corners:
            file.write("%g %g %g\n" % corner)
        for a, b, c, d in sides:
            file.write(f"3 {a} {b} {c}\n3 {a} {c} {d}\n")


def write_pipe(path, inner, outer, length, around):
    """About z from z = 0 on, with plane ends; of squares of about the same size."""
    side = 2 * math.pi * outer / around
    along, across = max(1, round(length / side)), max(1, round((outer - inner) / side))
    rings = [(outer, length * i / along) for i in range(along)]
    rings += [(outer + (inner - outer) * i / across, length) for i in range(across)]
    rings += [(inner, length - length * i / along) for i in range(along)]
    rings += [(inner + (outer - inner) * i / across, 0) for i in range(across)]
    with open(path, "w") as file:
        file.write(f"OFF\n{len(rings) * around} {2 * len(rings) * around} 0\n")
        for radius, height in rings:
            for i in range(around):
                angle = 2 * math.pi * i / around
                file.write(f"{radius * math.cos(angle):.17g} {radius * math.sin(angle):.17g} {height:.17g}\n")
        for ring in range(len(rings)):
            for i in range(around):
                p, q = ring * around + i, ring * around + (i + 1) % around
                s, t = (p + around) % (len(rings) * around), (q + around) % (len(rings) * around)
                file.write(f"3 {p} {q} {t}\n3 {p} {t} {s}\n")
