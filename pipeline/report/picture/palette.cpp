#include "pipeline/report/picture/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace aeroloom::picture {
namespace {

/// Colours fall into cells of 8 steps a side; each knows its pixels and the sum of their colours.
constexpr int bits = 5, cells_a_side = 1 << bits;
std::size_t cell_of(Colour c) {
  return static_cast<std::size_t>(c.red >> (8 - bits)) << (2 * bits) |
         static_cast<std::size_t>(c.green >> (8 - bits)) << bits |
         static_cast<std::size_t>(c.blue >> (8 - bits));
}

struct Cell {
  std::size_t index = 0;
  std::int64_t pixels = 0;
  std::array<std::int64_t, 3> sum = {0, 0, 0};

  double mean(int channel) const { return static_cast<double>(sum[channel]) / static_cast<double>(pixels); }
};

/// Cells [begin, end) that share a colour.
struct Group {
  std::size_t begin, end;
  int widest = 0;     ///< the channel in which they differ most
  double spread = 0;  ///< sum of squared distances from the mean in that channel
  std::array<double, 3> mean = {0, 0, 0};
};

Group measured(const std::vector<Cell>& cells, std::size_t begin, std::size_t end) {
  Group group{begin, end};
  for (int channel = 0; channel < 3; ++channel) {
    double pixels = 0, sum = 0, spread = 0;
    for (std::size_t i = begin; i < end; ++i) {
      pixels += static_cast<double>(cells[i].pixels), sum += static_cast<double>(cells[i].sum[channel]);
    }
    group.mean[channel] = sum / pixels;
    for (std::size_t i = begin; i < end; ++i) {
      const double off = cells[i].mean(channel) - group.mean[channel];
      spread += static_cast<double>(cells[i].pixels) * off * off;
    }
    if (spread > group.spread) group.widest = channel, group.spread = spread;
  }
  return group;
}

/// Cells up to the mean, and those beyond. Where the spread is not zero there are both.
std::pair<Group, Group> divided(std::vector<Cell>& cells, const Group& group) {
  const auto first = cells.begin() + static_cast<std::ptrdiff_t>(group.begin);
  const auto last = cells.begin() + static_cast<std::ptrdiff_t>(group.end);
  const auto middle = std::stable_partition(
      first, last, [&](const Cell& cell) { return cell.mean(group.widest) <= group.mean[group.widest]; });
  const auto split = static_cast<std::size_t>(middle - cells.begin());
  return {measured(cells, group.begin, split), measured(cells, split, group.end)};
}

std::vector<Cell> filled_cells(const Image& image) {
  std::vector<Cell> all(std::size_t{1} << (3 * bits));
  for (const Colour& c : image.pixels) {
    Cell& cell = all[cell_of(c)];
    ++cell.pixels;
    cell.sum[0] += c.red, cell.sum[1] += c.green, cell.sum[2] += c.blue;
  }
  for (std::size_t i = 0; i < all.size(); ++i) all[i].index = i;
  std::erase_if(all, [](const Cell& cell) { return cell.pixels == 0; });
  return all;
}

}  // namespace

PalettedImage quantise(const Image& image, int most) {
  std::vector<Cell> cells = filled_cells(image);
  PalettedImage result;
  if (cells.empty()) return result;
  std::vector<Group> groups{measured(cells, 0, cells.size())};
  while (groups.size() < static_cast<std::size_t>(most)) {
    const auto widest = std::max_element(groups.begin(), groups.end(),
                                         [](const Group& a, const Group& b) { return a.spread < b.spread; });
    constexpr double one_colour = 1e-6;  // squares of steps of a channel, times pixels: rounding
    if (!(widest->spread > one_colour)) break;
    const auto [low, high] = divided(cells, *widest);
    if (low.begin == low.end || high.begin == high.end) break;
    *widest = low;
    groups.push_back(high);
  }
  std::vector<std::uint8_t> colour_of_cell(std::size_t{1} << (3 * bits));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto rounded = [&](int channel) {
      return static_cast<std::uint8_t>(std::lround(groups[g].mean[channel]));
    };
    result.palette.push_back({rounded(0), rounded(1), rounded(2)});
    for (std::size_t i = groups[g].begin; i < groups[g].end; ++i) {
      colour_of_cell[cells[i].index] = static_cast<std::uint8_t>(g);
    }
  }
  result.pixels.reserve(image.pixels.size());
  for (const Colour& c : image.pixels) result.pixels.push_back(colour_of_cell[cell_of(c)]);
  return result;
}

}  // namespace aeroloom::picture
