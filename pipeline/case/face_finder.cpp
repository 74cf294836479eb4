#include "pipeline/case/face_finder.hpp"

#include "cad/model/patches.hpp"
#include "cad/tolerances.hpp"
#include "geometry/angle.hpp"
#include "pipeline/case/box_sides.hpp"
#include "pipeline/case/face_texts.hpp"
#include "pipeline/case/nearest_name.hpp"

#include <algorithm>
#include <numbers>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

/// Of a face's area: what is left of the area vector of a closed face is the error of integrals, and no
/// direction.
constexpr double least_area_vector = 1e-3;
constexpr std::size_t most_names = 5;  // in a message

void keep_common(std::vector<char>& faces, const std::vector<char>& others) {
  for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = faces[f] && others[f];
}

void add_all(std::vector<char>& faces, const std::vector<char>& others) {
  for (std::size_t f = 0; f < faces.size(); ++f) faces[f] = faces[f] || others[f];
}

/// The words of a pattern that is an expression may be near a name.
std::string without_mark(const std::string& pattern) {
  return pattern.starts_with("re:") ? pattern.substr(3) : pattern;
}

bool has_far_field(const cad::Model& model) {
  for (cad::FaceId f = 0; f < model.face_count(); ++f)
    if (model.is_far_field(f)) return true;
  return false;
}

}  // namespace

const std::vector<char>& FaceFinder::faces_of(std::size_t rule) {
  if (!_selected[rule].empty() || _model.face_count() == 0) return _selected[rule];
  const GroupRule& r = _rules[rule];
  if (_busy[rule])
    throw std::invalid_argument(
        fmt::format("{}: it is next to a group that is next to it. Remedy: 'adjacent_to' in one of the two "
                    "alone",
                    origin_of(r)));
  _busy[rule] = 1;
  std::vector<char> faces;
  if (r.all.empty() && r.any.empty() && r.except.empty()) {
    FaceConditions of_this_name;
    of_this_name.faces = {r.name};
    faces = meet(of_this_name, r);
  } else {
    faces = meet(r.all, r);
  }
  if (!r.any.empty()) {
    std::vector<char> some(faces.size(), 0);
    for (const FaceConditions& each : r.any) add_all(some, meet(each, r));
    keep_common(faces, some);
  }
  for (const FaceConditions& each : r.except) {
    std::vector<char> others = meet(each, r);
    for (char& other : others) other = !other;
    keep_common(faces, others);
  }
  _busy[rule] = 0;
  // The far field and the plane of symmetry are no faces of the file: a group has them that names them.
  for (cad::FaceId f = 0; f < _model.face_count(); ++f)
    if (faces[f] && _model.is_far_field(f) && !names(r, f)) faces[f] = 0;
  return _selected[rule] = std::move(faces);
}

bool FaceFinder::names(const GroupRule& rule, cad::FaceId face) const {
  const auto is_named = [&](const std::string& text) {
    return text == _model.face(face).name || text == _model.patches()[_model.face(face).patch];
  };
  const auto name = [&](const FaceConditions& c) {
    return std::any_of(c.faces.begin(), c.faces.end(), is_named);
  };
  return is_named(rule.name) || name(rule.all) || std::any_of(rule.any.begin(), rule.any.end(), name);
}

std::vector<FoundFaces> FaceFinder::explain(std::size_t rule) {
  const GroupRule& r = _rules[rule];
  std::vector<FoundFaces> found = look(r.all, r);
  if (!r.any.empty()) {
    std::vector<char> some(static_cast<std::size_t>(_model.face_count()), 0);
    for (const FaceConditions& each : r.any) add_all(some, meet(each, r));
    found.push_back({"by 'any'", some});
  }
  if (!r.except.empty()) {
    std::vector<char> left(static_cast<std::size_t>(_model.face_count()), 0);
    for (const FaceConditions& each : r.except) add_all(left, meet(each, r));
    for (char& each : left) each = !each;
    found.push_back({"not in 'except'", left});
  }
  return found;
}

