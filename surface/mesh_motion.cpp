#include "surface/mesh_motion.hpp"

#include "mesh/exchange/shared_vertices.hpp"

#include <algorithm>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;
using mesh::CadDimension;
using mesh::LocalIndex;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Triangles keep two thirds of their height if displacements fade over three times their length. Chosen, not
/// measured.
constexpr double reach = 3;
constexpr int smoothing_sweeps = 60;  // they reach about eight edges; chosen, not measured

/// The neighbours of the vertices of a piece, each once.
struct VertexGraph {
  std::vector<std::int32_t> first, neighbours;

  std::span<const std::int32_t> at(LocalIndex v) const {
    return std::span(neighbours).subspan(first[v], first[v + 1] - first[v]);
  }
};

VertexGraph graph_of(const mesh::Piece& piece) {
  std::vector<std::array<LocalIndex, 2>> pairs;
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* v = piece.cell(t);
    for (int i = 0; i < 3; ++i) {
      pairs.push_back({v[i], v[(i + 1) % 3]});
      pairs.push_back({v[(i + 1) % 3], v[i]});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  VertexGraph graph;
  graph.first.assign(static_cast<std::size_t>(piece.vertex_count()) + 1, 0);
  for (const auto& [from, to] : pairs) {
    ++graph.first[from + 1];
    graph.neighbours.push_back(to);
  }
  for (std::size_t v = 1; v < graph.first.size(); ++v) graph.first[v] += graph.first[v - 1];
  return graph;
}

class MeshMotion {
public:
  MeshMotion(const mesh::DistributedMesh& before, const mesh::DistributedMesh& moved,
             const FollowingFaces& faces)
      : _before(before), _moved(moved), _faces(faces), _shared(moved) {
    for (const mesh::Piece& piece : moved.pieces) {
      _follows.push_back(faces.follows(piece.common_face()) ? 1 : 0);
      _graphs.push_back(_follows.back() != 0 ? graph_of(piece) : VertexGraph());
    }
  }

  std::vector<std::vector<Displacement>> find() {
    give();
    spread();
    fade();
    smooth();
    return std::move(_found);
  }

private:
  /// Displacements of the boundaries that other faces have.
  void give() {
    for (std::size_t p = 0; p < _moved.pieces.size(); ++p) {
      const mesh::Piece &piece = _moved.pieces[p], &old = _before.pieces[p];
      const std::int32_t face = piece.common_face();
      const bool is_other = !_faces.follows(face) && !_faces.is_made_again(face);
      std::vector<Displacement>& found = _found.emplace_back();
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        const bool is_given = is_other || piece.vertex_dimension[v] == CadDimension::vertex;
        const Vec3 by = v < old.vertex_count() ? piece.point(v) - old.point(v) : Vec3{};
        found.push_back({by, is_given ? 0 : infinity, 0, is_given ? 1 : 0});
      }
      for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
        found[piece.shared_vertices[s]].source = piece.shared_keys[s];
    }
    _shared.combine(_found, [](const Displacement& a, const Displacement& b) { return nearer(a, b); });
  }

  static const Displacement& nearer(const Displacement& a, const Displacement& b) {
    return std::tie(b.distance, b.source) < std::tie(a.distance, a.source) ? b : a;
  }

  /// Along the edges of the faces that follow, from the nearest boundary.
  void spread() {
    for (std::int64_t changes = 1; changes > 0;) {
      changes = 0;
      for (std::size_t p = 0; p < _found.size(); ++p) {
        if (_follows[p] != 0) changes += spread_in(p) ? 1 : 0;
      }
      _shared.combine(_found, [](const Displacement& a, const Displacement& b) { return nearer(a, b); });
      changes = _moved.communicator.sum(changes);
    }
  }

  bool spread_in(std::size_t p) {
    std::vector<Displacement>& found = _found[p];
    using Entry = std::tuple<double, mesh::SharedVertexKey, LocalIndex>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (LocalIndex v = 0; v < static_cast<LocalIndex>(found.size()); ++v) {
      if (found[v].distance < infinity) queue.emplace(found[v].distance, found[v].source, v);
    }
    bool changed = false;
    while (!queue.empty()) {
      const auto [distance, source, v] = queue.top();
      queue.pop();
      if (std::tie(distance, source) != std::tie(found[v].distance, found[v].source)) continue;
      for (const LocalIndex w : _graphs[p].at(v)) {
        const double farther =
            distance + geometry::distance(_before.pieces[p].point(v), _before.pieces[p].point(w));
        if (found[w].is_given != 0 || farther >= reach * norm(found[v].by) ||
            std::tie(found[w].distance, found[w].source) <= std::tie(farther, source))
          continue;
        found[w] = {found[v].by, farther, source, 0};
        queue.emplace(farther, source, w);
        changed = true;
      }
    }
    return changed;
  }

  void fade() {
    for (std::vector<Displacement>& of_piece : _found) {
      for (Displacement& each : of_piece) {
        if (each.is_given != 0) continue;
        const double length = norm(each.by);
        each.by = each.distance < infinity && length > 0 ? (1 - each.distance / (reach * length)) * each.by
                                                         : Vec3{};
      }
    }
  }

  /// Of a vertex on a curve those on the same one, else all.
  bool counts(const mesh::Piece& piece, LocalIndex v, LocalIndex neighbour) const {
    if (piece.vertex_dimension[v] != CadDimension::edge) return true;
    if (piece.vertex_dimension[neighbour] == CadDimension::vertex) return true;
    return piece.vertex_dimension[neighbour] == CadDimension::edge &&
           piece.vertex_entity[neighbour] == piece.vertex_entity[v];
  }

  void smooth() {
    struct Mean {
      Vec3 sum;
      double count = 0;
    };
    std::vector<std::vector<Mean>> means;
    for (const std::vector<Displacement>& of_piece : _found) means.emplace_back(of_piece.size());
    for (int sweep = 0; sweep < smoothing_sweeps; ++sweep) {
      for (std::size_t p = 0; p < _found.size(); ++p) {
        for (LocalIndex v = 0; v < static_cast<LocalIndex>(means[p].size()); ++v) {
          means[p][v] = {};
          if (_follows[p] == 0 || _found[p][v].distance == infinity) continue;
          for (const LocalIndex w : _graphs[p].at(v)) {
            if (!counts(_moved.pieces[p], v, w)) continue;
            // Short edges are stiff: they must not turn over beside long ones.
            const double weight =
                1 / geometry::distance(_before.pieces[p].point(v), _before.pieces[p].point(w));
            means[p][v].sum += weight * _found[p][w].by;
            means[p][v].count += weight;
          }
        }
      }
      _shared.combine(means, [](const Mean& a, const Mean& b) {
        return Mean{a.sum + b.sum, a.count + b.count};
      });
      for (std::size_t p = 0; p < _found.size(); ++p) {
        for (std::size_t v = 0; v < means[p].size(); ++v) {
          if (_found[p][v].is_given == 0 && means[p][v].count > 0)
            _found[p][v].by = means[p][v].sum / means[p][v].count;
        }
      }
    }
  }

  const mesh::DistributedMesh &_before, &_moved;
  const FollowingFaces& _faces;
  const mesh::SharedVertices _shared;
  std::vector<std::uint8_t> _follows;  // by piece
  std::vector<VertexGraph> _graphs;
  std::vector<std::vector<Displacement>> _found;
};

bool contains(std::span<const std::int32_t> faces, std::int32_t face) {
  return std::binary_search(faces.begin(), faces.end(), face);
}

}  // namespace

bool FollowingFaces::follows(std::int32_t face) const {
  return contains(follow, face);
}
bool FollowingFaces::is_made_again(std::int32_t face) const {
  return contains(again, face);
}

std::vector<std::vector<Displacement>> find_displacements(const mesh::DistributedMesh& before,
                                                          const mesh::DistributedMesh& moved,
                                                          const FollowingFaces& faces) {
  return MeshMotion(before, moved, faces).find();
}

}  // namespace aeroloom::surface
