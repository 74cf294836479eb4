#include "pipeline/case/case_keys.hpp"
#include "pipeline/case/group_keys.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <unordered_map>

namespace aeroloom::cases {

namespace {

void declare_lifting_surface(KeyTable& keys, cad::LiftingSurface& surface) {
  keys.number("root_chord", surface.root_chord, Range::above(0, "m"),
              "Chord at the plane of symmetry; of the fin: at the fuselage.");
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
      "What becomes of blunt trailing edges. `keep`: they are meshed as they are. `sharpen`: they are closed "
      "to a curve half-way between their long borders, which saves many small tetrahedra ([Closing "
      "them](trailing_edges.md#closing-them)). `auto`: kept if five times the target, or a "
      "larger `sizing.feature_budget` (or `sizing.feature_minimum`), allows elements at most 2.7 times as "
      "long as the edge is wide; else closed "
      "if that moves its borders by at most 0.04 % of the local chord; else elements are longer ([Trailing "
      "edges](trailing_edges.md#what-auto-decides)).");
  keys.texts("sharpen_faces", trailing.faces,
             sets("TrailingEdgeOptions::faces",
                  {"Patterns: strips are closed only if the name of their face or patch matches one. `*` "
                   "stands for any characters, `?` for one, `re:` for an expression. A pattern without a "
                   "match is an error. Needs `trailing_edges: sharpen`.",
                   "all", "['wing*', fin_te]"}));
  keys.number(
      "sharpen_width", draft.sharpen_width, Range::above(0, length_unit),
      {"Strips up to this width are closed. Needs `trailing_edges: sharpen`.",
       "3 % of the strip's length, 10 % of the breadth of each neighbour (area over common border)", "0.02"});
}

void declare_parts(KeyTable& keys, CaseDraft& draft) {
  keys.named_sections("parts",
                      "Bodies of flat triangles beside those of `file` or `builtin`, such as a store or an "
                      "ice shape. They are united with what they overlap, as triangles ([CAD and triangles "
                      "in one case](faceted.md#cad-and-triangles-in-one-case)).",
                      {"A body, and its patch, of a name that you choose.", "", "store"},
                      [&draft](const std::string& name, KeyTable& part) {
                        auto found =
                            std::find_if(draft.parts.begin(), draft.parts.end(),
                                         [&](const cad::FacetedBody& each) { return each.name == name; });
                        if (found == draft.parts.end())
                          found = draft.parts.insert(found, cad::FacetedBody{name, "", 1});
                        part.path("file", found->file,
                                  {"Its triangles: STL, OBJ, OFF, PLY, .poly or .smesh. The path is as that "
                                   "of `geometry.file`. Needed.",
                                   "", "store.stl"});
                        part.number("scale", found->scale, Range::above(0),
                                    "Factor from its coordinates to the length unit of the geometry, because "
                                    "files of triangles declare no unit.");
                      });
}

/// What is left out of a file, closed in it, and how its names are read.
void declare_reading(KeyTable& keys, CaseDraft& draft) {
  keys.number(
      "feature_angle", draft.result.domain.feature_angle, Range::between(5, 180, "degrees"),
      sets("DomainOptions::feature_angle", {"For files of triangles: a side becomes an edge of the mesh if "
                                            "the surface turns by more than this angle there."}));
  keys.texts(
      "voids", draft.result.domain.voids,
      sets("DomainOptions::voids",
           {"For files of triangles: patterns for names of solids that are voids of the solid around "
            "them, whichever way they are turned ([Regions of triangles](faceted.md#regions)). "
            "Patterns as in `sharpen_faces`; without names, solids are `solid_0`, `solid_1` and so on.",
            "none", "[cavity, 'hole*']"}));
  keys.texts(
      "ignore", draft.result.domain.ignore,
      sets("DomainOptions::ignore",
           {"Faces of the file that are left out, such as a stray sheet beside the bodies: patterns of "
            "names (`*` any characters, `?` one, `re:` an expression) or numbers. Of triangles: names "
            "of solids, objects or groups. `aeroloom info FILE` lists them; one without a match is an "
            "error.",
            "none", "[face_12, 'construction*']"}));
  keys.choice<cad::Caps>(
      "caps", draft.result.domain.caps, {{"join", cad::Caps::join}, {"name", cad::Caps::name}},
      sets("DomainOptions::caps",
           "Patches of faces that close openings ([Healing](real_cad.md)). `join`: that of the wall "
           "around the opening. `name`: `cap_1`, `cap_2` and so on. The faces have these names either way."));
  keys.texts(
      "close", draft.result.domain.close,
      sets(
          "DomainOptions::close",
          {"Openings that get a closing face whatever their width: patterns for names of faces, or of groups "
           "of triangles, beside them (as in `ignore`), or boxes that contain them, as a text of six numbers "
           "(lower corner, upper corner). One without a match is an error. `[refuse]`: nothing is closed, "
           "however narrow ([Openings](real_cad.md#openings)).",
           "narrow, small and planar ones alone are closed", "[nozzle, '-1 -1 0 1 1 0.2']"}));
  keys.text("encoding", draft.result.domain.encoding,
            sets("DomainOptions::encoding",
                 {"Encoding of names in files of geometry, where they are not UTF-8: `latin-1`, "
                  "`windows-1252`, `GB18030`, `Shift-JIS`, or another that `iconv -l` lists. STEP has "
                  "escapes for other letters, and needs none. Without it, each byte is a letter of latin-1 "
                  "([Names](real_cad.md#names)).",
                  "latin-1", "GB18030"}));
}

void declare_geometry(KeyTable& keys, CaseDraft& draft) {
  using cad::DomainKind;
  keys.path("file", draft.result.domain.file,
            common({"The CAD file: STEP, IGES or BREP; or flat triangles: STL, OBJ, OFF, PLY, .poly or "
                    ".smesh ([Faceted models](faceted.md)). The path is relative to the folder of the case, "
                    "or else to the working directory; on the command line always to the working directory. "
                    "`${NAME}` in it is an environment variable. Needed, unless `builtin` is given.",
                    "", "aircraft.step"}));
  keys.choice<Builtin>("builtin", draft.builtin, {{"transport", Builtin::transport}},
                       {"A built-in shape, to try the program without CAD. `transport`: an aircraft of about "
                        "38 m length and 34 m span.",
                        "", "transport"});
  keys.choice<DomainKind>(
      "domain", draft.result.domain.kind,
      {{"auto", DomainKind::automatic}, {"fluid", DomainKind::fluid}, {"body", DomainKind::body}},
      sets("DomainOptions::kind",
           common("What the solids of the file are. `fluid`: the space to mesh. `body`: bodies in a far "
                  "field that the program adds. `auto` decides and says why ([Fluid or "
                  "body](configuration/geometry.md#fluid-or-body)). Set it where `auto` is wrong.")));
  keys.choice<cad::Baffles>(
      "baffles", draft.result.domain.baffles,
      {{"keep", cad::Baffles::keep}, {"refuse", cad::Baffles::refuse}},
      sets("DomainOptions::baffles",
           "What becomes of a face inside of the fluid, which has the fluid on both sides. `keep`: it is "
           "meshed "
           "once, as an inner patch of its name ([Baffles](real_cad.md#baffles)). `refuse`: it is an error, "
           "with name and place."));
  keys.choice<NarrowFaces>(
      "narrow_faces", draft.result.narrow_faces, {{"join", NarrowFaces::join}, {"keep", NarrowFaces::keep}},
      "`join`: a face narrower than `sizing.minimum` becomes part of a neighbour that continues it smoothly "
      "([Narrow faces](real_cad.md#narrow-faces)). `keep`: its borders stay in the mesh.");
  keys.choice<ChamberUse>(
      "chambers", draft.result.chambers, {{"refuse", ChamberUse::refuse}, {"keep", ChamberUse::keep}},
      "A region whose space falls into parts that nothing joins, such as the fluid around a body and that in "
      "a void of it. `refuse`: an error that lists volumes and places. `keep`: all are meshed.");
  declare_reading(keys, draft);
  declare_trailing_edges(keys, draft);
  declare_parts(keys, draft);
  declare_dimensions(
      keys.section("dimensions",
                   "Dimensions of the built-in aircraft, such as `wing: {half_span: 18}`. Needs `builtin`.",
                   &draft.dimensions_given),
      draft.dimensions);
}

void declare_far_field(KeyTable& keys, CaseDraft& draft) {
  using cad::Axis;
  using cad::FarFieldShape;
  using cad::Symmetry;
  keys.choice<FarFieldShape>(
      "shape", draft.far_field.shape,
      {{"sphere", FarFieldShape::sphere},
       {"box", FarFieldShape::box},
       {"hemisphere", FarFieldShape::hemisphere},
       {"cylinder", FarFieldShape::cylinder}},
      common("Shape of the far field, around the centre of the body. `hemisphere` makes a half model."));
  keys.number("extent", draft.extent, Range::above(0),
              sets("FarFieldOptions::extent",
                   common({"Distance of the far field: radius, half side of the box, radius and half length "
                           "of the cylinder. `unit` is what it counts.",
                           "10; 100 semispans with a level of sizes", "10"})));
  keys.choice<std::optional<cad::ExtentUnit>>(
      "unit", draft.extent_unit,
      {{"body", cad::ExtentUnit::body},
       {"semispan", cad::ExtentUnit::semispan},
       {"length", cad::ExtentUnit::model},
       {"reference_length", cad::ExtentUnit::reference}},
      {"What `extent` counts. `body`: largest extents of the body. `semispan`: half of what the body extends "
       "across the flow, or all of it from the plane of symmetry of a half model. `length`: the length unit "
       "of the geometry. `reference_length`: `sizing.reference_length`, such as a chord.",
       "body", "body"});
  keys.choice<Axis>("axis", draft.far_field.axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}},
                    "Axis of the cylinder.");
  keys.choice<Symmetry>("symmetry", draft.far_field.symmetry,
                        {{"auto", Symmetry::automatic},
                         {"none", Symmetry::none},
                         {"x", Symmetry::x},
                         {"y", Symmetry::y},
                         {"z", Symmetry::z}},
                        sets("FarFieldOptions::symmetry",
                             common("`x`, `y`, `z`: a half model with its plane of symmetry normal to this "
                                    "axis. `none`: the whole model. `auto`: a half model in a hemisphere "
                                    "only ([Half models](configuration/farfield.md#half-models)).")));
  keys.number("symmetry_position", draft.far_field.symmetry_position, Range::any(length_unit),
              sets("FarFieldOptions::symmetry_position",
                   {"Position of the plane of symmetry on its axis.", "where the body ends, or 0", "0"}));
}

