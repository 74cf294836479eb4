/// What a case asks for at places and on patches, laid on a model.
#pragma once

#include "sizing/choice/sampled_model.hpp"
#include "sizing/sources/size_demands.hpp"
#include "sizing/sources/surface_demand.hpp"

#include <utility>
#include <vector>

namespace aeroloom::sizing {

/// Finds the sources of SizeDemands. All functions take the model that they were laid on.
class Demands {
public:
  /// The model has the patches that are named. Collective. Throws std::invalid_argument where walls, wakes or
  /// edges are asked for and the model has none there.
  Demands(const SampledModel& sampled, SizeDemands demands);
  /// For the same model with some faces joined.
  Demands(Demands&& before, const SampledModel& joined);

  /// Replaces the lines; the same on every rank.
  void set_lines(std::vector<SizeLine> lines) { _demands.lines = std::move(lines); }

  /// The options as they hold on a face: a size of its patch binds every other one there.
  SizingOptions options_on(const SampledModel& sampled, cad::FaceId face, const SizingOptions& options) const;
  /// This rank's part of what is asked for, patches apart, all sizes `coarser` times as large. Collective, as
  /// what follows. Throws std::invalid_argument where it is more than the memory holds.
  std::vector<SizeSource> sample(const SampledModel& sampled, const SizingOptions& options,
                                 double coarser) const;
  /// Whether that is clearly more than `most` cells.
  bool ask_for_more_cells(const SampledModel& sampled, const SizingOptions& options, double coarser,
                          double most) const;

private:
  /// Walls, wakes and edges that are named.
  void lay_surfaces(const SampledModel& sampled);
  std::vector<SizeSource> sample_regions(const SampledModel& sampled, double coarser) const;
  /// What the formula, and walls, wakes and edges ask for; each ends early with one more than `most`.
  std::vector<SizeSource> sample_formula(const SampledModel& sampled, const SizingOptions& options,
                                         double coarser, double most) const;
  std::vector<SizeSource> sample_surfaces(const SampledModel& sampled, const SizingOptions& options,
                                          double coarser, double most) const;

  SizeDemands _demands;
  std::vector<double> _asked_on_faces;  // sizes of their patches; 0: none
  std::vector<SurfaceDemand> _surfaces;
};

}  // namespace aeroloom::sizing