std::vector<char> FaceFinder::meet(const FaceConditions& conditions, const GroupRule& rule) {
  std::vector<char> faces(static_cast<std::size_t>(_model.face_count()), 1);
  for (const FoundFaces& each : look(conditions, rule)) keep_common(faces, each.faces);
  return faces;
}

std::vector<FoundFaces> FaceFinder::look(const FaceConditions& c, const GroupRule& rule) {
  std::vector<FoundFaces> found;
  if (!c.faces.empty())
    found.push_back({"by name", with_names(c.faces, rule, "name", [this](cad::FaceId f) {
                       return std::vector{_model.face(f).name, _model.patches()[_model.face(f).patch]};
                     })});
  if (!c.parts.empty())
    found.push_back({"by part", with_names(c.parts, rule, "part", [this](cad::FaceId f) {
                       return std::vector{_model.face(f).part};
                     })});
  if (!c.layers.empty())
    found.push_back({"by layer", with_names(c.layers, rule, "layer", [this](cad::FaceId f) {
                       return std::vector{_model.face(f).layer};
                     })});
  if (!c.colors.empty()) found.push_back({"by color", with_colors(c.colors, rule)});
  if (!c.ids.empty()) found.push_back({"by id", with_numbers(c.ids, rule)});
  if (c.box) {
    geometry::Box box;
    box.add(c.box->first);
    box.add(c.box->second);
    found.push_back({"in the box", within_box(box)});
  }
  if (c.normal) found.push_back({"by normal", with_direction(*c.normal, c.within.value_or(default_within))});
  if (c.area)
    found.push_back({"by area", where([&](cad::FaceId f) {
                       const double area = _model.face_area(f);
                       const double rounding = cad::tolerances::rounding * area;
                       return area >= c.area->first - rounding && area <= c.area->second + rounding;
                     })});
  if (!c.adjacent_to.empty()) found.push_back({"beside 'adjacent_to'", beside(c.adjacent_to, rule)});
  return found;
}

std::vector<char> FaceFinder::where(const std::function<bool(cad::FaceId)>& holds) const {
  std::vector<char> faces(static_cast<std::size_t>(_model.face_count()), 0);
  for (cad::FaceId f = 0; f < _model.face_count(); ++f) faces[f] = holds(f) ? 1 : 0;
  return faces;
}

void FaceFinder::refuse(const GroupRule& rule, const char* what, const std::string& text,
                        const Names& names) const {
  std::set<std::string> known;
  for (cad::FaceId f = 0; f < _model.face_count(); ++f)
    for (const std::string& name : names(f)) known.insert(name);
  known.erase("");
  std::vector<std::string> near(known.begin(), known.end());
  const std::string wanted = without_mark(text);
  std::stable_sort(near.begin(), near.end(), [&](const std::string& a, const std::string& b) {
    return edit_distance(wanted, a) < edit_distance(wanted, b);
  });
  if (near.size() > most_names) near.resize(most_names);
  const std::string nearest =
      near.empty() ? fmt::format("the geometry gives no face a {}", what)
                   : fmt::format("the nearest that faces have are '{}'", fmt::join(near, "', '"));
  throw std::invalid_argument(
      fmt::format("{}: no face has a {} like '{}'; {}{}. Remedy: `aeroloom info FILE` lists "
                  "them; `optional: true` where the group may be empty",
                  origin_of(rule), what, text, nearest, hint_on_box_sides(_model, text)));
}

std::vector<char> FaceFinder::with_names(const std::vector<std::string>& patterns, const GroupRule& rule,
                                         const char* what, const Names& names) const {
  std::vector<char> faces(static_cast<std::size_t>(_model.face_count()), 0);
  for (const std::string& text : patterns) {
    const cad::NamePattern pattern(text);
    const std::vector<char> more = where([&](cad::FaceId f) {
      const std::vector<std::string> own = names(f);
      return std::any_of(own.begin(), own.end(),
                         [&](const std::string& name) { return !name.empty() && pattern.matches(name); });
    });
    if (!rule.optional && std::find(more.begin(), more.end(), 1) == more.end())
      refuse(rule, what, text, names);
    add_all(faces, more);
  }
  return faces;
}

