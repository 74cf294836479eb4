#include "pipeline/case/other_meshers.hpp"

#include "pipeline/case/case_error.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

constexpr std::array words_beyond{
    OtherWords{
        "Hexahedra",
        "hexahedra and quadrilaterals on the surface are not made; the volume is tetrahedra, with prisms "
        "on walls ('layers')",
        "hexahedra hexahedral hexahedron hexahedrons hex hexa hexes hexmesh hexcore hexdominant "
        "hexdominated cartesian cartesianmesh castellatedmesh cutcell trimmed trimmer voxel octreemesh "
        "quad quads quadrilateral quadrilaterals quaddominant quaddominated quaddom recombine recombineall "
        "recombination recombinationalgorithm blockmesh blocks transfinite transfinitecurve "
        "transfinitesurface transfinitevolume structured subdivisionalgorithm mosaic"},
    OtherWords{
        "Polyhedra",
        "polyhedra are not made; a solver's tools can take the dual of the tetrahedra, such as "
        "polyDualMesh of OpenFOAM",
        "polyhedra polyhedral polyhedron polyhedrons poly polys polymesh polydualmesh dualmesh polyhexcore "
        "convertpolyhedra"},
    OtherWords{"Two dimensions",
               "meshes are of three dimensions: no plane, axisymmetric or extruded ones are made",
               "2d twod twodimensional 2dmesh dim dimension planar axisymmetric axisymmetry wedge empty "
               "frontandback extrude extruded extrudemesh extrusion sweepmesh revolve cartesian2dmesh in2d"},
    OtherWords{"Periodic pairs",
               "periodic pairs of faces are not made: the triangles of two faces do not match",
               "periodic periodicity cyclic cyclicami cyclicslip translational rotational rotationalperiodic "
               "translationalperiodic setperiodic mastersurface matchingfaces nonconformal"},
    OtherWords{
        "Moving meshes",
        "meshes do not move: there are no sliding interfaces, and no motion or morphing of a mesh",
        "moving motion dynamicmesh dynamicmeshdict dynamicfvmesh morph morphing deformation deform sliding "
        "slidinginterface slidingmesh rotating rotatingmesh mrf movingreferenceframe ami "
        "arbitrarymeshinterface"},
    OtherWords{
        "Porous zones",
        "zones have no properties: a solid of its own inside of a fluid becomes a region, with a name in "
        "the files, which the solver makes porous, rotating or a source",
        "porous porousmedia porouszone porouszones porosity cellzone cellzones cellzoneinside facezone "
        "fluidzone solidzone heatsource actuator actuatordisk fan"},
    OtherWords{"Overset grids",
               "overset and overlapping grids are not made; bodies that overlap are united in one mesh",
               "overset chimera oversetgrid oversetmesh overlapping composite holecutting"},
    OtherWords{
        "Adaptation to a solution",
        "meshes do not follow a solution or a metric; 'sizing.sources', 'sizing.expression' and "
        "'sizing.walls' say where elements are small",
        "adaptive adaptation adapt adaptmesh adaptivemesh metric metricfield metricfile solutionadaptive amr "
        "dynamicrefinefvmesh backgroundmesh postview errorestimator"},
    OtherWords{
        "Stretched elements",
        "elements outside of boundary layers have edges of one length in all directions, but for rows along "
        "CAD edges ('sizing.edges.NAME.height')",
        "anisotropic anisotropy anisotropicsources stretching anisotropicsurface maxaspectratio "
        "surfaceaspectratio"},
    OtherWords{"Curved elements", "elements are straight: those of higher order are not made",
               "elementorder secondorder secondorderlinear secondorderincomplete highorder highorderoptimize "
               "quadratic curved curvedelements meshorder"},
    OtherWords{
        "Wrapping",
        "surfaces are not wrapped: wide holes that are not planar and leaks have to be closed in the CAD",
        "wrap wrapper shrinkwrap wrapping surfacewrap leakdetection leak capholes patchholes holepatching"},
    OtherWords{"Surfaces alone",
               "a run always fills the volume; the surface comes with it, in 'surface.pvtp'",
               "surfaceonly surfacemesh surfacemeshonly shell shellmesh membrane midsurface onlysurface"},
};

