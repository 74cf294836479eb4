/// A volume that was filled, and what any must be like.
#pragma once

#include "mesh/checks/validity.hpp"
#include "mesh/data/mixing.hpp"
#include "parallel/observation/log.hpp"
#include "tests/volume/steps.hpp"
#include "volume/filling/decomposition_data.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::volume {

/// Silences the stage: what it does is checked, not read.
class Quiet : public testing::Environment {
  void SetUp() override {
    parallel::configure_log(parallel::Communicator::world(), parallel::LogLevel::quiet);
  }
};
inline const testing::Environment* const quiet = testing::AddGlobalTestEnvironment(new Quiet);

/// Runs both halves of the stage; `change` may do something in between.
struct Filled {
  using Change = std::function<void(const Problem&, Decomposition::Data&)>;
  Filled(const parallel::Communicator& communicator, const surfaces::Surface& surface,
         const sizing::SizeField& field, VolumeOptions options = {}, const Change& change = {})
      : problem(communicator, surface, field, options) {
    Decomposition decomposition = decompose(problem.input());
    if (change) change(problem, decomposition.data());
    decomposed = decomposition.report();
    mesh = mesh::number_mesh(fill_zones(problem.input(), std::move(decomposition), report));
  }

  Problem problem;
  DecompositionReport decomposed;
  VolumeReport report;
  mesh::NumberedMesh mesh;
};

/// The places of vertices, each once, over all ranks.
inline std::int64_t count_places(const Filled& filled) {
  std::vector<geometry::Vec3> mine;
  for (const mesh::Piece& piece : filled.mesh.pieces) {
    for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) mine.push_back(piece.point(v));
  }
  auto all = filled.problem.communicator.all_gather_items<geometry::Vec3>(mine);
  std::sort(all.begin(), all.end(), [](geometry::Vec3 a, geometry::Vec3 b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
  });
  return std::unique(all.begin(), all.end()) - all.begin();
}

/// Valid, with the surface as its boundary, the volume it encloses, and one vertex at each place.
inline void expect_valid(const Filled& filled, const surfaces::Surface& surface) {
  const mesh::ValidityReport validity = mesh::check_volume_mesh(filled.mesh, &filled.problem.surface);
  for (const std::string& violation : validity.violations) ADD_FAILURE() << violation;
  for (mesh::RegionId region = 0; region < surfaces::region_count(surface); ++region) {
    const double expected = surfaces::volume(surface, region);
    ASSERT_LT(static_cast<std::size_t>(region), validity.region_volumes.size());
    EXPECT_NEAR(validity.region_volumes[region] / expected, 1, 1e-8) << "region " << region;
  }
  EXPECT_EQ(filled.mesh.numbering.vertex_count, count_places(filled));
}

/// What names each cell by the bits of its corners' coordinates, ascending, on every rank.
inline std::vector<std::uint64_t> cells_by_coordinates(const Filled& filled) {
  std::vector<std::uint64_t> mine;
  for (const mesh::Piece& piece : filled.mesh.pieces) {
    for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
      std::array<std::array<double, 3>, 4> corners;
      for (int k = 0; k < 4; ++k) {
        const geometry::Vec3 p = piece.point(piece.cell(c)[k]);
        corners[k] = {p.x, p.y, p.z};
      }
      std::sort(corners.begin(), corners.end());
      auto mixed = static_cast<std::uint64_t>(piece.region);
      for (const auto& corner : corners) {
        for (const double x : corner) mixed = mesh::mix_in(mixed, std::bit_cast<std::uint64_t>(x));
      }
      mine.push_back(mixed);
    }
  }
  auto all = filled.problem.communicator.all_gather_items<std::uint64_t>(mine);
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace aeroloom::volume
