#include "pipeline/case/case_keys.hpp"

#include "pipeline/case/layer_keys.hpp"
#include "pipeline/case/level_keys.hpp"
#include "pipeline/case/scale_keys.hpp"
#include "pipeline/case/wall_keys.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::cases {

namespace {

void declare_bounds(KeyTable& keys, SizingRequest& sizing) {
  keys.number(
      "minimum", sizing.minimum, Range::above(0, length_unit),
      sets("SizingOptions::minimum",
           common({"Smallest size where surfaces are curved. At most `maximum` and `surface_maximum`.",
                   "from the model", "0.01"})));
  keys.number("feature_minimum", sizing.feature_minimum, Range::above(0, length_unit),
              {"Smallest size at short CAD edges, in narrow faces (blunt trailing edges) and behind sharp "
               "corners. From the model: as small as these are, within `feature_budget`; at least a "
               "thousandth of the minimum in narrow faces, a twentieth elsewhere.",
               "from the model; a twentieth of `minimum` where that is given", "0.001"});
  keys.number("maximum", sizing.maximum, Range::above(0, length_unit),
              common({"Largest size, in the far field.", "from the model", "10"}));
  keys.number("surface_maximum", sizing.surface_maximum, Range::above(0, length_unit),
              common({"Largest size on faces that are not far field.",
                      "from the model; none where `minimum` and `maximum` are given", "0.5"}));
}

void declare_sizing(KeyTable& keys, CaseDraft& draft) {
  SizingRequest& sizing = draft.result.sizing;
  const sizing::SizingOptions preset;
  declare_reference_length(keys, sizing.reference_length);
  declare_bounds(keys, sizing);
  keys.number("curvature_angle", sizing.curvature_angle, Range::between(0.1, 90, "degrees per element"),
              sets("SizingOptions::curvature_angle",
                   common({"Largest turn of an element on curved faces and edges. A smaller angle makes "
                           "leading edges finer and, with a target, the rest coarser.",
                           "15 where sizes are chosen from the model, " + shortest(preset.curvature_angle) +
                               " where `minimum` and `maximum` are given",
                           shortest(preset.curvature_angle)})));
  keys.number("chordal_deviation", sizing.chordal_deviation, Range::above(0, length_unit),
              {"Largest distance of triangles from curved faces. Sizes may fall to `feature_minimum` for it.",
               "any", "0.0001"});
  keys.number("growth", sizing.growth, Range::between(1.01, 3),
              common({"Largest ratio of sizes of neighbouring elements. A ratio near 1 makes the mesh "
                      "smoother and larger.",
                      shortest(preset.growth), shortest(preset.growth)}));
  keys.number(
      "proximity", sizing.proximity, Range::between(0, 20, "elements"),
      {"Least number of elements across a thin part of the body and across a gap; 0: no condition. By "
       "default nothing is asked across the inside of a body, which has no mesh, but that triangles "
       "of both its sides stay half its thickness apart.",
       "1 across gaps", "1"});
  keys.number("gap_proximity", sizing.gap_proximity, Range::between(0, 20, "elements"),
              {"The same across gaps alone: between walls with fluid between them, such as slat and wing.",
               "`proximity` if given, else 1", "4"});
  keys.number(
      "target_tetrahedra", sizing.target_tetrahedra, Range::between(100, 1e10),
      common({"Number of tetrahedra that the chosen sizes aim at. The first key to change for a finer or "
              "coarser mesh. Given sizes stay; the others are chosen around them. Features finer than the "
              "minimum count. Gaps get one element across whatever the target. What `sources` ask for and "
              "cells of layers come on top; layers take the place of some tetrahedra.",
              shortest(default_target) + "; any where `minimum` and `maximum` are given",
              shortest(default_target)}));
  keys.number(
      "feature_budget", sizing.feature_budget, Range::between(1, 1000, "times the target"),
      "Features finer than the minimum that do not fit into the target may make it this many times as "
      "many. Beyond it, narrow regions get long triangles; the log, the report and `check` name them and "
      "what they would take.");
  declare_scale(keys, sizing);
  declare_levels(keys, sizing);
  declare_expression(keys, sizing.expression);
  declare_sources(keys, draft.sources);
  declare_walls(keys, draft.walls);
  declare_edges(keys, draft.edges);
}

void declare_surface(KeyTable& keys, Case& result) {
  using surface::SurfaceDecomposition;
  keys.integer("piece_triangles", result.surface.piece_triangles, Range::between(100, 1e9, "elements"),
               sets("SurfaceOptions::piece_triangles",
                    "Wanted triangles of a piece of the surface. CAD faces heavier than one and a half "
                    "pieces are cut. A smaller number helps many ranks on small meshes."));
  keys.choice<SurfaceDecomposition>(
      "decomposition", result.surface.decomposition,
      {{"faces", SurfaceDecomposition::faces}, {"pieces", SurfaceDecomposition::pieces}},
      "`pieces` cuts heavy CAD faces, `faces` keeps one piece per CAD face.");
  keys.number("cut_angle", result.surface.cut_angle, Range::between(0, 60, "degrees"),
              "Least angle of cuts with each other and with feature curves; 0: cuts as METIS leaves them.");
}

void declare_volume(KeyTable& keys, Case& result) {
  keys.integer("piece_tets", result.volume.piece_tets, Range::between(100, 1e9, "elements"),
               sets("VolumeOptions::piece_tets",
                    {"Wanted tetrahedra of a piece of the volume. A volume of more than one and a half "
                     "pieces is filled in [zones](volume_decomposition.md).",
                     "a sixty-fourth of all, 40,000 to 170,000", "200000"}));
  keys.number("lattice_clearance", result.volume.lattice_clearance, Range::above(0, 2, "local sizes"),
              "Distance of lattice points from the boundary. The default suits nearly every mesh.");
  keys.number("perturbation", result.volume.perturbation,
              Range::between(0, 0.01, "mean edges of the lattice"),
              "Perturbation of lattice points, so that they do not lie on common spheres.");
  keys.number("halo", result.volume.halo, Range::between(0.5, 5, "largest sizes nearby"),
              sets("VolumeOptions::halo",
                   "Width of what a zone knows around it. Zones with a narrow halo may disagree; a wide halo "
                   "costs time."));
}

}  // namespace

