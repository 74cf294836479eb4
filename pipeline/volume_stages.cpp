#include "pipeline/volume_stages.hpp"

#include "io/vtk/vtk_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/forecast.hpp"
#include "pipeline/stage_log.hpp"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

/// Leaves the triangles at fault in a file and throws the failure with the file's name. Collective.
[[noreturn]] void point_at_offenders(const parallel::Communicator& communicator,
                                     const volume::VolumeFailure& failure, const std::string& file) {
  std::string outcome = "the triangles are in " + file;
  try {
    parallel::on_root(communicator,
                      [&] { io::write_triangles(failure.points(), failure.triangles(), file); });
  } catch (const parallel::CollectiveError& error) {
    outcome = fmt::format("the triangles cannot be written: {}", error.what());
  }
  throw parallel::CollectiveError(failure.kind(), fmt::format("{}; {}", failure.what(), outcome));
}

}  // namespace

VolumeStart VolumeStages::decompose(const sizing::SizedSurface& boundary) {
  VolumeStart start;
  if (_input.improve.enabled) start.improved = _checkpoints.find(SavedStage::improve);
  if (!start.improved) start.filled = _checkpoints.find(SavedStage::volume);
  if (start.improved || start.filled) return start;
  start.zones = volume::decompose(input_of(boundary));
  _record.decomposition = start.zones->report();
  log_decompose(_record);
  if (_communicator.is_root()) warn_of_count(_record);
  return start;
}

VolumeProduct VolumeStages::fill(const sizing::SizedSurface& boundary, VolumeStart& start) {
  if (start.improved) {
    _record.resumed.emplace_back("volume");
    return {};
  }
  if (start.filled) return adopt(*std::exchange(start.filled, std::nullopt), "volume");
  VolumeProduct product;
  product.decomposition = start.zones->report();
  try {
    product.mesh = fill_zones(boundary, *std::exchange(start.zones, std::nullopt), product.volume);
  } catch (...) {
    _record.volume = std::move(product.volume);  // what was tried is told of a run that fails, too
    throw;
  }
  _record.volume = product.volume;
  log_volume(_record);
  keep(SavedStage::volume, product);
  return product;
}

VolumeProduct VolumeStages::improve(const cad::Model& model, const sizing::SizedSurface& boundary,
                                    VolumeStart& start, VolumeProduct filled) {
  if (start.improved) {
    VolumeProduct improved = adopt(*std::exchange(start.improved, std::nullopt), "improve");
    log_improve(_record);
    return improved;
  }
  if (!_input.improve.enabled) return filled;
  cad::PointLocator locator(model);
  filled.improve = improve_volume(_input, {&locator, &boundary.field}, filled.mesh, _record,
                                  _checkpoints.tasks(SavedStage::improve));
  keep(SavedStage::improve, filled);
  return filled;
}

VolumeProduct VolumeStages::adopt(io::CheckpointContent content, const char* stage) {
  _record.resumed.emplace_back(stage);
  VolumeProduct product;
  parallel::agree(_communicator, [&] { product = unpack_volume(_communicator, std::move(content)); });
  _record.decomposition = product.decomposition;
  _record.volume = product.volume;
  _record.improve = product.improve;
  parallel::add_pieces(static_cast<std::int64_t>(product.mesh.pieces.size()));
  log_decompose(_record);
  log_volume(_record);
  return product;
}

void VolumeStages::keep(SavedStage saved, const VolumeProduct& product) {
  _checkpoints.keep(saved, [&] { return pack_volume(product); });
}

volume::VolumeInput VolumeStages::input_of(const sizing::SizedSurface& boundary) {
  return {boundary, _input.volume, _checkpoints.tasks(SavedStage::volume), _input.layers.given};
}

mesh::DistributedMesh VolumeStages::fill_zones(const sizing::SizedSurface& boundary,
                                               volume::Decomposition zones, volume::VolumeReport& report) {
  try {
    return volume::fill_zones(input_of(boundary), std::move(zones), report);
  } catch (const volume::VolumeFailure& failure) {
    point_at_offenders(_communicator, failure, _input.output.directory + "/offending_triangles.vtp");
  }
}

}  // namespace aeroloom::pipeline
