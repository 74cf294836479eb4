#include "volume/failure.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

constexpr std::size_t most_names = 8;

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

std::string name_faces(const ZoneContent& content, const std::vector<std::int32_t>& triangles,
                       const mesh::DistributedMesh& surface) {
  std::vector<std::int32_t> faces;
  for (const std::int32_t t : triangles) faces.push_back(content.face[t]);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::string text = faces.empty() ? "" : "; CAD faces:";
  for (std::size_t i = 0; i < std::min(faces.size(), most_names); ++i)
    text += " '" + surface.faces[faces[i]] + "'";
  if (faces.size() > most_names) text += fmt::format(" and {} more", faces.size() - most_names);
  return text;
}

}  // namespace

void Evidence::note(const ZoneContent& content, const mesh::DistributedMesh& surface,
                    const std::string& reason, Look look) {
  const ZoneProblem& problem = content.problem;
  const SurfacePart part{problem.points, problem.triangles};
  Item item;
  item.zone = content.zone;
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
  item.message =
      fmt::format("zone {} between ({:.6g}, {:.6g}, {:.6g}) and ({:.6g}, {:.6g}, {:.6g}) cannot be filled: ",
                  content.zone, box.low.x, box.low.y, box.low.z, box.high.x, box.high.y, box.high.z);
  item.message += item.has_defect
                      ? defect.what + describe_triangles(part, triangles) + "\nThe mesher said: " + reason +
                            "\nUse smaller elements there, so that surfaces close to each other are "
                            "resolved, or repair the geometry"
                      : reason;
  item.message += name_faces(content, triangles, surface);
  if (triangles.empty()) {
    triangles.resize(problem.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0);
  }
  for (const std::int32_t t : triangles) {
    auto& local = item.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      local[k] = static_cast<mesh::LocalIndex>(item.points.size());
      item.points.push_back(problem.points[problem.triangles[t][k]]);
    }
  }
  std::erase_if(_items, [&](const Item& known) { return known.zone == item.zone; });
  _items.push_back(std::move(item));
}

Evidence::Item Evidence::lowest(const parallel::Communicator& communicator, const Item* mine) {
  const std::int64_t none = INT32_MAX;
  const std::int64_t zone = communicator.minimum(mine ? std::int64_t{mine->zone} : none);
  if (zone == none) return {};
  const bool is_mine = mine && mine->zone == zone;
  const auto root = static_cast<parallel::Rank>(
      communicator.minimum(std::int64_t{is_mine ? communicator.rank() : communicator.size()}));
  parallel::Bytes bytes;
  if (communicator.rank() == root) {
    parallel::Packer packer;
    packer.text(mine->message);
    packer.array(mine->points);
    packer.array(mine->triangles);
    bytes = packer.take();
  }
  communicator.broadcast(bytes, root);
  parallel::Unpacker unpacker(bytes);
  Item item;
  item.zone = static_cast<ZoneIndex>(zone);
  item.message = unpacker.text();
  item.points = unpacker.array<Vec3>();
  item.triangles = unpacker.array<LocalTriangle>();
  return item;
}

void Evidence::raise(const Item& item, const std::string& tried) {
  throw VolumeFailure(item.message + tried, item.points, item.triangles);
}

void Evidence::stop_at_defects(const parallel::Communicator& communicator) const {
  const Item* worst = nullptr;
  for (const Item& item : _items) {
    if (item.has_defect && (!worst || item.zone < worst->zone)) worst = &item;
  }
  const Item item = lowest(communicator, worst);
  if (item.zone != no_zone) raise(item, "");
}

void Evidence::give_up(const parallel::Communicator& communicator, ZoneIndex zone,
                       const std::vector<Retry>& tried) const {
  const Item* mine = nullptr;
  for (const Item& item : _items) {
    if (item.zone == zone) mine = &item;
  }
  std::string text = "\nNo way of filling it worked. Tried:\n  points as they come";
  for (const Retry& retry : tried) {
    if (retry.zone == zone) text += "\n  " + retry.change;
  }
  text += "\nUse other sizes there, or another piece size (volume.piece_tets)";
  raise(lowest(communicator, mine), text);
}

}  // namespace aeroloom::volume
