"""Closed models that gmsh makes with OpenCASCADE: lofts, helices, fillets, holes and booleans.

`CAD` names them: the text of a `.geo` file (gmsh 4.8 and later), the ending of what gmsh writes, and keys of the case beside
`geometry.file`. `make_cad` writes one of them.
"""
import subprocess

HEAD = 'SetFactory("OpenCASCADE");\n'


def loft(section, count, closed=True):
    """Wires from `section(i)`, a list of commands whose last one makes Curve Loop i, and the body through them."""
    text = "".join(section(i) for i in range(1, count + 1))
    return HEAD + text + f"ThruSections(1) = {{1:{count}}};\n"


def square_section(size, height, turn):
    def section(i):
        p, a = 10 * i, turn * (i - 1)
        points = "".join(f"Point({p + k}) = {{{size(i)}*Cos({a}+{k}*Pi/2), {size(i)}*Sin({a}+{k}*Pi/2), {height(i)}}};\n" for k in range(4))
        lines = "".join(f"Line({p + k}) = {{{p + k}, {p + (k + 1) % 4}}};\n" for k in range(4))
        return points + lines + f"Curve Loop({i}) = {{{p}, {p + 1}, {p + 2}, {p + 3}}};\n"
    return section


def foil_section(chord, height, turn, thickness, blunt):
    """Two splines from the leading to the trailing edge; a blunt edge gets a line of its own."""
    def section(i):
        p, text, c, a = 100 * i, "", chord(i), turn(i)
        xs = [0, 0.0125, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1]
        half = [5 * thickness * (0.2969 * x**0.5 - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4) for x in xs]
        half = [h + x * (blunt / 2 - half[-1]) for h, x in zip(half, xs)]

        def point(number, x, y):
            x -= 0.3
            return f"Point({number}) = {{{c}*({x}*Cos({a})-({y})*Sin({a})), {c}*({x}*Sin({a})+({y})*Cos({a})), {height(i)}}};\n"
        for k, (x, y) in enumerate(zip(xs, half)):
            text += point(p + k, x, y)
            if 0 < k < 9 or (k == 9 and blunt):
                text += point(p + 20 + k, x, -y)
        end = p + 29 if blunt else p + 9
        upper = ", ".join(str(p + k) for k in range(10))
        lower = ", ".join([str(p)] + [str(p + 20 + k) for k in range(1, 9)] + [str(end)])
        text += f"Spline({p}) = {{{upper}}};\nSpline({p + 1}) = {{{lower}}};\n"
        loop = f"{p}, -{p + 1}"
        if blunt:
            text += f"Line({p + 2}) = {{{p + 9}, {end}}};\n"
            loop = f"{p}, {p + 2}, -{p + 1}"
        return text + f"Curve Loop({i}) = {{{loop}}};\n"
    return section


def helix(turns, pitch, radius, wire):
    """A round wire along a helix."""
    return f"""
n = {12 * turns};
For i In {{0:n}}
  Point(1000+i) = {{{radius}*Cos(2*Pi*i/12), {radius}*Sin(2*Pi*i/12), {pitch}*i/12}};
EndFor
BSpline(1000) = {{1000:1000+n}};
Wire(1000) = {{1000}};
Disk(1000) = {{{radius}, 0, 0, {wire}}};
Rotate {{{{1, 0, 0}}, {{{radius}, 0, 0}}, Pi/2}} {{ Surface{{1000}}; }}
Extrude {{ Surface{{1000}}; }} Using Wire {{1000}}
Delete {{ Surface{{1000}}; }}
"""


def gear(teeth, root, tip, height):
    """Teeth with straight flanks and rounded edges along z."""
    return HEAD + f"""
n = {teeth};
For i In {{0:n-1}}
  a = 2*Pi*i/n;
  p = 2*Pi/n;
  Point(4*i+1) = {{{root}*Cos(a), {root}*Sin(a), 0}};
  Point(4*i+2) = {{{tip}*Cos(a+0.2*p), {tip}*Sin(a+0.2*p), 0}};
  Point(4*i+3) = {{{tip}*Cos(a+0.35*p), {tip}*Sin(a+0.35*p), 0}};
  Point(4*i+4) = {{{root}*Cos(a+0.55*p), {root}*Sin(a+0.55*p), 0}};
EndFor
For i In {{1:4*n}}
  Line(i) = {{i, i == 4*n ? 1 : i+1}};
EndFor
Curve Loop(1) = {{1:4*n}};
Circle(9000) = {{0, 0, 0, {0.4 * root}}};
Curve Loop(2) = {{9000}};
Plane Surface(1) = {{1, 2}};
Extrude {{0, 0, {height}}} {{ Surface{{1}}; }}
"""


