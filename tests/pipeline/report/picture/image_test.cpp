#include "pipeline/report/picture/image.hpp"

#include "pipeline/report/picture/palette.hpp"
#include "tests/several_ranks.hpp"

#include <cstring>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>
#include <png.h>

namespace aeroloom::picture {
namespace {

using parallel::Communicator;

/// Reads a PNG with the library's own simplified reader.
Image decode(const std::vector<std::uint8_t>& bytes) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  Image image;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size())) return image;
  png.format = PNG_FORMAT_RGB;
  image.width = static_cast<int>(png.width), image.height = static_cast<int>(png.height);
  image.pixels.resize(std::size_t{png.width} * png.height);
  if (!png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr)) image.pixels.clear();
  return image;
}

/// Triangles in many colours and depths, distributed to ranks.
Image scribble(const Communicator& communicator, int ranks) {
  Canvas canvas(97, 61);
  std::mt19937 random(7);
  const auto number = [&](double most) { return most * static_cast<double>(random()) / 4294967296.0; };
  for (int i = 0; i < 400; ++i) {
    std::array<ScreenPoint, 3> corners;
    for (ScreenPoint& p : corners) p = {number(97), number(61), number(50)};
    // Some have the same depth everywhere.
    if (i % 3 == 0) corners[0].depth = corners[1].depth = corners[2].depth = 20;
    const Colour colour{static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()), 90};
    if (i % ranks == communicator.rank()) canvas.draw_triangle(corners, {colour, colour});
  }
  return composite(communicator, std::move(canvas), white);
}

TEST(Composite, IsThePictureOfOneRank) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world();
  const Image together = scribble(world, world.size()), alone = scribble(Communicator::self(), 1);
  if (!world.is_root()) {
    EXPECT_TRUE(together.pixels.empty());
    return;
  }
  EXPECT_EQ(together.width, 97);
  EXPECT_EQ(together.height, 61);
  EXPECT_EQ(together.pixels, alone.pixels);
  EXPECT_EQ(encode_png(together, 1 << 20), encode_png(alone, 1 << 20));
}

/// What all ranks draw alike is behind and in front of what each has.
TEST(Composite, DrawsAlikeWithoutSending) {
  const Communicator world = Communicator::world();
  const auto half = [](double left, double depth) {
    return std::array<ScreenPoint, 3>{
        ScreenPoint{left, -1, depth}, {left + 200, -1, depth}, {left, 200, depth}};
  };
  const auto picture = [&](const Communicator& communicator, bool alike) {
    Canvas canvas(40, 30);
    const TriangleStyle blue{{0, 0, 200}}, grey{{90, 90, 90}};
    const auto draw_grey = [&](Canvas& on) { on.draw_triangle(half(20, 5), grey); };
    if (communicator.is_root()) canvas.draw_triangle(half(10, 9), blue);
    if (!alike && communicator.is_root()) draw_grey(canvas);
    return composite(communicator, std::move(canvas), white,
                     alike ? draw_grey : std::function<void(Canvas&)>());
  };
  EXPECT_EQ(picture(world, true).pixels, picture(world, false).pixels);
}

TEST(Composite, CanvasesLowerThanThereAreRanks) {
  const Communicator world = Communicator::world();
  Canvas canvas(3, 2);
  canvas.draw_triangle({{{-9, -9, 0}, {30, -9, 0}, {-9, 30, 0}}}, {ink, ink});
  const Image image = composite(world, std::move(canvas), white);
  EXPECT_EQ(image.pixels, std::vector<Colour>(world.is_root() ? 6 : 0, ink));
}

TEST(PngLocal, FewColoursComeBackExactly) {
  Image image{40, 30, {}};
  for (int i = 0; i < 40 * 30; ++i) {
    image.pixels.push_back(name_colours[static_cast<std::size_t>(i / 7) % name_colours.size()]);
  }
  const Image back = decode(encode_png(image, 1 << 20));
  EXPECT_EQ(back.width, 40);
  EXPECT_EQ(back.height, 30);
  EXPECT_EQ(back.pixels, image.pixels);
}

TEST(PngLocal, ManyColoursComeBackAboutRightAndFewerWhereBytesAreScarce) {
  Image image{256, 128, {}};
  for (int y = 0; y < 128; ++y) {
    for (int x = 0; x < 256; ++x) {
      image.pixels.push_back({static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(2 * y),
                              static_cast<std::uint8_t>((x * 37 + y * 91) % 64)});
    }
  }
  const Image back = decode(encode_png(image, 1 << 20));
  ASSERT_EQ(back.pixels.size(), image.pixels.size());
  double error = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    error += std::abs(back.pixels[i].red - image.pixels[i].red) +
             std::abs(back.pixels[i].green - image.pixels[i].green);
  }
  EXPECT_LT(error / static_cast<double>(image.pixels.size()), 24);
  const std::vector<std::uint8_t> all = encode_png(image, 1 << 20), half = encode_png(image, all.size() - 1);
  EXPECT_LT(half.size(), all.size());
  EXPECT_EQ(decode(half).pixels.size(), image.pixels.size());
}

TEST(PaletteLocal, HasAtMostTheColoursAskedFor) {
  Image image{64, 64, {}};
  std::mt19937 random(3);
  for (int i = 0; i < 64 * 64; ++i) {
    image.pixels.push_back({static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
                            static_cast<std::uint8_t>(random())});
  }
  for (const int most : {2, 16, 256}) {
    const PalettedImage few = quantise(image, most);
    EXPECT_LE(few.palette.size(), static_cast<std::size_t>(most));
    EXPECT_GT(few.palette.size(), static_cast<std::size_t>(most) / 2);
    EXPECT_EQ(few.pixels.size(), image.pixels.size());
  }
}

TEST(PaletteLocal, OneColourIsEnoughForOne) {
  const PalettedImage plain = quantise({5, 4, std::vector<Colour>(20, ink)}, 256);
  EXPECT_EQ(plain.palette, std::vector<Colour>{ink});
}

}  // namespace
}  // namespace aeroloom::picture
