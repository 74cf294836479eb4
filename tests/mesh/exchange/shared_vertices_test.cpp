#include "mesh/exchange/shared_vertices.hpp"

#include "mesh/data/mixing.hpp"
#include "parallel/communication/collective_error.hpp"
#include "tests/meshes/small_meshes.hpp"

#include <functional>
#include <map>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

/// Lists of keys, piece by piece; the vertex of a key is its place plus ten.
using Lists = std::map<PieceId, std::vector<std::uint64_t>>;

/// Key 7 is of three pieces, 20 of piece 2 alone; piece 4 knows nothing.
const Lists lists{{0, {7, 11, 12}}, {1, {12, 7}}, {2, {20, 13}}, {3, {13, 11, 7}}, {4, {}}};

/// The pieces of this rank: piece p is on rank (3 p) % size.
struct Held {
  explicit Held(const Communicator& communicator, const Lists& all = lists) {
    for (const auto& [piece, keys] : all) {
      if (3 * piece % communicator.size() != communicator.rank()) continue;
      pieces.push_back(piece);
      auto& vertices = _vertices.emplace_back();
      for (std::size_t i = 0; i < keys.size(); ++i) vertices.push_back(static_cast<LocalIndex>(i + 10));
      for (const std::uint64_t key : keys) this->keys.push_back(key), piece_of_copy.push_back(piece);
    }
    for (std::size_t p = 0; p < pieces.size(); ++p)
      keyed.push_back({pieces[p], _vertices[p], all.at(pieces[p])});
  }

  std::vector<PieceId> pieces, piece_of_copy;
  std::vector<std::uint64_t> keys;  ///< of copies
  std::vector<KeyedVertices> keyed;

private:
  std::vector<std::vector<LocalIndex>> _vertices;
};

std::vector<PieceId> pieces_with(const Lists& all, std::uint64_t key) {
  std::vector<PieceId> pieces;
  for (const auto& [piece, keys] : all) {
    if (std::count(keys.begin(), keys.end(), key)) pieces.push_back(piece);
  }
  return pieces;
}

/// An operation that does not commute, nor is it associative.
constexpr auto mixed = [](std::uint64_t total, std::uint64_t value) { return mix_in(total, value); };
std::uint64_t said_by(PieceId piece, std::uint64_t key) {
  return mix_bits(100 * static_cast<std::uint64_t>(piece) + key);
}

void expect_sums(const Held& held, const Lists& all, const SharedVertices& shared) {
  std::vector<std::uint64_t> values, totals, firsts;
  for (std::size_t c = 0; c < held.keys.size(); ++c) {
    const std::vector<PieceId> pieces = pieces_with(all, held.keys[c]);
    values.push_back(said_by(held.piece_of_copy[c], held.keys[c]));
    firsts.push_back(said_by(pieces.front(), held.keys[c]));
    std::uint64_t total = firsts.back();
    for (std::size_t i = 1; i < pieces.size(); ++i) total = mixed(total, said_by(pieces[i], held.keys[c]));
    totals.push_back(total);
  }
  std::vector<std::uint64_t> copies = values;
  shared.scatter(copies);
  EXPECT_EQ(copies, firsts);
  copies = values;
  shared.reduce(copies, mixed);
  for (std::size_t c = 0; c < copies.size(); ++c)
    EXPECT_EQ(copies[c], shared.is_owned(c) ? totals[c] : values[c]);
  copies = values;
  shared.reduce_and_scatter(copies, mixed);
  EXPECT_EQ(copies, totals);
}

TEST(SharedVertices, KnowWhoOwnsAndWhoShares) {
  const Communicator world = Communicator::world();
  const Held held(world);
  const SharedVertices shared(world, held.keyed);
  ASSERT_EQ(shared.size(), held.keys.size());
  for (std::size_t p = 0; p < held.pieces.size(); ++p) {
    for (std::size_t c = shared.first(p); c < shared.first(p + 1); ++c) {
      EXPECT_EQ(held.piece_of_copy[c], held.pieces[p]);
      EXPECT_EQ(shared.vertex(c), static_cast<LocalIndex>(c - shared.first(p) + 10));
      const std::vector<PieceId> pieces = pieces_with(lists, held.keys[c]);
      EXPECT_EQ(shared.is_owned(c), pieces.front() == held.pieces[p]);
      EXPECT_EQ(shared.is_shared(c), pieces.size() > 1);
    }
  }
  EXPECT_EQ(shared.first(held.pieces.size()), shared.size());
}

TEST(SharedVertices, SumInTheOrderOfPieces) {
  const Communicator world = Communicator::world();
  const Held held(world);
  expect_sums(held, lists, SharedVertices(world, held.keyed));
}

TEST(SharedVertices, MayAllBeOnOneRank) {
  const Communicator self = Communicator::self();
  const Held held(self);
  expect_sums(held, lists, SharedVertices(self, held.keyed));
}

TEST(SharedVertices, SumManyInTheOrderOfPieces) {
  Lists many;
  for (PieceId piece = 0; piece < 9; ++piece) {
    for (std::uint64_t key = 0; key < 400; ++key) {
      if (mix_bits(1000 * static_cast<std::uint64_t>(piece) + key) % 3 == 0)
        many[piece].push_back(mix_bits(key));
    }
    std::sort(many[piece].begin(), many[piece].end(),
              [&](std::uint64_t a, std::uint64_t b) { return mix_in(a, piece) < mix_in(b, piece); });
  }
  const Communicator world = Communicator::world();
  const Held held(world, many);
  expect_sums(held, many, SharedVertices(world, held.keyed));
}

