#include "surface/piece_pool.hpp"

#include "geometry/place_text.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/schedule.hpp"
#include "parallel/observation/progress.hpp"
#include "parallel/observation/timers.hpp"
#include "surface/charts/chart_mesher.hpp"
#include "surface/piece_mesher.hpp"
#include "surface/surface_error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using cad::FaceId;
using parallel::ScopedCpu;
using sizing::SizeField;

/// The cost of a whole face besides the vertices of its curves, in vertices, before any was looked at.
/// Chosen, not measured; no result depends on it.
constexpr double load_of_face = 50;
/// Rounds may come to so many triangles, however few the first one has. Chosen, not measured.
constexpr double few_triangles = 20'000;

/// No part of a face has it.
PieceKey key_of_rows(FaceId face) {
  return {face, -1, 0};
}

void note_failed_rows(const cad::Model& model, const FaceRows& rows, const CurveMesh& curves,
                      Conflicts& conflicts) {
  const std::vector<sizing::SizeSource> remedies = remedies_of(rows, curves);
  conflicts.remedies.insert(conflicts.remedies.end(), remedies.begin(), remedies.end());
  if (conflicts.message.empty())
    conflicts.message = fmt::format("rows on face '{}' do not fit near {}", model.face(rows.face).name,
                                    geometry::place_text(curves.points[rows.failures.front().vertex]));
}

std::vector<double> sizes_at_vertices(const SizeField& field, const mesh::Piece& piece) {
  std::vector<double> sizes(piece.vertex_count());
  for (mesh::LocalIndex v = 0; v < piece.vertex_count(); ++v) sizes[v] = field(piece.point(v));
  return sizes;
}

}  // namespace

PiecePool::PiecePool(const parallel::Communicator& communicator, const cad::Model& model,
                     const CutOptions& options, parallel::TaskStore* tasks)
    : _communicator(communicator),
      _model(model),
      _options(options),
      _tasks(tasks),
      _distributor(communicator, model, options),
      _parts(model.face_count(), 0),
      _has_rows(model.face_count(), 0) {}

std::vector<std::int32_t> PiecePool::edge_vertices(const CurveMesh& curves, FaceId face) const {
  std::vector<std::int32_t> counts;
  for (const auto& loop : _model.face(face).loops) {
    for (const cad::Coedge& use : loop)
      counts.push_back(curves.first_interior[use.edge + 1] - curves.first_interior[use.edge]);
  }
  return counts;
}

bool PiecePool::is_unchanged(const CurveMesh& curves, const SizeField& field, FaceId face,
                             const Meshed& meshed) const {
  if (edge_vertices(curves, face) != meshed.edge_vertices) return false;
  const mesh::Piece& piece = meshed.piece;
  for (std::size_t i = 0; i < piece.shared_keys.size(); ++i) {
    if (mesh::is_cut_vertex_key(piece.shared_keys[i])) continue;
    const CurveVertex v = curves.vertex_of(piece.shared_keys[i]);
    if (!(curves.points[v] == piece.point(piece.shared_vertices[i]))) return false;
  }
  return sizes_at_vertices(field, piece) == meshed.vertex_sizes;
}

/// Ascending, the same on every rank. A face is made again as a whole: sizes decide on its cuts too.
std::vector<FaceId> PiecePool::changed_faces(const CurveMesh& curves, const SizeField& field) const {
  std::vector<FaceId> changed;
  if (!_started) {
    changed.resize(_model.face_count());
    std::iota(changed.begin(), changed.end(), 0);
    return changed;
  }
  std::vector<std::int32_t> kept(_model.face_count(), 0);
  {
    const ScopedCpu cpu(ScopedCpu::As::task);
    for (const auto& [key, meshed] : _meshed)
      kept[key[0]] += is_unchanged(curves, field, key[0], meshed) ? 1 : 0;
  }
  std::vector<std::array<std::int32_t, 2>> mine;
  for (FaceId f = 0; f < _model.face_count(); ++f) {
    if (kept[f] > 0) mine.push_back({f, kept[f]});
  }
  std::fill(kept.begin(), kept.end(), 0);
  for (const auto& [face, count] : _communicator.all_gather_items<std::array<std::int32_t, 2>>(mine))
    kept[face] += count;
  for (FaceId f = 0; f < _model.face_count(); ++f) {
    if (_parts[f] == 0 || kept[f] != _parts[f]) changed.push_back(f);
  }
  return changed;
}

double PiecePool::seconds_per_triangle() const {
  constexpr double usual = 3e-6, of_curve = 0.8;  // the latter over what a unit of a curve's load takes;
                                                  // chosen, not measured; no result depends on it
  double load = 0, seconds = 0;
  for (const parallel::TaskRecord& task : parallel::noted_tasks()) {
    if (task.kind == parallel::TaskKind::curve) load += task.predicted, seconds += task.cpu_seconds;
  }
  load = _communicator.sum(load);
  seconds = _communicator.sum(seconds);
  return load > 0 && seconds > 0 ? of_curve * seconds / load : usual;
}

