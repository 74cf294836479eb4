/// Which openings a case closes, whatever their width. Internal to cad/.
#pragma once

#include "cad/model/patches.hpp"
#include "geometry/vec.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// DomainOptions::close, with a memory of what was found.
class OpeningRules {
public:
  OpeningRules() = default;
  /// Boxes of the texts are in `unit`s of the shapes. Throws CadError for a box that is none, and for
  /// `refuse` beside others.
  explicit OpeningRules(const std::vector<std::string>& texts, double unit = 1);

  bool refuse() const { return _refuse; }
  bool empty() const { return _entries.empty(); }
  /// Whether an opening is named: by a face beside it, or by a box that contains its own.
  bool take(const std::vector<std::string>& names, const geometry::Box& box);
  /// Throws CadError for an entry that took no opening.
  void require_use() const;

private:
  struct Entry {
    std::string text;
    NamePattern pattern;
    std::optional<geometry::Box> box;
    bool used = false;
  };
  std::vector<Entry> _entries;
  bool _refuse = false;
};

}  // namespace aeroloom::cad
