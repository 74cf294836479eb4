#include "mesh/quality/solver_quality.hpp"

#include "mesh/exchange/delivery.hpp"
#include "mesh/quality/face_measures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <tuple>
#include <utility>

namespace aeroloom::mesh {

namespace {

using geometry::Vec3;

constexpr std::size_t kept_per_solver_measure = 10;
constexpr double none_yet = std::numeric_limits<double>::infinity();

/// While places are collected, the value of non-orthogonality is the cosine, of which the smaller is worse.
bool larger_is_kept(std::size_t measure) {
  return all_solver_measures[measure] != SolverMeasure::non_orthogonality &&
         larger_is_worse(all_solver_measures[measure]);
}
bool is_worse_place(std::size_t measure, const WorstCellOfShape& a, const WorstCellOfShape& b) {
  const double sign = larger_is_kept(measure) ? -1 : 1;
  return std::make_tuple(sign * a.value, a.cell) < std::make_tuple(sign * b.value, b.cell);
}

/// The inner faces of one class in one piece.
struct ClassRow {
  GlobalIndex faces = 0, non_orthogonal = 0, high_ratios = 0, severe_ratios = 0;
  double cosines = 0, least_cosine = none_yet;
  double fractions = 0, least_fraction = none_yet;

  void add(double cosine, double fraction) {
    static const double severe_cosine = std::cos(severe_non_orthogonality * std::numbers::pi / 180);
    ++faces;
    cosines += cosine;
    fractions += fraction;
    least_cosine = std::min(least_cosine, cosine);
    least_fraction = std::min(least_fraction, fraction);
    if (cosine < severe_cosine) ++non_orthogonal;
    if (high_volume_ratio * fraction < 1) ++high_ratios;
    if (severe_volume_ratio * fraction < 1) ++severe_ratios;
  }
  void add(const ClassRow& other) {
    faces += other.faces, non_orthogonal += other.non_orthogonal;
    high_ratios += other.high_ratios, severe_ratios += other.severe_ratios;
    cosines += other.cosines, fractions += other.fractions;
    least_cosine = std::min(least_cosine, other.least_cosine);
    least_fraction = std::min(least_fraction, other.least_fraction);
  }
};

/// The figures of one piece.
struct PieceRow {
  std::array<ClassRow, face_class_count> of_class;
  GlobalIndex cells = 0, boundary_faces = 0, skewed = 0, stretched = 0, underdetermined = 0;
  double largest_skewness = 0, largest_aspect_ratio = 0;
  double determinants = 0, least_determinant = none_yet;

  void add_skewness(double value) {
    largest_skewness = std::max(largest_skewness, value);
    if (value > severe_skewness) ++skewed;
  }
  void add_cell(double aspect, double determinant) {
    ++cells;
    largest_aspect_ratio = std::max(largest_aspect_ratio, aspect);
    if (aspect > severe_aspect_ratio) ++stretched;
    determinants += determinant;
    least_determinant = std::min(least_determinant, determinant);
    if (determinant < severe_determinant) ++underdetermined;
  }
  void add(const PieceRow& other) {
    for (std::size_t c = 0; c < face_class_count; ++c) of_class[c].add(other.of_class[c]);
    cells += other.cells, boundary_faces += other.boundary_faces;
    skewed += other.skewed, stretched += other.stretched, underdetermined += other.underdetermined;
    largest_skewness = std::max(largest_skewness, other.largest_skewness);
    largest_aspect_ratio = std::max(largest_aspect_ratio, other.largest_aspect_ratio);
    determinants += other.determinants;
    least_determinant = std::min(least_determinant, other.least_determinant);
  }
};

/// What the cell on the other side of a face has to know.
struct CellFacts {
  CellGeometry geometry;
  std::int64_t in_layers = 0;
};

/// One cell with its points.
class CellAtHand {
public:
  CellAtHand(const Piece& piece, LocalIndex cell) : _place(cell_of(piece, cell)) {
    points_of(piece, _place, _points.data());
  }
  CellShape shape() const { return _place.shape; }
  std::size_t face_count() const { return faces_of(_place.shape).size(); }

