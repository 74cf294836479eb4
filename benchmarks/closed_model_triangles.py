"""Closed models of triangles, made by formulas: gyroids, gears, threads, blades, shells, films and the like.

`TRIANGLES` names them: each is a function that returns a surface as triangle_surfaces.py describes it, and the ending of its file.
None crosses itself; some come within a thousandth of their size of themselves, which is what they are for.
"""
import numpy
from triangle_surfaces import TAU, ball, box, capped, circle, level_set, outwards, ring_prism, sheet, together, tube, turned_in, weld


def gyroid(x, y, z):
    return numpy.sin(x) * numpy.cos(y) + numpy.sin(y) * numpy.cos(z) + numpy.sin(z) * numpy.cos(x)


def cube_distance(x, y, z, half):
    return numpy.maximum(numpy.maximum(abs(x), abs(y)), abs(z)) - half


def gyroid_block(half, wall, cells):
    return level_set(lambda x, y, z: numpy.maximum(abs(gyroid(x, y, z)) - wall, cube_distance(x, y, z, half)),
                     [-half - 0.11] * 3, [half + 0.13] * 3, [cells] * 3)


def gyroid_ball(radius, cells):
    return level_set(lambda x, y, z: numpy.maximum(gyroid(x, y, z) - 0.2, (x * x + y * y + z * z)**0.5 - radius),
                     [-radius - 0.21] * 3, [radius + 0.17] * 3, [cells] * 3)


def primitive_block(cells):
    return level_set(lambda x, y, z: numpy.maximum(numpy.cos(x) + numpy.cos(y) + numpy.cos(z) + 0.6, cube_distance(x, y, z, 5.0)),
                     [-5.3] * 3, [5.2] * 3, [cells] * 3)


def struts(cells):
    """A lattice of round bars that run into each other."""
    def distance(x, y, z):
        x, y, z = ((c + 0.5) % 1 - 0.5 for c in (x, y, z))
        return numpy.minimum(numpy.minimum(numpy.hypot(x, y), numpy.hypot(y, z)), numpy.hypot(x, z)) - 0.17
    return level_set(lambda x, y, z: numpy.maximum(distance(x, y, z), cube_distance(x, y, z, 1.3)), [-1.41] * 3, [1.37] * 3, [cells] * 3)


def gear_outline(teeth, root, tip, width, flank):
    """Teeth whose tips take `width` of a pitch and whose flanks take `flank` of it."""
    pitch, lines = TAU / teeth, []
    for i in range(teeth):
        for radius, at in ((root, 0), (tip, flank), (tip, flank + width / 2), (tip, flank + width), (root, 2 * flank + width),
                           (root, 0.5 + flank + width / 2)):
            lines.append((radius * numpy.cos(pitch * (i + at)), radius * numpy.sin(pitch * (i + at))))
    return numpy.array(lines)


def gear(teeth, tip, width, flank, twist, levels):
    outer = gear_outline(teeth, 1.0, tip, width, flank)
    return ring_prism(outer, circle(0.4, len(outer)), numpy.linspace(0, 0.5, levels), twist)


def thread(turns, depth, around, per_turn):
    """A bolt with a thread of sharp ridges that run out at both ends."""
    steps = turns * per_turn
    z, angle = numpy.linspace(0, turns, steps + 1), TAU * numpy.arange(around) / around
    phase = (z[:, None] - angle[None] / TAU) % 1
    fade = numpy.clip(numpy.minimum(z, turns - z) - 0.25, 0, 1)[:, None]
    radius = 2 - depth * fade * (1 - abs(2 * phase - 1))
    return capped(numpy.stack([radius * numpy.cos(angle), radius * numpy.sin(angle), z[:, None] + 0 * radius], axis=-1))


def spring(turns, pitch, wire):
    t = numpy.linspace(0, TAU * turns, 40 * turns)
    return tube(numpy.column_stack([numpy.cos(t), numpy.sin(t), pitch * t / TAU]), wire, 16, False)


def knot(p, q, radius):
    t = TAU * numpy.arange(360) / 360
    ring = 2 + numpy.cos(q * t)
    return tube(numpy.column_stack([ring * numpy.cos(p * t), ring * numpy.sin(p * t), -numpy.sin(q * t)]), radius, 20, True)


