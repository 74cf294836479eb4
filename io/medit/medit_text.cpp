#include "io/medit/local_medit_mesh.hpp"
#include "io/streams/text_lines.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::GlobalIndex;

constexpr std::size_t longest_word = 400;

/// The words of a text, one after another; comments, from # to the end of the line, are no words.
class WordReader {
public:
  explicit WordReader(const std::string& path) : _file(path) {}

  /// Bytes that are still to come.
  std::int64_t left() const { return _file.bytes_from(_offset) + static_cast<std::int64_t>(_filled - _at); }
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::runtime_error(fmt::format("{}, line {}: {}", _file.path(), _line, what));
  }

  /// The next word; empty at the end of the file.
  const std::string& next() {
    _word.clear();
    int c = get();
    while (c == '#' || is_blank(c)) {
      if (c == '#') {
        while (c != '\n' && c != end_of_file) c = get();
      } else {
        c = get();
      }
    }
    _line = _lines_ended + 1;
    while (c != end_of_file && !is_blank(c)) {
      if (_word.size() == longest_word) refuse("this is no text");
      _word += static_cast<char>(c);
      c = get();
    }
    return _word;
  }

  std::int64_t integer(const char* what) {
    std::int64_t value = 0;
    parse(value, what);
    return value;
  }
  double real(const char* what) {
    double value = 0;
    parse(value, what);
    return value;
  }

private:
  static constexpr int end_of_file = -1;

  static bool is_blank(int c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

  int get() {
    if (_at == _filled && !fill()) return end_of_file;
    const char c = _buffer[_at++];
    if (c == '\n') ++_lines_ended;
    return static_cast<unsigned char>(c);
  }

  bool fill() {
    _buffer.resize(static_cast<std::size_t>(std::min(std::int64_t{1} << 20, _file.bytes_from(_offset))));
    _file.read_bytes(_offset, std::as_writable_bytes(std::span(_buffer)));
    _filled = _buffer.size();
    _offset += static_cast<std::int64_t>(_filled);
    _at = 0;
    return _filled > 0;
  }

  template <class Number>
  void parse(Number& value, const char* what) {
    next();
    if (_word.empty()) refuse(fmt::format("the file ends where {} should be", what));
    if (!parse_number(_word, value)) refuse(fmt::format("'{}' should be {}", _word, what));
  }

  RangeReader _file;
  std::string _buffer, _word;
  std::size_t _at = 0, _filled = 0;
  std::int64_t _offset = 0;                  // of the file, after the buffer
  std::int64_t _line = 1, _lines_ended = 0;  // _line: of the last word
};

bool is_keyword(const std::string& word) {
  return !word.empty() && std::isalpha(static_cast<unsigned char>(word.front())) != 0;
}

class TextReader {
public:
  explicit TextReader(const std::string& path) : _words(path) {}

  LocalMeditMesh read() {
    std::string word = _words.next();
    if (word != "MeshVersionFormatted") _words.refuse("this is no Medit file: no MeshVersionFormatted");
    _words.integer("a version");
    for (word = _words.next(); !word.empty() && word != "End"; word = _following) {
      if (!is_keyword(word)) _words.refuse(fmt::format("'{}' should be a keyword", word));
      read_section(word);
    }
    return std::move(_local);
  }

private:
  std::string _following;  // the word after a section

  void read_section(const std::string& keyword) {
    if (keyword == "Dimension") {
      const std::int64_t dimension = _words.integer("a dimension");
      if (dimension != 3) _words.refuse(fmt::format("the mesh has {} dimensions, not 3", dimension));
      _following = _words.next();
    } else if (keyword == name_of(MeditKeyword::vertices)) {
      read_vertices();
      _following = _words.next();
    } else if (medit_unreadable(keyword)) {
      const std::int64_t count = _words.integer("a count");
      if (count != 0) {
        _words.refuse(
            fmt::format("there are {} {}; only tetrahedra, pyramids, prisms and hexahedra with straight "
                        "edges can be read",
                        count, keyword));
      }
      _following = _words.next();
    } else if (!read_items(keyword)) {
      do {
        _following = _words.next();
      } while (!_following.empty() && !is_keyword(_following));
    }
  }

  /// A number and a blank for each of `numbers` in a line.
  std::int64_t count_of_lines(int numbers, const std::string& keyword) {
    const std::int64_t count = _words.integer("a count");
    if (count < 0 || count > (_words.left() + 1) / (2 * numbers)) {
      _words.refuse(fmt::format("{} {} do not fit into the {} bytes that are left of the file", count,
                                keyword, _words.left()));
    }
    return count;
  }

  void read_vertices() {
    if (!_local.coordinates.empty()) _words.refuse("Vertices come twice");
    const std::int64_t count = count_of_lines(4, "Vertices");
    _local.coordinates.reserve(3 * static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < 3; ++axis) _local.coordinates.push_back(_words.real("a coordinate"));
      _words.real("a reference");
    }
  }

  /// Whether the keyword is one of cells or faces that are read.
  bool read_items(const std::string& keyword) {
    for (const MeditKeyword known :
         {MeditKeyword::triangles, MeditKeyword::quadrilaterals, MeditKeyword::tetrahedra,
          MeditKeyword::pyramids, MeditKeyword::prisms, MeditKeyword::hexahedra}) {
      if (keyword != name_of(known) && !(known == MeditKeyword::hexahedra && keyword == "Hexaedra")) continue;
      MeditItems& items = *_local.items(static_cast<std::int32_t>(known));
      if (!items.references.empty()) _words.refuse(keyword + " come twice");
      read_items(keyword, medit_corners(static_cast<std::int32_t>(known)), items);
      _following = _words.next();
      return true;
    }
    return false;
  }

  void read_items(const std::string& keyword, int corners, MeditItems& items) {
    const std::int64_t count = count_of_lines(corners + 1, keyword);
    items.references.reserve(static_cast<std::size_t>(count));
    items.corners.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(corners));
    for (std::int64_t i = 0; i < count; ++i) {
      for (int k = 0; k < corners; ++k) {
        const std::int64_t corner = _words.integer("a vertex");
        if (corner < 1) _words.refuse(fmt::format("there is no vertex {}", corner));
        items.corners.push_back(corner - 1);
      }
      items.references.push_back(_words.integer("a reference"));
    }
  }

  WordReader _words;
  LocalMeditMesh _local;
};

}  // namespace

LocalMeditMesh read_medit_text(const std::string& path) {
  return TextReader(path).read();
}

}  // namespace aeroloom::io
