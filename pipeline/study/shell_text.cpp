#include "pipeline/study/shell_text.hpp"

#include "pipeline/report/page/html_text.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::study {

namespace {

constexpr std::string_view plain_letters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";

bool is_plain(const std::string& word) {
  return !word.empty() && word.find_first_not_of(plain_letters) == std::string::npos;
}

/// With a backslash before each of these letters.
std::string escaped_letters(const std::string& text, std::string_view letters) {
  std::string result;
  for (const char letter : text) {
    if (letters.find(letter) != std::string_view::npos) result += '\\';
    result += letter;
  }
  return result;
}

/// Within single quotes, which are closed for a quote and opened again.
std::string within_single(const std::string& text) {
  std::string result;
  for (const char letter : text) result += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return result;
}

[[noreturn]] void refuse_place(const std::string& line, const std::string& mark, const char* what) {
  throw std::invalid_argument(fmt::format(
      "the launcher '{}' has {} {}, where names cannot be quoted. Remedy: {} outside of it, or a script "
      "as launcher",
      line, mark, what, mark));
}

/// Reads a line as the shell does, as far as quotes go.
class LineReader {
public:
  LineReader(const std::string& line, const std::string& mark, const std::vector<std::string>& command)
      : _line(line), _mark(mark), _words(quoted(command)) {}

  std::string read() {
    while (_at < _line.size()) {
      if (_line.compare(_at, _mark.size(), _mark) == 0)
        place_command();
      else if (_quote == 0)
        read_plain();
      else
        read_quoted();
    }
    return _result;
  }

private:
  void take(std::size_t letters) {
    _result.append(_line, _at, letters);
    _at += letters;
  }

  void place_command() {
    if (_in_backticks) refuse_place(_line, _mark, "within backticks");
    if (_holds_quotes) refuse_place(_line, _mark, "within quotes in quotes");
    _result += _quote == '\''  ? within_single(_words)
               : _quote == '"' ? escaped_letters(_words, "\\\"$`")
                               : _words;
    _at += _mark.size();
  }

  bool begins_word() const {
    return _at == 0 || std::string_view(" \t\n;&|()").find(_line[_at - 1]) != std::string_view::npos;
  }

  void read_plain() {
    const char letter = _line[_at];
    if (letter == '#' && begins_word()) {
      _at = std::min(_line.find('\n', _at), _line.size());
      return;
    }
    if (letter == '\\') return take(2);
    if (_line.compare(_at, 3, "<<<") == 0) return take(3);
    if (_line.compare(_at, 2, "<<") == 0)
      throw std::invalid_argument(fmt::format(
          "the launcher '{}' has a here-document, in which names cannot be quoted. Remedy: a script as "
          "launcher",
          _line));
    if (letter == '\'' || letter == '"') {
      _quote = letter;
      _holds_quotes = false;
    } else if (letter == '`') {
      _in_backticks = !_in_backticks;
    } else if (letter == '(') {
      _left.emplace_back(0, false);
    } else if (letter == ')' && !_left.empty()) {
      std::tie(_quote, _holds_quotes) = _left.back();
      _left.pop_back();
    }
    take(1);
  }

  void read_quoted() {
    const char letter = _line[_at];
    if (letter == _quote) {
      _quote = 0;
      _holds_quotes = false;
    } else if (letter == '\'' || letter == '"') {
      _holds_quotes = true;
    } else if (_quote == '"' && letter == '\\') {
      _holds_quotes = _holds_quotes || _line.compare(_at + 1, 1, "\"") == 0;
      return take(2);
    } else if (_quote == '"' && letter == '`') {
      _in_backticks = !_in_backticks;
    } else if (_quote == '"' && _line.compare(_at, 2, "$(") == 0) {
      _left.emplace_back(_quote, _holds_quotes);
      _quote = 0;
      _holds_quotes = false;
      return take(2);
    }
    take(1);
  }

  const std::string &_line, &_mark;
  const std::string _words;
  std::string _result;
  std::size_t _at = 0;
  char _quote = 0;             ///< that the place is in, or none
  bool _holds_quotes = false;  ///< other quotes stand before the place within these
  bool _in_backticks = false;
  std::vector<std::pair<char, bool>> _left;  ///< quotes that go on after a parenthesis
};

}  // namespace

std::string quoted(const std::string& word) {
  return is_plain(word) ? word : "'" + within_single(word) + "'";
}

std::string quoted(const std::vector<std::string>& words) {
  std::vector<std::string> texts;
  texts.reserve(words.size());
  for (const std::string& word : words) texts.push_back(quoted(word));
  return fmt::format("{}", fmt::join(texts, " "));
}

std::string assignments(const std::vector<std::pair<std::string, std::string>>& variables) {
  std::string lines;
  for (const auto& [name, value] : variables) lines += fmt::format("{}={}\n", name, quoted(value));
  return lines;
}

std::string with_command(const std::string& line, const std::string& mark,
                         const std::vector<std::string>& command) {
  return LineReader(line, mark, command).read();
}

std::string quoted_for_queue(const std::string& path) {
  if (path.find_first_of("\r\n") != std::string::npos)
    throw std::invalid_argument(fmt::format(
        "the folder of '{}' has a line break in its name, which a batch system does not take. Remedy: "
        "another folder",
        path));
  std::string text;
  for (const char letter : path) text += letter == '%' ? std::string("%%") : std::string(1, letter);
  return is_plain(text) ? text : "\"" + escaped_letters(text, "\\\"") + "\"";
}

std::string quoted_for_key(const std::string& path) {
  if (path.find("${") != std::string::npos)
    throw std::invalid_argument(fmt::format(
        "'{}' cannot hold a study: '${{' in its name would name an environment variable. Remedy: another "
        "output.directory",
        path));
  if (page::as_utf8(path) != path)
    throw std::invalid_argument(fmt::format(
        "'{}' cannot hold a study: its name is no UTF-8. Remedy: another output.directory", path));
  if (is_plain(path) && path.front() == '/' && path.find(':') == std::string::npos) return path;
  std::string text = "\"";
  for (const char letter : path) {
    if (static_cast<unsigned char>(letter) < 0x20 || letter == 0x7f)
      text += fmt::format("\\x{:02x}", static_cast<unsigned>(letter));
    else
      text += letter == '"' || letter == '\\' ? std::string("\\") + letter : std::string(1, letter);
  }
  return text + "\"";
}

}  // namespace aeroloom::study
