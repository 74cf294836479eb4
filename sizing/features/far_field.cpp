#include "sizing/features/far_field.hpp"

#include "geometry/disjoint_sets.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/features/model_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

using cad::FaceId;
using geometry::Box;
using geometry::Vec3;

/// Sides of a box: twice the axis, and one for its high side.
using Side = int;
constexpr Side no_side = -1;
constexpr int side_count = 6;
constexpr const char* side_names[side_count] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};

/// Of the diagonal: how far places may be off a side, off the shape of the outer boundary, and how far coarse
/// facets may end before it.
constexpr double on_side = 1e-6, on_shape = 1e-3, facets_short_of_it = 0.03;
/// Facets for the boxes of faces (of the diagonal; radians).
constexpr double box_deflection = 0.005, box_angle = 0.2;

/// The side of a box in which all that is in `own` lies.
Side side_of(const Box& own, const Box& box) {
  const double tolerance = on_side * box.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    if (own.high[axis] <= box.low[axis] + tolerance) return 2 * axis;
    if (own.low[axis] >= box.high[axis] - tolerance) return 2 * axis + 1;
  }
  return no_side;
}

/// The side of each planar face in a side of the model's box.
std::vector<Side> sides_of_faces(const cad::Model& model) {
  const Box& all = model.bounds();
  std::vector<Side> sides(static_cast<std::size_t>(model.face_count()), no_side);
  for (FaceId f = 0; f < model.face_count(); ++f) {
    if (!model.is_planar(f)) continue;
    // Corners away from every side tell without a triangulation.
    Box corners;
    for (const auto& loop : model.face(f).loops) {
      for (const cad::Coedge& use : loop) corners.add(model.vertex(model.edge(use.edge).first));
    }
    if (!corners.empty() && side_of(corners, all) == no_side) continue;
    Box own;
    for (const Vec3 p : sampling_facets(model, f, true).points) own.add(p);
    sides[f] = side_of(own, all);
  }
  return sides;
}

/// Places of a face on its surface, also between the corners of its facets: corners alone may lie on a shape
/// that the face crosses. Of triangles from a file, corners only.
void add_places(const cad::Model& model, FaceId face, std::vector<Vec3>& places) {
  const cad::Facets facets = sampling_facets(model, face, true);
  places.insert(places.end(), facets.points.begin(), facets.points.end());
  const bool is_flat = model.is_planar(face);
  if (model.is_faceted(face) && !is_flat) return;
  for (const std::array<std::int32_t, 3>& v : facets.triangles) {
    const auto middle = [&](const auto& of) { return (1.0 / 3) * (of[v[0]] + of[v[1]] + of[v[2]]); };
    places.push_back(is_flat ? middle(facets.points) : model.face_point(face, middle(facets.uv)));
  }
}

/// The middle of a sphere, of a cylinder, or of half of one that ends at a side.
Vec3 middle_of(const Box& box, Side symmetry) {
  Vec3 middle = box.center();
  if (symmetry != no_side)
    middle[symmetry / 2] = symmetry % 2 == 0 ? box.low[symmetry / 2] : box.high[symmetry / 2];
  return middle;
}

/// Whether all places lie on the box, or on the sphere or a cylinder in it about a middle.
class OuterShape {
public:
  OuterShape(const Box& box, Vec3 middle)
      : _box(box), _middle(middle), _tolerance(on_shape * box.diagonal()) {}

  bool fits(const std::vector<Vec3>& places) const {
    return all(places, [&](Vec3 p) { return is_on(p, 0) || is_on(p, 1) || is_on(p, 2); }) ||
           all(places, [&](Vec3 p) { return is_round(norm(p - _middle), radius_around(3)); }) ||
           is_cylinder(places, 0) || is_cylinder(places, 1) || is_cylinder(places, 2);
  }

private:
  template <class Condition>
  static bool all(const std::vector<Vec3>& places, const Condition& condition) {
    return std::all_of(places.begin(), places.end(), condition);
  }
  bool is_on(Vec3 p, int axis) const {
    return std::min(std::abs(p[axis] - _box.low[axis]), std::abs(p[axis] - _box.high[axis])) <= _tolerance;
  }
  bool is_round(double distance, double radius) const { return std::abs(distance - radius) <= _tolerance; }
  /// The largest distance from the middle to a side, but along `axis`.
  double radius_around(int axis) const {
    double radius = 0;
    for (int other = 0; other < 3; ++other)
      if (other != axis)
        radius = std::max({radius, _box.high[other] - _middle[other], _middle[other] - _box.low[other]});
    return radius;
  }
  bool is_cylinder(const std::vector<Vec3>& places, int axis) const {
    const double radius = radius_around(axis);
    return all(places, [&](Vec3 p) {
      Vec3 across = p - _middle;
      across[axis] = 0;
      return is_on(p, axis) || is_round(norm(across), radius);
    });
  }

