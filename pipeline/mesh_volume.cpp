#include "pipeline/mesh_volume.hpp"

#include "io/vtk_writer.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "parallel/schedule.hpp"
#include "pipeline/region_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;
using mesh::Piece;

/// The tetrahedral piece: the boundary's vertices come first, so its triangles keep their numbers.
Piece piece_of(const mesh::DistributedMesh& surface, const RegionContacts& contacts,
               const PieceBoundary& boundary, mesh::PieceId part, mesh::RegionId region,
               volume::FilledVolume&& filled) {
  Piece piece;
  piece.id = part;
  piece.region = region;
  piece.coordinates = std::move(filled.coordinates);
  piece.cells = std::move(filled.tetrahedra);
  piece.vertex_dimension = boundary.vertex_dimension;
  piece.vertex_entity = boundary.vertex_entity;
  piece.vertex_dimension.resize(piece.vertex_count(), 3);
  piece.vertex_entity.resize(piece.vertex_count(), region);
  std::vector<char> shared(boundary.vertex_number.size(), 0);
  for (std::size_t t = 0; t < boundary.surface.triangles.size(); ++t) {
    const auto& corners = boundary.surface.triangles[t];
    if (boundary.triangle_face[t] < 0) {
      for (const LocalIndex v : corners) shared[v] = 1;
      continue;
    }
    if (surface.sides_of(boundary.triangle_face[t]).front != region) continue;
    piece.boundary.insert(piece.boundary.end(), corners.begin(), corners.end());
    piece.triangle_face.push_back(boundary.triangle_face[t]);
    piece.triangle_patch.push_back(boundary.triangle_patch[t]);
  }
  for (std::size_t v = 0; v < shared.size(); ++v) {
    const std::int8_t dimension = boundary.vertex_dimension[v];
    if (!shared[v] && (dimension == 3 || !contacts.shared(dimension, boundary.vertex_entity[v]))) continue;
    piece.shared_vertices.push_back(static_cast<LocalIndex>(v));
    piece.shared_tokens.push_back(static_cast<mesh::SharedToken>(boundary.vertex_number[v]));
  }
  return piece;
}

/// A part that cannot be filled, and what to do about it.
struct Failure {
  std::int32_t part;
  std::int32_t with;  ///< neighbour to merge with; -1: there is none to blame
  std::string message;
};

/// The neighbour behind most of the triangles; -1 when none of them is on an interface.
std::int32_t neighbour_behind(const PieceBoundary& boundary, const std::vector<std::int32_t>& triangles,
                              const VolumePlan& plan, const MergedParts& parts, std::int32_t part) {
  std::vector<std::int32_t> behind;
  for (const std::int32_t t : triangles) {
    const std::int32_t f = boundary.triangle_interface[t];
    if (f < 0) continue;
    const std::int32_t a = parts.root(plan.faces[f].part), b = parts.root(plan.faces[f].beyond);
    behind.push_back(a == part ? b : a);
  }
  std::sort(behind.begin(), behind.end());
  std::int32_t best = -1;
  std::size_t most = 0;
  for (std::size_t i = 0, j = 0; i < behind.size(); i = j) {
    while (j < behind.size() && behind[j] == behind[i]) ++j;
    if (j - i > most) most = j - i, best = behind[i];
  }
  return best;
}

