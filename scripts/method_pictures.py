#!/usr/bin/env python3
"""Draws docs/pictures/lattice.svg and docs/pictures/shared_vertices.svg: plain SVG, readable in black and white.

usage: method_pictures.py [FOLDER]

What the drawings say is in volume/lattice/block_points.hpp and volume/lattice/lattice_tree.hpp, and in mesh/exchange/shared_vertices.hpp.
"""
import html
import pathlib
import sys

FONT = 'font-family="DejaVu Sans, Arial, sans-serif" font-size="13"'


def text(x, y, words, anchor="start", size=13, weight="normal"):
    return (f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" font-size="{size}" font-weight="{weight}">'
            f"{html.escape(words)}</text>")


def line(a, b, width=1.0, color="#000", dash="", arrow=False):
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    end = ' marker-end="url(#arrow)"' if arrow else ""
    return (f'<line x1="{a[0]:g}" y1="{a[1]:g}" x2="{b[0]:g}" y2="{b[1]:g}" stroke="{color}" stroke-width="{width}"'
            f"{dashes}{end}/>")


def box(x, y, width, height, fill="none", stroke="#000", thick=1.0):
    return f'<rect x="{x:g}" y="{y:g}" width="{width:g}" height="{height:g}" fill="{fill}" stroke="{stroke}" stroke-width="{thick}"/>'


def disc(at, fill="#000", radius=4.0):
    return f'<circle cx="{at[0]:g}" cy="{at[1]:g}" r="{radius:g}" fill="{fill}" stroke="#000" stroke-width="1.2"/>'


def polygon(points, fill, stroke="#000", thick=1.0, dash=""):
    dashes = f' stroke-dasharray="{dash}"' if dash else ""
    places = " ".join(f"{x:g},{y:g}" for x, y in points)
    return f'<polygon points="{places}" fill="{fill}" stroke="{stroke}" stroke-width="{thick}"{dashes}/>'


def picture(width, height, parts):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" {FONT}>\n'
            '<defs><marker id="arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" orient="auto">'
            '<path d="M0,0.8 L7,4 L0,7.2 z"/></marker></defs>\n'
            f'<rect width="{width}" height="{height}" fill="#fff"/>\n' + "\n".join(parts) + "\n</svg>\n")


# ---- block, leaf and cell of the lattice ----

def corners_of(x, y, edge):
    return [(x, y), (x + edge, y), (x, y + edge), (x + edge, y + edge)]


def octree(left, top):
    """A square of 320 with one block of large leaves, one large leaf that is a block, and two blocks of small leaves."""
    big, small = 80, 40
    leaves = [(left + big * i, top + big * j, big) for i in range(2) for j in range(2)]
    leaves += [(left + 160 + big * i, top + 80 * j, big) for i, j in ((1, 0), (1, 1))]
    blocks_small = [(left + 160, top), (left + 160, top + 80)]
    for x, y in blocks_small:
        leaves += [(x + small * i, y + small * j, small) for i in range(2) for j in range(2)]
    parts = [box(x, y, edge, edge, fill="#fff", stroke="#999") for x, y, edge in leaves]
    thick = [(left, top, 160), *((x, y, 80) for x, y in blocks_small), (left + 240, top, 80), (left + 240, top + 80, 80)]
    parts += [box(x, y, edge, edge, thick=2.6) for x, y, edge in thick]
    corners = {corner for leaf in leaves for corner in corners_of(*leaf)}
    hanging = {(left + 160, top + 40), (left + 160, top + 120), (left + 240, top + 40), (left + 240, top + 120)}
    parts += [disc(at) for at in sorted(corners - hanging)]
    parts += [disc(at, "#aaa") for at in sorted(hanging)]
    parts += [disc((x + edge / 2, y + edge / 2), "#fff", 3.5) for x, y, edge in leaves]
    return parts


