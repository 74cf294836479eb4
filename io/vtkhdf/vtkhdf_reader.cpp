#include "io/vtkhdf/vtkhdf_reader.hpp"

#include "io/vtkhdf/vtkhdf_share.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::io {

using parallel::Communicator;
using vtkhdf::FileFacts;

namespace {

/// The ids of points by their places among all of the file; `mine` are those of this rank's share.
/// Collective.
class IdLookup {
public:
  IdLookup(const Communicator& communicator, std::int64_t points, const std::vector<mesh::GlobalIndex>& mine)
      : _communicator(communicator), _points(points), _mine(mine) {}

  void replace(const std::vector<std::vector<mesh::GlobalIndex>*>& lists) {
    for (const auto* list : lists) _places.insert(_places.end(), list->begin(), list->end());
    std::sort(_places.begin(), _places.end());
    _places.erase(std::unique(_places.begin(), _places.end()), _places.end());
    ask();
    for (auto* list : lists) {
      for (mesh::GlobalIndex& place : *list) {
        const auto found = std::lower_bound(_places.begin(), _places.end(), place);
        place = _ids[static_cast<std::size_t>(found - _places.begin())];
      }
    }
  }

private:
  /// Places ascend, and so do ranks: the answers of all come in the order of the questions.
  void ask() {
    std::vector<parallel::Parcel> questions;
    auto next = _places.begin();
    for (int rank = 0; rank < _communicator.size() && next != _places.end(); ++rank) {
      const auto end =
          std::lower_bound(next, _places.end(), vtkhdf::share_of(_points, rank, _communicator.size()).end);
      if (end != next) {
        questions.push_back({rank, parallel::to_bytes(std::span<const mesh::GlobalIndex>(
                                       &*next, static_cast<std::size_t>(end - next)))});
      }
      next = end;
    }
    const std::int64_t first = vtkhdf::share_of(_points, _communicator.rank(), _communicator.size()).begin;
    std::vector<parallel::Parcel> answers;
    for (const parallel::Parcel& question : _communicator.exchange(std::move(questions))) {
      auto places = parallel::from_bytes<mesh::GlobalIndex>(question.content);
      for (mesh::GlobalIndex& place : places) place = _mine[static_cast<std::size_t>(place - first)];
      answers.push_back({question.rank, parallel::to_bytes(std::span<const mesh::GlobalIndex>(places))});
    }
    for (const parallel::Parcel& answer : _communicator.exchange(std::move(answers))) {
      const auto ids = parallel::from_bytes<mesh::GlobalIndex>(answer.content);
      _ids.insert(_ids.end(), ids.begin(), ids.end());
    }
  }

  const Communicator& _communicator;
  std::int64_t _points;
  const std::vector<mesh::GlobalIndex>& _mine;
  std::vector<mesh::GlobalIndex> _places, _ids;
};

/// The names that the values in `lists` stand for. Values become places in it; where `known` has a name for
/// each value in use, they stay. Collective.
std::vector<std::string> name_values(const Communicator& communicator,
                                     const std::vector<std::vector<std::int32_t>*>& lists,
                                     const std::vector<std::string>& known, const char* stem) {
  std::vector<std::int32_t> values;
  for (const auto* list : lists) {
    values.insert(values.end(), list->begin(), list->end());
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
  }
  values = communicator.all_gather_items(std::span<const std::int32_t>(values));
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.empty() || (values.front() >= 0 && static_cast<std::size_t>(values.back()) < known.size()))
    return known;
  std::vector<std::string> names;
  names.reserve(values.size());
  for (const std::int32_t value : values) {
    const bool has_name = value >= 0 && static_cast<std::size_t>(value) < known.size();
    names.push_back(has_name ? known[static_cast<std::size_t>(value)] : fmt::format("{}_{}", stem, value));
  }
  for (auto* list : lists) {
    for (std::int32_t& value : *list) {
      value =
          static_cast<std::int32_t>(std::lower_bound(values.begin(), values.end(), value) - values.begin());
    }
  }
  return names;
}

template <std::size_t N, class T>
std::vector<std::vector<T>*> pointers_to(std::array<std::vector<T>, N>& lists) {
  std::vector<std::vector<T>*> pointers;
  pointers.reserve(N);
  for (std::vector<T>& list : lists) pointers.push_back(&list);
  return pointers;
}

void name_regions(const Communicator& communicator, const FileFacts& facts, RawMesh& raw) {
  std::vector<std::string> known = facts.region_names;
  if (!facts.has_regions && known.size() != 1) known = {"fluid"};
  raw.regions = name_values(communicator, pointers_to(raw.cell_regions), known, "region");
  if (raw.regions.empty()) raw.regions = {"fluid"};
}

void name_patches(const Communicator& communicator, const FileFacts& facts, RawMesh& raw) {
  const std::vector<std::string> names =
      name_values(communicator, pointers_to(raw.face_patches), facts.patch_names, "patch");
  for (const std::string& name : names) {
    mesh::Patch patch{name, mesh::PatchType::wall};
    const auto known = std::find(facts.patch_names.begin(), facts.patch_names.end(), name);
    const auto p = static_cast<std::size_t>(known - facts.patch_names.begin());
    if (p < facts.patch_types.size())
      patch.type = mesh::patch_type_of(facts.patch_types[p]).value_or(mesh::PatchType::wall);
    raw.patches.push_back(std::move(patch));
  }
}

}  // namespace

RawMesh read_vtkhdf(const Communicator& communicator, const std::string& path) {
  FileFacts facts;
  parallel::agree(communicator, [&] {
    if (communicator.is_root()) facts = vtkhdf::survey_file(path);
  });
  vtkhdf::broadcast_facts(communicator, facts);
  RawMesh raw, boundary;
  parallel::agree(communicator, [&] {
    vtkhdf::read_share(facts, path, communicator.rank(), communicator.size(), raw, boundary);
  });
  if (!facts.id_array.empty()) {
    std::vector<std::vector<mesh::GlobalIndex>*> corners = pointers_to(raw.cells);
    for (auto* faces : pointers_to(raw.faces)) corners.push_back(faces);
    IdLookup(communicator, facts.all().points, raw.point_ids).replace(corners);
  }
  if (facts.has_boundary) {
    raw.faces = std::move(boundary.faces);
    raw.face_patches = std::move(boundary.face_patches);
  }
  name_regions(communicator, facts, raw);
  name_patches(communicator, facts, raw);
  return raw;
}

}  // namespace aeroloom::io