  /// Fills `corners`; valid until that is filled again.
  std::span<const Vec3> corners_at(std::size_t side, std::array<Vec3, 4>& corners) const {
    std::size_t count = 0;
    for (const std::int8_t k : faces_of(_place.shape)[side]) {
      if (k >= 0) corners[count++] = _points[static_cast<std::uint8_t>(k)];
    }
    return {corners.data(), count};
  }
  /// Fills `faces`; valid until that is filled again.
  std::span<const FaceGeometry> faces(std::array<FaceGeometry, 5>& faces) const {
    std::array<Vec3, 4> corners;
    for (std::size_t side = 0; side < face_count(); ++side)
      faces[side] = measure_face(corners_at(side, corners));
    return {faces.data(), face_count()};
  }

private:
  CellOfPiece _place;
  std::array<Vec3, 6> _points;
};

/// Measures the pieces of this rank: first cells, then faces, when what other pieces tell is there.
class LocalJudge {
public:
  LocalJudge(const NumberedMesh& mesh, const FaceLinks& links, bool layers_known)
      : _mesh(mesh), _links(links), _layers_known(layers_known), _rows(mesh.pieces.size()) {}

  void measure_cells() {
    for (std::size_t p = 0; p < _mesh.pieces.size(); ++p) {
      const Piece& piece = _mesh.pieces[p];
      _cells.emplace_back(static_cast<std::size_t>(piece.total_cell_count()));
      for (LocalIndex c = 0; c < piece.total_cell_count(); ++c) measure_cell_at(p, c);
    }
  }

  /// Tells the lower of both pieces at a face of the cell in the higher one.
  std::vector<Told<CellFacts>> words() const {
    std::vector<Told<CellFacts>> words;
    for (std::size_t p = 0; p < _mesh.pieces.size(); ++p) {
      const Piece& piece = _mesh.pieces[p];
      const std::vector<CellNeighbour>& neighbours = _links.pieces[p].neighbours;
      for (std::size_t side = 0; side < neighbours.size(); ++side) {
        if (neighbours[side].exists() && neighbours[side].piece < piece.id)
          words.push_back({neighbours[side], facts_of(p, cell_at_side(piece, side).cell)});
      }
    }
    return words;
  }

  /// `told` by cell and side.
  void measure_faces(const std::vector<Told<CellFacts>>& told) {
    auto next = told.begin();
    for (std::size_t p = 0; p < _mesh.pieces.size(); ++p) {
      for (LocalIndex c = 0; c < _mesh.pieces[p].total_cell_count(); ++c) measure_faces_of(p, c, next);
    }
  }

  const std::vector<PieceRow>& rows() const { return _rows; }
  const std::vector<WorstCellOfShape>& worst(std::size_t measure) const { return _worst[measure]; }

private:
  using Word = std::vector<Told<CellFacts>>::const_iterator;

  void measure_cell_at(std::size_t p, LocalIndex c) {
    const Piece& piece = _mesh.pieces[p];
    const CellAtHand cell(piece, c);
    std::array<FaceGeometry, 5> storage;
    const std::span<const FaceGeometry> faces = cell.faces(storage);
    const CellGeometry geometry = _cells[p][static_cast<std::size_t>(c)] = measure_cell(faces);
    const CellNeighbour* neighbours = _links.pieces[p].neighbours.data() + first_side(piece, c);
    DeterminantSum inner;
    for (std::size_t side = 0; side < faces.size(); ++side) {
      if (neighbours[side].exists()) inner.add(faces[side].area);
    }
    const double aspect = aspect_ratio(faces, geometry.volume), determinant = inner.determinant();
    _rows[p].add_cell(aspect, determinant);
    WorstCellOfShape place{aspect, _mesh.numbering.first_cell[p] + c, cell.shape(), geometry.center};
    keep(SolverMeasure::aspect_ratio, place);
    place.value = determinant;
    keep(SolverMeasure::determinant, place);
  }

