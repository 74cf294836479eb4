#include "io/vtk/vtk_parts.hpp"

#include "mesh/delivery.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

/// Whether a file name is NAME_<digits>.EXTENSION, as part_source makes them.
bool is_part_name(const std::string& file, const PartFiles& files) {
  const std::string prefix = files.name + "_", suffix = "." + files.part_extension;
  if (!file.starts_with(prefix) || !file.ends_with(suffix) || file.size() <= prefix.size() + suffix.size()) {
    return false;
  }
  return std::all_of(file.begin() + static_cast<std::ptrdiff_t>(prefix.size()),
                     file.end() - static_cast<std::ptrdiff_t>(suffix.size()),
                     [](char letter) { return letter >= '0' && letter <= '9'; });
}

/// Leaves an empty place: a run that stops half way must not look like an earlier, complete one.
void prepare_folder(const PartFiles& files) {
  const fs::path folder = fs::path(files.directory) / files.name;
  fs::create_directories(folder);
  fs::remove(files.index_path());
  std::vector<fs::path> stale;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_part_name(entry.path().filename().string(), files)) stale.push_back(entry.path());
  }
  for (const fs::path& file : stale) fs::remove(file);
}

/// What becomes of a part, the same on every rank.
struct PartPlan {
  parallel::Rank writer = 0;
  std::size_t turn = 0;  ///< the parts of this writer before it
};

/// Which piece goes into which part, a function of the mesh alone, and who writes that.
struct Plan {
  std::vector<std::size_t> part_of;  ///< per piece
  std::vector<PartPlan> parts;
  std::size_t turns = 0;  ///< that the busiest writer takes
};

Plan plan_parts(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                mesh::GlobalIndex cells_per_part) {
  struct Row {
    mesh::GlobalIndex cells;
    std::int64_t rank;
  };
  std::vector<Row> mine;
  for (const mesh::Piece& piece : mesh.pieces) mine.push_back({piece.cell_count(), communicator.rank()});
  Plan plan;
  std::vector<std::size_t> turns(communicator.size(), 0);
  std::map<parallel::Rank, mesh::GlobalIndex> held;  // of the part that is being filled
  mesh::GlobalIndex filled = 0;
  const auto close = [&] {
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    const parallel::Rank writer = std::max_element(held.begin(), held.end(), less)->first;
    plan.parts.push_back({writer, turns[writer]++});
    plan.turns = std::max(plan.turns, turns[writer]);
    held.clear();
    filled = 0;
  };
  for (const Row& row : mesh::gather_by_piece(communicator, mesh, mine)) {
    plan.part_of.push_back(plan.parts.size());
    held[static_cast<parallel::Rank>(row.rank)] += row.cells;
    filled += row.cells;
    if (filled >= cells_per_part) close();
  }
  if (!held.empty()) close();
  return plan;
}

PartPiece view(const mesh::Piece& piece, const std::vector<mesh::GlobalIndex>& numbers) {
  PartPiece result{piece.id, piece.region, piece.coordinates, numbers, piece.cells, {}, {}};
  if (piece.kind != mesh::CellKind::triangle) return result;
  result.triangle_face = piece.triangle_face;
  result.triangle_patch = piece.triangle_patch;
  return result;
}

/// A piece that came from another rank.
struct BroughtPiece {
  mesh::Piece piece;
  std::vector<mesh::GlobalIndex> numbers;
};

/// Brings the pieces that the parts of this turn lack on their writers.
std::vector<BroughtPiece> bring_pieces(const parallel::Communicator& communicator,
                                       const mesh::DistributedMesh& mesh, const mesh::Numbering& numbering,
                                       const Plan& plan, std::size_t turn) {
  std::map<parallel::Rank, parallel::Packer> packers;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const PartPlan& part = plan.parts[plan.part_of[mesh.pieces[i].id]];
    if (part.turn != turn || part.writer == communicator.rank()) continue;
    packers[part.writer].array(mesh::pack_piece(mesh.pieces[i]));
    packers[part.writer].array(numbering.vertices[i]);
  }
  std::vector<parallel::Parcel> parcels;
  parcels.reserve(packers.size());
  for (auto& [rank, packer] : packers) parcels.push_back({rank, packer.take()});
  std::vector<BroughtPiece> pieces;
  for (parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    parallel::Unpacker unpacker(parcel.content);
    while (!unpacker.at_end()) {
      BroughtPiece& brought = pieces.emplace_back();
      brought.piece = mesh::unpack_piece(unpacker.array<std::byte>());
      brought.numbers = unpacker.array<mesh::GlobalIndex>();
    }
    parcel.content = {};
  }
  return pieces;
}

