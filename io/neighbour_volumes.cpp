#include "io/neighbour_volumes.hpp"

#include "io/cell_measures.hpp"
#include "mesh/delivery.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

namespace aeroloom::io {

namespace {

using mesh::LocalIndex;
using parallel::Rank;

/// Tells a cell the volume of its neighbour.
struct VolumeMessage {
  std::int32_t part;
  LocalIndex cell;
  double volume;

  static constexpr auto fields() {
    return std::tuple(&VolumeMessage::part, &VolumeMessage::cell, &VolumeMessage::volume);
  }
};

/// The rank of each part. Collective.
std::vector<Rank> ranks_of_parts(const parallel::Communicator& communicator, const FileMesh& mesh) {
  struct Row {
    std::int32_t part;
    Rank rank;

    static constexpr auto fields() { return std::tuple(&Row::part, &Row::rank); }
  };
  std::vector<Row> mine;
  for (const FilePart& part : mesh.parts) mine.push_back({part.id, communicator.rank()});
  std::vector<Rank> ranks(static_cast<std::size_t>(mesh.part_count), 0);
  for (const Row& row : communicator.all_gather_items(std::span<const Row>(mine)))
    ranks[static_cast<std::size_t>(row.part)] = row.rank;
  return ranks;
}

std::vector<double> volumes_of(const FilePart& part) {
  std::vector<double> volumes(static_cast<std::size_t>(part.cell_count()));
  std::array<geometry::Vec3, 6> corners;
  for (LocalIndex c = 0; c < part.cell_count(); ++c) {
    const CellOfPart cell = cell_of(part, c);
    corners_of_cell(part, cell, corners.data());
    volumes[static_cast<std::size_t>(c)] = cell_volume(cell.shape, corners.data());
  }
  return volumes;
}

/// Places of parts on this rank, -1 for all others.
std::vector<std::ptrdiff_t> places_here(const FileMesh& mesh) {
  std::vector<std::ptrdiff_t> places(static_cast<std::size_t>(mesh.part_count), -1);
  for (std::size_t i = 0; i < mesh.parts.size(); ++i)
    places[static_cast<std::size_t>(mesh.parts[i].id)] = static_cast<std::ptrdiff_t>(i);
  return places;
}

}  // namespace

int corners_of_cell(const FilePart& part, CellOfPart cell, geometry::Vec3* corners) {
  const Block& block = part.cells[static_cast<std::size_t>(cell.shape)];
  const LocalIndex* v = block.item(cell.index);
  for (int k = 0; k < block.corners; ++k) corners[k] = part.point(v[k]);
  return block.corners;
}

NeighbourVolumes compare_volumes(const parallel::Communicator& communicator, const FileMesh& mesh,
                                 const FaceLinks& links) {
  NeighbourVolumes result;
  for (const FilePart& part : mesh.parts) {
    result.volumes.push_back(volumes_of(part));
    result.ratios.emplace_back(result.volumes.back().size(), 0.0);
  }
  const std::vector<Rank> rank_of = ranks_of_parts(communicator, mesh);
  const std::vector<std::ptrdiff_t> place_of = places_here(mesh);
  const auto meet = [&](std::size_t part, LocalIndex cell, double other) {
    double& ratio = result.ratios[part][static_cast<std::size_t>(cell)];
    ratio = std::max(ratio, volume_ratio(result.volumes[part][static_cast<std::size_t>(cell)], other));
  };
  std::vector<VolumeMessage> messages;
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const FilePart& part = mesh.parts[i];
    const std::vector<CellBehind>& behind = links.parts[i].behind;
    std::size_t side = 0;
    for (LocalIndex c = 0; c < part.cell_count(); ++c) {
      const std::size_t end = side + faces_of(cell_of(part, c).shape).size();
      for (; side < end; ++side) {
        const CellBehind& other = behind[side];
        if (!other.exists()) continue;
        const std::ptrdiff_t here = place_of[static_cast<std::size_t>(other.part)];
        if (here >= 0) {
          meet(i, c, result.volumes[static_cast<std::size_t>(here)][static_cast<std::size_t>(other.cell)]);
        } else {
          messages.push_back({other.part, other.cell, result.volumes[i][static_cast<std::size_t>(c)]});
        }
      }
    }
  }
  for (const VolumeMessage& message :
       mesh::deliver(communicator, std::move(messages),
                     [&](const VolumeMessage& m) { return rank_of[static_cast<std::size_t>(m.part)]; })) {
    meet(static_cast<std::size_t>(place_of[static_cast<std::size_t>(message.part)]), message.cell,
         message.volume);
  }
  return result;
}

}  // namespace aeroloom::io
