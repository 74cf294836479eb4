#include "cad/domain/booleans.hpp"
#include "cad/domain/far_field.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/repair/heal.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <BRepAlgoAPI_BuilderAlgo.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// Groups solids whose boxes touch, each group ascending.
std::vector<std::vector<TopoDS_Solid>> touching_groups(const std::vector<TopoDS_Solid>& solids) {
  if (solids.size() == 1) return {solids};
  std::vector<Box> boxes;
  Box all;
  for (const TopoDS_Solid& solid : solids) all.add(boxes.emplace_back(tight_box(solid)));
  const Vec3 gap = tolerances::same_place * all.diagonal() * Vec3{1, 1, 1};
  for (Box& box : boxes) box.low -= gap, box.high += gap;
  std::vector<std::size_t> group(solids.size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (std::size_t i = 0; i < solids.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (group[i] == group[j] || !boxes[i].overlaps(boxes[j])) continue;
      const std::size_t keep = std::min(group[i], group[j]), drop = std::max(group[i], group[j]);
      std::replace(group.begin(), group.end(), drop, keep);
    }
  }
  std::vector<std::vector<TopoDS_Solid>> groups(solids.size());
  for (std::size_t i = 0; i < solids.size(); ++i) groups[group[i]].push_back(solids[i]);
  std::erase_if(groups, [](const auto& members) { return members.empty(); });
  return groups;
}

/// From so many bodies on, they are united at once where they only touch: one after the other takes time with
/// the square of their number. Chosen, not measured.
constexpr std::size_t many_bodies = 16;

/// One after the other, so that each union's volume can be checked against its two parts; many that do not
/// overlap at once.
std::vector<TopoDS_Solid> unite(const std::vector<TopoDS_Solid>& group, Volumes& volumes, FaceLabels& labels,
                                Changes& changes) {
  if (group.size() >= many_bodies) {
    if (auto united = unite_at_once(group, volumes, labels)) return std::move(*united);
  }
  std::vector<TopoDS_Solid> united{group.front()};
  for (std::size_t i = 1; i < group.size(); ++i)
    united = unite_with(united, group[i], volumes, labels, changes);
  return united;
}

}  // namespace

NamedShape unite_bodies(NamedShape bodies, Volumes& volumes, Changes& changes,
                        std::vector<RefusedUnion>& refused) {
  std::vector<TopoDS_Solid> result;
  for (const auto& group : touching_groups(solids_of(bodies.shape))) {
    std::vector<TopoDS_Solid> united = group;
    try {
      if (group.size() > 1) united = unite(group, volumes, bodies.labels, changes);
    } catch (const CadError& error) {
      refused.push_back({group, error.what()});
      continue;
    }
    if (group.size() > united.size()) {
      changes.push_back({fmt::format("{} touching bodies united to {}", group.size(), united.size())});
    }
    result.insert(result.end(), united.begin(), united.end());
  }
  bodies.shape = make_compound(result);
  return bodies;
}

NamedShape refuse_unions(NamedShape bodies, const std::string& reason, std::vector<RefusedUnion>& refused) {
  std::vector<TopoDS_Solid> single;
  for (auto& group : touching_groups(solids_of(bodies.shape))) {
    if (group.size() == 1) single.push_back(group.front());
    if (group.size() > 1) refused.push_back({std::move(group), reason});
  }
  bodies.shape = make_compound(single);
  return bodies;
}

namespace {

/// The first pairs of solids that overlap, with places.
std::string name_overlaps(const std::vector<TopoDS_Solid>& group, Volumes& volumes) {
  constexpr int shown = 3;  // each takes a boolean operation
  std::vector<Box> boxes;
  boxes.reserve(group.size());
  for (const TopoDS_Solid& solid : group) boxes.push_back(tight_box(solid));
  std::string text;
  int found = 0;
  for (std::size_t i = 0; i < group.size() && found < shown; ++i) {
    for (std::size_t j = 0; j < i && found < shown; ++j) {
      if (!boxes[i].overlaps(boxes[j])) continue;
      const double common = common_volume(group[i], group[j], 0, volumes);
      if (common <= tolerances::integrated_volume * std::min(volumes.of(group[i]), volumes.of(group[j])))
        continue;
      ++found;
      text += fmt::format("; two share a volume of {:.6g} around {}", in_file(common, 3),
                          place_in_file(meeting_place(boxes[i], boxes[j])));
    }
  }
  return text;
}

}  // namespace

NamedShape join_regions(NamedShape regions, Volumes& volumes, Changes& changes) {
  std::vector<TopoDS_Solid> result;
  for (const auto& group : touching_groups(solids_of(regions.shape))) {
    if (group.size() == 1) {
      result.push_back(group.front());
      continue;
    }
    const double parts = volume_of(group, volumes);
    BRepAlgoAPI_BuilderAlgo join;
    join.SetArguments(list_of(group));
    perform(join, "joining regions that touch");
    follow_labels(join, group, regions.labels);
    const std::vector<TopoDS_Solid> joined = solids_of(join.Shape());
    const double whole = volume_of(joined, volumes);
    if (joined.size() < group.size() || std::abs(whole - parts) > tolerances::integrated_volume * parts) {
      throw CadError(
          fmt::format("{} solids overlap: together they fill {:.9g}, apart {:.9g}{}. Remedy: make "
                      "them touch in the CAD program, or take them as bodies (DomainOptions::kind: body)",
                      group.size(), in_file(whole, 3), in_file(parts, 3), name_overlaps(group, volumes)));
    }
    changes.push_back({fmt::format("{} touching regions joined face to face", group.size())});
    result.insert(result.end(), joined.begin(), joined.end());
  }
  regions.shape = make_compound(result);
  return regions;
}

}  // namespace aeroloom::cad