/// The pieces of this rank's part of a turn, ascending; none where its parts are written.
std::vector<PartPiece> pieces_of_turn(const parallel::Communicator& communicator,
                                      const mesh::DistributedMesh& mesh, const mesh::Numbering& numbering,
                                      const Plan& plan, std::size_t turn,
                                      const std::vector<BroughtPiece>& brought) {
  std::vector<PartPiece> pieces;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const PartPlan& part = plan.parts[plan.part_of[mesh.pieces[i].id]];
    if (part.turn == turn && part.writer == communicator.rank())
      pieces.push_back(view(mesh.pieces[i], numbering.vertices[i]));
  }
  for (const BroughtPiece& other : brought) pieces.push_back(view(other.piece, other.numbers));
  std::sort(pieces.begin(), pieces.end(), [](const PartPiece& a, const PartPiece& b) { return a.id < b.id; });
  return pieces;
}

}  // namespace

// Numbers tell which vertices of several pieces are one: the first use of each makes the point.
PartPoints merge_points(const std::vector<PartPiece>& pieces) {
  PartPoints points;
  std::vector<std::pair<mesh::GlobalIndex, std::size_t>> uses;
  for (const PartPiece& piece : pieces) {
    auto& places = points.of_piece.emplace_back(piece.numbers.size(), -1);
    for (const mesh::LocalIndex v : piece.cells) places[v] = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (places[v] == 0) uses.emplace_back(piece.numbers[v], uses.size());
    }
  }
  if (uses.size() > static_cast<std::size_t>(std::numeric_limits<PartIndex>::max()))
    throw std::length_error("a file would get more points than its 32-bit numbers can count");
  std::sort(uses.begin(), uses.end());
  std::vector<std::size_t> first_use(uses.size());
  for (std::size_t i = 0, first = 0; i < uses.size(); ++i) {
    if (uses[i].first != uses[first].first) first = i;
    first_use[uses[i].second] = uses[first].second;
  }
  std::vector<PartIndex> place_of(uses.size());
  std::size_t use = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (std::size_t v = 0; v < points.of_piece[p].size(); ++v) {
      PartIndex& place = points.of_piece[p][v];
      if (place < 0) continue;
      if (first_use[use] == use) {
        place_of[use] = static_cast<PartIndex>(points.numbers.size());
        points.numbers.push_back(pieces[p].numbers[v]);
        const auto point = pieces[p].coordinates.begin() + static_cast<std::ptrdiff_t>(3 * v);
        points.coordinates.insert(points.coordinates.end(), point, point + 3);
      }
      place = place_of[first_use[use++]];
    }
  }
  return points;
}

std::string PartFiles::index_path() const {
  return (fs::path(directory) / (name + "." + index_extension)).string();
}
std::string PartFiles::part_source(std::size_t part) const {
  return fmt::format("{0}/{0}_{1:06}.{2}", name, part, part_extension);
}
std::string PartFiles::part_path(std::size_t part) const {
  return (fs::path(directory) / part_source(part)).string();
}

std::size_t write_parts(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                        const mesh::Numbering& numbering, mesh::GlobalIndex cells_per_part,
                        const PartFiles& files, const PartWriter& write) {
  parallel::agree(communicator, [&] {
    if (communicator.is_root()) prepare_folder(files);
  });
  const Plan plan = plan_parts(communicator, mesh, cells_per_part);
  for (std::size_t turn = 0; turn < plan.turns; ++turn) {
    const std::vector<BroughtPiece> brought = bring_pieces(communicator, mesh, numbering, plan, turn);
    const std::vector<PartPiece> pieces = pieces_of_turn(communicator, mesh, numbering, plan, turn, brought);
    parallel::agree(communicator, [&] {
      if (!pieces.empty()) write(pieces, files.part_path(plan.part_of[pieces[0].id]));
    });
  }
  return plan.parts.size();
}

void write_index(const parallel::Communicator& communicator, const std::string& path,
                 const std::string& text) {
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    errno = 0;
    std::ofstream stream(path, std::ios::binary);
    stream << text;
    stream.close();
    if (!stream)
      throw fs::filesystem_error("cannot write", path, std::error_code(errno, std::generic_category()));
  });
}

}  // namespace aeroloom::io
