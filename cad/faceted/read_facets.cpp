#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_text.hpp"
#include "cad/faceted/plane_graph.hpp"
#include "cad/model/model.hpp"
#include "geometry/input_file.hpp"
#include "geometry/long_names.hpp"
#include "geometry/name_text.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

struct FacetFormat {
  const char* extension;
  FacetSoup (*read)(const FacetFile&);
};

constexpr FacetFormat facet_formats[] = {{".stl", read_stl}, {".obj", read_obj},   {".off", read_off},
                                         {".ply", read_ply}, {".poly", read_poly}, {".smesh", read_smesh}};

/// Files with more points are refused: numbers of corners are 32 bits wide.
constexpr std::size_t most_items = std::numeric_limits<std::int32_t>::max() / 8;

const FacetFormat* format_of(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  const auto* found = std::find_if(std::begin(facet_formats), std::end(facet_formats),
                                   [&](const FacetFormat& f) { return same_word(f.extension, extension); });
  return found == std::end(facet_formats) ? nullptr : found;
}

/// Cuts a polygon as it is seen along its area vector; one that crosses itself there is cut from its first
/// corner, and what is wrong with it shows later.
std::vector<geometry::TriangleCorners> cut_polygon(std::span<const geometry::Vec3> corners) {
  const auto count = static_cast<std::int32_t>(corners.size());
  const CoordinatePlane plane(polygon_area_vector(corners));
  std::vector<geometry::Vec2> places;
  std::vector<std::int32_t> loop(corners.size());
  for (std::int32_t i = 0; i < count; ++i) {
    places.push_back(plane(corners[i]));
    loop[i] = i;
  }
  if (auto ears = cut_ears(std::move(loop), places)) return std::move(*ears);
  std::vector<geometry::TriangleCorners> fan;
  for (std::int32_t i = 1; i + 1 < count; ++i) fan.push_back({0, i, i + 1});
  return fan;
}

void bound_names(FacetSoup& soup) {
  const auto bound = [&](std::string& name) { soup.cut_names += geometry::cut_long_name(name) ? 1 : 0; };
  for (FacetSoup::Group& group : soup.groups) bound(group.name), bound(group.part);
  for (FacetSoup::RegionPoint& region : soup.regions) bound(region.name);
}

void decode_names_of(FacetSoup& soup, const std::string& encoding) {
  std::vector<std::string*> names;
  for (FacetSoup::Group& group : soup.groups) names.insert(names.end(), {&group.name, &group.part});
  for (FacetSoup::RegionPoint& region : soup.regions) names.push_back(&region.name);
  std::vector<std::string> bytes;
  for (const std::string* name : names) bytes.push_back(*name);
  const std::vector<geometry::DecodedName> decoded = geometry::decode_names(bytes, encoding);
  std::set<std::string> said;
  for (std::size_t i = 0; i < names.size(); ++i) {
    *names[i] = decoded[i].text;
    if (!decoded[i].change.empty() && said.insert(decoded[i].change).second)
      soup.read_otherwise.push_back(decoded[i].change);
  }
}

}  // namespace

FacetFile load_facet_file(const std::string& name) {
  return {name, geometry::read_whole(name)};
}

std::int32_t find_group(FacetSoup& soup, const FacetSoup::Group& group) {
  const auto found = std::find(soup.groups.rbegin(), soup.groups.rend(), group);
  if (found != soup.groups.rend()) return static_cast<std::int32_t>(soup.groups.rend() - found) - 1;
  soup.groups.push_back(group);
  return static_cast<std::int32_t>(soup.groups.size()) - 1;
}

void add_polygon(FacetSoup& soup, std::span<const std::int64_t> corners, std::int32_t group,
                 const std::function<void(const std::string&)>& fail) {
  if (corners.size() < 3) fail(fmt::format("a polygon has {} corners", corners.size()));
  std::vector<geometry::Vec3> places;
  for (const std::int64_t corner : corners) {
    if (corner < 0 || corner >= static_cast<std::int64_t>(soup.points.size()))
      fail(fmt::format("a polygon has corner {}, counted from 0, of {} points", corner, soup.points.size()));
    places.push_back(soup.points[corner]);
  }
  const auto number = [&](std::int32_t i) { return static_cast<std::int32_t>(corners[i]); };
  const auto add = [&](const geometry::TriangleCorners& t) {
    soup.triangles.push_back({number(t[0]), number(t[1]), number(t[2])});
    soup.group_of.push_back(group);
  };
  if (corners.size() == 3) {
    add({0, 1, 2});
    return;
  }
  for (const geometry::TriangleCorners& t : cut_polygon(places)) add(t);
}

bool is_faceted_file(const std::string& file) {
  const FacetFormat* format = format_of(file);
  if (format == nullptr || geometry::refusal_of(file)) return false;
  std::ifstream stream(file, std::ios::binary);
  if (format->read != read_stl) return true;
  std::string head(1024, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return is_binary_stl(head) || begins_as_text_stl(head);
}

FacetSoup read_facets(const std::string& file, const std::string& encoding) {
  const FacetFormat* format = format_of(file);
  if (format == nullptr) {
    throw CadError(fmt::format(
        "{} is no faceted file: its name ends with none of .stl, .obj, .off, .ply, .poly, .smesh", file));
  }
  FacetSoup soup = format->read(load_facet_file(file));
  soup.file = file;
  bound_names(soup);
  bound_coordinates(soup);
  if (soup.points.size() > most_items || soup.triangles.size() > most_items)
    throw CadError(fmt::format("{} has more than {} points or triangles; coarsen it", file, most_items));
  if (soup.triangles.empty())
    throw CadError(fmt::format("{} has no triangles; export the surface of the body", file));
  decode_names_of(soup, encoding);
  return soup;
}

}  // namespace aeroloom::cad