def cells(left, top, edge):
    """Cells between centres: of one size, and of a leaf beside two smaller ones."""
    half = edge / 2
    a, b = (left + half, top + half), (left + 1.5 * edge, top + half)
    low, high = (left + edge, top), (left + edge, top + edge)
    parts = [box(left, top, edge, edge, stroke="#999"), box(left + edge, top, edge, edge, stroke="#999"),
             polygon([a, low, b], "#ddd"), polygon([a, high, b], "#f2f2f2")]
    parts += [disc(at) for at in (low, high, (left, top), (left, top + edge), (left + 2 * edge, top), (left + 2 * edge, top + edge))]
    return parts + [disc(at, "#fff", 3.5) for at in (a, b)]


def cells_of_two_sizes(left, top, edge):
    half = edge / 2
    a, mid = (left + half, top + half), (left + edge, top + half)
    low, high = (left + edge, top), (left + edge, top + edge)
    small = [(left + edge + edge / 4, top + edge / 4), (left + edge + edge / 4, top + 3 * edge / 4)]
    parts = [box(left, top, edge, edge, stroke="#999")]
    parts += [box(left + edge + half * i, top + half * j, half, half, stroke="#999") for i in range(2) for j in range(2)]
    parts += [polygon([a, low, mid], "#ddd"), polygon([a, mid, high], "#f2f2f2"),
              polygon([small[0], low, mid], "#eee"), polygon([small[1], mid, high], "#ddd")]
    points = {(left, top), (left, top + edge), low, high}
    points |= {(left + edge + half * i, top + half * j) for i in range(3) for j in range(3)} - {mid}
    parts += [disc(at) for at in sorted(points)] + [disc(mid, "#aaa")]
    centres = [a, *((left + edge + edge / 4 + half * i, top + edge / 4 + half * j) for i in range(2) for j in range(2))]
    return parts + [disc(at, "#fff", 3.5) for at in centres]


def slots(left, top, edge):
    """One leaf in three dimensions, with its eight slots."""
    def at(x, y, z):
        return (left + edge * (x + 0.45 * y), top + edge * (1.32 - z - 0.32 * y))

    frame = [((0, 0, 0), (1, 0, 0)), ((0, 0, 0), (0, 1, 0)), ((0, 0, 0), (0, 0, 1)), ((1, 0, 0), (1, 1, 0)), ((1, 0, 0), (1, 0, 1)),
             ((0, 1, 0), (1, 1, 0)), ((0, 1, 0), (0, 1, 1)), ((0, 0, 1), (1, 0, 1)), ((0, 0, 1), (0, 1, 1)), ((1, 1, 0), (1, 1, 1)),
             ((1, 0, 1), (1, 1, 1)), ((0, 1, 1), (1, 1, 1))]
    parts = [line(at(*a), at(*b), color="#999", dash="4 3" if (0, 1, 0) in (a, b) else "") for a, b in frame]
    places = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1), (1, 1, 1)]  # slot_places
    fills = ["#000"] + ["#aaa"] * 6 + ["#fff"]
    for slot, (place, fill) in enumerate(zip(places, fills)):
        x, y = at(*(0.5 * c for c in place))
        parts += [disc((x, y), fill), text(x + 7, y - 5, str(slot), size=12)]
    return parts


def lattice():
    parts = [text(20, 24, "Blocks and leaves (drawn in the plane)", weight="bold")]
    parts += octree(20, 40)
    parts += [text(20, 222, "thick: a block: the leaves of one split cube,"), text(20, 239, "or one leaf that has a split sibling"),
              text(20, 256, "thin: a leaf")]
    parts += [disc((27, 275)), text(40, 279, "corner of leaves"), disc((27, 295), "#fff", 3.5), text(40, 299, "centre of a leaf"),
              disc((27, 315), "#aaa"), text(40, 319, "corner in the middle of a larger leaf's side")]
    parts += [text(390, 24, "One leaf: its slots", weight="bold"), *slots(390, 40, 105)]
    parts += [text(575, 78, "A leaf owns the point at its low corner (0),"), text(575, 95, "its centre (7), and hanging points on three"),
              text(575, 112, "edges (1, 2, 3) and three squares (4, 5, 6)."),
              text(575, 142, "number of a point ="), text(575, 160, "64 · block + 8 · leaf in its block + slot", weight="bold"),
              text(575, 182, "key = vertices of the surface + number")]
    parts += [text(390, 222, "Cells of the core: around the line between two centres", weight="bold")]
    parts += cells(400, 236, 84) + cells_of_two_sizes(640, 236, 84)
    parts += [text(484, 338, "equal leaves", "middle"), text(724, 338, "unequal leaves: over the finer squares", "middle")]
    return picture(860, 350, parts)


