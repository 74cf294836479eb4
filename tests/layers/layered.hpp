/// Walls with columns as a test wants them, and the volume that is filled beyond their cap.
#pragma once

#include "improve/improver.hpp"
#include "layers/column_heights.hpp"
#include "layers/layer_cells.hpp"
#include "mesh/checks/validity.hpp"
#include "parallel/observation/log.hpp"
#include "tests/meshes/surfaces.hpp"
#include "tests/volume/fields.hpp"
#include "volume/volume_mesher.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::layers {

/// Silences the stages: what they do is checked, not read.
class QuietLayers : public testing::Environment {
  void SetUp() override {
    parallel::configure_log(parallel::Communicator::world(), parallel::LogLevel::quiet);
  }
};
inline const testing::Environment* const quiet = testing::AddGlobalTestEnvironment(new QuietLayers);

/// The column of a vertex on the faces that bear layers.
struct WantedColumn {
  geometry::Vec3 direction;
  std::int32_t count = 0;
};
using ColumnAt = std::function<WantedColumn(geometry::Vec3)>;

/// A surface whose face `wall_face` is a wall, all others of another type; columns on the wall's vertices.
struct Layered {
  Layered(const parallel::Communicator& ranks, const volume::surfaces::Surface& surface,
          std::int32_t wall_face, mesh::PatchType others)
      : communicator(ranks) {
    static_cast<mesh::DistributedMesh&>(wall) = volume::surfaces::spread(ranks, surface);
    wall.patches = {"wall", "others"};
    wall.patch_types = {mesh::PatchType::wall, others};
    for (mesh::Piece& piece : wall.pieces) {
      for (std::size_t t = 0; t < piece.triangle_face.size(); ++t)
        piece.triangle_patch[t] = piece.triangle_face[t] == wall_face ? 0 : 1;
    }
    wall = mesh::number_mesh(std::move(wall));
  }

  /// Heights are `first`, twice, then half as much again each. Vertices with a direction that is not zero
  /// have columns.
  void grow(double first, const ColumnAt& column_at) {
    mesh::DistributedMesh moved = wall;
    columns.pieces.clear();
    for (mesh::Piece& end : moved.pieces) {
      const mesh::Piece piece = end;
      PieceColumns& of_piece = columns.pieces.emplace_back();
      for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        const WantedColumn column = column_at(piece.point(v));
        of_piece.directions.push_back(column.direction);
        of_piece.counts.push_back(column.count);
        of_piece.constant.push_back(2);
        of_piece.first.push_back(first);
        of_piece.growth.push_back(1.5);
        of_piece.regular.push_back(most_layers);
        of_piece.stretch.push_back(1);
        of_piece.first_column.push_back(v);
      }
      of_piece.first_column.push_back(piece.vertex_count());
      for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t)
        of_piece.corner_columns.push_back({piece.cell(t)[0], piece.cell(t)[1], piece.cell(t)[2]});
      for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v)
        end.set_point(v, node(piece, of_piece, v, of_piece.counts[v]));
    }
    cap = mesh::number_mesh(std::move(moved));
  }

  /// Tetrahedra beyond the cap, improved, and the layers before it.
  void fill(const sizing::SizeField& field, std::int64_t most_cells_per_piece,
            volume::VolumeOptions options = {}) {
    volume::VolumeReport report;
    const sizing::SizedSurface boundary{cap, field};
    const volume::VolumeInput input{boundary, options, nullptr, true};
    mesh::DistributedMesh volume = volume::fill_zones(input, volume::decompose(input), report);
    improve::ImproveOptions improvement;
    improvement.boundary_may_change = false;
    improved = improve::improve_mesh(volume, improvement, {nullptr, &field});
    tetrahedra = 0;
    for (const mesh::Piece& piece : volume.pieces) tetrahedra += piece.cell_count();
    tetrahedra = communicator.sum(tetrahedra);
    append_layers(wall, columns, cap, {most_cells_per_piece, elements}, volume);
    mesh = mesh::number_mesh(std::move(volume));
  }

  std::string hash() const { return mesh::hash_mesh(mesh); }

  parallel::Communicator communicator;
  mesh::NumberedMesh wall;
  Columns columns;
  mesh::NumberedMesh cap, mesh;
  improve::ImproveReport improved;
  LayerElements elements = LayerElements::prisms;
  std::int64_t tetrahedra = 0;  ///< beyond the cap
};

}  // namespace aeroloom::layers
