#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_text.hpp"
#include "geometry/input_file.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

constexpr std::size_t stl_head = 84, stl_record = 50;

std::uint32_t little_word(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

void close_triangles(FacetSoup& soup, std::int32_t group) {
  const auto count = static_cast<std::int32_t>(soup.points.size() / 3);
  for (auto t = static_cast<std::int32_t>(soup.triangles.size()); t < count; ++t) {
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
    soup.group_of.push_back(group);
  }
}

FacetSoup read_binary_stl(const FacetFile& file) {
  FacetSoup soup;
  soup.format = "STL (binary)";
  soup.groups.emplace_back();
  const std::size_t count = little_word(file.bytes.data() + stl_head - 4);
  if (count > (file.bytes.size() - stl_head) / stl_record) {
    refuse_facets(file.name, fmt::format("byte {}", file.bytes.size()),
                  fmt::format("the file ends within its {} triangles", count));
  }
  if (const std::size_t rest = file.bytes.size() - stl_head - count * stl_record; rest > 0) {
    refuse_facets(
        file.name, fmt::format("byte {}", file.bytes.size() - rest),
        fmt::format("the file says that it has {} triangles, but {} bytes follow them", count, rest));
  }
  soup.points.reserve(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t place = stl_head + t * stl_record + 12;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto coordinate = [&](std::size_t k) {
        const std::size_t at = place + 12 * c + 4 * k;
        const auto value = std::bit_cast<float>(little_word(file.bytes.data() + at));
        if (!std::isfinite(value))
          refuse_facets(file.name, fmt::format("byte {}", at), "a coordinate is no finite number");
        return static_cast<double>(value);
      };
      soup.points.push_back({coordinate(0), coordinate(1), coordinate(2)});
    }
  }
  close_triangles(soup, 0);
  return soup;
}

/// What stands between `solid` and `endsolid`.
class StlText {
public:
  explicit StlText(const FacetFile& file) : _text(file.name, file.bytes) {}

  FacetSoup read() {
    _soup.format = "STL (ASCII)";
    while (_text.next_line()) {
      expect("solid", _text.word());
      read_solid(std::string(_text.rest()));
    }
    return std::move(_soup);
  }

private:
  void expect(std::string_view wanted, std::string_view found) {
    if (!same_word(wanted, found)) _text.fail(fmt::format("'{}' is missing", wanted));
  }

  void read_solid(const std::string& name) {
    const std::int32_t group = find_group(_soup, {name, {}});
    for (;;) {
      const std::string_view word = _text.any_word("'endsolid'");
      if (same_word(word, "endsolid")) {
        _text.rest();
        break;
      }
      expect("facet", word);
      expect("normal", _text.any_word("'normal'"));
      // Some programs write "nan" where a triangle has no area.
      for (int i = 0; i < 3; ++i) _text.any_word("a normal");
      expect("outer", _text.any_word("'outer'"));
      expect("loop", _text.any_word("'loop'"));
      for (int i = 0; i < 3; ++i) read_corner();
      expect("endloop", _text.any_word("'endloop'"));
      expect("endfacet", _text.any_word("'endfacet'"));
      close_triangles(_soup, group);
    }
  }

  void read_corner() {
    expect("vertex", _text.any_word("'vertex'"));
    const double x = _text.any_number("a coordinate"), y = _text.any_number("a coordinate");
    _soup.points.push_back({x, y, _text.any_number("a coordinate")});
  }

  FacetText _text;
  FacetSoup _soup;
};

}  // namespace

bool begins_as_text_stl(std::string_view bytes) {
  bytes.remove_prefix(geometry::mark_length(bytes));
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \n\r\t"), bytes.size()));
  return same_word(bytes.substr(0, 5), "solid");
}

bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < stl_head) return false;
  const std::size_t count = little_word(bytes.data() + stl_head - 4);
  if (bytes.size() == stl_head + stl_record * count) return true;
  if (!begins_as_text_stl(bytes)) return true;
  // Zeros and other control characters stand in no text.
  for (const char c : bytes.substr(0, 1024)) {
    if (static_cast<unsigned char>(c) < ' ' && std::strchr("\n\r\t\v\f", c) == nullptr) return true;
    if (c == 0) return true;
  }
  return false;
}

FacetSoup read_stl(const FacetFile& file) {
  if (is_binary_stl(file.bytes)) return read_binary_stl(file);
  if (file.bytes.size() < stl_head && !begins_as_text_stl(file.bytes)) {
    refuse_facets(file.name, fmt::format("byte {}", file.bytes.size()), "the file ends before its head does");
  }
  return StlText(file).read();
}

}  // namespace aeroloom::cad
