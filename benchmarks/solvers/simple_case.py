"""A case of OpenFOAM's `simpleFoam` with k-omega SST and wall functions about a section of chord 1 at speed 1."""
import math

HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"

CONTROL = """application simpleFoam;
startFrom latestTime;
startTime 0;
stopAt endTime;
endTime {steps};
deltaT 1;
writeControl timeStep;
writeInterval 100;
purgeWrite 2;
writeFormat binary;
writePrecision 12;
timeFormat general;
runTimeModifiable true;
functions
{{
    forces
    {{
        type forceCoeffs;
        libs ("libforces.so");
        writeControl timeStep;
        writeInterval 1;
        log no;
        patches (foil);
        rho rhoInf;
        rhoInf 1;
        magUInf 1;
        lRef 1;
        Aref {area};
        CofR (0.25 0 0);
        pitchAxis (0 1 0);
        liftDir ({lift});
        dragDir ({drag});
    }}
    wall_distance
    {{
        type yPlus;
        libs ("libfieldFunctionObjects.so");
        writeControl writeTime;
        log no;
    }}
}}
"""

# Convection of second order for the velocity; limits of gradients bite beyond twice the neighbours' range alone. Gradients take a face's
# value from its corners: the mean of two cells is that of another point where their centres' line misses the face's centre, and on
# tetrahedra it does.
SCHEMES = """ddtSchemes { default steadyState; }
gradSchemes { default Gauss linear; grad(p) Gauss pointLinear; grad(U) cellLimited Gauss pointLinear 0.5;
    grad(k) cellLimited Gauss linear 1; grad(omega) cellLimited Gauss linear 1; }
divSchemes
{
    default none;
    div(phi,U) bounded Gauss linearUpwind grad(U);
    div(phi,k) bounded Gauss limitedLinear 1;
    div(phi,omega) bounded Gauss limitedLinear 1;
    div((nuEff*dev2(T(grad(U))))) Gauss linear;
    div(div(phi,U)) Gauss linear;
}
laplacianSchemes { default Gauss linear limited 0.5; }
interpolationSchemes { default linear; }
snGradSchemes { default limited 0.5; }
wallDist { method meshWave; }
"""

SOLUTION = """solvers
{
    "(p|Phi)" { solver GAMG; smoother GaussSeidel; tolerance 1e-10; relTol 0.05; }
    "(U|k|omega)" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-12; relTol 0.1; }
}
potentialFlow { nNonOrthogonalCorrectors 5; }
SIMPLE { nNonOrthogonalCorrectors 0; consistent yes; }
relaxationFactors { fields { p RELAX_P; } equations { U RELAX_U; "(k|omega)" RELAX_T; } }
"""

# SIMPLEC without relaxation of the pressure diverges from the start on. Steps are written by the hundred.
CAREFUL_STEPS = 100
CAREFUL, QUICK = (0.5, 0.7, 0.5), (0.8, 0.9, 0.7)

FIELDS = {
    "U": ("volVectorField", "[0 1 -1 0 0 0 0]", "({flow})", "freestreamVelocity; freestreamValue uniform ({flow})", "noSlip"),
    "p": ("volScalarField", "[0 2 -2 0 0 0 0]", "0", "freestreamPressure; freestreamValue uniform 0", "zeroGradient"),
    "k": ("volScalarField", "[0 2 -2 0 0 0 0]", "{k}", "inletOutlet; inletValue uniform {k}; value uniform {k}",
          "kqRWallFunction; value uniform {k}"),
    "omega": ("volScalarField", "[0 0 -1 0 0 0 0]", "{omega}",
              "inletOutlet; inletValue uniform {omega}; value uniform {omega}",
              "omegaWallFunction; blended true; value uniform {omega}"),
    "nut": ("volScalarField", "[0 2 -1 0 0 0 0]", "{nut}", "calculated; value uniform {nut}",
            "nutUSpaldingWallFunction; value uniform 0")}


CONDITIONS = """dimensions {dimensions};
internalField uniform {inside};
boundaryField
{{
    wall {{ type {wall}; }}
    farfield {{ type {outer}; }}
    symmetry {{ type symmetry; }}
    planes {{ type empty; }}
}}
"""


def write_file(path, kind, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(kind=kind, name=path.name) + text)


def write_control(folder, angle, steps, span):
    """How far to go, and with which relaxation: call `simpleFoam` once with at most CAREFUL_STEPS, then with more."""
    turn = math.radians(angle)
    along = f"{math.cos(turn):.12g} 0 {math.sin(turn):.12g}"
    across = f"{-math.sin(turn):.12g} 0 {math.cos(turn):.12g}"
    write_file(folder / "system/controlDict", "dictionary", CONTROL.format(steps=steps, area=span, drag=along, lift=across))
    solution = SOLUTION
    for word, value in zip(("RELAX_P", "RELAX_U", "RELAX_T"), CAREFUL if steps <= CAREFUL_STEPS else QUICK):
        solution = solution.replace(word, str(value))
    write_file(folder / "system/fvSolution", "dictionary", solution)


def write_case(folder, angle, reynolds):
    """All but the mesh and the control. The turbulence of the free stream is that of cases as the program writes them: 0.1 %, and as much
    eddy viscosity as viscosity."""
    k = 1.5 * 0.001**2
    nut = 1 / reynolds
    turn = math.radians(angle)
    values = {"flow": f"{math.cos(turn):.12g} 0 {math.sin(turn):.12g}", "k": f"{k:g}", "nut": f"{nut:g}",
              "omega": f"{k / nut:g}"}
    for name, (kind, dimensions, inside, outer, wall) in FIELDS.items():
        inside, outer, wall = (text.format(**values) for text in (inside, outer, wall))
        write_file(folder / "0" / name, kind, CONDITIONS.format(
            dimensions=dimensions, inside=inside, outer=outer, wall=wall))
    write_file(folder / "system/fvSchemes", "dictionary", SCHEMES)
    write_file(folder / "constant/transportProperties", "dictionary",
               f"transportModel Newtonian;\nnu [0 2 -1 0 0 0 0] {1 / reynolds:.12g};\n")
    write_file(folder / "constant/turbulenceProperties", "dictionary",
               "simulationType RAS;\nRAS { RASModel kOmegaSST; turbulence on; printCoeffs off; }\n")
