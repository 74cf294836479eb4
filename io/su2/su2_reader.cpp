#include "io/su2/su2_reader.hpp"

#include "io/streams/text_lines.hpp"
#include "io/su2/su2_elements.hpp"
#include "io/su2/su2_markers.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

/// Reads the file from its first to its last line.
class Su2Text {
public:
  Su2Text(const std::string& path, RawMesh& raw) : _lines(path), _raw(raw) {}

  void read() {
    while (_lines.next()) {
      const std::string_view line = content();
      if (line.empty()) continue;
      const std::size_t equals = line.find('=');
      if (equals == std::string_view::npos) {
        if (_skips) continue;
        _lines.fail(
            "a keyword is expected here, as in `NPOIN= 8`; the section before has more lines than it "
            "announces");
      }
      read_section(trimmed(line.substr(0, equals)), trimmed(line.substr(equals + 1)));
    }
    finish();
  }

private:
  /// The line without its comment and blanks at its ends.
  std::string_view content() const {
    const std::string_view line = _lines.line();
    return trimmed(line.substr(0, std::min(line.find('%'), line.size())));
  }

  void read_section(std::string_view keyword, std::string_view value) {
    _skips = false;
    if (keyword == "NDIME") {
      if (number(value) != 3) _lines.fail("only meshes of three dimensions (NDIME= 3) are supported");
      _has_dimension = true;
    } else if (keyword == "NZONE") {
      if (number(value) != 1) _lines.fail("only files of one zone are supported");
    } else if (keyword == "NPOIN") {
      read_points(count(value, "points", 6));
    } else if (keyword == "NELEM") {
      if (std::exchange(_has_cells, true)) _lines.fail("NELEM comes twice");
      read_elements(count(value, "elements", 4), -1);
    } else if (keyword == "NMARK") {
      _markers_announced = count(value, "markers", 1);
    } else if (keyword == "MARKER_TAG") {
      if (value.empty()) _lines.fail("the marker has no name");
      _marker = value;
    } else if (keyword == "MARKER_ELEMS") {
      read_marker(count(value, "faces of a marker", 4));
    } else if (keyword != "IZONE") {
      _skips = true;  // boxes of free-form deformation, periodic boundaries, angles and the like
    }
  }

  std::int64_t number(std::string_view text) {
    std::int64_t value = 0;
    if (!parse_number(LineWords(text).next(), value))
      _lines.fail(fmt::format("`{}` is no whole number", text.substr(0, 40)));
    return value;
  }

  /// A count that the file can have lines for, at `bytes` each.
  std::int64_t count(std::string_view text, const char* what, std::int64_t bytes) {
    const std::int64_t value = number(text);
    if (value < 0 || value > _lines.size() / bytes + 1)
      _lines.fail(fmt::format("{} {} do not fit a file of {} bytes", value, what, _lines.size()));
    return value;
  }

  /// The next line that says something, of a section of `total`.
  std::string_view item_line(std::int64_t item, std::int64_t total, const char* what) {
    while (_lines.next()) {
      const std::string_view line = content();
      if (line.empty()) continue;
      if (line.find('=') != std::string_view::npos)
        _lines.fail(fmt::format("a keyword after {} of {} {}", item, total, what));
      return line;
    }
    _lines.fail(fmt::format("the file ends after {} of {} {}", item, total, what));
  }

  void read_points(std::int64_t total) {
    if (std::exchange(_has_points, true)) _lines.fail("NPOIN comes twice");
    _raw.coordinates.reserve(3 * static_cast<std::size_t>(total));
    _raw.point_ids.reserve(static_cast<std::size_t>(total));
    for (std::int64_t i = 0; i < total; ++i) {
      LineWords words(item_line(i, total, "points"));
      for (int k = 0; k < 3; ++k) {
        double value = 0;
        if (!parse_number(words.next(), value) || !std::isfinite(value))
          _lines.fail(fmt::format("coordinate {} of point {} is no number", k + 1, i));
        _raw.coordinates.push_back(value);
      }
      _raw.point_ids.push_back(i);
    }
  }

  /// Elements of a patch, -1: of the volume.
  void read_elements(std::int64_t total, std::int32_t patch) {
    for (std::int64_t i = 0; i < total; ++i) {
      LineWords words(item_line(i, total, patch < 0 ? "elements" : "faces of a marker"));
      std::int64_t type = 0;
      if (!parse_number(words.next(), type)) _lines.fail("an element begins with its type, a number");
      const std::optional<Su2Element> element = su2_element_of(type);
      if (!element) _lines.fail(su2_type_text(type));
      std::array<GlobalIndex, mesh::most_corners> points{};
      for (int k = 0; k < element->corners; ++k) points[static_cast<std::size_t>(k)] = point(words);
      if (element->cell && patch >= 0) _lines.fail("a marker has faces, no cells");
      append_su2_element(_raw, *element, points, patch);
    }
  }

  GlobalIndex point(LineWords& words) {
    GlobalIndex value = 0;
    if (!parse_number(words.next(), value)) _lines.fail("the element has too few points");
    if (value < 0) _lines.fail(fmt::format("there is no point {}", value));
    if (value > _highest) _highest = value, _highest_line = _lines.number();
    return value;
  }

  void read_marker(std::int64_t total) {
    if (_marker.empty()) _lines.fail("MARKER_TAG is expected before MARKER_ELEMS");
    ++_markers_read;
    const std::string name = std::exchange(_marker, {});
    if (name == "SEND_RECEIVE") {
      _skips = true;
      return;
    }
    const auto known = static_cast<std::int32_t>(_raw.patches.size());
    const auto [found, is_new] = _patch_of.try_emplace(name, known);
    if (is_new) _raw.patches.push_back({name, mesh::PatchType::wall});
    read_elements(total, found->second);
  }

  void finish() {
    if (!_has_dimension) _lines.fail("the file has no NDIME=; is it an SU2 mesh?");
    if (!_has_points) _lines.fail("the file has no NPOIN=");
    if (!_has_cells) _lines.fail("the file has no NELEM=");
    if (_markers_announced >= 0 && _markers_announced != _markers_read)
      _lines.fail(
          fmt::format("the file has {} markers; NMARK= announces {}", _markers_read, _markers_announced));
    const auto points = static_cast<GlobalIndex>(_raw.point_ids.size());
    if (_highest >= points)
      _lines.fail_at(_highest_line,
                     fmt::format("there is no point {}; the file has {}, from 0", _highest, points));
  }

  TextLines _lines;
  RawMesh& _raw;
  bool _has_dimension = false, _has_points = false, _has_cells = false;
  bool _skips = false;  ///< lines without a keyword, after one that does not concern the mesh
  std::string _marker;  ///< the tag that waits for its elements
  std::map<std::string, std::int32_t> _patch_of;
  std::int64_t _markers_announced = -1, _markers_read = 0;
  GlobalIndex _highest = -1;
  std::int64_t _highest_line = 0;
};

}  // namespace

RawMesh read_su2(const SharedPath& file) {
  RawMesh raw(file);
  parallel::on_root(file.communicator, [&] { Su2Text(file.path, raw).read(); });
  file.communicator.broadcast_value(raw.patches);
  set_marker_types(file, raw.patches);
  raw.regions = {"fluid"};
  return raw;
}

}  // namespace aeroloom::io
