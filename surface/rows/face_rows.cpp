#include "surface/rows/face_rows.hpp"

#include "geometry/box_tree.hpp"
#include "geometry/predicates.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "surface/curves/border_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// A row is as high as wanted to this fraction, and turns with the surface by less than the angle of this
/// cosine (20 degrees). Chosen, not measured.
constexpr double height_tolerance = 0.02, least_turning_cosine = 0.94;

/// Between the highest row and what lies ahead of it, in segments of the edge; chosen, not measured. Less is
/// ahead where the cosine between the way there and the column is below the second.
constexpr double least_margin = 0.7, least_ahead = 0.7;

/// How far columns can go before they meet the border of their face, or rows on the other side of it.
class RowRoom {
public:
  RowRoom(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
          std::span<const EdgeRows> rows) {
    for (const auto& loop : model.face(face).loops) {
      for (const cad::Coedge& use : loop) {
        const std::vector<CurveVertex> chain = curves.chain(model, use.edge);
        for (std::size_t i = 1; i < chain.size(); ++i) {
          _segments.push_back(
              {curves.points[chain[i - 1]], curves.points[chain[i]], use.edge, rows[use.edge].height > 0});
          geometry::Box box;
          box.add(_segments.back().from), box.add(_segments.back().to);
          _boxes.push_back(box);
        }
      }
    }
    _tree.emplace(_boxes, segments_per_leaf);
  }

  /// Along a column of an edge; half of it where rows come from the other side. Up to `most`.
  double along(cad::EdgeId edge, Vec3 foot, Vec3 direction, double most) const {
    geometry::Box reach;
    reach.add(foot), reach.add(foot + most * direction);
    double room = most;
    geometry::for_each_overlap(*_tree, _boxes, reach.dilated(most), [&](std::int32_t s) {
      const Segment& segment = _segments[s];
      if (segment.edge == edge) return;
      // The nearest point of the segment to the foot, and its ends.
      const Vec3 along = segment.to - segment.from;
      const double at = std::clamp(dot(foot - segment.from, along) / dot(along, along), 0.0, 1.0);
      for (const Vec3 point : {segment.from, segment.from + at * along, segment.to}) {
        const Vec3 way = point - foot;
        const double ahead = dot(way, direction);
        if (ahead >= least_ahead * norm(way)) room = std::min(room, segment.has_rows ? 0.5 * ahead : ahead);
      }
    });
    return room;
  }

private:
  static constexpr int segments_per_leaf = 8;
  struct Segment {
    Vec3 from, to;
    cad::EdgeId edge;
    bool has_rows;
  };
  std::vector<Segment> _segments;
  std::vector<geometry::Box> _boxes;
  std::optional<geometry::BoxTree> _tree;
};

/// Goes from a point of a face over its surface.
class Walk {
public:
  Walk(const cad::Model& model, cad::FaceId face, const RowVertex& from, Vec3 direction)
      : _model(model), _face(face), _at(from), _direction(direction) {}

  const RowVertex& at() const { return _at; }

  /// Goes on by a length, measured straight. False where the surface does not go on like that.
  bool advance(double length) {
    const std::optional<Vec2> start = guess(length);
    if (!start) return false;
    cad::Projection to = _model.project(_face, _at.point + length * _direction, *start);
    for (int correction = 0; correction < 2; ++correction) {
      const double gone = distance(to.point, _at.point);
      if (!to.converged || !(gone > 0)) return false;
      to = _model.project(_face, _at.point + (length / gone) * (to.point - _at.point), to.uv);
    }
    const bool is_near = distance(to.uv, *start) <= distance(*start, _at.uv);  // no jump over a seam
    if (!to.converged || !is_near ||
        std::abs(distance(to.point, _at.point) - length) > height_tolerance * length)
      return false;
    const Vec3 normal = _model.face_frame(_face, to.uv).normal;
    const Vec3 along = _direction - dot(_direction, normal) * normal;
    if (!(norm(normal) > 0) || dot(_direction, along) < least_turning_cosine * norm(along)) return false;
    _at = {to.point, to.uv};
    _direction = normalized(along);
    return true;
  }

private:
  /// Parameters at the end of a straight step.
  std::optional<Vec2> guess(double length) const {
    const cad::SurfaceFrame frame = _model.face_frame(_face, _at.uv);
    const double uu = dot(frame.du, frame.du), uv = dot(frame.du, frame.dv), vv = dot(frame.dv, frame.dv);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return std::nullopt;
    const double u = length * dot(frame.du, _direction), v = length * dot(frame.dv, _direction);
    return _at.uv + Vec2{(vv * u - uv * v) / determinant, (uu * v - uv * u) / determinant};
  }

  const cad::Model& _model;
  cad::FaceId _face;
  RowVertex _at;
  Vec3 _direction;
};

class RowFinder {
public:
  RowFinder(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
            std::span<const EdgeRows> rows)
      : _model(model), _curves(curves), _room(model, face, curves, rows) {
    _found.face = face;
  }

