#include "pipeline/case/case_keys.hpp"
#include "pipeline/case/group_keys.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace aeroloom::cases {

namespace {

void declare_lifting_surface(KeyTable& keys, cad::LiftingSurface& surface) {
  keys.number("root_chord", surface.root_chord, Range::above(0, "m"),
              "Chord at the plane of symmetry; of the fin: where it stands on the fuselage.");
  keys.number("taper", surface.taper, Range::above(0, 1), "Chord at the tip over chord at the root.");
  keys.number("half_span", surface.half_span, Range::above(0, "m"),
              "From the plane of symmetry to the tip; of the fin: from root to tip.");
  keys.number("sweep", surface.sweep, Range::between(-75, 75, "degrees"), "Sweep of the leading edge.");
  keys.number("dihedral", surface.dihedral, Range::between(-75, 75, "degrees"), "Rise towards the tip.");
  keys.number("thickness", surface.thickness, Range::above(0, 0.5, "of the chord"),
              "Largest thickness of the aerofoil.");
  keys.number("camber", surface.camber, Range::between(-0.2, 0.2, "of the chord"),
              "Largest camber of the aerofoil; 0 makes it symmetric.");
  keys.number("root_incidence", surface.root_incidence, Range::between(-30, 30, "degrees"),
              "Incidence at the root, nose up.");
  keys.number("tip_incidence", surface.tip_incidence, Range::between(-30, 30, "degrees"),
              "Incidence at the tip, nose up.");
  keys.number("x", surface.x, Range::any("m"), "Leading edge of the root, behind the nose.");
  keys.number("z", surface.z, Range::any("m"), "Root above the axis of the fuselage.");
  keys.number("trailing_edge", surface.trailing_edge, Range::above(0, 0.1, "of the chord"),
              "Thickness of the blunt trailing edge.");
}

void declare_dimensions(KeyTable& keys, cad::TransportDimensions& dimensions) {
  keys.number("fuselage_length", dimensions.fuselage_length, Range::above(0, "m"),
              "From the nose to the end of the tail.");
  keys.number("fuselage_diameter", dimensions.fuselage_diameter, Range::above(0, "m"),
              "Of the cylindrical part.");
  keys.number("nose_length", dimensions.nose_length, Range::above(0, "m"),
              "From the nose to the cylindrical part.");
  keys.number("tail_length", dimensions.tail_length, Range::above(0, "m"),
              "From the cylindrical part to the end of the tail.");
  keys.number("tail_upsweep", dimensions.tail_upsweep, Range::any("m"),
              "Rise of the axis at the end of the tail.");
  declare_lifting_surface(keys.section("wing", "The wing, on both sides."), dimensions.wing);
  declare_lifting_surface(keys.section("horizontal_tail", "The tailplane, on both sides."),
                          dimensions.horizontal_tail);
  declare_lifting_surface(keys.section("vertical_tail", "The fin."), dimensions.vertical_tail);
}

void declare_trailing_edges(KeyTable& keys, CaseDraft& draft) {
  cad::TrailingEdgeOptions& trailing = draft.result.domain.trailing_edges;
  keys.choice<cad::TrailingEdges>(
      "trailing_edges", trailing.treatment,
      {{"auto", cad::TrailingEdges::automatic},
       {"keep", cad::TrailingEdges::keep},
       {"sharpen", cad::TrailingEdges::sharpen}},
      "`auto`: blunt trailing edges are meshed as they are where elements along them, within "
      "`sizing.feature_budget` (or `sizing.feature_minimum`), are at most 2.7 times as long as they are "
      "wide; else "
      "closed where that moves their borders by at most 0.04 % of the local chord; else elements are longer "
      "([Trailing edges](trailing_edges.md#what-auto-decides)). `sharpen`: blunt trailing edges are closed "
      "to a curve half-way between their two long borders, which "
      "saves the small tetrahedra that their thickness asks for "
      "([Blunt trailing edges](trailing_edges.md#closing-them)). `keep`: they are meshed as they are.");
  keys.texts("sharpen_faces", trailing.faces,
             sets("TrailingEdgeOptions::faces",
                  {"List of patterns: only strips are closed whose face's or patch's name matches one; `*` "
                   "stands for any characters, `?` for one, `re:` for an expression. A pattern without any "
                   "match is an error. Needs `trailing_edges: sharpen`.",
                   "all", "['wing*', fin_te]"}));
  keys.number(
      "sharpen_width", draft.sharpen_width, Range::above(0, length_unit),
      {"Strips up to this width are closed. Needs `trailing_edges: sharpen`.",
       "3 % of the strip's length, 10 % of the breadth of each neighbour (area over common border)", "0.02"});
}

void declare_parts(KeyTable& keys, CaseDraft& draft) {
  keys.named_sections(
      "parts",
      "Bodies of flat triangles beside those of `file` or `builtin`, such as a store or an ice shape. What "
      "they overlap becomes triangles too and is united with them "
      "([CAD and triangles in one case](faceted.md#cad-and-triangles-in-one-case)).",
      {"A body of a name that you choose, which is the name of its patch.", "", "store"},
      [&draft](const std::string& name, KeyTable& part) {
        auto found = std::find_if(draft.parts.begin(), draft.parts.end(),
                                  [&](const cad::FacetedBody& each) { return each.name == name; });
        if (found == draft.parts.end()) found = draft.parts.insert(found, cad::FacetedBody{name, "", 1});
        part.path("file", found->file,
                  {"Its triangles: STL, OBJ, OFF, PLY, .poly or .smesh. Paths are as in `geometry.file`. "
                   "Needed.",
                   "", "store.stl"});
        part.number("scale", found->scale, Range::above(0),
                    "What its coordinates are multiplied by to be in the length unit of the geometry: files "
                    "of triangles have none.");
      });
}

void declare_geometry(KeyTable& keys, CaseDraft& draft) {
  using cad::DomainKind;
  keys.path(
      "file", draft.result.domain.file,
      common({"The CAD file: STEP, IGES or BREP; or flat triangles: STL, OBJ, OFF, PLY, .poly or .smesh "
              "([Faceted models](faceted.md)). Its path is relative to the case's folder, or else to the "
              "working directory; on the command line to the working directory. `${NAME}` in the path is an "
              "environment variable. Needed, unless `builtin` is given.",
              "", "aircraft.step"}));
  keys.choice<Builtin>(
      "builtin", draft.builtin, {{"transport", Builtin::transport}},
      {"A built-in shape instead of `file`, to try the program without CAD. `transport`: a transport "
       "aircraft of about 38 m length and 34 m span.",
       "", "transport"});
  keys.choice<DomainKind>(
      "domain", draft.result.domain.kind,
      {{"auto", DomainKind::automatic}, {"fluid", DomainKind::fluid}, {"body", DomainKind::body}},
      sets("DomainOptions::kind",
           common("What the file's solids are. `fluid`: the space to mesh; `body`: bodies in a far field "
                  "that the program adds; `auto` decides and says why. Say it where `auto` is wrong.")));
  keys.choice<NarrowFaces>(
      "narrow_faces", draft.result.narrow_faces, {{"join", NarrowFaces::join}, {"keep", NarrowFaces::keep}},
      "`join`: faces narrower than `sizing.minimum` become part of a neighbour that goes on from them "
      "smoothly ([Narrow faces](real_cad.md#narrow-faces)). `keep`: their borders stay in the mesh.");
  keys.number(
      "feature_angle", draft.result.domain.feature_angle, Range::between(5, 180, "degrees"),
      sets("DomainOptions::feature_angle",
           {"Of files of triangles: sides across which they turn by more are edges that the mesh keeps; "
            "across others it goes on smoothly."}));
  declare_trailing_edges(keys, draft);
  declare_parts(keys, draft);
  declare_dimensions(
      keys.section("dimensions",
                   "Dimensions of the built-in aircraft, any of them, such as `wing: {half_span: 18}`. Goes "
                   "with `builtin` only.",
                   &draft.dimensions_given),
      draft.dimensions);
}

void declare_far_field(KeyTable& keys, CaseDraft& draft) {
  using cad::Axis;
  using cad::FarFieldShape;
  using cad::Symmetry;
  keys.choice<FarFieldShape>("shape", draft.far_field.shape,
                             {{"sphere", FarFieldShape::sphere},
                              {"box", FarFieldShape::box},
                              {"hemisphere", FarFieldShape::hemisphere},
                              {"cylinder", FarFieldShape::cylinder}},
                             common("Shape of the far field, around the body's centre. `hemisphere` makes a "
                                    "half model."));
  keys.number(
      "extent", draft.extent, Range::above(0),
      sets("FarFieldOptions::extent",
           common({"How far away the far field is: radius, half side of the box, radius and half length of "
                   "the cylinder. `unit` says what it counts: the largest extent of the body, if left out.",
                   "10; 100 semispans with a level of sizes", "10"})));
  keys.choice<std::optional<cad::ExtentUnit>>(
      "unit", draft.extent_unit,
      {{"body", cad::ExtentUnit::body},
       {"semispan", cad::ExtentUnit::semispan},
       {"length", cad::ExtentUnit::model},
       {"reference_length", cad::ExtentUnit::reference}},
      {"What `extent` counts: lengths of the body, semispans, the length unit of the geometry, or "
       "`sizing.reference_length`, such as a chord. A semispan is half of what the body extends "
       "across the flow, of half models all from the plane of symmetry on.",
       "body", "body"});
  keys.choice<Axis>("axis", draft.far_field.axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}},
                    "Axis of the cylinder.");
  keys.choice<Symmetry>(
      "symmetry", draft.far_field.symmetry,
      {{"auto", Symmetry::automatic},
       {"none", Symmetry::none},
       {"x", Symmetry::x},
       {"y", Symmetry::y},
       {"z", Symmetry::z}},
      sets("FarFieldOptions::symmetry",
           common("`x`, `y`, `z`: a half model, its plane of symmetry normal to this axis. `none`: the whole "
                  "model. `auto`: the hemisphere alone makes a half model "
                  "([Half models](configuration.md#half-models)).")));
  keys.number("symmetry_position", draft.far_field.symmetry_position, Range::any(length_unit),
              sets("FarFieldOptions::symmetry_position",
                   {"Position of the plane of symmetry on its axis.", "where the body ends, or 0", "0"}));
}