constexpr std::array words_of_keys{
    OtherWords{"settings of the mesh", "the keys are below 'sizing', 'surface' and 'volume'",
               "mesh meshing meshsettings meshcontrols meshcontrol meshparameters meshdict refinement"},
    OtherWords{
        "number of elements", "the key is 'sizing.target_tetrahedra'",
        "maxglobalcells maxlocalcells maxcells numberofcells numcells targetcells cellcount targetcount "
        "elementcount numberofelements maxelements"},
    OtherWords{
        "factor on all sizes", "the key is 'sizing.scale'",
        "meshsizefactor characteristiclengthfactor sizefactor scalefactor globalscale refinementfactor "
        "fineness meshfineness coarsening"},
    OtherWords{
        "largest size", "the key is 'sizing.maximum'",
        "maxcellsize maxcelllength maxh hmax meshsizemax characteristiclengthmax maxsize maximumsize "
        "maxelementsize "
        "maximumelementsize maximumedgelength maxedgelength globalmax basesize cellsize meshsize elementsize "
        "backgroundcellsize defaultsize"},
    OtherWords{"smallest size", "the key is 'sizing.minimum'",
               "mincellsize minh hmin meshsizemin characteristiclengthmin minsize minimumsize minelementsize "
               "minimumelementsize minimumedgelength minedgelength globalmin"},
    OtherWords{"largest size on the surface", "the key is 'sizing.surface_maximum'",
               "boundarycellsize surfacesize maxsurfacesize surfacemaxsize facemaxsize surfacecellsize"},
    OtherWords{"growth of sizes", "the key is 'sizing.growth'",
               "grading growthrate growthfactor ncellsbetweenlevels meshsizeextendfromboundary "
               "characteristiclengthextendfromboundary boundarydecay decay gradation hgrad sizegradation "
               "maxgrowthrate "
               "cellgrowthrate volumegrowthrate surfacegrowthrate"},
    OtherWords{
        "turn of an element on a curve", "the key is 'sizing.curvature_angle'",
        "curvaturenormalangle normalangle curvatureangle meshsizefromcurvature "
        "characteristiclengthfromcurvature "
        "curvaturesafety segmentsperedge segmentsperradius elementspercurvature resolvefeatureangle maxangle "
        "curvature angularresolution"},
    OtherWords{
        "distance from a curved face", "the key is 'sizing.chordal_deviation'",
        "maxdeviation chordaldeviation sagitta sag chordheight surfacedeviation deflection lineardeflection"},
    OtherWords{"elements across gaps", "the keys are 'sizing.proximity' and 'sizing.gap_proximity'",
               "cellspergap elementspergap gaplevel gapmode closeedgefac scopeproximity cellsacrossgap "
               "elementsacrossgap gaprefinement proximitymin elementsinthinsection"},
    OtherWords{"sizes of faces", "the keys are 'patches.NAME.size' and 'groups.NAME.size'",
               "refinementsurfaces localrefinement facesize facesizing localsizing surfacemeshrefinement "
               "patchsize boundarysize surfaceregion partsize"},
    OtherWords{"sizes in regions", "the keys are below 'sizing.sources'",
               "refinementregions refinementregion objectrefinements objectrefinement bodyofinfluence boi "
               "volumesizing "
               "refinementbox refinementboxes refinementzone volumerefinement refinementvolume controlvolume "
               "fieldbox "
               "ball refinementregionsdict"},
    OtherWords{
        "sizes off walls", "the keys are below 'sizing.walls'",
        "boundarycellsizerefinementthickness threshold distance distancefield walldistance sizefromwall "
        "inflationofsize refinementthickness"},
    OtherWords{"sizes along edges", "the keys are below 'sizing.edges'",
               "edgemeshrefinement edgesizing edgesize edgerefinement featureedges explicitfeaturesnap "
               "implicitfeaturesnap curvesize connector connectorspacing"},
    OtherWords{"sizes by a formula", "the key is 'sizing.expression'",
               "matheval sizefunction meshsizefunction meshsizecallback meshsizefilename sizefield field"},
    OtherWords{
        "boundary layers", "the keys are below 'layers'",
        "addlayers addlayerscontrols boundarylayer boundarylayers inflation inflationlayer inflationlayers "
        "prism "
        "prisms prismlayer prismlayers trex viscouslayers boundarylayercontrols layerssettings prismmesh bl"},
    OtherWords{
        "number of layers", "the key is 'layers.count'",
        "nsurfacelayers nlayers numlayers numberoflayers maxlayers fulllayers numprismlayers layercount"},
    OtherWords{"height of the first layer", "the key is 'layers.first'",
               "firstlayerthickness firstlayerheight firstheight maxfirstlayerthickness hwalln hwall deltas "
               "wallspacing "
               "firstcellheight firstprismheight nearwallthickness firstaspectratio"},
    OtherWords{"y+", "the key is 'layers.y_plus', with 'layers.reynolds' and 'layers.length'",
               "yplus targetyplus"},
    OtherWords{"growth of layers", "the key is 'layers.growth'",
               "expansionratio thicknessratio layergrowth layergrowthrate layerratio stretchingratio "
               "layerstretching"},
    OtherWords{
        "height of all layers", "the key is 'layers.total'",
        "totalthickness layerthickness totalheight maxthickness prismlayerthickness totallayerthickness"},
    OtherWords{"where layers stop",
               "layers grow until they are as high as triangles are wide ('layers.until'), at most "
               "'layers.count' or "
               "'layers.total'",
               "finallayerthickness minthickness transitionratio lastlayerratio lastratio isotropicheight "
               "isotropiccellheight relativesizes"},
    OtherWords{"layers of single patches", "the keys are below 'layers.patches'",
               "patchboundarylayers layerpatches"},
    OtherWords{
        "edges of triangle files", "the key is 'geometry.feature_angle'",
        "featureangle angleforedges includedangle featureextract surfacefeatures surfacefeatureextract "
        "anglesurface"},
    OtherWords{"geometry file", "the keys are 'geometry.file' and 'geometry.parts'",
               "surfacefile trisurfacemesh trisurface cadfile geometryfile stlfile stepfile inputfile merge"},
    OtherWords{
        "fluid or body",
        "the key is 'geometry.domain': the file is the fluid, or bodies that a far field surrounds",
        "locationinmesh locationsinmesh insidepoint materialpoint seedpoint keepcellsintersectingboundary "
        "externalflow internalflow fluidregion volumeregion"},
    OtherWords{"box around a body", "the keys are below 'farfield'",
               "enclosure boundingbox windtunnel domainbox externaldomain outerdomain bbox"},
    OtherWords{
        "names of patches", "the keys are below 'patches' and 'groups'",
        "renameboundary namedselection namedselections physical physicalsurface physicalgroup physicalgroups "
        "boundaryconditions bc bcs boundaries boundary"},
    OtherWords{"names of regions", "regions have the names of their solids in the CAD",
               "physicalvolume regionname volumename materials material"},
    OtherWords{"quality", "the keys are below 'improve.gate'",
               "meshqualitycontrols meshquality maxnonortho maxboundaryskewness maxinternalskewness minvol "
               "mindeterminant "
               "mintetquality qualitylimits skewness orthogonalquality minorthogonality qualitymetric"},
    OtherWords{
        "improvement", "the keys are below 'improve'",
        "optimize optimizenetgen optimise optimization smoothing smooth optsteps3d optsteps2d optsteps "
        "nsmoothpatch "
        "nrelaxiter nsolveiter nrelaxediter meshoptimisation meshoptimization improvemesh autonodemove "
        "smoothingiterations optimiselayer"},
    OtherWords{"number of ranks", "`mpirun -n N` before the command gives it, and it changes no mesh",
               "numthreads maxnumthreads maxnumthreads3d threads nthreads processes nprocs "
               "numberofprocessors ncores cores "
               "numberofsubdomains parallelmesh"},
    OtherWords{"algorithm", "there is one algorithm, and no key for it",
               "algorithm algorithm2d algorithm3d meshalgorithm mesher method frontal delaunay hxt meshadapt "
               "packingofparallelograms mmg"},
    OtherWords{"fit to the geometry", "meshes always fit the CAD, without a key",
               "snap snapcontrols nfeaturesnapiter projection snaptolerance castellatedmeshcontrols"},
    OtherWords{"file format", "the key is 'output.formats'",
               "mshfileversion fileformat format saveformat exportformat outputformat writeformat"},
};

