#include "pipeline/report/picture_subject.hpp"

#include "parallel/communication/collective_error.hpp"
#include "pipeline/report/picture/image.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::report {
namespace {

using geometry::Box;
using geometry::Vec3;
using picture::Canvas;
using picture::Colour;
using picture::Place;
using picture::Scene;

/// Colours by area, the largest first. Those of a second and third round are lighter and darker.
void choose_colours(const mesh::DistributedMesh& surface, PictureSubject& subject) {
  constexpr std::size_t most_names = 36, rounds = 3;
  std::vector<std::size_t> order(surface.patches.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return subject.scene.patch_areas[a] > subject.scene.patch_areas[b];
  });
  subject.colours.assign(order.size(), picture::solid_grey);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!subject.scene.patches[order[i]]) continue;
    Colour colour = picture::name_colours[i % picture::name_colours.size()];
    const std::size_t round = i / picture::name_colours.size() % rounds;
    if (round == 1) colour = mix(colour, picture::white, 0.45);
    if (round == 2) colour = mix(colour, picture::ink, 0.3);
    subject.colours[order[i]] = colour;
    if (subject.patches.size() < most_names)
      subject.patches.push_back({surface.patches[order[i]], html_name(colour)});
  }
}

}  // namespace

PictureSubject find_subject(const PictureSource& source) {
  PictureSubject subject{source, picture::find_scene(source.surface, source.types), {}, {}, {}};
  subject.neighbours = picture::find_edge_neighbours(source.surface, subject.scene.shown);
  choose_colours(source.surface, subject);
  return subject;
}

Picture painted(const PictureSubject& subject, Picture picture, const std::function<void(Canvas&)>& draw,
                const std::function<void(Canvas&)>& draw_alike) {
  constexpr std::size_t bytes_of_picture = 240'000;  // a report of ten is a page that can be sent
  const parallel::Communicator& communicator = subject.source.surface.communicator;
  std::optional<Canvas> canvas;
  parallel::agree(communicator, [&] { draw(canvas.emplace(picture.width, picture.height)); });
  const picture::Image image =
      picture::composite(communicator, std::move(*canvas), picture::white, draw_alike);
  parallel::on_root(communicator, [&] { picture.png = picture::encode_png(image, bytes_of_picture); });
  return picture;
}

int height_for(const Box& seen, int least, int most) {
  const double ratio = seen.size().x > 0 ? seen.size().y / seen.size().x : 1;
  return std::clamp(static_cast<int>(std::lround(picture_width * ratio)) + 2 * picture_margin, least, most);
}

Vec3 main_direction(const Scene& scene) {
  Vec3 from{-1, -0.85, 0.62};
  for (int axis = 0; axis < 3; ++axis) {
    const double open = scene.open_towards[axis];
    if (std::abs(open) > half_open) from[axis] = std::copysign(from[axis], open);
  }
  return from;
}

double width_around(const PictureSubject& subject, const Place& place, double elements) {
  return std::min(elements * place.size, 0.5 * subject.scene.box.diagonal());
}

std::string width_text(const PictureSubject& subject, double length) {
  return fmt::format("{:.3g}{}{}", length, subject.source.unit.empty() ? "" : " ", subject.source.unit);
}

}  // namespace aeroloom::report
