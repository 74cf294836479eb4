/// The built-in transport aircraft, given by its dimensions. It lets users try the program without a CAD
/// file.
#pragma once

namespace aeroloom::cad {

/// One half of a lifting surface. Its section is a four-digit NACA aerofoil.
struct LiftingSurface {
  double root_chord;      ///< m, at the symmetry plane
  double taper;           ///< tip chord over root chord, (0,1]
  double half_span;       ///< m, from the symmetry plane (fin: from the root) to the wing tip
  double sweep;           ///< degrees, of the leading edge
  double dihedral;        ///< degrees
  double thickness;       ///< maximum thickness over chord
  double camber;          ///< maximum camber over chord
  double root_incidence;  ///< degrees, nose up
  double tip_incidence;   ///< degrees, nose up
  double x;               ///< m, from the nose to the leading edge of the root
  double z;               ///< m, height of the root above the fuselage axis
  double trailing_edge;   ///< thickness of the blunt trailing edge over chord; 0 makes it sharp
};

/// Dimensions are in metres and degrees. x points aft, y to the right wing, z up; the origin is the nose. The
/// defaults give a single-aisle transport of about 38 m length and 34 m span.
struct TransportDimensions {
  double fuselage_length = 37.6;
  double fuselage_diameter = 3.95;
  double nose_length = 6.0;
  double tail_length = 12.5;
  double tail_upsweep = 0.75;  ///< m, rise of the fuselage axis at the tail end
  LiftingSurface wing{6.6, 0.27, 17.0, 27.0, 5.5, 0.12, 0.018, 2.0, -1.0, 12.2, -1.05, 0.012};
  LiftingSurface horizontal_tail{3.9, 0.36, 6.2, 32.0, 6.0, 0.10, 0.0, 0.0, 0.0, 31.6, 0.75, 0.016};
  LiftingSurface vertical_tail{5.6, 0.36, 6.3, 38.0, 0.0, 0.10, 0.0, 0.0, 0.0, 29.4, 1.0, 0.012};
};

}  // namespace aeroloom::cad
