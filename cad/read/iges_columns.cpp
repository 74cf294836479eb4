#include "cad/read/iges_columns.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cad {

namespace {

/// Columns are counted from 0 here.
constexpr std::size_t parameter_columns = 64, section_column = 72;
constexpr std::size_t field_width = 8;

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string line(text.substr(0, end));
    while (line.ends_with('\r')) line.pop_back();
    lines.push_back(std::move(line));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

char section_of(const std::string& line) {
  return line.size() > section_column ? line[section_column] : ' ';
}

std::string without_last_blanks(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

/// The number in a field of a directory line; -1: none.
std::int64_t field_of(const std::string& line, std::size_t field) {
  std::string_view text = std::string_view(line).substr(field * field_width, field_width);
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  std::int64_t value = -1;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

void set_field(std::string& line, std::size_t field, std::size_t value) {
  line.replace(field * field_width, field_width, fmt::format("{:>8}", value));
}

struct Delimiters {
  char parameter = ',', record = ';';
};

/// They are the first two parameters of the global section, each left out or as "1H,".
Delimiters delimiters_of(const std::string& global) {
  Delimiters found;
  const auto take = [&](std::size_t at, char& delimiter) {
    if (global.size() < at + 3 || global.compare(at, 2, "1H") != 0) return at;
    delimiter = global[at + 2];
    return at + 3;
  };
  take(take(0, found.parameter) + 1, found.record);
  return found;
}

/// The parameters of an entity, each with its delimiter.
class Parameters {
public:
  Parameters(const std::string& text, Delimiters delimiters) {
    bool ended = false;
    for (std::size_t at = 0; at < text.size() && !ended;) {
      const std::size_t begin = std::min(text.find_first_not_of(' ', at), text.size());
      const std::size_t end = end_of(text, begin, delimiters);
      ended = end > begin && text[end - 1] == delimiters.record;
      if (end > begin) words.push_back(text.substr(begin, end - begin));
      at = std::max(end, begin + 1);
    }
  }

  std::vector<std::string> words;

  /// Lines of at most 64 columns. Only texts go on in the next line; a longer number is left to the library.
  std::vector<std::string> lines() const {
    std::vector<std::string> result(1);
    for (const std::string& word : words) {
      const std::size_t head = text_begin(word);
      const bool fits = result.back().size() + word.size() <= parameter_columns;
      const bool goes_on = head > 0 && result.back().size() + head < parameter_columns;
      if (!fits && !goes_on) result.emplace_back();
      std::string_view rest = word;
      while (!rest.empty()) {
        if (result.back().size() == parameter_columns) result.emplace_back();
        const std::size_t room = head > 0 ? parameter_columns - result.back().size() : rest.size();
        result.back() += rest.substr(0, room);
        rest.remove_prefix(std::min(room, rest.size()));
      }
    }
    return result;
  }

private:
  /// Where the letters of a text "5Hwords" begin; 0 of a number.
  static std::size_t text_begin(std::string_view word) {
    const std::size_t digits = std::min(word.find_first_not_of("0123456789"), word.size());
    return digits > 0 && digits < word.size() && word[digits] == 'H' ? digits + 1 : 0;
  }

  /// The end of the parameter at `begin`, after its delimiter.
  static std::size_t end_of(const std::string& text, std::size_t begin, Delimiters delimiters) {
    std::size_t at = begin;
    if (const std::size_t letters = text_begin(std::string_view(text).substr(begin)); letters > 0) {
      std::size_t length = 0;
      std::from_chars(text.data() + begin, text.data() + begin + letters - 1, length);
      at = std::min(text.size(), begin + letters + std::min(length, text.size()));
    }
    while (at < text.size() && text[at] != delimiters.parameter && text[at] != delimiters.record) ++at;
    return std::min(at + 1, text.size());
  }
};

/// An IGES file by its sections.
class IgesText {
public:
  explicit IgesText(const std::string& text) : _lines(lines_of(text)) {
    std::string global;
    for (std::size_t i = 0; i < _lines.size(); ++i) {
      const char section = section_of(_lines[i]);
      if (section == 'G') global += _lines[i].substr(0, section_column);
      if (section == 'D') _directory.push_back(i);
      if (section == 'P') _parameters.push_back(i);
    }
    _delimiters = delimiters_of(global);
  }

  /// With more entities their numbers reach into column 65.
  bool is_shifted() const {
    constexpr std::size_t most_lines = 9'999'999;
    return _directory.size() <= most_lines &&
           std::any_of(_parameters.begin(), _parameters.end(),
                       [&](std::size_t i) { return _lines[i][parameter_columns] != ' '; });
  }

  std::optional<std::string> laid_out() {
    std::vector<std::string> parameters;
    for (std::size_t d = 0; d + 1 < _directory.size(); d += 2) {
      std::string &first = _lines[_directory[d]], &second = _lines[_directory[d + 1]];
      const std::int64_t begin = field_of(first, 1), count = std::max<std::int64_t>(field_of(second, 3), 1);
      const auto all = static_cast<std::int64_t>(_parameters.size());
      if (begin < 1 || begin - 1 > all - count) return std::nullopt;
      set_field(first, 1, parameters.size() + 1);
      const std::vector<std::string> lines = entity_lines(begin - 1, count);
      for (const std::string& line : lines) {
        parameters.push_back(fmt::format("{:<64} {:>7}P{:>7}", line, d + 1, parameters.size() + 1));
      }
      set_field(second, 3, lines.size());
    }
    return joined(parameters);
  }

private:
  std::vector<std::string> entity_lines(std::int64_t begin, std::int64_t count) const {
    bool shifted = false;
    std::string text;
    std::vector<std::string> as_they_are;
    for (std::int64_t i = begin; i < begin + count; ++i) {
      const std::string& line = _lines[_parameters[static_cast<std::size_t>(i)]];
      std::string columns = line.substr(0, parameter_columns);
      as_they_are.push_back(columns);
      if (line[parameter_columns] != ' ') {
        shifted = true;
        columns = without_last_blanks(std::move(columns)) + line[parameter_columns];
      }
      text += columns;
    }
    return shifted ? Parameters(text, _delimiters).lines() : as_they_are;
  }

  std::string joined(const std::vector<std::string>& parameters) const {
    std::string text;
    bool are_in = false;
    for (std::string line : _lines) {
      const char section = section_of(line);
      if (section == 'P') {
        if (!are_in)
          for (const std::string& each : parameters) text.append(each).append("\n");
        are_in = true;
        continue;
      }
      if (section == 'T')
        line.replace(3 * field_width, field_width, fmt::format("P{:>7}", parameters.size()));
      text.append(line).append("\n");
    }
    return text;
  }

  std::vector<std::string> _lines;
  std::vector<std::size_t> _directory, _parameters;  // indices of lines
  Delimiters _delimiters;
};

}  // namespace

std::optional<std::string> with_right_columns(const std::string& text) {
  IgesText file(text);
  return file.is_shifted() ? file.laid_out() : std::nullopt;
}

}  // namespace aeroloom::cad
