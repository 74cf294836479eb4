/// A test that compares numbers of ranks has nothing to do on one.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <gtest/gtest.h>

/// The first line of a test that only several ranks can fail. On one rank the test is skipped.
#define NEEDS_SEVERAL_RANKS() \
  if (::aeroloom::parallel::Communicator::world().size() == 1) GTEST_SKIP() << "needs several ranks"
