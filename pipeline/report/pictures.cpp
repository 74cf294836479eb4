#include "pipeline/report/pictures.hpp"

#include "mesh/data/bounds.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "pipeline/report/cut_pictures.hpp"
#include "pipeline/report/picture_subject.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <new>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::report {
namespace {

using geometry::Box;
using geometry::Vec3;
using picture::Camera;
using picture::Canvas;
using picture::Colour;
using picture::Place;
using picture::Viewpoint;
using picture::Window;

constexpr int least_height_of_body = 420;
/// Elements across a close-up: each is seen as a triangle, and what it belongs to too.
constexpr double elements_across = 40;
constexpr double no_extent = 1e-300;  // in place of nothing, to divide by

constexpr Vec3 up{0, 0, 1};

/// The box of what is shown in coordinates of the view. Collective.
Box seen_from(const PictureSubject& subject, const Viewpoint& view) {
  Box mine;
  const std::vector<mesh::Piece>& pieces = subject.source.surface.pieces;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (mesh::LocalIndex t = 0; t < pieces[p].cell_count(); ++t) {
      if (!subject.scene.shown[p][t]) continue;
      for (int k = 0; k < 3; ++k) mine.add(in_view(view, pieces[p].point(pieces[p].cell(t)[k])));
    }
  }
  return mesh::box_over_ranks(subject.source.surface.communicator, mine);
}