/// The faces as piece problems, spread over the ranks. What one takes, most of it in the CAD library, cannot
/// be told before: it is measured, and who has had more gets fewer pieces.
PieceProblems PiecePool::make_face_problems(const std::vector<FaceId>& faces, const CurveMesh& curves,
                                            const SizeField& field, Conflicts& conflicts) {
  PieceProblems problems;
  _costs.clear();
  const double of_triangle = seconds_per_triangle();
  parallel::collectively(_communicator, ScopedCpu::As::task, [&] {
    std::vector<double> loads;
    for (const FaceId face : faces) {
      const auto counts = edge_vertices(curves, face);
      loads.push_back(load_of_face + std::accumulate(counts.begin(), counts.end(), 0.0));
    }
    const auto owners = parallel::assign_largest_first(loads, _communicator.size());
    for (const int task : parallel::tasks_of_rank(owners, loads, _communicator.rank())) {
      const double begin = parallel::cpu_seconds();
      const PieceKey key{faces[task], 0, 0};
      FaceProblem problem = problem_of_face(_model, faces[task], curves, field, _options);
      if (!problem.rows.failures.empty()) {
        note_failed_rows(_model, problem.rows, curves, conflicts);
        continue;
      }
      problems.emplace(key, std::move(problem.rest));
      if (!problem.rows.empty()) keep_rows(problem.rows, curves, field);
      const double seconds = parallel::cpu_seconds() - begin;
      _costs[key] = seconds / of_triangle;
      parallel::note_task({.kind = parallel::TaskKind::face,
                           .number = faces[task],
                           .predicted = loads[task],
                           .cpu_seconds = seconds,
                           .burden = _costs[key]});
    }
  });
  return problems;
}

void PiecePool::keep_rows(const FaceRows& rows, const CurveMesh& curves, const SizeField& field) {
  mesh::Piece piece = piece_of_rows(_model, rows, curves);
  std::vector<double> sizes = sizes_at_vertices(field, piece);
  const auto triangles = static_cast<double>(piece.cell_count());
  _meshed.emplace(key_of_rows(rows.face),
                  Meshed{std::move(piece), std::move(sizes), edge_vertices(curves, rows.face), triangles, 0});
}

void PiecePool::place_rows(const std::vector<FaceId>& faces) {
  std::vector<FaceId> mine;
  for (const FaceId face : faces) {
    if (_meshed.count(key_of_rows(face)) > 0) mine.push_back(face);
    _has_rows[face] = 0;
  }
  for (const FaceId face : _communicator.all_gather_items(std::span<const FaceId>(mine))) _has_rows[face] = 1;
  for (const FaceId face : faces) {
    const auto rows = _meshed.find(key_of_rows(face));
    if (rows != _meshed.end()) rows->second.place = _parts[face];
    _parts[face] += _has_rows[face];
  }
}

void PiecePool::leave_whole(const std::vector<FaceId>& faces) {
  _distributor.leave_whole(faces);
  for (const FaceId face : faces) _parts[face] = 0;
}

double PiecePool::predict(const PieceProblems& problems, const SizeField& field) const {
  // Whole numbers: their sum does not depend on who has which.
  std::int64_t triangles = 0;
  const ScopedCpu cpu(ScopedCpu::As::task);
  for (const auto& [key, problem] : problems)
    triangles += std::llround(integrate_triangles(problem.surface, field));
  for (const auto& [key, meshed] : _meshed) triangles += meshed.piece.cell_count();
  return static_cast<double>(_communicator.sum(triangles));
}

double PiecePool::most_triangles() const {
  return std::min(std::max(few_triangles, _options.most_growth * _first), _limit);
}

/// Depends on the piece problem and the field; model and options are the context of the store.
mesh::Piece PiecePool::mesh_or_find(const PieceProblem& problem, const SizeField& field,
                                    const parallel::Digest& of_field) const {
  if (_tasks == nullptr) return mesh_piece(_model, problem, field, _options);
  const parallel::Digest key = parallel::Digester()
                                   .value(of_field.low)
                                   .value(of_field.high)
                                   .bytes(parallel::to_wire(problem))
                                   .result();
  if (const std::optional<parallel::Bytes> known = _tasks->find(key))
    return parallel::from_wire<mesh::Piece>(*known);
  mesh::Piece piece = mesh_piece(_model, problem, field, _options);
  _tasks->keep(key, parallel::to_wire(piece));
  return piece;
}

