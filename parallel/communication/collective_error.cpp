#include "parallel/communication/collective_error.hpp"

#include "parallel/observation/memory_limit.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <filesystem>
#include <ios>
#include <new>
#include <optional>

namespace aeroloom::parallel {

namespace {

struct Failure {
  FailureKind kind = FailureKind::bug;
  std::string message;
};

/// How many agree() are at work, one within the other.
int depth = 0;

struct Depth {
  Depth() { ++depth; }
  ~Depth() { --depth; }
  Depth(const Depth&) = delete;
  Depth& operator=(const Depth&) = delete;
};

/// Runs the work; what it threw, if anything. A CollectiveError passes.
std::optional<Failure> attempt(const std::function<void()>& work) {
  try {
    const Depth deeper;
    work();
    return std::nullopt;
  } catch (const CollectiveError&) {
    throw;
  } catch (const std::bad_alloc&) {
    return Failure{FailureKind::resources, out_of_memory_text()};
  } catch (const SandboxInterrupted& error) {
    return Failure{FailureKind::resources, error.what()};
  } catch (const std::logic_error& error) {
    return Failure{FailureKind::bug, error.what()};
  } catch (const std::ios_base::failure& error) {
    return Failure{FailureKind::files, error.what()};
  } catch (const std::filesystem::filesystem_error& error) {
    return Failure{FailureKind::files, error.what()};
  } catch (const std::exception& error) {
    return Failure{FailureKind::input, error.what()};
  } catch (...) {
    return Failure{FailureKind::bug, "exception of unknown type"};
  }
}

}  // namespace

bool is_agreeing() {
  return depth > 0;
}

void agree(const Communicator& communicator, const std::function<void()>& work) {
  const std::optional<Failure> mine = attempt(work);
  const std::int64_t failed = communicator.sum(std::int64_t{mine ? 1 : 0});
  if (failed == 0) return;
  const Rank first = static_cast<Rank>(
      communicator.minimum(static_cast<std::int64_t>(mine ? communicator.rank() : communicator.size())));
  Failure failure = mine.value_or(Failure());
  communicator.broadcast_value(failure, first);
  if (failed > 1) {
    const std::int64_t others = failed - 1;
    failure.message +=
        " (" + std::to_string(others) + (others == 1 ? " other rank" : " other ranks") + " failed as well)";
  }
  throw CollectiveError(failure.kind, failure.message);
}

void on_root(const Communicator& communicator, const std::function<void()>& work) {
  agree(communicator, [&] {
    if (communicator.is_root()) work();
  });
}

}  // namespace aeroloom::parallel
