/// Build and evaluation of a size field around a sphere whose sizes vary along it, in a cube ten diameters
/// wide. Arguments: smallest sizes; default 0.03 0.01 0.005.
#include "parallel/observation/timers.hpp"
#include "sizing/field/size_field.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

using namespace aeroloom;
using geometry::Vec3;

namespace {

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return geometry::normalized(Vec3{normal(random), normal(random), normal(random)});
}

std::vector<sizing::SizeSource> cover_sphere(double size, std::mt19937_64& random) {
  std::vector<sizing::SizeSource> sources(static_cast<std::size_t>(40 / (size * size)));
  for (sizing::SizeSource& source : sources) {
    source.point = random_direction(random);
    source.size = size * (1 + 0.5 * std::abs(source.point.x));
  }
  return sources;
}

std::vector<Vec3> scatter_around_sphere(std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> exponent(-6, 2);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = (1 + std::exp(exponent(random))) * random_direction(random);
  return points;
}

void run(double size) {
  std::mt19937_64 random(1);
  const auto sources = cover_sphere(size, random);
  geometry::Box box;
  box.add(Vec3{-10, -10, -10});
  box.add(Vec3{10, 10, 10});
  const double start = parallel::cpu_seconds();
  const auto field = sizing::SizeField::build(box, sources, {size, 2, 12, 1.3, 0});
  const double built = parallel::cpu_seconds();
  const auto points = scatter_around_sphere(1'000'000, random);
  const double before = parallel::cpu_seconds();
  double sum = 0;
  for (const Vec3 p : points) sum += field(p);
  const double evaluated = parallel::cpu_seconds() - before;
  std::printf(
      "RESULT benchmark=size_field size=%g sources=%zu leaves=%lld build_seconds=%.3f "
      "build_us_per_leaf=%.2f evaluate_ns=%.1f mean_size=%.6g\n",
      size, sources.size(), static_cast<long long>(field.leaf_count()), built - start,
      1e6 * (built - start) / static_cast<double>(field.leaf_count()),
      1e9 * evaluated / static_cast<double>(points.size()), sum / static_cast<double>(points.size()));
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<double> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::atof(argv[i]));
  if (sizes.empty()) sizes = {0.03, 0.01, 0.005};
  for (const double size : sizes) run(size);
}