  void add_strip(const cad::Coedge& use, const EdgeRows& rows) {
    RowStrip strip{use, _curves.chain(_model, use.edge), _curves.chain_parameters(_model, use.edge), {}, {0},
                   {}};
    std::vector<Vec3> points;
    for (const CurveVertex v : strip.chain) points.push_back(_curves.points[v]);
    const std::vector<int> counts = count_rows(points, rows);
    strip.tops.assign(counts.size(), -1);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      add_column(strip, i, counts[i], rows);
      strip.first.push_back(strip.vertices.size());
    }
    if (strip.empty()) return;
    find_turned(strip);
    for (std::size_t i = 0; i < counts.size(); ++i) {
      if (strip.rows_at(i) > 0) strip.tops[i] = _tops++;
    }
    _found.strips.push_back(std::move(strip));
  }

  FaceRows take() { return std::move(_found); }

private:
  void add_column(RowStrip& strip, std::size_t i, int count, const EdgeRows& rows) {
    if (count == 0) return;
    const double t = strip.parameters[i];
    const RowVertex foot = foot_of(strip, i);
    const Vec3 tangent = _model.edge_tangent(strip.use.edge, t);
    const Vec3 inside =
        cross(_model.face_frame(_found.face, foot.uv).normal, strip.use.reversed ? -tangent : tangent);
    if (!(norm(inside) > 0)) return fail(strip, i);
    if (!has_room(strip, i, count, rows, normalized(inside))) return;
    Walk walk(_model, _found.face, foot, normalized(inside));
    for (int row = 0; row < count; ++row) {
      if (!walk.advance(row_height(rows, row))) return fail(strip, i);
      strip.vertices.push_back(walk.at());
    }
  }

  RowVertex foot_of(const RowStrip& strip, std::size_t i) const {
    return {_curves.points[strip.chain[i]], _model.edge_uv(_found.face, strip.use, strip.parameters[i])};
  }

  /// Notes a failure where there is none: rows are as many as fit for the size asked for then.
  bool has_room(const RowStrip& strip, std::size_t i, int count, const EdgeRows& rows, Vec3 inside) {
    const double length = longest_segment(_curves, strip, i), breadth = breadth_of(rows, count);
    const double wanted = breadth + least_margin * length;
    const double room = _room.along(strip.use.edge, _curves.points[strip.chain[i]], inside, 2 * wanted);
    if (room >= wanted) return true;
    // The breadth of rows up to a height L is (g L - h) / (g - 1).
    const double growth = rows.growth;
    const double size = ((growth - 1) * room + rows.height) / (growth + least_margin * (growth - 1));
    _found.failures.push_back({strip.chain[i], std::max(rows.height, std::min(size, 0.9 * length))});
    return false;
  }

  void fail(const RowStrip& strip, std::size_t i) {
    _found.failures.push_back({strip.chain[i], 0.5 * longest_segment(_curves, strip, i)});
  }

  /// Lists columns whose triangles are turned over in the plane of parameters.
  void find_turned(const RowStrip& strip) {
    const auto uv = [&](const RowPlace& place) {
      return place.level == 0 ? foot_of(strip, place.column).uv : strip.above(place.column, place.level).uv;
    };
    for (std::size_t i = 0; i + 1 < strip.chain.size(); ++i) {
      if (strip.rows_at(i) + strip.rows_at(i + 1) == 0) continue;
      const cad::SurfaceFrame frame = _model.face_frame(_found.face, foot_of(strip, i).uv);
      const int orientation = dot(cross(frame.du, frame.dv), frame.normal) > 0 ? 1 : -1;
      bool turned = false;
      for_each_row_triangle(strip, i, [&](const std::array<RowPlace, 3>& corners) {
        turned = turned || geometry::orient2d(uv(corners[0]), uv(corners[1]), uv(corners[2])) != orientation;
      });
      if (turned) fail(strip, i), fail(strip, i + 1);
    }
  }

  const cad::Model& _model;
  const CurveMesh& _curves;
  RowRoom _room;
  FaceRows _found;
  std::int32_t _tops = 0;
};

/// Makes the piece of the rows of a face.
class RowPieceMaker {
public:
  RowPieceMaker(const cad::Model& model, const FaceRows& rows, const CurveMesh& curves)
      : _model(model), _rows(rows), _curves(curves) {
    _piece.kind = mesh::CellKind::triangle;
  }

