#include "pipeline/report/pictures.hpp"

#include "mesh/data/bounds.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "pipeline/report/picture/drawing.hpp"
#include "pipeline/report/picture/image.hpp"
#include "pipeline/report/picture/places.hpp"

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
using parallel::Communicator;
using picture::Camera;
using picture::Canvas;
using picture::Colour;
using picture::Place;
using picture::Plane;
using picture::Scene;
using picture::Viewpoint;
using picture::Window;

// Widths, heights, margins (pixels), opacities and directions are a matter of taste, looked at in the
// pictures of the survey (docs/pictures/); nothing but the pictures depends on them.

constexpr std::size_t bytes_of_picture = 240'000;  // a report of ten is a page that can be sent
constexpr int width = 1000, detail_width = 800, detail_height = 560;
constexpr int least_height_of_body = 420, least_height_of_cut = 360, most_height = 680;
constexpr int margin = 15;
/// Elements across a close-up, and across the cut beside it: each is seen as a triangle, and what it belongs
/// to too.
constexpr double elements_across = 40, elements_across_cut = 36;
/// Of what is shown, where it is open: half a body.
constexpr double half = 0.02;
/// Of the diagonal: a plane of symmetry is cut just inside, where there are tetrahedra; a middle that is
/// nearer to zero is zero.
constexpr double just_inside = 1e-7, as_good_as_zero = 1e-3;
constexpr double no_extent = 1e-300;  // in place of nothing, to divide by

/// The subject of all pictures of a mesh, found once.
struct Subject {
  const Communicator& communicator;
  const PictureSource& source;
  Scene scene;
  picture::EdgeNeighbours neighbours;
  std::vector<Colour> colours;  ///< by patch
  std::vector<LegendItem> patches;
};

/// Colours by area, the largest first. Those of a second and third round are lighter and darker.
void choose_colours(const mesh::DistributedMesh& surface, Subject& subject) {
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

Subject find_subject(const Communicator& communicator, const PictureSource& source) {
  Subject subject{communicator, source, picture::find_scene(source.surface, source.types), {}, {}, {}};
  subject.neighbours = picture::find_edge_neighbours(source.surface, subject.scene.shown);
  choose_colours(source.surface, subject);
  return subject;
}

/// Collective.
std::vector<LegendItem> legend_of_cuts(const mesh::DistributedMesh& volume) {
  const Communicator& communicator = volume.communicator;
  std::vector<LegendItem> legend;
  legend.reserve(picture::angle_classes.size());
  for (const picture::AngleClass& each : picture::angle_classes) {
    legend.push_back({fmt::format("smallest dihedral angle {}", each.name), html_name(each.colour)});
  }
  const bool layered = std::any_of(volume.pieces.begin(), volume.pieces.end(),
                                   [](const mesh::Piece& piece) { return !piece.layers.empty(); });
  if (communicator.maximum(std::int64_t{layered}) > 0)
    legend.push_back({"boundary layers", html_name(picture::layer_green)});
  return legend;
}

/// `draw` puts on a canvas what this rank has, `draw_alike` what is the same on all. Collective; all ranks
/// learn of what is thrown on one by `draw`.
Picture painted(const Communicator& communicator, Picture picture, const std::function<void(Canvas&)>& draw,
                const std::function<void(Canvas&)>& draw_alike = nullptr) {
  std::optional<Canvas> canvas;
  parallel::agree(communicator, [&] { draw(canvas.emplace(picture.width, picture.height)); });
  const picture::Image image =
      picture::composite(communicator, std::move(*canvas), picture::white, draw_alike);
  parallel::on_root(communicator, [&] { picture.png = picture::encode_png(image, bytes_of_picture); });
  return picture;
}

/// The box of what is shown in coordinates of the view. Collective.
Box seen_from(const Subject& subject, const Viewpoint& view) {
  Box mine;
  const std::vector<mesh::Piece>& pieces = subject.source.surface.pieces;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (mesh::LocalIndex t = 0; t < pieces[p].cell_count(); ++t) {
      if (!subject.scene.shown[p][t]) continue;
      for (int k = 0; k < 3; ++k) mine.add(in_view(view, pieces[p].point(pieces[p].cell(t)[k])));
    }
  }
  return mesh::box_over_ranks(subject.communicator, mine);
}

/// A height that suits what is to be seen.
int height_for(const Box& seen, int least, int most) {
  const double ratio = seen.size().x > 0 ? seen.size().y / seen.size().x : 1;
  return std::clamp(static_cast<int>(std::lround(width * ratio)) + 2 * margin, least, most);
}

/// From upstream and above, on the side to which half a body is open.
Vec3 main_direction(const Scene& scene) {
  Vec3 from{-1, -0.85, 0.62};
  for (int axis = 0; axis < 3; ++axis) {
    const double open = scene.open_towards[axis];
    if (std::abs(open) > half) from[axis] = std::copysign(from[axis], open);
  }
  return from;
}

