/// Colours of patches and angles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace aeroloom::picture {

/// An sRGB colour.
struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(Colour, Colour) = default;
};

inline constexpr Colour white{255, 255, 255};
inline constexpr Colour ink{28, 32, 38};             ///< outlines
inline constexpr Colour solid_grey{208, 212, 217};   ///< a body in a cut
inline constexpr Colour layer_green{214, 232, 200};  ///< cells of boundary layers

/// Fewer to more layers, without any first; suits red-green blindness.
inline constexpr std::array<Colour, 5> layer_colours = {
    {{222, 72, 50}, {254, 218, 140}, {235, 243, 205}, {176, 213, 232}, {104, 158, 204}}};

/// Mixes `fraction` of b into a, from 0 to 1.
Colour mix(Colour a, Colour b, double fraction);
/// Makes a colour darker or lighter by a factor.
Colour lit(Colour colour, double brightness);
/// As in HTML: "#rrggbb".
std::string html_name(Colour colour);

/// Colours for named items, light enough to show lines. Adjacent ones differ in lightness, for viewers who
/// see few hues.
inline constexpr std::array<Colour, 12> name_colours = {{{112, 164, 210},
                                                         {236, 170, 72},
                                                         {86, 176, 148},
                                                         {222, 150, 188},
                                                         {240, 222, 118},
                                                         {138, 122, 188},
                                                         {166, 216, 236},
                                                         {204, 104, 82},
                                                         {176, 190, 92},
                                                         {178, 136, 98},
                                                         {84, 128, 146},
                                                         {196, 196, 200}}};

/// A class of smallest dihedral angles, in degrees.
struct AngleClass {
  double below;  ///< upper bound; the class before is the lower bound
  Colour colour;
  std::string_view name;
};
/// From red (flat) over yellow to blue (near the regular tetrahedron, 70.5 degrees); suits red-green
/// blindness.
inline constexpr std::array<AngleClass, 7> angle_classes = {{{5, {165, 15, 40}, "under 5°"},
                                                             {10, {222, 72, 50}, "5° to 10°"},
                                                             {20, {250, 150, 90}, "10° to 20°"},
                                                             {30, {254, 218, 140}, "20° to 30°"},
                                                             {40, {235, 243, 205}, "30° to 40°"},
                                                             {50, {176, 213, 232}, "40° to 50°"},
                                                             {400, {104, 158, 204}, "50° and more"}}};
std::size_t angle_class(double degrees);

}  // namespace aeroloom::picture
