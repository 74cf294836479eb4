/// Small polyhedron reconnection: finds the best tetrahedralisation of a polyhedron around a bad tetrahedron
/// with the same vertices (Liu, Baida and Shang, Finite Elements in Analysis and Design 42, 2006; Chen,
/// Zheng, Zhao et al., Int. J. Numer. Meth. Engng 92, 2012, doi:10.1002/nme.4316).
#pragma once

#include "improve/operations/operation.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::improve {

class SmallPolyhedron final : public LocalOperation {
public:
  static constexpr int most_vertices = 12;  // chosen, not measured
  static constexpr int most_tets = 24;      // chosen, not measured
  static constexpr int most_steps = 300;    ///< of the search; chosen, not measured

  bool improve(OperationContext& context, LocalIndex t) override;
  /// Grows a polyhedron around a tetrahedron, first by neighbours that add no vertex, and proposes a new
  /// tetrahedralisation. Its faces stay; a free vertex inside may vanish. False if nothing beats both the
  /// polyhedron and `floor`.
  bool propose(const TetMesh& mesh, LocalIndex t, double floor, CavityReplacement& cavity);

private:
  using Local = std::int8_t;  ///< number of a vertex in the polyhedron
  using Face = std::array<Local, 3>;

  struct Apex {
    double quality;
    int closes;  ///< number of front faces it closes
    Local vertex;
  };

  void grow(const TetMesh& mesh, LocalIndex t);
  bool open_front(const TetMesh& mesh);
  Local number(LocalIndex v) const;
  void search(const TetMesh& mesh, double worst);
  bool choose_face(const TetMesh& mesh, Face& face, std::vector<Apex>& apexes);
  void list_apexes(const TetMesh& mesh, const Face& face, std::vector<Apex>& apexes);
  double quality(const TetMesh& mesh, const Face& base, Local apex);
  void open(const Face& face);
  void close(const Face& face);
  static int key(const Face& face);
  /// The faces added to the front by a tetrahedron on one of its faces, unless their opposite sides are
  /// there.
  static std::array<Face, 3> sides_of(const Face& base, Local apex) {
    return {{{base[0], base[1], apex}, {base[1], base[2], apex}, {base[2], base[0], apex}}};
  }

  std::vector<LocalIndex> _vertices;  ///< of the polyhedron, ascending
  std::vector<LocalIndex> _tets;
  std::vector<Face>
      _front;  ///< the advancing front: faces of the unfilled part, counter-clockwise seen from outside of it
  /// Per oriented face, lowest vertex first: whether it is in the front.
  std::array<std::int8_t, most_vertices * most_vertices * most_vertices> _open{};
  /// Quality of the positive tetrahedron of four ascending vertices. Negative if it needs an odd order; 2 if
  /// not yet known.
  std::array<double, most_vertices * most_vertices * most_vertices * most_vertices> _qualities;
  std::vector<Apex> _trial;
  std::vector<std::array<Local, 4>> _filling, _best_filling;
  double _best = 0;
  int _steps = 0;
  CavityReplacement _change;
};

}  // namespace aeroloom::improve
