"""Closed surfaces of triangles from formulas: grids, tubes, balls, boxes, prisms and level sets, and their files.

A surface is its points (n x 3) and its triangles (m x 3), oriented outwards.
"""
import struct

import numpy

TAU = 2 * numpy.pi
KUHN = ((0, 1, 3, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 6, 4, 7), (0, 4, 5, 7), (0, 5, 1, 7))


def weld(points, triangles, digits=10):
    """Equal points become one, triangles that lose a corner are left out."""
    _, first, index = numpy.unique(numpy.round(points, digits), axis=0, return_index=True, return_inverse=True)
    triangles = index.reshape(-1)[triangles]
    whole = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2]) & (triangles[:, 2] != triangles[:, 0])
    return points[first], triangles[whole]


def together(*parts):
    """Several closed surfaces as one."""
    offsets = numpy.cumsum([0] + [len(points) for points, _ in parts[:-1]])
    return (numpy.vstack([points for points, _ in parts]),
            numpy.vstack([triangles + offset for (_, triangles), offset in zip(parts, offsets)]))


def level_set(function, low, high, cells):
    """Where the function is below zero, by marching tetrahedra."""
    axes = [numpy.linspace(low[k], high[k], cells[k] + 1) for k in range(3)]
    grid = numpy.stack(numpy.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    values = function(*grid.T)
    values[numpy.abs(values) < 1e-9] = 1e-9
    number = numpy.arange(len(grid)).reshape([c + 1 for c in cells])
    corner = [number[i:cells[0] + i, j:cells[1] + j, k:cells[2] + k].ravel() for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    tets = numpy.vstack([numpy.stack([corner[c] for c in tet], axis=1) for tet in KUHN])
    inside = values[tets] < 0
    order = numpy.argsort(~inside, axis=1, kind="stable")
    tets, counts = numpy.take_along_axis(tets, order, axis=1), inside.sum(axis=1)
    one, two, three = tets[counts == 1], tets[counts == 2], tets[counts == 3]

    def cut(pairs):
        pairs = numpy.sort(pairs, axis=1)
        at = values[pairs]
        return grid[pairs[:, 0]] + (at[:, :1] / (at[:, :1] - at[:, 1:])) * (grid[pairs[:, 1]] - grid[pairs[:, 0]])

    triangles, ways = [], []
    for tet, edges in ((one, ((0, 1), (0, 2), (0, 3))), (three, ((0, 3), (1, 3), (2, 3))),
                       (two, ((0, 2), (0, 3), (1, 3))), (two, ((0, 2), (1, 3), (1, 2)))):
        triangles.append(numpy.stack([cut(tet[:, list(edge)]) for edge in edges], axis=1))
        ways.append(grid[tet[:, 3]] - grid[tet[:, 0]])
    triangles, way = numpy.vstack(triangles), numpy.vstack(ways)
    normal = numpy.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    turned = (normal * way).sum(axis=1) < 0
    triangles[turned] = triangles[turned][:, ::-1]
    return weld(triangles.reshape(-1, 3), numpy.arange(3 * len(triangles)).reshape(-1, 3), 9)


def sheet(rows, around_u=True, around_v=True):
    """Triangles of a grid of points (n x m x 3), closed around in either direction."""
    n, m = rows.shape[:2]
    number = numpy.arange(n * m).reshape(n, m)
    if around_u:
        number = numpy.vstack([number, number[:1]])
    if around_v:
        number = numpy.hstack([number, number[:, :1]])
    a, b, c, d = number[:-1, :-1].ravel(), number[1:, :-1].ravel(), number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    return rows.reshape(-1, 3), numpy.vstack([numpy.stack([a, b, c], axis=1), numpy.stack([a, c, d], axis=1)])


def capped(rows):
    """A grid of points closed around in its second direction, with a fan at either end."""
    points, triangles = sheet(rows, around_u=False)
    n, m = rows.shape[:2]
    ring = numpy.arange(m)
    ends = numpy.vstack([rows[0].mean(axis=0), rows[-1].mean(axis=0)])
    first = numpy.stack([numpy.full(m, n * m), ring, numpy.roll(ring, -1)], axis=1)
    last = numpy.stack([numpy.full(m, n * m + 1), (n - 1) * m + numpy.roll(ring, -1), (n - 1) * m + ring], axis=1)
    return outwards(numpy.vstack([points, ends]), numpy.vstack([triangles, first, last]))


def outwards(points, triangles):
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return (points, triangles) if (a * numpy.cross(b, c)).sum() > 0 else (points, triangles[:, ::-1])


def ring_prism(outer, inner, heights, twist=0.0):
    """Between two outlines of as many points, extruded along z and turned by `twist` on the way."""
    rows = []
    for height in heights:
        angle = twist * (height - heights[0]) / (heights[-1] - heights[0])
        turn = numpy.array([[numpy.cos(angle), -numpy.sin(angle)], [numpy.sin(angle), numpy.cos(angle)]])
        rows.append([numpy.column_stack([line @ turn.T, numpy.full(len(line), height)]) for line in (outer, inner)])
    loop = [pair[0] for pair in rows] + [pair[1] for pair in rows[::-1]]
    return outwards(*sheet(numpy.array(loop)))


def circle(radius, count, phase=0.0):
    angle = TAU * numpy.arange(count) / count + phase
    return radius * numpy.column_stack([numpy.cos(angle), numpy.sin(angle)])


def ball(radius, level, place=(0, 0, 0)):
    g = (1 + 5**0.5) / 2
    points = numpy.array([(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
                          (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)], float)
    triangles = numpy.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
                             (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
                             (8, 6, 7), (9, 8, 1)])
    for _ in range(level):
        a, b, c = (points[triangles[:, k]] for k in range(3))
        corners = numpy.stack([a, (a + b) / 2, (c + a) / 2, b, (b + c) / 2, (a + b) / 2, c, (c + a) / 2, (b + c) / 2,
                               (a + b) / 2, (b + c) / 2, (c + a) / 2], axis=1).reshape(-1, 3)
        points, triangles = weld(corners, numpy.arange(len(corners)).reshape(-1, 3))
    points = radius * points / numpy.linalg.norm(points, axis=1)[:, None]
    return points + numpy.array(place, float), triangles


def box(size, place=(0, 0, 0), cells=(1, 1, 1)):
    """Its surface as squares of two triangles each."""
    parts = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            grid = numpy.zeros((cells[u] + 1, cells[v] + 1, 3))
            grid[..., axis] = side
            grid[..., u] = numpy.linspace(0, 1, cells[u] + 1)[:, None]
            grid[..., v] = numpy.linspace(0, 1, cells[v] + 1)[None]
            points, triangles = sheet(grid, False, False)
            parts.append((points, triangles if side else triangles[:, ::-1]))
    points, triangles = weld(*together(*parts))
    return points * numpy.array(size, float) + numpy.array(place, float), triangles


def turned_in(part):
    return part[0], part[1][:, ::-1]


def tube(center, radius, around, closed):
    """A round tube along points, in a frame that does not twist."""
    along = numpy.roll(center, -1, 0) - numpy.roll(center, 1, 0) if closed else numpy.gradient(center, axis=0)
    along /= numpy.linalg.norm(along, axis=1)[:, None]
    side = numpy.cross(along[0], (0.3, 0.2, 1.0))
    sides = []
    for tangent in along:
        side = side - tangent * (side @ tangent)
        side /= numpy.linalg.norm(side)
        sides.append(side)
    sides = numpy.array(sides)
    second = numpy.cross(along, sides)
    if closed:
        last = sides[-1] - along[0] * (sides[-1] @ along[0])
        total = numpy.arctan2(last @ second[0], last @ sides[0])
        back = -total * numpy.arange(len(center)) / len(center)
        sides, second = (numpy.cos(back)[:, None] * sides + numpy.sin(back)[:, None] * second,
                         numpy.cos(back)[:, None] * second - numpy.sin(back)[:, None] * sides)
    angle = TAU * numpy.arange(around) / around
    rows = center[:, None] + radius * (numpy.cos(angle)[None, :, None] * sides[:, None] + numpy.sin(angle)[None, :, None] * second[:, None])
    return outwards(*sheet(rows)) if closed else capped(rows)


def write_model(path, points, triangles):
    """As OFF, OBJ or binary STL, by the ending."""
    if path.suffix == ".off":
        rows = ["OFF", f"{len(points)} {len(triangles)} 0", *("%.12g %.12g %.12g" % tuple(p) for p in points),
                *("3 %d %d %d" % tuple(t) for t in triangles)]
        path.write_text("\n".join(rows) + "\n")
    elif path.suffix == ".obj":
        rows = [*("v %.12g %.12g %.12g" % tuple(p) for p in points), *("f %d %d %d" % tuple(t + 1) for t in triangles)]
        path.write_text("\n".join(rows) + "\n")
    else:
        corners = points.astype("<f4")[triangles]
        normal = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= numpy.maximum(numpy.linalg.norm(normal, axis=1), 1e-30)[:, None]
        records = numpy.zeros(len(triangles), dtype=[("floats", "<f4", 12), ("attribute", "<u2")])
        records["floats"] = numpy.hstack([normal, corners.reshape(-1, 9)])
        path.write_bytes(b"model".ljust(80) + struct.pack("<I", len(triangles)) + records.tobytes())


def faults(points, triangles):
    """What keeps the surface from being closed, as text; empty where nothing does."""
    edges = numpy.vstack([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    key, count = numpy.unique(edges, axis=0, return_counts=True)
    if (count > 1).any():
        return f"{(count > 1).sum()} edges are passed twice in one direction"
    back = numpy.unique(key[:, ::-1], axis=0)
    return "" if len(back) == len(key) and (back == key).all() else "open edges"
