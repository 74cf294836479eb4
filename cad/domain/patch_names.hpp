/// Names of patches that the program makes, and that files and cases give: none takes the faces of another.
/// Internal to cad/.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/model/model_data.hpp"
#include "cad/repair/change.hpp"

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::cad {

/// Names of the patches between two regions: "interface_A_B" with the names of both, or their numbers where
/// they have none. All are different.
class InterfaceNames {
public:
  /// A region without a name has an empty one, or "region_" and its number.
  explicit InterfaceNames(std::vector<std::string> regions);
  /// In either order.
  std::string operator()(int region, int other);

private:
  std::vector<std::string> _regions;
  std::map<std::pair<int, int>, std::string> _known;
  std::set<std::string> _used;
};

/// Faces that close openings go to the patch of the wall around them: the one with most of the border.
void join_caps(const NamedShape& named, std::vector<FaceTag>& tags, Changes& changes);
/// The same for triangles. `tags` are those of the faces of the complex alone.
void join_caps(const FacetComplex& complex, std::vector<FaceTag>& tags, Changes& changes);

/// Gives each patch a name that no patch of another origin has. A name stays with the first of: the far field
/// and the plane of symmetry that the program adds, the file, faces without a name, parts of the case.
void separate_patches(std::vector<FaceTag>& tags, Changes& changes);

}  // namespace aeroloom::cad
