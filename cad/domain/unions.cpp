#include "cad/domain/booleans.hpp"
#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/repair/heal.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using Solids = std::vector<TopoDS_Solid>;

/// One way to have the CAD library unite solids.
struct Way {
  std::string name;
  bool swapped = false;       ///< arguments and tools change places
  bool one_by_one = false;    ///< with each of the others in turn
  double tolerance = 0;       ///< points up to so far apart are one; 0: the library's own
  bool shared_faces = false;  ///< nothing is intersected: faces lie on one another or apart
  bool is_first = false;
};

/// In the order in which they are tried, and what they may move.
std::vector<Way> ways(double diagonal) {
  std::vector<Way> all{{"as they are", false, false, 0, false, true},
                       {"the other way round", true},
                       {"one by one", false, true}};
  for (const double fraction : tolerances::uniting) {
    const double length = fraction * diagonal;
    all.push_back(
        {fmt::format("with points up to {:.3g} apart taken as one", in_file(length)), false, false, length});
    all.push_back(
        {fmt::format("the other way round, with points up to {:.3g} apart taken as one", in_file(length)),
         true, false, length});
  }
  all.push_back({"as shapes that share whole faces", false, false, 0, true});
  return all;
}

struct Union {
  Solids solids;
  FaceLabels labels;
};

Union fuse(const Solids& arguments, const Solids& tools, const Way& way, const FaceLabels& labels) {
  BRepAlgoAPI_Fuse fuse;
  fuse.SetArguments(list_of(way.swapped ? tools : arguments));
  fuse.SetTools(list_of(way.swapped ? arguments : tools));
  if (way.tolerance > 0) fuse.SetFuzzyValue(way.tolerance);
  if (way.shared_faces) fuse.SetGlue(BOPAlgo_GlueShift);
  perform(fuse, "uniting bodies that touch");
  Solids inputs = arguments;
  inputs.insert(inputs.end(), tools.begin(), tools.end());
  Union result{solids_of(fuse.Shape()), labels};
  follow_labels(fuse, inputs, result.labels);
  return result;
}

/// Why a union is none; empty where it is sound.
std::string find_fault(const Solids& united, const Solids& before, const TopoDS_Solid& solid, const Way& way,
                       Volumes& volumes) {
  if (united.empty()) return "no solid is left";
  const double parts = volume_of(before, volumes) + volumes.of(solid), whole = volume_of(united, volumes);
  const double tolerance = tolerances::integrated_volume * parts;
  if (std::abs(parts - whole) > tolerance) {
    const double common = common_volume(make_compound(before), solid, way.tolerance, volumes);
    if (std::abs(parts - common - whole) > tolerance) {
      return fmt::format("parts of volume {:.9g} that share {:.3g} gave a union of {:.9g}", in_file(parts, 3),
                         in_file(common, 3), in_file(whole, 3));
    }
  }
  if (way.is_first)
    return {};  // as costly as the union where there are many bodies; what it misses, volumes tell
  const bool were_valid =
      BRepCheck_Analyzer(make_compound(before)).IsValid() && BRepCheck_Analyzer(solid).IsValid();
  if (were_valid && !BRepCheck_Analyzer(make_compound(united)).IsValid())
    return "the CAD library finds the union invalid";
  return {};
}

/// Nothing where a way fails in the CAD library.
std::optional<Union> try_way(const Solids& united, const TopoDS_Solid& solid, const Way& way,
                             const FaceLabels& labels, std::string& fault) {
  try {
    if (!way.one_by_one) return fuse(united, {solid}, way, labels);
    Union all{{solid}, labels};
    for (const TopoDS_Solid& other : united) {
      Union next = fuse(all.solids, {other}, way, all.labels);
      all = std::move(next);
    }
    return all;
  } catch (const CadError& error) {
    fault = error.what();
  } catch (const Standard_Failure& failure) {
    fault = failure.GetMessageString();
  }
  return std::nullopt;
}

std::string name_of_body(const TopoDS_Shape& body, const FaceLabels& labels) {
  for (TopExp_Explorer faces(body, TopAbs_FACE); faces.More(); faces.Next()) {
    const FaceLabel* label = labels.Seek(faces.Current());
    if (label == nullptr) continue;
    if (!label->solid.empty()) return fmt::format("'{}'", label->solid);
    if (const std::string name = shown_name(*label); !name.empty())
      return fmt::format("that with face '{}'", name);
  }
  return fmt::format("that around {}", place_in_file(tight_box(body).center()));
}

