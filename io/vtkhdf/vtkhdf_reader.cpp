#include "io/vtkhdf/vtkhdf_reader.hpp"

#include "geometry/sort_unique.hpp"
#include "io/distinct_numbers.hpp"
#include "io/vtkhdf/vtkhdf_items.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include <fmt/format.h>

namespace aeroloom::io {

using vtkhdf::FileFacts;

namespace {

/// The ids of points by their places among all `points` of the file. Collective.
class IdLookup {
public:
  IdLookup(const RawMesh& raw, std::int64_t points)
      : _communicator(raw.file.communicator), _points(points), _mine(raw.point_ids) {}

  void replace(const std::vector<std::vector<mesh::GlobalIndex>*>& lists) {
    parallel::agree(_communicator, [&] {
      for (const auto* list : lists) _places.insert(_places.end(), list->begin(), list->end());
      geometry::sort_unique(_places);
    });
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
    std::vector<parallel::Parcel> parcels;
    parallel::agree(_communicator, [&] { parcels = questions(); });
    parcels = _communicator.exchange(std::move(parcels));
    parallel::agree(_communicator, [&] { parcels = answers(parcels); });
    parcels = _communicator.exchange(std::move(parcels));
    parallel::agree(_communicator, [&] {
      for (const parallel::Parcel& answer : parcels) {
        const auto ids = parallel::from_bytes<mesh::GlobalIndex>(answer.content);
        _ids.insert(_ids.end(), ids.begin(), ids.end());
      }
    });
  }

  std::vector<parallel::Parcel> questions() const {
    std::vector<parallel::Parcel> result;
    auto next = _places.begin();
    for (int rank = 0; rank < _communicator.size() && next != _places.end(); ++rank) {
      const auto end =
          std::lower_bound(next, _places.end(), LocalRange::of(_points, rank, _communicator.size()).end);
      if (end != next) {
        result.push_back({rank, parallel::to_bytes(std::span<const mesh::GlobalIndex>(
                                    &*next, static_cast<std::size_t>(end - next)))});
      }
      next = end;
    }
    return result;
  }

  std::vector<parallel::Parcel> answers(const std::vector<parallel::Parcel>& questions) const {
    const std::int64_t first = LocalRange::of(_points, _communicator.rank(), _communicator.size()).begin;
    std::vector<parallel::Parcel> result;
    for (const parallel::Parcel& question : questions) {
      auto places = parallel::from_bytes<mesh::GlobalIndex>(question.content);
      for (mesh::GlobalIndex& place : places) place = _mine[static_cast<std::size_t>(place - first)];
      result.push_back({question.rank, parallel::to_bytes(std::span<const mesh::GlobalIndex>(places))});
    }
    return result;
  }

  const parallel::Communicator& _communicator;
  std::int64_t _points;
  const std::vector<mesh::GlobalIndex>& _mine;
  std::vector<mesh::GlobalIndex> _places, _ids;
};

/// More are no names.
constexpr std::size_t most_names = std::size_t{1} << 20;

std::vector<std::span<const std::int32_t>> spans_of(const std::vector<std::vector<std::int32_t>*>& lists) {
  std::vector<std::span<const std::int32_t>> spans;
  spans.reserve(lists.size());
  for (const auto* list : lists) spans.emplace_back(*list);
  return spans;
}

/// The meaning of cell data: values of the file, and their names.
struct NamedValues {
  std::vector<std::int32_t> values;
  std::vector<std::string> names;
};

/// Finds what the values in `lists` stand for; they become places in it. Where `known` has a name for each
/// value in use, they stay. Collective; throws CollectiveError (input) where there are too many to be names.
NamedValues name_values(const SharedPath& file, const std::vector<std::vector<std::int32_t>*>& lists,
                        const std::vector<std::string>& known, const char* stem) {
  NamedValues named;
  named.values = distinct_numbers(
      file.communicator, spans_of(lists), most_names,
      fmt::format("{}: the cell data {} has more than {} different values", file.path, stem, most_names));
  parallel::agree(file.communicator, [&] {
    const auto has_name = [&](std::int32_t value) {
      return value >= 0 && static_cast<std::size_t>(value) < known.size();
    };
    if (std::all_of(named.values.begin(), named.values.end(), has_name)) {
      named.names = known;
      named.values.resize(known.size());
      std::iota(named.values.begin(), named.values.end(), 0);
      return;
    }
    for (const std::int32_t value : named.values) {
      named.names.push_back(has_name(value) ? known[static_cast<std::size_t>(value)]
                                            : fmt::format("{}_{}", stem, value));
    }
    for (auto* list : lists) {
      for (std::int32_t& value : *list) {
        const auto place = std::lower_bound(named.values.begin(), named.values.end(), value);
        value = static_cast<std::int32_t>(place - named.values.begin());
      }
    }
  });
  return named;
}

template <std::size_t N, class T>
std::vector<std::vector<T>*> pointers_to(std::array<std::vector<T>, N>& lists) {
  std::vector<std::vector<T>*> pointers;
  pointers.reserve(N);
  for (std::vector<T>& list : lists) pointers.push_back(&list);
  return pointers;
}

void name_regions(const FileFacts& facts, RawMesh& raw) {
  std::vector<std::string> known = facts.region_names;
  if (!facts.has_regions && known.size() != 1) known = {"fluid"};
  raw.regions = name_values(raw.file, pointers_to(raw.cell_regions), known, "region").names;
  if (raw.regions.empty()) raw.regions = {"fluid"};
}

void name_patches(const FileFacts& facts, RawMesh& raw) {
  NamedValues named = name_values(raw.file, pointers_to(raw.face_patches), facts.patch_names, "patch");
  for (std::size_t i = 0; i < named.names.size(); ++i) {
    const std::int32_t value = named.values[i];
    const bool has_type = value >= 0 && static_cast<std::size_t>(value) < facts.patch_types.size();
    const auto type = has_type ? mesh::patch_type_of(facts.patch_types[static_cast<std::size_t>(value)])
                               : mesh::patch_type_by_name(named.names[i]);
    raw.patches.push_back({std::move(named.names[i]), type.value_or(mesh::PatchType::wall)});
  }
}

}  // namespace

RawMesh read_vtkhdf(const SharedPath& file) {
  FileFacts facts;
  parallel::on_root(file.communicator, [&] { facts = vtkhdf::survey_file(file.path); });
  file.communicator.broadcast_value(facts);
  RawMesh raw(file), boundary(file);
  parallel::agree(file.communicator, [&] { vtkhdf::read_local_items(facts, raw, boundary); });
  if (!facts.id_array.empty()) {
    std::vector<std::vector<mesh::GlobalIndex>*> corners = pointers_to(raw.cells);
    for (auto* faces : pointers_to(raw.faces)) corners.push_back(faces);
    IdLookup(raw, facts.all().points).replace(corners);
  }
  if (facts.has_boundary) {
    raw.faces = std::move(boundary.faces);
    raw.face_patches = std::move(boundary.face_patches);
  }
  name_regions(facts, raw);
  name_patches(facts, raw);
  return raw;
}

}  // namespace aeroloom::io
