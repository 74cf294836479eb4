#include "pipeline/info_text.hpp"

#include "geometry/place_text.hpp"
#include "io/read_mesh.hpp"
#include "pipeline/report/change_json.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::ordered_json;

/// Names shown of a kind; `--json` has all.
constexpr std::size_t shown_names = 20;

std::string box_text(const geometry::Box& box) {
  const geometry::Vec3 size = box.size();
  return fmt::format("{} to {}, {:.6g} x {:.6g} x {:.6g}", geometry::place_text(box.low),
                     geometry::place_text(box.high), size.x, size.y, size.z);
}

geometry::Box scaled(const geometry::Box& box, double factor) {
  geometry::Box result = box;
  result.low = factor * box.low;
  result.high = factor * box.high;
  return result;
}

Json names_json(const std::vector<cad::NamedFaces>& list) {
  Json json = Json::array();
  for (const cad::NamedFaces& named : list) json.push_back({{"name", named.name}, {"faces", named.faces}});
  return json;
}

std::string names_text(const char* what, const std::vector<cad::NamedFaces>& list) {
  if (list.empty()) return "";
  std::string text = fmt::format("{} ({}):", what, list.size());
  // "and 1 more" would be no shorter than the one.
  const std::size_t shown = list.size() <= shown_names + 1 ? list.size() : shown_names;
  for (std::size_t i = 0; i < shown; ++i)
    text += fmt::format("{} {} ({})", i == 0 ? "" : ",", list[i].name, list[i].faces);
  if (list.size() > shown) text += fmt::format(", and {} more", list.size() - shown);
  return text + "\n";
}

Json faces_json(const std::vector<cad::FaceFacts>& faces) {
  Json json = Json::array();
  for (const cad::FaceFacts& face : faces) {
    Json row = report::face_row(face.name, face.place);
    for (const auto& [key, value] :
         {std::pair("part", face.part), {"layer", face.layer}, {"colour", face.colour}}) {
      if (!value.empty()) row[key] = value;
    }
    json.push_back(std::move(row));
  }
  return json;
}

std::string faces_text(const std::vector<cad::FaceFacts>& faces) {
  const std::size_t shown = faces.size() <= shown_names + 1 ? faces.size() : shown_names;
  std::size_t width = 4;
  for (std::size_t i = 0; i < shown; ++i) width = std::max(width, faces[i].name.size());
  std::string text = fmt::format("{:<{}}  {:>10}  {:<32}  box\n", "face", width, "area", "centre");
  for (std::size_t i = 0; i < shown; ++i) {
    const cad::FacePlace& at = faces[i].place;
    text += fmt::format("{:<{}}  {:>10.4g}  {:<32}  {} to {}\n", faces[i].name, width, at.area,
                        geometry::place_text(at.centre), geometry::place_text(at.box.low),
                        geometry::place_text(at.box.high));
  }
  if (faces.size() > shown) text += fmt::format("and {} more: --json has all\n", faces.size() - shown);
  return text;
}

}  // namespace

Json doubled_nodes_json(const io::DoubledNodes& doubled) {
  return {{"nodes", doubled.nodes},
          {"faces", doubled.faces},
          {"place", doubled.nodes > 0 ? Json{doubled.place.x, doubled.place.y, doubled.place.z} : Json()},
          {"regions", doubled.regions},
          {"patches", doubled.patches}};
}

mesh::GlobalIndex cells_of_region(const io::FileMesh& mesh, std::size_t region) {
  const auto& cells = mesh.region_cells[region];
  return std::accumulate(cells.begin(), cells.end(), mesh::GlobalIndex{0});
}

Json info_json(const io::Assembled& file, const MeshFileFacts& facts) {
  const io::FileMesh& mesh = file.mesh;
  Json json = {{"kind", "mesh"},
               {"format", facts.format},
               {"parts", facts.parts > 0 ? Json(facts.parts) : Json()},
               {"points", mesh.vertex_count},
               {"cells", mesh.cell_count()},
               {"tetrahedra", mesh.cell_count(io::CellShape::tetrahedron)},
               {"pyramids", mesh.cell_count(io::CellShape::pyramid)},
               {"prisms", mesh.cell_count(io::CellShape::prism)},
               {"hexahedra", mesh.cell_count(io::CellShape::hexahedron)},
               {"bounds", report::to_json(facts.bounds)}};
  json["regions"] = Json::array();
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    json["regions"].push_back({{"name", mesh.regions[r]}, {"cells", cells_of_region(mesh, r)}});
  }
  json["patches"] = Json::array();
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    json["patches"].push_back({{"name", mesh.patches[p].name},
                               {"type", name_of(mesh.patches[p].type)},
                               {"triangles", mesh.patch_faces[p][0]},
                               {"quadrilaterals", mesh.patch_faces[p][1]}});
  }
  json["reading"] = {{"turned_cells", file.turned_cells},
                     {"dropped_points", file.dropped_points},
                     {"unnamed_faces", file.unnamed_faces},
                     {"left_out_faces", file.left_out_faces}};
  json["doubled_nodes"] = doubled_nodes_json(facts.doubled);
  return json;
}

