"""Draws pictures by the command, without a display, and looks at their pixels.

usage: pictures.py --command SCAN2FEA --examples FOLDER
Prints what is wrong, one line each; exit status 1 if anything is, 77 where numpy is not installed.
"""
import argparse
import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib

from expectations import expect, wrong

try:
    import numpy
except ImportError:
    print("python3-numpy is not installed")
    sys.exit(77)


# Of a PNG whose rows hold differences to the left, as ours are.
def pixels(file):
    data = open(file, "rb").read()
    expect(data.startswith(b"\x89PNG\r\n\x1a\n"), f"{file} is a PNG")
    at, packed, size = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        expect(zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0], "checksums hold")
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height = size
    rows = numpy.frombuffer(zlib.decompress(packed), dtype=numpy.uint8).reshape(height, 1 + 4 * width)
    return numpy.cumsum(rows[:, 1:].reshape(height, width, 4), axis=1, dtype=numpy.uint8)


class Drawing:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder
        self.environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}

    def run(self, *arguments, code=0):
        done = subprocess.run([self.program, *arguments], cwd=self.folder, env=self.environment, capture_output=True, text=True)
        expect(done.returncode == code, f"{arguments} ends with {code}, not {done.returncode}: {done.stderr}")
        return done.stderr

    def __call__(self, mesh, *flags):
        self.run("picture", mesh, "-o", "picture.png", "--force", "--quiet", "--size", "400x300", *flags)
        return pixels(os.path.join(self.folder, "picture.png"))

    def refused(self, *arguments):
        told = self.run("picture", *arguments, code=2)
        expect(told.count("\n") == 1, f"an error is one line: {told}")
        expect(not os.path.exists(os.path.join(self.folder, "no.png")), "and no file")
        return told


def is_white(picture):
    return (picture[:, :, :3] == 255).all(axis=2)


def look(draw):
    plain = draw("part.vtu")
    expect(plain.shape == (300, 400, 4) and (plain[:, :, 3] == 255).all(), "a picture has its size and a ground")
    expect(0.1 < 1 - is_white(plain).mean() < 0.9, "the part is seen")
    # The mirror image of what is seen from the front is the outline from the back.
    front, back = is_white(draw("part.vtu", "--view", "front")), is_white(draw("part.vtu", "--view", "back"))
    expect((front[:, ::-1] != back).mean() < 0.01, "from the back the outline is that of the front, mirrored")
    same = is_white(draw("part.vtu", "--view", "0,-3,0"))
    expect((front == same).all(), "a direction is the side of that name")
    expect((draw("part.vtu", "--edges") != plain).any(), "edges are seen")

    # Half of it, cut across the length, covers about half from the side; the half nearer to the eye goes.
    side = (~is_white(draw("part.vtu", "--view", "front"))).sum()
    half = (~is_white(draw("part.vtu", "--view", "front", "--cut", "x=30"))).sum()
    expect(0.1 * side < half < 0.9 * side, f"a cut takes a part away, {half} of {side}")
    across = draw("part.vtu", "--view", "front", "--cut", "y")
    expect((is_white(across) == front).mean() > 0.97, "what is behind a cut stays")
    expect((across != draw("part.vtu", "--view", "front", "--cut", "-y")).sum() == 0, "whichever way the normal points")

    looks = [draw("part.vtu", "--colour", c).tobytes() for c in
             ("none", "edge-ratio", "min-angle", "scaled-jacobian", "min-dihedral", "max-dihedral", "face", "measured")]
    looks.append(draw("part.vtu", "--reference", "scan.ply").tobytes())
    expect(len(set(looks)) == len(looks), "each colouring looks different")
    expect(draw("part.vtu", "--reference", "scan.ply", "--colour", "deviation").tobytes() == looks[-1], "a reference colours")
    expect(draw("part.vtu", "--reference", "scan.ply", "--range", "-5:5").tobytes() != looks[-1], "a range is kept")
    draw("scan.ply", "--cut", "z=20")
    draw("faces.vtp", "--colour", "face")


