#include "io/vtk/vtk_parts.hpp"

#include "io/local_file.hpp"
#include "io/vtk/file_plan.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/progress.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>
#include <system_error>
#include <tuple>
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

mesh::GlobalIndex items_of(const FilePart& part, PartContent content) {
  return content == PartContent::cells ? part.cell_count() : part.face_count();
}

/// The blocks of a part that go into the files.
std::span<const Block> blocks_of(const FilePart& part, PartContent content) {
  if (content == PartContent::cells) return part.cells;
  return part.faces;
}

/// The items of a part in corners.
mesh::GlobalIndex work_of(const FilePart& part, PartContent content) {
  mesh::GlobalIndex corners = 0;
  for (const Block& block : blocks_of(part, content))
    corners += static_cast<mesh::GlobalIndex>(block.count()) * block.corners;
  return corners;
}

/// Collective.
FilePlan plan_for(const parallel::Communicator& communicator, std::span<const PartPiece> mine,
                  PartContent content, mesh::GlobalIndex items_per_file) {
  std::vector<PartPlace> places;
  for (const PartPiece& piece : mine) {
    places.push_back({.id = piece.part.id,
                      .rank = communicator.rank(),
                      .items = items_of(piece.part, content),
                      .work = work_of(piece.part, content)});
  }
  auto all = communicator.gather_sorted(places, &PartPlace::id);
  return plan_files(all, items_per_file, communicator.size());
}

/// The arrays of a part that travel.
template <template <class> class Array>
struct PieceArrays {
  struct Items {
    Array<mesh::LocalIndex> connectivity;
    Array<Run> runs;
    Array<mesh::LocalIndex> order;

    static constexpr auto fields() { return std::tuple(&Items::connectivity, &Items::runs, &Items::order); }
  };
  std::int32_t id = 0;
  Array<double> coordinates;
  Array<mesh::GlobalIndex> numbers;
  std::array<Items, cell_shape_count> cells;
  std::array<Items, face_shape_count> faces;
  Array<std::int32_t> triangle_face, triangle_patch;
  Array<std::int16_t> layers;

  static constexpr auto fields() {
    return std::tuple(&PieceArrays::id, &PieceArrays::coordinates, &PieceArrays::numbers, &PieceArrays::cells,
                      &PieceArrays::faces, &PieceArrays::triangle_face, &PieceArrays::triangle_patch,
                      &PieceArrays::layers);
  }
};

/// A part of this rank.
template <class T>
using View = std::span<const T>;

PieceArrays<View> arrays_of(const PartPiece& piece) {
  PieceArrays<View> arrays;
  arrays.id = piece.part.id;
  arrays.coordinates = piece.part.coordinates;
  arrays.numbers = piece.part.numbers;
  const auto items_of = [](const Block& block) -> PieceArrays<View>::Items {
    return {block.connectivity, block.runs, block.order};
  };
  std::transform(piece.part.cells.begin(), piece.part.cells.end(), arrays.cells.begin(), items_of);
  std::transform(piece.part.faces.begin(), piece.part.faces.end(), arrays.faces.begin(), items_of);
  arrays.triangle_face = piece.triangle_face;
  arrays.triangle_patch = piece.triangle_patch;
  arrays.layers = piece.part.layers;
  return arrays;
}

/// A part that came from another rank. Its arrays stay where they are when it moves.
template <class T>
using List = std::vector<T>;
using BroughtPiece = PieceArrays<List>;

PartPiece view(const BroughtPiece& brought) {
  PartPiece piece;
  piece.part.id = brought.id;
  piece.part.coordinates = brought.coordinates;
  piece.part.numbers = brought.numbers;
  for (const CellShape shape : cell_shapes) {
    const auto& items = brought.cells[static_cast<std::size_t>(shape)];
    piece.part.cells[static_cast<std::size_t>(shape)] = {corners_of(shape), items.connectivity, items.runs, 0,
                                                         items.order};
  }
  for (const FaceShape shape : face_shapes) {
    const auto& items = brought.faces[static_cast<std::size_t>(shape)];
    piece.part.faces[static_cast<std::size_t>(shape)] = {corners_of(shape), items.connectivity, items.runs, 0,
                                                         items.order};
  }
  piece.triangle_face = brought.triangle_face;
  piece.triangle_patch = brought.triangle_patch;
  piece.part.layers = brought.layers;
  return piece;
}

/// Brings the parts that the files of this round lack on their writers. Collective.
std::vector<BroughtPiece> bring_pieces(const parallel::Communicator& communicator,
                                       std::span<const PartPiece> mine, const FilePlan& plan,
                                       std::size_t round) {
  std::map<parallel::Rank, parallel::Packer> packers;
  for (const PartPiece& piece : mine) {
    const PlannedFile& file = plan.plan_of(piece.part.id);
    if (file.round == round && file.writer != communicator.rank())
      parallel::pack(packers[file.writer], arrays_of(piece));
  }
  std::vector<parallel::Parcel> parcels;
  parcels.reserve(packers.size());
  for (auto& [rank, packer] : packers) parcels.push_back({rank, packer.take()});
  std::vector<BroughtPiece> pieces;
  for (parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    parallel::Unpacker unpacker(parcel.content);
    while (!unpacker.at_end()) pieces.push_back(parallel::unpack<BroughtPiece>(unpacker));
    parallel::Bytes().swap(parcel.content);
  }
  return pieces;
}

