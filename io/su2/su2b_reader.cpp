#include "io/streams/range_reader.hpp"
#include "io/su2/su2_elements.hpp"
#include "io/su2/su2_markers.hpp"
#include "io/su2/su2_reader.hpp"
#include "io/su2/su2b_layout.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

/// Elements and points read at a time.
constexpr std::int64_t records_at_once = 1 << 15;

/// Reads a file with integers of one width.
template <class Integer>
class Su2bReader {
public:
  explicit Su2bReader(RangeReader& file) : _file(file) {}

  void read(RawMesh& raw) {
    read_zone();
    const Elements cells = find_elements(first_section, "cells");
    _points = count_at(cells.end, "points", 24 + width);
    read_elements(cells, raw.file.local_range(cells.count), -1, raw);
    read_points(cells.end + width, raw);
    read_markers(cells.end + width + _points * (24 + width), raw);
  }

private:
  static constexpr std::int64_t width = sizeof(Integer);
  static constexpr std::int64_t first_section = 16;

  /// Places of a section, held against the size of the file.
  struct Elements {
    std::int64_t count, places, connectivity, integers, end;
  };

  void read_zone() {
    const auto zones = _file.value<std::int32_t>(4);
    if (zones != 1)
      _file.fail(4, fmt::format("the file has {} zones; only files of one zone are supported", zones));
    const auto dimensions = _file.value<std::int32_t>(12);
    if (dimensions != 3)
      _file.fail(12, fmt::format("a mesh of {} dimensions; only three are supported", dimensions));
  }

  /// A count of things of `bytes` each that stand behind it.
  std::int64_t count_at(std::int64_t offset, const char* what, std::int64_t bytes) {
    const auto count = static_cast<std::uint64_t>(_file.value<Integer>(offset));
    if (count > static_cast<std::uint64_t>(_file.bytes_from(offset + width) / bytes))
      _file.fail(offset, fmt::format("{} {} do not fit a file of {} bytes", count, what, _file.size()));
    return static_cast<std::int64_t>(count);
  }

  Elements find_elements(std::int64_t offset, const char* what) {
    Elements elements{};
    elements.count = count_at(offset, what, width);
    elements.places = offset + width;
    const std::int64_t length_at = elements.places + elements.count * width;
    elements.integers = count_at(length_at, "integers of connectivity", width);
    elements.connectivity = length_at + width;
    elements.end = elements.connectivity + elements.integers * width;
    return elements;
  }

  void read_points(std::int64_t section, RawMesh& raw) {
    const LocalRange range = raw.file.local_range(_points);
    constexpr std::int64_t stride = 24 + width;
    raw.coordinates.reserve(3 * static_cast<std::size_t>(range.count()));
    raw.point_ids.reserve(static_cast<std::size_t>(range.count()));
    std::vector<std::byte> chunk;
    for (std::int64_t begin = range.begin; begin < range.end; begin += records_at_once) {
      const std::int64_t end = std::min(begin + records_at_once, range.end);
      chunk.resize(static_cast<std::size_t>((end - begin) * stride));
      _file.read_bytes(section + begin * stride, chunk);
      for (std::int64_t i = begin; i < end; ++i) {
        for (int k = 0; k < 3; ++k) {
          const auto value = _file.decoded<double>(chunk.data() + (i - begin) * stride + 8 * k);
          if (!std::isfinite(value))
            _file.fail(section + i * stride + 8 * k, fmt::format("a coordinate of point {} is no number", i));
          raw.coordinates.push_back(value);
        }
        raw.point_ids.push_back(i);
      }
    }
  }

