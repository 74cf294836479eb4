#include "pipeline/layer_forecast.hpp"

#include "geometry/place_text.hpp"
#include "layers/column_heights.hpp"
#include "layers/end_planes.hpp"
#include "layers/sectors.hpp"
#include "parallel/observation/process_memory.hpp"
#include "pipeline/case/layer_rules.hpp"
#include "pipeline/edge_turns.hpp"
#include "pipeline/report/change_json.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/features/ray_tree.hpp"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using geometry::Vec3;
using sizing::Triangle;
using Json = nlohmann::ordered_json;

// What a prism of layers adds to a run, cut into tetrahedra or not (benchmarks/results/layers.md).
constexpr double seconds_per_prism = 3e-6, bytes_per_prism = 75;

constexpr double triangles_per_area = 4 / std::numbers::sqrt3;  // times 1/h^2
constexpr double part_per_size = 3;                             // edges of a part that one size stands for
constexpr int deepest_part = 24;                                // bisections; chosen, not measured

/// A facet of the boundary.
struct WallFacet {
  Triangle corners;
  Vec3 outward;  ///< unit, out of the fluid
  cad::FaceId face;
  bool turned = false;  ///< of an inner face, seen from its back
};

Vec3 area_vector(const Triangle& t) {
  return 0.5 * cross(t[1] - t[0], t[2] - t[0]);
}

/// Of all faces that bound one region, far field excepted.
std::vector<WallFacet> boundary_facets(const cad::Model& model) {
  std::vector<WallFacet> facets;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.is_far_field(f)) continue;
    const cad::Facets of_face = sizing::sampling_facets(model, f, false);
    for (const auto& t : of_face.triangles) {
      const Triangle corners{of_face.points[t[0]], of_face.points[t[1]], of_face.points[t[2]]};
      const Vec3 area = area_vector(corners);
      if (norm(area) > 0) facets.push_back({corners, normalized(area), f});
    }
  }
  return facets;
}

std::vector<Triangle> corners_of_facets(const std::vector<WallFacet>& facets) {
  std::vector<Triangle> corners;
  corners.reserve(facets.size());
  for (const WallFacet& facet : facets) corners.push_back(facet.corners);
  return corners;
}

/// Adds up what parts of facets ask for.
class LayerCount {
public:
  LayerCount(const cad::Model& model, const sizing::SizeField& field,
             const std::vector<mesh::PatchType>& types, layers::LayerElements elements)
      : _model(model),
        _field(field),
        _types(types),
        _elements(elements),
        _facets(boundary_facets(model)),
        _tree(corners_of_facets(_facets)) {}

  /// Over the facets of the patch's faces, of inner ones on the sides that are asked for.
  void add_patch(std::int32_t patch, layers::InnerSides sides, PatchLayerForecast& sum) const {
    for_each_part(patch, sides, [&](const WallFacet& facet, Vec3 middle, double size, double area) {
      add_part(facet, middle, size, area, sum);
    });
  }

  /// Over an edge that turns by this much, in radians: the sectors of its fans, as many as where they are
  /// most.
  void add_fans(cad::EdgeId id, double turn, PatchLayerForecast& sum) const {
    constexpr int parts = 64;  // chosen, not measured
    const cad::Edge& edge = _model.edge(id);
    const layers::Heights heights{sum.asked.first, sum.asked.growth, sum.asked.constant};
    const auto point = [&](int i) {
      return _model.edge_point(
          id, edge.first_parameter + (edge.last_parameter - edge.first_parameter) * i / parts);
    };
    std::int32_t sectors = 1;
    double layers_along = 0;
    for (int i = 0; i < parts; ++i) {
      const Vec3 a = point(i), b = point(i + 1);
      const double size = _field(0.5 * (a + b));
      const std::int32_t count = layers::wanted_count(sum.asked, size);
      sectors = std::max(sectors, layers::wanted_sectors(turn, heights.total(count), size));
      layers_along += distance(a, b) / size * (count + 1);  // a pyramid ends each sector
    }
    sum.cells += sectors * layers_along;
  }

