/// Elements of a page.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::page {

enum class Align { left, right };

struct Column {
  std::string head;  ///< HTML
  Align align = Align::left;
  std::string hint = {};  ///< plain text that explains the heading
};

/// A table whose first rows are shown; of the others it says how many there are and in which file.
class Table {
public:
  explicit Table(std::vector<Column> columns, std::string file = "report.json")
      : _columns(std::move(columns)), _file(std::move(file)) {}
  /// Cells are HTML.
  void add(const std::vector<std::string>& cells);
  bool empty() const { return _rows == 0; }
  std::string html() const;

private:
  std::vector<Column> _columns;
  std::string _file;
  std::string _shown;
  std::size_t _rows = 0;
};

/// A section with its heading; nothing where the body is empty. `id` is a word of our own.
std::string section(const std::string& id, const std::string& title, const std::string& body);
/// A heading within a section and what belongs to it; nothing where the body is empty.
std::string part(const std::string& title, const std::string& body);
std::string paragraph(const std::string& body);
/// A short word that stands out: `kind` is good, fair, poor or plain.
std::string badge(const std::string& kind, const std::string& words);
/// Names and values, two columns; both HTML.
std::string facts(const std::vector<std::pair<std::string, std::string>>& rows);
/// A bar that is filled to this fraction, 0 to 1.
std::string bar(double part);

}  // namespace aeroloom::page
