#include "io/vtk_parts.hpp"

#include "mesh/delivery.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <map>
#include <span>
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

/// The part of each piece, from one row per piece: a function of the mesh alone.
std::vector<std::size_t> assign_parts(const parallel::Communicator& communicator,
                                      const mesh::DistributedMesh& mesh, mesh::GlobalIndex cells_per_part) {
  std::vector<mesh::GlobalIndex> counts;
  for (const mesh::Piece& piece : mesh.pieces) counts.push_back(piece.cell_count());
  std::vector<std::size_t> part_of;
  std::size_t part = 0;
  mesh::GlobalIndex filled = 0;
  for (const mesh::GlobalIndex count : mesh::gather_by_piece(communicator, mesh, counts)) {
    part_of.push_back(part);
    filled += count;
    if (filled >= cells_per_part) ++part, filled = 0;
  }
  return part_of;
}

void pack(const mesh::Piece& piece, const std::vector<mesh::GlobalIndex>& numbers, parallel::Packer& packer) {
  packer.value(piece.id);
  packer.value(piece.region);
  packer.array(piece.coordinates);
  packer.array(numbers);
  packer.array(piece.cells);
  const bool labelled = piece.kind == mesh::CellKind::triangle;
  packer.array(labelled ? piece.triangle_face : std::vector<std::int32_t>{});
  packer.array(labelled ? piece.triangle_patch : std::vector<std::int32_t>{});
}

PartPiece unpack(parallel::Unpacker& unpacker) {
  PartPiece piece;
  piece.id = unpacker.value<mesh::PieceId>();
  piece.region = unpacker.value<std::int32_t>();
  piece.coordinates = unpacker.array<double>();
  piece.numbers = unpacker.array<mesh::GlobalIndex>();
  piece.cells = unpacker.array<mesh::LocalIndex>();
  piece.triangle_face = unpacker.array<std::int32_t>();
  piece.triangle_patch = unpacker.array<std::int32_t>();
  return piece;
}

/// Brings the pieces of parts [first, first + ranks) to their writers: at most one part per rank.
std::vector<PartPiece> bring_parts(const parallel::Communicator& communicator,
                                   const mesh::DistributedMesh& mesh, const mesh::Numbering& numbering,
                                   const std::vector<std::size_t>& part_of, std::size_t first) {
  std::map<parallel::Rank, parallel::Packer> packers;
  for (std::size_t i = 0; i < mesh.pieces.size(); ++i) {
    const std::size_t part = part_of[mesh.pieces[i].id];
    if (part < first || part >= first + communicator.size()) continue;
    pack(mesh.pieces[i], numbering.vertices[i], packers[static_cast<parallel::Rank>(part - first)]);
  }
  std::vector<parallel::Parcel> parcels;
  parcels.reserve(packers.size());
  for (auto& [rank, packer] : packers) parcels.push_back({rank, packer.take()});
  std::vector<PartPiece> pieces;
  for (parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    parallel::Unpacker unpacker(parcel.content);
    while (!unpacker.at_end()) pieces.push_back(unpack(unpacker));
    parcel.content = {};
  }
  std::sort(pieces.begin(), pieces.end(), [](const PartPiece& a, const PartPiece& b) { return a.id < b.id; });
  return pieces;
}

}  // namespace

PartPoints merge_points(const std::vector<PartPiece>& pieces) {
  PartPoints points;
  for (const PartPiece& piece : pieces) {
    auto& places = points.of_piece.emplace_back(piece.numbers.size(), -1);
    for (const mesh::LocalIndex v : piece.cells) places[v] = 0;
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (places[v] == 0) points.numbers.push_back(piece.numbers[v]);
    }
  }
  std::sort(points.numbers.begin(), points.numbers.end());
  points.numbers.erase(std::unique(points.numbers.begin(), points.numbers.end()), points.numbers.end());
  points.coordinates.resize(3 * points.numbers.size());
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    auto& places = points.of_piece[p];
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (places[v] != 0) continue;
      const auto found = std::lower_bound(points.numbers.begin(), points.numbers.end(), pieces[p].numbers[v]);
      places[v] = found - points.numbers.begin();
      std::copy_n(pieces[p].coordinates.begin() + static_cast<std::ptrdiff_t>(3 * v), 3,
                  points.coordinates.begin() + 3 * places[v]);
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
  const std::vector<std::size_t> part_of = assign_parts(communicator, mesh, cells_per_part);
  const std::size_t parts = part_of.empty() ? 0 : part_of.back() + 1;
  for (std::size_t first = 0; first < parts; first += communicator.size()) {
    const std::vector<PartPiece> pieces = bring_parts(communicator, mesh, numbering, part_of, first);
    parallel::agree(communicator, [&] {
      if (!pieces.empty()) write(pieces, files.part_path(part_of[pieces[0].id]));
    });
  }
  return parts;
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
