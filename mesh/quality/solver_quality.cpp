#include "mesh/quality/solver_quality.hpp"

#include "mesh/exchange/delivery.hpp"
#include "mesh/quality/face_measures.hpp"
#include "mesh/quality/solver_sums.hpp"

#include <algorithm>
#include <span>
#include <tuple>
#include <utility>

namespace aeroloom::mesh {

namespace {

using geometry::Vec3;

constexpr std::size_t kept_per_solver_measure = 10;

/// While places are collected, the value of non-orthogonality is the cosine, of which the smaller is worse.
constexpr bool larger_is_kept(SolverMeasure measure) {
  return measure != SolverMeasure::non_orthogonality && larger_is_worse(measure);
}
bool is_worse_place(SolverMeasure measure, const WorstCellOfShape& a, const WorstCellOfShape& b) {
  const double sign = larger_is_kept(measure) ? -1 : 1;
  return std::make_tuple(sign * a.value, a.cell) < std::make_tuple(sign * b.value, b.cell);
}

/// The worst places by one measure that are known, worst first, each cell once.
template <SolverMeasure measure>
class WorstOf {
public:
  WorstOf() { _places.reserve(kept_per_solver_measure + 1); }

  bool is_full() const { return _places.size() == kept_per_solver_measure; }
  /// What is better is not kept.
  bool may_keep(double value) const {
    return !is_full() || (larger_is_kept(measure) ? value >= last() : value <= last());
  }
  /// Of a full list, the value of the last.
  double last() const { return _places.back().value; }

  void keep(const WorstCellOfShape& candidate) {
    if (is_full() && !worse(candidate, _places.back())) return;
    const auto same = std::find_if(_places.begin(), _places.end(), [&](const WorstCellOfShape& place) {
      return place.cell == candidate.cell;
    });
    if (same != _places.end()) {
      if (!worse(candidate, *same)) return;
      _places.erase(same);
    }
    _places.insert(std::upper_bound(_places.begin(), _places.end(), candidate, worse), candidate);
    if (_places.size() > kept_per_solver_measure) _places.pop_back();
  }
  const std::vector<WorstCellOfShape>& places() const { return _places; }

private:
  static bool worse(const WorstCellOfShape& a, const WorstCellOfShape& b) {
    return is_worse_place(measure, a, b);
  }

  std::vector<WorstCellOfShape> _places;
};

/// Below this value a measure of which the larger is worse matters neither for counts nor for places.
template <SolverMeasure measure>
double least_that_matters(const WorstOf<measure>& worst, double severe) {
  return worst.is_full() ? std::min(severe, worst.last()) : 0;
}

/// What the cell on the other side of a face has to know.
struct CellFacts {
  CellGeometry geometry;
  std::int64_t in_layers = 0;
};

struct CellsAtFace {
  CellFacts own, beyond;
};

FaceClass class_between(const CellFacts& a, const CellFacts& b) {
  const std::int64_t in_layers = a.in_layers + b.in_layers;
  return in_layers == 2   ? FaceClass::within_layers
         : in_layers == 1 ? FaceClass::at_front
                          : FaceClass::off_layers;
}

template <CellShape shape>
constexpr const auto& faces_of_shape() {
  if constexpr (shape == CellShape::tetrahedron) {
    return faces_of_tetrahedra;
  } else if constexpr (shape == CellShape::pyramid) {
    return faces_of_pyramids;
  } else if constexpr (shape == CellShape::prism) {
    return faces_of_prisms;
  } else {
    return faces_of_hexahedra;
  }
}

/// One cell with its points.
template <CellShape shape>
class CellAtHand {
public:
  static constexpr const auto& sides = faces_of_shape<shape>();

  CellAtHand(const Piece& piece, const LocalIndex* vertices) {
    for (std::size_t k = 0; k < _points.size(); ++k) _points[k] = piece.point(vertices[k]);
  }
  template <std::size_t side>
  auto corners() const {
    constexpr CellFace face = sides[side];
    constexpr std::size_t count = face[3] < 0 ? 3 : 4;
    std::array<Vec3, count> corners;
    for (std::size_t k = 0; k < count; ++k) corners[k] = _points[static_cast<std::uint8_t>(face[k])];
    return corners;
  }
  /// Calls visit(side, corners) for each side.
  template <class Visit>
  void for_each_side(const Visit& visit) const {
    [&]<std::size_t... side>(std::index_sequence<side...>) {
      (visit(side, corners<side>()), ...);
    }
    (std::make_index_sequence<sides.size()>{});
  }

private:
  std::array<Vec3, static_cast<std::size_t>(corners_of(shape))> _points;
};

/// Measures the pieces of this rank. A face between two pieces is left to the lower one, which is told of the
/// cell in the higher one.
class LocalJudge {
public:
  LocalJudge(const NumberedMesh& mesh, const FaceLinks& links, bool layers_known)
      : _mesh(mesh), _links(links), _layers_known(layers_known), _sums(mesh.pieces.size()) {
    for (const Piece& piece : mesh.pieces) {
      _cells.emplace_back(static_cast<std::size_t>(piece.total_cell_count()));
    }
  }