  const Box& _box;
  Vec3 _middle;
  double _tolerance;
};

/// The faces, with those of one side apart, in connected sets.
geometry::DisjointSets<FaceId> connect(const cad::Model& model, const std::vector<Side>& sides, Side apart) {
  geometry::DisjointSets<FaceId> sets(static_cast<std::size_t>(model.face_count()));
  const auto counts = [&](FaceId f) { return apart == no_side || sides[f] != apart; };
  for (cad::EdgeId e = 0; e < model.edge_count(); ++e) {
    FaceId first = cad::no_entity;
    for (const FaceId f : model.edge(e).faces) {
      if (!counts(f)) continue;
      if (first == cad::no_entity) first = f;
      sets.unite(first, f);
    }
  }
  return sets;
}

/// What a try to see the outer boundary as a far field found.
struct Judgement {
  enum class Reached { body, shape, distance, far_field } reached = Reached::body;
  std::string why = "the outer boundary holds no body";
  std::vector<FaceId> faces = {};  ///< of the far field
};

/// Judges the outer boundary, with one side apart.
class OuterBoundary {
public:
  OuterBoundary(const cad::Model& model, const std::vector<Side>& sides, Side symmetry)
      : _model(model), _sides(sides), _symmetry(symmetry), _sets(connect(model, sides, symmetry)) {}

  /// Whether anything is apart from the outer boundary, as a body is.
  bool may_hold_body() {
    FaceId first = cad::no_entity;
    for (FaceId f = 0; f < _model.face_count(); ++f) {
      if (is_apart(f)) continue;
      if (first == cad::no_entity) first = _sets.root(f);
      if (_sets.root(f) != first) return true;
    }
    return false;
  }

  Judgement judge(const std::vector<Box>& boxes) {
    find_outer(boxes);
    if (_outer == cad::no_entity) return {};
    Box body;
    std::vector<Vec3> places;
    std::vector<FaceId> outer;
    for (FaceId f = 0; f < _model.face_count(); ++f) {
      const bool is_outer = is_apart(f) || _sets.root(f) == _outer;
      if (is_outer) outer.push_back(f);
      if (!is_outer) body.add(boxes[f]);
      if (is_outer && !is_apart(f)) add_places(_model, f, places);
    }
    if (body.empty()) return {};
    const Box& all = _model.bounds();
    if (!OuterShape(all, middle_of(all, _symmetry)).fits(places))
      return {Judgement::Reached::shape,
              "the outer boundary is no box, sphere, cylinder or half of one in the axes"};
    Judgement judgement = judge_distances(body);
    if (judgement.reached == Judgement::Reached::far_field) judgement.faces = std::move(outer);
    return judgement;
  }

private:
  bool is_apart(FaceId f) const { return _symmetry != no_side && _sides[f] == _symmetry; }

  /// The set that reaches all sides.
  void find_outer(const std::vector<Box>& boxes) {
    std::vector<Box> of_set(boxes.size());
    for (FaceId f = 0; f < _model.face_count(); ++f)
      if (!is_apart(f)) of_set[_sets.root(f)].add(boxes[f]);
    const Box& all = _model.bounds();
    const double tolerance = facets_short_of_it * all.diagonal();
    for (FaceId f = 0; f < _model.face_count() && _outer == cad::no_entity; ++f)
      if (!of_set[f].empty() && of_set[f].dilated(tolerance).contains(all)) _outer = f;
  }

  Judgement judge_distances(const Box& given) const {
    const Box& all = _model.bounds();
    Box body = given;
    if (_symmetry != no_side) {  // with its mirror image
      const int axis = _symmetry / 2;
      const double plane = middle_of(all, _symmetry)[axis];
      const double reach = std::max(std::abs(body.low[axis] - plane), std::abs(body.high[axis] - plane));
      body.low[axis] = plane - reach, body.high[axis] = plane + reach;
    }
    const Vec3 size = body.size(), middle = body.center();
    const double extent = std::max({size.x, size.y, size.z});
    const double wanted = least_far_field_distance * extent * (1 - on_side);
    for (Side side = 0; side < side_count; ++side) {
      if (side == _symmetry) continue;
      const int axis = side / 2;
      const double distance = side % 2 == 0 ? middle[axis] - all.low[axis] : all.high[axis] - middle[axis];
      if (distance < wanted)
        return {Judgement::Reached::distance,
                fmt::format("its side {} is {:.3g} from the middle of the body, which is {:.3g} large; "
                            "{:g} times that is wanted",
                            side_names[side], distance, extent, least_far_field_distance)};
    }
    std::string why =
        "the outer boundary is a box, sphere or cylinder at least three times as large as the "
        "body";
    if (_symmetry != no_side) why += fmt::format(", {} apart", side_names[_symmetry]);
    return {Judgement::Reached::far_field, std::move(why)};
  }

