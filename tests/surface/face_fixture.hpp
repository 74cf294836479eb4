/// Faces of small shapes and of real files, ready to be turned into chart surfaces and charts.
#pragma once

#include "cad/model/model.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/charts/chart.hpp"
#include "surface/charts/chart_surface.hpp"
#include "surface/curves/curves.hpp"
#include "tests/source_tree.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace aeroloom::surface::testing {

/// A field of one size everywhere, held by these ranks together. Collective.
inline sizing::SizeField uniform_field(
    const cad::Model& model, double size,
    const parallel::Communicator& ranks = parallel::Communicator::world()) {
  const auto field = sizing::SizeField::build(model.bounds(), {}, {size, size, 12, 1.3});
  return sizing::SizeField::unpack(ranks, field.pack());
}

/// A field that grows from `least` to `most` with the distance from a point. Collective.
inline sizing::SizeField graded_field(const cad::Model& model, geometry::Vec3 point, double least,
                                      double most,
                                      const parallel::Communicator& ranks = parallel::Communicator::world()) {
  const std::vector<sizing::SizeSource> sources{{point, least}};
  const auto field = sizing::SizeField::build(model.bounds(), sources, {least, most, 12, 1.3});
  return sizing::SizeField::unpack(ranks, field.pack());
}

inline cad::Facets facets_of(const cad::Model& model, cad::FaceId face) {
  const double extent = (model.is_far_field(face) ? model.bounds() : model.body_bounds()).diagonal();
  return model.facets(face, 1e-3 * extent, 15 * std::numbers::pi / 180);
}

inline std::filesystem::path aircraft_folder() {
  const char* set = std::getenv("AEROLOOM_GEOMETRY");
  const std::filesystem::path root =
      set != nullptr ? std::filesystem::path(set) : source_tree() / "../shared/geometry";
  return root / "aircraft";
}

}  // namespace aeroloom::surface::testing
