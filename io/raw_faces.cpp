#include "io/raw_faces.hpp"

#include "geometry/sort_unique.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/exchange/rendezvous.hpp"
#include "parallel/communication/collective_error.hpp"

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

using mesh::FaceKey;
using mesh::FaceUser;
using mesh::GlobalIndex;
using mesh::LocalIndex;

constexpr std::int32_t none = mesh::no_region;  // or patch

/// A candidate for a face: a side of a cell (region and part), or a face of the file (patch and order).
struct FaceCandidate {
  FaceKey<GlobalIndex> key, corners;
  GlobalIndex order;           ///< of a face of the file
  std::int32_t region, piece;  ///< of a cell
  std::int32_t patch;          ///< of a face of the file

  bool is_cell() const { return region != none; }
  auto place() const { return std::tuple(region, patch, order, corners); }
};

/// The sides of the cells on this rank, for match_faces.
class LocalCellSides {
public:
  explicit LocalCellSides(const LocalMesh& local) : _local(local) {}

  template <class Sink>
  void for_each_side(const Sink& sink) const {
    LocalIndex cell = 0;
    for (const CellShape shape : cell_shapes) {
      const auto& corners = _local.cells[static_cast<std::size_t>(shape)];
      for (std::size_t i = 0; i < corners.size(); i += static_cast<std::size_t>(corners_of(shape)), ++cell) {
        std::int32_t side = 0;
        for (const CellFace& face : faces_of(shape))
          sink(mesh::corners_at(face, corners.data() + i), cell, side++);
      }
    }
  }
  template <class Sink>
  void for_each_face(const Sink&) const {}

  FaceCandidate candidate(const FaceUser& user) const {
    LocalIndex cell = user.item;
    std::size_t s = 0;
    while (cell >= static_cast<LocalIndex>(_local.regions[s].size()))
      cell -= static_cast<LocalIndex>(_local.regions[s++].size());
    const auto corners =
        mesh::corners_at(faces_of(cell_shapes[s])[static_cast<std::size_t>(user.side)],
                         _local.cells[s].data() + static_cast<std::size_t>(cell) *
                                                      static_cast<std::size_t>(corners_of(cell_shapes[s])));
    FaceCandidate candidate{{}, {-1, -1, -1, -1}, 0, _local.regions[s][cell], _local.pieces[s][cell], none};
    for (std::size_t k = 0; k < 4; ++k) {
      if (corners[k] >= 0) candidate.corners[k] = _local.numbers[corners[k]];
    }
    candidate.key = mesh::face_key(candidate.corners);
    return candidate;
  }

private:
  const LocalMesh& _local;
};

/// Whether all corners have a mark.
bool are_marked(const FaceKey<LocalIndex>& key, const std::vector<std::uint8_t>& marks) {
  return std::all_of(key.begin(), key.end(), [&](LocalIndex v) { return v < 0 || marks[v] != 0; });
}

/// Sides of cells that are not matched inside one region here, or that a cell on another rank may have, and
/// all faces of the file.
std::vector<FaceCandidate> candidates_of(const LocalMesh& local) {
  std::vector<FaceCandidate> candidates;
  const LocalCellSides faces(local);
  std::vector<FaceCandidate> met;
  mesh::match_faces(local.numbers.size(), faces,
                    [&](const FaceKey<LocalIndex>& key, std::span<const FaceUser> users) {
                      met.clear();
                      for (const FaceUser& user : users) met.push_back(faces.candidate(user));
                      const bool matched = met.size() == 2 && met[0].region == met[1].region &&
                                           mesh::opposite_direction(met[0].corners, met[1].corners) &&
                                           !are_marked(key, local.shared);
                      if (!matched) candidates.insert(candidates.end(), met.begin(), met.end());
                    });
  GlobalIndex count = 0;
  for (const auto& patches : local.patches) count += static_cast<GlobalIndex>(patches.size());
  GlobalIndex order = local.file.communicator.exclusive_scan(count);
  for (const FaceShape shape : face_shapes) {
    const auto s = static_cast<std::size_t>(shape);
    for (std::size_t f = 0; f < local.patches[s].size(); ++f) {
      const GlobalIndex* v = local.faces[s].data() + f * static_cast<std::size_t>(corners_of(shape));
      FaceCandidate candidate{{},      {v[0], v[1], v[2], shape == FaceShape::triangle ? -1 : v[3]},
                              order++, none,
                              none,    local.patches[s][f]};
      candidate.key = mesh::face_key(candidate.corners);
      candidates.push_back(candidate);
    }
  }
  return candidates;
}

