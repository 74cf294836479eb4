#include "sizing/lifting/lifting.hpp"

#include "geometry/disjoint_sets.hpp"
#include "parallel/communication/collective_error.hpp"
#include "sizing/features/segment_tree.hpp"
#include "sizing/features/skin_faces.hpp"
#include "sizing/features/trailing_candidates.hpp"
#include "sizing/lifting/lifting_section.hpp"
#include "sizing/sources/surface_request.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using geometry::Vec3;

/// Of the chord: thicker is a fuselage that ends in an edge, not a wing. Chosen, not measured.
constexpr double thickest = 0.4;
/// Of the chord: a blunt edge that is wider is an end of something else. Chosen, not measured.
constexpr double widest = 0.05;

/// Makes an element of a candidate.
class Surveyor {
public:
  /// `goes_on` tells at which ends another trailing edge begins.
  Surveyor(const SampledModel& sampled, Vec3 flow, TrailingCandidate candidate, std::array<bool, 2> goes_on)
      : _model(sampled.model()), _flow(flow), _element(std::move(candidate.element)), _goes_on(goes_on) {
    const std::set<FaceId> faces =
        skin_faces(_model, candidate.neighbours, _element.blunt_face, Kinks::no_valleys);
    for (const ModelFacet& facet : sampled.facets().items)
      if (faces.contains(facet.face)) _skin.push_back(facet);
    list_ends(faces);
    measure_lengths();
  }

  /// Nothing where what lies ahead is no lifting body.
  std::optional<LiftingElement> survey() {
    constexpr int first_stations = 17;  // to start with; chosen, not measured
    std::vector<std::pair<double, LiftingStation>> found;
    for (int i = 0; i < first_stations; ++i) {
      const double fraction = beside_end + (1 - 2 * beside_end) * i / (first_stations - 1);
      if (const auto station = station_at(fraction)) found.emplace_back(fraction, *station);
    }
    if (2 * found.size() < first_stations) return std::nullopt;
    for (std::size_t i = 0; i + 1 < found.size(); ++i) {
      _element.stations.push_back(found[i].second);
      refine(found[i].first, found[i].second, found[i + 1].first, found[i + 1].second, 0);
    }
    _element.stations.push_back(found.back().second);
    lay_leading();
    for (const Vec3 p : _element.trailing.points) _element.trailing.chords.push_back(chord_at(p));
    return std::move(_element);
  }

private:
  /// Of the trailing edge's length: so far from its ends sections are whole, mostly. Chosen, not measured.
  static constexpr double beside_end = 0.01;

  void list_ends(const std::set<FaceId>& faces) {
    for (const FaceId face : faces) {
      for (const auto& loop : _model.face(face).loops) {
        for (const cad::Coedge& use : loop) {
          const cad::Edge& edge = _model.edge(use.edge);
          const bool inside =
              edge.degenerate || std::all_of(edge.faces.begin(), edge.faces.end(), [&](FaceId f) {
                return f == _element.blunt_face || faces.contains(f);
              });
          if (!inside) _element.ends.insert(use.edge);
        }
      }
    }
  }

  void measure_lengths() {
    const auto& points = _element.trailing.points;
    _lengths.assign(1, 0);
    for (std::size_t i = 1; i < points.size(); ++i)
      _lengths.push_back(_lengths.back() + distance(points[i - 1], points[i]));
  }

  /// The plane along the flow at a fraction of the trailing edge's length, and how wide that is.
  struct Place {
    CuttingPlane plane;
    Vec3 along;  ///< the trailing edge
    double width = 0;
  };
  Place place_at(double fraction) const {
    const auto& points = _element.trailing.points;
    const double length = fraction * _lengths.back();
    const auto above = std::upper_bound(_lengths.begin() + 1, _lengths.end() - 1, length);
    const auto i = static_cast<std::size_t>(above - _lengths.begin()) - 1;
    const double part = (length - _lengths[i]) / (_lengths[i + 1] - _lengths[i]);
    Place place;
    place.along = normalized(points[i + 1] - points[i]);
    Vec3 at = points[i] + part * (points[i + 1] - points[i]);
    if (!_element.opposite.empty()) {
      const auto& other = _element.opposite;
      const Vec3 across = other[i] + part * (other[i + 1] - other[i]);
      place.width = distance(at, across);
      at = 0.5 * (at + across);
    }
    place.plane = {at, normalized(place.along - dot(place.along, _flow) * _flow), -_flow};
    return place;
  }

  std::optional<LiftingStation> station_at(double fraction) const {
    const Place place = place_at(fraction);
    const auto nose = find_nose(_model, _skin, place.plane, 2 * place.width);
    if (!nose) return std::nullopt;
    const double chord = distance(nose->place, place.plane.origin);
    if (nose->thickness > thickest * chord || place.width > widest * chord) return std::nullopt;
    return LiftingStation{place.plane.origin, nose->place, chord, nose->thickness};
  }

