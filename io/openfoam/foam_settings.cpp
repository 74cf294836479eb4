#include "io/openfoam/foam_settings.hpp"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

std::string with_header(std::string_view kind, std::string_view folder, std::string_view name,
                        std::string_view content) {
  return fmt::format(
      "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n"
      "    location    \"{}\";\n    object      {};\n}}\n\n{}",
      kind, folder, name, content);
}

/// `{}`: functions of meshes with fans.
constexpr std::string_view control = R"foam(application     simpleFoam;
startFrom       latestTime;
startTime       0;
stopAt          endTime;
endTime         1000;
deltaT          1;
writeControl    timeStep;
writeInterval   100;
purgeWrite      2;
writeFormat     binary;
writePrecision  12;
timeFormat      general;
runTimeModifiable true;
OptimisationSwitches {{ fileModificationSkew 0; }}    // new schemes are read at once

#include "../0.orig/conditions"
functions
{{
{}    // The first iterations are of first order, those that follow of second.
    order
    {{
        type            timeActivatedFileUpdate;
        libs            ("libutilityFunctionObjects.so");
        fileToUpdate    "$FOAM_CASE/system/fvSchemes";
        timeVsFile
        (
            (0 "$FOAM_CASE/system/fvSchemes.first")
            (50 "$FOAM_CASE/system/fvSchemes.second")
        );
    }}
    relaxation
    {{
        type            timeActivatedFileUpdate;
        libs            ("libutilityFunctionObjects.so");
        fileToUpdate    "$FOAM_CASE/system/fvSolution";
        timeVsFile
        (
            (0 "$FOAM_CASE/system/fvSolution.first")
            (50 "$FOAM_CASE/system/fvSolution.second")
        );
    }}
    // Of all walls; postProcessing/forces has the table.
    forces
    {{
        type            forceCoeffs;
        libs            ("libforces.so");
        writeControl    timeStep;
        writeInterval   1;
        log             no;
        patches         (wall);
        rho             rhoInf;
        rhoInf          1;
        magUInf         $speed;
        lRef            $reference_length;
        Aref            $reference_area;
        CofR            $moment_center;
        dragDir         $drag_direction;
        liftDir         $lift_direction;
        pitchAxis       $pitch_axis;
    }}
    extremes
    {{
        type            fieldMinMax;
        libs            ("libfieldFunctionObjects.so");
        fields          (U p k omega);
        writeControl    timeStep;
        writeInterval   10;
        log             no;
    }}
    wall_distance
    {{
        type            yPlus;
        libs            ("libfieldFunctionObjects.so");
        writeControl    writeTime;
        log             no;
    }}
}}
)foam";

/// `{0}`: a field. Of constant/sharpEdges, which is 0 in cells at sharp edges, it makes how much of its first
/// scheme a `localBlended` one takes at each face.
constexpr std::string_view blending =
    R"foam(    // Which scheme {0} has at sharp edges of layers with fans: constant/sharpEdges.
    {0}_at_sharp_edges
    {{
        type            stabilityBlendingFactor;
        libs            ("libfieldFunctionObjects.so");
        field           {0};
        result          {0}BlendingFactor;
        faceWeight      sharpEdges;
        switchFaceWeight yes;
        minFaceWeight   1;
        maxFaceWeight   0;
        switchNonOrtho  no;
        switchGradCc    no;
        switchSkewness  no;
        switchResiduals no;
        switchCo        no;
        writeToFile     no;
        log             no;
        executeControl  none;
        writeControl    none;
    }}
)foam";

/// `{}`: gradients and convection of the velocity.
constexpr std::string_view schemes =
    R"foam(// system/controlDict copies fvSchemes.first over fvSchemes at the start, and
// fvSchemes.second after the first iterations: edit those two.
ddtSchemes      {{ default steadyState; }}
gradSchemes     {{ {} }}
divSchemes
{{
    default         none;
    div(phi,U)      bounded Gauss {};
    div(phi,k)      bounded Gauss upwind;
    div(phi,omega)  bounded Gauss upwind;
    div(phi,epsilon) bounded Gauss upwind;
    div(phi,nuTilda) bounded Gauss upwind;
    div((nuEff*dev2(T(grad(U))))) Gauss linear;
    div(div(phi,U)) Gauss linear;
}}
laplacianSchemes {{ default Gauss linear limited 0.5; }}
interpolationSchemes {{ default linear; }}
snGradSchemes   {{ default limited 0.5; }}
wallDist        {{ method meshWave; }}
)foam";

// Why each of these is as it is: docs/formats/openfoam.md.
constexpr std::string_view solution =
    R"foam(// system/controlDict copies fvSolution.first over fvSolution at the start, and
// fvSolution.second after the first iterations: edit those two.

