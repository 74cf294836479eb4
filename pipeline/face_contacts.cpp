#include "geometry/triangle_contact.hpp"
#include "mesh/checks/triangle_contact.hpp"
#include "pipeline/check.hpp"
#include "sizing/features/model_sources.hpp"
#include "sizing/features/ray_tree.hpp"

#include <set>
#include <utility>
#include <vector>

namespace aeroloom::pipeline {
namespace {

struct Facet {
  sizing::Triangle corners;
  cad::FaceId face;
};

/// Of the body, those that sizes were sampled on.
std::vector<Facet> collect_facets(const cad::Model& model) {
  std::vector<Facet> facets;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.is_far_field(f)) continue;
    const cad::Facets of_face = sizing::sampling_facets(model, f, false);
    for (const auto& t : of_face.triangles) {
      facets.push_back({{of_face.points[t[0]], of_face.points[t[1]], of_face.points[t[2]]}, f});
    }
  }
  return facets;
}

/// Which faces share a vertex.
class Neighbours {
public:
  explicit Neighbours(const cad::Model& model) {
    std::vector<std::vector<cad::FaceId>> around(model.vertex_count());
    for (cad::FaceId f = 0; f < model.face_count(); ++f) {
      for (const auto& loop : model.face(f).loops) {
        for (const cad::Coedge& use : loop) {
          around[model.edge(use.edge).first].push_back(f);
          around[model.edge(use.edge).last].push_back(f);
        }
      }
    }
    for (const std::vector<cad::FaceId>& faces : around) {
      for (const cad::FaceId a : faces) {
        for (const cad::FaceId b : faces) _pairs.insert({a, b});
      }
    }
  }
  bool are(cad::FaceId a, cad::FaceId b) const { return _pairs.contains({a, b}); }

private:
  std::set<std::pair<cad::FaceId, cad::FaceId>> _pairs;
};

std::vector<sizing::Triangle> corners_of(const std::vector<Facet>& facets) {
  std::vector<sizing::Triangle> corners;
  corners.reserve(facets.size());
  for (const Facet& facet : facets) corners.push_back(facet.corners);
  return corners;
}

mesh::NamedTriangle named(const Facet& facet, std::int64_t index) {
  mesh::NamedTriangle triangle;
  for (int k = 0; k < 3; ++k) {
    triangle.points[k] = facet.corners[k];
    triangle.names[k] = {index, static_cast<std::uint64_t>(k)};
  }
  return triangle;
}

}  // namespace

std::vector<FaceContact> find_face_contacts(const cad::Model& model, std::size_t most, std::int64_t& count) {
  const std::vector<Facet> facets = collect_facets(model);
  const Neighbours neighbours(model);
  const sizing::RayTree tree(corners_of(facets));
  std::set<std::pair<cad::FaceId, cad::FaceId>> met;
  std::vector<FaceContact> contacts;
  std::vector<std::int32_t> near;
  std::int64_t nodes = 0;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Facet& a = facets[i];
    const auto counts = [&](std::int32_t other) {
      const Facet& b = facets[other];
      return a.face < b.face && !neighbours.are(a.face, b.face) && !met.contains({a.face, b.face});
    };
    tree.find_near(a.corners, 0, counts, near, nodes);
    for (const std::int32_t other : near) {
      const Facet& b = facets[other];
      if (met.contains({a.face, b.face})) continue;
      const mesh::NamedTriangle first = named(a, static_cast<std::int64_t>(i)), second = named(b, other);
      if (!mesh::meet_wrongly(first, second)) continue;
      met.insert({a.face, b.face});
      if (contacts.size() < most)
        contacts.push_back({a.face, b.face, geometry::place_of_meeting(first.points, second.points)});
    }
  }
  count = static_cast<std::int64_t>(met.size());
  return contacts;
}

}  // namespace aeroloom::pipeline