  /// Adds stations between two until the leading edge is straight between them.
  void refine(double first, const LiftingStation& from, double last, const LiftingStation& to, int depth) {
    constexpr int most_halvings = 6;
    constexpr double straight = 3e-4;  // of the chord: a small part of any level's size
    if (depth == most_halvings) return;
    const double middle = 0.5 * (first + last);
    const auto station = station_at(middle);
    if (!station) return;
    const bool is_straight =
        distance_to_segment(station->leading, from.leading, to.leading) < straight * station->chord;
    if (!is_straight) refine(first, from, middle, *station, depth + 1);
    _element.stations.push_back(*station);
    if (!is_straight) refine(middle, *station, last, to, depth + 1);
  }

  /// The leading edge of the stations, and beyond them: roots and tips need not lie along the flow.
  void lay_leading() {
    const auto beyond = [&](int side, const LiftingStation& end, const LiftingStation& next) {
      // In chords; a body's side or a tip is not farther away. Chosen, not measured.
      constexpr double step = 0.01, most = 0.5, near = 0.03;
      const double fraction = side == 0 ? beside_end : 1 - beside_end, way = side == 0 ? -1 : 1;
      const double farthest = _goes_on[side] ? beside_end * _lengths.back() / end.chord : most;
      std::vector<Vec3> points;
      Place place = place_at(fraction);
      Vec3 last = end.leading;
      const double span = distance(end.trailing, next.trailing);
      Vec3 stride = step * end.chord / span * (end.leading - next.leading);
      for (double gone = step; gone < farthest; gone += step) {
        place.plane.origin = place.plane.origin + way * step * end.chord * place.along;
        const auto nose = find_nose_near(_model, _skin, place.plane, last + stride, near * end.chord);
        if (!nose) break;
        stride = *nose - last;
        last = *nose;
        points.push_back(last);
      }
      return points;
    };
    const auto& stations = _element.stations;
    const std::size_t count = stations.size();
    std::vector<Vec3> before = beyond(0, stations[0], stations[1]);
    std::reverse(before.begin(), before.end());
    EdgeLine line{std::move(before), {}};
    line.chords.assign(line.points.size(), stations[0].chord);
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0 && jumps(stations[i - 1], stations[i])) {
        _element.leading.push_back(std::move(line));
        line = {};
      }
      line.points.push_back(stations[i].leading);
      line.chords.push_back(stations[i].chord);
    }
    const std::vector<Vec3> after = beyond(1, stations[count - 1], stations[count - 2]);
    line.points.insert(line.points.end(), after.begin(), after.end());
    line.chords.resize(line.points.size(), stations[count - 1].chord);
    _element.leading.push_back(std::move(line));
  }

  /// Whether two stations are of different bodies: a section through a pylon may lead on in the wing above.
  static bool jumps(const LiftingStation& a, const LiftingStation& b) {
    // Steeper than any sweep, and farther than noses are rough. Chosen, not measured.
    constexpr double steepest = 3, rough = 0.01;
    return distance(a.leading, b.leading) >
           steepest * distance(a.trailing, b.trailing) + rough * std::min(a.chord, b.chord);
  }

  double chord_at(Vec3 p) const {
    const auto& stations = _element.stations;
    double nearest = distance(p, stations[0].trailing), chord = stations[0].chord;
    for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
      const LiftingStation &a = stations[i], &b = stations[i + 1];
      const double part = part_along(p, a.trailing, b.trailing);
      const double away = distance(p, a.trailing + part * (b.trailing - a.trailing));
      if (away < nearest) nearest = away, chord = a.chord + part * (b.chord - a.chord);
    }
    return chord;
  }

  const cad::Model& _model;
  Vec3 _flow;
  LiftingElement _element;
  std::vector<ModelFacet> _skin;
  std::array<bool, 2> _goes_on;
  std::vector<double> _lengths;  // of the trailing edge up to each of its points
};

/// Area of an element across the flow, and the integral of the square of its chord.
struct Planform {
  double area = 0, square = 0;
  geometry::Box box;
};

Planform planform_of(const LiftingElement& element, Vec3 flow) {
  Planform form;
  for (std::size_t i = 0; i < element.stations.size(); ++i) {
    const LiftingStation& b = element.stations[i];
    form.box.add(b.trailing), form.box.add(b.leading);
    if (i == 0) continue;
    const LiftingStation& a = element.stations[i - 1];
    const Vec3 way = b.trailing - a.trailing;
    const double span = norm(way - dot(way, flow) * flow);
    form.area += 0.5 * span * (a.chord + b.chord);
    form.square += span / 3 * (a.chord * a.chord + a.chord * b.chord + b.chord * b.chord);
  }
  return form;
}

