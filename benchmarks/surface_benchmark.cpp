/// The surface stage alone: mpirun -n N surface_benchmark CASE [KEY=VALUE ...] [OPTION ...] prints one RESULT
/// line. --write: surface.pvtp goes to the case's output directory. --details FILE: shapes by piece and
/// histograms as JSON. --without STEP[,STEP ...]: leaves out steps of the decomposition of faces:
/// contraction, repair, widening, straightening.
///
/// CPU figures are those of the stage clock: around the tasks, without waiting. "Cut" triangles have a vertex
/// on a border between pieces of one CAD face. Needles: below 10 degrees, below 5, the least angle.
#include "benchmarks/surface_details.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/quality.hpp"
#include "parallel/communication/environment.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/domain/load_domain.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "surface/surface_mesher.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

namespace {

using namespace aeroloom;
using parallel::Communicator;

/// Sums over all triangles, those that touch a cut apart, and over all edges.
struct Shape {
  double count[2] = {0, 0}, mean_ratio[2] = {0, 0};
  double worst_mean_ratio[2] = {1, 1}, smallest_angle[2] = {180, 180};
  double edges = 0, good_edges = 0;
};

Shape measure(const mesh::Piece& piece, const sizing::SizeField& field) {
  Shape shape;
  std::vector<char> on_cut(piece.vertex_count(), 0);
  for (const mesh::LocalIndex v : piece.shared_vertices)
    on_cut[v] = piece.vertex_dimension[v] == mesh::CadDimension::face;
  for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const mesh::LocalIndex* v = piece.cell(t);
    const geometry::Vec3 p[3] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
    const int k = on_cut[v[0]] || on_cut[v[1]] || on_cut[v[2]];
    const double ratio = mesh::triangle_mean_ratio(p[0], p[1], p[2]);
    shape.count[k] += 1;
    shape.mean_ratio[k] += ratio;
    shape.worst_mean_ratio[k] = std::min(shape.worst_mean_ratio[k], ratio);
    shape.smallest_angle[k] = std::min(shape.smallest_angle[k], mesh::smallest_angle(p[0], p[1], p[2]));
    for (int i = 0; i < 3; ++i) {
      const geometry::Vec3 a = p[i], b = p[(i + 1) % 3];
      const double length = distance(a, b) / field(0.5 * (a + b));
      shape.edges += 1;
      shape.good_edges += length >= 0.7 && length <= 1.4;
    }
  }
  return shape;
}

Shape measure(const mesh::DistributedMesh& surface, const sizing::SizeField& field) {
  const Communicator& communicator = surface.communicator;
  Shape all;
  for (const mesh::Piece& piece : surface.pieces) {
    const Shape one = measure(piece, field);
    for (int k = 0; k < 2; ++k) {
      all.count[k] += one.count[k];
      all.mean_ratio[k] += one.mean_ratio[k];
      all.worst_mean_ratio[k] = std::min(all.worst_mean_ratio[k], one.worst_mean_ratio[k]);
      all.smallest_angle[k] = std::min(all.smallest_angle[k], one.smallest_angle[k]);
    }
    all.edges += one.edges;
    all.good_edges += one.good_edges;
  }
  for (int k = 0; k < 2; ++k) {
    all.count[k] = communicator.sum(all.count[k]);
    all.mean_ratio[k] = communicator.sum(all.mean_ratio[k]) / std::max(all.count[k], 1.0);
    all.worst_mean_ratio[k] = communicator.minimum(all.worst_mean_ratio[k]);
    all.smallest_angle[k] = communicator.minimum(all.smallest_angle[k]);
  }
  all.edges = communicator.sum(all.edges);
  all.good_edges = communicator.sum(all.good_edges);
  return all;
}

/// Triangles away from listed corners: how sharp the sharpest is, and how many are below 20 and 10 degrees.
struct Sharp {
  double least = 180;
  std::int64_t below_20 = 0, below_10 = 0;
};

Sharp measure_sharp(const surface::SurfaceMesh& surface) {
  const Communicator& communicator = surface.communicator;
  using Place = std::tuple<cad::FaceId, double, double, double>;
  std::set<Place> listed;
  for (const surface::ListedCorner& c : surface.report.sharp_corners) {
    listed.insert({c.face, c.point.x, c.point.y, c.point.z});
  }
  Sharp sharp;
  for (const mesh::Piece& piece : surface.pieces) {
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const geometry::Vec3 p[3] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
      const double angle = mesh::smallest_angle(p[0], p[1], p[2]);
      if (angle >= 20 && angle >= sharp.least) continue;
      const bool at_corner = std::any_of(p, p + 3, [&](geometry::Vec3 q) {
        return listed.count({piece.common_face(), q.x, q.y, q.z}) > 0;
      });
      if (at_corner) continue;
      sharp.least = std::min(sharp.least, angle);
      sharp.below_20 += angle < 20;
      sharp.below_10 += angle < 10;
    }
  }
  return {communicator.minimum(sharp.least), communicator.sum(sharp.below_20),
          communicator.sum(sharp.below_10)};
}

