#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_text.hpp"
#include "cad/faceted/plane_graph.hpp"
#include "cad/model/model.hpp"
#include "geometry/input_file.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

using geometry::Vec2;
using geometry::Vec3;

enum class PolyKind { poly, smesh };

std::string node_file_of(const std::string& file) {
  return std::filesystem::path(file).replace_extension(".node").string();
}

/// One facet of .poly: polygons and segments of one plane, and points in its holes.
struct PolyFacet {
  std::vector<std::vector<std::int64_t>> polygons;
  std::vector<Vec3> holes;
};

class PolyText {
public:
  PolyText(const FacetFile& file, PolyKind kind) : _file(file), _text(file.name, file.bytes), _kind(kind) {}

  FacetSoup read() {
    _soup.format = _kind == PolyKind::poly ? "TetGen .poly" : "TetGen .smesh";
    _soup.filling = Filling::all;
    read_nodes(_text);
    need_line(_text, "the number of facets");
    const std::int64_t facets = _text.count(_text.word(), "the number of facets", 2);
    _has_markers = _text.word() == "1";
    for (std::int64_t i = 0; i < facets; ++i) {
      need_line(_text, "a facet");
      _kind == PolyKind::poly ? read_facet() : read_polygon_facet();
    }
    read_places();
    return std::move(_soup);
  }

private:
  static void need_line(FacetText& text, const char* what) {
    if (!text.next_line()) text.fail(fmt::format("the file ends where {} should stand", what));
  }

  /// The list of points, which may stand in a file of its own beside this one.
  void read_nodes(FacetText& text) {
    need_line(text, "the number of points");
    const std::int64_t count = text.count(text.word(), "the number of points", 8);
    if (count == 0 && &text == &_text) {
      const std::string beside = node_file_of(_file.name);
      if (!std::filesystem::exists(beside))
        text.fail(fmt::format("there are no points, here or in {}", beside));
      const FacetFile nodes = load_facet_file(beside);
      FacetText other(nodes.name, nodes.bytes);
      read_nodes(other);
      return;
    }
    if (const std::string_view dimension = text.word(); !dimension.empty() && dimension != "3")
      text.fail("points do not have three coordinates");
    for (std::int64_t i = 0; i < count; ++i) {
      need_line(text, "a point");
      const std::int64_t number = text.integer("the number of a point");
      if (i == 0) _first_number = number;
      if (number != _first_number + i || (i == 0 && number != 0 && number != 1))
        text.fail("points are not numbered one after the other, from 0 or 1");
      _soup.points.push_back(text.point());
    }
  }

  std::vector<std::int64_t> read_corners() {
    const std::int64_t count = _text.count(_text.any_word("a number of corners"), "a number of corners", 2);
    std::vector<std::int64_t> corners(count);
    for (std::int64_t& corner : corners) {
      corner = _text.any_integer("the number of a point") - _first_number;
      if (corner < 0 || corner >= static_cast<std::int64_t>(_soup.points.size()))
        _text.fail(fmt::format("there is no point {}", corner + _first_number));
    }
    return corners;
  }

  std::int32_t group_of_marker(std::string_view marker) {
    if (marker.empty() || marker == "0") return find_group(_soup, {});
    return find_group(_soup, {fmt::format("marker_{}", _text.to_integer(marker, "a boundary marker")), {}});
  }

  void read_facet() {
    const std::int64_t polygons = _text.count(_text.word(), "a number of polygons", 2);
    const std::string_view number_of_holes = _text.word();
    const std::int64_t holes =
        number_of_holes.empty() ? 0 : _text.count(number_of_holes, "a number of holes", 2);
    const std::int32_t group = group_of_marker(_has_markers ? _text.word() : std::string_view());
    PolyFacet facet;
    for (std::int64_t i = 0; i < polygons; ++i) {
      need_line(_text, "a polygon");
      facet.polygons.push_back(read_corners());
    }
    for (std::int64_t i = 0; i < holes; ++i) {
      need_line(_text, "a hole of a facet");
      _text.integer("the number of a hole");
      facet.holes.push_back(_text.point());
    }
    add_facet(facet, group);
  }

