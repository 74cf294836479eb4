/// The kinds of tasks, and how each is scheduled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace aeroloom::parallel {

/// What a task makes. In the order in which kinds follow one another within a round.
enum class TaskKind : std::uint8_t {
  sampled_face,
  curve,
  face,
  divided_face,
  divided_part,
  surface_piece,
  wall_piece,
  zone,
  core_piece,
  improved_piece,
  cavity,
  file,
};

/// How the tasks of one kind get their ranks (parallel/communication/schedule.hpp).
enum class TaskAssignment : std::uint8_t {
  largest_first,  ///< to whoever has least
  on_burdens,     ///< to whoever has least, what was done earlier in the round included
  along_curve,    ///< a rank has a stretch of the curve
  rebalanced,     ///< where the piece was made, unless that is uneven
};

struct TaskKindRow {
  TaskKind kind;
  std::string_view name;  ///< in tasks.csv
  TaskAssignment assignment = TaskAssignment::largest_first;
  /// Tasks that a rank gets at a time, largest first; all ranks wait for each other between them. 0: all.
  int at_a_time = 0;
};

/// By kind. A zone waits in memory, with all it is made of, until its turn: four at a time are chosen, not
/// measured.
inline constexpr std::array<TaskKindRow, 12> task_kinds = {{
    {TaskKind::sampled_face, "sampled face"},
    {TaskKind::curve, "curve"},
    {TaskKind::face, "face"},
    {TaskKind::divided_face, "divided face", TaskAssignment::on_burdens},
    {TaskKind::divided_part, "divided part", TaskAssignment::on_burdens},
    {TaskKind::surface_piece, "surface piece", TaskAssignment::on_burdens},
    {TaskKind::wall_piece, "wall piece"},
    {TaskKind::zone, "zone", TaskAssignment::largest_first, 4},
    {TaskKind::core_piece, "core piece", TaskAssignment::along_curve},
    {TaskKind::improved_piece, "improved piece", TaskAssignment::rebalanced},
    {TaskKind::cavity, "cavity"},
    {TaskKind::file, "file"},
}};

constexpr const TaskKindRow& row_of(TaskKind kind) {
  return task_kinds.at(static_cast<std::size_t>(kind));
}
constexpr std::string_view name_of(TaskKind kind) {
  return row_of(kind).name;
}
/// Empty where no kind is called so.
constexpr std::optional<TaskKind> task_kind_called(std::string_view name) {
  for (const TaskKindRow& row : task_kinds)
    if (row.name == name) return row.kind;
  return std::nullopt;
}

}  // namespace aeroloom::parallel
