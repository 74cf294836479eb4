/// Units of length that CAD files declare. Internal to cad/.
#pragma once

#include <string>

namespace aeroloom::cad {

struct LengthUnit {
  const char* name;  ///< as users write it
  double metres;
  const char* cad_name;  ///< name in the settings of the CAD library
  int iges_flag;         ///< number in the global section of an IGES file
};

const LengthUnit& millimetre();
/// Finds a unit by its name ("metre", "INCH", "ft"), in upper or lower case, or by its IGES number. nullptr
/// if it is unknown.
const LengthUnit* find_length_unit(std::string name);
const LengthUnit* find_length_unit(int iges_flag);

/// Makes the CAD library read and write files in this unit. Shapes are in `factor` of it; lengths of files in
/// the same unit are not converted for a factor of 1.
void set_cad_library_unit(const LengthUnit& unit, double factor);

/// The precision that the CAD library reads with: for a factor of 1 that of the file. Elsewhere `stated`, in
/// shapes' units, within bounds: files state absolute ones whatever their size.
void set_cad_library_precision(double factor, double stated);

}  // namespace aeroloom::cad
