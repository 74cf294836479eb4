/// Properties that every model has, whatever its shape.
#pragma once

#include "cad/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::cad::checks {

inline Vec2 start_uv(const Model& model, FaceId face, const Coedge& use) {
  const Edge& edge = model.edge(use.edge);
  return model.edge_uv(face, use, use.reversed ? edge.last_parameter : edge.first_parameter);
}

inline Vec2 end_uv(const Model& model, FaceId face, const Coedge& use) {
  const Edge& edge = model.edge(use.edge);
  return model.edge_uv(face, use, use.reversed ? edge.first_parameter : edge.last_parameter);
}

/// Each loop runs head to tail in space, and each pair (edge, use) is passed once.
inline void expect_closed_loops(const Model& model, double tolerance) {
  for (FaceId f = 0; f < model.face_count(); ++f) {
    std::map<std::pair<EdgeId, int>, int> coedges;
    ASSERT_FALSE(model.face(f).loops.empty() && model.facets(f, 1, 1).boundary.size() > 0);
    for (const auto& loop : model.face(f).loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Coedge& here = loop[i];
        const Coedge& next = loop[(i + 1) % loop.size()];
        EXPECT_EQ(++coedges[std::pair(here.edge, here.use)], 1);
        const VertexId end = here.reversed ? model.edge(here.edge).first : model.edge(here.edge).last;
        const VertexId start = next.reversed ? model.edge(next.edge).last : model.edge(next.edge).first;
        EXPECT_EQ(end, start) << "face " << f;
        EXPECT_LT(distance(model.face_point(f, end_uv(model, f, here)), model.vertex(end)), tolerance)
            << "face " << f << " edge " << here.edge;
        const auto& users = model.edge(here.edge).faces;
        EXPECT_TRUE(std::binary_search(users.begin(), users.end(), f));
      }
    }
  }
}

/// On the boundary of a solid each proper edge is passed twice, in opposite directions.
inline void expect_watertight(const Model& model) {
  std::vector<int> forward(model.edge_count()), backward(model.edge_count());
  for (FaceId f = 0; f < model.face_count(); ++f) {
    EXPECT_NE(model.face(f).front, no_entity);
    if (model.face(f).back != no_entity) continue;
    for (const auto& loop : model.face(f).loops) {
      for (const Coedge& use : loop) ++(use.reversed ? backward : forward)[use.edge];
    }
  }
  for (EdgeId e = 0; e < model.edge_count(); ++e) {
    if (model.edge(e).degenerate) continue;
    EXPECT_EQ(forward[e], backward[e]) << "edge " << e;
  }
}

/// Volume by the divergence theorem over the facets of all faces: positive when normals point outward.
inline double facets_volume(const Model& model, double deflection, double angle) {
  double six_volumes = 0;
  for (FaceId f = 0; f < model.face_count(); ++f) {
    if (model.face(f).back != no_entity) continue;
    const Facets facets = model.facets(f, deflection, angle);
    for (const auto& t : facets.triangles) {
      six_volumes += dot(facets.points[t[0]], cross(facets.points[t[1]], facets.points[t[2]]));
    }
  }
  return six_volumes / 6;
}

/// Facets lie on their face, their uv belong to their points, their boundary lines follow the edges, and they
/// are turned like the face's normal.
inline void expect_sound_facets(const Model& model, FaceId f, double deflection, double angle,
                                double tolerance) {
  const Facets facets = model.facets(f, deflection, angle);
  ASSERT_FALSE(facets.triangles.empty());
  ASSERT_EQ(facets.points.size(), facets.uv.size());
  std::size_t uses = 0;
  for (const auto& loop : model.face(f).loops) uses += loop.size();
  EXPECT_EQ(facets.boundary.size(), uses) << "face " << f;
  for (std::size_t i = 0; i < facets.points.size(); ++i) {
    EXPECT_LT(distance(model.face_point(f, facets.uv[i]), facets.points[i]), tolerance) << "face " << f;
  }
  for (const auto& line : facets.boundary) {
    const Edge& edge = model.edge(line.use.edge);
    EXPECT_DOUBLE_EQ(line.parameters.front(), edge.first_parameter);
    EXPECT_DOUBLE_EQ(line.parameters.back(), edge.last_parameter);
    EXPECT_TRUE(std::is_sorted(line.parameters.begin(), line.parameters.end()));
    for (std::size_t i = 0; i < line.nodes.size(); ++i) {
      const Vec3 on_edge = model.edge_point(line.use.edge, line.parameters[i]);
      EXPECT_LT(distance(on_edge, facets.points[line.nodes[i]]), tolerance)
          << "face " << f << " edge " << line.use.edge;
      const Vec2 uv = model.edge_uv(f, line.use, line.parameters[i]);
      EXPECT_LT(distance(model.face_point(f, uv), facets.points[line.nodes[i]]), tolerance);
    }
  }
  double along = 0, total = 0;
  for (const auto& t : facets.triangles) {
    const Vec3 area =
        0.5 * cross(facets.points[t[1]] - facets.points[t[0]], facets.points[t[2]] - facets.points[t[0]]);
    const Vec2 uv = (facets.uv[t[0]] + facets.uv[t[1]] + facets.uv[t[2]]) / 3.0;
    along += dot(area, model.face_frame(f, uv).normal);
    total += norm(area);
  }
  EXPECT_GT(along, 0.7 * total) << "face " << f;
}

}  // namespace aeroloom::cad::checks