void declare_patches(KeyTable& root, CaseDraft& draft) {
  root.named_sections(
      "patches",
      common(
          "Joins and renames patches and says what they are to a solver "
          "([Patches and conditions](configuration.md#patches-and-conditions)). `aeroloom check` lists the "
          "patches "
          "that the CAD file has."),
      common(
          {"A patch of the mesh, of a name that you choose. The first patch of the list that a face matches "
           "has it.",
           "", "wing"}),
      [&draft, places = std::unordered_map<std::string, std::size_t>()](const std::string& name,
                                                                        KeyTable& keys) mutable {
        if (places.size() != draft.patches.size()) {
          for (std::size_t p = 0; p < draft.patches.size(); ++p) places.try_emplace(draft.patches[p].name, p);
        }
        const auto [place, is_new] = places.try_emplace(name, draft.patches.size());
        PatchRule& rule =
            is_new ? draft.patches.emplace_back(PatchRule{name, {}, {}, {}}) : draft.patches[place->second];
        keys.texts("faces", rule.faces,
                   common({"List of patterns of faces' or patches' names (`*` any characters, `?` one, `re:` "
                           "an expression): these "
                           "faces become this patch. A pattern without any match is an error that lists the "
                           "nearest names.",
                           "the patch of this name", "['wing_*', 'flap_?']"}));
        keys.number(
            "size", rule.size, Range::above(0, length_unit),
            common({"Largest size of elements on the faces of the patch. Smaller sizes that are asked for "
                    "there win; no other bound does.",
                    "that of `sizing`", "0.05"}));
        declare_patch_type(keys, rule.type);
      });
}

}  // namespace

void declare_geometry_keys(KeyTable& root, CaseDraft& draft) {
  declare_geometry(root.section("geometry", common("What is meshed, and how its CAD is prepared.")), draft);
  declare_far_field(
      root.section("farfield",
                   common("The outer boundary that the program puts around bodies. An error where the file's "
                          "solids are the fluid."),
                   &draft.far_field_given),
      draft);
  declare_groups(root, draft.groups, draft.result.groups.strict);
  declare_patches(root, draft);
}

}  // namespace aeroloom::cases
