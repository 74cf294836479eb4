#include "pipeline/case_keys.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::pipeline {

namespace {

const std::string length = "(length unit of the geometry)";

void declare_lifting_surface(KeyTable& keys, cad::LiftingSurface& surface) {
  keys.number("root_chord", surface.root_chord, Range::above(0, "m"));
  keys.number("taper", surface.taper, Range::above(0, 1));
  keys.number("half_span", surface.half_span, Range::above(0, "m"));
  keys.number("sweep", surface.sweep, Range::between(-75, 75, "degrees"));
  keys.number("dihedral", surface.dihedral, Range::between(-75, 75, "degrees"));
  keys.number("thickness", surface.thickness, Range::above(0, 0.5, "of the chord"));
  keys.number("camber", surface.camber, Range::between(-0.2, 0.2, "of the chord"));
  keys.number("root_incidence", surface.root_incidence, Range::between(-30, 30, "degrees"));
  keys.number("tip_incidence", surface.tip_incidence, Range::between(-30, 30, "degrees"));
  keys.number("x", surface.x, {});
  keys.number("z", surface.z, {});
  keys.number("trailing_edge", surface.trailing_edge, Range::above(0, 0.1, "of the chord"));
}

void declare_dimensions(KeyTable& keys, cad::TransportDimensions& dimensions) {
  keys.number("fuselage_length", dimensions.fuselage_length, Range::above(0, "m"));
  keys.number("fuselage_diameter", dimensions.fuselage_diameter, Range::above(0, "m"));
  keys.number("nose_length", dimensions.nose_length, Range::above(0, "m"));
  keys.number("tail_length", dimensions.tail_length, Range::above(0, "m"));
  keys.number("tail_upsweep", dimensions.tail_upsweep, {});
  declare_lifting_surface(keys.section("wing"), dimensions.wing);
  declare_lifting_surface(keys.section("horizontal_tail"), dimensions.horizontal_tail);
  declare_lifting_surface(keys.section("vertical_tail"), dimensions.vertical_tail);
}

void declare_sabotage(KeyTable& keys, parallel::Sabotage& sabotage) {
  using parallel::Sabotage;
  keys.choice<Sabotage>("inject", sabotage,
                        {{"none", Sabotage::none},
                         {"throws", Sabotage::throws},
                         {"aborts", Sabotage::aborts},
                         {"hangs", Sabotage::hangs},
                         {"exhausts_memory", Sabotage::exhausts_memory}});
}

void declare_geometry(KeyTable& root, CaseDraft& draft) {
  using cad::DomainKind;
  using cad::FarFieldShape;
  KeyTable& keys = root.section("geometry");
  keys.text("file", draft.result.domain.file);
  keys.choice<Builtin>("builtin", draft.builtin, {{"transport", Builtin::transport}});
  declare_dimensions(keys.section("dimensions", &draft.dimensions_given), draft.dimensions);
  keys.choice<DomainKind>(
      "domain", draft.result.domain.kind,
      {{"auto", DomainKind::automatic}, {"fluid", DomainKind::fluid}, {"body", DomainKind::body}});
  keys.choice<NarrowFaces>("narrow_faces", draft.result.narrow_faces,
                           {{"join", NarrowFaces::join}, {"keep", NarrowFaces::keep}});
  cad::TrailingEdgeOptions& trailing = draft.result.domain.trailing_edges;
  keys.choice<cad::TrailingEdges>(
      "trailing_edges", trailing.treatment,
      {{"keep", cad::TrailingEdges::keep}, {"sharpen", cad::TrailingEdges::sharpen}});
  keys.texts("sharpen_faces", trailing.faces);
  keys.number("sharpen_width", draft.sharpen_width, Range::above(0, length));
  declare_sabotage(keys, draft.result.geometry_sabotage);
  KeyTable& far_field = root.section("farfield", &draft.far_field_given);
  far_field.choice<FarFieldShape>("shape", draft.far_field.shape,
                                  {{"sphere", FarFieldShape::sphere},
                                   {"box", FarFieldShape::box},
                                   {"hemisphere", FarFieldShape::hemisphere},
                                   {"cylinder", FarFieldShape::cylinder}});
  far_field.number("extent", draft.far_field.extent, Range::above(0, "reference lengths"));
  using cad::Axis;
  using cad::Symmetry;
  far_field.choice<Axis>("axis", draft.far_field.axis, {{"x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}});
  far_field.choice<Symmetry>("symmetry", draft.far_field.symmetry,
                             {{"auto", Symmetry::automatic},
                              {"none", Symmetry::none},
                              {"x", Symmetry::x},
                              {"y", Symmetry::y},
                              {"z", Symmetry::z}});
  far_field.number("symmetry_position", draft.far_field.symmetry_position, {});
}

void declare_patches(KeyTable& root, CaseDraft& draft) {
  root.named_sections("patches", [&draft](const std::string& name, KeyTable& keys) {
    const auto known = std::find_if(draft.patches.begin(), draft.patches.end(),
                                    [&](const PatchRule& rule) { return rule.name == name; });
    PatchRule& rule =
        known != draft.patches.end() ? *known : draft.patches.emplace_back(PatchRule{name, {}, {}});
    keys.texts("faces", rule.faces);
    using mesh::PatchType;
    std::vector<std::pair<std::string, std::optional<PatchType>>> types;
    for (const PatchType type : {PatchType::wall, PatchType::slip, PatchType::symmetry, PatchType::farfield,
                                 PatchType::inlet, PatchType::outlet})
      types.emplace_back(mesh::name_of(type), type);
    keys.choice("type", rule.type, types);
  });
}

void declare_sizing(KeyTable& keys, SizingRequest& sizing) {
  keys.number("minimum", sizing.minimum, Range::above(0, length));
  keys.number("feature_minimum", sizing.feature_minimum, Range::above(0, length));
  keys.number("maximum", sizing.maximum, Range::above(0, length));
  keys.number("surface_maximum", sizing.surface_maximum, Range::above(0, length));
  keys.number("curvature_angle", sizing.curvature_angle, Range::between(0.1, 90, "degrees per element"));
  keys.number("chordal_deviation", sizing.chordal_deviation, Range::above(0, length));
  keys.number("growth", sizing.growth, Range::above(1, 3));
  keys.number("proximity", sizing.proximity, Range::between(0, 20, "elements"));
  keys.number("target_tetrahedra", sizing.target_tetrahedra, Range::between(100, 1e10));
  keys.number("feature_budget", sizing.feature_budget, Range::between(1, 1000));
}

void declare_stages(KeyTable& root, Case& result) {
  const Range piece_size = Range::between(100, 1e9, "elements");
  KeyTable& surface_keys = root.section("surface");
  using surface::SurfaceDecomposition;
  surface_keys.integer("piece_triangles", result.surface.piece_triangles, piece_size);
  surface_keys.choice<SurfaceDecomposition>(
      "decomposition", result.surface.decomposition,
      {{"faces", SurfaceDecomposition::faces}, {"pieces", SurfaceDecomposition::pieces}});
  surface_keys.number("cut_angle", result.surface.cut_angle, Range::between(0, 60, "degrees"));
  KeyTable& volume = root.section("volume");
  volume.integer("piece_tets", result.volume.piece_tets, piece_size);
  volume.number("lattice_clearance", result.volume.lattice_clearance, Range::above(0, 2, "local sizes"));
  volume.number("perturbation", result.volume.perturbation,
                Range::between(0, 0.05, "mean edges of the lattice"));
  volume.number("halo", result.volume.halo, Range::between(0.5, 5, "largest sizes nearby"));
  declare_sabotage(volume, result.volume.sabotage);
  volume.integer("inject_zone", result.volume.sabotaged_zone, Range::between(-1, 1e9));
  const std::string no_interfaces = "volume pieces have no interfaces";
  volume.retired("erase_interfaces", no_interfaces);
  volume.retired("interface_angle", no_interfaces);
  KeyTable& improve = root.section("improve");
  improve.flag("enabled", result.improve.enabled);
  improve.number("target_angle", result.improve.target_angle, Range::above(0, 50, "degrees"));
  improve.integer("sweeps", result.improve.sweeps, Range::between(0, 1000));
  improve.integer("relaxation", result.improve.relaxation, Range::between(0, 100));
  KeyTable& gate = improve.section("gate");
  const Range angle = Range::between(0, 180, "degrees"), ratio = Range::between(0, 1);
  gate.number("smallest_angle", result.gate.smallest_angle, angle);
  gate.number("largest_angle", result.gate.largest_angle, angle);
  gate.number("percentile_01", result.gate.percentile_01, angle);
  gate.number("percentile_1", result.gate.percentile_1, angle);
  gate.number("percentile_5", result.gate.percentile_5, angle);
  gate.number("min_mean_ratio", result.gate.min_mean_ratio, ratio);
  gate.number("mean_mean_ratio", result.gate.mean_mean_ratio, ratio);
  gate.number("largest_volume_ratio", result.gate.largest_volume_ratio, Range::between(1, io::largest_ratio));
  gate.number("largest_edge_ratio", result.gate.largest_edge_ratio, Range::between(1, io::largest_ratio));
  gate.number("min_scaled_jacobian", result.gate.min_scaled_jacobian, Range::between(-1, 1));
  KeyTable& output = root.section("output");
  output.text("directory", result.output.directory);
  std::vector<std::pair<std::string, io::FileFormat>> formats;
  formats.reserve(io::format_names.size());
  for (const io::FormatName& format : io::format_names) formats.emplace_back(format.name, format.format);
  output.choices("formats", result.output.formats, formats);
  output.integer("parts", result.output.parts, Range::between(0, 1e6));
  output.flag("tasks", result.output.tasks);
  output.choice<io::Compression>(
      "compression", result.output.compression,
      {{"none", io::Compression::none}, {"lz4", io::Compression::lz4}, {"zlib", io::Compression::zlib}});
  output.choice<Checkpoints>(
      "checkpoints", result.output.checkpoints,
      {{"none", Checkpoints::none}, {"write", Checkpoints::write}, {"resume", Checkpoints::resume}});
  output.flag("pictures", result.output.pictures);
  output.choice<parallel::LogLevel>("log", result.output.log,
                                    {{"quiet", parallel::LogLevel::quiet},
                                     {"normal", parallel::LogLevel::normal},
                                     {"verbose", parallel::LogLevel::verbose}});
}

}  // namespace

void declare_case_keys(KeyTable& root, CaseDraft& draft) {
  declare_geometry(root, draft);
  declare_patches(root, draft);
  declare_sizing(root.section("sizing"), draft.result.sizing);
  declare_stages(root, draft.result);
}

}  // namespace aeroloom::pipeline
