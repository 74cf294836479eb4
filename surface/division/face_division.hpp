/// Divides a CAD face into pieces: background mesh, simplified dual graph, partition, repair, cuts. After
/// Chen, Zhao, Zheng et al. (22nd International Meshing Roundtable, 2013, doi:10.1007/978-3-319-02335-9_31).
///
/// A piece problem that is too heavy is cut along a partition of its background mesh. A very heavy face is
/// cut twice: first into about the square root of the number of pieces, then each of these parts, on any
/// rank. So one face never keeps a single rank busy for long.
#pragma once

#include "surface/division/imposed_cuts.hpp"
#include "surface/division/piece_problem.hpp"
#include "surface/surface_report.hpp"

#include <deque>
#include <vector>

namespace aeroloom::surface {

/// Size fields for background meshes: the fine field times powers of two.
class CoarseSizes {
public:
  explicit CoarseSizes(const sizing::SizeField& fine) : _fields{fine} {}
  /// The field 2^power times as large. It is made at the first call.
  const sizing::SizeField& field(int power);
  const sizing::SizeField& fine() const { return _fields.front(); }

private:
  std::deque<sizing::SizeField> _fields;  // references to those made stay good
};

/// The estimated cost of dividing a problem with so many triangles and facets, in triangles to mesh. Group 0
/// is a face. Work is scheduled by it; no result depends on it.
double division_cost(double triangles, double facets, std::int32_t group, const SurfaceOptions& options);

struct DividedProblem {
  std::vector<PieceProblem> problems;
  std::vector<CutAngle> angles;  ///< where cuts end: on loops and where they meet
};

/// Whether a problem with this load is divided.
bool is_heavy(double load, const SurfaceOptions& options);

/// Divides a problem, by options.divider if there is one. Cuts lie on the CAD surface, are straightened, and
/// are discretised once under the field. `group` distinguishes the vertex keys of several divisions of one
/// face. Group 0 divides a face, possibly into large parts; other groups divide such a part into pieces.
/// Where no background mesh can be made the problem stays whole. The result depends on the arguments alone.
/// Not collective. Throws SurfaceError, cad::CadError, or std::runtime_error where METIS fails or there are
/// too many cuts for their keys.
DividedProblem divide_problem(const cad::Model& model, PieceProblem problem, std::int32_t group,
                              CoarseSizes& sizes, const CutOptions& options);

}  // namespace aeroloom::surface
