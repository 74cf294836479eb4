/// Encodes bytes as text, for images in a page.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace aeroloom::page {

/// Base64 with padding (RFC 4648).
std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace aeroloom::page
