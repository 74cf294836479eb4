#include "improve/stage_record.hpp"

#include "improve/expected_work.hpp"
#include "parallel/observation/timers.hpp"

namespace aeroloom::improve {

StageRecord::StageRecord() {
  parallel::begin_round();
  mine.min_angle_before = mine.min_angle_after = 180;
}

void StageRecord::add_piece(const mesh::Piece& piece, double cells, double begin,
                            const ImproveReport& of_piece) {
  parallel::note_task({parallel::TaskKind::improved_piece, piece.id, expected_work(cells, of_piece),
                       parallel::cpu_seconds() - begin, mesh::bytes_at_rest(piece)});
  mine.add(of_piece);
  parallel::add_pieces(1);
}

void StageRecord::note_cavity(const cavities::Cavity& cavity, double begin) {
  parallel::note_task({parallel::TaskKind::cavity, static_cast<std::int64_t>(cavity.id),
                       static_cast<double>(cavity.tets.size()), parallel::cpu_seconds() - begin,
                       static_cast<std::int64_t>(cavity.tets.size() * sizeof(cavity.tets[0]))});
}

ImproveReport StageRecord::total(const mesh::DistributedMesh& mesh) const {
  ImproveReport all = mine;
  for (std::int64_t* count :
       {&all.bad_before, &all.bad_after, &all.smoothed, &all.slid, &all.replaced, &all.changed_triangles}) {
    *count = mesh.communicator.sum(*count);
  }
  for (double* angle : {&all.min_angle_before, &all.min_angle_after})
    *angle = mesh.communicator.minimum(*angle);
  return all;
}

}  // namespace aeroloom::improve
