/// How the size on the body is searched.
#include "sizing/choice/size_search.hpp"

#include "parallel/observation/log.hpp"
#include "sizing/choice/field_factory.hpp"
#include "tests/cad/primitives.hpp"

#include <string>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

/// The fields that are built for a target out of reach, from a first size below the coarsest or at it.
std::size_t fields_from(double first_size, double coarsest_size) {
  const parallel::Communicator world = parallel::Communicator::world();
  const cad::Model model = cad::make_primitive_domain(cad::PrimitiveKind::box);
  FieldFactory factory(SampledModel(world, model), gap_demand({}), Fields::several);
  const GivenSizes given;
  SizeSearch search(factory, 10, 1, {}, given);
  parallel::configure_log(world, parallel::LogLevel::verbose);
  ::testing::internal::CaptureStdout();
  search.run(first_size, 0.01, most_rounds, coarsest_size);
  const std::string log = ::testing::internal::GetCapturedStdout();
  parallel::configure_log(world, parallel::LogLevel::normal);
  EXPECT_TRUE(search.is_out_of_reach());
  EXPECT_NEAR(search.body_size(), coarsest_size, 1e-12);
  std::size_t fields = 0;
  for (std::size_t at = log.find("on the body"); at != std::string::npos;
       at = log.find("on the body", at + 1))
    ++fields;
  return fields;
}

TEST(SizeSearchLocal, TriesTheCoarsestSizeOnce) {
  EXPECT_EQ(fields_from(1, 0.05), 1u);
}

TEST(SizeSearchLocal, GoesToTheCoarsestSizeAtOnce) {
  EXPECT_EQ(fields_from(0.03, 0.05), 2u);
}

}  // namespace
}  // namespace aeroloom::sizing