  mesh::Piece make() {
    add_borders();
    for (const RowStrip& strip : _rows.strips) {
      add_inside(strip);
      for (std::size_t i = 0; i + 1 < strip.chain.size(); ++i) {
        for_each_row_triangle(strip, i, [&](const std::array<RowPlace, 3>& corners) {
          for (const RowPlace& corner : corners) _piece.cells.push_back(vertex_at(strip, corner));
        });
      }
    }
    const auto count = static_cast<std::size_t>(_piece.cell_count());
    _piece.triangle_face.assign(count, _rows.face);
    _piece.triangle_patch.assign(count, _model.face(_rows.face).patch);
    return std::move(_piece);
  }

private:
  /// Vertices of the edges, then tops: ascending by key.
  void add_borders() {
    std::map<mesh::SharedVertexKey, Vec3> borders;
    for (const RowStrip& strip : _rows.strips) {
      for (std::size_t i = 0; i < strip.chain.size(); ++i) {
        const bool is_used = strip.rows_at(i) > 0 || (i > 0 && strip.rows_at(i - 1) > 0) ||
                             (i + 1 < strip.chain.size() && strip.rows_at(i + 1) > 0);
        if (is_used)
          borders.emplace(_curves.vertex_key(_model, strip.chain[i]), _curves.points[strip.chain[i]]);
        if (strip.tops[i] >= 0) borders.emplace(_rows.top_key(strip.tops[i]), strip.top(i).point);
      }
    }
    for (const auto& [key, point] : borders) {
      _of_key[key] = add_point(point);
      _piece.shared_vertices.push_back(_of_key[key]);
      _piece.shared_keys.push_back(key);
      classify_border_vertex(_rows.face, key, _piece);
    }
  }

  void add_inside(const RowStrip& strip) {
    _first_inside.clear();
    for (std::size_t i = 0; i < strip.chain.size(); ++i) {
      _first_inside.push_back(_piece.vertex_count());
      for (std::size_t rows = 1; rows < strip.rows_at(i); ++rows) {
        add_point(strip.above(i, rows).point);
        _piece.vertex_dimension.push_back(mesh::CadDimension::face);
        _piece.vertex_entity.push_back(_rows.face);
      }
    }
  }

  mesh::LocalIndex add_point(Vec3 p) {
    _piece.coordinates.insert(_piece.coordinates.end(), {p.x, p.y, p.z});
    return _piece.vertex_count() - 1;
  }

  mesh::LocalIndex vertex_at(const RowStrip& strip, const RowPlace& place) const {
    if (place.level == 0) return _of_key.at(_curves.vertex_key(_model, strip.chain[place.column]));
    if (place.level == strip.rows_at(place.column))
      return _of_key.at(_rows.top_key(strip.tops[place.column]));
    return _first_inside[place.column] + static_cast<mesh::LocalIndex>(place.level) - 1;
  }

  const cad::Model& _model;
  const FaceRows& _rows;
  const CurveMesh& _curves;
  std::map<mesh::SharedVertexKey, mesh::LocalIndex> _of_key;
  std::vector<mesh::LocalIndex> _first_inside;  // by column of the strip
  mesh::Piece _piece;
};

}  // namespace

double longest_segment(const CurveMesh& curves, const RowStrip& strip, std::size_t i) {
  const Vec3 here = curves.points[strip.chain[i]];
  double length = 0;
  if (i > 0) length = distance(here, curves.points[strip.chain[i - 1]]);
  if (i + 1 < strip.chain.size())
    length = std::max(length, distance(here, curves.points[strip.chain[i + 1]]));
  return length;
}

const RowStrip* FaceRows::strip_of(const cad::Coedge& use) const {
  const auto found = std::find_if(strips.begin(), strips.end(), [&](const RowStrip& strip) {
    return strip.use.edge == use.edge && strip.use.use == use.use;
  });
  return found == strips.end() ? nullptr : &*found;
}

mesh::SharedVertexKey FaceRows::top_key(std::int32_t top) const {
  // Cuts of a face are named by numbers above those of all its border vertices, of which tops are some.
  constexpr std::int32_t group_of_faces = 0;
  return mesh::cut_vertex_key(face, group_of_faces, top);
}

FaceRows find_face_rows(const cad::Model& model, cad::FaceId face, const CurveMesh& curves,
                        std::span<const EdgeRows> rows) {
  FaceRows none;
  none.face = face;
  if (rows.empty() || model.is_faceted(face)) return none;
  std::optional<RowFinder> finder;
  for (const auto& loop : model.face(face).loops) {
    for (const cad::Coedge& use : loop) {
      if (!(rows[use.edge].height > 0) || !is_constraining(model, use.edge)) continue;
      if (!finder) finder.emplace(model, face, curves, rows);
      finder->add_strip(use, rows[use.edge]);
    }
  }
  return finder ? finder->take() : none;
}

mesh::Piece piece_of_rows(const cad::Model& model, const FaceRows& rows, const CurveMesh& curves) {
  return RowPieceMaker(model, rows, curves).make();
}

std::vector<sizing::SizeSource> remedies_of(const FaceRows& rows, const CurveMesh& curves) {
  std::vector<sizing::SizeSource> remedies;
  for (const RowFailure& failure : rows.failures)
    remedies.push_back({curves.points[failure.vertex], failure.size});
  return remedies;
}

}  // namespace aeroloom::surface
