/// From a CAD face to its pieces: background mesh, simplified dual graph, partition, repair, cuts, pieces,
/// after Chen, Zhao, Zheng et al. (22nd International Meshing Roundtable, 2013,
/// doi:10.1007/978-3-319-02335-9_31).
///
/// A piece problem that is too heavy is cut along a decomposition of its background mesh. A very heavy one is
/// cut twice: into about the square root of the number of pieces first, then each of these, by any rank. So
/// no rank has more to do with a single face than a small fraction of it.
#pragma once

#include "surface/division/imposed_cuts.hpp"
#include "surface/division/piece_problem.hpp"
#include "surface/surface_report.hpp"

#include <deque>
#include <vector>

namespace aeroloom::surface {

/// Sizes for background meshes: the fine ones, a power of two times as large.
class CoarseSizes {
public:
  explicit CoarseSizes(const sizing::SizeField& fine) : _fields{fine} {}
  /// The field 2^power times as large; made when it is asked for first.
  const sizing::SizeField& field(int power);
  const sizing::SizeField& fine() const { return _fields.front(); }

private:
  std::deque<sizing::SizeField> _fields;  // references to those made stay good
};

/// The cost of dividing a piece problem of so many triangles and facets (group 0: a face), in triangles to
/// mesh. An estimate by which work is distributed; no result depends on it.
double division_cost(double triangles, double facets, std::int32_t group, const SurfaceOptions& options);

struct DividedProblem {
  std::vector<PieceProblem> problems;
  std::vector<CutAngle> angles;  ///< where cuts end: on loops and where they meet
};

/// Whether a piece problem of this load is to be divided.
bool is_heavy(double load, const SurfaceOptions& options);

/// Divides a heavy piece problem, or any by a divider. Cuts are straightened, discretised once under the
/// field, and lie on the CAD surface; `group` keeps the names of their vertices apart from those of other
/// divisions of the same face: 0 for a face, which may be cut into large parts, others for its parts, which
/// are cut into pieces. Where no background mesh can be had, the piece problem stays whole. A function of the
/// arguments alone. Not collective. Throws SurfaceError, cad::CadError, or std::runtime_error where METIS
/// fails or there are more cuts than can be named.
DividedProblem divide_problem(const cad::Model& model, PieceProblem problem, std::int32_t group,
                              CoarseSizes& sizes, const CutOptions& options);

}  // namespace aeroloom::surface
