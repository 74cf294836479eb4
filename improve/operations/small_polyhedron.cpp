#include "improve/operations/small_polyhedron.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr double unknown = 2;

}  // namespace

SmallPolyhedron::Local SmallPolyhedron::number(LocalIndex v) const {
  return static_cast<Local>(std::lower_bound(_vertices.begin(), _vertices.end(), v) - _vertices.begin());
}

int SmallPolyhedron::key(const Face& f) {
  const int lowest = f[0] < f[1] ? (f[0] < f[2] ? 0 : 2) : (f[1] < f[2] ? 1 : 2);
  return (f[lowest] * most_vertices + f[(lowest + 1) % 3]) * most_vertices + f[(lowest + 2) % 3];
}

void SmallPolyhedron::grow(const TetMesh& mesh, LocalIndex t) {
  _tets.assign(1, t);
  _vertices.assign(mesh.corners(t).begin(), mesh.corners(t).end());
  const auto has = [](const std::vector<LocalIndex>& list, LocalIndex value) {
    return std::find(list.begin(), list.end(), value) != list.end();
  };
  while (static_cast<int>(_tets.size()) < most_tets) {
    // Prefers neighbours that add no vertex, then the worst one.
    LocalIndex next = -1, apex = -1;
    bool inside = false;
    for (const LocalIndex tet : _tets) {
      for (int f = 0; f < 4; ++f) {
        const HalfFace other = mesh.twin(4 * tet + f);
        if (other < 0 || has(_tets, other >> 2)) continue;
        const LocalIndex candidate = other >> 2, opposite = mesh.corners(candidate)[other & 3];
        const bool known = has(_vertices, opposite);
        if (next >= 0 && (known != inside ? inside : mesh.quality(candidate) >= mesh.quality(next))) continue;
        next = candidate;
        apex = opposite;
        inside = known;
      }
    }
    if (next < 0 || (!inside && static_cast<int>(_vertices.size()) == most_vertices)) break;
    _tets.push_back(next);
    if (!inside) _vertices.push_back(apex);
  }
  std::sort(_vertices.begin(), _vertices.end());
}

// False where a vertex inside must stay.
bool SmallPolyhedron::open_front(const TetMesh& mesh) {
  _front.clear();
  _open.fill(0);
  std::array<bool, most_vertices> outer{};
  for (const LocalIndex tet : _tets) {
    for (int f = 0; f < 4; ++f) {
      const HalfFace other = mesh.twin(4 * tet + f);
      if (other >= 0 && std::find(_tets.begin(), _tets.end(), other >> 2) != _tets.end()) continue;
      const auto& face = mesh::tetrahedron_faces[f];
      const Corners& c = mesh.corners(tet);
      _front.push_back({number(c[face[0]]), number(c[face[1]]), number(c[face[2]])});
      _open[key(_front.back())] = 1;
      for (const Local v : _front.back()) outer[v] = true;
    }
  }
  for (std::size_t v = 0; v < _vertices.size(); ++v) {
    if (!outer[v] && (mesh.is_fixed(_vertices[v]) || is_on_boundary(mesh.dimension(_vertices[v]))))
      return false;
  }
  return true;
}

// Of the tetrahedron between a face, counter-clockwise seen from its outside, and a vertex.
double SmallPolyhedron::quality(const TetMesh& mesh, const Face& base, Local apex) {
  std::array<Local, 4> v{base[0], base[2], base[1], apex};
  bool odd = false;
  for (int i = 1; i < 4; ++i) {
    for (int k = i; k > 0 && v[k] < v[k - 1]; --k) {
      std::swap(v[k], v[k - 1]);
      odd = !odd;
    }
  }
  double& known = _qualities[((v[0] * most_vertices + v[1]) * most_vertices + v[2]) * most_vertices + v[3]];
  if (known == unknown) {
    const Corners even{_vertices[v[0]], _vertices[v[1]], _vertices[v[2]], _vertices[v[3]]};
    known = mesh.quality_of(even);
    if (!(known > 0)) known = -std::max(0.0, mesh.quality_of({even[1], even[0], even[2], even[3]}));
  }
  return odd ? -known : known;
}