/// The triangles a failure names, with their CAD faces, and a file to look at them.
std::string explain(const volume::VolumeError& error, const PieceBoundary& boundary,
                    const std::vector<std::string>& face_names, const std::string& offenders_file) {
  std::string text = error.what();
  std::vector<std::int32_t> triangles = error.triangles();
  if (triangles.empty()) {  // nothing is known but the piece: all of it reproduces the failure
    triangles.resize(boundary.surface.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0);
  }
  std::vector<std::array<LocalIndex, 3>> offenders;
  std::vector<std::int32_t> faces;
  for (const std::int32_t t : triangles) {
    offenders.push_back(boundary.surface.triangles[t]);
    if (boundary.triangle_face[t] >= 0) faces.push_back(boundary.triangle_face[t]);
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  if (!faces.empty()) text += "; CAD faces:";
  for (std::size_t i = 0; i < std::min<std::size_t>(faces.size(), 8); ++i)
    text += " '" + face_names[faces[i]] + "'";
  io::write_triangles(boundary.surface.points, offenders, offenders_file);
  return text + "; the triangles are in " + offenders_file;
}

/// Fills parts round by round: those that fail are merged and come again.
class VolumeFiller {
public:
  VolumeFiller(const parallel::Communicator& communicator, const VolumeTask& task,
               parallel::StageClock& clock, VolumeReport& report)
      : _communicator(communicator),
        _task(task),
        _clock(clock),
        _report(report),
        _contacts(task.model),
        _parts(merge_at_failed(task.plan, task.boundary.interfaces)),
        _owners(parallel::assign_largest_first(task.plan.loads, communicator.size())) {}

  std::vector<Piece> run() {
    std::vector<char> wanted(_task.plan.parts, 0);
    for (std::int32_t p = 0; p < _task.plan.parts; ++p) wanted[_parts.root(p)] = 1;
    for (const std::int32_t f : _task.boundary.interfaces.failed) {
      const InterfaceFace& face = _task.plan.faces[f];
      _report.merges.push_back(
          {face.part, face.beyond, "an interface between them is too thin to be meshed"});
    }
    while (std::find(wanted.begin(), wanted.end(), 1) != wanted.end()) {
      std::vector<PieceBoundary> boundaries =
          gather_boundaries(_communicator, _task.boundary, _task.plan, _parts, wanted, _owners);
      std::vector<Failure> failures;
      parallel::agree(_communicator, [&] {
        for (const int part : parallel::tasks_of_rank(_owners, _task.plan.loads, _communicator.rank())) {
          if (wanted[part]) fill(part, boundaries[part], failures);
        }
      });
      wanted = merge_failed(failures);
    }
    _report.angles = summarise_interfaces(_communicator, _corners);
    return std::move(_pieces);
  }

  const MergedParts& parts() const { return _parts; }

private:
  void fill(std::int32_t part, PieceBoundary& boundary, std::vector<Failure>& failures) {
    try {
      volume::FilledVolume filled = volume::fill_volume(boundary.surface, _task.field, options_for(part));
      _report.steiner_points += filled.steiner_points;
      _report.attempts = std::max(_report.attempts, filled.attempts);
      _clock.add_task_cpu(filled.cpu_seconds);
      _clock.note_child_memory(filled.child_peak_bytes);
      _clock.add_pieces(1);
      const auto corners = find_interface_corners(boundary, _task.plan, _parts, part);
      _corners.insert(_corners.end(), corners.begin(), corners.end());
      _pieces.push_back(piece_of(_task.boundary.surface, _contacts, boundary, part,
                                 _task.plan.region_of[part], std::move(filled)));
      boundary = {};
    } catch (const volume::VolumeError& error) {
      std::vector<std::int32_t> suspects = error.triangles();
      if (suspects.empty()) {  // any neighbour will do
        suspects.resize(boundary.surface.triangles.size());
        std::iota(suspects.begin(), suspects.end(), 0);
      }
      const std::int32_t with = neighbour_behind(boundary, suspects, _task.plan, _parts, part);
      if (with >= 0) {
        failures.push_back({part, with, error.what()});
        return;
      }
      const mesh::RegionId region = _task.plan.region_of[part];
      const std::string where = _task.boundary.surface.region_count() > 1
                                    ? fmt::format("region '{}': ", _task.model.region_name(region))
                                    : std::string();
      throw std::runtime_error(where +
                               explain(error, boundary, _task.boundary.surface.faces, _task.offenders_file));
    }
  }

  volume::VolumeOptions options_for(std::int32_t part) const {
    volume::VolumeOptions options = _task.options;
    if (_task.sabotaged < 0) return options;
    bool alone = true;
    for (std::int32_t p = 0; p < _parts.count(); ++p) alone = alone && (p == part || _parts.root(p) != part);
    if (part != _task.sabotaged || !alone) options.sabotage = volume::VolumeOptions::Sabotage::none;
    return options;
  }

  /// Merges each failed part with its neighbour, on every rank alike; returns which parts are to be filled
  /// (again).
  std::vector<char> merge_failed(const std::vector<Failure>& mine) {
    parallel::Packer packer;
    for (const Failure& f : mine) {
      packer.value(f.part);
      packer.value(f.with);
      packer.text(f.message);
    }
    std::vector<Merge> merges;
    for (const parallel::Bytes& bytes : _communicator.all_gather(packer.take())) {
      parallel::Unpacker unpacker(bytes);
      while (!unpacker.at_end()) {
        Merge merge;
        merge.part = unpacker.value<std::int32_t>();
        merge.with = unpacker.value<std::int32_t>();
        merge.reason = unpacker.text();
        merges.push_back(std::move(merge));
      }
    }
    std::sort(merges.begin(), merges.end(), [](const Merge& a, const Merge& b) { return a.part < b.part; });
    for (const Merge& merge : merges) {
      parallel::log_info(fmt::format("volume: piece {} is merged with piece {}: {}", merge.part, merge.with,
                                     merge.reason.substr(0, merge.reason.find('\n'))));
      _parts.merge(merge.part, merge.with);
    }
    std::vector<char> wanted(_task.plan.parts, 0);
    for (const Merge& merge : merges) wanted[_parts.root(merge.part)] = 1;
    std::erase_if(_pieces, [&](const Piece& piece) { return wanted[_parts.root(piece.id)] != 0; });
    std::erase_if(_corners,
                  [&](const InterfaceCorner& corner) { return wanted[_parts.root(corner.part)] != 0; });
    _report.merges.insert(_report.merges.end(), merges.begin(), merges.end());
    return wanted;
  }

  const parallel::Communicator& _communicator;
  const VolumeTask& _task;
  parallel::StageClock& _clock;
  VolumeReport& _report;
  RegionContacts _contacts;
  MergedParts _parts;
  std::vector<parallel::Rank> _owners;
  std::vector<Piece> _pieces;
  std::vector<InterfaceCorner> _corners;
};

/// The relative error that 90 % of the predicted loads stay below.
double load_error(const parallel::Communicator& communicator, const std::vector<Piece>& pieces,
                  const VolumePlan& plan, const MergedParts& parts) {
  std::vector<double> predicted(plan.parts, 0), mine;
  for (std::int32_t p = 0; p < plan.parts; ++p) predicted[parts.root(p)] += plan.loads[p];
  for (const Piece& piece : pieces) {
    mine.push_back(
        std::abs(predicted[piece.id] / static_cast<double>(std::max<LocalIndex>(1, piece.cell_count())) - 1));
  }
  std::vector<double> errors = communicator.all_gather_items<double>(mine);
  std::sort(errors.begin(), errors.end());
  return errors.empty() ? 0 : errors[(errors.size() - 1) * 9 / 10];
}

}  // namespace

