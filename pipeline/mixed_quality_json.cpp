#include "pipeline/mixed_quality_json.hpp"

#include "pipeline/change_json.hpp"

#include <string>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json distribution_json(const io::MeasureDistribution& of) {
  Json json = {{"cells", of.cells}, {"minimum", of.minimum}, {"maximum", of.maximum}, {"mean", of.mean}};
  for (std::size_t i = 0; i < of.percentiles.size(); ++i)
    json[fmt::format("percentile_{:g}", io::percentiles_per_mille[i] / 10.0)] = of.percentiles[i];
  json["histogram"] = {{"scale", of.histogram.logarithmic ? "log10" : "linear"},
                       {"low", of.histogram.low},
                       {"high", of.histogram.high},
                       {"counts", of.histogram.counts}};
  return json;
}

Json worst_json(const std::vector<io::WorstCellOfShape>& worst) {
  Json json = Json::array();
  for (const io::WorstCellOfShape& cell : worst) {
    json.push_back({{"value", cell.value},
                    {"shape", io::name_of(cell.shape)},
                    {"cell", cell.cell},
                    {"center", to_json(cell.center)}});
  }
  return json;
}

}  // namespace

Json to_json(const io::MixedQuality& quality) {
  Json json;
  for (const io::CellShape shape : io::cell_shapes) {
    for (const io::Measure measure : io::all_measures) {
      const io::MeasureDistribution& of = quality.distribution(shape, measure);
      if (of.cells > 0)
        json[std::string(io::name_of(shape))][std::string(name_of(measure))] = distribution_json(of);
    }
  }
  for (const io::Measure measure : io::all_measures) {
    const auto& worst = quality.worst[static_cast<std::size_t>(measure)];
    if (!worst.empty()) json["worst"][std::string(name_of(measure))] = worst_json(worst);
  }
  return json;
}

}  // namespace aeroloom::pipeline
