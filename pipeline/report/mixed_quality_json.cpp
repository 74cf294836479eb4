#include "pipeline/report/mixed_quality_json.hpp"

#include "pipeline/report/places_json.hpp"

#include <string>

#include <fmt/format.h>

namespace aeroloom::report {
namespace {

using Json = nlohmann::ordered_json;

Json measure_json(const mesh::MeasureDistribution& of) {
  Json json = {{"cells", of.cells}, {"minimum", of.minimum}, {"maximum", of.maximum}, {"mean", of.mean}};
  for (std::size_t i = 0; i < of.percentiles.size(); ++i)
    json[fmt::format("percentile_{:g}", mesh::percentiles_per_mille[i] / 10.0)] = of.percentiles[i];
  json["histogram"] = {{"scale", of.histogram.logarithmic ? "log10" : "linear"},
                       {"low", of.histogram.low},
                       {"high", of.histogram.high},
                       {"counts", of.histogram.counts}};
  return json;
}

}  // namespace

Json to_json(const mesh::MixedQuality& quality) {
  Json json;
  for (const mesh::CellShape shape : mesh::cell_shapes) {
    for (const mesh::Measure measure : mesh::all_measures) {
      const mesh::MeasureDistribution& of = quality.distribution(shape, measure);
      if (of.cells > 0)
        json[std::string(mesh::name_of(shape))][std::string(name_of(measure))] = measure_json(of);
    }
  }
  for (const mesh::Measure measure : mesh::all_measures) {
    const auto& worst = quality.worst[static_cast<std::size_t>(measure)];
    if (!worst.empty()) json["worst"][std::string(name_of(measure))] = to_json(worst);
  }
  json["places"] = to_json(quality.places.all);
  return json;
}

}  // namespace aeroloom::report
