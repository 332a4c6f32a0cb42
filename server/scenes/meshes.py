#!/usr/bin/env python3
"""meshes.py SHAPE [--obj | --data]: writes a closed mesh to the standard output.

SHAPE is mixer (a shaft with four blades), screw (a shaft with a helix), bottle, drum (64 sides, with four lifters),
landscape, hourglass (the free space), walls or roofs (of the same six houses). Lengths are in metres.
The output is a binary STL, or an OBJ. With --data it is Base64 for the field `data` of a mesh in a scene."""
import base64
import math
import struct
import sys


def lathe(line, sides):
    """Turns a line around the z axis: pairs (distance from the axis, z), from below to above along the outer side."""
    def ring(radius, z):
        count = sides if radius > 0 else 1
        return [(radius * math.cos(2 * math.pi * k / sides), radius * math.sin(2 * math.pi * k / sides), z)
                for k in range(count)]
    triangles = []
    for (r0, z0), (r1, z1) in zip(line, line[1:]):
        low, high = ring(r0, z0), ring(r1, z1)
        for k in range(sides):
            a, b = low[k % len(low)], low[(k + 1) % len(low)]
            c, d = high[(k + 1) % len(high)], high[k % len(high)]
            if r0 > 0:
                triangles.append((a, b, c))
            if r1 > 0:
                triangles.append((a, c, d))
    return triangles


