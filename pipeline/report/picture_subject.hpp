/// What all pictures of a mesh have in common, and how one is painted.
#pragma once

#include "pipeline/report/picture/drawing.hpp"
#include "pipeline/report/picture/places.hpp"
#include "pipeline/report/pictures.hpp"

#include <functional>
#include <string>
#include <vector>

namespace aeroloom::report {

// Widths and heights (pixels), as directions and opacities, are a matter of taste, looked at in the pictures
// of the survey (docs/pictures/); nothing but the pictures depends on them.
inline constexpr int picture_width = 1000, detail_width = 800, detail_height = 560;
inline constexpr int most_height = 680;
inline constexpr int picture_margin = 15;
/// Of what is shown, where it is open: half a body.
inline constexpr double half_open = 0.02;

/// The subject of all pictures of a mesh, found once.
struct PictureSubject {
  const PictureSource& source;
  picture::Scene scene;
  picture::EdgeNeighbours neighbours;
  std::vector<picture::Colour> colours;  ///< by patch
  std::vector<LegendItem> patches;
};

/// Collective.
PictureSubject find_subject(const PictureSource& source);

/// `draw` puts on a canvas what this rank has, `draw_alike` what is the same on all. Collective; all ranks
/// learn of what is thrown on one by `draw`.
Picture painted(const PictureSubject& subject, Picture picture,
                const std::function<void(picture::Canvas&)>& draw,
                const std::function<void(picture::Canvas&)>& draw_alike = nullptr);

/// A height that suits what is to be seen.
int height_for(const geometry::Box& seen, int least, int most);
/// From upstream and above, on the side to which half a body is open.
geometry::Vec3 main_direction(const picture::Scene& scene);
/// How much of the surface a close-up shows: so many elements.
double width_around(const PictureSubject& subject, const picture::Place& place, double elements);
/// With the unit.
std::string width_text(const PictureSubject& subject, double length);

}  // namespace aeroloom::report