  /// All cells and all other faces. Returns what to tell.
  std::vector<Told<CellFacts>> measure_pieces() {
    std::vector<Told<CellFacts>> words;
    for (std::size_t p = 0; p < _mesh.pieces.size(); ++p) {
      measure_cells<CellShape::hexahedron>(p, words);
      measure_cells<CellShape::prism>(p, words);
      measure_cells<CellShape::pyramid>(p, words);
      measure_cells<CellShape::tetrahedron>(p, words);
    }
    return words;
  }

  /// The faces between pieces.
  void measure_between(const std::vector<Told<CellFacts>>& told) {
    std::array<Vec3, 4> corners;
    for (const auto& [to, beyond] : told) {
      const std::size_t p = position_of(_mesh, to.piece);
      const Piece& piece = _mesh.pieces[p];
      const FaceKey<LocalIndex> vertices = PieceFaces(piece).side(to.cell, to.side);
      const std::size_t count = vertices[3] < 0 ? 3 : 4;
      for (std::size_t k = 0; k < count; ++k) corners[k] = piece.point(vertices[k]);
      const std::span<const Vec3> of_face(corners.data(), count);
      measure_inner_face(measure_face(of_face), of_face, {p, to.cell, cell_of(piece, to.cell).shape},
                         {facts_of(p, to.cell), beyond});
    }
  }

  const std::vector<PieceSums>& sums() const { return _sums; }
  /// The worst places of this rank by SolverMeasure.
  std::array<std::vector<WorstCellOfShape>, solver_measure_count> worst() const {
    return {_non_orthogonal.places(), _skewed.places(), _stretched.places(), _underdetermined.places(),
            _jumps.places()};
  }

private:
  struct Place {
    std::size_t piece;  ///< of this rank
    LocalIndex cell;
    CellShape shape;
  };

  /// The last cells first, so each face is measured from the lower of its cells when both are known.
  template <CellShape shape>
  void measure_cells(std::size_t p, std::vector<Told<CellFacts>>& words) {
    const Piece& piece = _mesh.pieces[p];
    constexpr auto corners = static_cast<std::size_t>(corners_of(shape));
    const std::span<const LocalIndex> vertices = connectivity_of(piece, shape);
    const LocalIndex first = first_cell(piece, shape);
    for (std::size_t i = vertices.size() / corners; i-- > 0;) {
      const CellAtHand<shape> cell(piece, vertices.data() + corners * i);
      measure_cell_at(cell, {p, first + static_cast<LocalIndex>(i), shape}, words);
    }
  }

  template <CellShape shape>
  void measure_cell_at(const CellAtHand<shape>& cell, const Place& place,
                       std::vector<Told<CellFacts>>& words) {
    const Piece& piece = _mesh.pieces[place.piece];
    const CellNeighbour* neighbours =
        _links.pieces[place.piece].neighbours.data() + first_side(piece, place.cell);
    std::array<FaceGeometry, CellAtHand<shape>::sides.size()> faces;
    DeterminantSum inner;
    cell.for_each_side([&](std::size_t side, const auto& corners) {
      faces[side] = measure_face(corners);
      if (neighbours[side].exists()) inner.add(faces[side].area);
    });
    const CellGeometry geometry = measure_cell(faces);
    add_cell(faces, geometry, inner.determinant(), place);
    const CellFacts own = facts_of(place.piece, place.cell);
    cell.for_each_side([&](std::size_t side, const auto& corners) {
      const CellNeighbour& other = neighbours[side];
      if (!other.exists()) {
        ++_sums[place.piece].boundary_faces;
        add_skewness(skewness_at_boundary(faces[side], corners, geometry.center), place, faces[side].center);
      } else if (other.piece == piece.id) {
        if (other.cell > place.cell)
          measure_inner_face(faces[side], corners, place, {own, facts_of(place.piece, other.cell)});
      } else if (other.piece < piece.id) {
        words.push_back({other, own});
      }
    });
  }

  void add_cell(std::span<const FaceGeometry> faces, const CellGeometry& geometry, double determinant,
                const Place& place) {
    _cells[place.piece][static_cast<std::size_t>(place.cell)] = geometry;
    PieceSums& sums = _sums[place.piece];
    sums.add_determinant(determinant);
    offer(_underdetermined, determinant, place, geometry.center);
    if (!may_be_stretched(faces, geometry.volume, least_that_matters(_stretched, severe_aspect_ratio)))
      return;
    const double aspect = aspect_ratio(faces, geometry.volume);
    sums.add_aspect_ratio(aspect);
    offer(_stretched, aspect, place, geometry.center);
  }

