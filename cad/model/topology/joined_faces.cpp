#include "cad/model/topology/joined_faces.hpp"

#include "cad/model/model_data.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/topology/sheet_interior.hpp"
#include "cad/model/topology/sheets.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// From which the nearest border to a point is told; chosen, not measured.
constexpr int samples_per_border = 64;
/// How far beside its loops guesses of a periodic face stray, in periods: one and the half beside it.
constexpr double straying_periods = 1.5;

void require_joinable(const Model& model, const std::vector<FaceId>& group) {
  const Face& first = model.face(group.front());
  for (const FaceId id : group) {
    const Face& face = model.face(id);
    const bool alike = face.patch == first.patch && face.front == first.front && face.back == first.back;
    if (!alike || model.is_far_field(id) || (group.size() > 1 && model.is_faceted(id)) ||
        model.is_exact_plane(id) != model.is_exact_plane(group.front())) {
      throw std::invalid_argument(
          fmt::format("faces '{}' and '{}' cannot be seen as one", first.name, face.name));
    }
  }
}

/// The interval of u that a member's points can have: its loops, and as far around as guesses stray.
std::pair<double, double> interval_of_u(const FaceEvaluator& face) {
  const double extent = face.uv_high.x - face.uv_low.x, repeats = face.u.repeats_after();
  const double margin = std::max(extent, straying_periods * repeats);
  const double low = face.uv_low.x - margin, high = face.uv_high.x + margin;
  if (repeats > 0) return {low, high};
  return {std::max(low, face.u.low), std::min(high, face.u.high)};
}

/// Lays the members' planes side by side.
std::vector<Sheet> lay_out(const Model& base, const std::vector<FaceId>& members) {
  std::vector<Sheet> sheets;
  double next = 0;
  for (const FaceId id : members) {
    Sheet sheet{id};
    if (members.size() > 1) {
      const FaceEvaluator& evaluator = base.data().face_evaluators[id];
      const auto [low, high] = interval_of_u(evaluator);
      const double width = high - low;
      sheet.shift = sheets.empty() ? 0 : next - low;
      sheet.low = low + sheet.shift;
      sheet.high = high + sheet.shift;
      next = sheet.high + 0.5 * width;
      sheet.interior = std::make_shared<const SheetInterior>(evaluator);
    }
    sheets.push_back(std::move(sheet));
  }
  return sheets;
}

/// Loops and uses of all members; the second coedge along an edge between two of them is its use 1.
void take_uses(const Model& base, JoinedFace& joined, Face& face) {
  face.loops.clear();
  for (std::size_t s = 0; s < joined.sheets.size(); ++s) {
    for (auto loop : base.face(joined.sheets[s].face).loops) {
      for (Coedge& use : loop) {
        const Coedge own = use;
        const bool taken = std::ranges::any_of(joined.uses, [&](const JoinedFace::Use& other) {
          return other.use.edge == use.edge && other.use.use == use.use;
        });
        if (taken) use.use = 1 - use.use;
        joined.uses.push_back({use, own, static_cast<std::int32_t>(s)});
      }
      face.loops.push_back(std::move(loop));
    }
  }
  std::ranges::sort(joined.uses, [](const JoinedFace::Use& a, const JoinedFace::Use& b) {
    return std::pair(a.use.edge, a.use.use) < std::pair(b.use.edge, b.use.use);
  });
}

void sample_borders(const Model& base, JoinedFace& joined) {
  for (std::size_t i = 1; i < joined.uses.size(); ++i) {
    const JoinedFace::Use &a = joined.uses[i - 1], &b = joined.uses[i];
    if (a.use.edge != b.use.edge || a.sheet == b.sheet) continue;
    const Edge& edge = base.edge(a.use.edge);
    if (edge.degenerate) continue;
    for (int k = 0; k <= samples_per_border; ++k) {
      const double t =
          edge.first_parameter + (edge.last_parameter - edge.first_parameter) * k / samples_per_border;
      joined.borders.push_back({base.edge_point(a.use.edge, t),
                                {a.sheet, b.sheet},
                                {base.edge_uv(joined.sheets[a.sheet].face, a.base, t),
                                 base.edge_uv(joined.sheets[b.sheet].face, b.base, t)}});
    }
  }
}

}  // namespace

Model join_faces(const Model& model, const std::vector<std::vector<FaceId>>& groups) {
  if (const ScaledModel* scaled = model.data().scaled.get())
    return in_file_unit(join_faces(within(model), groups), scaled->unit);
  if (model.data().joined) throw std::invalid_argument("faces of this model are joined already");
  std::vector<std::vector<FaceId>> members(model.face_count());
  std::vector<char> taken(model.face_count(), 0);
  for (std::vector<FaceId> group : groups) {
    require_joinable(model, group);
    std::sort(group.begin(), group.end());
    for (const FaceId id : group) {
      if (taken[id])
        throw std::invalid_argument(fmt::format("face '{}' is joined twice", model.face(id).name));
      taken[id] = 1;
    }
    members[group.front()] = std::move(group);
  }
  auto data = std::make_shared<Model::Data>(model.data());
  data->face_evaluators.clear();
  data->cache.reset();
  data->faces.clear();
  data->far_field.clear();
  JoinedModel joined{model, {}};
  std::vector<FaceId> number(model.face_count(), no_entity);
  for (FaceId id = 0; id < model.face_count(); ++id) {
    if (taken[id] && members[id].empty()) continue;
    if (members[id].empty()) members[id] = {id};
    const auto& own = members[id];
    const FaceId largest = *std::ranges::max_element(
        own, [&](FaceId a, FaceId b) { return own.size() > 1 && model.face_area(a) < model.face_area(b); });
    for (const FaceId member : own) number[member] = static_cast<FaceId>(data->faces.size());
    Face face = model.face(largest);
    JoinedFace parts{lay_out(model, own), {}, {}};
    if (own.size() > 1) {
      take_uses(model, parts, face);
      sample_borders(model, parts);
    }
    data->faces.push_back(std::move(face));
    data->far_field.push_back(model.is_far_field(id) ? 1 : 0);
    joined.faces.push_back(std::move(parts));
  }
  for (Edge& edge : data->edges) {
    for (FaceId& face : edge.faces) face = number[face];
    geometry::sort_unique(edge.faces);
  }
  data->joined = std::make_shared<const JoinedModel>(std::move(joined));
  return Model(std::move(data));
}

}  // namespace aeroloom::cad