void declare_case_keys(KeyTable& root, CaseDraft& draft) {
  declare_geometry_keys(root, draft);
  declare_sizing(
      root.section(
          "sizing",
          common(
              "How large elements are. Sizes that are left out are chosen from the model. At each place the "
              "smallest size wins ([Precedence of sizes](configuration/sizing.md#precedence-of-sizes)).")),
      draft);
  declare_surface(root.section("surface", "How the surface is cut into pieces of work."), draft.result);
  declare_layers(root, draft);
  declare_volume(root.section("volume", "How the volume is cut into pieces of work and filled."),
                 draft.result);
  declare_result_keys(root, draft.result);
  root.section("parallel", "How the machine is used; it changes no result.")
      .choice<parallel::Sandbox>(
          "sandbox", draft.result.sandbox,
          {{"process", parallel::Sandbox::process}, {"none", parallel::Sandbox::none}},
          "Where the CAD library and TetGen run. `process`: in child processes, so that a crash becomes a "
          "message or another try. `none`: in the ranks, for machines that forbid child processes. A crash "
          "then ends the run, and limits of time and memory do not hold.");
}

std::vector<KeyInfo> case_keys() {
  CaseDraft draft;
  KeyTable keys;
  declare_case_keys(keys, draft);
  keys.add_named("groups", made_up_name);
  keys.add_named("geometry.parts", made_up_name);
  keys.add_named("patches", made_up_name);
  for (const char* each : {"sizing.sources", "sizing.walls", "sizing.edges", "layers.patches"})
    keys.add_named(each, made_up_name);
  return keys.infos();
}

}  // namespace aeroloom::cases
