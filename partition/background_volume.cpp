#include "partition/background_volume.hpp"

#include "mesh/piece.hpp"

#include <algorithm>
#include <numbers>

namespace aeroloom::partition {
namespace {

using geometry::Vec3;

/// The dihedral angle between the faces (a,b,c) and (a,b,d), degrees.
double dihedral(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 along = normalized(b - a);
  const Vec3 p = (c - a) - dot(c - a, along) * along, q = (d - a) - dot(d - a, along) * along;
  return std::atan2(norm(cross(p, q)), dot(p, q)) * 180 / std::numbers::pi;
}

/// A tetrahedron at an edge, with the local numbers of its other two vertices.
struct EdgeUse {
  std::int32_t low, high, tet;
  std::int8_t c, d;
};

}  // namespace

std::vector<std::array<std::int32_t, 4>> link_tetrahedra(
    const std::vector<std::array<std::int32_t, 4>>& tets) {
  struct Face {
    std::array<std::int32_t, 3> vertices;
    std::int32_t tet, k;
  };
  std::vector<Face> faces;
  faces.reserve(4 * tets.size());
  for (std::size_t t = 0; t < tets.size(); ++t) {
    for (int k = 0; k < 4; ++k) {
      std::array<std::int32_t, 3> v{tets[t][(k + 1) % 4], tets[t][(k + 2) % 4], tets[t][(k + 3) % 4]};
      std::sort(v.begin(), v.end());
      faces.push_back({v, static_cast<std::int32_t>(t), k});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.tet < b.tet;
  });
  std::vector<std::array<std::int32_t, 4>> neighbours(tets.size(), {-1, -1, -1, -1});
  for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
    if (faces[i].vertices != faces[i + 1].vertices) continue;
    neighbours[faces[i].tet][faces[i].k] = faces[i + 1].tet;
    neighbours[faces[i + 1].tet][faces[i + 1].k] = faces[i].tet;
  }
  return neighbours;
}

EdgeRings gather_rings(const BackgroundVolume& volume) {
  std::vector<EdgeUse> uses;
  uses.reserve(6 * volume.tets.size());
  for (std::size_t t = 0; t < volume.tets.size(); ++t) {
    for (const auto& [i, j] : mesh::tetrahedron_edges) {
      const std::int32_t a = volume.tets[t][i], b = volume.tets[t][j];
      std::int8_t others[2], n = 0;
      for (std::int8_t k = 0; k < 4; ++k) {
        if (k != i && k != j) others[n++] = k;
      }
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), others[0], others[1]});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.tet < b.tet;
  });
  EdgeRings rings;
  rings.first.push_back(0);
  std::vector<char> seen;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].low == uses[i].low && uses[j].high == uses[i].high) ++j;
    seen.assign(j - i, 0);
    const auto slot = [&](std::int32_t tet) {
      const auto at = std::lower_bound(uses.begin() + static_cast<std::ptrdiff_t>(i),
                                       uses.begin() + static_cast<std::ptrdiff_t>(j), tet,
                                       [](const EdgeUse& u, std::int32_t t) { return u.tet < t; });
      return static_cast<std::size_t>(at - uses.begin()) - i;
    };
    // Around the edge from one tet: leave by the face opposite `out` (a vertex of the tet off the edge).
    const auto walk = [&](std::size_t start, std::int8_t out, bool closed) {
      std::size_t s = start;
      while (true) {
        const EdgeUse& use = uses[i + s];
        const auto& tet = volume.tets[use.tet];
        seen[s] = 1;
        rings.tets.push_back(use.tet);
        rings.angles.push_back(dihedral(volume.points[use.low], volume.points[use.high],
                                        volume.points[tet[use.c]], volume.points[tet[use.d]]));
        const std::int32_t shared = tet[out == use.c ? use.d : use.c];
        const std::int32_t next = volume.neighbours[use.tet][out];
        if (next < 0) break;
        s = slot(next);
        if (seen[s]) break;
        out = volume.tets[next][uses[i + s].c] == shared ? uses[i + s].c : uses[i + s].d;
      }
      rings.edges.push_back({uses[i].low, uses[i].high});
      rings.closed.push_back(closed);
      rings.first.push_back(static_cast<std::int32_t>(rings.tets.size()));
    };
    for (std::size_t s = 0; s < j - i; ++s) {  // fans first, from a boundary face on
      const EdgeUse& use = uses[i + s];
      if (seen[s]) continue;
      if (volume.neighbours[use.tet][use.d] < 0) {
        walk(s, use.c, false);
      } else if (volume.neighbours[use.tet][use.c] < 0) {
        walk(s, use.d, false);
      }
    }
    for (std::size_t s = 0; s < j - i; ++s) {
      if (!seen[s]) walk(s, uses[i + s].c, true);
    }
  }
  return rings;
}

void find_stretches(const EdgeRings& rings, std::int32_t ring, const std::vector<std::int32_t>& label,
                    std::vector<Stretch>& stretches) {
  stretches.clear();
  const std::int32_t size = rings.size(ring), first = rings.first[ring];
  const auto label_at = [&](std::int32_t i) { return label[rings.tets[first + i % size]]; };
  std::int32_t start = 0;
  if (rings.closed[ring]) {
    while (start < size && label_at(start) == label_at(start + size - 1)) ++start;
    if (start == size) start = 0;
  }
  for (std::int32_t i = start; i < start + size;) {
    Stretch stretch{i, i, 0};
    while (stretch.to < start + size && label_at(stretch.to) == label_at(i))
      stretch.angle += rings.angles[first + stretch.to++ % size];
    stretches.push_back(stretch);
    i = stretch.to;
  }
}

}  // namespace aeroloom::partition