/// A point of a face that met no cell, or of the cells on a rank.
struct MetPoint {
  GlobalIndex number;
  LocalIndex index;  ///< of a point of cells here; -1 of a face
  friend auto operator<=>(const MetPoint&, const MetPoint&) = default;
};

/// The faces of the file that met no cell, again, and the sides of cells that may be there: all corners are
/// of such faces. Nothing where there are none. Collective.
std::vector<FaceCandidate> second_candidates(const LocalMesh& local, std::vector<FaceCandidate> lonely) {
  const parallel::Communicator& communicator = local.file.communicator;
  if (communicator.sum(static_cast<std::int64_t>(lonely.size())) == 0) return {};
  std::vector<MetPoint> points;
  for (const FaceCandidate& face : lonely) {
    for (const GlobalIndex v : face.key) {
      if (v >= 0) points.push_back({v, -1});
    }
  }
  geometry::sort_unique(points);
  for (std::size_t v = 0; v < local.numbers.size(); ++v)
    points.push_back({local.numbers[v], static_cast<LocalIndex>(v)});
  const mesh::Rendezvous meeting(communicator, points, &MetPoint::number, &MetPoint::index);
  points = {};
  std::vector<std::uint8_t> marks(local.numbers.size(), 0);
  for (const LocalIndex v : meeting.answer<LocalIndex>([](const auto&group, const auto&reply) {
         if (group[0].item.index >= 0) return;
         for (const auto& point : group) {
           if (point.item.index >= 0) reply(point, point.item.index);
         }
       }))
    marks[v] = 1;
  const LocalCellSides faces(local);
  mesh::match_faces(local.numbers.size(), faces,
                    [&](const FaceKey<LocalIndex>& key, std::span<const FaceUser> users) {
                      if (!are_marked(key, marks)) return;
                      for (const FaceUser& user : users) lonely.push_back(faces.candidate(user));
                    });
  return lonely;
}

/// A boundary face and the regions on its sides, before it has a patch.
struct BoundaryFace {
  FaceKey<GlobalIndex> corners;
  GlobalIndex order;
  std::int32_t piece, patch, region, other_region;
};

/// The first place where cells do not fit together.
struct UnmatchedFace {
  FaceKey<GlobalIndex> key{-1, -1, -1, -1};
  std::int64_t cells = 0;
};

/// Candidates grouped by face on this rank, and matched.
class FaceMatch {
public:
  explicit FaceMatch(const std::vector<FaceCandidate>& met) {
    mesh::for_each_key(met, &FaceCandidate::key,
                       [&](std::span<const FaceCandidate> group) { match_group(group); });
  }

  /// With second candidates, for the lonely faces.
  void match_lonely(const std::vector<FaceCandidate>& met) {
    lonely.clear();
    mesh::for_each_key(met, &FaceCandidate::key, [&](std::span<const FaceCandidate> group) {
      if (!group[0].is_cell()) match_group(group);
    });
    left_out += static_cast<GlobalIndex>(lonely.size());
  }

