#include "geometry/box_tree.hpp"
#include "pipeline/check.hpp"
#include "sizing/model_sources.hpp"
#include "surface/triangle_contact.hpp"

#include <algorithm>
#include <iterator>
#include <set>

namespace aeroloom::pipeline {
namespace {

struct Facet {
  geometry::Vec3 corners[3];
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

/// The vertices around each face, ascending.
std::vector<std::vector<cad::VertexId>> vertices_of_faces(const cad::Model& model) {
  std::vector<std::vector<cad::VertexId>> vertices(model.face_count());
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    for (const auto& loop : model.face(f).loops) {
      for (const cad::EdgeUse& use : loop) {
        vertices[f].push_back(model.edge(use.edge).first);
        vertices[f].push_back(model.edge(use.edge).last);
      }
    }
    std::sort(vertices[f].begin(), vertices[f].end());
  }
  return vertices;
}

bool share_vertex(const std::vector<cad::VertexId>& a, const std::vector<cad::VertexId>& b) {
  std::vector<cad::VertexId> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return !common.empty();
}

surface::NamedTriangle named(const Facet& facet, std::int64_t index) {
  surface::NamedTriangle triangle;
  for (int k = 0; k < 3; ++k) {
    triangle.points[k] = facet.corners[k];
    triangle.names[k] = {index, static_cast<std::uint64_t>(k)};
  }
  return triangle;
}

}  // namespace

std::vector<FaceContact> find_face_contacts(const cad::Model& model, std::size_t most, std::int64_t& count) {
  const std::vector<Facet> facets = collect_facets(model);
  const auto vertices = vertices_of_faces(model);
  std::vector<geometry::Box> boxes;
  for (const Facet& facet : facets) {
    geometry::Box& box = boxes.emplace_back();
    for (const geometry::Vec3 corner : facet.corners) box.add(corner);
  }
  const geometry::BoxTree tree(boxes, 8);
  std::set<std::pair<cad::FaceId, cad::FaceId>> met;
  std::vector<FaceContact> contacts;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    geometry::for_each_overlap(tree, boxes, boxes[i], [&](std::int32_t other) {
      const Facet &a = facets[i], &b = facets[other];
      if (a.face >= b.face || met.contains({a.face, b.face})) return;
      if (share_vertex(vertices[a.face], vertices[b.face])) return;
      if (!surface::meet_wrongly(named(a, static_cast<std::int64_t>(i)), named(b, other))) return;
      met.insert({a.face, b.face});
      if (contacts.size() < most) {
        contacts.push_back({a.face, b.face, (a.corners[0] + a.corners[1] + a.corners[2]) / 3});
      }
    });
  }
  count = static_cast<std::int64_t>(met.size());
  return contacts;
}

}  // namespace aeroloom::pipeline