constexpr std::array words_of_paths{
    OtherWords{
        "unit of the geometry",
        "lengths stay in the unit of the file: scale the file, or the mesh before a solver reads it",
        "geometryscale geometryunit geometryunits geometryscaling geometryfactor outputscale outputunit "
        "outputunits"},
};

constexpr std::array words_of_values{
    OtherWords{"symmetry", "the type is 'symmetry'", "symmetryplane symm mirror"},
    OtherWords{"inlet", "the type is 'inlet'", "velocityinlet massflowinlet pressureinlet"},
    OtherWords{"outlet", "the type is 'outlet'", "pressureoutlet outflowboundary massflowoutlet"},
    OtherWords{"wall without friction", "the type is 'slip'", "inviscidwall eulerwall slipwall freeslip"},
    OtherWords{"wall", "the type is 'wall'", "noslip noslipwall viscouswall adiabaticwall patch"},
    OtherWords{"far field as a type", "the type is 'farfield'", "pressurefarfield freestream"},
    OtherWords{"format of a solver", "docs/formats.md says which formats its solver reads",
               "fluent starccm ccm nastran abaqus ansys cfx bdf inp unv exodus comsol"},
};

/// Letters and digits, in lower case.
std::string bare_path(std::string_view word) {
  std::string letters;
  for (const unsigned char c : word)
    if (std::isalnum(c) != 0) letters += static_cast<char>(std::tolower(c));
  return letters;
}

