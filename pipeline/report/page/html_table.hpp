/// Tables, sections and other elements of an HTML page.
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
  std::string hint = {};  ///< explains the heading; plain text
};

/// A table that shows its first rows, then the number of hidden rows and the file that has them.
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

/// A section with heading; empty if `body` is empty. `id`: a word for links.
std::string section(const std::string& id, const std::string& title, const std::string& body);
/// A heading within a section, with its content; empty if `body` is empty.
std::string part(const std::string& title, const std::string& body);
std::string paragraph(const std::string& body);
/// A highlighted word; `kind`: good, fair, poor or plain.
std::string badge(const std::string& kind, const std::string& words);
/// A table of names and values, both HTML.
std::string facts(const std::vector<std::pair<std::string, std::string>>& rows);
/// A bar filled up to this fraction, 0 to 1.
std::string bar(double part);

}  // namespace aeroloom::page
