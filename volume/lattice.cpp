#include "volume/volume_mesher.hpp"
