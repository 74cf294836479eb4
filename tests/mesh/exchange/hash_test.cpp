#include "mesh/data/distributed_mesh.hpp"
#include "tests/meshes/small_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <cstring>
#include <functional>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

std::string hash_of(const DistributedMesh& mesh) {
  return hash_mesh(number_mesh(mesh));
}

TEST(HashLocal, HasThirtyTwoHexadecimalDigits) {
  const std::string hash = hash_of(examples::two_tets(Communicator::self()));
  EXPECT_EQ(hash.size(), 32U);
  EXPECT_EQ(hash.find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(Hash, IsTheSameForAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  for (const int pieces : {1, 2, 7, 30}) {
    EXPECT_EQ(hash_of(examples::cube(world, 4, pieces)), hash_of(examples::cube(self, 4, pieces)));
    EXPECT_EQ(hash_of(examples::cube_surface(world, 4, pieces)),
              hash_of(examples::cube_surface(self, 4, pieces)));
  }
}

/// Flips one bit of an array element and puts it back afterwards.
template <class T>
void with_each_flip(std::vector<T>& values, std::size_t stride, const std::function<void()>& check) {
  for (std::size_t i = 0; i < values.size(); i += stride) {
    const T kept = values[i];
    for (std::size_t bit = 0; bit < 8 * sizeof(T); ++bit) {
      std::uint64_t word = 0;
      std::memcpy(&word, &kept, sizeof(T));
      word ^= std::uint64_t{1} << bit;
      std::memcpy(&values[i], &word, sizeof(T));
      check();
    }
    values[i] = kept;
  }
}

TEST(HashLocal, ChangesWithAnyBitThatIsFlipped) {
  const auto self = Communicator::self();
  NumberedMesh mesh = number_mesh(examples::cube(self, 2, 3));
  std::set<std::string> seen{hash_mesh(mesh)};
  const auto is_new = [&] { EXPECT_TRUE(seen.insert(hash_mesh(mesh)).second); };
  // Piece 0 owns all its vertices.
  Piece& piece = mesh.pieces[0];
  with_each_flip(piece.coordinates, 5, is_new);
  with_each_flip(piece.vertex_dimension, 4, is_new);
  with_each_flip(piece.vertex_entity, 4, is_new);
  with_each_flip(piece.triangle_face, 5, is_new);
  with_each_flip(piece.triangle_patch, 5, is_new);
  EXPECT_GT(seen.size(), 1000U);
}

TEST(HashLocal, ChangesWithAnyOtherVertexOfACellOrTriangle) {
  const auto self = Communicator::self();
  NumberedMesh mesh = number_mesh(examples::cube(self, 2, 3));
  std::set<std::string> seen{hash_mesh(mesh)};
  Piece& piece = mesh.pieces[2];
  for (auto* indices : {&piece.cells, &piece.boundary}) {
    for (std::size_t i = 0; i < indices->size(); i += 3) {
      const LocalIndex kept = (*indices)[i];
      for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
        if (v == kept) continue;
        (*indices)[i] = v;
        EXPECT_TRUE(seen.insert(hash_mesh(mesh)).second);
      }
      (*indices)[i] = kept;
    }
  }
}

TEST(HashLocal, ChangesWithOrderNamesAndMissingItems) {
  const auto self = Communicator::self();
  const auto original = examples::cube(self, 2, 3);
  std::set<std::string> seen{hash_of(original)};
  const auto expect_new = [&](const std::function<void(DistributedMesh&)>& change) {
    auto mesh = original;
    change(mesh);
    EXPECT_TRUE(seen.insert(hash_of(mesh)).second);
  };
  expect_new(
      [](auto& m) { std::swap_ranges(&m.pieces[0].cells[0], &m.pieces[0].cells[4], &m.pieces[0].cells[4]); });
  expect_new([](auto& m) { std::swap(m.pieces[0].cells[0], m.pieces[0].cells[1]); });
  expect_new([](auto& m) { m.pieces[1].cells.resize(m.pieces[1].cells.size() - 4); });
  expect_new([](auto& m) { m.patches[0] += " "; });
  expect_new([](auto& m) { std::swap(m.faces[0], m.faces[1]); });
  expect_new([](auto& m) { m.faces.push_back(""); });
}

}  // namespace
}  // namespace aeroloom::mesh
