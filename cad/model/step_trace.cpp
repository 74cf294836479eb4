#include "cad/model/step_trace.hpp"

namespace aeroloom::cad {
namespace {

StepListener current = nullptr;

}  // namespace

void listen_to_steps(StepListener listener) {
  current = listener;
}

void report_step(const std::string& step) {
  if (current != nullptr) current(step);
}

}  // namespace aeroloom::cad