/// The same of the last part of a name.
std::string bare(std::string_view word) {
  const std::size_t last = word.find_last_of("./");
  return bare_path(last == std::string_view::npos ? word : word.substr(last + 1));
}

bool has_word(std::string_view words, const std::string& word) {
  for (std::size_t begin = 0; begin < words.size();) {
    const std::size_t end = std::min(words.find(' ', begin), words.size());
    if (words.substr(begin, end - begin) == word) return true;
    begin = end + 1;
  }
  return false;
}

std::optional<std::string> answer_of(std::span<const OtherWords> table, const std::string& letters) {
  for (const OtherWords& each : table)
    if (!letters.empty() && has_word(each.words, letters))
      return fmt::format("{} ({})", each.answer, page_of_other_words);
  return std::nullopt;
}

}  // namespace

std::span<const OtherWords> out_of_scope() {
  return words_beyond;
}

std::span<const OtherWords> named_otherwise() {
  return words_of_keys;
}

std::span<const OtherWords> paths_otherwise() {
  return words_of_paths;
}

std::span<const OtherWords> values_otherwise() {
  return words_of_values;
}

std::optional<std::string> answer_to_key(const std::string& key) {
  const std::string letters = bare(key);
  for (const auto table : {out_of_scope(), named_otherwise(), values_otherwise()})
    if (auto answer = answer_of(table, letters)) return answer;
  return std::nullopt;
}

std::optional<std::string> answer_to_path(const std::string& path) {
  return answer_of(words_of_paths, bare_path(path));
}

std::optional<std::string> answer_to_value(const std::string& value) {
  const std::string letters = bare(value);
  for (const auto table : {out_of_scope(), values_otherwise()})
    if (auto answer = answer_of(table, letters)) return answer;
  return std::nullopt;
}

namespace {

/// Names a file of another mesher's settings by its name or its first characters: "a dictionary of OpenFOAM".
/// Empty for others.
std::string settings_of_other_mesher(const std::string& file, const std::string& beginning) {
  const std::filesystem::path path(file);
  const std::string end = path.extension().string();
  if (beginning.find("FoamFile") != std::string::npos || path.filename().string().ends_with("MeshDict"))
    return "a dictionary of OpenFOAM";
  if (end == ".geo") return "a script of Gmsh";
  if (end == ".glf") return "a script of Pointwise";
  if (end == ".jou") return "a journal of Fluent Meshing";
  return {};
}

}  // namespace

void require_no_geometry(const std::string& file) {
  const std::string known = " .step .stp .iges .igs .brep .stl .obj .off .ply .poly .smesh ";
  std::string end = std::filesystem::path(file).extension().string();
  std::transform(end.begin(), end.end(), end.begin(), [](unsigned char c) { return std::tolower(c); });
  if (end.empty() || known.find(" " + end + " ") == std::string::npos) return;
  throw CaseError(file + ": a geometry, but a case is expected. `aeroloom init case.yaml --geometry " + file +
                  "` writes one");
}

void require_no_settings(const std::string& file, const std::string& text) {
  constexpr std::size_t beginning = 2000;  // characters; a header of OpenFOAM has some hundred
  const std::string what = settings_of_other_mesher(file, text.substr(0, beginning));
  if (what.empty()) return;
  throw CaseError(
      fmt::format("{}: {}, but a case in YAML is expected. `aeroloom init case.yaml` writes one; {} "
                  "tells which keys take the place of others",
                  file, what, page_of_other_words));
}

}  // namespace aeroloom::cases
