#include "pipeline/commands/plain_words.hpp"

#include <string_view>

namespace aeroloom::pipeline {

namespace {

std::string about_path(const std::string& message) {
  constexpr std::string_view sign = "filesystem error: ";
  const std::size_t begin = message.find(sign);
  if (begin == std::string::npos) return message;
  const std::size_t text = begin + sign.size(), open = message.find(" [", text);
  if (open == std::string::npos) return message;
  const std::size_t colon = message.rfind(": ", open), close = message.find(']', open);
  if (colon == std::string::npos || colon < text || close == std::string::npos) return message;
  const std::string path = message.substr(open + 2, close - open - 2);
  std::string rest = message.substr(close + 1), to;
  if (rest.starts_with(" [") && rest.find(']') != std::string::npos) {
    const std::size_t end = rest.find(']');
    to = " to '" + rest.substr(2, end - 2) + "'";
    rest.erase(0, end + 1);
  }
  return message.substr(0, begin) + message.substr(text, colon - text) + " '" + path + "'" + to +
         message.substr(colon, open - colon) + rest;
}

}  // namespace

std::string plain_words(const std::string& message) {
  constexpr std::string_view no_reason = ": iostream error";
  std::string text = about_path(message);
  for (std::size_t at = text.find(no_reason); at != std::string::npos; at = text.find(no_reason))
    text.erase(at, no_reason.size());
  return text;
}

}  // namespace aeroloom::pipeline