TEST(SharedVertices, TakeValuesOfAnyKind) {
  struct Far {
    double distance;
    std::int32_t piece;
    static constexpr auto fields() { return std::tuple(&Far::distance, &Far::piece); }
  };
  const Communicator world = Communicator::world();
  const Held held(world);
  const SharedVertices shared(world, held.keyed);
  std::vector<Far> copies;
  for (const PieceId piece : held.piece_of_copy) copies.push_back({-1.5 * piece, piece});
  shared.reduce_and_scatter(copies,
                            [](const Far& a, const Far& b) { return a.distance <= b.distance ? a : b; });
  for (std::size_t c = 0; c < copies.size(); ++c) {
    EXPECT_EQ(copies[c].piece, pieces_with(lists, held.keys[c]).back());
    EXPECT_EQ(copies[c].distance, -1.5 * copies[c].piece);
  }
}

TEST(SharedVertices, OfNoPieces) {
  const Communicator world = Communicator::world();
  const SharedVertices shared(world, std::span<const KeyedVertices>());
  EXPECT_EQ(shared.size(), 0u);
  std::vector<double> copies;
  shared.reduce_and_scatter(copies, std::plus<>());
}

TEST(SharedVertices, RefuseAKeyTwiceInAPiece) {
  const Communicator world = Communicator::world();
  Lists twice = lists;
  twice[3].push_back(13);
  const Held held(world, twice);
  try {
    SharedVertices(world, held.keyed);
    FAIL() << "no rank may go on";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_STREQ(error.what(), "shared vertices: vertices 10 and 13 of piece 3 are the same");
  }
}

TEST(SharedVertices, RefuseValuesOfOtherCopies) {
  const Communicator self = Communicator::self();
  const Held held(self);
  const SharedVertices shared(self, held.keyed);
  std::vector<int> copies(shared.size() + 1);
  EXPECT_THROW(shared.scatter(copies), std::logic_error);
}

class SharedVerticesOfCube : public testing::TestWithParam<int> {};

TEST_P(SharedVerticesOfCube, CountThePiecesOfEachVertex) {
  const Communicator world = Communicator::world();
  const examples::WholeMesh whole = examples::whole_cube(3, GetParam());
  const DistributedMesh mesh = examples::distribute(world, whole, GetParam());
  const SharedVertices shared(mesh);
  std::vector<int> pieces(shared.size(), 1);
  shared.reduce_and_scatter(pieces, std::plus<>());
  std::map<std::array<double, 3>, std::set<int>> known_by;
  for (std::size_t c = 0; c < whole.cells.size(); ++c) {
    for (const int v : whole.cells[c]) {
      const geometry::Vec3 p = whole.points[v];
      known_by[{p.x, p.y, p.z}].insert(whole.piece_of_cell[c]);
    }
  }
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    for (std::size_t c = shared.first(p); c < shared.first(p + 1); ++c) {
      const geometry::Vec3 at = mesh.pieces[p].point(shared.vertex(c));
      const std::set<int>& expected = known_by.at({at.x, at.y, at.z});
      EXPECT_EQ(pieces[c], static_cast<int>(expected.size()));
      EXPECT_EQ(shared.is_owned(c), *expected.begin() == mesh.pieces[p].id);
    }
  }
}

TEST_P(SharedVerticesOfCube, DropWhatOnlyOnePieceKnows) {
  const Communicator world = Communicator::world();
  DistributedMesh mesh = examples::cube(world, 3, GetParam());
  const DistributedMesh before = mesh;
  std::int64_t added = 0;
  for (Piece& piece : mesh.pieces) {
    std::vector<SharedVertexKey> vertex_keys(piece.vertex_count(), 0);
    for (std::size_t s = 0; s < piece.shared_vertices.size(); ++s)
      vertex_keys[piece.shared_vertices[s]] = piece.shared_keys[s];
    piece.shared_vertices.clear(), piece.shared_keys.clear();
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      const bool alone = vertex_keys[v] == 0;
      if (alone && v % 3 == 0) continue;
      added += alone;
      piece.shared_vertices.push_back(v);
      piece.shared_keys.push_back(alone ? mix_in(static_cast<std::uint64_t>(piece.id) + 1, v)
                                        : vertex_keys[v]);
    }
  }
  SharedVertices shared(mesh);
  EXPECT_EQ(shared.drop_unshared(mesh), added);
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    EXPECT_EQ(mesh.pieces[p].shared_vertices, before.pieces[p].shared_vertices);
    EXPECT_EQ(mesh.pieces[p].shared_keys, before.pieces[p].shared_keys);
  }
  // As if it had been made of what is left.
  const SharedVertices fresh(mesh);
  ASSERT_EQ(shared.size(), fresh.size());
  std::vector<std::uint64_t> copies, expected;
  for (std::size_t p = 0; p < mesh.pieces.size(); ++p) {
    EXPECT_EQ(shared.first(p), fresh.first(p));
    for (std::size_t c = fresh.first(p); c < fresh.first(p + 1); ++c) {
      EXPECT_EQ(shared.vertex(c), fresh.vertex(c));
      EXPECT_EQ(shared.is_owned(c), fresh.is_owned(c));
      copies.push_back(mix_in(static_cast<std::uint64_t>(mesh.pieces[p].id), c - fresh.first(p)));
    }
  }
  EXPECT_EQ(shared.first(mesh.pieces.size()), shared.size());
  expected = copies;
  shared.reduce_and_scatter(copies, mixed);
  fresh.reduce_and_scatter(expected, mixed);
  EXPECT_EQ(copies, expected);
}

INSTANTIATE_TEST_SUITE_P(Pieces, SharedVerticesOfCube, testing::Values(1, 2, 4, 7, 27));

}  // namespace
}  // namespace aeroloom::mesh
