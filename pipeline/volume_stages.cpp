#include "pipeline/volume_stages.hpp"

#include "io/vtk/vtk_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "pipeline/finished_volume.hpp"
#include "pipeline/forecast.hpp"
#include "pipeline/stage.hpp"
#include "pipeline/stage_log.hpp"
#include "pipeline/stage_products.hpp"

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
    parallel::agree(communicator, [&] {
      if (communicator.is_root()) io::write_triangles(failure.points(), failure.triangles(), file);
    });
  } catch (const parallel::CollectiveError& error) {
    outcome = fmt::format("the triangles cannot be written: {}", error.what());
  }
  throw parallel::CollectiveError(failure.kind(), fmt::format("{}; {}", failure.what(), outcome));
}

}  // namespace

mesh::DistributedMesh VolumeStages::find_or_build(const cad::Model& model, const VolumeBoundary& boundary) {
  constexpr report::ExitCode code = report::ExitCode::volume;
  std::optional<io::CheckpointContent> improved, filled;
  run_stage(_record, "decompose", code, [&] {
    const auto find = [&](SavedStage saved, const char* name) {
      std::optional<io::CheckpointContent> content = _checkpoints.find(saved);
      if (content) _record.resumed.emplace_back(name);
      return content;
    };
    if (_input.improve.enabled) improved = find(SavedStage::improve, "improve");
    if (!improved) filled = find(SavedStage::volume, "volume");
  });
  if (improved) {
    run_stage(_record, "volume", code, [] {});
    _record.resumed.insert(_record.resumed.end() - 1, "volume");
    return run_stage(_record, "improve", code, [&] {
      mesh::DistributedMesh volume = adopt(std::move(*improved));
      log_improve(_record);
      return volume;
    });
  }
  mesh::DistributedMesh volume =
      filled ? run_stage(_record, "volume", code, [&] { return adopt(std::move(*filled)); })
             : build(boundary);
  run_stage(_record, "improve", code, [&] { improve(model, boundary, volume); });
  return volume;
}

mesh::DistributedMesh VolumeStages::build(const VolumeBoundary& boundary) {
  constexpr report::ExitCode code = report::ExitCode::volume;
  volume::Decomposition decomposition =
      run_stage(_record, "decompose", code, [&] { return decompose(boundary); });
  return run_stage(_record, "volume", code, [&] {
    mesh::DistributedMesh volume = fill(boundary, std::move(decomposition));
    log_volume(_record);
    keep(SavedStage::volume, volume);
    return volume;
  });
}

mesh::DistributedMesh VolumeStages::adopt(io::CheckpointContent content) {
  VolumeProduct product;
  parallel::agree(_communicator, [&] { product = unpack_volume(_communicator, std::move(content)); });
  _record.decomposition = product.decomposition;
  _record.volume = std::move(product.volume);
  _record.improve = product.improve;
  parallel::add_pieces(static_cast<std::int64_t>(product.mesh.pieces.size()));
  log_decompose(_record);
  log_volume(_record);
  return std::move(product.mesh);
}

void VolumeStages::keep(SavedStage saved, const mesh::DistributedMesh& volume) {
  _checkpoints.keep(
      saved, [&] { return pack_volume(volume, _record.decomposition, _record.volume, _record.improve); });
}

volume::VolumeInput VolumeStages::input_of(const VolumeBoundary& boundary) {
  return {boundary.surface.mesh, boundary.surface.numbering, boundary.field, _input.volume,
          _checkpoints.tasks(SavedStage::volume)};
}

volume::Decomposition VolumeStages::decompose(const VolumeBoundary& boundary) {
  volume::Decomposition decomposition = volume::decompose(input_of(boundary));
  _record.decomposition = decomposition.report();
  log_decompose(_record);
  if (_communicator.is_root()) warn_of_count(_record);
  return decomposition;
}

mesh::DistributedMesh VolumeStages::fill(const VolumeBoundary& boundary,
                                         volume::Decomposition decomposition) {
  try {
    return volume::fill_zones(input_of(boundary), std::move(decomposition), _record.volume);
  } catch (const volume::VolumeFailure& failure) {
    point_at_offenders(_communicator, failure, _input.output.directory + "/offending_triangles.vtp");
  }
}

void VolumeStages::improve(const cad::Model& model, const VolumeBoundary& boundary,
                           mesh::DistributedMesh& volume) {
  if (!_input.improve.enabled) return;
  cad::PointLocator locator(model);
  improve_volume(_input, {&locator, &boundary.field}, volume, _record,
                 _checkpoints.tasks(SavedStage::improve));
  keep(SavedStage::improve, volume);
}

}  // namespace aeroloom::pipeline