  void read_markers(std::int64_t offset, RawMesh& raw) {
    const auto count = _file.value<std::int32_t>(offset);
    if (count < 0 || count > _file.bytes_from(offset) / (su2b_name_bytes + 2 * width))
      _file.fail(offset, fmt::format("{} markers do not fit a file of {} bytes", count, _file.size()));
    struct Marker {
      Elements faces;
      std::int32_t patch;
    };
    std::vector<Marker> markers;
    std::int64_t at = offset + 4, total = 0;
    std::map<std::string, std::int32_t> patch_of;
    for (std::int32_t marker = 0; marker < count; ++marker) {
      std::array<char, su2b_name_bytes + 1> name{};
      _file.read(at, std::span<char>(name.data(), su2b_name_bytes));
      const Elements faces = find_elements(at + su2b_name_bytes, "faces of a marker");
      at = faces.end;
      const std::string_view text(name.data());
      if (text == "SEND_RECEIVE") continue;
      const std::string tag = text.empty() ? fmt::format("marker_{}", marker + 1) : std::string(text);
      const auto [found, is_new] = patch_of.try_emplace(tag, static_cast<std::int32_t>(raw.patches.size()));
      if (is_new) raw.patches.push_back({tag, mesh::PatchType::wall});
      markers.push_back({faces, found->second});
      total += faces.count;
    }
    if (at != _file.size()) {
      _file.fail(at, fmt::format("the counts of the file end here, but {} bytes follow; it is damaged",
                                 _file.bytes_from(at)));
    }
    // One range of all faces: the ranges of the ranks, one after another, have the order of the file.
    const LocalRange range = raw.file.local_range(total);
    std::int64_t before = 0;
    for (const Marker& marker : markers) {
      const auto inside = [&](std::int64_t i) {
        return std::clamp(i - before, std::int64_t{0}, marker.faces.count);
      };
      read_elements(marker.faces, {inside(range.begin), inside(range.end)}, marker.patch, raw);
      before += marker.faces.count;
    }
  }

  /// Elements of a patch, -1: of the volume.
  void read_elements(const Elements& section, LocalRange range, std::int32_t patch, RawMesh& raw) {
    std::vector<Integer> places, integers;
    for (std::int64_t begin = range.begin; begin < range.end; begin += records_at_once) {
      const std::int64_t end = std::min(begin + records_at_once, range.end);
      places.resize(static_cast<std::size_t>(end - begin + 1));
      const std::int64_t places_at = section.places + begin * width;
      _file.read(places_at, std::span<Integer>(places));
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] > static_cast<Integer>(section.integers) || (i > 0 && places[i] < places[i - 1]))
          _file.fail(places_at + static_cast<std::int64_t>(i) * width,
                     fmt::format("place {} in a connectivity of {} integers is out of turn", places[i],
                                 section.integers));
      }
      integers.resize(static_cast<std::size_t>(places.back() - places.front()));
      const std::int64_t first_at = section.connectivity + static_cast<std::int64_t>(places.front()) * width;
      _file.read(first_at, std::span<Integer>(integers));
      for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        const auto from = static_cast<std::size_t>(places[i] - places.front());
        const auto length = static_cast<std::size_t>(places[i + 1] - places[i]);
        read_element(std::span<const Integer>(integers).subspan(from, length),
                     first_at + static_cast<std::int64_t>(from) * width, patch, raw);
      }
    }
  }

  void read_element(std::span<const Integer> integers, std::int64_t offset, std::int32_t patch,
                    RawMesh& raw) {
    if (integers.empty()) _file.fail(offset, "an element without a type");
    const auto type = static_cast<std::int64_t>(integers[0]);
    const std::optional<Su2Element> element = su2_element_of(type);
    if (!element) _file.fail(offset, su2_type_text(type));
    if (integers.size() < static_cast<std::size_t>(element->corners) + (patch < 0 ? 2 : 1))
      _file.fail(offset, "the element has too few integers");
    const auto points = integers.subspan(1, static_cast<std::size_t>(element->corners));
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k] >= static_cast<std::uint64_t>(_points))
        _file.fail(offset + static_cast<std::int64_t>(k + 1) * width,
                   fmt::format("there is no point {}; the file has {}, from 0", points[k], _points));
    }
    if (element->cell && patch >= 0) _file.fail(offset, "a marker has faces, no cells");
    append_su2_element(raw, *element, points, patch);
  }

  RangeReader& _file;
  std::int64_t _points = 0;
};

}  // namespace

RawMesh read_su2b(const SharedPath& file) {
  RawMesh raw(file);
  raw.regions = {"fluid"};
  parallel::agree(file.communicator, [&] {
    RangeReader reader(file.path);
    auto width = reader.value<std::int32_t>(0);
    if (width != 4 && width != 8) {
      reader.set_order(ByteOrder::big);
      width = reader.value<std::int32_t>(0);
    }
    if (width == 4) {
      Su2bReader<std::uint32_t>(reader).read(raw);
    } else if (width == 8) {
      Su2bReader<std::uint64_t>(reader).read(raw);
    } else {
      reader.fail(0, "no binary SU2 mesh: it begins with the size of its integers, 4 or 8");
    }
  });
  set_marker_types(file, raw.patches);
  return raw;
}

}  // namespace aeroloom::io
