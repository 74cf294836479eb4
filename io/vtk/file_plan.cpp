#include "io/vtk/file_plan.hpp"

#include <algorithm>
#include <map>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;
using parallel::Rank;

/// What is to be known of a file before its writer is chosen.
struct Content {
  std::map<Rank, GlobalIndex> held;  ///< items by the rank that holds them
  GlobalIndex items = 0, work = 0;

  Rank holder_of_most() const {
    const auto less = [](const auto& a, const auto& b) { return a.second < b.second; };
    return std::max_element(held.begin(), held.end(), less)->first;
  }
  GlobalIndex received_by(Rank writer) const {
    const auto own = held.find(writer);
    return own == held.end() ? items : items - own->second;
  }
};

std::vector<Content> group_parts(std::span<const PartLocation> places, GlobalIndex items_per_file,
                                 std::vector<std::size_t>& file_of) {
  std::vector<Content> contents;
  for (const PartLocation& place : places) {
    if (contents.empty() || contents.back().items >= items_per_file) contents.emplace_back();
    Content& content = contents.back();
    file_of.push_back(contents.size() - 1);
    content.held[place.rank] += place.items;
    content.items += place.items;
    content.work += place.work;
  }
  return contents;
}

std::vector<Rank> choose_writers(const std::vector<Content>& contents, int ranks) {
  std::vector<GlobalIndex> work(static_cast<std::size_t>(ranks), 0);
  GlobalIndex all = 0;
  for (const Content& content : contents) all += content.work;
  const GlobalIndex mean_work = all / ranks;
  std::vector<Rank> writers(contents.size(), -1);
  for (std::size_t i = 0; i < contents.size(); ++i) {
    const Rank holder = contents[i].holder_of_most();
    GlobalIndex& of_holder = work[static_cast<std::size_t>(holder)];
    const bool fits = of_holder + contents[i].work <= mean_work;
    if (of_holder > 0 && contents[i].work > 0 && !fits) continue;
    writers[i] = holder;
    of_holder += contents[i].work;
  }
  for (std::size_t i = 0; i < contents.size(); ++i) {
    if (writers[i] >= 0) continue;
    const auto least = std::min_element(work.begin(), work.end());
    writers[i] = static_cast<Rank>(least - work.begin());
    *least += contents[i].work;
  }
  return writers;
}

}  // namespace

FilePlan plan_files(std::span<const PartLocation> places, GlobalIndex items_per_file, int ranks) {
  FilePlan plan;
  const std::vector<Content> contents = group_parts(places, items_per_file, plan.file_of);
  const std::vector<Rank> writers = choose_writers(contents, ranks);
  GlobalIndex all = 0;
  for (const Content& content : contents) all += content.items;
  constexpr int rounds_of_mean = 8;  // chosen, not measured
  const GlobalIndex at_once = std::max(items_per_file, all / ranks / rounds_of_mean);
  struct Round {
    std::size_t number = 0;
    GlobalIndex received = 0;
  };
  std::vector<Round> last(static_cast<std::size_t>(ranks));
  for (std::size_t i = 0; i < contents.size(); ++i) {
    PlannedFile& file = plan.files.emplace_back();
    file.writer = writers[i];
    const GlobalIndex received = contents[i].received_by(file.writer);
    if (received == 0) continue;
    Round& round = last[static_cast<std::size_t>(file.writer)];
    if (round.received > 0 && round.received + received > at_once) round = {round.number + 1, 0};
    round.received += received;
    file.round = round.number;
    plan.rounds = std::max(plan.rounds, round.number + 1);
  }
  return plan;
}

}  // namespace aeroloom::io
