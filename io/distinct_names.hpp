/// Names as a format can hold them.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::io {

/// Each name as `fit` spells it, cut to `longest` bytes between two characters of UTF-8, all distinct: a name
/// that fits stays, the others give way and get _2, _3, ... at their end. A function of the names alone.
std::vector<std::string> distinct_names(std::span<const std::string> names, std::size_t longest,
                                        const std::function<std::string(const std::string&)>& fit);

}  // namespace aeroloom::io