  /// Of the sizes on the patch, weighted by area; 0 for a patch without facets.
  double mean_size(std::int32_t patch, layers::InnerSides sides) const {
    double sum = 0, sum_of_areas = 0;
    for_each_part(patch, sides, [&](const WallFacet&, Vec3, double size, double area) {
      sum += area * size, sum_of_areas += area;
    });
    return sum_of_areas > 0 ? sum / sum_of_areas : 0;
  }

private:
  /// Calls visit(facet, middle, size, area) for parts that are not much larger than the size there.
  template <class Visit>
  void for_each_part(std::int32_t patch, layers::InnerSides sides, const Visit& visit) const {
    using layers::InnerSides;
    std::vector<double> area_of_facets(_model.face_count(), 0);
    for (const WallFacet& facet : _facets) area_of_facets[facet.face] += norm(area_vector(facet.corners));
    for (const WallFacet& facet : _facets) {
      const cad::Face& face = _model.face(facet.face);
      if (face.patch != patch) continue;
      const bool inner = face.back != cad::no_entity;
      const bool front = sides == InnerSides::front || sides == InnerSides::both,
                 back = sides == InnerSides::back || sides == InnerSides::both,
                 is_baffle = face.back == face.front;  // normals point to its front
      // Facets cut corners: the exact area makes up for it.
      const double larger = _model.face_area(facet.face) / area_of_facets[facet.face];
      if (!inner || (is_baffle ? back : front)) visit_parts(facet, facet.corners, larger, 0, visit);
      const WallFacet turned{facet.corners, -facet.outward, facet.face, true};
      if (inner && (is_baffle ? front : back)) visit_parts(turned, facet.corners, larger, 0, visit);
    }
  }

  template <class Visit>
  void visit_parts(const WallFacet& facet, const Triangle& t, double larger, int depth,
                   const Visit& visit) const {
    int longest = 0;
    for (int i = 1; i < 3; ++i)
      if (distance(t[i], t[(i + 1) % 3]) > distance(t[longest], t[(longest + 1) % 3])) longest = i;
    const Vec3 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
    const Vec3 middle = (a + b + c) / 3.0;
    const double size = _field(middle);
    if (distance(a, b) <= part_per_size * size || depth >= deepest_part)
      return visit(facet, middle, size, larger * norm(area_vector(t)));
    const Vec3 half = 0.5 * (a + b);
    visit_parts(facet, {a, half, c}, larger, depth + 1, visit);
    visit_parts(facet, {half, b, c}, larger, depth + 1, visit);
  }

  void add_part(const WallFacet& facet, Vec3 middle, double size, double area,
                PatchLayerForecast& sum) const {
    const layers::Heights heights{sum.asked.first, sum.asked.growth, sum.asked.constant};
    const std::int32_t wanted = layers::wanted_count(sum.asked, size);
    const double total = heights.total(wanted);
    const bool is_first = sum.area == 0;
    sum.least_count = is_first ? wanted : std::min(sum.least_count, wanted);
    sum.most_count = std::max(sum.most_count, wanted);
    sum.least_total = is_first ? total : std::min(sum.least_total, total);
    sum.most_total = std::max(sum.most_total, total);
    sum.area += area;
    sum.edges_area += area * size;
    const double gap = gap_before(facet, middle, layers::ample_gap(total, size));
    std::int32_t count = wanted;
    if (gap < layers::ample_gap(total, size)) {
      const double room = layers::room_in_gap(gap, size, 1);
      count = layers::layers_below(heights, wanted, room);
      if (count < wanted) sum.lacking_area += area;
      if (count < wanted && gap < sum.narrowest_gap) sum.narrowest_gap = gap, sum.narrowest_at = middle;
    }
    const int of_prism = _elements == layers::LayerElements::tets ? 3 : 1;
    sum.cells += triangles_per_area * area / (size * size) * count * of_prism;
    sum.replaced += area * tetrahedra_on(middle, -facet.outward, heights.total(count));
  }