# ---- who owns a shared vertex ----

def shared_vertices():
    parts = [text(20, 24, "Three pieces, and a vertex that all of them know", weight="bold")]
    v = (190, 170)
    pieces = {"piece 0": [(60, 60), (200, 50), v, (70, 190)], "piece 2": [(200, 50), (330, 80), (320, 230), v],
              "piece 5": [(70, 190), v, (320, 230), (170, 300)]}
    shades = {"piece 0": "#e4e4e4", "piece 2": "#fff", "piece 5": "#f4f4f4"}
    gap = 9
    middle_of = {}
    for name, corners in pieces.items():
        middle = (sum(x for x, _ in corners) / 4, sum(y for _, y in corners) / 4)
        pull = [(x + gap * (middle[0] - x) / 100, y + gap * (middle[1] - y) / 100) for x, y in corners]
        middle_of[name] = middle
        parts.append(polygon(pull, shades[name], thick=1.4))
        x, y = pull[corners.index(v)]
        parts.append(disc((x, y), "#000" if name == "piece 0" else "#fff", 5))
    parts += [text(middle_of["piece 0"][0] - 20, middle_of["piece 0"][1] - 4, "piece 0", "middle", weight="bold"),
              text(middle_of["piece 0"][0] - 20, middle_of["piece 0"][1] + 13, "on rank 1", "middle"),
              text(middle_of["piece 2"][0] + 8, middle_of["piece 2"][1] - 14, "piece 2", "middle", weight="bold"),
              text(middle_of["piece 2"][0] + 8, middle_of["piece 2"][1] + 3, "on rank 0", "middle"),
              text(middle_of["piece 5"][0], middle_of["piece 5"][1] + 8, "piece 5", "middle", weight="bold"),
              text(middle_of["piece 5"][0], middle_of["piece 5"][1] + 25, "on rank 0", "middle")]
    parts += [disc((27, 330), "#000", 5), text(40, 334, "the owner's copy: of the lowest piece"),
              disc((27, 352), "#fff", 5), text(40, 356, "the sharers' copies; all copies have one key")]
    parts += exchange(410, "reduce(op): sharers to the owner, in the order of pieces", to_owner=True, top=24)
    parts += exchange(410, "scatter: the owner to its sharers", to_owner=False, top=204)
    return picture(860, 372, parts)


def exchange(left, title, to_owner, top):
    """Values of the three copies before and after."""
    parts = [text(left, top, title, weight="bold")]
    rows = [("piece 0, rank 1", "a", "(a op b) op c"), ("piece 2, rank 0", "b", "b"), ("piece 5, rank 0", "c", "c")]
    if not to_owner:
        rows = [("piece 0, rank 1", "t", "t"), ("piece 2, rank 0", "b", "t"), ("piece 5, rank 0", "c", "t")]
    parts += [text(left + 150, top + 26, "before", "middle"), text(left + 345, top + 26, "after", "middle")]
    for i, (name, before, after) in enumerate(rows):
        y = top + 38 + 40 * i
        fill = "#e4e4e4" if i == 0 else "#fff"
        parts += [text(left, y + 20, name), box(left + 125, y, 50, 28, fill), text(left + 150, y + 19, before, "middle"),
                  box(left + 285, y, 120, 28, fill), text(left + 345, y + 19, after, "middle")]
        if i:
            start, end = (left + 175, y + 14), (left + 285, top + 38 + 8 + 10 * i)
            parts.append(line(start, end, arrow=True) if to_owner else line((left + 175, top + 38 + 8 + 6 * i), (left + 285, y + 14), arrow=True))
    return parts


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent / "docs" / "pictures"
    (folder / "lattice.svg").write_text(lattice())
    (folder / "shared_vertices.svg").write_text(shared_vertices())


if __name__ == "__main__":
    main()
