#include "mesh/checks/triangle_contact.hpp"

#include "geometry/triangle_contact.hpp"

namespace aeroloom::mesh {

bool meet_wrongly(const NamedTriangle& a, const NamedTriangle& b) {
  geometry::CommonCorners common;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (common.count < 3 && a.names[i] == b.names[j]) {
        common.first[common.count] = i;
        common.second[common.count++] = j;
      }
    }
  }
  return geometry::meet_wrongly(a.points, b.points, common);
}

}  // namespace aeroloom::mesh
