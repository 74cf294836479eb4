/// All that host programs need of the sizing stage. From a model and a wanted number of tetrahedra, or given
/// bounds, it makes the size field that every later stage follows.
#pragma once

#include "sizing/choice/feature_resolution.hpp"
#include "sizing/choice/given_sizes.hpp"
#include "sizing/choice/levels.hpp"
#include "sizing/field/size_field.hpp"
#include "sizing/sources/patch_size.hpp"