// Vertices that make a tetrahedron on a face: better than the best solution so far, and outside the filled
// part.
void SmallPolyhedron::list_apexes(const TetMesh& mesh, const Face& face, std::vector<Apex>& apexes) {
  apexes.clear();
  for (Local v = 0; v < static_cast<Local>(_vertices.size()); ++v) {
    if (v == face[0] || v == face[1] || v == face[2]) continue;
    int closes = 0;
    bool overlaps = false;
    for (const Face& side : sides_of(face, v)) {
      overlaps = overlaps || _open[key(side)];
      closes += _open[key({side[1], side[0], side[2]})];
    }
    if (overlaps) continue;
    const double value = quality(mesh, face, v);
    if (value > _best) apexes.push_back({value, closes, v});
  }
}

// The face of the front with the fewest choices, and these, most promising first. False where a face has
// none.
bool SmallPolyhedron::choose_face(const TetMesh& mesh, Face& face, std::vector<Apex>& apexes) {
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int lowest = 0;
  for (const Face& candidate : _front) {
    list_apexes(mesh, candidate, _trial);
    if (_trial.empty()) return false;
    const int name = key(candidate);
    if (_trial.size() > fewest || (_trial.size() == fewest && name > lowest)) continue;
    fewest = _trial.size();
    lowest = name;
    face = candidate;
    apexes.swap(_trial);
  }
  std::sort(apexes.begin(), apexes.end(), [](const Apex& a, const Apex& b) {
    return a.closes != b.closes ? a.closes > b.closes
                                : (a.quality != b.quality ? a.quality > b.quality : a.vertex < b.vertex);
  });
  return true;
}

void SmallPolyhedron::open(const Face& face) {
  _open[key(face)] = 1;
  _front.push_back(face);
}

void SmallPolyhedron::close(const Face& face) {
  const int name = key(face);
  _open[name] = 0;
  const auto at =
      std::find_if(_front.begin(), _front.end(), [&](const Face& other) { return key(other) == name; });
  *at = _front.back();
  _front.pop_back();
}

// Positive tetrahedra whose faces cancel, up to those of the polyhedron, fill it exactly once. So no test for
// intersections is needed.
void SmallPolyhedron::search(const TetMesh& mesh, double worst) {
  if (_front.empty()) {
    _best = worst;
    _best_filling = _filling;
    return;
  }
  if (++_steps > most_steps) return;
  Face base;
  std::vector<Apex> apexes;
  if (!choose_face(mesh, base, apexes)) return;
  for (const Apex& apex : apexes) {
    if (apex.quality <= _best || worst <= _best || _steps > most_steps) continue;
    const auto sides = sides_of(base, apex.vertex);
    std::array<bool, 3> closed{};
    close(base);
    for (int i = 0; i < 3; ++i) {
      const Face across{sides[i][1], sides[i][0], sides[i][2]};
      closed[i] = _open[key(across)];
      closed[i] ? close(across) : open(sides[i]);
    }
    _filling.push_back({base[0], base[2], base[1], apex.vertex});
    search(mesh, std::min(worst, apex.quality));
    _filling.pop_back();
    for (int i = 0; i < 3; ++i) {
      const Face across{sides[i][1], sides[i][0], sides[i][2]};
      closed[i] ? open(across) : close(sides[i]);
    }
    open(base);
  }
}

bool SmallPolyhedron::propose(const TetMesh& mesh, LocalIndex t, double floor, CavityReplacement& cavity) {
  grow(mesh, t);
  if (_tets.size() < 2 || !open_front(mesh)) return false;
  const double before = mesh.worst_of(_tets);
  _qualities.fill(unknown);
  _filling.clear();
  _best_filling.clear();
  _best = std::max(floor, before);
  _steps = 0;
  search(mesh, std::numeric_limits<double>::max());
  if (_best_filling.empty()) return false;
  cavity.clear();
  cavity.before = before;
  cavity.after = _best;
  cavity.old_tets = _tets;
  for (const auto& tet : _best_filling)
    cavity.new_tets.push_back({_vertices[tet[0]], _vertices[tet[1]], _vertices[tet[2]], _vertices[tet[3]]});
  return true;
}

bool SmallPolyhedron::improve(OperationContext& context, LocalIndex t) {
  TetMesh& mesh = context.mesh();
  return propose(mesh, t, mesh.quality(t), _change) && context.apply(_change);
}

}  // namespace aeroloom::improve
