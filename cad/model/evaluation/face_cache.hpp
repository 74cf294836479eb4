/// Keeps results that were computed for the faces of a model. Internal to cad/model/.
#pragma once

#include "cad/model/evaluation/face_integrals.hpp"
#include "cad/model/model.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::cad {

/// Keeps integrals over faces, and triangulations that will be asked for again. Results are the same with or
/// without the cache. Models with the same faces share one. Not thread-safe.
class FaceCache {
public:
  explicit FaceCache(std::size_t faces) : _faces(faces) {}
  /// Takes over the integrals of some faces of another model, in this order.
  FaceCache(const FaceCache& other, std::span<const FaceId> faces) {
    for (const FaceId id : faces) _faces.push_back({other._faces.at(id).integrals, std::nullopt});
  }

  /// The kept integrals; without any, those that compute() returns, which are then kept.
  template <class Compute>
  const FaceIntegrals& integrals(FaceId id, const Compute& compute) {
    std::optional<FaceIntegrals>& known = _faces.at(id).integrals;
    if (!known) known = compute();
    return *known;
  }

  /// Null if no triangulation with these limits is kept.
  const Facets* facets(FaceId id, double deflection, double angle) const {
    const std::optional<KeptFacets>& kept = _faces.at(id).kept;
    return kept && kept->deflection == deflection && kept->angle == angle ? &kept->facets : nullptr;
  }
  /// Keeps one triangulation per face; another one of the face is replaced.
  void keep(FaceId id, double deflection, double angle, Facets facets) {
    _faces.at(id).kept = KeptFacets{deflection, angle, std::move(facets)};
  }

private:
  struct KeptFacets {
    double deflection, angle;
    Facets facets;
  };
  struct OfFace {
    std::optional<FaceIntegrals> integrals;
    std::optional<KeptFacets> kept;
  };
  std::vector<OfFace> _faces;
};

}  // namespace aeroloom::cad
