/// Where the smallest size wins over what curvature asks for.
#pragma once

#include "sizing/model_sampler.hpp"

#include <string>
#include <tuple>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {

/// A face on which elements turn further, or lie farther off, than was asked for.
struct NamedBound {
  std::string face;
  double fraction;  ///< of its area
  double degrees;   ///< that an element turns there, at most

  static constexpr auto fields() {
    return std::tuple(&NamedBound::face, &NamedBound::fraction, &NamedBound::degrees);
  }
};

/// Those of a model, the largest fractions first. Collective.
std::vector<NamedBound> report_bounded_faces(const sizing::ModelSampler& sampler,
                                             const sizing::SizingOptions& sizes);

/// One line of a few of them; empty where there are none of any extent.
std::string describe(const std::vector<NamedBound>& faces, const sizing::SizingOptions& sizes);

nlohmann::ordered_json to_json(const std::vector<NamedBound>& faces);

}  // namespace aeroloom::pipeline
