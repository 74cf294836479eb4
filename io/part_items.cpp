#include "io/part_items.hpp"

#include "io/id_table.hpp"
#include "mesh/delivery.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

template <std::size_t N>
void send(const parallel::Communicator& communicator, std::int32_t parts, std::vector<PartItem<N>>& items) {
  items = mesh::deliver(communicator, std::move(items), [&](const PartItem<N>& item) {
    return rank_of_part(item.part, parts, communicator.size());
  });
  std::sort(items.begin(), items.end(), [](const PartItem<N>& a, const PartItem<N>& b) {
    return std::tie(a.part, a.id, a.order, a.corners) < std::tie(b.part, b.id, b.order, b.corners);
  });
}

/// A part while it is put together.
struct Draft {
  std::int32_t id = 0;
  std::vector<GlobalIndex> known;    ///< old numbers, ascending
  std::vector<GlobalIndex> numbers;  ///< new ones
  std::vector<std::uint8_t> owned;
  std::unique_ptr<PartArrays> arrays = std::make_unique<PartArrays>();
};

/// The items of one part among those that are sorted by part.
template <std::size_t N>
std::span<const PartItem<N>> items_of(const std::vector<PartItem<N>>& items, std::int32_t part) {
  const auto less = [](const PartItem<N>& item, std::int32_t id) { return item.part < id; };
  const auto begin = std::lower_bound(items.begin(), items.end(), part, less);
  const auto end = std::lower_bound(begin, items.end(), part + 1, less);
  return {items.data() + (begin - items.begin()), static_cast<std::size_t>(end - begin)};
}

template <std::size_t N>
void collect(const std::vector<PartItem<N>>& items, Draft& draft) {
  for (const auto& item : items_of(items, draft.id))
    draft.known.insert(draft.known.end(), item.corners.begin(), item.corners.end());
}

std::vector<GlobalIndex> distinct(std::vector<GlobalIndex> values) {
  return IdTable(std::move(values)).numbers();
}

/// All old numbers that the parts of this rank know.
std::vector<GlobalIndex> known_to_any(const std::vector<Draft>& drafts) {
  std::vector<GlobalIndex> all;
  for (const Draft& draft : drafts) all.insert(all.end(), draft.known.begin(), draft.known.end());
  return distinct(std::move(all));
}

void own_by_number(std::vector<Draft>& drafts, std::int32_t parts, GlobalIndex count) {
  for (Draft& draft : drafts) {
    const auto first_of = [&](std::int32_t part) {
      return count / parts * part + count % parts * part / parts;
    };
    const GlobalIndex begin = first_of(draft.id), end = first_of(draft.id + 1);
    const std::size_t needed = draft.known.size();
    draft.known.resize(needed + static_cast<std::size_t>(end - begin));
    std::iota(draft.known.begin() + static_cast<std::ptrdiff_t>(needed), draft.known.end(), begin);
    draft.known = distinct(std::move(draft.known));
    draft.numbers = draft.known;
    for (const GlobalIndex number : draft.known)
      draft.owned.push_back(number >= begin && number < end ? 1 : 0);
  }
}

/// Says of vertices which part owns them, or what their numbers are: what the meeting place of an old number
/// has heard.
class NumberMeeting {
public:
  NumberMeeting(const parallel::Communicator& communicator, GlobalIndex limit)
      : _communicator(communicator), _ranges(mesh::even_ranges(communicator.size(), limit)) {}

  struct Note {
    GlobalIndex key;
    GlobalIndex value;
    std::int64_t rank;

    static constexpr auto fields() { return std::tuple(&Note::key, &Note::value, &Note::rank); }
  };
  /// Ascending by key, then value.
  std::vector<Note> gather(std::vector<Note> notes) const {
    std::vector<Note> met = mesh::deliver(_communicator, std::move(notes),
                                          [&](const Note& note) { return _ranges.rank_of(note.key); });
    std::sort(met.begin(), met.end(), [](const Note& a, const Note& b) {
      return std::tie(a.key, a.value, a.rank) < std::tie(b.key, b.value, b.rank);
    });
    return met;
  }
  std::vector<Note> reply(std::vector<Note> notes) const {
    std::vector<Note> arrived = mesh::deliver(_communicator, std::move(notes), [](const Note& note) {
      return static_cast<parallel::Rank>(note.rank);
    });
    std::sort(arrived.begin(), arrived.end(), [](const Note& a, const Note& b) { return a.key < b.key; });
    return arrived;
  }

private:
  const parallel::Communicator& _communicator;
  mesh::KeyRanges _ranges;
};

/// Per vertex that a rank knows, the lowest part that knows it, anywhere.
std::vector<NumberMeeting::Note> find_owners(const parallel::Communicator& communicator,
                                             const NumberMeeting& meeting, const std::vector<Draft>& drafts) {
  using Note = NumberMeeting::Note;
  std::vector<Note> notes;
  for (const GlobalIndex number : known_to_any(drafts)) notes.push_back({number, 0, communicator.rank()});
  for (auto draft = drafts.rbegin(); draft != drafts.rend(); ++draft) {
    for (const GlobalIndex number : draft->known) {
      const auto at = std::lower_bound(notes.begin(), notes.end(), number,
                                       [](const Note& note, GlobalIndex key) { return note.key < key; });
      at->value = draft->id;
    }
  }
  std::vector<Note> met = meeting.gather(std::move(notes));
  for (std::size_t i = 1; i < met.size(); ++i) {
    if (met[i].key == met[i - 1].key) met[i].value = met[i - 1].value;
  }
  return meeting.reply(std::move(met));
}