/// Needles that the CAD forces, or does not: below ten degrees, below five, the least.
struct NeedleCount {
  std::int64_t below_10 = 0, below_5 = 0;
  double least = 180;
};

NeedleCount count_needles(const surface::SurfaceReport& report, bool forced) {
  NeedleCount count;
  for (const surface::NeedleGroup& group : report.needles) {
    if ((group.cause != surface::NeedleCause::mesh) != forced) continue;
    count.below_10 += group.needles;
    count.below_5 += group.below_half;
    count.least = std::min(count.least, group.degrees);
  }
  return count;
}

/// What the decomposition of faces made: how many fine edges its cuts have, and how much heavier than the
/// mean piece of its face the heaviest one is (the worst face).
struct Decomposition {
  double cut_edges = 0, imbalance = 1;
};

Decomposition inspect_pieces(const mesh::DistributedMesh& surface) {
  const Communicator& communicator = surface.communicator;
  struct Row {
    std::int32_t face, piece, triangles, border;

    static constexpr auto fields() {
      return std::tuple(&Row::face, &Row::piece, &Row::triangles, &Row::border);
    }
  };
  std::vector<Row> rows;
  for (const mesh::Piece& piece : surface.pieces) {
    std::int32_t border = 0;
    for (const mesh::LocalIndex v : piece.shared_vertices)
      border += piece.vertex_dimension[v] == mesh::CadDimension::face;
    rows.push_back({piece.common_face(), piece.id, piece.cell_count(), border});
  }
  rows = communicator.all_gather_items<Row>(rows);
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.piece < b.piece; });
  Decomposition result;
  for (std::size_t i = 0; i < rows.size();) {
    double sum = 0, most = 0;
    std::size_t end = i;
    for (; end < rows.size() && rows[end].face == rows[i].face; ++end) {
      sum += rows[end].triangles;
      most = std::max(most, double(rows[end].triangles));
      result.cut_edges += 0.5 * rows[end].border;
    }
    result.imbalance = std::max(result.imbalance, most * static_cast<double>(end - i) / sum);
    i = end;
  }
  return result;
}

struct Request {
  std::vector<std::string> settings;
  surface::DivisionSteps steps;
  std::string details;  // empty: none
  bool write = false;
};

surface::DivisionSteps steps_without(std::string names) {
  surface::DivisionSteps steps;
  for (std::size_t end = 0; end != std::string::npos;) {
    end = names.find(',');
    const std::string name = names.substr(0, end);
    bool* step = name == "contraction"     ? &steps.contraction
                 : name == "repair"        ? &steps.repair
                 : name == "widening"      ? &steps.widening
                 : name == "straightening" ? &steps.straightening
                                           : nullptr;
    if (step == nullptr) throw std::invalid_argument("--without: no step '" + name + "'");
    *step = false;
    if (end != std::string::npos) names.erase(0, end + 1);
  }
  return steps;
}

Request read_request(const std::vector<std::string>& arguments) {
  Request request;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--write") {
      request.write = true;
    } else if (argument.starts_with("--")) {
      if (i + 1 == arguments.size()) throw std::invalid_argument(argument + " lacks its value");
      if (argument == "--without") {
        request.steps = steps_without(arguments[++i]);
      } else if (argument == "--details") {
        request.details = arguments[++i];
      } else {
        throw std::invalid_argument("no option " + argument);
      }
    } else {
      request.settings.push_back(argument);
    }
  }
  return request;
}

