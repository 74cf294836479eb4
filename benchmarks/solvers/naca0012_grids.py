"""Two grids about a section of NACA 0012 between two planes, in the same domain: one of Aeroloom, with layers on the section, and a
C-grid of `blockMesh`. The chord is 1, the section ends sharp, the domain is a half disc before the section and a box behind."""
import math
import pathlib
import subprocess

SPAN = 0.1
FAR = 30.0
REYNOLDS = 6e6
FOIL_POINTS = 60

CASE = """# NACA 0012 between two planes of symmetry, with layers.
geometry:
  file: section.brep
  domain: fluid
groups:
  foil: {{box: [[-1, -1, -1], [2, 1, 1]], type: wall}}
  left: {{normal: [0, -1, 0], type: symmetry}}
  right: {{normal: [0, 1, 0], type: symmetry}}
  outer: {{faces: '*', type: farfield}}
sizing:
  solver: cell
  minimum: 0.001
  surface_maximum: 0.45
  maximum: 0.45
  curvature_angle: 4
  growth: 1.2
  proximity: 0             # the planes are nearer to each other than the far field's elements are long
  walls:
    foil: {{faces: [foil], size: 0.02, distance: 0}}
  edges:
    trailing: {{between: [foil], low: [0.999, -1, -1], high: [1.001, 1, 1], size: 0.004}}
  sources:
    wake: {{shape: wake, from: [1, 0, 0], to: [1, {span}, 0], direction: [1, 0, {slope}], length: 3, size: 0.01, end_size: 0.2}}
layers:
  reynolds: {reynolds}
  length: 1
  y_plus: {y_plus}
  growth: 1.25
output:
  formats: [openfoam]
  pictures: false
"""


def half_thickness(x):
    """NACA 0012 as NASA's page on turbulence models closes it: thickness 0 at x = 1."""
    return 0.594689181 * (0.298222773 * math.sqrt(x) - 0.127125232 * x - 0.357907906 * x**2 + 0.291984971 * x**3
                          - 0.105174606 * x**4)


def first_height(y_plus):
    """Height of the cell at the wall whose centre has this y+, as `layers` has it with `solver: cell`."""
    friction = 0.026 / REYNOLDS**(1 / 7)
    return 2 * 0.80 * y_plus / (REYNOLDS * math.sqrt(friction / 2))


def foil_points(count):
    """From nose to tail on the upper side, denser at both ends."""
    xs = [0.5 * (1 - math.cos(math.pi * i / count)) for i in range(count + 1)]
    return [(x, 0.0 if i in (0, count) else half_thickness(x)) for i, x in enumerate(xs)]


def write_geometry(folder):
    """section.brep by Gmsh: the domain less the section."""
    inner = foil_points(FOIL_POINTS)[1:-1]
    lines = ['SetFactory("OpenCASCADE");']
    tags = {}

    def point(name, x, z):
        tags[name] = len(tags) + 1
        lines.append(f"Point({tags[name]}) = {{{x:.12g}, 0, {z:.12g}}};")

    for name, x, z in (("nose", 0, 0), ("tail", 1, 0), ("middle", 0.5, 0), ("front", 0.5 - FAR, 0), ("top", 0.5, FAR),
                       ("bottom", 0.5, -FAR), ("back_top", 1 + FAR, FAR), ("back_bottom", 1 + FAR, -FAR)):
        point(name, x, z)
    for i, (x, z) in enumerate(inner):
        point(f"upper{i}", x, z)
        point(f"lower{i}", x, -z)
    upper = ", ".join(str(tags[f"upper{i}"]) for i in reversed(range(len(inner))))
    lower = ", ".join(str(tags[f"lower{i}"]) for i in range(len(inner)))
    lines += [f"Spline(1) = {{{tags['tail']}, {upper}, {tags['nose']}}};",
              f"Spline(2) = {{{tags['nose']}, {lower}, {tags['tail']}}};",
              f"Circle(3) = {{{tags['top']}, {tags['middle']}, {tags['front']}}};",
              f"Circle(4) = {{{tags['front']}, {tags['middle']}, {tags['bottom']}}};",
              f"Line(5) = {{{tags['bottom']}, {tags['back_bottom']}}};",
              f"Line(6) = {{{tags['back_bottom']}, {tags['back_top']}}};",
              f"Line(7) = {{{tags['back_top']}, {tags['top']}}};",
              "Curve Loop(1) = {3, 4, 5, 6, 7}; Curve Loop(2) = {1, 2}; Plane Surface(1) = {1, 2};",
              f"Extrude {{0, {SPAN}, 0}} {{ Surface{{1}}; }}", 'Save "section.brep";']
    (folder / "section.geo").write_text("\n".join(lines) + "\n")
    subprocess.run(["gmsh", "section.geo", "-0", "-v", "2"], cwd=folder, check=True)


def write_case(folder, angle, y_plus):
    """naca0012.yaml beside section.brep."""
    text = CASE.format(span=SPAN, slope=f"{math.tan(math.radians(angle)):.4f}", reynolds=f"{REYNOLDS:g}", y_plus=y_plus)
    path = pathlib.Path(folder) / "naca0012.yaml"
    path.write_text(text)
    return path


def growth_to(length, first, cells):
    """Last over first of `cells` heights in geometric series that fill `length`."""
    low, high = 1.0 + 1e-9, 3.0
    for _ in range(200):
        ratio = 0.5 * (low + high)
        low, high = (ratio, high) if first * (ratio**cells - 1) / (ratio - 1) < length else (low, ratio)
    return ratio**(cells - 1)


