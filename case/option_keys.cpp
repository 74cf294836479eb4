#include "aeroloom/case/option_keys.hpp"

#include <string_view>
#include <utility>

namespace aeroloom::cases {
namespace {

/// Keys are named like the members, but for the first ones.
constexpr std::pair<std::string_view, std::string_view> sections[] = {
    {"DomainOptions::kind", "geometry.domain"}, {"DomainOptions::", "geometry."},
    {"FarFieldOptions::", "farfield."},         {"SizingOptions::", "sizing."},
    {"SurfaceOptions::", "surface."},           {"VolumeOptions::", "volume."},
    {"ImproveOptions::", "improve."},
};

}  // namespace

std::string with_keys(std::string message) {
  for (const auto& [member, key] : sections) {
    for (std::size_t at = message.find(member); at != std::string::npos;
         at = message.find(member, at + key.size()))
      message.replace(at, member.size(), key);
  }
  return message;
}

}  // namespace aeroloom::cases
