/// Units of length as CAD files declare them. Seen by this folder only.
#pragma once

#include <string>

namespace aeroloom::cad {

struct LengthUnit {
  const char* name;  ///< as users write it
  double metres;
  const char* cad_name;  ///< as the CAD library's settings call it
  int iges_flag;         ///< in the global section of an IGES file
};

const LengthUnit& millimetre();
/// By any usual name ("metre", "INCH", "ft"), in either case; nullptr when unknown.
const LengthUnit* find_length_unit(std::string name);
const LengthUnit* find_length_unit(int iges_flag);

/// Makes the CAD library read and write lengths in this unit, unconverted when the file declares the same.
void set_cad_library_unit(const LengthUnit& unit);

}  // namespace aeroloom::cad
