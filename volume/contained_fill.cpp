#include "volume/contained_fill.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace aeroloom::volume {

using geometry::Vec3;
using parallel::Bytes;

namespace {

const char* const task_name = "volume.fill";

// Limits of a child. TetGen takes about 1 us and 350 bytes per tetrahedron; what takes forty times as long is
// stuck.
constexpr double base_cpu_seconds = 10.0;
constexpr double cpu_seconds_per_tetrahedron = 40e-6;
constexpr std::int64_t base_bytes = 2LL << 30;
constexpr std::int64_t bytes_per_tetrahedron = 1500;

/// Moves a piece near the origin and to about unit size, where TetGen's tolerances suit it. Exact: a
/// coordinate axis is shifted only when the piece is far from its zero (Sterbenz: such a difference has no
/// rounding), and the scale is a power of two. So every orientation is what it was.
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

void commit_sabotage(VolumeOptions::Sabotage sabotage) {
  using Sabotage = VolumeOptions::Sabotage;
  if (sabotage == Sabotage::throws) throw std::runtime_error("sabotage: an exception");
  if (sabotage == Sabotage::aborts) std::abort();
  if (sabotage == Sabotage::hangs) {
    for (;;) std::atomic_signal_fence(std::memory_order_seq_cst);
  }
  if (sabotage == Sabotage::exhausts_memory) {
    constexpr std::size_t chunk = 64 << 20;
    std::vector<std::vector<char>> hoard;
    for (;;) hoard.emplace_back(chunk, 'x');
  }
}

FillRequest unpack_request(std::span<const std::byte> input) {
  parallel::Unpacker unpacker(input);
  FillRequest request;
  request.sabotage = unpacker.value<VolumeOptions::Sabotage>();
  request.interior = unpacker.value<InteriorPoints>();
  request.surface_points = unpacker.value<std::uint64_t>();
  request.interior_points = unpacker.value<std::uint64_t>();
  request.points = unpacker.array<Vec3>();
  request.triangles = unpacker.array<Triangle>();
  return request;
}

Bytes pack_request(const FillRequest& request) {
  parallel::Packer packer;
  packer.value(request.sabotage);
  packer.value(request.interior);
  packer.value(static_cast<std::uint64_t>(request.surface_points));
  packer.value(static_cast<std::uint64_t>(request.interior_points));
  packer.array(request.points);
  packer.array(request.triangles);
  return packer.take();
}

TetgenMesh triangulate(const FillRequest& request, const UnitFrame& frame) {
  std::vector<double> unit;
  unit.reserve(3 * request.points.size());
  for (const Vec3& p : request.points) {
    const Vec3 q = frame.to_unit(p);
    unit.insert(unit.end(), {q.x, q.y, q.z});
  }
  return run_tetgen(unit, request.surface_points, request.triangles, request.interior);
}

/// Runs in the child.
Bytes fill_task(std::span<const std::byte> input) {
  FillRequest request = unpack_request(input);
  commit_sabotage(request.sabotage);
  const UnitFrame frame(request.points);
  auto& points = request.points;
  const std::size_t given = points.size();
  std::vector<Cell> cells;
  {
    const TetgenMesh mesh = triangulate(request, frame);
    for (std::size_t s = 0; s < mesh.added.size(); s += 3) {
      points.push_back(frame.from_unit({mesh.added[s], mesh.added[s + 1], mesh.added[s + 2]}));
    }
    cells = cells_inside(mesh, request.triangles);
  }
  const auto used = drop_unused_points(points, cells, request.surface_points);
  const auto first_scaffold =
      used.begin() + static_cast<std::ptrdiff_t>(request.surface_points + request.interior_points);
  const auto first_added = used.begin() + static_cast<std::ptrdiff_t>(given);
  check_filling(points, cells, request.triangles);
  sort_along_curve(points, cells);
  parallel::Packer packer;
  packer.value(static_cast<std::int64_t>(std::count(first_added, used.end(), 1)));
  packer.value(static_cast<std::int64_t>(std::count(used.begin(), first_scaffold, 0)));
  packer.array(points);
  packer.array(cells);
  return packer.take();
}

FilledVolume unpack_volume(const Bytes& output) {
  parallel::Unpacker unpacker(output);
  FilledVolume volume;
  volume.steiner_points = unpacker.value<std::int64_t>();
  volume.dropped_points = unpacker.value<std::int64_t>();
  const auto points = unpacker.array<Vec3>();
  volume.coordinates.reserve(3 * points.size());
  for (const Vec3& p : points) volume.coordinates.insert(volume.coordinates.end(), {p.x, p.y, p.z});
  const auto cells = unpacker.array<Cell>();
  volume.tetrahedra.reserve(4 * cells.size());
  for (const Cell& c : cells) volume.tetrahedra.insert(volume.tetrahedra.end(), c.begin(), c.end());
  return volume;
}

std::string describe(const parallel::ContainedResult& result) {
  using Status = parallel::ContainedStatus;
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

std::int64_t predict_tetrahedra(const FillRequest& request) {
  return tetrahedra_per_point * static_cast<std::int64_t>(request.interior_points) +
         tetrahedra_per_triangle * static_cast<std::int64_t>(request.triangles.size());
}

FillReply fill_contained(const FillRequest& request) {
  const std::int64_t predicted = predict_tetrahedra(request);
  const parallel::ContainedLimits limits{
      base_cpu_seconds + cpu_seconds_per_tetrahedron * static_cast<double>(predicted),
      base_bytes + bytes_per_tetrahedron * predicted};
  const auto result = parallel::run_contained(task_name, pack_request(request), limits);
  FillReply reply;
  reply.filled = result.status == parallel::ContainedStatus::ok;
  if (reply.filled) {
    reply.volume = unpack_volume(result.output);
  } else {
    reply.failure = describe(result);
  }
  reply.volume.cpu_seconds = result.cpu_seconds;
  reply.volume.child_peak_bytes = result.peak_resident_bytes;
  return reply;
}

void register_volume_tasks() {
  parallel::register_contained_task(task_name, fill_task);
}

}  // namespace aeroloom::volume
