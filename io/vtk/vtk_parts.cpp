#include "io/vtk/vtk_parts.hpp"

#include "aeroloom/parallel/communication/collective_error.hpp"
#include "io/local_file.hpp"
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

/// The plan for a file, the same on every rank.
struct FilePlan {
  parallel::Rank writer = 0;
  std::size_t round = 0;  ///< the files of this writer before it
};

/// Which part goes into which file, a function of the mesh alone, and who writes that.
struct Plan {
  std::vector<std::size_t> file_of;  ///< per part
  std::vector<FilePlan> files;
  std::size_t rounds = 0;  ///< that the busiest writer takes

  const FilePlan& plan_of(const PartPiece& piece) const { return files[file_of[piece.part.id]]; }
};

/// A part and where it lives.
struct PlaceRow {
  mesh::GlobalIndex items;
  std::int32_t id, rank;

  static constexpr auto fields() { return std::tuple(&PlaceRow::items, &PlaceRow::id, &PlaceRow::rank); }
};

/// The rows of all parts by id.
std::vector<PlaceRow> gather_rows(const parallel::Communicator& communicator,
                                  std::span<const PartPiece> pieces, PartContent content) {
  std::vector<PlaceRow> mine;
  for (const PartPiece& piece : pieces)
    mine.push_back({items_of(piece.part, content), piece.part.id, communicator.rank()});
  auto rows = communicator.all_gather_items(std::span<const PlaceRow>(mine));
  std::sort(rows.begin(), rows.end(), [](const PlaceRow& a, const PlaceRow& b) { return a.id < b.id; });
  return rows;
}

Plan plan_files(const parallel::Communicator& communicator, std::span<const PartPiece> mine,
                PartContent content, mesh::GlobalIndex items_per_file) {
  Plan plan;
  std::vector<std::size_t> rounds(communicator.size(), 0);
  std::map<parallel::Rank, mesh::GlobalIndex> held;  // of the file that is being filled
  mesh::GlobalIndex filled = 0;
  const auto close = [&] {
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    const parallel::Rank writer = std::max_element(held.begin(), held.end(), less)->first;
    plan.files.push_back({writer, rounds[writer]++});
    plan.rounds = std::max(plan.rounds, rounds[writer]);
    held.clear();
    filled = 0;
  };
  for (const PlaceRow& row : gather_rows(communicator, mine, content)) {
    plan.file_of.push_back(plan.files.size());
    held[row.rank] += row.items;
    filled += row.items;
    if (filled >= items_per_file) close();
  }
  if (!held.empty()) close();
  return plan;
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

/// Brings the parts that the files of this round lack on their writers.
std::vector<BroughtPiece> bring_pieces(const parallel::Communicator& communicator,
                                       std::span<const PartPiece> mine, const Plan& plan, std::size_t round) {
  std::map<parallel::Rank, parallel::Packer> packers;
  for (const PartPiece& piece : mine) {
    const FilePlan& file = plan.plan_of(piece);
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

/// The parts of this rank's file of a round, ascending; none where its files are written.
std::vector<PartPiece> pieces_of_round(const parallel::Communicator& communicator,
                                       std::span<const PartPiece> mine, const Plan& plan, std::size_t round,
                                       const std::vector<BroughtPiece>& brought) {
  std::vector<PartPiece> pieces;
  for (const PartPiece& piece : mine) {
    const FilePlan& file = plan.plan_of(piece);
    if (file.round == round && file.writer == communicator.rank()) pieces.push_back(piece);
  }
  for (const BroughtPiece& other : brought) pieces.push_back(view(other));
  std::sort(pieces.begin(), pieces.end(),
            [](const PartPiece& a, const PartPiece& b) { return a.part.id < b.part.id; });
  return pieces;
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
  parallel::agree(communicator, [&] {
    if (communicator.is_root()) prepare_folder(files);
  });
  const Plan plan = plan_files(communicator, mine, content, items_per_file);
  parallel::Progress progress("output", static_cast<std::int64_t>(plan.rounds), "files");
  for (std::size_t round = 0; round < plan.rounds; ++round) {
    const std::vector<BroughtPiece> brought = bring_pieces(communicator, mine, plan, round);
    const std::vector<PartPiece> pieces = pieces_of_round(communicator, mine, plan, round, brought);
    parallel::agree(communicator, [&] {
      if (!pieces.empty()) write(pieces, files.part_path(plan.file_of[pieces[0].part.id]));
    });
    progress.advance(1, pieces.empty() ? 0 : 1);
  }
  return plan.files.size();
}

void write_index(const parallel::Communicator& communicator, const std::string& path,
                 const std::string& text) {
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
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
