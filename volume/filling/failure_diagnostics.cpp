#include "volume/filling/failure_diagnostics.hpp"

#include "geometry/place_text.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

#include <fmt/format.h>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

constexpr std::size_t most_names = 8;  // in a message

/// The triangles at vertices of the zone itself.
std::vector<std::int32_t> own_triangles(const ZoneProblem& problem) {
  std::vector<std::int32_t> own;
  for (std::size_t t = 0; t < problem.triangles.size(); ++t) {
    const auto& v = problem.triangles[t];
    if (std::any_of(v.begin(), v.end(), [&](mesh::LocalIndex w) { return problem.owners[w] == Owner::mine; }))
      own.push_back(static_cast<std::int32_t>(t));
  }
  return own;
}

std::string name_faces(std::vector<std::int32_t> faces, const mesh::DistributedMesh& surface) {
  geometry::sort_unique(faces);
  std::string text = faces.empty() ? "" : "; CAD faces:";
  for (std::size_t i = 0; i < std::min(faces.size(), most_names); ++i)
    text += " '" + surface.faces[faces[i]] + "'";
  if (faces.size() > most_names) text += fmt::format(" and {} more", faces.size() - most_names);
  return text;
}

/// Adds a triangle that shares no vertices with the others.
void add_triangle(const std::array<Vec3, 3>& corners, std::vector<Vec3>& points,
                  std::vector<LocalTriangle>& triangles) {
  const auto v = static_cast<mesh::LocalIndex>(points.size());
  triangles.push_back({v, v + 1, v + 2});
  points.insert(points.end(), corners.begin(), corners.end());
}

/// The triangles of all ranks, by number, each once. Collective.
std::vector<SurfaceTriangle> gather_triangles(const mesh::DistributedMesh& surface,
                                              std::span<const SurfaceTriangle> mine) {
  std::vector<SurfaceTriangle> all = surface.communicator.all_gather_items<SurfaceTriangle>(mine);
  geometry::sort_unique(
      all, [](const SurfaceTriangle& a, const SurfaceTriangle& b) { return a.number < b.number; },
      [](const SurfaceTriangle& a, const SurfaceTriangle& b) { return a.number == b.number; });
  return all;
}

}  // namespace

void FailureDiagnostics::note(const ZoneInput& input, const std::string& reason, Look look) {
  const ZoneProblem& problem = input.problem;
  const TriangleSoup part{problem.points, problem.triangles};
  Item item;
  item.zone = input.zone;
  SurfaceDefect defect;
  if (look == Look::for_defects) {
    defect = find_defect(part);
    if (defect.what.empty() && !problem.triangles.empty())
      defect = find_intersections(part, BoundaryDistance(problem.points, problem.triangles));
  }
  item.has_defect = !defect.what.empty();
  std::vector<std::int32_t> triangles = item.has_defect ? defect.triangles : own_triangles(problem);
  geometry::Box box;
  for (std::size_t v = 0; v < problem.points.size(); ++v) {
    if (problem.owners[v] == Owner::mine) box.add(problem.points[v]);
  }
  item.message = fmt::format("zone {} between {} and {} cannot be filled: ", input.zone,
                             geometry::place_text(box.low), geometry::place_text(box.high));
  item.message += item.has_defect
                      ? defect.what + describe_triangles(part, triangles) + "\nThe mesher said: " + reason +
                            "\nUse smaller elements there, so that surfaces close to each other are "
                            "resolved, or repair the geometry"
                      : reason;
  std::vector<std::int32_t> faces;
  faces.reserve(triangles.size());
  for (const std::int32_t t : triangles) faces.push_back(input.face[t]);
  item.message += name_faces(std::move(faces), _surface);
  if (triangles.empty()) {
    triangles.resize(problem.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0);
  }
  for (const std::int32_t t : triangles) {
    const auto& [a, b, c] = problem.triangles[t];
    add_triangle({problem.points[a], problem.points[b], problem.points[c]}, item.points, item.triangles);
  }
  std::erase_if(_items, [&](const Item& known) { return known.zone == item.zone; });
  _items.push_back(std::move(item));
}