/// Elements one after the other, by the vertices in which their trailing edges end.
std::vector<Planform> planforms(const std::vector<LiftingElement>& elements, Vec3 flow) {
  geometry::DisjointSets<std::int32_t> sets(elements.size());
  const auto count = static_cast<std::int32_t>(elements.size());
  std::map<cad::VertexId, std::int32_t> user;
  for (std::int32_t i = 0; i < count; ++i) {
    for (const auto& vertices : elements[i].end_vertices)
      for (const cad::VertexId vertex : vertices) sets.unite(user.emplace(vertex, i).first->second, i);
  }
  std::map<std::int32_t, Planform> groups;
  for (std::int32_t i = 0; i < count; ++i) {
    const Planform form = planform_of(elements[i], flow);
    Planform& group = groups[sets.root(i)];
    group.area += form.area, group.square += form.square;
    group.box.add(form.box.low), group.box.add(form.box.high);
  }
  std::vector<Planform> all;
  all.reserve(groups.size());
  for (const auto& [first, group] : groups) all.push_back(group);
  return all;
}

/// Whether a body ends in the plane of symmetry.
bool is_half_model(const cad::Model& model) {
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    const auto& faces = model.edge(e).faces;
    const auto outer =
        std::count_if(faces.begin(), faces.end(), [&](FaceId f) { return model.is_far_field(f); });
    if (outer > 0 && outer < static_cast<std::ptrdiff_t>(faces.size())) return true;
  }
  return false;
}

void add_reference(const cad::Model& model, const geometry::Box& body, Vec3 flow, LiftingBodies& bodies) {
  constexpr double alike = 0.01;  // areas of a left and a right wing
  constexpr double whole = 0.95;  // of the body's extent: a wing alone, from tip to tip
  const std::vector<Planform> all = planforms(bodies.elements, flow);
  const Planform* largest = &all.front();
  for (const Planform& each : all)
    if (each.area > largest->area) largest = &each;
  bodies.reference_chord = largest->square / largest->area;
  const Vec3 extent = largest->box.size() - Vec3{std::abs(flow.x), std::abs(flow.y), std::abs(flow.z)} *
                                                dot(largest->box.size(), Vec3{1, 1, 1});
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (extent[i] > extent[axis]) axis = i;
  const bool has_partner = std::any_of(all.begin(), all.end(), [&](const Planform& each) {
    return &each != largest && std::abs(each.area - largest->area) < alike * largest->area;
  });
  const bool is_alone = largest->box.size()[axis] > whole * body.size()[axis];
  bodies.semispan =
      !is_half_model(model) && (has_partner || is_alone) ? 0.5 * body.size()[axis] : body.size()[axis];
}

/// Whether there is a candidate with a face that is wanted. All are where the list is empty.
bool is_wanted(const std::optional<TrailingCandidate>& candidate, const std::vector<bool>& wanted) {
  if (!candidate || wanted.empty()) return candidate.has_value();
  const cad::FaceId blunt_face = candidate->element.blunt_face;
  return (blunt_face != cad::no_entity && wanted[blunt_face]) ||
         std::any_of(candidate->neighbours.begin(), candidate->neighbours.end(),
                     [&](FaceId f) { return wanted[f]; });
}

}  // namespace

LiftingBodies find_lifting_bodies(const SampledModel& sampled, Vec3 flow,
                                  const std::vector<std::string>& named) {
  const parallel::Communicator& communicator = sampled.communicator();
  const cad::Model& model = sampled.model();
  std::vector<bool> wanted;
  std::vector<std::int32_t> faces, edges;
  parallel::agree(communicator, [&] {
    require_like(model, "sizing.lifting", named);
    if (!named.empty()) wanted = faces_like(model, named);
    for (FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size())
      if (is_wanted(blunt_candidate(model, f, flow), wanted)) faces.push_back(f);
    for (cad::EdgeId e = communicator.rank(); e < model.edge_count(); e += communicator.size())
      if (is_wanted(sharp_candidate(model, e, flow), wanted)) edges.push_back(e);
  });
  const std::vector<std::int32_t> all_faces = communicator.gather_sorted(faces),
                                  all_edges = communicator.gather_sorted(edges);
  LiftingBodies bodies;
  parallel::agree(communicator, [&] {
    std::vector<TrailingCandidate> candidates;
    candidates.reserve(all_faces.size() + all_edges.size());
    for (const FaceId f : all_faces) candidates.push_back(*blunt_candidate(model, f, flow));
    for (const cad::EdgeId e : all_edges) candidates.push_back(*sharp_candidate(model, e, flow));
    std::map<cad::VertexId, int> users;
    for (const TrailingCandidate& candidate : candidates) {
      for (const auto& vertices : candidate.element.end_vertices)
        for (const cad::VertexId vertex : vertices) ++users[vertex];
    }
    for (TrailingCandidate& candidate : candidates) {
      std::array<bool, 2> goes_on;
      for (int side = 0; side < 2; ++side) {
        const auto& vertices = candidate.element.end_vertices[side];
        goes_on[side] = std::any_of(vertices.begin(), vertices.end(),
                                    [&](cad::VertexId vertex) { return users[vertex] > 1; });
      }
      if (auto element = Surveyor(sampled, flow, std::move(candidate), goes_on).survey())
        bodies.elements.push_back(std::move(*element));
    }
    if (!bodies.elements.empty()) add_reference(model, sampled.body_box(), flow, bodies);
  });
  return bodies;
}

}  // namespace aeroloom::sizing