def sharp_section(count, thickness):
    """An airfoil with a trailing edge of no thickness."""
    x = 0.5 * (1 - numpy.cos(numpy.pi * numpy.arange(count + 1) / count))
    y = 5 * thickness * (0.2969 * x**0.5 - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    y[-1] = 0
    return numpy.vstack([numpy.column_stack([x, y])[::-1], numpy.column_stack([x, -y])[1:-1]])


def blade(thickness, twist, taper, sections):
    """A twisted blade of airfoils; both ends are triangulated across, upper point to lower one."""
    line, rows = sharp_section(28, thickness), []
    for s in numpy.linspace(0, 1, sections):
        angle, chord = twist * s, 1 + (taper - 1) * s
        turn = numpy.array([[numpy.cos(angle), -numpy.sin(angle)], [numpy.sin(angle), numpy.cos(angle)]])
        rows.append(numpy.column_stack([chord * (line - (0.3, 0)) @ turn.T, numpy.full(len(line), 3 * s)]))
    points, triangles = sheet(numpy.array(rows), around_u=False)
    m, ends = len(line), []
    for first, way in ((0, 1), ((sections - 1) * m, -1)):
        for k in range(m // 2):
            a, b, c, d = k, k + 1, (m - k - 1) % m, (m - k) % m
            for corners in ((a, b, c), (a, c, d)):
                if len(set(corners)) == 3:
                    ends.append([first + corner for corner in corners[::way]])
    return outwards(points, numpy.vstack([triangles, ends]))


def honeycomb(rows, columns, wall, height):
    """Six-sided cells with walls of that thickness between them."""
    parts, corners = [], circle(1.0, 6, TAU / 12)
    for i in range(rows):
        for j in range(columns):
            place = numpy.array([3**0.5 * (j + 0.5 * (i % 2)), 1.5 * i])
            lines = ((corners, 0), ((1 - wall) * corners, 0), ((1 - wall) * corners, height), (corners, height))
            parts.append(sheet(numpy.array([numpy.column_stack([line + place, numpy.full(6, z)]) for line, z in lines])))
    points, triangles = weld(*together(*parts), 6)
    _, column = numpy.unique(numpy.round(points[:, :2], 5), axis=0, return_inverse=True)
    columns_of = numpy.sort(column.reshape(-1)[triangles], axis=1)
    upright = (columns_of[:, 0] == columns_of[:, 1]) | (columns_of[:, 1] == columns_of[:, 2])
    columns_of = numpy.where(upright[:, None], columns_of[:, [0, 2]], -1)
    _, index, count = numpy.unique(columns_of, axis=0, return_inverse=True, return_counts=True)
    return outwards(points, triangles[~upright | (count[index.reshape(-1)] == 2)])  # without the walls of two cells


def sponge(level):
    """Cubes of a Menger sponge."""
    n = 3**level
    i = numpy.stack(numpy.meshgrid(*[numpy.arange(n)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    kept = numpy.ones(len(i), bool)
    for k in range(level):
        kept &= ((i // 3**k % 3) == 1).sum(axis=1) < 2
    cube_points, cube = box((1, 1, 1))
    parts = [(cube_points + place, cube) for place in i[kept]]
    return outwards(*cube_union(parts))


def cube_union(parts):
    points, triangles = weld(*together(*parts))
    # Both halves of a square that two cubes share may be cut along different diagonals: squares are compared by their middle.
    a, b, c = (points[triangles[:, k]] for k in range(3))
    middle = numpy.round(0.5 * (numpy.minimum(numpy.minimum(a, b), c) + numpy.maximum(numpy.maximum(a, b), c)), 6)
    _, index, count = numpy.unique(middle, axis=0, return_inverse=True, return_counts=True)
    return points, triangles[count[index.reshape(-1)] == 2]


def noisy_box(noise, cells):
    points, triangles = box((2, 1, 1), cells=(2 * cells, cells, cells))
    random = numpy.random.default_rng(7)
    return points + random.uniform(-noise, noise, points.shape), triangles


def steps(count, height):
    """A plate with strips that are higher by a little than those beside them."""
    line = []
    for i in range(count):
        z = 1 + height * (i % 2)
        line += [(i / count, z), ((i + 1) / count, z)]
    top = numpy.array(line)
    bottom = numpy.column_stack([top[:, 0], 0 * top[:, 0]])
    rows = numpy.array([numpy.column_stack([side[:, 0], numpy.full(len(side), y), side[:, 1]]) for side, y in
                        ((bottom, 0), (top, 0), (top, 1), (bottom, 1))])
    points, triangles = sheet(rows, around_v=False)
    m, ends = len(top), []
    for k in (0, m - 1):
        quad = [k + m * r for r in range(4)]
        quad = quad if k == 0 else quad[::-1]
        ends += [(quad[0], quad[2], quad[1]), (quad[0], quad[3], quad[2])]
    return outwards(*weld(points, numpy.vstack([triangles, ends])))


def comb(teeth, gap, depth):
    """Fins with narrow gaps, as a prism over an outline of right angles."""
    pitch = 1.0
    xs = numpy.array([x for i in range(teeth) for x in (i * pitch, (i + 1) * pitch - gap)])
    floor, top, low = numpy.zeros(len(xs)), numpy.full(len(xs), depth), numpy.full(len(xs), -0.5)
    triangles, points = [], []
    for y in (0.0, 2.0):
        for z in (low, floor, top):
            points.append(numpy.column_stack([xs, numpy.full(len(xs), y), z]))
    m = len(xs)

    def quad(a, b, c, d):
        triangles.extend(((a, b, c), (a, c, d)))
    for k in range(m - 1):
        quad(k, k + 1, m + k + 1, m + k)  # y = 0, below
        quad(3 * m + k, 4 * m + k, 4 * m + k + 1, 3 * m + k + 1)
        quad(k, 3 * m + k, 3 * m + k + 1, k + 1)  # z = -0.5
        if k % 2 == 0:
            quad(m + k, m + k + 1, 2 * m + k + 1, 2 * m + k)
            quad(4 * m + k, 5 * m + k, 5 * m + k + 1, 4 * m + k + 1)
            quad(2 * m + k, 2 * m + k + 1, 5 * m + k + 1, 5 * m + k)
            quad(m + k, 2 * m + k, 5 * m + k, 4 * m + k)
            quad(m + k + 1, 4 * m + k + 1, 5 * m + k + 1, 2 * m + k + 1)
        else:
            quad(m + k, m + k + 1, 4 * m + k + 1, 4 * m + k)
    quad(0, m, 4 * m, 3 * m)
    quad(m - 1, 4 * m - 1, 5 * m - 1, 2 * m - 1)
    return outwards(numpy.vstack(points), numpy.array(triangles))


def urchin(spikes_level, length):
    """A ball with a thin spike on each triangle of a coarse ball."""
    points, triangles = ball(1.0, spikes_level)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    tips = (a + b + c) / 3
    tips *= length / numpy.linalg.norm(tips, axis=1)[:, None]
    tip = len(points) + numpy.arange(len(triangles))
    fans = [numpy.stack([triangles[:, k], triangles[:, (k + 1) % 3], tip], axis=1) for k in range(3)]
    return numpy.vstack([points, tips]), numpy.vstack(fans)


def lens(radius, around):
    """Two caps that meet in a rim of 60 degrees."""
    rows = []
    for s in numpy.linspace(0.02, 0.98, 25):
        r = numpy.sin(numpy.pi * s)
        z = numpy.sign(s - 0.5) * (1 - r) * 0.5
        rows.append(numpy.column_stack([radius * circle(r, around), numpy.full(around, radius * z)]))
    return capped(numpy.array(rows))


def rings(gap):
    """Two linked tori, nearly touching."""
    t = TAU * numpy.arange(96) / 96
    first = tube(numpy.column_stack([numpy.cos(t), numpy.sin(t), 0 * t]), 0.3, 32, True)
    second = tube(numpy.column_stack([1 - 0.4 + gap + numpy.cos(t) - 0.0, 0 * t, numpy.sin(t)]), 0.3, 32, True)
    return together(first, (second[0] + (0.0, 0, 0), second[1]))


def bumpy(amount, level):
    points, triangles = ball(1.0, level)
    x, y, z = points.T
    radius = 1 + amount * numpy.sin(7 * x) * numpy.sin(6 * y + 1) * numpy.sin(8 * z)
    return points * radius[:, None], triangles


TRIANGLES = {
    "gyroid_walls": (lambda: gyroid_block(3.3, 0.35, 44), "off"),
    "gyroid_ball": (lambda: gyroid_ball(6.0, 48), "stl"),
    "primitive_block": (lambda: primitive_block(40), "obj"),
    "struts": (lambda: struts(56), "stl"),
    "gear_thin_teeth": (lambda: gear(40, 1.18, 0.12, 0.08, 0, 2), "off"),
    "gear_helical": (lambda: gear(24, 1.2, 0.25, 0.15, 0.5, 14), "stl"),
    "thread_fine": (lambda: thread(12, 0.35, 60, 16), "off"),
    "spring_tight": (lambda: spring(8, 0.42, 0.2), "stl"),
    "knot": (lambda: knot(2, 3, 0.35), "obj"),
    "blade_sharp": (lambda: blade(0.10, 0.9, 0.5, 30), "off"),
    "blade_thin": (lambda: blade(0.03, 1.4, 0.3, 40), "stl"),
    "honeycomb": (lambda: honeycomb(5, 6, 0.12, 1.5), "off"),
    "honeycomb_thin": (lambda: honeycomb(4, 4, 0.03, 0.8), "stl"),
    "sponge": (lambda: sponge(2), "off"),
    "noisy_box": (lambda: noisy_box(2e-3, 14), "off"),
    "low_steps": (lambda: steps(14, 2e-3), "off"),
    "comb_narrow": (lambda: comb(12, 0.02, 1.5), "obj"),
    "urchin": (lambda: urchin(1, 1.8), "off"),
    "balls_near": (lambda: together(ball(1, 3), ball(1, 3, (2.0005, 0, 0)), ball(0.5, 3, (0, 1.502, 0))), "stl"),
    "shell_thin": (lambda: together(ball(1, 4), turned_in(ball(0.99, 4))), "off"),
    "rings_near": (lambda: rings(4e-3), "off"),
    "bumpy": (lambda: bumpy(0.06, 4), "obj"),
    "film": (lambda: box((50, 50, 0.02), cells=(10, 10, 1)), "off"),
    "lens": (lambda: lens(1.0, 48), "stl"),
}
