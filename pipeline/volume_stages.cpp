#include "pipeline/volume_stages.hpp"

#include "io/vtk/vtk_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/stage_log.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

/// Writes the triangles at fault and throws the failure with the name of their file; without a directory none
/// is written. Collective.
[[noreturn]] void point_at_offenders(const mesh::DistributedMesh& surface,
                                     const volume::VolumeFailure& failure, const std::string& directory) {
  if (directory.empty()) throw parallel::CollectiveError(failure.kind(), failure.what());
  const std::string file = directory + "/offending_triangles.vtp";
  std::string outcome = "the triangles are in " + file;
  try {
    parallel::on_root(surface.communicator,
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
  log_decompose(start.zones->report());
  return start;
}

VolumeProduct VolumeStages::fill(const sizing::SizedSurface& boundary, VolumeStart& start,
                                 volume::VolumeReport& tried) {
  if (start.improved) return {};
  if (start.filled) return adopt(boundary, *std::exchange(start.filled, std::nullopt));
  VolumeProduct product;
  product.decomposition = start.zones->report();
  try {
    product.mesh = fill_zones(boundary, *std::exchange(start.zones, std::nullopt), product.volume);
  } catch (...) {
    tried = std::move(product.volume);
    throw;
  }
  log_volume(product.volume);
  keep(SavedStage::volume, product);
  return product;
}

VolumeProduct VolumeStages::improve(const cad::Model& model, const sizing::SizedSurface& boundary,
                                    VolumeStart& start, VolumeProduct filled) {
  if (start.improved) {
    VolumeProduct improved = adopt(boundary, *std::exchange(start.improved, std::nullopt));
    log_improve(improved.improve);
    return improved;
  }
  if (!_input.improve.enabled) return filled;
  cad::PointLocator locator(model);
  filled.improve = improve_volume(improve_options(_input), {&locator, &boundary.field}, filled.mesh,
                                  _checkpoints.tasks(SavedStage::improve));
  keep(SavedStage::improve, filled);
  return filled;
}

VolumeProduct VolumeStages::adopt(const sizing::SizedSurface& boundary, io::CheckpointContent content) {
  const parallel::Communicator& communicator = boundary.communicator;
  VolumeProduct product;
  parallel::agree(communicator, [&] { product = unpack_volume(communicator, std::move(content)); });
  parallel::add_pieces(static_cast<std::int64_t>(product.mesh.pieces.size()));
  log_decompose(product.decomposition);
  log_volume(product.volume);
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
    point_at_offenders(boundary, failure, _input.output.directory);
  }
}

}  // namespace aeroloom::pipeline
