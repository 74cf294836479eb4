#include "pipeline/case/option_keys.hpp"

#include "pipeline/case/key_info.hpp"

#include <cctype>
#include <map>
#include <string_view>

namespace aeroloom::cases {
namespace {

/// By option, as messages name it.
std::map<std::string, std::string> keys_of_options() {
  std::map<std::string, std::string> keys;
  for (const KeyInfo& key : case_keys()) {
    if (!key.doc.option.empty()) keys.emplace(key.doc.option, key.path);
  }
  return keys;
}

bool is_of_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

}  // namespace

std::string with_keys(std::string message) {
  static const std::map<std::string, std::string> keys = keys_of_options();
  constexpr std::string_view middle = "Options::";
  for (std::size_t at = message.find(middle); at != std::string::npos;) {
    std::size_t begin = at, end = at + middle.size();
    while (begin > 0 && is_of_name(message[begin - 1])) --begin;
    while (end < message.size() && is_of_name(message[end])) ++end;
    if (const auto found = keys.find(message.substr(begin, end - begin)); found != keys.end()) {
      message.replace(begin, end - begin, found->second);
      end = begin + found->second.size();
    }
    at = message.find(middle, end);
  }
  return message;
}

}  // namespace aeroloom::cases
