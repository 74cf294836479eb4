#include "cad/faceted/facet_readers.hpp"
#include "cad/faceted/facet_text.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {
namespace {

class ObjText {
public:
  explicit ObjText(const FacetFile& file) : _text(file.name, file.bytes) {}

  FacetSoup read() {
    _soup.format = "OBJ";
    while (_text.next_line()) {
      const std::string_view word = _text.word();
      if (word == "v") {
        _soup.points.push_back(_text.point());
      } else if (word == "f" || word == "fo") {
        read_face();
      } else if (word == "o") {
        rename(_part);
      } else if (word == "g") {
        rename(_group);
      } else if (word == "usemtl") {
        rename(_material);
      }
    }
    return std::move(_soup);
  }

private:
  void rename(std::string& name) {
    name = _text.rest();
    _number.reset();
  }

  void read_face() {
    _corners.clear();
    for (std::string_view word = _text.word(); !word.empty(); word = _text.word()) {
      if (word == "\\") {
        _text.join_next_line();
        continue;
      }
      const std::int64_t number = _text.to_integer(word.substr(0, word.find('/')), "the number of a point");
      if (number == 0) _text.fail("points are counted from 1, or backwards from -1");
      _corners.push_back(number > 0 ? number - 1 : static_cast<std::int64_t>(_soup.points.size()) + number);
    }
    if (!_number) _number = find_group(_soup, {_group.empty() ? _material : _group, _part});
    add_polygon(_soup, _corners, *_number, [&](const std::string& what) { _text.fail(what); });
  }

  FacetText _text;
  FacetSoup _soup;
  std::string _part, _group, _material;
  std::optional<std::int32_t> _number;  // of the group that these name
  std::vector<std::int64_t> _corners;
};

}  // namespace

FacetSoup read_obj(const FacetFile& file) {
  return ObjText(file).read();
}

}  // namespace aeroloom::cad
