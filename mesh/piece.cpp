#include "mesh/piece.hpp"
#include "mesh/validity.hpp"
#include "mesh/quality.hpp"