  /// The faces that no cell before this one has. `next`: what the first of them is told.
  void measure_faces_of(std::size_t p, LocalIndex c, Word& next) {
    const Piece& piece = _mesh.pieces[p];
    const CellNeighbour* neighbours = _links.pieces[p].neighbours.data() + first_side(piece, c);
    const CellAtHand cell(piece, c);
    const CellFacts own = facts_of(p, c);
    const WorstCellOfShape here{0, _mesh.numbering.first_cell[p] + c, cell.shape(), {}};
    WorstFaces worst(here);
    std::array<Vec3, 4> storage;
    for (std::size_t side = 0; side < cell.face_count(); ++side) {
      const CellNeighbour& other = neighbours[side];
      if (other.exists() && std::tie(other.piece, other.cell) < std::tie(piece.id, c)) continue;
      const std::span<const Vec3> corners = cell.corners_at(side, storage);
      const FaceGeometry face = measure_face(corners);
      if (!other.exists()) {
        ++_rows[p].boundary_faces;
        const double skewness = skewness_at_boundary(face, corners, own.geometry.center);
        _rows[p].add_skewness(skewness);
        worst.meet(SolverMeasure::skewness, skewness, face.center);
        continue;
      }
      const CellFacts beyond = other.piece == piece.id ? facts_of(p, other.cell) : (next++)->what;
      const double skewness = skewness_inside(face, corners, own.geometry.center, beyond.geometry.center);
      const double cosine = cosine_at_face(face.area, own.geometry.center, beyond.geometry.center);
      const double fraction = volume_fraction(own.geometry.volume, beyond.geometry.volume);
      _rows[p].of_class[class_between(own, beyond)].add(cosine, fraction);
      _rows[p].add_skewness(skewness);
      worst.meet(SolverMeasure::skewness, skewness, face.center);
      worst.meet(SolverMeasure::non_orthogonality, cosine, face.center);
      worst.meet(SolverMeasure::volume_ratio, fraction, face.center);
    }
    for (const SolverMeasure measure :
         {SolverMeasure::non_orthogonality, SolverMeasure::skewness, SolverMeasure::volume_ratio}) {
      if (worst.has(measure)) keep(measure, worst.of(measure));
    }
  }

  /// The worst face of one cell by measure.
  class WorstFaces {
  public:
    explicit WorstFaces(const WorstCellOfShape& cell) { _of.fill(cell); }
    void meet(SolverMeasure measure, double value, Vec3 center) {
      const auto m = static_cast<std::size_t>(measure);
      WorstCellOfShape& worst = _of[m];
      if (_has[m] && (larger_is_kept(m) ? value <= worst.value : value >= worst.value)) return;
      _has[m] = true;
      worst.value = value;
      worst.center = center;
    }
    bool has(SolverMeasure measure) const { return _has[static_cast<std::size_t>(measure)]; }
    const WorstCellOfShape& of(SolverMeasure measure) const { return _of[static_cast<std::size_t>(measure)]; }

  private:
    std::array<WorstCellOfShape, solver_measure_count> _of;
    std::array<bool, solver_measure_count> _has{};
  };

  static std::size_t class_between(const CellFacts& a, const CellFacts& b) {
    const std::int64_t in_layers = a.in_layers + b.in_layers;
    return static_cast<std::size_t>(in_layers == 2   ? FaceClass::within_layers
                                    : in_layers == 1 ? FaceClass::at_front
                                                     : FaceClass::off_layers);
  }

  CellFacts facts_of(std::size_t p, LocalIndex c) const {
    const Piece& piece = _mesh.pieces[p];
    const bool in_layers = _layers_known
                               ? !piece.layers.empty() && piece.layers[static_cast<std::size_t>(c)] > 0
                               : c >= piece.cell_count();
    return {_cells[p][static_cast<std::size_t>(c)], in_layers ? 1 : 0};
  }