/// The first number of each part on this rank, from the counts of all. Collective.
std::vector<GlobalIndex> first_numbers(const parallel::Communicator& communicator,
                                       const std::vector<Draft>& drafts) {
  GlobalIndex mine = 0;
  std::vector<GlobalIndex> first;
  for (const Draft& draft : drafts) {
    first.push_back(mine);
    mine += std::count(draft.owned.begin(), draft.owned.end(), 1);
  }
  const GlobalIndex before = communicator.exclusive_scan(mine);  // parts ascend with ranks
  for (GlobalIndex& number : first) number += before;
  return first;
}

void own_by_part(const parallel::Communicator& communicator, std::vector<Draft>& drafts, GlobalIndex count) {
  using Note = NumberMeeting::Note;
  const NumberMeeting meeting(communicator, count);
  std::vector<Note> of_vertex = find_owners(communicator, meeting, drafts);
  const auto note_of = [&](GlobalIndex number) {
    return std::lower_bound(of_vertex.begin(), of_vertex.end(), number,
                            [](const Note& note, GlobalIndex key) { return note.key < key; });
  };
  for (Draft& draft : drafts) {
    for (const GlobalIndex number : draft.known)
      draft.owned.push_back(note_of(number)->value == draft.id ? 1 : 0);
  }
  const std::vector<GlobalIndex> first = first_numbers(communicator, drafts);
  constexpr GlobalIndex question = -1;  // sorts before every number: the answer is the last of a key
  std::vector<Note> notes;
  notes.reserve(2 * of_vertex.size());
  for (const Note& note : of_vertex) notes.push_back({note.key, question, communicator.rank()});
  for (std::size_t d = 0; d < drafts.size(); ++d) {
    GlobalIndex next = first[d];
    for (std::size_t v = 0; v < drafts[d].known.size(); ++v) {
      if (drafts[d].owned[v]) notes.push_back({drafts[d].known[v], next++, communicator.rank()});
    }
  }
  const std::vector<Note> met = meeting.gather(std::move(notes));
  std::vector<Note> answers;
  for (std::size_t i = 0, j = 0; i < met.size(); i = j) {
    for (j = i; j < met.size() && met[j].key == met[i].key;) ++j;
    for (std::size_t k = i; k + 1 < j; ++k) answers.push_back({met[k].key, met[j - 1].value, met[k].rank});
  }
  of_vertex = meeting.reply(std::move(answers));
  for (Draft& draft : drafts) {
    for (const GlobalIndex number : draft.known) draft.numbers.push_back(note_of(number)->value);
  }
}

/// Vertices in the order of their new numbers, items with local corners.
void finish(Draft& draft, const PartItems& items, const std::vector<GlobalIndex>& keys,
            const std::vector<std::array<double, 3>>& points) {
  const IdTable table(draft.known);
  PartArrays& arrays = *draft.arrays;
  std::vector<LocalIndex> order(draft.known.size()), place(draft.known.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](LocalIndex a, LocalIndex b) { return draft.numbers[a] < draft.numbers[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const LocalIndex v = order[i];
    place[v] = static_cast<LocalIndex>(i);
    const auto at = std::lower_bound(keys.begin(), keys.end(), draft.known[v]) - keys.begin();
    arrays.coordinates.insert(arrays.coordinates.end(), points[at].begin(), points[at].end());
    arrays.numbers.push_back(draft.numbers[v]);
    arrays.owned.push_back(draft.owned[v]);
  }
  const auto add = [&](const auto& all, std::vector<LocalIndex>& connectivity,
                       std::vector<std::int32_t>& ids) {
    for (const auto& item : items_of(all, draft.id)) {
      for (const GlobalIndex number : item.corners) connectivity.push_back(place[table.place(number)]);
      ids.push_back(item.id);
    }
  };
  for_each_cell_shape(
      [&](auto s) { add(std::get<s>(items.cells), arrays.cells[s], arrays.cell_regions[s]); });
  for_each_face_shape(
      [&](auto s) { add(std::get<s>(items.faces), arrays.faces[s], arrays.face_patches[s]); });
}

}  // namespace

FileMesh build_parts(const parallel::Communicator& communicator, PartItems items, const PointStore& points,
                     std::int32_t parts, Ownership ownership, std::vector<mesh::Patch> patches,
                     std::vector<std::string> regions) {
  for_each_cell_shape([&](auto s) { send(communicator, parts, std::get<s>(items.cells)); });
  for_each_face_shape([&](auto s) { send(communicator, parts, std::get<s>(items.faces)); });
  std::vector<Draft> drafts;
  for (std::int32_t part = 0; part < parts; ++part) {
    if (rank_of_part(part, parts, communicator.size()) != communicator.rank()) continue;
    Draft& draft = drafts.emplace_back();
    draft.id = part;
    for_each_cell_shape([&](auto s) { collect(std::get<s>(items.cells), draft); });
    for_each_face_shape([&](auto s) { collect(std::get<s>(items.faces), draft); });
    draft.known = distinct(std::move(draft.known));
  }
  if (ownership == Ownership::by_number) {
    own_by_number(drafts, parts, points.count());
  } else {
    own_by_part(communicator, drafts, points.count());
  }
  const std::vector<GlobalIndex> keys = known_to_any(drafts);
  const PointStore::Found found = points.fetch(keys);
  std::vector<OwnedPart> mine;
  for (Draft& draft : drafts) {
    finish(draft, items, keys, found.values);
    mine.push_back({draft.id, std::move(draft.arrays)});
    draft = {};
  }
  return make_file_mesh(communicator, parts, std::move(mine), std::move(patches), std::move(regions));
}

}  // namespace aeroloom::io
