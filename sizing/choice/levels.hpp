/// Levels of grids as the prediction workshops have them: each a set of sizes relative to chords and span.
///
/// Letters are those of the fourth AIAA high-lift prediction workshop (HLPW-4 with GMGW-3, gridding
/// guidelines V11.3); words are those of HLPW-3 (V10) or, in the family `dpw`, C, M, F, X of the eighth drag
/// prediction workshop (DPW-8, v3, 2024). Growth in the volume, of which guidelines say nothing, is 1.2 at B
/// and at coarse; within a family every size and the logarithm of the growth scale by one factor, so counts
/// go with its cube.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace aeroloom::sizing {

/// From coarse to fine, letters and words.
enum class Level : std::uint8_t { a, b, c, d, e, f, coarse, medium, fine, extra };

/// Whose words they are; letters are HLPW's alone.
enum class LevelFamily : std::uint8_t { hlpw, dpw };

/// The place of a solver's unknowns, between which the spacings are meant.
enum class SolverPoints : std::uint8_t { vertex, cell };

/// What a level asks for. Fractions, not percent.
struct LevelSizes {
  double factor = 1;           ///< of all sizes and of ln(growth), over those of B or of coarse
  double edge = 0;             ///< chordwise at leading and trailing edges, over the local chord
  double span = 0;             ///< spanwise at roots and tips, over the semispan
  double body = 0;             ///< largest on walls, over the reference chord
  int trailing_cells = 0;      ///< across a blunt trailing edge, at least
  double growth = 0;           ///< ratio of neighbouring sizes in the volume
  double far_field = 0;        ///< its distance, in semispans
  double wake = 0;             ///< its length behind a trailing edge, in local chords
  double curvature_angle = 0;  ///< degrees an element turns on curved faces; no guideline has it
};

/// What a level asks of layers of prisms at walls.
struct LevelLayers {
  double y_plus = 0;        ///< of the first one's height
  double growth = 0;        ///< ratio of heights
  int constant_layers = 0;  ///< at the wall, as high as the first one; 0: nothing is said of them
};

const char* name_of(Level level);
const char* name_of(LevelFamily family);

/// The levels of the same kind, letters or words, from coarse to fine.
std::span<const Level> levels_like(Level level);

/// Letters, where another family than theirs is given, are refused: std::invalid_argument. Left out, words
/// are HLPW's. Between cell centres spacings are larger: as a surface has half as many points as triangles,
/// sizes are sqrt(2) times as large where they are meant so. Growth, counts of cells and lengths of the
/// domain stay.
LevelSizes sizes_of(Level level, std::optional<LevelFamily> family = {},
                    SolverPoints points = SolverPoints::vertex);

/// As above.
LevelLayers layers_of(Level level, std::optional<LevelFamily> family = {});

}  // namespace aeroloom::sizing