  void keep(SolverMeasure measure, const WorstCellOfShape& candidate) {
    const auto m = static_cast<std::size_t>(measure);
    std::vector<WorstCellOfShape>& kept = _worst[m];
    if (kept.size() == kept_per_solver_measure && !is_worse_place(m, candidate, kept.back())) return;
    kept.insert(std::upper_bound(kept.begin(), kept.end(), candidate,
                                 [m](const WorstCellOfShape& a, const WorstCellOfShape& b) {
                                   return is_worse_place(m, a, b);
                                 }),
                candidate);
    if (kept.size() > kept_per_solver_measure) kept.pop_back();
  }

  const NumberedMesh& _mesh;
  const FaceLinks& _links;
  bool _layers_known;
  std::vector<std::vector<CellGeometry>> _cells;  // by piece
  std::vector<PieceRow> _rows;
  std::array<std::vector<WorstCellOfShape>, solver_measure_count> _worst;
};

/// Of all ranks. Collective.
std::vector<WorstCellOfShape> worst_places(const parallel::Communicator& communicator, std::size_t measure,
                                           const std::vector<WorstCellOfShape>& mine) {
  auto all = communicator.all_gather_items(std::span<const WorstCellOfShape>(mine));
  std::sort(all.begin(), all.end(), [measure](const WorstCellOfShape& a, const WorstCellOfShape& b) {
    return is_worse_place(measure, a, b);
  });
  if (all.size() > kept_per_solver_measure) all.resize(kept_per_solver_measure);
  if (all_solver_measures[measure] == SolverMeasure::non_orthogonality) {
    for (WorstCellOfShape& place : all) place.value = degrees_of_cosine(place.value);
  }
  return all;
}

double mean_of(double sum, GlobalIndex count) {
  return sum / static_cast<double>(count);
}

FacesOfClass summarise(const ClassRow& row) {
  FacesOfClass result;
  if (row.faces == 0) return result;
  result.faces = row.faces;
  result.largest_non_orthogonality = degrees_of_cosine(row.least_cosine);
  result.average_non_orthogonality = degrees_of_cosine(mean_of(row.cosines, row.faces));
  result.non_orthogonal_faces = row.non_orthogonal;
  result.largest_volume_ratio =
      row.least_fraction * largest_ratio > 1 ? 1 / row.least_fraction : largest_ratio;
  result.high_volume_ratios = row.high_ratios, result.severe_volume_ratios = row.severe_ratios;
  return result;
}

SolverQuality summarise(const PieceRow& sum) {
  SolverQuality result;
  ClassRow all;
  for (std::size_t c = 0; c < face_class_count; ++c) {
    all.add(sum.of_class[c]);
    result.of_class[c] = summarise(sum.of_class[c]);
  }
  const FacesOfClass inner = summarise(all);
  result.cells = sum.cells, result.inner_faces = inner.faces, result.boundary_faces = sum.boundary_faces;
  result.largest_non_orthogonality = inner.largest_non_orthogonality;
  result.average_non_orthogonality = inner.average_non_orthogonality;
  result.non_orthogonal_faces = inner.non_orthogonal_faces;
  result.largest_skewness = sum.largest_skewness, result.skewed_faces = sum.skewed;
  result.largest_aspect_ratio = sum.largest_aspect_ratio, result.stretched_cells = sum.stretched;
  result.underdetermined_cells = sum.underdetermined;
  if (sum.cells > 0) {
    result.smallest_determinant = sum.least_determinant;
    result.mean_determinant = mean_of(sum.determinants, sum.cells);
  }
  if (all.faces > 0) {
    result.smallest_volume_ratio = all.least_fraction;
    result.mean_volume_ratio = mean_of(all.fractions, all.faces);
  }
  return result;
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
  judge.measure_cells();
  judge.measure_faces(tell_cells(mesh, judge.words()));
  PieceRow sum;
  for (const PieceRow& row : gather_by_piece(mesh, judge.rows())) sum.add(row);
  SolverQuality result = summarise(sum);
  for (std::size_t m = 0; m < solver_measure_count; ++m)
    result.worst[m] = worst_places(communicator, m, judge.worst(m));
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
