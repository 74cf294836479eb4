#include "sizing/size_field.hpp"