void PiecePool::mesh_problems(const TaskDistribution& distribution, const CurveMesh& curves,
                              const SizeField& field, Conflicts& conflicts) {
  const parallel::Digest of_field = _tasks == nullptr ? parallel::Digest{} : field.digest();
  parallel::Progress progress("surface", static_cast<std::int64_t>(distribution.problems.size()),
                              "triangles");
  for (const auto& [key, problem] : distribution.problems) {
    const ScopedCpu cpu(ScopedCpu::As::task);
    const double begin = parallel::cpu_seconds();
    try {
      Meshed meshed{mesh_or_find(problem, field, of_field),
                    {},
                    edge_vertices(curves, key[0]),
                    problem.load,
                    distribution.places.at(key)};
      meshed.vertex_sizes = sizes_at_vertices(field, meshed.piece);
      parallel::note_task({parallel::TaskKind::surface_piece, key[0],
                           load_of_piece(problem.load, problem.facets()), parallel::cpu_seconds() - begin,
                           mesh::bytes_at_rest(meshed.piece)});
      _meshed.emplace(key, std::move(meshed));
    } catch (const FaceConflict& conflict) {
      if (conflicts.message.empty()) conflicts.message = conflict.what();
      if (is_divided(key[0])) {
        conflicts.undivided.push_back(key[0]);
      } else {
        conflicts.remedies.insert(conflicts.remedies.end(), conflict.remedy().begin(),
                                  conflict.remedy().end());
      }
    } catch (const SurfaceError& error) {
      if (!is_divided(key[0])) throw;
      if (conflicts.message.empty()) conflicts.message = error.what();
      conflicts.undivided.push_back(key[0]);
    }
    const auto made = _meshed.find(key);
    progress.advance(1, made == _meshed.end() ? 0 : made->second.piece.cell_count());
  }
}

Conflicts PiecePool::mesh(const CurveMesh& curves, const SizeField& field) {
  const std::vector<FaceId> faces = changed_faces(curves, field);
  const auto has_changed = [&](const auto& entry) {
    return std::binary_search(faces.begin(), faces.end(), entry.first[0]);
  };
  std::erase_if(_meshed, has_changed);
  std::erase_if(_angles, has_changed);
  Conflicts conflicts;
  PieceProblems problems = make_face_problems(faces, curves, field, conflicts);
  conflicts.predicted = predict(problems, field);
  // Faces whose rows failed are missing: the first round is that in which none is.
  if (!_is_complete) _first = std::max(_first, conflicts.predicted);
  _is_complete = _is_complete || _communicator.sum(std::int64_t{!conflicts.message.empty()}) == 0;
  _started = true;
  if (conflicts.predicted > most_triangles()) return conflicts;
  TaskDistribution distribution = _distributor.distribute(std::move(problems), _costs, field);
  for (const FaceId face : faces) _parts[face] = 0;
  for (const auto& [key, place] : distribution.places) ++_parts[key[0]];
  place_rows(faces);
  _angles.merge(distribution.angles);
  parallel::agree(_communicator, [&] { mesh_problems(distribution, curves, field, conflicts); });
  return conflicts;
}

mesh::DistributedMesh PiecePool::assemble() const {
  mesh::DistributedMesh surface(_communicator);
  surface.kind = mesh::CellKind::triangle;
  surface.patches = _model.patches();
  std::vector<mesh::PieceId> first{0};
  for (FaceId f = 0; f < _model.face_count(); ++f) {
    const cad::Face& face = _model.face(f);
    surface.faces.push_back(face.name);
    surface.sides.push_back({face.front, face.back});
    first.push_back(first.back() + _parts[f]);
  }
  surface.piece_count = first.back();
  for (cad::RegionId r = 0; r < _model.region_count(); ++r) surface.regions.push_back(_model.region_name(r));
  for (const auto& [key, meshed] : _meshed) {
    surface.pieces.push_back(meshed.piece);
    surface.pieces.back().id = first[key[0]] + meshed.place;
  }
  return surface;
}

std::vector<mesh::PieceId> PiecePool::row_pieces() const {
  std::vector<mesh::PieceId> pieces;
  mesh::PieceId next = 0;
  for (FaceId f = 0; f < _model.face_count(); ++f) {
    next += _parts[f];
    if (_has_rows[f] != 0) pieces.push_back(next - 1);
  }
  return pieces;
}

std::vector<CutAngle> PiecePool::cut_angles() const {
  std::vector<CutAngle> mine;
  for (const auto& [key, angles] : _angles) mine.insert(mine.end(), angles.begin(), angles.end());
  std::vector<CutAngle> all = _communicator.gather_sorted(mine, [](const CutAngle& each) {
    return std::tie(each.face, each.degrees, each.point.x, each.point.y, each.point.z);
  });
  return all;
}

double PiecePool::load_error_90() const {
  std::vector<double> errors;
  for (const auto& [key, meshed] : _meshed)
    errors.push_back(std::abs(meshed.load / static_cast<double>(meshed.piece.cell_count()) - 1));
  errors = _communicator.gather_sorted(errors);
  return errors.empty() ? 0 : errors[errors.size() * 9 / 10];
}

std::int64_t PiecePool::divided_faces() const {
  return std::count_if(_parts.begin(), _parts.end(), [](std::int32_t parts) { return parts > 1; });
}

}  // namespace aeroloom::surface
