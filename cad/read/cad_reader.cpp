#include "cad/read/cad_reader.hpp"

#include "cad/model/library_unit.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/occ_guard.hpp"
#include "cad/model/shape_map.hpp"
#include "cad/model/step_trace.hpp"
#include "cad/model/to_vec.hpp"
#include "cad/read/iges_columns.hpp"
#include "cad/read/memory_file.hpp"
#include "cad/read/scale_shape.hpp"
#include "geometry/input_file.hpp"
#include "geometry/long_names.hpp"
#include "geometry/place_text.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <exception>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#include <vector>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <TopoDS.hxx>
#include <fmt/format.h>

namespace aeroloom::cad {
namespace {

/// The first and last bytes of a file, enough to tell what it is and whether it is complete.
struct Ends {
  std::string head, tail;  ///< the head without the byte-order mark
  std::size_t mark = 0;    ///< length of the mark
};

Ends read_ends(const std::string& file) {
  constexpr std::streamoff window = 4096;  // bytes; chosen, not measured
  std::ifstream stream;
  stream.exceptions(std::ios::failbit | std::ios::badbit);
  geometry::require_readable(file);
  errno = 0;
  try {
    stream.open(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream.tellg();
    Ends ends;
    ends.head.resize(std::min(size, window));
    stream.seekg(0);
    stream.read(ends.head.data(), static_cast<std::streamsize>(ends.head.size()));
    ends.tail.resize(std::min(size, window));
    stream.seekg(size - std::min(size, window));
    stream.read(ends.tail.data(), static_cast<std::streamsize>(ends.tail.size()));
    ends.mark = geometry::mark_length(ends.head);
    ends.head.erase(0, ends.mark);
    return ends;
  } catch (const std::ios_base::failure& failure) {
    const std::error_code reason(errno, std::generic_category());
    throw std::ios_base::failure(fmt::format("cannot read '{}'", file), reason ? reason : failure.code());
  }
}

bool contains(const std::string& text, const char* wanted) {
  return text.find(wanted) != std::string::npos;
}

std::string trimmed(std::string text) {
  const auto solid = [](unsigned char c) { return !std::isspace(c) && c != 0; };
  text.erase(std::find_if(text.rbegin(), text.rend(), solid).base(), text.end());
  text.erase(text.begin(), std::find_if(text.begin(), text.end(), solid));
  return text;
}

/// The beginning of a file, printable, so that a message shows what it is instead of CAD.
std::string excerpt(const std::string& head) {
  constexpr std::size_t shown = 40;  // characters, in one line of a message
  std::string text = trimmed(head).substr(0, shown);
  std::ranges::replace_if(
      text, [](unsigned char c) { return !std::isprint(c); }, '.');
  return text;
}

/// IGES: lines of 80 characters with the section's letter in column 73, here counted from 0. Line lengths
/// vary when trailing blanks were stripped, never before that column.
constexpr std::size_t letter_column = 72;

bool looks_like_iges(const std::string& head) {
  const std::string line = head.substr(0, head.find_first_of("\r\n"));
  return line.size() > letter_column + 1 && line[letter_column] == 'S' &&
         line.find_first_not_of(" 0123456789", letter_column + 1) == std::string::npos;
}

bool iges_is_complete(const std::string& tail) {
  const std::string text = trimmed(tail);
  const std::string line = text.substr(text.find_last_of("\r\n") + 1);
  return line.size() > letter_column && line[letter_column] == 'T';
}

void require(bool condition, const std::string& file, const std::string& found) {
  if (!condition) throw CadError(fmt::format("'{}': {}", file, found));
}

/// The CAD library's BREP readers print to standard output when they stumble.
class SilentOutput {
public:
  SilentOutput() : _buffer(std::cout.rdbuf(nullptr)) {}
  ~SilentOutput() {
    std::cout.rdbuf(_buffer);
    std::cout.clear();
  }
  SilentOutput(const SilentOutput&) = delete;
  SilentOutput& operator=(const SilentOutput&) = delete;

private:
  std::streambuf* _buffer;
};

/// Half of the vertices are exact to this.
double median_tolerance(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape vertices = map_of(shape, TopAbs_VERTEX);
  std::vector<double> tolerances;
  for (int i = 1; i <= vertices.Extent(); ++i)
    tolerances.push_back(BRep_Tool::Tolerance(TopoDS::Vertex(vertices(i))));
  if (tolerances.empty()) return 0;
  const auto middle = tolerances.begin() + static_cast<std::ptrdiff_t>(tolerances.size() / 2);
  std::nth_element(tolerances.begin(), middle, tolerances.end());
  return *middle;
}

/// The stream throws where the file ends too early: the readers would go round in circles for ever.
NamedShape read_brep(const std::string& file, bool binary) {
  NamedShape named;
  try {
    const SilentOutput silent;
    std::ifstream stream(file, std::ios::binary);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    if (binary) {
      BinTools::Read(named.shape, stream);
    } else {
      BRepTools::Read(named.shape, stream, BRep_Builder());
    }
  } catch (const std::ios_base::failure&) {
    throw CadError(fmt::format("'{}': a BREP file that is damaged or ends too early", file));
  }
  require(!named.shape.IsNull(), file, "a BREP file that is damaged: no shape could be read");
  named.precision = median_tolerance(named.shape);
  return named;
}

/// STEP files may begin with comments.
std::string without_comments(std::string text) {
  text = trimmed(text);
  while (text.starts_with("/*")) {
    const std::size_t end = text.find("*/");
    text = end == std::string::npos ? std::string() : trimmed(text.substr(end + 2));
  }
  return text;
}

enum class Format { unknown, step, iges, brep, binary_brep };

Format recognise(const Ends& ends) {
  if (without_comments(ends.head).starts_with("ISO-10303-21")) return Format::step;
  if (looks_like_iges(ends.head)) return Format::iges;
  if (contains(ends.head, "Open CASCADE Topology V")) return Format::binary_brep;
  return contains(ends.head, "CASCADE Topology V") ? Format::brep : Format::unknown;
}

[[noreturn]] void refuse_format(const std::string& file, const Ends& ends) {
  if (contains(ends.head, "ISO-10303-21")) {
    throw CadError(
        fmt::format("'{}': a STEP file must begin with ISO-10303-21; found \"{}\". Remedy: remove what "
                    "stands before ISO-10303-21",
                    file, excerpt(ends.head)));
  }
  throw CadError(fmt::format(
      "'{}' is neither STEP, IGES nor BREP: it begins with \"{}\". Remedy: export the geometry as "
      "STEP, or triangles as STL, OBJ, OFF, PLY, .poly or .smesh, with that ending of the name",
      file, excerpt(ends.head)));
}

/// What a reader is told: the encoding of names, and the length that is the unit of the shapes.
struct Reading {
  const std::string& encoding;
  double unit;
};

NamedShape read_by_content(const std::string& file, const Ends& ends, const Reading& as) {
  switch (recognise(ends)) {
    case Format::step:
      require(contains(ends.tail, "END-ISO-10303-21"), file,
              "a STEP file that ends too early: no END-ISO-10303-21");
      return read_step(file, as.encoding, as.unit);
    case Format::iges:
      require(iges_is_complete(ends.tail), file,
              "an IGES file that ends too early: its last line is no T section");
      return read_iges(file, as.encoding);
    case Format::brep:
      return read_brep(file, false);
    case Format::binary_brep:
      return read_brep(file, true);
    case Format::unknown:
      break;
  }
  refuse_format(file, ends);
}

/// What the CAD library has to read instead of the file; nothing where it can read the file.
std::optional<std::string> readable_text(const std::string& file, const Ends& ends) {
  const bool is_iges = recognise(ends) == Format::iges;
  if (ends.mark == 0 && !is_iges) return std::nullopt;
  const std::string text = geometry::read_whole(file).substr(ends.mark);
  if (std::optional<std::string> right = is_iges ? with_right_columns(text) : std::nullopt) return right;
  return ends.mark > 0 ? std::optional(text) : std::nullopt;
}

/// Messages name the file that the user knows.
NamedShape read_from_memory(const std::string& file, const std::string& text, const Ends& ends,
                            const Reading& as) {
  const MemoryFile copy(text);
  try {
    return read_by_content(copy.path(), ends, as);
  } catch (const CadError& error) {
    std::string message = error.what();
    const std::size_t at = message.find(copy.path());
    if (at != std::string::npos) message.replace(at, copy.path().size(), file);
    throw CadError(message);
  }
}

/// The extent of the corners, which no tolerance widens; of the whole where there is one corner at most.
double extent_of(const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape vertices = map_of(shape, TopAbs_VERTEX);
  Box corners;
  for (int i = 1; i <= vertices.Extent(); ++i)
    corners.add(to_vec(BRep_Tool::Pnt(TopoDS::Vertex(vertices(i)))));
  const auto largest = [](const Box& box) {
    const Vec3 size = box.empty() ? Vec3{} : box.size();
    return std::max({size.x, size.y, size.z});
  };
  return largest(corners) > 0 ? largest(corners) : largest(tight_box(shape));
}

/// In the file's unit. Where nothing comes of a STEP file, as if it were tiny. Throws as the first reading.
template <class Read>
NamedShape read_at_first(const Read& read, bool is_step) {
  constexpr double tiny = 1.0 / (1 << 30);  // the library's precision is then 1e-16
  std::exception_ptr why;
  NamedShape first;
  try {
    first = read(1.0);
    if (!is_step || extent_of(first.shape) > 0) return first;
  } catch (const CadError&) {
    if (!is_step) throw;
    why = std::current_exception();
  }
  try {
    NamedShape named = read(tiny);
    if (extent_of(named.shape) > 0) return named;
  } catch (const CadError&) {  // the first reading says why
  }
  if (why) std::rethrow_exception(why);
  return first;
}

/// Numbers are products of up to five coordinates, as of triangles (bound_coordinates()). Corners that
/// numbers do not tell apart are one.
void require_calculable(const NamedShape& named, const std::string& file) {
  constexpr double largest_allowed = 1e30, smallest_allowed = 1e-30, least_spacings = 100;
  const TopTools_IndexedMapOfShape vertices = map_of(named.shape, TopAbs_VERTEX);
  double largest = 0;
  Vec3 farthest;
  for (int i = 1; i <= vertices.Extent(); ++i) {
    const Vec3 p = named.unit * to_vec(BRep_Tool::Pnt(TopoDS::Vertex(vertices(i))));
    const double away = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (!(away <= largest)) largest = away, farthest = p;
  }
  if (largest == 0) return;
  require(largest >= smallest_allowed && largest <= largest_allowed, file,
          fmt::format("the largest coordinate is {:.3g}, of a corner at {}, but only such from {:.0g} to "
                      "{:.0g} can be calculated with. Remedy: write the file in another unit, or leave out "
                      "what does not belong to the body",
                      largest, geometry::place_text(farthest), smallest_allowed, largest_allowed));
  const double extent = named.unit * extent_of(named.shape);
  const double spacing = std::nextafter(largest, std::numeric_limits<double>::infinity()) - largest;
  require(extent >= least_spacings * spacing, file,
          fmt::format("all corners lie within {:.3g} around {}, where numbers of the computer are {:.2g} "
                      "apart. Remedy: a model near the origin",
                      extent, geometry::place_text(farthest), spacing));
}

/// In the unit for its extent. Tiny STEP files are read in it: in the file's unit the library would take
/// places for one. Other shapes are scaled as they were read.
template <class Read>
NamedShape read_in_own_unit(const Read& read, bool is_step, const std::string& file) {
  constexpr int most_readings = 4;  // what the first one makes of a tiny file may lack parts
  NamedShape named = read_at_first(read, is_step);
  require_calculable(named, file);
  double unit = library_unit(named.unit * extent_of(named.shape));
  for (int reading = 1; is_step && unit < 1 && unit != named.unit && reading < most_readings; ++reading) {
    named = read(unit);
    unit = library_unit(named.unit * extent_of(named.shape));
  }
  return unit == named.unit ? named : scaled(named, unit);
}

/// In the order of the file, which no repair, cut or far field changes.
void number_faces(NamedShape& named) {
  const TopTools_IndexedMapOfShape faces = map_of(named.shape, TopAbs_FACE);
  for (int i = 1; i <= faces.Extent(); ++i) {
    if (!named.labels.IsBound(faces(i))) named.labels.Bind(faces(i), FaceLabel{});
    FaceLabel& label = named.labels.ChangeFind(faces(i));
    label.number = i - 1;
    for (std::string* name : {&label.name, &label.layer, &label.solid})
      named.cut_names += geometry::cut_long_name(*name) ? 1 : 0;
  }
}

}  // namespace

std::string format_of_cad_file(const std::string& file) {
  switch (recognise(read_ends(file))) {
    case Format::step:
      return "STEP";
    case Format::iges:
      return "IGES";
    case Format::brep:
    case Format::binary_brep:
      return "BREP";
    case Format::unknown:
      break;
  }
  return {};
}

NamedShape read_cad_file(const std::string& file, const std::string& encoding) {
  const Ends ends = read_ends(file);
  require(!trimmed(ends.head).empty(), file, "the file is empty");
  report_step("reading the file");
  return guarded(fmt::format("reading '{}'", file), [&] {
    const std::optional<std::string> text = readable_text(file, ends);
    NamedShape named = read_in_own_unit(
        [&](double unit) {
          const Reading as{encoding, unit};
          return text ? read_from_memory(file, *text, ends, as) : read_by_content(file, ends, as);
        },
        recognise(ends) == Format::step, file);
    number_faces(named);
    return named;
  });
}

}  // namespace aeroloom::cad