def box(low, high, angle=0.0):
    """A box along the axes, turned about the z axis."""
    cos, sin = math.cos(angle), math.sin(angle)
    corners = []
    for k in range(8):
        x, y, z = (high[axis] if k >> axis & 1 else low[axis] for axis in range(3))
        corners.append((cos * x - sin * y, sin * x + cos * y, z))
    numbers = [(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
               (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]
    return [tuple(corners[k] for k in triangle) for triangle in numbers]


def mixer():
    """The parts touch nowhere, so that each is closed."""
    triangles = lathe([(0, 0), (0.03, 0), (0.03, 1), (0, 1)], 24)
    for k in range(4):
        triangles += box((0.031, -0.01, 0.02), (0.35, 0.01, 0.22), k * math.pi / 2)
    return triangles


def screw(turns=5, pitch=0.2, inner=0.031, outer=0.16, thickness=0.012, steps=24):
    """A shaft, and a blade along a helix around it. They touch nowhere."""
    def corners(k):
        angle, z = 2 * math.pi * k / steps, 0.02 + pitch * k / steps
        x, y = math.cos(angle), math.sin(angle)
        return [(r * x, r * y, z + height) for r, height in
                ((inner, 0), (outer, 0), (outer, thickness), (inner, thickness))]
    triangles = lathe([(0, 0), (0.03, 0), (0.03, turns * pitch + 0.05), (0, turns * pitch + 0.05)], 24)
    rings = [corners(k) for k in range(turns * steps + 1)]
    for low, high in zip(rings, rings[1:]):
        for k in range(4):
            a, b, c, d = low[k], high[k], high[(k + 1) % 4], low[(k + 1) % 4]
            triangles += [(a, b, c), (a, c, d)]
    first, last = rings[0], rings[-1]
    triangles += [(first[0], first[1], first[2]), (first[0], first[2], first[3])]
    triangles += [(last[0], last[2], last[1]), (last[0], last[3], last[2])]
    return triangles


def bottle():
    return lathe([(0, 0), (0.5, 0), (0.55, 0.1), (0.55, 1.0), (0.2, 1.4), (0.16, 1.75), (0.22, 1.8), (0.2, 1.85),
                  (0, 1.85)], 40)


def drum():
    """The free space of the drum. Its lifters are notches that the line of the side leaves out."""
    sides, lifters, depth = 64, 4, 0.06
    side = []
    for k in range(sides):
        lifted = k % (sides // lifters) == 0
        radius = 0.5 - (depth if lifted else 0)
        side.append((radius * math.cos(2 * math.pi * k / sides), radius * math.sin(2 * math.pi * k / sides)))
    triangles = []
    for k in range(sides):
        (x0, y0), (x1, y1) = side[k], side[(k + 1) % sides]
        a, b, c, d = (x0, y0, 0), (x1, y1, 0), (x1, y1, 0.6), (x0, y0, 0.6)
        triangles += [(a, b, c), (a, c, d), ((0, 0, 0), b, a), ((0, 0, 0.6), d, c)]
    return triangles


def landscape(cells=64, side=4.0, depth=0.5):
    """Hills on a square, with sides and a bottom."""
    def height(x, y):
        return 0.25 * math.sin(2.1 * x + 0.3) * math.cos(1.7 * y) + 0.06 * math.sin(5.3 * x) * math.sin(4.7 * y + 1)

    def top(column, row):
        x, y = (side * (k / cells - 0.5) for k in (column, row))
        return (x, y, height(x, y))
    triangles = []
    for row in range(cells):
        for column in range(cells):
            a, b, c, d = top(column, row), top(column + 1, row), top(column + 1, row + 1), top(column, row + 1)
            triangles += [(a, b, c), (a, c, d)]
    border = [top(k, 0) for k in range(cells)] + [top(cells, k) for k in range(cells)]
    border += [top(k, cells) for k in range(cells, 0, -1)] + [top(0, k) for k in range(cells, 0, -1)]
    for (x0, y0, z0), (x1, y1, z1) in zip(border, border[1:] + border[:1]):
        a, b = (x0, y0, -depth), (x1, y1, -depth)
        triangles += [((x0, y0, z0), a, b), ((x0, y0, z0), b, (x1, y1, z1)), ((0, 0, -depth), b, a)]
    return triangles


def hourglass(neck=0.061, widest=0.5, half=1.0, sides=40):
    """The free space: two bulbs and a neck around the origin."""
    upper = [(neck, 0.0)]
    for k in range(1, 11):  # from the neck to the widest place
        share = k / 10
        upper.append((neck + (widest - neck) * (1 - math.cos(math.pi * share)) / 2, 0.66 * half * share))
    for k in range(1, 6):  # round to the flat end
        angle = math.pi / 2 * k / 5
        upper.append((widest - 0.16 * half * (1 - math.cos(angle)), half * (0.84 + 0.16 * math.sin(angle))))
    lower = [(r, -z) for r, z in reversed(upper[1:])]
    return lathe([(0, -half)] + lower + upper + [(0, half)], sides)


# x, y, angle, width, depth, height
HOUSES = [(6.05, -1.05, 0.2, 0.62, 0.46, 0.4), (6.2, 0.15, -0.15, 0.55, 0.55, 0.5), (6.0, 1.25, 0.35, 0.6, 0.44, 0.38),
          (7.35, -0.55, -0.25, 0.5, 0.42, 0.36), (7.3, 0.85, 0.1, 0.66, 0.46, 0.42), (8.3, 0.05, 0.3, 0.5, 0.44, 0.36)]


def floor_below(x):
    """Height of the slope of the scene landslide along its middle; the houses stand on it."""
    return 3.8 - 0.6 * x if x < 4 else 1.4 - 0.2 * (x - 4) - 0.28 * (1 - math.exp((4 - x) / 0.7))


def placed(house, triangles):
    x, y, angle, width, depth, height = house
    cos, sin = math.cos(angle), math.sin(angle)
    base = floor_below(x + 0.3)
    return [tuple((x + cos * u - sin * v, y + sin * u + cos * v, base + w) for u, v, w in triangle)
            for triangle in triangles]


def walls():
    triangles = []
    for house in HOUSES:
        width, depth, height = house[3:]
        triangles += placed(house, box((-width / 2, -depth / 2, -0.25), (width / 2, depth / 2, height)))
    return triangles


def roofs():
    """Prisms, each a little above its house and wider than it, so that both are closed."""
    triangles = []
    for house in HOUSES:
        width, depth, height = house[3:]
        u, v, low, high = width / 2 + 0.06, depth / 2 + 0.07, height + 0.002, height + 0.3
        a, b, c, d = (-u, -v, low), (u, -v, low), (u, v, low), (-u, v, low)
        e, f = (-u, 0, high), (u, 0, high)
        triangles += placed(house, [(a, c, b), (a, d, c), (a, b, f), (a, f, e), (c, d, e), (c, e, f), (a, e, d),
                                    (b, c, f)])
    return triangles


def stl(triangles):
    parts = [b"spherule".ljust(80), struct.pack("<I", len(triangles))]
    for triangle in triangles:
        parts.append(struct.pack("<12fH", 0, 0, 0, *(value for corner in triangle for value in corner), 0))
    return b"".join(parts)


def obj(triangles):
    numbers, lines, faces = {}, [], []
    for triangle in triangles:
        face = []
        for corner in triangle:
            key = tuple(round(value, 9) + 0.0 for value in corner)
            if key not in numbers:
                numbers[key] = len(numbers) + 1
                lines.append("v %.9g %.9g %.9g\n" % key)
            face.append(numbers[key])
        faces.append("f %d %d %d\n" % tuple(face))
    return "".join(lines + faces).encode()


SHAPES = {"mixer": mixer, "screw": screw, "bottle": bottle, "drum": drum, "landscape": landscape,
          "hourglass": hourglass, "walls": walls, "roofs": roofs}


def main(arguments):
    names = [one for one in arguments if not one.startswith("--")]
    if len(names) != 1 or names[0] not in SHAPES or set(arguments) - set(names) - {"--obj", "--data"}:
        sys.exit(__doc__)
    triangles = SHAPES[names[0]]()
    result = obj(triangles) if "--obj" in arguments else stl(triangles)
    if "--data" in arguments:
        result = base64.b64encode(result) + b"\n"
    sys.stdout.buffer.write(result)


if __name__ == "__main__":
    main(sys.argv[1:])