// Residuals are relative to sums over all cells, and those of a far field
// are huge: what is left of them says little about the body, so pressure is
// solved well in each step.
solvers
{{
    "(p|Phi)"
    {{
        solver          GAMG;
        smoother        DICGaussSeidel;
        tolerance       1e-14;
        relTol          0.005;
        minIter         2;
        maxIter         50;
    }}
    "(U|k|omega|epsilon|nuTilda)"
    {{
        solver          PBiCGStab;
        preconditioner  DILU;
        tolerance       1e-9;
        relTol          0.1;
    }}
}}
potentialFlow   {{ nNonOrthogonalCorrectors 5; PhiRefCell 0; PhiRefValue 0; pRefCell 0; pRefValue 0; }}
SIMPLE          {{ nNonOrthogonalCorrectors 0; consistent yes; pRefCell 0; pRefValue 0; }}
relaxationFactors
{{
    fields          {{ p {}; }}
    equations       {{ U {}; "(k|omega|epsilon|nuTilda)" {}; }}
}}
)foam";

constexpr std::string_view transport = R"foam(#include "../0.orig/conditions"
transportModel  Newtonian;
nu              $viscosity;
)foam";

constexpr std::string_view turbulence = R"foam(simulationType  RAS;
RAS
{
    RASModel        kOmegaSST;
    turbulence      on;
    printCoeffs     on;
}
)foam";

/// Of the free stream. The speed is in metres per second: time has the unit that goes with that.
constexpr double speed = 50, intensity = 0.001;

/// Kinematic viscosity in metres per second times the unit of length, and why.
struct Viscosity {
  double value;
  std::string why;
};

Viscosity viscosity_of(const FlowReference& flow) {
  if (flow.reynolds > 0)
    return {speed * flow.length / flow.reynolds,
            fmt::format("a Reynolds number of {:.6g} over a length of {:.6g}", flow.reynolds, flow.length)};
  constexpr double of_air = 1.5e-5;
  return {of_air / flow.unit_in_metres, "air: the case has no Reynolds number (layers.reynolds and length)"};
}

/// The numbers of the fields, which the time folders 0 refer to, and of the forces.
std::string conditions_of(const FlowReference& flow, bool is_external) {
  const Viscosity viscosity = viscosity_of(flow);
  const double k = 1.5 * std::pow(intensity * speed, 2);
  return fmt::format(
      "// The numbers of the fields in this folder, which the time folders 0 refer to.\n"
      "// {}\n"
      "speed           {};\n"
      "velocity        ({} 0 0);   // of the free stream, m/s\n"
      "inflow          -{};        // at inlets along the normal, which points out of what flows\n"
      "pressure        0;          // over density\n"
      "viscosity       {:.9g};     // kinematic: {}\n"
      "k               {:.9g};     // a turbulence of {:.2g} %\n"
      "omega           {:.9g};     // as much eddy viscosity as viscosity\n"
      "nut             {:.9g};     // eddy viscosity: k over omega\n"
      "start           {};  // what the solver starts from\n"
      "// For coefficients of forces; lift is along z.\n"
      "reference_length {:.9g};\n"
      "reference_area  1;\n"
      "moment_center   (0 0 0);\n"
      "drag_direction  (1 0 0);\n"
      "lift_direction  (0 0 1);\n"
      "pitch_axis      (0 1 0);\n",
      flow.unit.empty() ? "Lengths are in the unit of the mesh, which is not known: metres are assumed."
                        : fmt::format("Lengths are in {}; viscosity in m/s times that.", flow.unit),
      speed, speed, speed, viscosity.value, viscosity.why, k, 100 * intensity, k / viscosity.value,
      viscosity.value, is_external ? "$velocity" : "(0 0 0)", flow.length > 0 ? flow.length : 1);
}

/// A field with its conditions at patches of each type; the name of a type is that of a group of patches.
struct Field {
  std::string_view name, kind, dimensions, start, wall, slip, farfield, inlet, outlet;
};
constexpr std::array<Field, 6> fields = {
    {{"U", "volVectorField", "[0 1 -1 0 0 0 0]", "$start", "type noSlip;", "type slip;",
      "type freestreamVelocity; freestreamValue uniform $velocity;",
      "type surfaceNormalFixedValue; refValue uniform $inflow;",
      "type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0);"},
     {"p", "volScalarField", "[0 2 -2 0 0 0 0]", "$pressure", "type zeroGradient;", "type zeroGradient;",
      "type freestreamPressure; freestreamValue uniform $pressure;", "type zeroGradient;",
      "type fixedValue; value uniform $pressure;"},
     // As much flows through the far field as the free stream brings.
     {"Phi", "volScalarField", "[0 2 -1 0 0 0 0]", "0", "type zeroGradient;", "type zeroGradient;",
      "type zeroGradient;", "type zeroGradient;", "type fixedValue; value uniform 0;"},
     {"k", "volScalarField", "[0 2 -2 0 0 0 0]", "$k", "type kqRWallFunction; value uniform $k;",
      "type zeroGradient;", "type inletOutlet; inletValue uniform $k; value uniform $k;",
      "type fixedValue; value uniform $k;", "type inletOutlet; inletValue uniform $k; value uniform $k;"},
     {"omega", "volScalarField", "[0 0 -1 0 0 0 0]", "$omega",
      "type omegaWallFunction; value uniform $omega;", "type zeroGradient;",
      "type inletOutlet; inletValue uniform $omega; value uniform $omega;",
      "type fixedValue; value uniform $omega;",
      "type inletOutlet; inletValue uniform $omega; value uniform $omega;"},
     {"nut", "volScalarField", "[0 2 -1 0 0 0 0]", "$nut", "type nutUSpaldingWallFunction; value uniform 0;",
      "type calculated; value uniform $nut;", "type calculated; value uniform $nut;",
      "type calculated; value uniform $nut;", "type calculated; value uniform $nut;"}}};

}  // namespace