void declare_patches(KeyTable& root, CaseDraft& draft) {
  root.named_sections(
      "patches",
      common("Joins and renames patches, and gives them sizes and conditions ([Patches and "
             "conditions](configuration/patches.md#patches-and-conditions)). `aeroloom check` lists the "
             "patches of the CAD file."),
      common({"A patch of a name that you choose. A face belongs to the first patch that it matches.", "",
              "wing"}),
      [&draft, places = std::unordered_map<std::string, std::size_t>()](const std::string& name,
                                                                        KeyTable& keys) mutable {
        if (places.size() != draft.patches.size()) {
          for (std::size_t p = 0; p < draft.patches.size(); ++p) places.try_emplace(draft.patches[p].name, p);
        }
        const auto [place, is_new] = places.try_emplace(name, draft.patches.size());
        PatchRule& rule =
            is_new ? draft.patches.emplace_back(PatchRule{name, {}, {}, {}}) : draft.patches[place->second];
        keys.texts(
            "faces", rule.faces,
            common(
                {"Patterns of names of faces or patches that become this patch (`*` any characters, `?` one, "
                 "`re:` an expression). A pattern without a match is an error that lists the nearest names.",
                 "the patch of this name", "['wing_*', 'flap_?']"}));
        keys.number("size", rule.size, Range::above(0, length_unit),
                    common({"Largest size of elements on the patch. Only smaller sizes that are asked for "
                            "there replace it.",
                            "that of `sizing`", "0.05"}));
        keys.flag("optional", rule.optional,
                  "Whether the rule may match nothing, as in a case for several geometries, or where a face "
                  "may be closed or joined. Otherwise this is an error.");
        declare_patch_type(keys, rule.type);
      });
}

}  // namespace

void declare_geometry_keys(KeyTable& root, CaseDraft& draft) {
  declare_geometry(root.section("geometry", common("What is meshed, and how its CAD is prepared.")), draft);
  declare_far_field(root.section("farfield",
                                 common("The outer boundary that the program puts around bodies. It is an "
                                        "error where the solids of the file are the fluid."),
                                 &draft.far_field_given),
                    draft);
  declare_groups(root, draft.groups, draft.result.groups.strict);
  declare_patches(root, draft);
}

}  // namespace aeroloom::cases
