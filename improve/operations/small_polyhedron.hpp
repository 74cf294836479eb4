/// Small polyhedron reconnection: the best tetrahedra of all that fill the polyhedron around a bad one with
/// the same vertices (Liu, Baida and Shang, Finite Elements in Analysis and Design 42, 2006; Chen, Zheng,
/// Zhao et al., Int. J. Numer. Meth. Engng 92, 2012, doi:10.1002/nme.4316).
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
  static constexpr int most_steps = 300;    ///< of the search, which gives up then; chosen, not measured

  bool improve(OperationContext& context, LocalIndex t) override;
  /// Grows a polyhedron around a tetrahedron, neighbours that add no vertex first, and proposes to fill it
  /// anew. Its faces stay; a vertex inside may vanish if it is free. False when nothing beats both the
  /// polyhedron as it is and `floor`.
  bool propose(const TetMesh& mesh, LocalIndex t, double floor, CavityReplacement& cavity);

private:
  using Local = std::int8_t;  ///< number of a vertex in the polyhedron
  using Face = std::array<Local, 3>;

  struct Apex {
    double quality;
    int closes;  ///< faces of the front
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
  /// The faces that the front gets when a tetrahedron is put on one of its faces, where it does not have them
  /// already from the other side.
  static std::array<Face, 3> sides_of(const Face& base, Local apex) {
    return {{{base[0], base[1], apex}, {base[1], base[2], apex}, {base[2], base[0], apex}}};
  }

  std::vector<LocalIndex> _vertices;  ///< of the polyhedron, ascending
  std::vector<LocalIndex> _tets;
  std::vector<Face> _front;  ///< what is not filled yet, counter-clockwise seen from its outside
  /// Per oriented face, its lowest vertex first: whether it is in the front.
  std::array<std::int8_t, most_vertices * most_vertices * most_vertices> _open{};
  /// Per four vertices, ascending: quality of the positive tetrahedron, negative where it needs an odd order;
  /// 2 when not computed yet.
  std::array<double, most_vertices * most_vertices * most_vertices * most_vertices> _qualities;
  std::vector<Apex> _trial;
  std::vector<std::array<Local, 4>> _filling, _best_filling;
  double _best = 0;
  int _steps = 0;
  CavityReplacement _change;
};

}  // namespace aeroloom::improve
