#include "cad/faceted/features.hpp"
#include "geometry/disjoint_sets.hpp"

namespace aeroloom::cad {
namespace {

/// Chains of features between vertices.
class CurveTracer {
public:
  CurveTracer(const SideTable& table, const FacetFeatures& features, std::size_t points)
      : _table(table), _is_vertex(points, 0), _features_at(points), _used(table.sides.size(), 0) {
    for (const std::int32_t v : features.vertices) _is_vertex[v] = 1;
    for (std::int32_t s = 0; s < static_cast<std::int32_t>(table.sides.size()); ++s) {
      if (features.is_feature[s] == 0) continue;
      _features_at[table.sides[s].low].push_back(s);
      _features_at[table.sides[s].high].push_back(s);
    }
    for (const std::int32_t v : features.vertices) {
      for (const std::int32_t s : _features_at[v]) {
        if (_used[s] == 0) curves.push_back(trace(v, s));
      }
    }
  }

  std::vector<FacetComplex::Curve> curves;

private:
  FacetComplex::Curve trace(std::int32_t from, std::int32_t side) {
    FacetComplex::Curve curve{{from}};
    for (std::int32_t at = from;;) {
      _used[side] = 1;
      at = _table.sides[side].low == at ? _table.sides[side].high : _table.sides[side].low;
      curve.points.push_back(at);
      if (_is_vertex[at] != 0) return curve;
      const std::vector<std::int32_t>& both = _features_at[at];
      side = both[0] == side ? both[1] : both[0];
    }
  }

  const SideTable& _table;
  std::vector<char> _is_vertex;
  std::vector<std::vector<std::int32_t>> _features_at;  // of each point
  std::vector<char> _used;                              // sides
};

/// The face of each triangle: what hangs together over sides that are no features, in the order of the file.
std::vector<FaceId> gather_faces(const FacetSoup& soup, const SideTable& table, const FacetFeatures& features,
                                 std::vector<std::int32_t>& first_of_face) {
  geometry::DisjointSets<std::int32_t> sets(soup.triangles.size());
  for (std::size_t s = 0; s < table.sides.size(); ++s) {
    if (features.is_feature[s] != 0) continue;
    const SideRecord& side = table.sides[s];
    sets.unite(facet_of(table.passes[side.begin].half_edge), facet_of(table.passes[side.end - 1].half_edge));
  }
  std::vector<FaceId> face_of(soup.triangles.size(), no_entity);
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(face_of.size()); ++t) {
    const std::int32_t root = sets.root(t);
    if (root == t) {
      face_of[t] = static_cast<FaceId>(first_of_face.size());
      first_of_face.push_back(t);
    } else {
      face_of[t] = face_of[root];
    }
  }
  return face_of;
}

}  // namespace

FacetComplex split_facets(const FacetSoup& soup, const std::vector<FacetRegions>& regions,
                          double feature_angle) {
  const SideTable table = make_side_table(soup.triangles);
  const FacetFeatures features = find_features(soup, regions, table, feature_angle);
  FacetComplex complex;
  complex.points = soup.points;
  complex.triangles = soup.triangles;
  std::vector<std::int32_t> first_of_face;
  complex.face_of = gather_faces(soup, table, features, first_of_face);
  for (const std::int32_t t : first_of_face)
    complex.faces.push_back({soup.groups[soup.group_of[t]], regions[t]});
  complex.curves = CurveTracer(table, features, soup.points.size()).curves;
  complex.vertices = features.vertices;
  return complex;
}

}  // namespace aeroloom::cad
