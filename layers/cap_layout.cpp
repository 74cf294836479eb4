#include "layers/cap_layout.hpp"

namespace aeroloom::layers {
namespace {

using mesh::LocalIndex;

class LayoutMaker {
public:
  LayoutMaker(const mesh::Piece& wall, const PieceColumns& columns) : _wall(wall), _columns(columns) {}

  CapLayout make() {
    place_columns();
    for (LocalIndex t = 0; t < _wall.cell_count(); ++t) {
      const auto& corners = _columns.corner_columns[t];
      _layout.triangles.push_back({at(corners[0]), at(corners[1]), at(corners[2])});
    }
    _layout.apex_of_face.assign(_columns.fan_faces.size(), -1);
    for (std::size_t f = 0; f < _columns.fan_faces.size(); ++f) cover(static_cast<std::int32_t>(f));
    for (const RimTriangle& rim : _columns.rims) {
      if (_columns.counts[_columns.vertex_of(rim.columns[0])] == 0) continue;
      add({at(rim.columns[0]), at(rim.columns[1]), at(rim.columns[2])}, -1);
    }
    _layout.vertex_count = static_cast<LocalIndex>(_layout.column_of_vertex.size());
    return std::move(_layout);
  }

private:
  LocalIndex at(std::int32_t column) const { return _layout.vertex_of_column[column]; }
  std::int32_t count_of(std::int32_t column) const { return _columns.counts[_columns.vertex_of(column)]; }

  void place_columns() {
    std::vector<std::uint8_t> used(_columns.column_count(), 0);
    for (const auto& corners : _columns.corner_columns) {
      for (const std::int32_t column : corners) used[column] = 1;
    }
    for (const FanFace& face : _columns.fan_faces) {
      for (const std::int32_t column : face.columns) {
        if (column >= 0) used[column] = 1;
      }
    }
    for (const RimTriangle& rim : _columns.rims) {
      for (const std::int32_t column : rim.columns) used[column] = 1;
    }
    _layout.vertex_of_column.assign(_columns.column_count(), -1);
    _layout.column_of_vertex.assign(_wall.vertex_count(), -1);
    for (LocalIndex v = 0; v < _wall.vertex_count(); ++v) {
      bool taken = false;
      for (std::int32_t c = _columns.first_column[v]; c < _columns.first_column[v + 1]; ++c) {
        if (!used[c] && _columns.columns_at(v) > 1) continue;
        if (!taken || _columns.counts[v] == 0) {
          if (!taken) _layout.column_of_vertex[v] = c;
          _layout.vertex_of_column[c] = v;
          taken = true;
          continue;
        }
        _layout.vertex_of_column[c] = static_cast<LocalIndex>(_layout.column_of_vertex.size());
        _layout.column_of_vertex.push_back(c);
      }
    }
  }

  /// Corners counter-clockwise seen from the fluid; the wall's are the other way round.
  void add(std::array<LocalIndex, 3> corners, std::int32_t origin) {
    _layout.triangles.push_back({corners[0], corners[2], corners[1]});
    _layout.origins.push_back(origin);
  }

  void cover(std::int32_t f) {
    const FanFace& face = _columns.fan_faces[f];
    const bool first = count_of(face.columns[0]) > 0;
    const auto corner = [&](int i) { return at(face.columns[i]); };
    if (!face.is_sector()) {
      if (first) add({corner(0), corner(1), corner(2)}, f);
      return;
    }
    const bool second = count_of(face.columns[2]) > 0;
    if (!first && !second) return;
    if (!second) return add({corner(0), corner(1), corner(2)}, f);
    if (!first) return add({corner(0), corner(2), corner(3)}, f);
    const auto apex = static_cast<LocalIndex>(_layout.column_of_vertex.size());
    _layout.column_of_vertex.push_back(-1);
    _layout.apex_of_face[f] = apex;
    for (int i = 0; i < 4; ++i) add({corner(i), corner((i + 1) % 4), apex}, f);
  }

  const mesh::Piece& _wall;
  const PieceColumns& _columns;
  CapLayout _layout;
};

}  // namespace

CapLayout lay_out_cap(const mesh::Piece& wall, const PieceColumns& columns) {
  return LayoutMaker(wall, columns).make();
}

}  // namespace aeroloom::layers
