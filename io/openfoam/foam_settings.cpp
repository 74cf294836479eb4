#include "io/openfoam/foam_settings.hpp"

#include <array>

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

constexpr std::string_view control = R"foam(application     simpleFoam;
startFrom       latestTime;
startTime       0;
stopAt          endTime;
endTime         1000;
deltaT          1;
writeControl    timeStep;
writeInterval   50;
writeFormat     binary;
writePrecision  12;
timeFormat      general;
runTimeModifiable true;
)foam";

constexpr std::string_view schemes =
    R"foam(// To start with: convection of first order, gradients and corrections
// limited. Once it converges, div(phi,U) may be
//     bounded Gauss linearUpwind grad(U);
ddtSchemes      { default steadyState; }
gradSchemes     { default cellLimited Gauss linear 1; }
divSchemes
{
    default         none;
    div(phi,U)      bounded Gauss upwind;
    div(phi,k)      bounded Gauss upwind;
    div(phi,omega)  bounded Gauss upwind;
    div(phi,epsilon) bounded Gauss upwind;
    div(phi,nuTilda) bounded Gauss upwind;
    div((nuEff*dev2(T(grad(U))))) Gauss linear;
    div(div(phi,U)) Gauss linear;
}
laplacianSchemes { default Gauss linear limited 0.5; }
interpolationSchemes { default linear; }
snGradSchemes   { default limited 0.5; }
wallDist        { method meshWave; }
)foam";

constexpr std::string_view solution =
    R"foam(// Residuals are relative to sums over all cells, and those of a far field
// are huge: what is left of them says little about the body, so pressure is
// solved well in each step.
solvers
{
    "(p|Phi)"
    {
        solver          GAMG;
        smoother        DICGaussSeidel;
        tolerance       1e-14;
        relTol          0.005;
        minIter         2;
        maxIter         50;
    }
    "(U|k|omega|epsilon|nuTilda)"
    {
        solver          PBiCGStab;
        preconditioner  DILU;
        tolerance       1e-9;
        relTol          0.1;
    }
}
potentialFlow   { nNonOrthogonalCorrectors 5; PhiRefCell 0; PhiRefValue 0; pRefCell 0; pRefValue 0; }
SIMPLE          { nNonOrthogonalCorrectors 1; pRefCell 0; pRefValue 0; }
relaxationFactors
{
    fields          { p 0.3; }
    equations       { U 0.6; "(k|omega|epsilon|nuTilda)" 0.5; }
}
)foam";

constexpr std::string_view transport = R"foam(transportModel  Newtonian;
nu              1.5e-05;    // m2/s: air
)foam";

constexpr std::string_view turbulence = R"foam(simulationType  RAS;
RAS
{
    RASModel        kOmegaSST;
    turbulence      on;
    printCoeffs     on;
}
)foam";

constexpr std::string_view conditions =
    R"foam(// The numbers of the fields in this folder, which the time folders 0 refer to.
velocity        (50 0 0);   // of the free stream, m/s
inflow          -50;        // at inlets along the normal, which points out of what flows
pressure        0;          // over density, m2/s2
k               0.00375;    // m2/s2: a turbulence of 0.1 % at 50 m/s
omega           250;        // 1/s: as much eddy viscosity as viscosity
nut             1.5e-05;    // eddy viscosity, m2/s: k over omega
)foam";

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

std::vector<FoamSetting> foam_dictionaries() {
  std::vector<FoamSetting> all;
  const auto add = [&all](const char* folder, const char* name, std::string_view content) {
    all.push_back({std::filesystem::path(folder) / name, with_header("dictionary", folder, name, content)});
  };
  add("system", "controlDict", control);
  add("system", "fvSchemes", schemes);
  add("system", "fvSolution", solution);
  add("constant", "transportProperties", transport);
  add("constant", "turbulenceProperties", turbulence);
  return all;
}

FoamSetting foam_conditions(bool is_external) {
  const std::string content =
      fmt::format("{}{}", conditions,
                  is_external ? "start           $velocity;  // what the solver starts from\n"
                              : "start           (0 0 0);    // what the solver starts from\n");
  return {"0.orig/conditions", with_header("dictionary", "0.orig", "conditions", content)};
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