  const cad::Model& _model;
  const std::vector<Side>& _sides;
  Side _symmetry;
  geometry::DisjointSets<FaceId> _sets;
  FaceId _outer = cad::no_entity;  // its lowest face
};

/// The boxes of all faces; each rank finds some.
std::vector<Box> boxes_of_faces(const parallel::Communicator& communicator, const cad::Model& model) {
  std::vector<Box> mine;
  parallel::collectively(communicator, parallel::ScopedCpu::As::task, [&] {
    for (FaceId f = communicator.rank(); f < model.face_count(); f += communicator.size()) {
      Box box;
      for (const Vec3 p : model.facets(f, box_deflection * model.bounds().diagonal(), box_angle).points)
        box.add(p);
      mine.push_back(box);
    }
  });
  const std::vector<Box> all = communicator.all_gather_items<Box>(mine);
  std::vector<Box> boxes(static_cast<std::size_t>(model.face_count()));
  std::size_t next = 0;
  for (int rank = 0; rank < communicator.size(); ++rank)
    for (FaceId f = rank; f < model.face_count(); f += communicator.size()) boxes[f] = all[next++];
  return boxes;
}

/// The farthest that a try with any side apart gets, or none.
Judgement judge_boundary(const parallel::Communicator& communicator, const cad::Model& model,
                         const std::vector<Side>& sides) {
  Judgement best;
  std::optional<std::vector<Box>> boxes;
  for (Side apart = no_side; apart < side_count; ++apart) {
    if (apart != no_side && std::find(sides.begin(), sides.end(), apart) == sides.end()) continue;
    OuterBoundary boundary(model, sides, apart);
    if (!boundary.may_hold_body()) continue;
    if (!boxes) boxes = boxes_of_faces(communicator, model);
    Judgement judgement;
    parallel::collectively(communicator, parallel::ScopedCpu::As::repeated,
                           [&] { judgement = boundary.judge(*boxes); });
    if (judgement.reached > best.reached) best = std::move(judgement);
    if (best.reached == Judgement::Reached::far_field) break;
  }
  return best;
}

std::string count_text(const std::vector<bool>& faces) {
  const auto count = std::count(faces.begin(), faces.end(), true);
  return fmt::format("{} face{}", count, count == 1 ? "" : "s");
}

}  // namespace

FarFieldFaces find_far_field(const parallel::Communicator& communicator, const cad::Model& model,
                             const std::vector<FaceRole>& roles) {
  FarFieldFaces far{std::vector<bool>(static_cast<std::size_t>(model.face_count()), false), {}};
  const auto has_role = [&](FaceId f, FaceRole role) { return !roles.empty() && roles[f] == role; };
  bool made = false, typed = false;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    made = made || model.is_far_field(f);
    const bool is_typed = has_role(f, FaceRole::far_field);
    typed = typed || (is_typed && !model.is_far_field(f));
    far.faces[f] = model.is_far_field(f) || is_typed;
  }
  if (made) {
    far.decision =
        "the far field that the program made" + std::string(typed ? ", and faces of its type" : "");
    return far;
  }
  for (FaceId f = 0; f < model.face_count(); ++f)
    if (typed && has_role(f, FaceRole::symmetry) && model.is_planar(f)) far.faces[f] = true;
  std::vector<Side> sides;
  parallel::collectively(communicator, parallel::ScopedCpu::As::repeated,
                         [&] { sides = sides_of_faces(model); });
  const Judgement judgement = judge_boundary(communicator, model, sides);
  const bool is_far = judgement.reached == Judgement::Reached::far_field;
  for (const FaceId f : judgement.faces)
    if (!has_role(f, FaceRole::wall)) far.faces[f] = true;
  if (is_far && std::count(far.faces.begin(), far.faces.end(), true) == 0)
    far.decision =
        "none, all faces are sized as walls: the outer boundary is a far field, but its faces are of type "
        "wall";
  else if (is_far)
    far.decision = fmt::format("{}: {}", count_text(far.faces), judgement.why);
  else if (typed)
    far.decision = fmt::format("{} by type", count_text(far.faces));
  else
    far.decision = fmt::format(
        "none, all faces are sized as walls: {}; `type: farfield` of a patch overrules "
        "this",
        judgement.why);
  return far;
}

}  // namespace aeroloom::sizing
