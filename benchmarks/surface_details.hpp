// What a table cannot hold of a surface mesh, as JSON: the shape of its triangles by piece and by what they
// touch, and histograms. benchmarks/results/surface_cuts.md and surface_quality.md
// are made from it.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "mesh/quality/quality.hpp"
#include "parallel/communication/communicator.hpp"
#include "surface/surface_report.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::benchmarks {

/// What a triangle touches with a vertex: a cut, a CAD curve, both, or neither.
enum TriangleGroup : std::int8_t { at_cut, at_cut_and_curve, at_curve, inside };
inline constexpr int group_count = 4;

/// Bins of two degrees from 0 to 60, and of a hundredth from 0 to 1.
inline constexpr int angle_bins = 30, ratio_bins = 100;

/// The triangles of one piece, by group.
struct PieceShape {
  std::int32_t face = -1, piece = -1;
  std::array<double, group_count> count{}, angle_sum{}, ratio_sum{};

  static constexpr auto fields() {
    return std::tuple(&PieceShape::face, &PieceShape::piece, &PieceShape::count, &PieceShape::angle_sum,
                      &PieceShape::ratio_sum);
  }
};

/// Of all triangles, by group.
struct ShapeHistograms {
  std::array<std::array<double, angle_bins>, group_count> angle{};
  std::array<std::array<double, ratio_bins>, group_count> ratio{};

  static constexpr auto fields() { return std::tuple(&ShapeHistograms::angle, &ShapeHistograms::ratio); }
};

class SurfaceDetails {
public:
  /// Collective. One row per piece comes to all ranks.
  SurfaceDetails(const mesh::DistributedMesh& surface) {
    const parallel::Communicator& communicator = surface.communicator;
    ShapeHistograms mine;
    std::vector<PieceShape> shapes;
    for (const mesh::Piece& piece : surface.pieces) shapes.push_back(measure(piece, mine));
    _pieces = communicator.all_gather_items<PieceShape>(shapes);
    std::sort(_pieces.begin(), _pieces.end(),
              [](const PieceShape& a, const PieceShape& b) { return a.piece < b.piece; });
    for (const ShapeHistograms& one : communicator.all_gather_values(mine)) {
      for (int k = 0; k < group_count; ++k) {
        for (int i = 0; i < angle_bins; ++i) _histograms.angle[k][i] += one.angle[k][i];
        for (int i = 0; i < ratio_bins; ++i) _histograms.ratio[k][i] += one.ratio[k][i];
      }
    }
  }

  /// Throws std::runtime_error where the file cannot be written.
  void write(const std::string& path, const std::vector<surface::CutAngle>& angles,
             const std::vector<double>& cpu_of_ranks) const {
    std::FILE* file = std::fopen(path.c_str(), "w");
    if (file == nullptr) throw std::runtime_error("'" + path + "' cannot be written");
    std::fprintf(file, "{\"groups\": [\"cut\", \"cut_and_curve\", \"curve\", \"inside\"],\n\"pieces\": [");
    for (std::size_t i = 0; i < _pieces.size(); ++i) {
      const PieceShape& p = _pieces[i];
      std::fprintf(file, "%s\n{\"face\": %d, \"piece\": %d, \"count\": ", i == 0 ? "" : ",", p.face, p.piece);
      print(file, p.count);
      std::fprintf(file, ", \"angle_sum\": ");
      print(file, p.angle_sum);
      std::fprintf(file, ", \"ratio_sum\": ");
      print(file, p.ratio_sum);
      std::fprintf(file, "}");
    }
    std::fprintf(file, "],\n\"angle_histograms\": [");
    print_all(file, _histograms.angle);
    std::fprintf(file, "],\n\"ratio_histograms\": [");
    print_all(file, _histograms.ratio);
    std::vector<double> degrees;
    for (const surface::CutAngle& angle : angles) degrees.push_back(angle.degrees);
    std::fprintf(file, "],\n\"cut_angles\": ");
    print(file, degrees);
    std::fprintf(file, ",\n\"cpu_of_ranks\": ");
    print(file, cpu_of_ranks);
    std::fprintf(file, "}\n");
    if (std::fclose(file) != 0) throw std::runtime_error("'" + path + "' cannot be written");
  }

private:
  static PieceShape measure(const mesh::Piece& piece, ShapeHistograms& histograms) {
    PieceShape shape{piece.common_face(), piece.id};
    std::vector<char> on_cut(piece.vertex_count(), 0);
    for (std::size_t i = 0; i < piece.shared_vertices.size(); ++i)
      on_cut[piece.shared_vertices[i]] = mesh::is_cut_vertex_key(piece.shared_keys[i]);
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const bool cut = std::any_of(v, v + 3, [&](mesh::LocalIndex at) { return on_cut[at] != 0; });
      const bool curve =
          std::any_of(v, v + 3, [&](mesh::LocalIndex at) { return is_on_curve(piece.vertex_dimension[at]); });
      const TriangleGroup group = cut ? (curve ? at_cut_and_curve : at_cut) : (curve ? at_curve : inside);
      const geometry::Vec3 p[3] = {piece.point(v[0]), piece.point(v[1]), piece.point(v[2])};
      const double angle = mesh::smallest_angle(p[0], p[1], p[2]);
      const double ratio = mesh::triangle_mean_ratio(p[0], p[1], p[2]);
      shape.count[group] += 1;
      shape.angle_sum[group] += angle;
      shape.ratio_sum[group] += ratio;
      histograms.angle[group][bin(angle / 2, angle_bins)] += 1;
      histograms.ratio[group][bin(ratio * ratio_bins, ratio_bins)] += 1;
    }
    return shape;
  }

  static int bin(double place, int bins) { return std::clamp(static_cast<int>(place), 0, bins - 1); }

  template <class Numbers>
  static void print(std::FILE* file, const Numbers& numbers) {
    std::fprintf(file, "[");
    for (std::size_t i = 0; i < numbers.size(); ++i)
      std::fprintf(file, "%s%.10g", i == 0 ? "" : ", ", numbers[i]);
    std::fprintf(file, "]");
  }

  template <class Rows>
  static void print_all(std::FILE* file, const Rows& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      std::fprintf(file, "%s\n", i == 0 ? "" : ",");
      print(file, rows[i]);
    }
  }

  std::vector<PieceShape> _pieces;  // by number
  ShapeHistograms _histograms;
};

}  // namespace aeroloom::benchmarks
