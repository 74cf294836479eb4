#include "pipeline/report/page/html_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace aeroloom::page {
namespace {

constexpr const char* dash = "–";
constexpr std::size_t longest_name = 200;

/// Before the letter of UTF-8 that `end` is in.
std::size_t letter_before(std::string_view text, std::size_t end) {
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return end;
}

std::string cut(const std::string& text, std::size_t most) {
  return text.size() <= most ? text : text.substr(0, letter_before(text, most)) + " …";
}

/// Digits in groups of three.
std::string in_groups(const std::string& digits) {
  std::string grouped;
  const std::size_t sign = !digits.empty() && digits.front() == '-' ? 1 : 0;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > sign && (digits.size() - i) % 3 == 0) grouped += ',';
    grouped += digits[i];
  }
  return grouped;
}

std::string with_exponent(double value) {
  constexpr std::array<const char*, 10> raised = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string plain = fmt::format("{:.3g}", value);
  const std::size_t e = plain.find('e');
  if (e == std::string::npos) return plain;
  const int exponent = std::stoi(plain.substr(e + 1));
  std::string power = exponent < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(exponent)))
    power += raised.at(static_cast<std::size_t>(digit - '0'));
  return plain.substr(0, e) + "·10" + power;
}

}  // namespace

const Json& find(const Json& report, const std::string& path) {
  static const Json nothing;
  const Json::json_pointer pointer(path);
  return report.contains(pointer) ? report.at(pointer) : nothing;
}

double number(const Json& value, double otherwise) {
  return value.is_number() ? value.get<double>() : otherwise;
}

std::string text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::string as_utf8(const std::string& bytes) {
  return Json::parse(Json(bytes).dump(-1, ' ', false, Json::error_handler_t::replace)).get<std::string>();
}

std::string escaped(std::string_view text) {
  std::string safe;
  safe.reserve(text.size() + text.size() / 8);
  for (const char letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (letter == '&') {
      safe += "&amp;";
    } else if (letter == '<') {
      safe += "&lt;";
    } else if (letter == '>') {
      safe += "&gt;";
    } else if (letter == '"') {
      safe += "&quot;";
    } else if (letter == '\'') {
      safe += "&#39;";
    } else if ((code < 0x20 && letter != '\n' && letter != '\t') || code == 0x7F) {
      safe += "\xEF\xBF\xBD";
    } else {
      safe += letter;
    }
  }
  return safe;
}

std::string name(const Json& value) {
  return value.is_string() ? "<bdi>" + escaped(cut(text(value), longest_name)) + "</bdi>" : dash;
}

std::string long_text(const Json& value, std::size_t most) {
  return escaped(cut(text(value), most));
}

std::string count(const Json& value) {
  return value.is_number() ? in_groups(fmt::format("{:.0f}", value.get<double>())) : dash;
}

std::string quantity(const Json& value) {
  if (!value.is_number()) return dash;
  const double v = value.get<double>();
  const double size = std::abs(v);
  if (size == 0) return "0";
  if (size >= 99999.5 && size < 1e15) return count(value);
  if (size < 1e-3 || size >= 1e15) return with_exponent(v);
  return fmt::format("{:.4g}", size >= 9999.5 ? std::round(v) : v).find('e') != std::string::npos
             ? count(value)
             : fmt::format("{:.4g}", v);
}

std::string degrees(const Json& value) {
  if (!value.is_number()) return dash;
  const double v = value.get<double>();
  return v != 0 && std::abs(v) < 1 ? fmt::format("{:.2g}°", v) : fmt::format("{:.1f}°", v);
}

std::string ratio(const Json& value) {
  if (!value.is_number()) return dash;
  const double v = value.get<double>();
  return v != 0 && std::abs(v) < 0.01 ? quantity(value) : fmt::format("{:.3f}", v);
}

std::string seconds(const Json& value) {
  if (!value.is_number()) return dash;
  const double v = value.get<double>();
  if (v < 0.005) return "0 s";
  if (v < 0.995) return fmt::format("{:.2f} s", v);
  if (v < 99.95) return fmt::format("{:.1f} s", v);
  const auto whole = static_cast<long long>(std::llround(v));
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string memory(const Json& value) {
  if (!value.is_number()) return dash;
  constexpr std::array<const char*, 4> units = {"KiB", "MiB", "GiB", "TiB"};
  double v = value.get<double>() / 1024;
  std::size_t unit = 0;
  for (; v >= 999.5 && unit + 1 < units.size(); ++unit) v /= 1024;
  return fmt::format("{:.{}f} {}", v, v < 9.95 ? 1 : 0, units.at(unit));
}

std::string percent(double part) {
  const double v = 100 * part;
  if (std::abs(v) < 0.0005) return "0 %";
  return fmt::format("{:.{}f} %", v, std::abs(v) < 0.0995 ? 3 : std::abs(v) < 9.995 ? 2 : 1);
}

std::string place(const Json& point) {
  if (!point.is_array() || point.size() != 3) return dash;
  double largest = 0;
  for (const Json& c : point) largest = std::max(largest, std::abs(number(c)));
  std::string coordinates;
  for (const Json& c : point) {
    const double value = std::abs(number(c)) < 1e-9 * largest ? 0 : number(c);
    coordinates += fmt::format("{}{:.6g}", coordinates.empty() ? "" : ", ", value);
  }
  return fmt::format("<span class=\"place\">({})</span>", coordinates);
}

std::string counted(const Json& value, const std::string& noun, const std::string& plural) {
  const std::string many = plural.empty() ? noun + "s" : plural;
  return count(value) + " " + (number(value) == 1 ? noun : many);
}

}  // namespace aeroloom::page
