#include "io/vtk_writer.hpp"