def curved(draw):
    # A ball of few elements: those of second order cover its disk, those of first order what their chords leave of it.
    rings, segments, radius = 24, 48, 10.0
    points = [(0, 0, radius)]
    for i in range(1, rings):
        for k in range(segments):
            a, b = math.pi * i / rings, 2 * math.pi * k / segments
            points.append((radius * math.sin(a) * math.cos(b), radius * math.sin(a) * math.sin(b), radius * math.cos(a)))
    points.append((0, 0, -radius))
    at = lambda i, k: 1 + (i - 1) * segments + k % segments
    faces = [(0, at(1, k), at(1, k + 1)) for k in range(segments)]
    for i in range(1, rings - 1):
        for k in range(segments):
            faces += [(at(i, k), at(i + 1, k), at(i + 1, k + 1)), (at(i, k), at(i + 1, k + 1), at(i, k + 1))]
    faces += [(at(rings - 1, k + 1), at(rings - 1, k), len(points) - 1) for k in range(segments)]
    with open(os.path.join(draw.folder, "ball.off"), "w") as out:
        out.write(f"OFF\n{len(points)} {len(faces)} 0\n")
        out.writelines("%.17g %.17g %.17g\n" % p for p in points)
        out.writelines("3 %d %d %d\n" % f for f in faces)
    cover = {}
    for order in ("1", "2"):
        draw.run("run", "ball.off", "-o", f"ball{order}.vtu", "--faces", "100", "--order", order, "--quiet")
        for edges in ((), ("--edges",)):
            seen = ~is_white(draw(f"ball{order}.vtu", "--view", "front", *edges))
            rows, columns = numpy.flatnonzero(seen.any(axis=1)), numpy.flatnonzero(seen.any(axis=0))
            box = (rows[-1] - rows[0] + 1) * (columns[-1] - columns[0] + 1)
            cover[order, edges] = seen.sum() / box
    disk = math.pi / 4
    expect(abs(cover["2", ()] - disk) < 0.005, f"curved elements are round: {cover}")
    expect(cover["2", ("--edges",)] == cover["2", ()], "and so are their edges")
    expect(abs(cover["1", ()] - disk) > 0.01, f"flat ones are not: {cover}")


def refusals(draw):
    for what, arguments in {
            "a picture is a PNG file": ("part.vtu", "-o", "no.jpg"),
            "nothing to measure the deviation from": ("part.vtu", "-o", "no.png", "--colour", "deviation"),
            "has no tetrahedra to colour": ("scan.ply", "-o", "no.png", "--colour", "scaled-jacobian"),
            "has no sets of faces": ("scan.ply", "-o", "no.png", "--colour", "face"),
            "is none of": ("part.vtu", "-o", "no.png", "--colour", "height"),
            "is no plane": ("part.vtu", "-o", "no.png", "--cut", "x="),
            "misses the part": ("part.vtu", "-o", "no.png", "--cut", "x=1e4"),
            "is no size": ("part.vtu", "-o", "no.png", "--size", "20000x10"),
            "is no range": ("part.vtu", "-o", "no.png", "--range", "1:0"),
            "no direction": ("part.vtu", "-o", "no.png", "--view", "0,0,0")}.items():
        told = draw.refused(*arguments)
        expect(what in told, f"'{what}' is said: {told}")
    draw.run("picture", "part.vtu", "-o", "picture.png", code=6)
    draw.run("picture", "missing.vtu", "-o", "no.png", code=3)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--command", required=True)
    parser.add_argument("--examples", required=True)
    arguments = parser.parse_args()
    program, examples = os.path.abspath(arguments.command), os.path.abspath(arguments.examples)
    with tempfile.TemporaryDirectory() as folder:
        draw = Drawing(program, folder)
        os.symlink(os.path.join(examples, "bracket.ply"), os.path.join(folder, "scan.ply"))
        draw.run("run", "scan.ply", "-o", "part.vtu", "--faces", "3000", "--unit", "mm", "--quiet", "--set", "foot=z<3mm")
        draw.run("faces", "scan.ply", "-o", "faces.vtp", "--quiet")
        look(draw)
        curved(draw)
        refusals(draw)

        # The README's own: drawn by its script; that of the scan, which no change of the meshes touches, byte by byte.
        made = os.path.join(folder, "made")
        os.mkdir(made)
        subprocess.run([os.path.join(examples, "pictures"), made, program], check=True, env=draw.environment)
        names = sorted(os.listdir(made))
        expect(names == sorted(n for n in os.listdir(examples) if n.startswith("bracket-") and n.endswith(".png")),
               f"the script makes the README's pictures: {names}")
        for name in names:
            expect(pixels(os.path.join(made, name)).shape == (560, 640, 4), f"{name} has its size")
            if name == "bracket-scan.png":
                kept = open(os.path.join(examples, name), "rb").read()
                expect(open(os.path.join(made, name), "rb").read() == kept, f"{name} is what examples/pictures draws")
    sys.exit(1 if wrong else 0)


main()
