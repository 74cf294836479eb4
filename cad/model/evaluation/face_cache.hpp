/// What has been computed of the faces of a model. Seen by this folder only.
#pragma once

#include "cad/model/evaluation/face_integrals.hpp"
#include "cad/model/model.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::cad {

/// Beside the data of a model, which do not change: integrals over its faces, and triangulations that will be
/// asked for again, each from when somebody first asks. No answer depends on what is here. Models with the
/// same faces share one. Not for several threads at a time.
class FaceCache {
public:
  explicit FaceCache(std::size_t faces) : _faces(faces) {}
  /// The integrals over some faces of another model, in this order.
  FaceCache(const FaceCache& other, std::span<const FaceId> faces) {
    for (const FaceId id : faces) _faces.push_back({other._faces.at(id).integrals, std::nullopt});
  }

  /// What compute() gave when this was asked for first.
  template <class Compute>
  const FaceIntegrals& integrals(FaceId id, const Compute& compute) {
    std::optional<FaceIntegrals>& known = _faces.at(id).integrals;
    if (!known) known = compute();
    return *known;
  }

  /// Null where none of these limits is kept.
  const Facets* facets(FaceId id, double deflection, double angle) const {
    const std::optional<KeptFacets>& kept = _faces.at(id).kept;
    return kept && kept->deflection == deflection && kept->angle == angle ? &kept->facets : nullptr;
  }
  /// In the place of others of this face.
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
