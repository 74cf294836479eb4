#include "io/openfoam/foam_file.hpp"

#include <array>

#include <fmt/format.h>

namespace aeroloom::io {

std::string foam_header(const FoamFormat& format, std::string_view kind, std::string_view location,
                        std::string_view object, std::string_view note) {
  std::string text = fmt::format(
      "FoamFile\n{{\n    version     2.0;\n    format      {};\n    class       {};\n"
      "    arch        \"LSB;label={};scalar=64\";\n",
      format.binary ? "binary" : "ascii", kind, format.label_bits);
  if (!note.empty()) text += fmt::format("    note        \"{}\";\n", note);
  text += fmt::format("    location    \"{}\";\n    object      {};\n}}\n\n", location, object);
  return text;
}

FoamList::FoamList(LocalFile& file, const FoamFormat& format, std::int64_t count)
    : _file(file), _format(format), _count(count) {
  _file.text(fmt::format("{}\n", count));
  // An empty binary list has no brackets.
  if (!_format.binary) {
    _file.text("(\n");
  } else if (_count > 0) {
    _file.text("(");
  }
}

void FoamList::label(std::int64_t value) {
  if (!_format.binary) {
    std::array<char, 24> text;
    *fmt::format_to(text.data(), "{}\n", value) = 0;
    _file.text(text.data());
  } else if (_format.label_bits == 64) {
    _file.item(value);
  } else {
    _file.item(static_cast<std::int32_t>(value));
  }
}

void FoamList::vector(const double* xyz) {
  if (_format.binary) {
    _file.items(std::span<const double>(xyz, 3));
  } else {
    std::array<char, 96> text;
    *fmt::format_to(text.data(), "({:.17g} {:.17g} {:.17g})\n", xyz[0], xyz[1], xyz[2]) = 0;
    _file.text(text.data());
  }
}

void FoamList::flag(bool value) {
  if (_format.binary) {
    _file.item(static_cast<char>(value ? 1 : 0));
  } else {
    _file.text(value ? "1\n" : "0\n");
  }
}

void FoamList::end() {
  if (!_format.binary || _count > 0) _file.text(")");
}

}  // namespace aeroloom::io