void run(const Communicator& communicator, const cases::Case& input, const Request& request) {
  parallel::StageClock clock;
  cad::DomainReport domain;
  clock.begin("geometry");
  const cad::Model model = domain::load_domain(communicator, input.domain, domain);
  clock.end();
  clock.begin("sizing");
  const domain::SizedDomain sized =
      domain::size_domain(communicator, model, input.sizing, domain::Simplification::of(input));
  clock.end();
  clock.begin("surface");
  const surface::SurfaceMesh surface = surface::mesh_surface(sized.model, sized.field, input.surface);
  clock.end();
  const std::vector<parallel::StageSummary> stages = clock.summarise(communicator);
  const parallel::StageSummary& stage = stages.back();
  const double sizing = stages[1].cpu_seconds_mean * communicator.size();
  const auto validity = mesh::check_surface_mesh(surface);
  const std::string hash = mesh::hash_mesh(surface);
  const Shape shape = measure(surface, surface.field);
  const auto quality = mesh::summarise_quality(surface);
  const Sharp apart = measure_sharp(surface);
  const Decomposition decomposition = inspect_pieces(surface);
  const benchmarks::SurfaceDetails details(surface);
  if (request.write) io::write_surface(surface, input.output.directory, "surface");
  if (!communicator.is_root()) return;
  if (!request.details.empty())
    details.write(request.details, surface.report.cut_angles, stage.cpu_seconds_of_ranks);
  double sharpest = 180;
  int sharp = 0, bins[6] = {0, 0, 0, 0, 0, 0};
  for (const surface::CutAngle& angle : surface.report.cut_angles) {
    sharpest = std::min(sharpest, angle.degrees);
    sharp += angle.degrees < 30;
    ++bins[std::min(5, static_cast<int>(angle.degrees / 10))];
  }
  const NeedleCount forced = count_needles(surface.report, true),
                    others = count_needles(surface.report, false);
  const double total = stage.cpu_seconds_mean * communicator.size();
  const auto triangles = static_cast<double>(surface.report.triangles);
  std::printf(
      "RESULT ranks=%d pieces=%d triangles=%.0f valid=%d wall_seconds=%.3f cpu_total=%.3f sizing_cpu=%.3f "
      "cpu_max=%.3f "
      "busiest=%.3f serial_share=%.4f triangles_per_cpu_second=%.0f load_error_90=%.3f rounds=%d\n"
      "       min_angle=%.2f mean_ratio=%.4f good_edges=%.4f cut_triangles=%.0f cut_mean_ratio=%.4f "
      "other_mean_ratio=%.4f cut_worst=%.3f other_worst=%.3f cut_min_angle=%.2f "
      "cut_places=%zu cut_places_below_30=%d cut_angle_min=%.2f "
      "cut_edges=%.0f imbalance=%.3f cut_angles_by_10=%d,%d,%d,%d,%d,%d\n"
      "       joined_faces=%zu sharp_corners=%zu min_angle_apart=%.2f below_20_apart=%lld "
      "below_10_apart=%lld forced_needles=%lld,%lld,%.4g other_needles=%lld,%lld,%.4g hash=%s\n",
      communicator.size(), surface.piece_count, triangles, validity.valid(), stage.wall_seconds, total,
      sizing, stage.cpu_seconds_max, stage.cpu_seconds_max / stage.cpu_seconds_mean,
      stage.serial_seconds * communicator.size() / total, triangles / total, surface.report.load_error_90,
      surface.report.mending_rounds, quality.min_dihedral.minimum, quality.mean_ratio.mean,
      shape.good_edges / shape.edges, shape.count[1], shape.mean_ratio[1], shape.mean_ratio[0],
      shape.worst_mean_ratio[1], shape.worst_mean_ratio[0], shape.smallest_angle[1],
      surface.report.cut_angles.size(), sharp, sharpest, decomposition.cut_edges, decomposition.imbalance,
      bins[0], bins[1], bins[2], bins[3], bins[4], bins[5], sized.findings.joined.changes.size(),
      surface.report.sharp_corners.size(), apart.least, static_cast<long long>(apart.below_20),
      static_cast<long long>(apart.below_10), static_cast<long long>(forced.below_10),
      static_cast<long long>(forced.below_5), forced.least, static_cast<long long>(others.below_10),
      static_cast<long long>(others.below_5), others.least, hash.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  const parallel::Environment environment(argc, argv);
  const Communicator world = Communicator::world();
  if (argc < 2) {
    std::fprintf(stderr, "usage: surface_benchmark CASE [KEY=VALUE ...] [OPTION ...]\n");
    return 2;
  }
  try {
    const bool verbose = std::getenv("AEROLOOM_VERBOSE") != nullptr;
    parallel::configure_log(world, verbose ? parallel::LogLevel::verbose : parallel::LogLevel::quiet);
    const Request request = read_request({argv + 2, argv + argc});
    cases::Case input = cases::read_case(argv[1], request.settings);
    input.surface.division = request.steps;
    run(world, input, request);
  } catch (const std::exception& error) {
    if (world.is_root()) std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