std::vector<char> FaceFinder::with_colors(const std::vector<std::string>& colors,
                                          const GroupRule& rule) const {
  std::vector<std::string> plain;
  plain.reserve(colors.size());
  for (const std::string& color : colors) plain.push_back(plain_color(color).value_or(color));
  return with_names(plain, rule, "color",
                    [this](cad::FaceId f) { return std::vector{_model.face(f).colour}; });
}

std::vector<char> FaceFinder::with_numbers(const std::vector<std::string>& ids, const GroupRule& rule) const {
  std::vector<char> faces(static_cast<std::size_t>(_model.face_count()), 0);
  for (const std::string& text : ids) {
    const NumberRange range = number_range(text).value_or(NumberRange{});
    const std::vector<char> more = where([&](cad::FaceId f) {
      const std::int32_t number = _model.face(f).number;
      return number >= 0 && number >= range.first && number <= range.last;
    });
    if (!rule.optional && std::find(more.begin(), more.end(), 1) == more.end()) {
      std::int32_t largest = -1;
      for (cad::FaceId f = 0; f < _model.face_count(); ++f)
        largest = std::max(largest, _model.face(f).number);
      throw std::invalid_argument(
          fmt::format("{}: no face has the id {}; the largest is {}. Remedy: `aeroloom check` of the case "
                      "without this group writes the ids of all faces to check.json",
                      origin_of(rule), text, largest));
    }
    add_all(faces, more);
  }
  return faces;
}

std::vector<char> FaceFinder::within_box(const geometry::Box& box) const {
  // What lies on its border lies within, as far as a file separates the two.
  const geometry::Box around = box.dilated(cad::tolerances::same_place * _model.body_bounds().diagonal());
  return where([&](cad::FaceId f) {
    // The box of a face takes long; its corners mostly decide that it is not within.
    for (const auto& loop : _model.face(f).loops)
      for (const cad::Coedge& use : loop)
        if (!around.contains(_model.vertex(_model.edge(use.edge).first))) return false;
    const geometry::Box face = _model.face_place(f).box;
    return around.contains(face.low) && around.contains(face.high);
  });
}

std::vector<char> FaceFinder::with_direction(geometry::Vec3 direction, double within) const {
  // Of a body the solid of the CAD is what is not meshed, and the model's normals point into it.
  const bool bodies = has_far_field(_model);
  return where([&](cad::FaceId f) {
    geometry::Vec3 normal = _model.face_area_vector(f);
    if (bodies && !_model.is_far_field(f)) normal = -normal;
    if (norm(normal) <= least_area_vector * _model.face_area(f)) return false;
    double turned = angle_between(normal, direction);
    // A face between two regions looks both ways.
    if (_model.face(f).back != cad::no_entity) turned = std::min(turned, std::numbers::pi - turned);
    return turned <= within * geometry::degree;
  });
}

std::vector<char> FaceFinder::beside(const std::vector<std::string>& others, const GroupRule& rule) {
  std::vector<char> those(static_cast<std::size_t>(_model.face_count()), 0);
  for (const std::string& other : others) {
    const auto group =
        std::find_if(_rules.begin(), _rules.end(), [&](const GroupRule& each) { return each.name == other; });
    if (group != _rules.end()) {
      add_all(those, faces_of(static_cast<std::size_t>(group - _rules.begin())));
      continue;
    }
    FaceConditions by_name;
    by_name.faces = {other};
    add_all(those, meet(by_name, rule));
  }
  return where([&](cad::FaceId f) {
    if (those[f]) return false;
    for (const auto& loop : _model.face(f).loops)
      for (const cad::Coedge& use : loop)
        for (const cad::FaceId next : _model.edge(use.edge).faces)
          if (those[next]) return true;
    return false;
  });
}

}  // namespace aeroloom::cases