std::vector<FoamSetting> foam_dictionaries(bool has_fans) {
  std::vector<FoamSetting> all;
  const auto add = [&all](const char* folder, const char* name, std::string_view content) {
    all.push_back({std::filesystem::path(folder) / name, with_header("dictionary", folder, name, content)});
  };
  add("system", "controlDict",
      fmt::format(control, has_fans ? fmt::format(blending, "U") + fmt::format(blending, "p") : ""));
  const std::string first = fmt::format(schemes, "default cellLimited Gauss linear 1;", "upwind"),
                    gradients = fmt::format(
                        "default cellLimited Gauss linear 1;\n"
                        "                  grad(p) cellLimited Gauss {0} 0.5;\n"
                        "                  convected cellLimited Gauss {0} 0.5;",
                        has_fans ? "localBlended linear pointLinear" : "pointLinear"),
                    second = fmt::format(
                        schemes, gradients,
                        has_fans ? "localBlended upwind linearUpwind convected" : "linearUpwind convected");
  add("system", "fvSchemes", first);
  add("system", "fvSchemes.first", first);
  add("system", "fvSchemes.second", second);
  const std::string slow = fmt::format(solution, 0.9, 0.7, 0.6), fast = fmt::format(solution, 0.5, 0.9, 0.7);
  add("system", "fvSolution", slow);
  add("system", "fvSolution.first", slow);
  add("system", "fvSolution.second", fast);
  add("constant", "transportProperties", transport);
  add("constant", "turbulenceProperties", turbulence);
  return all;
}

FoamSetting foam_conditions(const FlowReference& flow, bool is_external) {
  return {"0.orig/conditions",
          with_header("dictionary", "0.orig", "conditions", conditions_of(flow, is_external))};
}

FoamSetting foam_script(std::int64_t parts) {
  return {"run.sh",
          fmt::format(R"sh(#!/bin/sh
# Checks the mesh, then runs simpleFoam from where it is to endTime of system/controlDict, on as many ranks as
# the mesh has parts ({0}). Logs: log.checkMesh, log.simpleFoam; forces: postProcessing/forces.
set -eu
cd "$(dirname "$0")"
# Where OpenFOAM's own settings are; other installations set it themselves.
export WM_PROJECT_DIR="${{WM_PROJECT_DIR:-/usr/share/openfoam}}"
launch() {{
  {1}
}}
launch checkMesh{2} > log.checkMesh 2>&1 || {{ tail -n 5 log.checkMesh; exit 1; }}
grep -E "Mesh OK|Failed .* mesh checks" log.checkMesh || true
status=0
launch simpleFoam{2} > log.simpleFoam 2>&1 || status=$?
grep "^Time = " log.simpleFoam | tail -n 1
forces=$(find postProcessing/forces -name "*.dat" 2> /dev/null | sort | tail -n 1)
if [ -n "$forces" ]; then grep "^# Time" "$forces"; tail -n 1 "$forces"; fi
exit "$status"
)sh",
                      parts, parts == 1 ? "\"$@\"" : fmt::format("${{MPIRUN:-mpirun}} -n {} \"$@\"", parts),
                      parts == 1 ? "" : " -parallel")};
}

std::vector<FoamField> foam_fields(std::string_view up) {
  std::vector<FoamField> all;
  for (const Field& field : fields) {
    const std::string content = fmt::format(
        "#include \"conditions\"\n\ndimensions      {};\ninternalField   uniform {};\nboundaryField\n{{\n"
        "    wall        {{ {} }}\n    slip        {{ {} }}\n    farfield    {{ {} }}\n"
        "    inlet       {{ {} }}\n    outlet      {{ {} }}\n    symmetry    {{ type symmetry; }}\n"
        "    \"procBoundary.*\" {{ type processor; }}\n}}\n",
        field.dimensions, field.start, field.wall, field.slip, field.farfield, field.inlet, field.outlet);
    all.push_back({std::string(field.name), with_header(field.kind, "0.orig", field.name, content),
                   with_header(field.kind, "0", field.name,
                               fmt::format("#include \"{}0.orig/{}\"\n", up, field.name))});
  }
  return all;
}

std::string foam_decomposition(std::int64_t parts) {
  return with_header("dictionary", "system", "decomposeParDict",
                     fmt::format("numberOfSubdomains {};\nmethod          scotch;\n", parts));
}

}  // namespace aeroloom::io
