#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_text.hpp"
#include "cad/model/model.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

enum class PlyEncoding { text, little, big };

struct PlyType {
  int bytes = 0;
  bool is_signed = false, is_real = false;
};

struct PlyProperty {
  std::string name;
  std::optional<PlyType> list_count;  ///< of lists
  PlyType type;
};

struct PlyElement {
  std::string name;
  std::int64_t count = 0;
  std::vector<PlyProperty> properties;

  std::int64_t least_bytes(PlyEncoding encoding) const {
    std::int64_t sum = 0;
    for (const PlyProperty& p : properties)
      sum += encoding == PlyEncoding::text ? 2 : (p.list_count ? p.list_count->bytes : p.type.bytes);
    return std::max<std::int64_t>(sum, 1);
  }
};

struct PlyTypeName {
  const char* name;
  PlyType type;
};

constexpr PlyTypeName ply_types[] = {
    {"char", {1, true, false}},    {"int8", {1, true, false}},    {"uchar", {1, false, false}},
    {"uint8", {1, false, false}},  {"short", {2, true, false}},   {"int16", {2, true, false}},
    {"ushort", {2, false, false}}, {"uint16", {2, false, false}}, {"int", {4, true, false}},
    {"int32", {4, true, false}},   {"uint", {4, false, false}},   {"uint32", {4, false, false}},
    {"float", {4, true, true}},    {"float32", {4, true, true}},  {"double", {8, true, true}},
    {"float64", {8, true, true}}};

/// The values behind the head, as text or bytes.
class PlyValues {
public:
  PlyValues(const FacetFile& file, PlyEncoding encoding, std::size_t begin, std::int64_t head_lines)
      : _file(file),
        _encoding(encoding),
        _at(begin),
        _head_lines(head_lines),
        _text(file.name, std::string_view(file.bytes).substr(begin)) {}

  double next(PlyType type) {
    if (_encoding == PlyEncoding::text) {
      const std::string_view word = _text.any_word("a value");
      // Properties that are not read may be "nan".
      if (same_word(word, "nan") || same_word(word, "-nan")) return std::nan("");
      return _text.to_number(word, "a number");
    }
    const auto size = static_cast<std::size_t>(type.bytes);
    if (_file.bytes.size() - _at < size) fail("the file ends where a value should stand");
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t place = _encoding == PlyEncoding::little ? _at + size - 1 - i : _at + i;
      bits = bits << 8 | static_cast<unsigned char>(_file.bytes[place]);
    }
    _at += size;
    if (type.is_real) {
      return size == 8 ? std::bit_cast<double>(bits)
                       : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    }
    const int unused = 64 - 8 * type.bytes;
    if (type.is_signed) return static_cast<double>(static_cast<std::int64_t>(bits << unused) >> unused);
    return static_cast<double>(bits);
  }

  double coordinate(PlyType type) {
    const double value = next(type);
    if (!std::isfinite(value)) fail("a coordinate is no finite number");
    return value;
  }

  std::int64_t integer(PlyType type) {
    const double value = next(type);
    if (!(std::abs(value) < 1e15) || value != std::floor(value)) fail("a number of a point is no integer");
    return static_cast<std::int64_t>(value);
  }

  /// The length of a list: no more than the file has room for.
  std::int64_t length(PlyType type) {
    const std::int64_t value = integer(type);
    if (value < 0 || value > static_cast<std::int64_t>(_file.bytes.size()))
      fail(fmt::format("a list has {} items, more than the file has room for", value));
    return value;
  }

  /// A binary file ends with its last value.
  void require_end() const {
    if (_encoding == PlyEncoding::text || _at == _file.bytes.size()) return;
    fail(fmt::format("the elements of the file end here, but {} bytes follow", _file.bytes.size() - _at));
  }

  [[noreturn]] void fail(const std::string& what) const {
    refuse_facets(_file.name,
                  _encoding == PlyEncoding::text ? fmt::format("line {}", _head_lines + _text.line())
                                                 : fmt::format("byte {}", _at),
                  what);
  }

private:
  const FacetFile& _file;
  PlyEncoding _encoding;
  std::size_t _at;
  std::int64_t _head_lines;
  FacetText _text;
};

/// The lines up to `end_header`.
class PlyHead {
public:
  explicit PlyHead(const FacetFile& file) : _file(file) { read(); }