/// The files of a round by number, and the parts of each, ascending.
using PiecesOfFiles = std::map<std::size_t, std::vector<PartPiece>>;

/// Of this rank: those that it holds, and those that were brought.
PiecesOfFiles pieces_of_round(parallel::Rank rank, std::span<const PartPiece> mine, const FilePlan& plan,
                              std::size_t round, const std::vector<BroughtPiece>& brought) {
  PiecesOfFiles files;
  const auto add = [&](const PartPiece& piece) {
    const std::size_t file = plan.file_of[static_cast<std::size_t>(piece.part.id)];
    if (plan.files[file].writer == rank && plan.files[file].round == round) files[file].push_back(piece);
  };
  std::for_each(mine.begin(), mine.end(), add);
  for (const BroughtPiece& other : brought) add(view(other));
  for (auto& [file, pieces] : files) {
    std::sort(pieces.begin(), pieces.end(),
              [](const PartPiece& a, const PartPiece& b) { return a.part.id < b.part.id; });
  }
  return files;
}

}  // namespace

std::vector<PartPiece> pieces_of(const FileMesh& mesh) {
  std::vector<PartPiece> pieces;
  for (const FilePart& part : mesh.parts) pieces.push_back({part, {}, {}});
  return pieces;
}

// Numbers tell which vertices of several parts are one: the first use of each makes the point.
PartPoints merge_points(const std::vector<PartPiece>& pieces, PartContent content) {
  PartPoints points;
  std::vector<std::pair<mesh::GlobalIndex, std::size_t>> uses;
  for (const PartPiece& piece : pieces) {
    auto& places = points.of_piece.emplace_back(piece.part.numbers.size(), -1);
    for (const Block& block : blocks_of(piece.part, content)) {
      for (const mesh::LocalIndex v : block.connectivity) places[v] = 0;
    }
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (places[v] == 0) uses.emplace_back(piece.part.numbers[v], uses.size());
    }
  }
  if (uses.size() > static_cast<std::size_t>(std::numeric_limits<PointIndex>::max()))
    throw std::length_error("a file would get more points than its 32-bit numbers can count");
  std::sort(uses.begin(), uses.end());
  std::vector<std::size_t> first_use(uses.size());
  for (std::size_t i = 0, first = 0; i < uses.size(); ++i) {
    if (uses[i].first != uses[first].first) first = i;
    first_use[uses[i].second] = uses[first].second;
  }
  std::vector<PointIndex> place_of(uses.size());
  std::size_t use = 0;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (std::size_t v = 0; v < points.of_piece[p].size(); ++v) {
      PointIndex& place = points.of_piece[p][v];
      if (place < 0) continue;
      if (first_use[use] == use) {
        place_of[use] = static_cast<PointIndex>(points.numbers.size());
        points.numbers.push_back(pieces[p].part.numbers[v]);
        const auto point = pieces[p].part.coordinates.begin() + static_cast<std::ptrdiff_t>(3 * v);
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
std::vector<std::string> PartFiles::part_sources(std::size_t parts) const {
  std::vector<std::string> sources;
  for (std::size_t i = 0; i < parts; ++i) sources.push_back(part_source(i));
  return sources;
}
std::string PartFiles::part_path(std::size_t part) const {
  return (fs::path(directory) / part_source(part)).string();
}

std::size_t write_parts(const parallel::Communicator& communicator, std::span<const PartPiece> mine,
                        PartContent content, mesh::GlobalIndex items_per_file, const PartFiles& files,
                        const PartWriter& write) {
  parallel::on_root(communicator, [&] { prepare_folder(files); });
  const FilePlan plan = plan_for(communicator, mine, content, items_per_file);
  const auto of_this_rank = [&](const PlannedFile& file) { return file.writer == communicator.rank(); };
  parallel::Progress progress("output", std::count_if(plan.files.begin(), plan.files.end(), of_this_rank),
                              "files");
  const auto write_round = [&](std::size_t round, const std::vector<BroughtPiece>& brought) {
    parallel::agree(communicator, [&] {
      for (const auto& [file, pieces] : pieces_of_round(communicator.rank(), mine, plan, round, brought)) {
        write(pieces, files.part_path(file));
        progress.advance(1, 1);
      }
    });
  };
  for (std::size_t round = 0; round < plan.rounds; ++round)
    write_round(round, bring_pieces(communicator, mine, plan, round));
  write_round(PlannedFile::no_round, {});
  return plan.files.size();
}

void write_index(const parallel::Communicator& communicator, const std::string& path,
                 const std::string& text) {
  parallel::on_root(communicator, [&] {
    const std::string unfinished = path + ".unfinished";
    try {
      LocalFile file(unfinished);
      file.text(text);
      file.finish();
      fs::rename(unfinished, path);
    } catch (const fs::filesystem_error& error) {
      std::error_code ignored;
      fs::remove(unfinished, ignored);
      throw fs::filesystem_error("cannot write", path, error.code());
    }
  });
}

}  // namespace aeroloom::io
