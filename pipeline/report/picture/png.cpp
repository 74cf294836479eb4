#include "pipeline/report/picture/palette.hpp"

#include <cstring>
#include <stdexcept>
#include <string>

#include <png.h>

namespace aeroloom::picture {
namespace {

struct Writer {
  png_structp file = nullptr;
  png_infop head = nullptr;
  ~Writer() { png_destroy_write_struct(&file, &head); }
};

[[noreturn]] void fail(png_structp, png_const_charp message) {
  throw std::runtime_error(std::string("PNG: ") + message);
}
void append(png_structp file, png_bytep data, std::size_t count) {
  auto* bytes = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(file));
  bytes->insert(bytes->end(), data, data + count);
}

std::vector<std::uint8_t> encode(const PalettedImage& image, int width, int height) {
  std::vector<std::uint8_t> bytes;
  Writer writer;
  writer.file = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
  if (writer.file != nullptr) writer.head = png_create_info_struct(writer.file);
  if (writer.head == nullptr) throw std::runtime_error("PNG: the library does not start");
  png_set_write_fn(writer.file, &bytes, append, [](png_structp) {});
  // Noise of small triangles goes best as it is.
  png_set_filter(writer.file, 0, PNG_FILTER_NONE);
  png_set_compression_level(writer.file, 6);
  png_set_IHDR(writer.file, writer.head, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> palette;
  for (const Colour& c : image.palette) palette.push_back({c.red, c.green, c.blue});
  png_set_PLTE(writer.file, writer.head, palette.data(), static_cast<int>(palette.size()));
  png_write_info(writer.file, writer.head);
  for (int y = 0; y < height; ++y) {
    png_write_row(writer.file, image.pixels.data() + static_cast<std::size_t>(y) * width);
  }
  png_write_end(writer.file, nullptr);
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image& image, std::size_t bytes) {
  constexpr int fewest = 16;  // colours, below which patches cannot be distinguished
  for (int colours = 256;; colours /= 2) {
    std::vector<std::uint8_t> png = encode(quantise(image, colours), image.width, image.height);
    if (png.size() <= bytes || colours == fewest) return png;
  }
}

}  // namespace aeroloom::picture