  /// Tetrahedra that sizes ask for between a point and this height above it, per area.
  double tetrahedra_on(Vec3 point, Vec3 inward, double height) const {
    constexpr int steps = 3;  // sizes grow slowly over the height of layers
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double size = _field(point + (i + 0.5) / steps * height * inward);
      sum += sizing::tetrahedra_per_volume * height / steps / (size * size * size);
    }
    return sum;
  }

  /// How far the next wall is in front of a facet, `reach` at most. Layers end on planes that are no walls,
  /// and what is opposite there is their own mirror image.
  double gap_before(const WallFacet& facet, Vec3 point, double reach) const {
    const Vec3 inward = -facet.outward;
    const auto corners = [&](std::int32_t t) -> const Triangle& { return _facets[t].corners; };
    const auto faces_back = [&](std::int32_t t) {
      const bool turned = facet.turned && _model.face(_facets[t].face).back != cad::no_entity;
      return dot(turned ? -_facets[t].outward : _facets[t].outward, inward) > 0;
    };
    std::int64_t nodes = 0;
    const sizing::RayTree::Crossing met =
        _tree.nearest_crossings(point, inward, reach, corners, faces_back, nodes)[0];
    if (met.triangle < 0) return reach;
    const std::int32_t patch = _model.face(_facets[met.triangle].face).patch;
    const bool is_wall = _types.at(patch) == mesh::PatchType::wall;
    return is_wall ? met.distance : std::min(reach, 2 * met.distance);
  }

  const cad::Model& _model;
  const sizing::SizeField& _field;
  const std::vector<mesh::PatchType>& _types;
  layers::LayerElements _elements;
  std::vector<WallFacet> _facets;
  sizing::RayTree _tree;
};

/// Changes what is asked for as a run does; sizes stand for edges.
void fit_patch(const cases::LayerRequest& request, double size, PatchLayerForecast& forecast) {
  if (size <= 0) return;
  const layers::WallLayers asked = forecast.asked;
  forecast.asked = cases::fitted_layers(asked, size, request.fit, request.growth_maximum);
  forecast.change = cases::change_of_fit(asked, forecast.asked, size);
}

std::string from_to(double low, double high) {
  return high > low ? fmt::format("{:.3g} to {:.3g}", low, high) : fmt::format("{:.3g}", low);
}

/// The y+ of a height of the first layer, in both meanings; empty where the flow is not known.
std::optional<double> y_plus_at_node(const LayerForecast& forecast, double first) {
  if (!forecast.reynolds || !forecast.length) return std::nullopt;
  return cases::y_plus_of(first, *forecast.reynolds, *forecast.length);
}

std::string describe_patch(const LayerForecast& forecast, const PatchLayerForecast& patch) {
  const std::optional<double> y_plus = y_plus_at_node(forecast, patch.asked.first);
  std::string text = fmt::format(
      "layers on '{}': {} layers, the first {:.3g} high{}, growing by {:.3g}, {} high together\n", patch.name,
      from_to(patch.least_count, patch.most_count), patch.asked.first,
      y_plus ? fmt::format(" (y+ {:.3g} at its node, {:.3g} at its centre)", *y_plus, 0.5 * *y_plus) : "",
      patch.asked.growth, from_to(patch.least_total, patch.most_total));
  if (!patch.change.empty()) text += fmt::format("       by layers.fit: {}\n", patch.change);
  const std::string early = cases::early_end(patch.asked, patch.edges_area / patch.area);
  if (!early.empty()) text += fmt::format("       {}\n", early);
  if (patch.lacking_area > 0)
    text += fmt::format(
        "       no room for that on {:.3g} % of its area, where gaps are down to {:.3g} (near {}): the last "
        "layers are left out there\n",
        100 * patch.lacking_area / patch.area, patch.narrowest_gap, geometry::place_text(patch.narrowest_at));
  return text;
}

}  // namespace

double LayerForecast::cells() const {
  double sum = 0;
  for (const PatchLayerForecast& patch : patches) sum += patch.cells;
  return sum;
}

double LayerForecast::seconds() const {
  return seconds_per_prism * cells() / cells_of_prism;
}

double LayerForecast::bytes() const {
  return bytes_per_prism * cells() / cells_of_prism;
}

double LayerForecast::tetrahedra_off_layers(double everywhere) const {
  double replaced = 0;
  for (const PatchLayerForecast& patch : patches) replaced += patch.replaced;
  if (!(everywhere > 0)) return everywhere;
  // Layers of walls that meet in a corner count twice there, and stay lower in a run.
  return everywhere / (1 + replaced / everywhere);
}

