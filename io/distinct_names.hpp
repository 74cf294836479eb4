/// Names that a format allows, all different.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace aeroloom::io {

/// The longest beginning of at most `bytes` bytes that ends between two characters of UTF-8. Text that is no
/// UTF-8 may be cut anywhere.
std::string cut_name(const std::string& name, std::size_t bytes);

/// Gives names one after another, all different.
class TakenNames {
public:
  /// Takes a name as it is; false where it is already taken.
  bool reserve(const std::string& name) { return _taken.insert(name).second; }

  /// The first free one of spell(""), spell("_2"), spell("_3"), ... Calls with one `key` must spell the same
  /// names: the search then goes on at the last number, so many equal names cost little.
  std::string take(const std::string& key, const std::function<std::string(const std::string&)>& spell);

private:
  std::unordered_set<std::string> _taken;
  std::unordered_map<std::string, int> _numbers;  ///< by key: the last number that was tried
};

/// Each name as `fit` spells it, cut to `longest` bytes (cut_name), all different and none of `reserved`.
/// Names that need no change stay; the others get _2, _3, ... where their name is taken. The result depends
/// on the names alone.
std::vector<std::string> distinct_names(std::span<const std::string> names, std::size_t longest,
                                        const std::function<std::string(const std::string&)>& fit,
                                        std::span<const std::string_view> reserved = {});

}  // namespace aeroloom::io
