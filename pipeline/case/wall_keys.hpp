/// The keys of sizes along walls and CAD edges: sizing.walls, sizing.edges.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <deque>

namespace aeroloom::cases {

/// As declare_sources().
void declare_walls(KeyTable& sizing, std::deque<WallRule>& rules);
void declare_edges(KeyTable& sizing, std::deque<EdgeRule>& rules);

/// Throw CaseError if a rule lacks a key that it needs.
void check_walls(const KeyTable& keys, const std::deque<WallRule>& rules);
void check_edges(const KeyTable& keys, const std::deque<EdgeRule>& rules);

}  // namespace aeroloom::cases