std::string point_text(Vec3 p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

Picture body_picture(const PictureSubject& subject) {
  const Viewpoint view = picture::look_from(main_direction(subject.scene), up);
  const Box seen = seen_from(subject, view);
  const int height = height_for(seen, least_height_of_body, most_height);
  const Camera camera = picture::frame(view, seen, {0, 0, picture_width, height}, picture_margin);
  const std::string what = subject.scene.has_body ? "The body in the flow" : "The walls, seen from inside";
  return painted(subject,
                 {.name = "body",
                  .caption = what + ", by patch.",
                  .width = picture_width,
                  .height = height,
                  .legend = subject.patches},
                 [&](Canvas& canvas) {
                   draw_surface(canvas, camera, subject.source.surface, subject.neighbours, subject.scene,
                                {subject.colours, 0, 1.3});
                 });
}

/// The body, coloured by its number of layers in quarters of the largest. Collective.
Picture layers_picture(const PictureSubject& subject) {
  const PictureSource& source = subject.source;
  std::int64_t most = 0;
  for (const std::vector<std::int32_t>& of_piece : source.layers) {
    for (const std::int32_t layers : of_piece) most = std::max<std::int64_t>(most, layers);
  }
  most = source.surface.communicator.maximum(most);
  constexpr std::int64_t bands = picture::layer_colours.size() - 1;
  const auto band_of = [&](std::int64_t layers) {
    return layers == 0 ? 0 : 1 + (bands * (layers - 1)) / most;
  };
  std::vector<std::vector<Colour>> colours;
  for (const std::vector<std::int32_t>& of_piece : source.layers) {
    std::vector<Colour>& mine = colours.emplace_back();
    for (const std::int32_t layers : of_piece)
      mine.push_back(layers < 0 ? picture::solid_grey : picture::layer_colours[band_of(layers)]);
  }
  std::vector<LegendItem> legend{{"no layers", html_name(picture::layer_colours[0])}};
  for (std::int64_t band = 1; band <= bands; ++band) {
    const std::int64_t low = (most * (band - 1) + bands - 1) / bands + 1,
                       high = (most * band + bands - 1) / bands;
    if (low > high) continue;
    legend.push_back(
        {low == high ? fmt::format("{} layers", high) : fmt::format("{} to {} layers", low, high),
         html_name(picture::layer_colours[band])});
  }
  const Viewpoint view = picture::look_from(main_direction(subject.scene), up);
  const Box seen = seen_from(subject, view);
  const int height = height_for(seen, least_height_of_body, most_height);
  const Camera camera = picture::frame(view, seen, {0, 0, picture_width, height}, picture_margin);
  return painted(subject,
                 {.name = "layers",
                  .caption = "The number of boundary layers. Walls without a request are grey.",
                  .width = picture_width,
                  .height = height,
                  .legend = std::move(legend)},
                 [&](Canvas& canvas) {
                   draw_surface(canvas, camera, source.surface, subject.neighbours, subject.scene,
                                {subject.colours, 0.5, 1.3, &colours});
                 });
}

/// Two rows and two columns of views to one scale but for the last.
Picture views_picture(const PictureSubject& subject) {
  const Vec3 from = main_direction(subject.scene);
  const Vec3 side{0, std::copysign(1, from.y), 0}, front{std::copysign(1, from.x), 0, 0};
  const std::array<Viewpoint, 4> views = {picture::look_from({0, 0, std::copysign(1, from.z)}, {0, 1, 0}),
                                          picture::look_from({-from.x, from.y, -0.7 * from.z}, up),
                                          picture::look_from(side, up), picture::look_from(front, up)};
  std::array<Box, 4> seen;
  for (int i = 0; i < 4; ++i) seen[i] = seen_from(subject, views[i]);
  constexpr double gap = 12;
  constexpr int most = most_height;
  // Beside a slender body there is room for the view from behind all the same.
  const double right = std::max(seen[3].size().x, 0.5 * seen[2].size().x);
  const double wide = seen[2].size().x + right, tall = seen[0].size().y + seen[2].size().y;
  const double scale = std::min((picture_width - 4 * gap) / wide, (most - 4 * gap) / tall);
  const int left = static_cast<int>(picture_width * seen[2].size().x / wide);
  const double view_from_aft =
      (picture_width - left) * seen[1].size().y / std::max(seen[1].size().x, no_extent);
  const int lower = static_cast<int>(std::lround(scale * seen[2].size().y + 2 * gap));
  const int upper = static_cast<int>(
      std::lround(std::max(scale * seen[0].size().y + 2 * gap,
                           std::min(view_from_aft + 2 * gap, static_cast<double>(most - lower)))));
  const std::array<Window, 4> windows = {{{0, 0, left, upper},
                                          {left, 0, picture_width - left, upper},
                                          {0, upper, left, lower},
                                          {left, upper, picture_width - left, lower}}};
  return painted(
      subject,
      {.name = "views",
       .caption =
           "From above, from the side and from the front to one scale; upper right: from behind and below.",
       .width = picture_width,
       .height = upper + lower,
       .legend = subject.patches},
      [&](Canvas& canvas) {
        for (int i = 0; i < 4; ++i) {
          Camera camera = picture::frame(views[i], seen[i], windows[i], gap);
          if (i != 1) camera.scale = scale;
          draw_surface(canvas, camera, subject.source.surface, subject.neighbours, subject.scene,
                       {subject.colours, 0, 1.0});
        }
      });
}

/// A direction along the line, towards who looks from the main direction.
Vec3 towards_viewer(const PictureSubject& subject, Vec3 along) {
  return dot(along, main_direction(subject.scene)) < 0 ? -along : along;
}

/// The place lies a little off the middle, so that more of the body is seen and less of what is behind it.
Picture close_up_picture(const PictureSubject& subject, const Place& place, Vec3 from, std::string name,
                         const std::string& what) {
  const double across = width_around(subject, place, elements_across);
  const Viewpoint view = picture::look_from(from, up);
  const Vec3 inwards = dot(place.normal, view.towards) * view.towards - place.normal;
  const Camera camera = picture::close_up(view, place.point + 0.25 * across * inwards, across,
                                          {0, 0, detail_width, detail_height});
  return painted(subject,
                 {.name = std::move(name),
                  .caption = fmt::format("The triangles at {}, around {}; the picture is {} wide.", what,
                                         point_text(place.point), width_text(subject, across)),
                  .width = detail_width,
                  .height = detail_height,
                  .legend = subject.patches},
                 [&](Canvas& canvas) {
                   canvas.set_nearest(-0.75 * detail_width);  // what stands in front
                   draw_surface(canvas, camera, subject.source.surface, subject.neighbours, subject.scene,
                                {subject.colours, 0.85, 2.0});
                 });
}

Picture leading_edge_picture(const PictureSubject& subject, const Place& place) {
  const Vec3 main = main_direction(subject.scene);
  Vec3 side = cross(place.along, place.normal);
  if (dot(side, Vec3{0, 0.3 * main.y, main.z}) < 0) side = -side;
  const Vec3 from = place.normal + 0.4 * side + 0.3 * towards_viewer(subject, place.along);
  return close_up_picture(subject, place, from, "leading_edge",
                          place.upstream ? "a leading edge" : "the sharpest place");
}

Picture junction_picture(const PictureSubject& subject, const Place& place) {
  const Vec3 from = place.normal + 0.45 * normalized(main_direction(subject.scene));
  return close_up_picture(subject, place, from, "junction", "a junction");
}

std::vector<Picture> make_all(const PictureSource& source, const mesh::DistributedMesh* volume) {
  const PictureSubject subject = find_subject(source);
  const mesh::NumberedMesh& surface = source.surface;
  const std::optional<Place> edge = find_leading_edge(surface, subject.neighbours, subject.scene);
  const std::optional<Place> junction = find_junction(surface, subject.neighbours, subject.scene);
  std::vector<Picture> pictures{body_picture(subject), views_picture(subject)};
  if (edge) pictures.push_back(leading_edge_picture(subject, *edge));
  if (junction) pictures.push_back(junction_picture(subject, *junction));
  if (volume != nullptr) pictures.push_back(cut_picture(subject, *volume));
  if (volume != nullptr && edge) pictures.push_back(leading_edge_cut_picture(subject, *volume, *edge));
  const auto has_layers = static_cast<std::int64_t>(!source.layers.empty());
  if (volume != nullptr && surface.communicator.maximum(has_layers) > 0)
    pictures.push_back(layers_picture(subject));
  if (!surface.communicator.is_root()) pictures.clear();
  return pictures;
}

}  // namespace

std::vector<Picture> pictures_or_warning(const PictureSource& source, const mesh::DistributedMesh* volume) {
  std::string problem;
  try {
    return make_all(source, volume);
  } catch (const std::bad_alloc&) {
    parallel::give_up_without_memory();  // not agreed on: the others wait for this rank
    problem = parallel::out_of_memory_text();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (source.surface.communicator.is_root())
    parallel::log_warning(fmt::format("the report has no pictures: {}", problem));
  return {};
}

}  // namespace aeroloom::report