LayerForecast forecast_layers(const cad::Model& model, const std::vector<mesh::PatchType>& types,
                              const cases::Case& input, const sizing::SizeField& field) {
  const layers::LayerOptions options = cases::layer_options(
      cases::without_missing_patches(input.layers, model.patches()), input.sizing, model.patches(), types);
  const LayerCount count(model, field, types, options.elements);
  const bool has_fans =
      options.fans != layers::FanPlaces::none && options.elements != layers::LayerElements::tets;
  const auto has_layers = [&](cad::FaceId face) {
    return options.patches.at(static_cast<std::size_t>(model.face(face).patch)).first > 0;
  };
  std::vector<cad::FaceId> planes;
  for (cad::FaceId face = 0; face < model.face_count(); ++face) {
    if (!has_layers(face) && model.is_planar(face) && layers::may_end_on(types.at(model.face(face).patch)))
      planes.push_back(face);
  }
  const std::vector<double> turns = has_fans ? find_ridge_turns(model, planes) : std::vector<double>();
  const auto may_have_fan = [&](cad::FaceId face) {
    return has_layers(face) || std::binary_search(planes.begin(), planes.end(), face);
  };
  LayerForecast forecast{{}, input.layers.reynolds, input.layers.length};
  if (options.elements == layers::LayerElements::tets) forecast.cells_of_prism = 3;
  for (std::size_t p = 0; p < options.patches.size(); ++p) {
    if (options.patches[p].first <= 0) continue;
    PatchLayerForecast patch{.name = model.patches()[p], .asked = options.patches[p]};
    const layers::InnerSides sides = layers::inner_sides_of(options, p);
    if (input.layers.fit != cases::LayerFit::none)
      fit_patch(input.layers, count.mean_size(static_cast<std::int32_t>(p), sides), patch);
    count.add_patch(static_cast<std::int32_t>(p), sides, patch);
    for (std::size_t e = 0; e < turns.size(); ++e) {
      const auto id = static_cast<cad::EdgeId>(e);
      const std::vector<cad::FaceId>& faces = model.edge(id).faces;
      if (turns[e] <= 0 || !std::all_of(faces.begin(), faces.end(), may_have_fan)) continue;
      const auto of = std::find_if(faces.begin(), faces.end(), has_layers);
      if (of != faces.end() && model.face(*of).patch == static_cast<std::int32_t>(p))
        count.add_fans(id, turns[e], patch);
    }
    if (patch.area > 0) forecast.patches.push_back(std::move(patch));
  }
  return forecast;
}

std::string describe(const LayerForecast& forecast) {
  if (forecast.patches.empty()) return {};
  constexpr std::size_t shown = 10;
  std::string text;
  for (std::size_t i = 0; i < std::min(shown, forecast.patches.size()); ++i)
    text += describe_patch(forecast, forecast.patches[i]);
  if (forecast.patches.size() > shown)
    text += fmt::format("layers on {} more patches, see check.json: forecast.layers\n",
                        forecast.patches.size() - shown);
  if (forecast.reynolds && forecast.length)
    text += fmt::format("layers: the boundary layer of a flat plate is {:.3g} thick\n",
                        cases::boundary_layer_thickness(*forecast.reynolds, *forecast.length));
  return text + fmt::format(
                    "layers add: about {:.3g} cells, {:.0f} s on one core, {:.2g} GiB; the tetrahedra "
                    "below are those off them\n",
                    forecast.cells(), forecast.seconds(), forecast.bytes() / parallel::gibibyte);
}

nlohmann::ordered_json to_json(const LayerForecast& forecast) {
  Json json = {
      {"cells", forecast.cells()}, {"seconds_on_one_core", forecast.seconds()}, {"bytes", forecast.bytes()}};
  json["patches"] = Json::array();
  for (const PatchLayerForecast& patch : forecast.patches) {
    const std::optional<double> y_plus = y_plus_at_node(forecast, patch.asked.first);
    const bool narrow = patch.lacking_area > 0;
    json["patches"].push_back({{"name", patch.name},
                               {"first", patch.asked.first},
                               {"y_plus_node", y_plus ? Json(*y_plus) : Json()},
                               {"y_plus_centre", y_plus ? Json(0.5 * *y_plus) : Json()},
                               {"growth", patch.asked.growth},
                               {"constant", patch.asked.constant},
                               {"layers_min", patch.least_count},
                               {"layers_max", patch.most_count},
                               {"total_min", patch.least_total},
                               {"total_max", patch.most_total},
                               {"cells", patch.cells},
                               {"lacking", patch.lacking_area / patch.area},
                               {"narrowest_gap", narrow ? Json(patch.narrowest_gap) : Json()},
                               {"narrowest_at", narrow ? report::to_json(patch.narrowest_at) : Json()}});
  }
  return json;
}

}  // namespace aeroloom::pipeline
