#include "pipeline/report/picture/image.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace aeroloom::picture {
namespace {

/// Rows that a rank puts together.
struct Band {
  int begin, end;
};
Band band_of(parallel::Rank rank, int ranks, int height) {
  const auto border = [&](std::int64_t r) { return static_cast<int>(r * height / ranks); };
  return {border(rank), border(rank + 1)};
}

/// Samples one after another that are not empty; `first` counts from the start of the band.
struct RunHead {
  std::uint32_t first, count;
};

/// The drawn samples of a band: heads of runs, each followed by its samples.
parallel::Bytes pack_band(const std::uint64_t* samples, std::size_t count) {
  parallel::Bytes packed;
  const auto append = [&packed](const void* data, std::size_t bytes) {
    const auto* from = static_cast<const std::byte*>(data);
    packed.insert(packed.end(), from, from + bytes);
  };
  for (std::size_t i = 0, end = 0; i < count; i = end) {
    end = i + 1;
    if (samples[i] == Canvas::nothing) continue;
    while (end < count && samples[end] != Canvas::nothing) ++end;
    const RunHead head{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(end - i)};
    append(&head, sizeof head);
    append(samples + i, (end - i) * sizeof(std::uint64_t));
  }
  return packed;
}

void merge_band(const parallel::Bytes& packed, std::uint64_t* samples) {
  for (std::size_t at = 0; at < packed.size();) {
    RunHead head;
    std::memcpy(&head, packed.data() + at, sizeof head);
    at += sizeof head;
    for (std::uint32_t i = 0; i < head.count; ++i, at += sizeof(std::uint64_t)) {
      std::uint64_t sample;
      std::memcpy(&sample, packed.data() + at, sizeof sample);
      samples[head.first + i] = std::min(samples[head.first + i], sample);
    }
  }
}

/// The mean of the samples of each pixel.
std::vector<Colour> resolve(const Canvas& canvas, Band band, Colour background) {
  std::vector<Colour> pixels;
  pixels.reserve(static_cast<std::size_t>(band.end - band.begin) * canvas.width());
  for (int y = band.begin; y < band.end; ++y) {
    const std::uint64_t* sample = canvas.row(y);
    for (int x = 0; x < canvas.width(); ++x) {
      int red = 0, green = 0, blue = 0;
      for (int s = 0; s < Canvas::samples; ++s, ++sample) {
        const Colour colour = *sample == Canvas::nothing ? background : Canvas::colour_of(*sample);
        red += colour.red, green += colour.green, blue += colour.blue;
      }
      const auto mean = [](int sum) {
        return static_cast<std::uint8_t>((sum + Canvas::samples / 2) / Canvas::samples);
      };
      pixels.push_back({mean(red), mean(green), mean(blue)});
    }
  }
  return pixels;
}

}  // namespace

Image composite(const parallel::Communicator& communicator, Canvas canvas, Colour background,
                const std::function<void(Canvas&)>& draw_alike) {
  const int ranks = communicator.size();
  const auto sample_count = [&](Band band) {
    return static_cast<std::size_t>(band.end - band.begin) * canvas.width() * Canvas::samples;
  };
  std::vector<parallel::Parcel> parcels;
  for (parallel::Rank rank = 0; rank < ranks; ++rank) {
    if (rank == communicator.rank()) continue;
    const Band band = band_of(rank, ranks, canvas.height());
    if (band.begin == band.end) continue;
    parallel::Bytes packed = pack_band(canvas.row(band.begin), sample_count(band));
    if (!packed.empty()) parcels.push_back({rank, std::move(packed)});
  }
  const Band mine = band_of(communicator.rank(), ranks, canvas.height());
  for (const parallel::Parcel& parcel : communicator.exchange(std::move(parcels))) {
    merge_band(parcel.content, canvas.row(mine.begin));
  }
  if (draw_alike) draw_alike(canvas);
  const std::vector<Colour> pixels = resolve(canvas, mine, background);
  Image image;
  for (const parallel::Bytes& bytes :
       communicator.gather(parallel::to_bytes(std::span<const Colour>(pixels)))) {
    const std::vector<Colour> rows = parallel::from_bytes<Colour>(bytes);
    image.pixels.insert(image.pixels.end(), rows.begin(), rows.end());
  }
  if (communicator.is_root()) image.width = canvas.width(), image.height = canvas.height();
  return image;
}

}  // namespace aeroloom::picture
