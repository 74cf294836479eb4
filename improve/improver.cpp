#include "improve/improver.hpp"
