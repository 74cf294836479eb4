#include "io/vtk/indexed_files.hpp"

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
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace fs = std::filesystem;

namespace {

/// Whether a file name is NAME_<digits>.EXTENSION, as file_source makes them.
bool is_file_name(const std::string& file, const IndexedFiles& files) {
  const std::string prefix = files.name + "_", suffix = "." + files.file_extension;
  if (!file.starts_with(prefix) || !file.ends_with(suffix) || file.size() <= prefix.size() + suffix.size()) {
    return false;
  }
  return std::all_of(file.begin() + static_cast<std::ptrdiff_t>(prefix.size()),
                     file.end() - static_cast<std::ptrdiff_t>(suffix.size()),
                     [](char letter) { return letter >= '0' && letter <= '9'; });
}

/// Leaves an empty place: a run that stops half way must not look like an earlier, complete one.
void prepare_folder(const IndexedFiles& files) {
  const fs::path folder = fs::path(files.directory) / files.name;
  fs::create_directories(folder);
  fs::remove(files.index_path());
  std::vector<fs::path> stale;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_file_name(entry.path().filename().string(), files)) stale.push_back(entry.path());
  }
  for (const fs::path& file : stale) fs::remove(file);
}

mesh::GlobalIndex items_of(const MeshPart& part, FileContent content) {
  return content == FileContent::cells ? part.cell_count() : part.face_count();
}

/// The blocks of a part that go into the files.
std::span<const Block> blocks_of(const MeshPart& part, FileContent content) {
  if (content == FileContent::cells) return part.cells;
  return part.faces;
}

/// The items of a part in corners.
mesh::GlobalIndex work_of(const MeshPart& part, FileContent content) {
  mesh::GlobalIndex corners = 0;
  for (const Block& block : blocks_of(part, content))
    corners += static_cast<mesh::GlobalIndex>(block.count()) * block.corners;
  return corners;
}

/// Collective.
FilePlan plan_for(const parallel::Communicator& communicator, std::span<const WrittenPart> mine,
                  FileContent content, mesh::GlobalIndex items_per_file) {
  std::vector<PartLocation> places;
  for (const WrittenPart& written : mine) {
    places.push_back({.id = written.part.id,
                      .rank = communicator.rank(),
                      .items = items_of(written.part, content),
                      .work = work_of(written.part, content)});
  }
  return plan_files(communicator.gather_sorted(places, &PartLocation::id), items_per_file,
                    communicator.size());
}

/// The arrays of a part in a message.
template <template <class> class Array>
struct PartArrays {
  struct Items {
    Array<mesh::LocalIndex> connectivity;
    Array<Run> runs;
    Array<mesh::LocalIndex> order;
  };
  std::int32_t id = 0;
  Array<double> coordinates;
  Array<mesh::GlobalIndex> numbers;
  std::array<Items, cell_shape_count> cells;
  std::array<Items, face_shape_count> faces;
  Array<std::int32_t> triangle_face, triangle_patch;
  Array<std::int16_t> layers;
};

/// A part of this rank.
template <class T>
using View = std::span<const T>;

PartArrays<View> arrays_of(const WrittenPart& written) {
  PartArrays<View> arrays;
  arrays.id = written.part.id;
  arrays.coordinates = written.part.coordinates;
  arrays.numbers = written.part.numbers;
  const auto items_of = [](const Block& block) -> PartArrays<View>::Items {
    return {block.connectivity, block.runs, block.order};
  };
  std::transform(written.part.cells.begin(), written.part.cells.end(), arrays.cells.begin(), items_of);
  std::transform(written.part.faces.begin(), written.part.faces.end(), arrays.faces.begin(), items_of);
  arrays.triangle_face = written.triangle_face;
  arrays.triangle_patch = written.triangle_patch;
  arrays.layers = written.part.layers;
  return arrays;
}

/// A part that came from another rank. Its arrays stay where they are when it moves.
template <class T>
using List = std::vector<T>;
using ReceivedPart = PartArrays<List>;

WrittenPart view(const ReceivedPart& received) {
  WrittenPart written;
  written.part.id = received.id;
  written.part.coordinates = received.coordinates;
  written.part.numbers = received.numbers;
  for (const CellShape shape : cell_shapes) {
    const auto& items = received.cells[static_cast<std::size_t>(shape)];
    written.part.cells[static_cast<std::size_t>(shape)] = {corners_of(shape), items.connectivity, items.runs,
                                                           0, items.order};
  }
  for (const FaceShape shape : face_shapes) {
    const auto& items = received.faces[static_cast<std::size_t>(shape)];
    written.part.faces[static_cast<std::size_t>(shape)] = {corners_of(shape), items.connectivity, items.runs,
                                                           0, items.order};
  }
  written.triangle_face = received.triangle_face;
  written.triangle_patch = received.triangle_patch;
  written.part.layers = received.layers;
  return written;
}

