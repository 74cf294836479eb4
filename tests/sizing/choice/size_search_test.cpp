/// How the size on the body is searched.
#include "sizing/choice/size_search.hpp"

#include "parallel/observation/log.hpp"
#include "sizing/choice/field_factory.hpp"
#include "tests/cad/primitives.hpp"

#include <string>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

TEST(SizeSearchLocal, TriesTheCoarsestSizeOnce) {
  const parallel::Communicator world = parallel::Communicator::world();
  const cad::Model model = cad::make_primitive_domain(cad::PrimitiveKind::box);
  FieldFactory factory(SampledModel(world, model), gap_demand({}), Fields::several);
  const GivenSizes given;
  SizeSearch search(factory, 10, 1, {}, given);
  parallel::configure_log(world, parallel::LogLevel::verbose);
  ::testing::internal::CaptureStdout();
  search.run(1, 0.01, most_rounds, 0.05);
  const std::string log = ::testing::internal::GetCapturedStdout();
  parallel::configure_log(world, parallel::LogLevel::normal);
  EXPECT_TRUE(search.is_out_of_reach());
  std::size_t fields = 0;
  for (std::size_t at = log.find("on the body"); at != std::string::npos;
       at = log.find("on the body", at + 1))
    ++fields;
  EXPECT_EQ(fields, 1u) << log;
}

}  // namespace
}  // namespace aeroloom::sizing
