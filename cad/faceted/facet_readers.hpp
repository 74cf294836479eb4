/// Readers of the single file formats. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

namespace aeroloom::cad {

/// A file in memory.
struct FacetFile {
  std::string name, bytes;
};

FacetFile load_facet_file(const std::string& name);

FacetSoup read_stl(const FacetFile& file);
FacetSoup read_obj(const FacetFile& file);
FacetSoup read_off(const FacetFile& file);
FacetSoup read_ply(const FacetFile& file);
FacetSoup read_poly(const FacetFile& file);   ///< TetGen's .poly
FacetSoup read_smesh(const FacetFile& file);  ///< TetGen's .smesh

/// Whether the content of an .stl file is binary.
bool is_binary_stl(std::string_view bytes);
/// Whether it begins as text does: with `solid`, after blanks and a byte-order mark.
bool begins_as_text_stl(std::string_view bytes);

/// The number of the group, which is added if it does not exist.
std::int32_t find_group(FacetSoup& soup, const FacetSoup::Group& group);

/// Triangulates a polygon and adds the triangles. `fail` is called with a message if the polygon is invalid.
void add_polygon(FacetSoup& soup, std::span<const std::int64_t> corners, std::int32_t group,
                 const std::function<void(const std::string&)>& fail);

}  // namespace aeroloom::cad