def holes(shape, count, hole):
    """`shape` makes Volume(1); `hole` makes one of the `count` tools from the number `i`."""
    return HEAD + f"""{shape}
For i In {{0:{count}-1}}
  {hole}
EndFor
BooleanDifference(5000) = {{ Volume{{1}}; Delete; }}{{ Volume{{100:{100 + count - 1}}}; Delete; }};
"""


FLANGE = """
Cylinder(1) = {0, 0, 0, 0, 0, 0.4, 2};
Cylinder(2) = {0, 0, 0, 0, 0, 2.5, 1};
Cylinder(3) = {0, 0, -1, 0, 0, 5, 0.85};
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
BooleanDifference(5) = { Volume{4}; Delete; }{ Volume{3}; Delete; };
"""
FIT = """
For i In {0:7}
  c = 1.5*Cos(i*Pi/4);
  s = 1.5*Sin(i*Pi/4);
  Cylinder(100+i) = {c, s, -1, 0, 0, 2, 0.2};
  Cylinder(200+i) = {c, s, -0.3, 0, 0, 1.1, %s};
  Cylinder(300+i) = {c, s, 0.4%s, 0, 0, 0.2, 0.32};
  BooleanUnion(400+i) = { Volume{200+i}; Delete; }{ Volume{300+i}; Delete; };
EndFor
BooleanDifference(6) = { Volume{5}; Delete; }{ Volume{100:107}; Delete; };
"""
BODY, FLUID = {"domain": "body"}, {"domain": "fluid"}
CAD = {
    "twisted_bar": (loft(square_section(lambda i: 1, lambda i: 0.6 * i, 0.35), 9), "brep", {}),
    "twisted_taper": (loft(square_section(lambda i: 1.1 - 0.1 * i, lambda i: 0.5 * i, 0.5), 9), "step", {}),
    "loft_blade": (loft(foil_section(lambda i: 1.2 - 0.1 * i, lambda i: 0.8 * i, lambda i: 0.15 * i, 0.12, 0.004), 6), "step", {}),
    "loft_blade_sharp": (loft(foil_section(lambda i: 1.1 - 0.1 * i, lambda i: 0.8 * i, lambda i: 0.2 * i, 0.09, 0), 5), "brep", {}),
    "spring": (HEAD + helix(5, 0.5, 1, 0.15), "brep", {}),
    "thread": (HEAD + "Cylinder(1) = {0, 0, -0.5, 0, 0, 3.5, 1};\n" + helix(6, 0.4, 1, 0.12) +
               "w() = Volume{:};\nw() -= {1};\nBooleanDifference(900) = { Volume{1}; Delete; }{ Volume{w()}; Delete; };\n", "brep", {}),
    "gear": (gear(26, 1.0, 1.2, 0.3), "step", {}),
    "gear_fine": (gear(60, 1.0, 1.08, 0.2), "brep", {}),
    "fins": (HEAD + """Box(1) = {0, 0, -0.3, 4, 3, 0.3};
For i In {0:15}
  Box(10+i) = {0.1+0.25*i, 0, 0, 0.05, 3, 1.2};
EndFor
BooleanUnion(100) = { Volume{1}; Delete; }{ Volume{10:25}; Delete; };
""", "step", {}),
    "flange_bolts_tight": (HEAD + FLANGE + FIT % ("0.195", "05"), "step", {}),
    "flange_bolts_loose": (HEAD + FLANGE + FIT % ("0.15", "2"), "brep", {}),
    "plate_holes": (holes("Box(1) = {0, 0, 0, 10, 10, 0.5};", 100,
                          "Cylinder(100+i) = {0.5+(i%10), 0.5+Floor(i/10), -1, 0, 0, 3, 0.3+0.0017*i};"), "step", {}),
    "honeycomb": (HEAD + """Box(1) = {-1.2, -1.2, 0, 12, 9, 1};
For j In {0:4}
  For i In {0:4}
    k = 100*(5*j+i);
    x = 1.9*(i+0.5*(j%2));
    y = 1.9*0.8660254*j;
    For c In {0:5}
      Point(1000+k+c) = {x+1.03*Sin(c*Pi/3), y+1.03*Cos(c*Pi/3), -1};
    EndFor
    For c In {0:5}
      Line(1000+k+c) = {1000+k+c, 1000+k+(c+1)%6};
    EndFor
    Curve Loop(1000+k) = {1000+k:1000+k+5};
    Plane Surface(1000+k) = {1000+k};
    v() = Extrude {0, 0, 3} { Surface{1000+k}; };
    t() += {v(1)};
    Delete { Surface{1000+k}; }
  EndFor
EndFor
BooleanDifference(900) = { Volume{1}; Delete; }{ Volume{t()}; Delete; };
""", "step", {}),
    "rounded_box": (HEAD + "Box(1) = {0, 0, 0, 3, 2, 1};\nFillet{1}{1:12}{0.04}\n", "step", {}),
    "rounded_cross": (HEAD + """Cylinder(1) = {0, 0, -2, 0, 0, 4, 0.8};
Cylinder(2) = {-2, 0, 0.1, 4, 0, 0, 0.6};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Fillet{3}{1:2}{0.05}
""", "brep", {}),
    "equal_pipes": (HEAD + """Cylinder(1) = {0, 0, -2, 0, 0, 4, 1};
Cylinder(2) = {-2, 0, 0, 4, 0, 0, 1};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""", "step", {}),
    "shell_eccentric": (HEAD + """Sphere(1) = {0, 0, 0, 10};
Sphere(2) = {0.12, 0, 0, 9.8};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""", "brep", FLUID),
    "annulus_eccentric": (HEAD + """Cylinder(1) = {0, 0, 0, 0, 0, 8, 5};
Cylinder(2) = {0.35, 0, 0, 0, 0, 8, 4.5};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""", "step", FLUID),
    "film_between": (HEAD + """Box(1) = {0, 0, 0, 50, 50, 2};
Box(2) = {10, 10, 2.2, 30, 30, 2};
""", "step", {}),
    "balls_near": (HEAD + "Sphere(1) = {0, 0, 0, 1};\nSphere(2) = {2.003, 0, 0, 1};\n", "step", {}),
    "chain": (HEAD + """Torus(1) = {0, 0, 0, 1, 0.3};
Torus(2) = {1.395, 0, 0, 1, 0.3};
Rotate {{1, 0, 0}, {1.395, 0, 0}, Pi/2} { Volume{2}; }
""", "brep", {}),
    "drilled_near_wall": (HEAD + """Cylinder(1) = {0, 0, 0, 0, 0, 4, 1};
Cylinder(2) = {0.19, 0, -1, 0, 0, 6, 0.8};
Cylinder(3) = {-0.9, -2, 2, 0, 4, 0, 0.07};
BooleanDifference(4) = { Volume{1}; Delete; }{ Volume{2:3}; Delete; };
""", "step", {}),
    "impeller": (HEAD + """Cylinder(1) = {0, 0, 0, 0, 0, 0.2, 2};
Cylinder(2) = {0, 0, 0, 0, 0, 1, 0.5};
For i In {0:8}
  Box(10+i) = {0.4, -0.02, 0.1, 1.5, 0.04, 0.6};
  Rotate {{0, 0, 1}, {1.9, 0, 0}, 0.5} { Volume{10+i}; }
  Rotate {{0, 0, 1}, {0, 0, 0}, 2*Pi*i/9} { Volume{10+i}; }
EndFor
BooleanUnion(100) = { Volume{1}; Delete; }{ Volume{2}; Volume{10:18}; Delete; };
""", "step", {}),
    "cone_and_needle": (HEAD + """Cone(1) = {0, 0, 0, 4, 0, 0, 1, 0.02};
Cylinder(2) = {-2, 0, 0, 2, 0, 0, 1};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""", "step", {}),
    "stepped_shaft": (HEAD + """Cylinder(1) = {0, 0, 0, 3, 0, 0, 1};
Cylinder(2) = {3, 0, 0, 2, 0, 0, 0.97};
Cylinder(3) = {5, 0, 0, 2, 0, 0, 0.5};
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2:3}; Delete; };
Torus(5) = {6, 0, 0, 0.5, 0.05};
Rotate {{0, 1, 0}, {6, 0, 0}, Pi/2} { Volume{5}; }
BooleanDifference(6) = { Volume{4}; Delete; }{ Volume{5}; Delete; };
""", "brep", {}),
    "pipe_bend": (HEAD + """Torus(1) = {0, 0, 0, 2, 0.5, Pi/2};
Torus(2) = {0, 0, 0, 2, 0.48, Pi/2};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
""", "step", {}),
}


def make_cad(name, path, gmsh="gmsh"):
    """Writes the model to `path`, by gmsh; what gmsh says where it fails is the error."""
    text, _, _ = CAD[name]
    source = path.with_suffix(".geo")
    source.write_text(text + f'Save "{path}";\n')
    done = subprocess.run([gmsh, "-parse_and_exit", "-v", "3", str(source)], capture_output=True, text=True, check=False)
    errors = [line for line in (done.stdout + done.stderr).splitlines() if line.startswith("Error")]
    if errors or not path.exists():
        raise RuntimeError(f"gmsh cannot make {name}: {'; '.join(errors)}")