[[noreturn]] void refuse_union(const Solids& united, const TopoDS_Solid& solid, const FaceLabels& labels,
                               const std::string& fault) {
  const Box box = tight_box(solid);
  const TopoDS_Solid* nearest = &united.front();
  double most = -std::numeric_limits<double>::max();
  for (const TopoDS_Solid& other : united) {
    const Box other_box = tight_box(other);
    double overlap = std::numeric_limits<double>::max();
    for (int axis = 0; axis < 3; ++axis)
      overlap = std::min(overlap, std::min(box.high[axis], other_box.high[axis]) -
                                      std::max(box.low[axis], other_box.low[axis]));
    if (overlap > most) most = overlap, nearest = &other;
  }
  throw CadError(fmt::format(
      "the bodies {} and {} touch or overlap near {}, and no way of the CAD library unites them soundly: {}. "
      "Remedy: unite them in the CAD program, or move one so that they overlap clearly or stay apart",
      name_of_body(*nearest, labels), name_of_body(solid, labels),
      place_in_file(meeting_place(box, tight_box(*nearest))), fault));
}

}  // namespace

Vec3 meeting_place(const Box& a, const Box& b) {
  Vec3 middle;
  for (int axis = 0; axis < 3; ++axis)
    middle[axis] = 0.5 * (std::max(a.low[axis], b.low[axis]) + std::min(a.high[axis], b.high[axis]));
  return middle;
}

double volume_of(const Solids& solids, Volumes& volumes) {
  double sum = 0;
  for (const TopoDS_Solid& solid : solids) sum += volumes.of(solid);
  return sum;
}

double common_volume(const TopoDS_Shape& first, const TopoDS_Shape& second, double tolerance,
                     Volumes& volumes) {
  BRepAlgoAPI_Common common;
  common.SetArguments(list_of(std::vector{first}));
  common.SetTools(list_of(std::vector{second}));
  if (tolerance > 0) common.SetFuzzyValue(tolerance);
  perform(common, "intersecting two bodies");
  return common.Shape().IsNull() ? 0 : std::abs(volumes.of(common.Shape()));
}

std::optional<Solids> unite_at_once(const Solids& solids, Volumes& volumes, FaceLabels& labels) {
  // Of the smallest solid: less than what is lost where one is left out. Chosen, not measured.
  constexpr double most_lost = 0.1;
  double sum = 0, smallest = std::numeric_limits<double>::max();
  for (const TopoDS_Solid& solid : solids) {
    const double volume = volumes.of(solid);
    sum += volume;
    smallest = std::min(smallest, volume);
  }
  try {
    Union all = fuse({solids.front()}, {solids.begin() + 1, solids.end()}, {"as they are"}, labels);
    const double lost = std::abs(sum - volume_of(all.solids, volumes));
    if (all.solids.empty() || lost > std::min(tolerances::integrated_volume * sum, most_lost * smallest))
      return std::nullopt;
    labels = all.labels;
    return std::move(all.solids);
  } catch (const CadError&) {
    return std::nullopt;
  } catch (const Standard_Failure&) {
    return std::nullopt;
  }
}

std::vector<TopoDS_Solid> unite_with(const Solids& united, const TopoDS_Solid& solid, Volumes& volumes,
                                     FaceLabels& labels, Changes& changes) {
  Box box = tight_box(solid);
  for (const TopoDS_Solid& each : united) box.add(tight_box(each));
  std::string first_fault;
  for (const Way& way : ways(box.diagonal())) {
    if (way.one_by_one && united.size() == 1) continue;
    std::string fault;
    std::optional<Union> found = try_way(united, solid, way, labels, fault);
    if (found) {
      try {
        fault = find_fault(found->solids, united, solid, way, volumes);
      } catch (const CadError& error) {
        fault = error.what();
      }
    }
    if (first_fault.empty()) first_fault = fault;
    if (!fault.empty()) continue;
    if (!first_fault.empty()) {
      changes.push_back(
          {fmt::format("the bodies {} and others, which the CAD library could not unite as they are ({}), "
                       "united {}",
                       name_of_body(solid, labels), first_fault, way.name),
           tight_box(solid).center(), way.tolerance});
    }
    labels = found->labels;
    return std::move(found->solids);
  }
  refuse_union(united, solid, labels, first_fault);
}

}  // namespace aeroloom::cad