mesh::DistributedMesh mesh_volume(const parallel::Communicator& communicator, const VolumeTask& task,
                                  parallel::StageClock& clock, VolumeReport& report) {
  VolumeFiller filler(communicator, task, clock, report);
  mesh::DistributedMesh mesh;
  mesh.pieces = filler.run();
  report.load_error_90 = load_error(communicator, mesh.pieces, task.plan, filler.parts());
  std::vector<mesh::PieceId> number(task.plan.parts, 0);
  for (std::int32_t p = 0; p < task.plan.parts; ++p) {
    if (filler.parts().root(p) == p) number[p] = mesh.piece_count++;
  }
  for (Piece& piece : mesh.pieces) piece.id = number[piece.id];
  std::sort(mesh.pieces.begin(), mesh.pieces.end(),
            [](const Piece& a, const Piece& b) { return a.id < b.id; });
  const mesh::DistributedMesh& surface = task.boundary.surface;
  mesh.patches = surface.patches;
  mesh.faces = surface.faces;
  mesh.regions = surface.regions;
  mesh.sides = surface.sides;
  report.steiner_points = communicator.sum(report.steiner_points);
  report.attempts = static_cast<int>(communicator.maximum(std::int64_t{report.attempts}));
  return mesh;
}

}  // namespace aeroloom::pipeline