std::string info_text(const io::Assembled& file, const MeshFileFacts& facts) {
  const io::FileMesh& mesh = file.mesh;
  std::string text = fmt::format("a mesh, {}{}\n", facts.format,
                                 facts.parts > 0 ? fmt::format(", {} part(s)", facts.parts) : "");
  text += fmt::format("points {}, tetrahedra {}, pyramids {}, prisms {}, hexahedra {}\n", mesh.vertex_count,
                      mesh.cell_count(io::CellShape::tetrahedron), mesh.cell_count(io::CellShape::pyramid),
                      mesh.cell_count(io::CellShape::prism), mesh.cell_count(io::CellShape::hexahedron));
  text += "box " + box_text(facts.bounds) + "\n";
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    text += fmt::format("region {:<30} {:>12} cells\n", mesh.regions[r], cells_of_region(mesh, r));
  }
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    const auto& faces = mesh.patch_faces[p];
    text += fmt::format("patch {:<31} {:>12} faces, {}\n", mesh.patches[p].name, faces[0] + faces[1],
                        name_of(mesh.patches[p].type));
  }
  text += "reading it: " + io::describe(file) + "\n";
  return facts.doubled.nodes == 0 ? text : text + io::describe(facts.doubled) + "\n";
}

namespace {

Json facets_json(const cad::CadFacts& facts) {
  const cad::FacetCounts& counts = *facts.facets;
  return {{"kind", "triangles"},
          {"format", facts.format},
          {"bounds", report::to_json(facts.bounds)},
          {"points", counts.points},
          {"triangles", counts.triangles},
          {"components", counts.components},
          {"without_area", counts.without_area},
          {"open_sides", counts.open_sides},
          {"junction_sides", counts.junction_sides},
          {"misoriented_sides", counts.misoriented_sides},
          {"area", counts.area},
          {"volume", counts.volume},
          {"parts", names_json(facts.parts)},
          {"face_names", names_json(facts.face_names)}};
}

std::string facets_text(const cad::CadFacts& facts) {
  const cad::FacetCounts& counts = *facts.facets;
  std::string text = fmt::format(
      "triangles, {}\nbox {}\npoints {}, triangles {}, components {}, area {:.6g}, volume {:.6g}\n",
      facts.format, box_text(facts.bounds), counts.points, counts.triangles, counts.components, counts.area,
      counts.volume);
  text += fmt::format(
      "sides of one triangle {}, of three or more {}, turned against each other {}; triangles "
      "without area {}\n",
      counts.open_sides, counts.junction_sides, counts.misoriented_sides, counts.without_area);
  return text + names_text("parts", facts.parts) + names_text("groups", facts.face_names);
}

}  // namespace

Json info_json(const cad::CadFacts& facts) {
  if (facts.facets) return facets_json(facts);
  const bool declared = !facts.unit_name.empty();
  return {
      {"kind", "cad"},
      {"format", facts.format},
      {"unit", declared ? Json(facts.unit_name) : Json()},
      {"unit_in_metres", declared ? Json(facts.unit_in_metres) : Json()},
      {"bounds", report::to_json(facts.bounds)},
      {"bounds_in_metres", declared ? report::to_json(scaled(facts.bounds, facts.unit_in_metres)) : Json()},
      {"solids", facts.solids},
      {"shells", facts.shells},
      {"faces", facts.faces},
      {"edges", facts.edges},
      {"parts", names_json(facts.parts)},
      {"face_names", names_json(facts.face_names)},
      {"layers", names_json(facts.layers)},
      {"colours", names_json(facts.colours)},
      {"face_table", faces_json(facts.face_table)}};
}

std::string info_text(const cad::CadFacts& facts) {
  if (facts.facets) return facets_text(facts);
  const bool declared = !facts.unit_name.empty();
  std::string text = fmt::format("CAD, {}, unit {}\n", facts.format,
                                 declared ? facts.unit_name : std::string("not declared: lengths as stored"));
  text += "box " + box_text(facts.bounds) + (declared ? " " + facts.unit_name : "") + "\n";
  if (declared && facts.unit_in_metres != 1)
    text += "    " + box_text(scaled(facts.bounds, facts.unit_in_metres)) + " m\n";
  text += fmt::format("solids {}, shells {}, faces {}, edges {}\n", facts.solids, facts.shells, facts.faces,
                      facts.edges);
  return text + names_text("parts", facts.parts) + names_text("names of faces", facts.face_names) +
         names_text("layers", facts.layers) + names_text("colours", facts.colours) +
         faces_text(facts.face_table);
}

}  // namespace aeroloom::pipeline
