/// The readers of single formats. Seen by this folder only.
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

/// Whether an .stl is a binary one.
bool is_binary_stl(std::string_view bytes);

/// The group with these names, made where there is none yet. The last ones are looked at first.
std::int32_t find_group(FacetSoup& soup, const FacetSoup::Group& group);

/// Adds a polygon as triangles. `fail` is told what is wrong with it.
void add_polygon(FacetSoup& soup, std::span<const std::int64_t> corners, std::int32_t group,
                 const std::function<void(const std::string&)>& fail);

}  // namespace aeroloom::cad
