#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_text.hpp"

#include <vector>

#include <fmt/format.h>

namespace aeroloom::cad {

FacetSoup read_off(const FacetFile& file) {
  FacetText text(file.name, file.bytes);
  FacetSoup soup;
  soup.format = "OFF";
  soup.groups.emplace_back();
  text.next_line();
  const std::string_view head = text.word();
  if (head.size() < 3 || !same_word(head.substr(head.size() - 3), "OFF"))
    text.fail("the file does not begin with 'OFF'");
  const std::string_view kind = head.substr(0, head.size() - 3);
  if (kind.find_first_not_of("STCN") != std::string_view::npos)
    text.fail(fmt::format("points of '{}OFF' have more than three coordinates", kind));

  std::string_view first = text.word();
  if (same_word(first, "BINARY")) text.fail("binary OFF files are not read; write the file as text");
  if (first.empty()) first = text.any_word("the number of points");
  const std::int64_t points = text.count(first, "the number of points", 6);
  const std::int64_t polygons = text.count(text.word(), "the number of polygons", 2);
  soup.points.reserve(points);
  for (std::int64_t i = 0; i < points; ++i) {
    if (!text.next_line()) text.fail(fmt::format("the file ends within its {} points", points));
    soup.points.push_back(text.point());  // normals and colours follow
  }
  std::vector<std::int64_t> corners;
  for (std::int64_t i = 0; i < polygons; ++i) {
    if (!text.next_line()) text.fail(fmt::format("the file ends within its {} polygons", polygons));
    const std::int64_t count = text.count(text.word(), "a number of corners", 2);
    corners.clear();
    for (std::int64_t k = 0; k < count; ++k) corners.push_back(text.integer("the number of a point"));
    add_polygon(soup, corners, 0, [&](const std::string& what) { text.fail(what); });
  }
  return soup;
}

}  // namespace aeroloom::cad