# Corners of the C-grid's blocks on a plane: nose, tail, end of the wake; the outer border before, above and behind, below; where
# the blocks on the section meet above and below, on the section and on the border.
NOSE, TAIL, END, FRONT, TOP, END_TOP, BOTTOM, END_BOTTOM, UPPER, LOWER, FAR_UPPER, FAR_LOWER = range(12)
CORNERS = 12
MEETING, FAN = 0.3, math.radians(60)


def c_grid(y_plus):
    """system/blockMeshDict of the C-grid: six blocks, one cell across."""
    nose, rear, behind, off = 70, 70, 70, 100
    normal, wake = growth_to(FAR, first_height(y_plus), off), growth_to(FAR, 0.005, behind)
    far_normal = growth_to(FAR, 0.05, off)
    height, fan = half_thickness(MEETING), (0.5 - FAR * math.cos(FAN), FAR * math.sin(FAN))
    plane = [(0, 0), (1, 0), (1 + FAR, 0), (0.5 - FAR, 0), (1, FAR), (1 + FAR, FAR), (1, -FAR), (1 + FAR, -FAR),
             (MEETING, height), (MEETING, -height), fan, (fan[0], -fan[1])]
    vertices = [f"({x:.12g} {y} {z:.12g})" for y in (0, SPAN) for x, z in plane]

    def block(corners, cells, along, normals):
        """Anticlockwise above the chord, clockwise below it, where the other plane comes first."""
        first, second = (CORNERS, 0) if corners[2] in (TOP, END_TOP, FAR_UPPER) else (0, CORNERS)
        ends = " ".join([str(c + first) for c in corners] + [str(c + second) for c in corners])
        near, far = along
        left, right = normals
        grading = (near, far, far, near, left, right, right, left)
        return f"hex ({ends}) ({cells} {off} 1) edgeGrading ({' '.join(map(str, grading))} 1 1 1 1)"

    blocks = []
    for top, end, mid, far_mid in ((TOP, END_TOP, UPPER, FAR_UPPER), (BOTTOM, END_BOTTOM, LOWER, FAR_LOWER)):
        blocks += [block((NOSE, mid, far_mid, FRONT), nose, ("((0.15 0.4 4) (0.85 0.6 3))", 1), (normal, normal)),
                   block((mid, TAIL, top, far_mid), rear, ("((0.4 0.33 1.3) (0.6 0.67 0.3))", 0.3), (normal, normal)),
                   block((TAIL, END, end, top), behind, (wake, wake), (normal, far_normal))]
    return dict_text(vertices, blocks, curved_edges())


def curved_edges():
    """The section and the circle before it, on both planes."""
    edges = []
    front = [x for x, _ in foil_points(400) if 0 < x < MEETING]
    rear = [x for x, _ in foil_points(400) if MEETING < x < 1]
    turns = [FAN * i / 200 for i in range(1, 200)], [FAN + (0.5 * math.pi - FAN) * i / 100 for i in range(1, 101)]
    for shift, y in ((0, 0), (CORNERS, SPAN)):
        for sign, mid, far_mid, far_tail in ((1, UPPER, FAR_UPPER, TOP), (-1, LOWER, FAR_LOWER, BOTTOM)):
            for start, end, xs in ((NOSE, mid, front), (mid, TAIL, rear)):
                points = " ".join(f"({x:.12g} {y} {sign * half_thickness(x):.12g})" for x in xs)
                edges.append(f"polyLine {start + shift} {end + shift} ({points})")
            for start, end, angles in ((FRONT, far_mid, turns[0]), (far_mid, far_tail, turns[1])):
                points = " ".join(f"({0.5 - FAR * math.cos(t):.12g} {y} {sign * FAR * math.sin(t):.12g})" for t in angles)
                edges.append(f"polyLine {start + shift} {end + shift} ({points})")
    return edges


def dict_text(vertices, blocks, edges):
    def sides(*pairs):
        return " ".join(f"({a} {b} {b + CORNERS} {a + CORNERS})" for a, b in pairs)

    lines = "\n    "
    foil = sides((NOSE, UPPER), (UPPER, TAIL), (NOSE, LOWER), (LOWER, TAIL))
    outer = sides((FRONT, FAR_UPPER), (FAR_UPPER, TOP), (TOP, END_TOP), (END, END_TOP), (FRONT, FAR_LOWER), (FAR_LOWER, BOTTOM),
                  (BOTTOM, END_BOTTOM), (END, END_BOTTOM))
    planes = " ".join(f"({' '.join(str(c + shift) for c in corners)})" for shift in (0, CORNERS) for corners in (
        (NOSE, UPPER, FAR_UPPER, FRONT), (UPPER, TAIL, TOP, FAR_UPPER), (TAIL, END, END_TOP, TOP),
        (NOSE, LOWER, FAR_LOWER, FRONT), (LOWER, TAIL, BOTTOM, FAR_LOWER), (TAIL, END, END_BOTTOM, BOTTOM)))
    return f"""FoamFile {{ version 2.0; format ascii; class dictionary; object blockMeshDict; }}
vertices
(
    {lines.join(vertices)}
);
blocks
(
    {lines.join(blocks)}
);
edges
(
    {lines.join(edges)}
);
boundary
(
    foil {{ type wall; inGroups (wall); faces ({foil}); }}
    outer {{ type patch; inGroups (farfield); faces ({outer}); }}
    planes {{ type empty; faces ({planes}); }}
);
"""