/// Sends the parts of the files of this round to their writers, where they lack. Collective.
std::vector<ReceivedPart> fetch_parts(const parallel::Communicator& communicator,
                                      std::span<const WrittenPart> mine, const FilePlan& plan,
                                      std::size_t round) {
  std::map<parallel::Rank, parallel::Packer> packers;
  for (const WrittenPart& written : mine) {
    const PlannedFile& file = plan.plan_of(written.part.id);
    if (file.round == round && file.writer != communicator.rank())
      parallel::pack(packers[file.writer], arrays_of(written));
  }
  std::vector<parallel::Parcel> parcels;
  parcels.reserve(packers.size());
  for (auto& [rank, packer] : packers) parcels.push_back({rank, packer.take()});
  std::vector<ReceivedPart> parts;
  for (parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    parallel::Unpacker unpacker(parcel.content);
    while (!unpacker.at_end()) parts.push_back(parallel::unpack<ReceivedPart>(unpacker));
    parallel::Bytes().swap(parcel.content);
  }
  return parts;
}

/// The files of a round by number, and the parts of each, ascending.
using PartsOfFiles = std::map<std::size_t, std::vector<WrittenPart>>;

/// The files that this rank writes, with the parts that it holds and those that it received.
PartsOfFiles parts_of_round(parallel::Rank rank, std::span<const WrittenPart> mine, const FilePlan& plan,
                            std::size_t round, const std::vector<ReceivedPart>& received) {
  PartsOfFiles files;
  const auto add = [&](const WrittenPart& written) {
    const std::size_t file = plan.file_of[static_cast<std::size_t>(written.part.id)];
    if (plan.files[file].writer == rank && plan.files[file].round == round) files[file].push_back(written);
  };
  std::for_each(mine.begin(), mine.end(), add);
  for (const ReceivedPart& other : received) add(view(other));
  for (auto& [file, parts] : files) {
    std::sort(parts.begin(), parts.end(),
              [](const WrittenPart& a, const WrittenPart& b) { return a.part.id < b.part.id; });
  }
  return files;
}

}  // namespace

std::vector<WrittenPart> parts_of(const FileMesh& mesh) {
  std::vector<WrittenPart> parts;
  for (const MeshPart& part : mesh.parts) parts.push_back({part, {}, {}});
  return parts;
}

// Numbers tell which vertices of several parts are one: the first use of each makes the point.
FilePoints merge_points(const std::vector<WrittenPart>& parts, FileContent content) {
  FilePoints points;
  std::vector<std::pair<mesh::GlobalIndex, std::size_t>> uses;
  for (const WrittenPart& written : parts) {
    auto& places = points.of_part.emplace_back(written.part.numbers.size(), -1);
    for (const Block& block : blocks_of(written.part, content)) {
      for (const mesh::LocalIndex v : block.connectivity) places[v] = 0;
    }
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (places[v] == 0) uses.emplace_back(written.part.numbers[v], uses.size());
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
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (std::size_t v = 0; v < points.of_part[p].size(); ++v) {
      PointIndex& place = points.of_part[p][v];
      if (place < 0) continue;
      if (first_use[use] == use) {
        place_of[use] = static_cast<PointIndex>(points.numbers.size());
        points.numbers.push_back(parts[p].part.numbers[v]);
        const auto point = parts[p].part.coordinates.begin() + static_cast<std::ptrdiff_t>(3 * v);
        points.coordinates.insert(points.coordinates.end(), point, point + 3);
      }
      place = place_of[first_use[use++]];
    }
  }
  return points;
}

std::string IndexedFiles::index_path() const {
  return (fs::path(directory) / (name + "." + index_extension)).string();
}
std::string IndexedFiles::file_source(std::size_t file) const {
  return fmt::format("{0}/{0}_{1:06}.{2}", name, file, file_extension);
}
std::vector<std::string> IndexedFiles::file_sources(std::size_t files) const {
  std::vector<std::string> sources;
  for (std::size_t i = 0; i < files; ++i) sources.push_back(file_source(i));
  return sources;
}
std::string IndexedFiles::file_path(std::size_t file) const {
  return (fs::path(directory) / file_source(file)).string();
}

std::size_t write_files(std::span<const WrittenPart> mine, FileContent content,
                        mesh::GlobalIndex items_per_file, const IndexedFiles& files,
                        const FileWriter& write) {
  const parallel::Communicator& communicator = files.communicator;
  parallel::on_root(communicator, [&] { prepare_folder(files); });
  const FilePlan plan = plan_for(communicator, mine, content, items_per_file);
  const auto of_this_rank = [&](const PlannedFile& file) { return file.writer == communicator.rank(); };
  parallel::Progress progress("output", std::count_if(plan.files.begin(), plan.files.end(), of_this_rank),
                              "files");
  const auto write_round = [&](std::size_t round, const std::vector<ReceivedPart>& received) {
    parallel::agree(communicator, [&] {
      for (const auto& [file, parts] : parts_of_round(communicator.rank(), mine, plan, round, received)) {
        write(parts, files.file_path(file));
        progress.advance(1, 1);
      }
    });
  };
  for (std::size_t round = 0; round < plan.rounds; ++round)
    write_round(round, fetch_parts(communicator, mine, plan, round));
  write_round(PlannedFile::no_round, {});
  return plan.files.size();
}

void write_index(const IndexedFiles& files, const std::string& text) {
  parallel::on_root(files.communicator, [&] {
    const std::string path = files.index_path(), unfinished = path + ".unfinished";
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
