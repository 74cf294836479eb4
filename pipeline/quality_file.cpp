#include "pipeline/quality_file.hpp"

#include "mesh/quality/mixed_quality.hpp"
#include "mesh/quality/solver_quality.hpp"
#include "parallel/communication/collective_error.hpp"
#include "pipeline/info_text.hpp"
#include "pipeline/report/mixed_quality_json.hpp"
#include "pipeline/report/mixed_quality_text.hpp"
#include "pipeline/report/solver_quality_json.hpp"
#include "pipeline/report/text_file.hpp"

#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::ordered_json;

constexpr int quality_schema_version = 1;

Json mesh_json(const io::FileMesh& mesh, const mesh::MixedQuality& quality) {
  return {{"points", mesh.vertex_count},
          {"cells", mesh.cell_count()},
          {"tetrahedra", mesh.cell_count(mesh::CellShape::tetrahedron)},
          {"pyramids", mesh.cell_count(mesh::CellShape::pyramid)},
          {"prisms", mesh.cell_count(mesh::CellShape::prism)},
          {"hexahedra", mesh.cell_count(mesh::CellShape::hexahedron)},
          {"boundary_triangles", mesh.boundary_count(mesh::FaceShape::triangle)},
          {"boundary_quadrilaterals", mesh.boundary_count(mesh::FaceShape::quadrilateral)},
          {"volume", quality.volume}};
}

Json regions_json(const io::FileMesh& mesh, const mesh::MixedQuality& quality) {
  Json json = Json::array();
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) {
    json.push_back({{"name", mesh.regions[r]},
                    {"volume", quality.region_volumes[r]},
                    {"tetrahedra", mesh.region_cells[r][0]},
                    {"pyramids", mesh.region_cells[r][1]},
                    {"prisms", mesh.region_cells[r][2]},
                    {"hexahedra", mesh.region_cells[r][3]}});
  }
  return json;
}

Json patches_json(const io::FileMesh& mesh, const mesh::MixedQuality& quality) {
  Json json = Json::array();
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    json.push_back({{"name", mesh.patches[p].name},
                    {"type", name_of(mesh.patches[p].type)},
                    {"area", quality.patch_areas[p]},
                    {"triangles", mesh.patch_faces[p][0]},
                    {"quadrilaterals", mesh.patch_faces[p][1]}});
  }
  return json;
}

struct FileQuality {
  mesh::MixedQuality cells;
  mesh::SolverQuality solver;
};

/// Collective.
FileQuality measure(const mesh::NumberedMesh& pieces) {
  const mesh::FaceLinks links = mesh::link_faces(pieces);
  FileQuality quality{mesh::measure_quality(pieces, links), mesh::measure_as_solvers(pieces, links)};
  mesh::add_faces(quality.solver, quality.cells.places);
  return quality;
}

Json report_json(const std::string& path, const io::Assembled& file, const FileQuality& measured,
                 const io::DoubledNodes& doubled, const std::string& missed) {
  const mesh::MixedQuality& quality = measured.cells;
  const mesh::LinkDefects& defects = quality.defects;
  return {{"schema_version", quality_schema_version},
          {"file", path},
          {"mesh", mesh_json(file.mesh, quality)},
          {"regions", regions_json(file.mesh, quality)},
          {"patches", patches_json(file.mesh, quality)},
          {"reading",
           {{"turned_cells", file.turned_cells},
            {"dropped_points", file.dropped_points},
            {"unnamed_faces", file.unnamed_faces},
            {"left_out_faces", file.left_out_faces}}},
          {"defects",
           {{"crowded_faces", defects.crowded_faces},
            {"stray_faces", defects.stray_faces},
            {"repeated_faces", defects.repeated_faces},
            {"open_faces", defects.open_faces}}},
          {"doubled_nodes", doubled_nodes_json(doubled)},
          {"quality", report::to_json(quality)},
          {"solver", report::to_json(measured.solver)},
          {"gate", {{"passed", missed.empty()}, {"missed", missed}}}};
}

/// A name in a file may be no UTF-8, which JSON cannot hold: its letters are replaced.
std::string dump(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string show_quality(const io::Assembled& file, const QualityRequest& request,
                         const cases::QualityGate& gate) {
  const mesh::NumberedMesh& pieces = *file.mesh.pieces;
  const FileQuality quality = measure(pieces);
  const io::DoubledNodes doubled = io::find_doubled_nodes(file.mesh);
  std::string missed = cases::missed_limits(gate, quality.cells, quality.solver);
  parallel::on_root(pieces.communicator, [&] {
    const std::string json = dump(report_json(request.file, file, quality, doubled, missed));
    if (!request.json_file.empty()) report::write_text(request.json_file, json);
    if (request.print_json) {
      fmt::print("{}", json);
    } else {
      fmt::print("'{}': {}\n{}{}", request.file, io::describe(file),
                 doubled.nodes == 0 ? "" : io::describe(doubled) + "\n",
                 report::quality_text(file.mesh, quality.cells, quality.solver));
    }
    std::fflush(stdout);
  });
  return missed;
}

}  // namespace aeroloom::pipeline