std::vector<ZoneFailure> FailureDiagnostics::gather(const std::vector<ZoneFailure>& mine) const {
  std::vector<ZoneFailure> all;
  for (const std::vector<ZoneFailure>& failures : _surface.communicator.all_gather_values(mine))
    all.insert(all.end(), failures.begin(), failures.end());
  std::sort(all.begin(), all.end(),
            [](const ZoneFailure& a, const ZoneFailure& b) { return a.zone < b.zone; });
  return all;
}

FailureDiagnostics::Item FailureDiagnostics::lowest(const Item* mine) const {
  const parallel::Communicator& communicator = _surface.communicator;
  const std::int64_t none = INT32_MAX;
  const std::int64_t zone = communicator.minimum(mine ? std::int64_t{mine->zone} : none);
  if (zone == none) return {};
  const bool is_mine = mine && mine->zone == zone;
  const auto root = static_cast<parallel::Rank>(
      communicator.minimum(std::int64_t{is_mine ? communicator.rank() : communicator.size()}));
  Item item = is_mine ? *mine : Item();
  communicator.broadcast_value(item, root);
  return item;
}

void FailureDiagnostics::raise(const Item& item, const std::string& tried) {
  throw VolumeFailure(item.message + tried, item.points, item.triangles);
}

void FailureDiagnostics::stop_at_defects() const {
  const Item* worst = nullptr;
  for (const Item& item : _items) {
    if (item.has_defect && (!worst || item.zone < worst->zone)) worst = &item;
  }
  const Item item = lowest(worst);
  if (item.zone != no_zone) raise(item, "");
}

void FailureDiagnostics::give_up(ZoneIndex zone, const std::vector<Retry>& tried) const {
  const Item* mine = nullptr;
  for (const Item& item : _items) {
    if (item.zone == zone) mine = &item;
  }
  std::string text = "\nNo way of filling it worked. Tried:\n  points as they come";
  for (const Retry& retry : tried) {
    if (retry.zone == zone) text += "\n  " + retry.change;
  }
  text += "\nUse other sizes there, or another piece size (VolumeOptions::piece_tets)";
  raise(lowest(mine), text);
}

void refuse_surface(const Contradiction& contradiction, std::span<const SurfaceTriangle> triangles,
                    const LocalSurface& near, const mesh::DistributedMesh& surface) {
  std::vector<SurfaceTriangle> mine;
  if (!near.empty()) {
    const SurfaceDefect defect = find_intersections({near.points(), near.triangles()}, near.distance());
    for (const std::int32_t t : defect.triangles) mine.push_back(triangles[t]);
  }
  std::vector<SurfaceTriangle> culprits = gather_triangles(surface, mine);
  const bool intersects = !culprits.empty();
  if (!intersects) {
    std::copy_if(triangles.begin(), triangles.end(), std::back_inserter(mine),
                 [&](const SurfaceTriangle& t) { return t.number == contradiction.triangle; });
    culprits = gather_triangles(surface, mine);
  }
  std::vector<Vec3> points;
  std::vector<LocalTriangle> local;
  std::vector<std::int32_t> all, faces;
  for (const SurfaceTriangle& t : culprits) {
    all.push_back(static_cast<std::int32_t>(all.size()));
    faces.push_back(t.face);
    add_triangle(t.points, points, local);
  }
  const auto name_region = [&](mesh::RegionId region) {
    if (region == mesh::no_region) return std::string("outside");
    return surface.regions.empty() ? std::string("inside") : "in region '" + surface.regions[region] + "'";
  };
  throw VolumeFailure(
      fmt::format(
          "{}: {} is {} seen from there, and {} seen from elsewhere.{}\n{}{}",
          intersects ? "the surface intersects itself" : "the surface has a gap",
          geometry::place_text(contradiction.place), name_region(contradiction.seen),
          name_region(contradiction.elsewhere), describe_triangles({points, local}, all),
          "Use smaller elements there, so that surfaces close to each other are resolved, or repair the "
          "geometry",
          name_faces(std::move(faces), surface)),
      points, local);
}

}  // namespace aeroloom::volume