  PlyEncoding encoding = PlyEncoding::text;
  std::vector<PlyElement> elements;
  std::size_t end = 0;  ///< byte behind the head
  std::int64_t lines = 0;

private:
  void read() {
    bool has_format = false;
    for (;;) {
      const std::size_t stop = _file.bytes.find('\n', end);
      if (stop == std::string::npos) fail("the head of the file has no 'end_header'");
      FacetText line(_file.name, std::string_view(_file.bytes).substr(end, stop - end));
      end = stop + 1;
      ++lines;
      if (!line.next_line()) continue;
      const std::string_view word = line.word();
      if (lines == 1 && word != "ply") fail("the file does not begin with 'ply'");
      if (word == "end_header") break;
      if (word == "format") {
        read_format(line);
        has_format = true;
      } else if (word == "element") {
        const std::string name(line.word());
        elements.push_back({name, line.to_integer(line.word(), "a number of elements"), {}});
      } else if (word == "property") {
        read_property(line);
      }
    }
    if (!has_format) fail("the head of the file has no 'format'");
    for (const PlyElement& element : elements) {
      const auto room = static_cast<std::int64_t>(_file.bytes.size() - end);
      if (element.count < 0 || element.count > room / element.least_bytes(encoding) + 1)
        fail(fmt::format("{} '{}' are more than the file has room for", element.count, element.name));
    }
  }

  void read_format(FacetText& line) {
    const std::string_view name = line.word();
    if (name == "ascii") {
      encoding = PlyEncoding::text;
    } else if (name == "binary_little_endian") {
      encoding = PlyEncoding::little;
    } else if (name == "binary_big_endian") {
      encoding = PlyEncoding::big;
    } else {
      fail("the format is none of ascii, binary_little_endian, binary_big_endian");
    }
  }

  void read_property(FacetText& line) {
    if (elements.empty()) fail("a property stands before the first element");
    PlyProperty property;
    std::string_view word = line.word();
    if (word == "list") {
      property.list_count = type_of(line.word());
      word = line.word();
    }
    property.type = type_of(word);
    property.name = line.word();
    elements.back().properties.push_back(property);
  }

  PlyType type_of(std::string_view name) const {
    const auto* found = std::find_if(std::begin(ply_types), std::end(ply_types),
                                     [&](const auto& t) { return t.name == name; });
    if (found == std::end(ply_types)) fail("a property has a type that PLY does not know");
    return found->type;
  }

  [[noreturn]] void fail(const std::string& what) const {
    refuse_facets(_file.name, fmt::format("line {}", std::max<std::int64_t>(lines, 1)), what);
  }

  const FacetFile& _file;
};

void read_ply_point(const PlyElement& element, PlyValues& values, FacetSoup& soup) {
  geometry::Vec3 point;
  int found = 0;
  for (const PlyProperty& property : element.properties) {
    const std::int64_t items = property.list_count ? values.length(*property.list_count) : 1;
    const int axis = property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
    if (axis >= 0 && !property.list_count) {
      point[axis] = values.coordinate(property.type);
      ++found;
      continue;
    }
    for (std::int64_t i = 0; i < items; ++i) values.next(property.type);
  }
  if (found != 3) values.fail("points have no coordinates x, y and z");
  soup.points.push_back(point);
}

void read_ply_face(const PlyElement& element, PlyValues& values, FacetSoup& soup,
                   std::vector<std::int64_t>& corners) {
  corners.clear();
  for (const PlyProperty& property : element.properties) {
    const bool wanted = property.list_count && property.name.starts_with("vertex_ind");
    const std::int64_t items = property.list_count ? values.length(*property.list_count) : 1;
    for (std::int64_t i = 0; i < items; ++i) {
      if (wanted) {
        corners.push_back(values.integer(property.type));
      } else {
        values.next(property.type);
      }
    }
  }
  add_polygon(soup, corners, 0, [&](const std::string& what) { values.fail(what); });
}

}  // namespace

FacetSoup read_ply(const FacetFile& file) {
  const PlyHead head(file);
  FacetSoup soup;
  soup.format = head.encoding == PlyEncoding::text ? "PLY (ASCII)" : "PLY (binary)";
  soup.groups.emplace_back();
  PlyValues values(file, head.encoding, head.end, head.lines);
  std::vector<std::int64_t> corners;
  for (const PlyElement& element : head.elements) {
    for (std::int64_t i = 0; i < element.count; ++i) {
      if (element.name == "vertex") {
        read_ply_point(element, values, soup);
      } else if (element.name == "face") {
        read_ply_face(element, values, soup, corners);
      } else if (element.name == "tristrips") {
        values.fail("strips of triangles are not read; write single triangles");
      } else {
        for (const PlyProperty& property : element.properties) {
          const std::int64_t items = property.list_count ? values.length(*property.list_count) : 1;
          for (std::int64_t k = 0; k < items; ++k) values.next(property.type);
        }
      }
    }
  }
  values.require_end();
  return soup;
}

}  // namespace aeroloom::cad