  void read_polygon_facet() {
    PolyFacet facet;
    facet.polygons.push_back(read_corners());
    add_facet(facet, group_of_marker(_has_markers ? _text.word() : std::string_view()));
  }

  void add_facet(const PolyFacet& facet, std::int32_t group) {
    if (facet.polygons.empty()) return;
    const std::vector<std::int64_t>& outline = facet.polygons.front();
    if (facet.polygons.size() == 1 && facet.holes.empty()) {
      if (outline.size() < 3) return;  // a point or a segment that no facet needs
      add_polygon(_soup, outline, group, [&](const std::string& what) { _text.fail(what); });
      return;
    }
    std::vector<Vec3> corners;
    for (const std::int64_t corner : outline) corners.push_back(_soup.points[corner]);
    const CoordinatePlane plane(polygon_area_vector(corners));
    PlaneGraph graph;
    std::vector<std::int32_t> numbers;  // of points of the soup
    std::vector<std::int32_t> place_of(_soup.points.size(), -1);
    for (const std::vector<std::int64_t>& polygon : facet.polygons) {
      std::vector<std::int32_t> loop;
      for (const std::int64_t corner : polygon) {
        if (place_of[corner] < 0) {
          place_of[corner] = static_cast<std::int32_t>(numbers.size());
          numbers.push_back(static_cast<std::int32_t>(corner));
          graph.places.push_back(plane(_soup.points[corner]));
        }
        loop.push_back(place_of[corner]);
      }
      if (loop.size() < 2) continue;
      const std::size_t sides = loop.size() == 2 ? 1 : loop.size();
      for (std::size_t i = 0; i < sides; ++i) graph.sides.push_back({loop[i], loop[(i + 1) % loop.size()]});
    }
    for (const Vec3 hole : facet.holes) graph.holes.push_back(plane(hole));
    const auto triangles = fill_plane_graph(graph);
    if (!triangles)
      _text.fail("the polygons of the facet that ends here cross, or run through each other's points");
    for (const auto& [a, b, c] : *triangles) {
      _soup.triangles.push_back({numbers[a], numbers[b], numbers[c]});
      _soup.group_of.push_back(group);
    }
  }

  /// Points in holes and in regions; both lists may be absent.
  void read_places() {
    if (!_text.next_line()) return;
    const std::int64_t holes = _text.count(_text.word(), "the number of holes", 2);
    for (std::int64_t i = 0; i < holes; ++i) {
      need_line(_text, "a hole");
      _text.integer("the number of a hole");
      _soup.holes.push_back(_text.point());
    }
    if (!_text.next_line()) return;
    const std::int64_t regions = _text.count(_text.word(), "the number of regions", 2);
    for (std::int64_t i = 0; i < regions; ++i) {
      need_line(_text, "a region");
      const std::string number(_text.word());
      const Vec3 point = _text.point();
      const std::string_view attribute = _text.word();
      _soup.regions.push_back({point, fmt::format("region_{}", attribute.empty() ? number : attribute)});
    }
  }

  const FacetFile& _file;
  FacetText _text;
  PolyKind _kind;
  bool _has_markers = false;
  std::int64_t _first_number = 0;
  FacetSoup _soup;
};

}  // namespace

std::optional<std::string> points_beside(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (!same_word(extension, ".poly") && !same_word(extension, ".smesh")) return std::nullopt;
  if (geometry::refusal_of(file)) return std::nullopt;
  // Comments may stand before the number. What is longer has points of its own, or says so too late.
  std::string head(std::size_t{1} << 16, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  FacetText text(file, head);
  if (text.next_line() && text.word() != "0") return std::nullopt;
  return node_file_of(file);
}

FacetSoup read_poly(const FacetFile& file) {
  return PolyText(file, PolyKind::poly).read();
}

FacetSoup read_smesh(const FacetFile& file) {
  return PolyText(file, PolyKind::smesh).read();
}

}  // namespace aeroloom::cad
