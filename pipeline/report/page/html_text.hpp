/// Text and numbers for people, as they stand in report.html. Values come from report.json: what is absent or
/// null there becomes a dash.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace aeroloom::page {

using Json = nlohmann::ordered_json;

/// What is at a path such as "/mesh/volume"; null where there is nothing.
const Json& find(const Json& report, const std::string& path);
/// The number there, or `otherwise`.
double number(const Json& value, double otherwise = 0);
/// The text there; empty where there is none.
std::string text(const Json& value);

/// As report.json has it: bytes that are no UTF-8 are replaced.
std::string as_utf8(const std::string& bytes);

/// For the text of an element or a quoted attribute, whatever the characters are; `text` is UTF-8. Controls
/// but tab and line feed, which no page may have, become U+FFFD.
std::string escaped(std::string_view text);
/// A name of the CAD or the case: escaped, cut where it is very long, and kept from turning the direction of
/// the text around it.
std::string name(const Json& value);
/// A long text, escaped, cut at `most` bytes.
std::string long_text(const Json& value, std::size_t most = 20000);

std::string count(const Json& value);     ///< 1,384,540
std::string quantity(const Json& value);  ///< four digits: 387.7, 848,256, 8.5·10⁻⁷
std::string degrees(const Json& value);   ///< 28.0°
std::string ratio(const Json& value);     ///< 0.862
std::string seconds(const Json& value);   ///< 0.42 s, 7.4 s, 12 min 3 s
std::string memory(const Json& value);    ///< 466 MiB
std::string percent(double part);         ///< 0.15 %; rounding is 0 %
std::string place(const Json& point);     ///< (36.21, -0.02782, 6.727), HTML

/// "1 limit", "2 limits"; `plural` where an s does not make it.
std::string counted(const Json& value, const std::string& noun, const std::string& plural = "");

}  // namespace aeroloom::page
