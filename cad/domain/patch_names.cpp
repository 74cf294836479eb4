#include "cad/domain/patch_names.hpp"

#include "cad/model/shape_map.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <BRepGProp.hxx>
#include <GProp_GProps.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// The first of NAME, NAME_2, NAME_3, ... that is not in use.
std::string free_name(const std::string& name, const std::set<std::string>& used) {
  std::string free = name;
  for (int k = 2; used.contains(free); ++k) free = fmt::format("{}_{}", name, k);
  return free;
}

/// Lengths of the common borders of caps and walls.
using CapBorders = std::map<std::pair<FaceId, FaceId>, double>;

/// Of equally long borders that with the first face counts.
void join_to_longest(const CapBorders& borders, std::vector<FaceTag>& tags, Changes& changes) {
  std::map<FaceId, std::pair<FaceId, double>> wall_of;
  for (const auto& [faces, length] : borders) {
    const auto [cap, wall] = faces;
    const auto found = wall_of.try_emplace(cap, wall, length).first;
    if (length > found->second.second) found->second = {wall, length};
  }
  for (const auto& [cap, found] : wall_of) {
    const FaceTag& wall = tags[found.first];
    FaceTag& tag = tags[cap];
    tag.patch = wall.patch, tag.part = wall.part, tag.origin = wall.origin;
    changes.push_back(
        {fmt::format("face '{}' belongs to the patch '{}' of the wall around it "
                     "(DomainOptions::caps gives it a patch of its own)",
                     tag.name, tag.patch)});
  }
}

double length_of_edge(const TopoDS_Shape& edge) {
  GProp_GProps properties;
  BRepGProp::LinearProperties(edge, properties);
  return properties.Mass();
}

const char* what_has(PatchOrigin origin) {
  switch (origin) {
    case PatchOrigin::program:
      return "the far field or its plane of symmetry has this name";
    case PatchOrigin::file:
      return "the file has this name for other faces";
    case PatchOrigin::unnamed:
      return "faces without a name in the file are called so";
    case PatchOrigin::part:
      break;
  }
  return "another part is called so";
}

}  // namespace

InterfaceNames::InterfaceNames(std::vector<std::string> regions) : _regions(std::move(regions)) {
  for (std::size_t r = 0; r < _regions.size(); ++r) {
    if (_regions[r].empty() || _regions[r] == fmt::format("region_{}", r)) _regions[r] = std::to_string(r);
  }
}

std::string InterfaceNames::operator()(int region, int other) {
  const std::pair<int, int> key = std::minmax(region, other);
  const auto known = _known.find(key);
  if (known != _known.end()) return known->second;
  const auto name_of = [&](int r) {
    return static_cast<std::size_t>(r) < _regions.size() ? _regions[r] : std::to_string(r);
  };
  std::string name =
      free_name(fmt::format("interface_{}_{}", name_of(key.first), name_of(key.second)), _used);
  _used.insert(name);
  _known.emplace(key, name);
  return name;
}

void join_caps(const NamedShape& named, std::vector<FaceTag>& tags, Changes& changes) {
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  const auto is_cap = [&](int face) {
    const FaceLabel* label = named.labels.Seek(faces(face));
    return label != nullptr && label->cap;
  };
  bool any = false;
  for (int f = 1; f <= faces.Extent(); ++f) any = any || is_cap(f);
  if (!any) return;
  TopTools_IndexedDataMapOfShapeListOfShape users;
  TopExp::MapShapesAndUniqueAncestors(named.shape, TopAbs_EDGE, TopAbs_FACE, users);
  CapBorders borders;
  for (int e = 1; e <= users.Extent(); ++e) {
    std::vector<int> caps, walls;
    for (const TopoDS_Shape& face : users(e)) {
      const int f = faces.FindIndex(face);
      if (is_cap(f))
        caps.push_back(f - 1);
      else if (tags[f - 1].origin != PatchOrigin::program)
        walls.push_back(f - 1);
    }
    if (caps.empty()) continue;
    const double length = length_of_edge(users.FindKey(e));
    for (const int cap : caps)
      for (const int wall : walls) borders[{cap, wall}] += length;
  }
  join_to_longest(borders, tags, changes);
}

void join_caps(const FacetComplex& complex, std::vector<FaceTag>& tags, Changes& changes) {
  if (std::ranges::none_of(complex.faces, [](const auto& face) { return face.cap; })) return;
  using Side = std::pair<std::int32_t, std::int32_t>;
  const auto each_side = [&](bool of_caps, const auto& visit) {
    for (std::size_t t = 0; t < complex.triangles.size(); ++t) {
      const FaceId face = complex.face_of[t];
      if (complex.faces[face].cap != of_caps) continue;
      for (int i = 0; i < 3; ++i) {
        const std::int32_t a = complex.triangles[t][i], b = complex.triangles[t][(i + 1) % 3];
        visit(face, Side(std::min(a, b), std::max(a, b)));
      }
    }
  };
  std::map<Side, FaceId> cap_at;
  each_side(true, [&](FaceId cap, const Side& side) { cap_at.emplace(side, cap); });
  CapBorders borders;
  each_side(false, [&](FaceId wall, const Side& side) {
    const auto cap = cap_at.find(side);
    if (cap == cap_at.end() || tags[wall].origin == PatchOrigin::program) return;
    borders[{cap->second, wall}] += distance(complex.points[side.first], complex.points[side.second]);
  });
  join_to_longest(borders, tags, changes);
}

void separate_patches(std::vector<FaceTag>& tags, Changes& changes) {
  constexpr std::array order{PatchOrigin::program, PatchOrigin::file, PatchOrigin::unnamed,
                             PatchOrigin::part};
  using Owner = std::pair<PatchOrigin, std::string>;  // with the name of the part
  const auto owner_of = [](const FaceTag& tag) {
    return Owner(tag.origin, tag.origin == PatchOrigin::part ? tag.part : std::string());
  };
  std::map<std::string, Owner> owners;
  for (const PatchOrigin origin : order) {
    for (const FaceTag& tag : tags)
      if (tag.origin == origin) owners.try_emplace(tag.patch, owner_of(tag));
  }
  std::set<std::string> used;
  for (const auto& [name, owner] : owners) used.insert(name);
  std::map<std::pair<Owner, std::string>, std::string> renamed;
  for (FaceTag& tag : tags) {
    const Owner& first = owners.at(tag.patch);
    if (tag.patch.empty() || owner_of(tag) == first) continue;
    const std::pair key(owner_of(tag), tag.patch);
    auto found = renamed.find(key);
    if (found == renamed.end()) {
      found = renamed.emplace(key, free_name(tag.patch, used)).first;
      used.insert(found->second);
      changes.push_back(
          {fmt::format("{}the patch '{}' of face '{}' is called '{}': {}",
                       tag.origin == PatchOrigin::part ? fmt::format("part '{}': ", tag.part) : "", tag.patch,
                       tag.name, found->second, what_has(first.first)),
           {},
           0,
           true});
    }
    tag.patch = found->second;
  }
}

}  // namespace aeroloom::cad
