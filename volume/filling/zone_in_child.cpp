#include "volume/filling/zone_in_child.hpp"

#include "parallel/sandbox/sandbox.hpp"
#include "volume/filling/cell_order.hpp"
#include "volume/volume_mesher.hpp"
#include "volume/zones/zones.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace aeroloom::volume {

using geometry::Vec3;
using parallel::Bytes;

namespace {

// Limits of a child. TetGen takes about 1 us and 350 bytes per tetrahedron. If it takes forty times as long,
// it hangs.
constexpr double cpu_seconds_per_tetrahedron = 40e-6;
constexpr std::int64_t base_bytes = 2LL << 30;
constexpr std::int64_t bytes_per_tetrahedron = 1500;

/// Moves a zone near the origin and scales it to about unit size, as TetGen's tolerances need it. This is
/// exact: an axis is shifted only if the zone is far from its zero (by the lemma of Sterbenz the difference
/// has no rounding), and the scale is a power of two. So orientations and circumspheres do not change.
class UnitFrame {
public:
  explicit UnitFrame(std::span<const Vec3> points) {
    geometry::Box box;
    for (const Vec3& p : points) box.add(p);
    const Vec3 center = box.center(), size = box.size();
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(center[axis]) > size[axis]) _shift[axis] = center[axis];
    }
    _exponent = -std::ilogb(std::max({size.x, size.y, size.z}));
  }
  Vec3 to_unit(Vec3 p) const { return std::ldexp(1.0, _exponent) * (p - _shift); }
  Vec3 from_unit(Vec3 p) const { return std::ldexp(1.0, -_exponent) * p + _shift; }

private:
  Vec3 _shift;
  int _exponent = 0;
};

/// Sorts the cells along a space-filling curve, and the crossings accordingly.
void sort_cells(std::span<const Vec3> points, OwnedCells& owned) {
  OwnedCells sorted;
  std::vector<std::int32_t> place(owned.cells.size());
  for (const std::uint32_t c : order_along_curve(points, owned.cells)) {
    place[c] = static_cast<std::int32_t>(sorted.cells.size());
    sorted.cells.push_back(owned.cells[c]);
    sorted.regions.push_back(owned.regions[c]);
  }
  const auto sort_faces = [&](const std::vector<Crossing>& from, std::vector<Crossing>& to) {
    to.reserve(from.size());
    for (const Crossing& face : from) to.push_back({place[face.cell], face.face});
    std::sort(to.begin(), to.end(), [](const Crossing& a, const Crossing& b) {
      return a.cell != b.cell ? a.cell < b.cell : a.face < b.face;
    });
  };
  sort_faces(owned.crossings, sorted.crossings);
  sort_faces(owned.borders, sorted.borders);
  sorted.touched = std::move(owned.touched);
  sorted.triangles = std::move(owned.triangles);
  std::sort(sorted.triangles.begin(), sorted.triangles.end());
  owned = std::move(sorted);
}

/// Runs in the child.
Bytes child_task(std::span<const std::byte> input) {
  const auto [fault, problem] = parallel::from_wire<std::tuple<parallel::Fault, ZoneProblem>>(input);
  parallel::inject_fault(fault);
  const UnitFrame frame(problem.points);
  std::vector<Vec3> points = problem.points, added;
  OwnedCells owned;
  {
    std::vector<double> unit;
    unit.reserve(3 * points.size());
    for (const Vec3& p : points) {
      const Vec3 q = frame.to_unit(p);
      unit.insert(unit.end(), {q.x, q.y, q.z});
    }
    std::vector<std::uint8_t> mine;
    mine.reserve(problem.owners.size());
    for (const Owner owner : problem.owners) mine.push_back(owner == Owner::mine);
    TetgenMesh mesh = run_tetgen(unit, problem.triangles, mine);
    for (std::size_t s = 0; s < mesh.added.size(); s += 3)
      added.push_back(frame.from_unit({mesh.added[s], mesh.added[s + 1], mesh.added[s + 2]}));
    points.insert(points.end(), added.begin(), added.end());
    owned = select_owned(problem, std::move(mesh), points);
  }
  if (owned.missing_borders.empty()) sort_cells(points, owned);
  return parallel::to_wire(std::tie(owned, added));
}

const parallel::NamedTask fill_task("volume.zone", child_task);

void unpack_filling(std::span<const std::byte> bytes, ZoneFilling& filling) {
  auto result = std::tie(filling.owned, filling.added);
  parallel::from_wire_into(bytes, result);
  filling.filled = true;
}

std::string describe(const parallel::SandboxResult& result) {
  using Status = parallel::SandboxStatus;
  switch (result.status) {
    case Status::aborted:
      return "the mesher crashed: " + result.message;
    case Status::out_of_time:
      return "the mesher did not end in " + std::to_string(std::lround(result.cpu_seconds)) + " CPU seconds";
    case Status::out_of_memory:
      return "the mesher ran out of its memory";
    default:
      return result.message;
  }
}

}  // namespace

std::int64_t predict_tetrahedra(const ZoneProblem& problem) {
  return static_cast<std::int64_t>(tetrahedra_per_point * static_cast<double>(problem.regions.size()) +
                                   tetrahedra_per_triangle * static_cast<double>(problem.triangles.size()));
}

ZoneFilling fill_zone_in_child(const ZoneProblem& problem, parallel::Fault fault, parallel::TaskStore* tasks,
                               double base_cpu_seconds) {
  if (fault != parallel::Fault::none) tasks = nullptr;
  const Bytes packed = parallel::to_wire(std::tie(fault, problem));
  ZoneFilling filling;
  parallel::Digest key;
  if (tasks != nullptr) {
    key = parallel::digest_of(packed);
    if (const std::optional<Bytes> known = tasks->find(key)) {
      unpack_filling(*known, filling);
      return filling;
    }
  }
  const std::int64_t predicted = predict_tetrahedra(problem);
  const parallel::SandboxLimits limits{
      base_cpu_seconds + cpu_seconds_per_tetrahedron * static_cast<double>(predicted),
      base_bytes + bytes_per_tetrahedron * predicted};
  const auto result = parallel::run_sandboxed(fill_task.name(), packed, limits);
  filling.cpu_seconds = result.cpu_seconds;
  filling.child_peak_bytes = result.peak_resident_bytes;
  if (result.status != parallel::SandboxStatus::ok) {
    filling.failure = describe(result);
    return filling;
  }
  if (tasks != nullptr) tasks->keep(key, result.output);
  unpack_filling(result.output, filling);
  return filling;
}

}  // namespace aeroloom::volume
