/// Grid levels of the prediction workshops. Each level is a set of sizes relative to chords and span.
///
/// Letters A to F are those of the fourth AIAA high-lift prediction workshop (HLPW-4 with GMGW-3, gridding
/// guidelines V11.3). Words are those of HLPW-3 (V10). In the family `dpw` they are C, M, F, X of the eighth
/// drag prediction workshop (DPW-8, v3, 2024). The guidelines do not give a growth in the volume: it is 1.2
/// at B and at coarse. Within a family one factor scales every size and the logarithm of the growth. So
/// counts go with the cube of the factor.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace aeroloom::sizing {

/// From coarse to fine: first letters, then words.
enum class Level : std::uint8_t { a, b, c, d, e, f, coarse, medium, fine, extra };

/// The workshop that the words are from. Letters are always of HLPW.
enum class LevelFamily : std::uint8_t { hlpw, dpw };

/// Where a solver has its unknowns. The spacings of a level are meant between these.
enum class SolverPoints : std::uint8_t { vertex, cell };

/// Sizes of a level, as fractions and not as percent.
struct LevelSizes {
  double factor = 1;           ///< of all sizes and of ln(growth), relative to B or coarse
  double edge = 0;             ///< chordwise at leading and trailing edges, over the local chord
  double span = 0;             ///< spanwise at roots and tips, over the semispan
  double body = 0;             ///< largest on walls, over the reference chord
  int trailing_cells = 0;      ///< across a blunt trailing edge, at least
  double growth = 0;           ///< ratio of neighbouring sizes in the volume
  double far_field = 0;        ///< its distance, in semispans
  double wake = 0;             ///< its length behind a trailing edge, in local chords
  double curvature_angle = 0;  ///< degrees an element turns on curved faces; no guideline has it
};

/// Layers of prisms at walls that a level asks for.
struct LevelLayers {
  double y_plus = 0;        ///< of the first one's height
  double growth = 0;        ///< ratio of heights
  int constant_layers = 0;  ///< layers at the wall of equal height; 0: not specified
};

const char* name_of(Level level);
const char* name_of(LevelFamily family);

/// The levels of the same kind, letters or words, from coarse to fine.
std::span<const Level> levels_like(Level level);

/// The sizes of a level. Throws std::invalid_argument for letters with a family other than HLPW; words
/// without a family are of HLPW. Spacings between cell centres give larger sizes: a surface has half as many
/// points as triangles, so sizes are sqrt(2) times as large. Growth, counts of cells and lengths of the
/// domain do not change.
LevelSizes sizes_of(Level level, std::optional<LevelFamily> family = {},
                    SolverPoints points = SolverPoints::vertex);

/// The layers of a level. Throws as sizes_of().
LevelLayers layers_of(Level level, std::optional<LevelFamily> family = {});

}  // namespace aeroloom::sizing