constexpr Vec3 up{0, 0, 1};

Picture body_picture(const Subject& subject) {
  const Viewpoint view = picture::look_from(main_direction(subject.scene), up);
  const Box seen = seen_from(subject, view);
  const int height = height_for(seen, least_height_of_body, most_height);
  const Camera camera = picture::frame(view, seen, {0, 0, width, height}, margin);
  const std::string what = subject.scene.has_body ? "The body in the flow" : "The walls, seen from inside";
  return painted(subject.communicator,
                 {.name = "body",
                  .caption = what + ", by patch.",
                  .width = width,
                  .height = height,
                  .legend = subject.patches},
                 [&](Canvas& canvas) {
                   draw_surface(canvas, camera, subject.source.surface, subject.neighbours, subject.scene,
                                {subject.colours, 0, 1.3});
                 });
}

/// Two rows and two columns of views to one scale but for the last.
Picture views_picture(const Subject& subject) {
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
  const double scale = std::min((width - 4 * gap) / wide, (most - 4 * gap) / tall);
  const int left = static_cast<int>(width * seen[2].size().x / wide);
  const double view_from_aft = (width - left) * seen[1].size().y / std::max(seen[1].size().x, no_extent);
  const int lower = static_cast<int>(std::lround(scale * seen[2].size().y + 2 * gap));
  const int upper = static_cast<int>(
      std::lround(std::max(scale * seen[0].size().y + 2 * gap,
                           std::min(view_from_aft + 2 * gap, static_cast<double>(most - lower)))));
  const std::array<Window, 4> windows = {{{0, 0, left, upper},
                                          {left, 0, width - left, upper},
                                          {0, upper, left, lower},
                                          {left, upper, width - left, lower}}};
  return painted(
      subject.communicator,
      {.name = "views",
       .caption =
           "From above, from the side and from the front to one scale; upper right: from behind and below.",
       .width = width,
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

std::string width_text(const Subject& subject, double length) {
  return fmt::format("{:.3g}{}{}", length, subject.source.unit.empty() ? "" : " ", subject.source.unit);
}
std::string point_text(Vec3 p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z);
}

/// How much of the surface a close-up shows: so many elements.
double width_around(const Subject& subject, const Place& place, double elements) {
  return std::min(elements * place.size, 0.5 * subject.scene.box.diagonal());
}

/// A direction along the line, towards who looks from the main direction.
Vec3 towards_viewer(const Subject& subject, Vec3 along) {
  return dot(along, main_direction(subject.scene)) < 0 ? -along : along;
}

/// The place lies a little off the middle, so that more of the body is seen and less of what is behind it.
Picture close_up_picture(const Subject& subject, const Place& place, Vec3 from, std::string name,
                         const std::string& what) {
  const double across = width_around(subject, place, elements_across);
  const Viewpoint view = picture::look_from(from, up);
  const Vec3 inwards = dot(place.normal, view.towards) * view.towards - place.normal;
  const Camera camera = picture::close_up(view, place.point + 0.25 * across * inwards, across,
                                          {0, 0, detail_width, detail_height});
  return painted(subject.communicator,
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

Picture leading_edge_picture(const Subject& subject, const Place& place) {
  const Vec3 main = main_direction(subject.scene);
  Vec3 side = cross(place.along, place.normal);
  if (dot(side, Vec3{0, 0.3 * main.y, main.z}) < 0) side = -side;
  const Vec3 from = place.normal + 0.4 * side + 0.3 * towards_viewer(subject, place.along);
  return close_up_picture(subject, place, from, "leading_edge",
                          place.upstream ? "a leading edge" : "the sharpest place");
}

Picture junction_picture(const Subject& subject, const Place& place) {
  const Vec3 from = place.normal + 0.45 * normalized(main_direction(subject.scene));
  return close_up_picture(subject, place, from, "junction", "a junction");
}

/// A plane and how one looks at it.
struct Cut {
  Plane plane;
  Viewpoint view;
};

/// Looks at a plane so that x goes to the right and z upwards as far as they lie in it.
Cut look_at_plane(Vec3 normal, double offset) {
  const Vec3 upwards = std::abs(normal.z) > 0.9 ? Vec3{0, 1, 0} : up;
  Viewpoint view = picture::look_from(normal, upwards);
  if (view.right.x < -0.1) view = picture::look_from(-normal, upwards);
  return {{normal, offset}, view};
}

Cut main_cut(const Scene& scene) {
  for (const int axis : {1, 2, 0}) {
    const double open = scene.open_towards[axis];
    if (!scene.has_body || std::abs(open) <= half) continue;
    // Just inside of the plane that half a body ends at.
    const double end = open > 0 ? scene.box.low[axis] : scene.box.high[axis];
    Vec3 normal;
    normal[axis] = std::copysign(1, open);
    return look_at_plane(normal, normal[axis] * end + just_inside * scene.box.diagonal());
  }
  int axis = 1;
  if (!scene.has_body) {
    const Vec3 size = scene.box.size();
    constexpr double shorter = 0.999;  // by more than rounding, or y is across as on an aircraft
    for (const int other : {2, 0}) axis = size[other] < shorter * size[axis] ? other : axis;
  }
  Vec3 normal;
  normal[axis] = 1;
  const double middle = scene.box.center()[axis];
  return look_at_plane(normal, std::abs(middle) < as_good_as_zero * scene.box.diagonal() ? 0 : middle);
}

Picture painted_cut(const Subject& subject, const mesh::DistributedMesh& volume, const Plane& plane,
                    const Camera& camera, std::string name, std::string caption) {
  if (subject.scene.has_body) caption += " The body is grey.";
  return painted(
      subject.communicator,
      {.name = std::move(name),
       .caption = std::move(caption),
       .width = camera.window.width,
       .height = camera.window.height,
       .legend = legend_of_cuts(volume)},
      [&](Canvas& canvas) {
        draw_cut(canvas, camera, volume, plane, 0.8);
        draw_section(canvas, camera, subject.source.surface, subject.scene, plane, 2);
      },
      [&](Canvas& canvas) {
        if (subject.scene.has_body) draw_backdrop(canvas, camera, subject.scene.box, picture::solid_grey);
      });
}

Picture cut_picture(const Subject& subject, const mesh::DistributedMesh& volume) {
  const Cut cut = main_cut(subject.scene);
  const auto box_in_view = [&](const Box& box) {
    Box seen;
    for (int corner = 0; corner < 8; ++corner) {
      seen.add(in_view(cut.view, {corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                  corner & 4 ? box.high.z : box.low.z}));
    }
    return seen;
  };
  Box seen = box_in_view(subject.scene.box);
  if (subject.scene.has_body) {
    const Box domain = box_in_view(subject.scene.domain);
    seen = seen.dilated(0.15 * std::max(seen.size().x, seen.size().y));
    for (int axis = 0; axis < 3; ++axis) {
      seen.low[axis] = std::max(seen.low[axis], domain.low[axis]);
      seen.high[axis] = std::min(seen.high[axis], domain.high[axis]);
    }
  }
  const int height = height_for(seen, least_height_of_cut, most_height);
  const double around = subject.scene.has_body ? 0 : margin;
  const Camera camera = picture::frame(cut.view, seen, {0, 0, width, height}, around);
  return painted_cut(subject, volume, cut.plane, camera, "cut",
                     fmt::format("The tetrahedra that a plane cuts, {}.",
                                 subject.scene.has_body ? "around the body" : "from wall to wall"));
}

Picture leading_edge_cut_picture(const Subject& subject, const mesh::DistributedMesh& volume,
                                 const Place& place) {
  const double across = width_around(subject, place, elements_across_cut);
  const Cut cut = look_at_plane(place.along, dot(place.along, place.point));
  const Camera camera = picture::close_up(cut.view, place.point, across, {0, 0, detail_width, detail_height});
  return painted_cut(
      subject, volume, cut.plane, camera, "leading_edge_cut",
      fmt::format("The tetrahedra that a plane across {} cuts; the picture is {} wide.",
                  place.upstream ? "the leading edge" : "the sharpest place", width_text(subject, across)));
}

std::vector<Picture> make_all(const Communicator& communicator, const PictureSource& source,
                              const mesh::DistributedMesh* volume) {
  const Subject subject = find_subject(communicator, source);
  const auto& surface = source.surface;
  const std::optional<Place> edge = find_leading_edge(surface, subject.neighbours, subject.scene);
  const std::optional<Place> junction = find_junction(surface, subject.neighbours, subject.scene);
  std::vector<Picture> pictures{body_picture(subject), views_picture(subject)};
  if (edge) pictures.push_back(leading_edge_picture(subject, *edge));
  if (junction) pictures.push_back(junction_picture(subject, *junction));
  if (volume != nullptr) pictures.push_back(cut_picture(subject, *volume));
  if (volume != nullptr && edge) pictures.push_back(leading_edge_cut_picture(subject, *volume, *edge));
  if (!communicator.is_root()) pictures.clear();
  return pictures;
}

}  // namespace

std::vector<Picture> pictures_or_warning(const Communicator& communicator,
                                         const mesh::DistributedMesh* volume, const PictureSource& source) {
  std::string problem;
  try {
    return make_all(communicator, source, volume);
  } catch (const std::bad_alloc&) {
    parallel::give_up_without_memory();  // not agreed on: the others wait for this rank
    problem = parallel::out_of_memory_text();
  } catch (const std::exception& error) {
    problem = error.what();
  }
  if (communicator.is_root()) parallel::log_warning(fmt::format("the report has no pictures: {}", problem));
  return {};
}

}  // namespace aeroloom::report
