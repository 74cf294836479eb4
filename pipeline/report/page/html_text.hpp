/// Formats values of report.json for a page. An absent or null value becomes a dash.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace aeroloom::page {

using Json = nlohmann::ordered_json;

/// The value at a path such as "/mesh/volume"; null if there is none.
const Json& find(const Json& report, const std::string& path);
/// The number at the path, or `otherwise`.
double number(const Json& value, double otherwise = 0);
/// The text at the path, or an empty text.
std::string text(const Json& value);

/// Replaces bytes that are no UTF-8, as report.json does.
std::string as_utf8(const std::string& bytes);

/// Escapes UTF-8 text for an element or a quoted attribute. Control characters except tab and line feed
/// become U+FFFD, because HTML forbids them.
std::string escaped(std::string_view text);
/// A name from CAD or case: escaped, shortened if long, and isolated from the text direction around it.
std::string name(const Json& value);
/// An escaped text, cut after `most` bytes.
std::string long_text(const Json& value, std::size_t most = 20000);

std::string count(const Json& value);     ///< 1,384,540
std::string quantity(const Json& value);  ///< four digits: 387.7, 848,256, 8.5·10⁻⁷
std::string degrees(const Json& value);   ///< 28.0°
std::string ratio(const Json& value);     ///< 0.862
std::string seconds(const Json& value);   ///< 0.42 s, 7.4 s, 12 min 3 s
std::string memory(const Json& value);    ///< 466 MiB
std::string percent(double part);         ///< 0.15 %; differences by rounding are 0 %
std::string place(const Json& point);     ///< (36.21, -0.02782, 6.727), HTML

/// "1 limit", "2 limits"; `plural`: for words whose plural has no plain s.
std::string counted(const Json& value, const std::string& noun, const std::string& plural = "");

}  // namespace aeroloom::page
