/// The kinds of tasks, and how each is scheduled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace aeroloom::parallel {

/// What a task makes. Within a round, kinds follow each other in this order.
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

/// How tasks of a kind are assigned to ranks (parallel/communication/schedule.hpp).
enum class TaskAssignment : std::uint8_t {
  largest_first,  ///< to the rank with the smallest load
  on_burdens,     ///< the same, with loads of earlier tasks of the round
  along_curve,    ///< each rank gets a run along the space-filling curve
  rebalanced,     ///< to the rank that made the piece, unless that is uneven
};

struct TaskKindRow {
  TaskKind kind;
  std::string_view name;  ///< in tasks.csv
  TaskAssignment assignment = TaskAssignment::largest_first;
  /// Tasks per rank in a batch, largest first; all ranks wait for each other between batches. 0: all tasks.
  int at_a_time = 0;
};

/// The rows, in the order of TaskKind. The input of a zone stays in memory until the zone is filled, so zones
/// come in batches of four (chosen, not measured).
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
/// The kind of this name; none if there is none.
constexpr std::optional<TaskKind> task_kind_called(std::string_view name) {
  for (const TaskKindRow& row : task_kinds)
    if (row.name == name) return row.kind;
  return std::nullopt;
}

}  // namespace aeroloom::parallel