  std::vector<BoundaryFace> found;
  std::vector<FaceCandidate> lonely;  ///< faces of the file that met no cell
  std::vector<UnmatchedFace> unmatched;
  GlobalIndex left_out = 0;

private:
  /// Faces of the file come first (their region is -1), then cells by region.
  void match_group(std::span<const FaceCandidate> group) {
    std::size_t faces = 0;
    while (faces < group.size() && !group[faces].is_cell()) ++faces;
    const auto cells = group.subspan(faces);
    if (cells.size() > 2 ||
        (cells.size() == 2 && !mesh::opposite_direction(cells[0].corners, cells[1].corners))) {
      unmatched.push_back({group[0].key, static_cast<std::int64_t>(cells.size())});
      return;
    }
    if (cells.empty()) {
      lonely.insert(lonely.end(), group.begin(), group.end());
      return;
    }
    const bool is_inside = cells.size() == 2 && cells[0].region == cells[1].region;
    if (is_inside && faces == 0) return;
    if (faces > 0) left_out += static_cast<GlobalIndex>(faces - 1);
    const FaceCandidate* given = faces > 0 ? &group[0] : nullptr;
    for (std::size_t f = 1; f < faces; ++f) {
      if (group[f].order < given->order) given = &group[f];
    }
    // Of a baffle the file's direction says which side is in front.
    const std::size_t front = is_inside && mesh::same_direction(given->corners, cells[1].corners) ? 1 : 0;
    BoundaryFace& face = found.emplace_back();
    face.corners = cells[front].corners;
    face.piece = cells[front].piece;
    face.region = cells[front].region;
    face.other_region = cells.size() == 2 ? cells[1 - front].region : none;
    if (given != nullptr) face.corners = oriented_like(given->corners, cells[front].corners);
    face.order = given != nullptr ? given->order : -1;
    face.patch = given != nullptr ? given->patch : none;
  }

  /// The corners as the file has them, from the first one, in the direction of the cell's side; those of the
  /// side where the file goes crosswise.
  static FaceKey<GlobalIndex> oriented_like(FaceKey<GlobalIndex> corners, const FaceKey<GlobalIndex>& side) {
    if (mesh::opposite_direction(corners, side)) std::swap(corners[1], corners[corners[3] < 0 ? 2 : 3]);
    return mesh::same_direction(corners, side) ? corners : side;
  }
};

void require_fit(const SharedPath& file, const std::vector<UnmatchedFace>& mine) {
  const GlobalIndex count = file.communicator.sum(static_cast<std::int64_t>(mine.size()));
  if (count == 0) return;
  const auto less = [](const UnmatchedFace& a, const UnmatchedFace& b) { return a.key < b.key; };
  std::vector<UnmatchedFace> first;
  if (!mine.empty()) first.push_back(*std::min_element(mine.begin(), mine.end(), less));
  const auto all = file.communicator.all_gather_items(std::span<const UnmatchedFace>(first));
  const UnmatchedFace& worst = *std::min_element(all.begin(), all.end(), less);
  throw parallel::CollectiveError(
      parallel::FailureKind::input,
      fmt::format("'{}': {} at the face of points {}, {} and {} (counted from 0 in the order of their ids, "
                  "without those "
                  "that no cell uses): "
                  "the mesh does not conform; {} such faces",
                  file.path,
                  worst.cells > 2 ? "more than two cells meet"
                                  : "two cells lie on the same side, or their corners cross,",
                  worst.key[0], worst.key[1], worst.key[2], count));
}

/// Patches of faces that the file left without, and those that are split, by what they are for.
class PatchTable {
public:
  PatchTable(const parallel::Communicator& communicator, std::vector<mesh::Patch> patches,
             const std::vector<std::string>& regions, const std::vector<BoundaryFace>& found)
      : _patches(std::move(patches)) {
    std::vector<Use> uses;
    uses.reserve(found.size());
    for (const BoundaryFace& face : found) uses.push_back(use_of(face));
    geometry::sort_unique(uses);
    uses = communicator.gather_sorted(uses);
    const auto given = static_cast<std::int32_t>(_patches.size());
    for (std::int32_t p = 0; p < given; ++p) {
      if (std::binary_search(uses.begin(), uses.end(), Use{p, none, none})) {
        if (_patches[p].type == mesh::PatchType::interior) _patches[p].type = mesh::PatchType::wall;
        _targets[{p, none, none}] = p;
      }
    }
    for (const Use& use : uses) add(use, regions);
  }

  std::int32_t patch_of(const BoundaryFace& face) const { return _targets.at(use_of(face)); }
  std::vector<mesh::Patch> take() { return std::move(_patches); }

private:
  /// Patch and regions; regions count for faces without a patch, the second one as 0 for others between
  /// regions.
  using Use = std::array<std::int32_t, 3>;

  static Use use_of(const BoundaryFace& face) {
    if (face.patch == none) return {none, face.region, face.other_region};
    return {face.patch, none, face.other_region == none ? none : 0};
  }

