#include "geometry/vec.hpp"