  void measure_inner_face(const FaceGeometry& face, std::span<const Vec3> corners, const Place& place,
                          const CellsAtFace& cells) {
    const auto& [own, beyond] = cells;
    const Vec3 here = own.geometry.center, there = beyond.geometry.center;
    const double cosine = cosine_at_face(face.area, here, there);
    const double fraction = volume_fraction(own.geometry.volume, beyond.geometry.volume);
    _sums[place.piece].of_class[static_cast<std::size_t>(class_between(own, beyond))].add(cosine, fraction);
    offer(_non_orthogonal, cosine, place, face.center);
    offer(_jumps, fraction, place, face.center);
    if (may_be_skewed(face, corners, here, there, least_that_matters(_skewed, severe_skewness)))
      add_skewness(skewness_inside(face, corners, here, there), place, face.center);
  }

  void add_skewness(double skewness, const Place& place, Vec3 center) {
    _sums[place.piece].add_skewness(skewness);
    offer(_skewed, skewness, place, center);
  }

  template <SolverMeasure measure>
  void offer(WorstOf<measure>& worst, double value, const Place& place, Vec3 center) {
    if (worst.may_keep(value))
      worst.keep({value, _mesh.numbering.first_cell[place.piece] + place.cell, place.shape, center});
  }

  CellFacts facts_of(std::size_t p, LocalIndex c) const {
    const Piece& piece = _mesh.pieces[p];
    const bool in_layers = _layers_known
                               ? !piece.layers.empty() && piece.layers[static_cast<std::size_t>(c)] > 0
                               : c >= piece.cell_count();
    return {_cells[p][static_cast<std::size_t>(c)], in_layers ? 1 : 0};
  }

  const NumberedMesh& _mesh;
  const FaceLinks& _links;
  bool _layers_known;
  std::vector<std::vector<CellGeometry>> _cells;  // by piece
  std::vector<PieceSums> _sums;                   // by piece
  WorstOf<SolverMeasure::non_orthogonality> _non_orthogonal;
  WorstOf<SolverMeasure::skewness> _skewed;
  WorstOf<SolverMeasure::aspect_ratio> _stretched;
  WorstOf<SolverMeasure::determinant> _underdetermined;
  WorstOf<SolverMeasure::volume_ratio> _jumps;
};

/// Of all ranks. Collective.
std::vector<WorstCellOfShape> worst_places(const parallel::Communicator& communicator, SolverMeasure measure,
                                           const std::vector<WorstCellOfShape>& mine) {
  auto all = communicator.all_gather_items(std::span<const WorstCellOfShape>(mine));
  std::sort(all.begin(), all.end(), [measure](const WorstCellOfShape& a, const WorstCellOfShape& b) {
    return is_worse_place(measure, a, b);
  });
  if (all.size() > kept_per_solver_measure) all.resize(kept_per_solver_measure);
  if (measure == SolverMeasure::non_orthogonality) {
    for (WorstCellOfShape& place : all) place.value = degrees_of_cosine(place.value);
  }
  return all;
}

}  // namespace

std::string_view name_of(SolverMeasure measure) {
  constexpr std::array<std::string_view, solver_measure_count> names = {
      "non_orthogonality", "skewness", "aspect_ratio", "determinant", "volume_ratio"};
  return names[static_cast<std::size_t>(measure)];
}

std::string_view name_of(FaceClass face_class) {
  constexpr std::array<std::string_view, face_class_count> names = {"within_layers", "at_front",
                                                                    "off_layers"};
  return names[static_cast<std::size_t>(face_class)];
}

SolverQuality measure_as_solvers(const NumberedMesh& mesh, const FaceLinks& links) {
  const parallel::Communicator& communicator = mesh.communicator;
  const bool known = std::any_of(mesh.pieces.begin(), mesh.pieces.end(),
                                 [](const Piece& piece) { return !piece.layers.empty(); });
  LocalJudge judge(mesh, links, communicator.maximum(std::int64_t{known}) > 0);
  judge.measure_between(tell_cells(mesh, judge.measure_pieces()));
  PieceSums sum;
  for (const PieceSums& of_piece : gather_by_piece(mesh, judge.sums())) sum.add(of_piece);
  SolverQuality result = summarise(sum);
  const auto worst = judge.worst();
  for (std::size_t m = 0; m < solver_measure_count; ++m)
    result.worst[m] = worst_places(communicator, all_solver_measures[m], worst[m]);
  return result;
}

void add_faces(const SolverQuality& quality, WorstPlaces& places) {
  for (const auto& [measure, flaw] : {std::pair(SolverMeasure::non_orthogonality, Flaw::non_orthogonality),
                                      std::pair(SolverMeasure::skewness, Flaw::skewness)}) {
    std::vector<FlawedCell>& of = places.of[static_cast<std::size_t>(flaw)];
    of.clear();
    for (const WorstCellOfShape& place : quality.worst_of(measure)) {
      of.push_back(
          {place.value, severity_of(flaw, place.value), place.cell, place.shape, flaw, place.center});
    }
  }
  list_worst_of_all(places);
}

}  // namespace aeroloom::mesh