  void add(const Use& use, const std::vector<std::string>& regions) {
    if (_targets.count(use)) return;
    const auto [patch, region, other_region] = use;
    if (patch != none && !_targets.count({patch, none, none})) {
      _patches[patch].type = mesh::PatchType::interior;
      _targets[use] = patch;
      return;
    }
    std::string name = patch != none          ? _patches[patch].name + "_interior"
                       : other_region == none ? "boundary_of_" + regions[region]
                                              : regions[region] + "_to_" + regions[other_region];
    const auto taken = [&] {
      return std::any_of(_patches.begin(), _patches.end(),
                         [&](const mesh::Patch& p) { return p.name == name; });
    };
    while (taken()) name += "_";
    _targets[use] = static_cast<std::int32_t>(_patches.size());
    _patches.push_back({name, other_region == none ? mesh::PatchType::wall : mesh::PatchType::interior});
  }

  std::vector<mesh::Patch> _patches;
  std::map<Use, std::int32_t> _targets;
};

/// A face of the model: a patch where it bounds one region, or lies between two.
struct ModelFace {
  std::int32_t patch;
  mesh::RegionId front, back;
  friend auto operator<=>(const ModelFace&, const ModelFace&) = default;
};

/// The different ones of all ranks, ascending. Collective.
std::vector<ModelFace> all_faces(const parallel::Communicator& communicator, std::vector<ModelFace> faces) {
  geometry::sort_unique(faces);
  faces = communicator.all_gather_items(std::span<const ModelFace>(faces));
  geometry::sort_unique(faces);
  return faces;
}

void name_faces(const std::vector<ModelFace>& faces, mesh::DistributedMesh& names) {
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const ModelFace& face = faces[f];
    const bool alone = (f == 0 || faces[f - 1].patch != face.patch) &&
                       (f + 1 == faces.size() || faces[f + 1].patch != face.patch);
    std::string name = names.patches[face.patch];
    if (!alone) name += "_" + names.regions[face.front];
    if (!alone && face.back != mesh::no_region) name += "_" + names.regions[face.back];
    names.faces.push_back(std::move(name));
    names.sides.push_back({face.front, face.back});
  }
}

}  // namespace

MatchedFaces match_boundary(const LocalMesh& local, std::vector<mesh::Patch> patches,
                            const std::vector<std::string>& regions) {
  const parallel::Communicator& communicator = local.file.communicator;
  const auto meet = [&](std::vector<FaceCandidate> candidates) {
    return mesh::meet_by_key(communicator, std::move(candidates), &FaceCandidate::key, &FaceCandidate::place);
  };
  FaceMatch match(meet(candidates_of(local)));
  match.match_lonely(meet(second_candidates(local, match.lonely)));
  require_fit(local.file, match.unmatched);
  PatchTable table(communicator, std::move(patches), regions, match.found);
  std::vector<ModelFace> of_found;
  of_found.reserve(match.found.size());
  for (const BoundaryFace& face : match.found)
    of_found.push_back({table.patch_of(face), face.region, face.other_region});
  const std::vector<ModelFace> faces = all_faces(communicator, of_found);
  MatchedFaces matched;
  for (std::size_t i = 0; i < of_found.size(); ++i) {
    const BoundaryFace& face = match.found[i];
    matched.unnamed += face.patch == none ? 1 : 0;
    const auto& c = face.corners;
    const auto id =
        static_cast<std::int32_t>(std::lower_bound(faces.begin(), faces.end(), of_found[i]) - faces.begin());
    const std::int32_t patch = of_found[i].patch;
    if (c[3] < 0) {
      std::get<0>(matched.items).push_back({{c[0], c[1], c[2]}, face.order, face.piece, patch, id});
    } else {
      std::get<1>(matched.items).push_back({c, face.order, face.piece, patch, id});
    }
  }
  for (mesh::Patch& patch : table.take()) {
    matched.names.patches.push_back(std::move(patch.name));
    matched.names.patch_types.push_back(patch.type);
  }
  matched.names.regions = regions;
  name_faces(faces, matched.names);
  matched.unnamed = communicator.sum(matched.unnamed);
  matched.left_out = communicator.sum(match.left_out);
  return matched;
}

}  // namespace aeroloom::io
