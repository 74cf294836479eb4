/// Names as a format can hold them.
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

/// The longest beginning of at most `bytes` bytes that ends between two characters of UTF-8; within one where
/// the text has no other place, for it is no UTF-8.
std::string cut_name(const std::string& name, std::size_t bytes);

/// Gives names one after another, no two alike.
class TakenNames {
public:
  /// Takes a name as it is; false where it is taken already.
  bool reserve(const std::string& name) { return _taken.insert(name).second; }

  /// `spell("")` where that is free, otherwise the first free one of spell("_2"), spell("_3"), ... `key`
  /// tells one way of spelling from others, so that many equal names take no time.
  std::string take(const std::string& key, const std::function<std::string(const std::string&)>& spell);

private:
  std::unordered_set<std::string> _taken;
  std::unordered_map<std::string, int> _numbers;  ///< by key: the last one tried
};

/// Each name as `fit` spells it, cut to `longest` bytes (cut_name), all distinct and none of `reserved`: a
/// name that fits stays, the others give way and get _2, _3, ... at their end. A function of the names alone.
std::vector<std::string> distinct_names(std::span<const std::string> names, std::size_t longest,
                                        const std::function<std::string(const std::string&)>& fit,
                                        std::span<const std::string_view> reserved = {});

}  // namespace aeroloom::io
