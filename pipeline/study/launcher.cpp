#include "pipeline/study/launcher.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace aeroloom::study {

namespace {

std::atomic<pid_t> running_session = 0;
/// Held while a line begins, and while it is decided that none does any more.
std::mutex beginning;
bool is_over = false;

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

/// Whether a variable describes this process's place under a launcher, or how to start without one:
/// others must not inherit it.
bool is_of_this_process(const std::string& variable) {
  constexpr std::array<std::string_view, 9> beginnings{"OMPI_COMM_WORLD_",
                                                       "OMPI_UNIVERSE_",
                                                       "OMPI_MCA_ess_",
                                                       "OMPI_MCA_orte_ess_",
                                                       "OMPI_MCA_orte_hnp_uri=",
                                                       "OMPI_MCA_orte_local_daemon_uri=",
                                                       "PMI_",
                                                       "PMIX_",
                                                       "OMPI_MCA_orte_create_session_dirs="};
  if (variable.starts_with("PMIX_MCA_")) return false;
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](std::string_view beginning) { return variable.starts_with(beginning); });
}

/// As the system gave it to this process; libraries that run since have added to what getenv returns.
std::vector<std::string> first_environment() {
  std::ifstream file("/proc/self/environ", std::ios::binary);
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::string> variables;
  for (std::size_t begin = 0; begin < all.size();) {
    const std::size_t end = std::min(all.find('\0', begin), all.size());
    std::string variable = all.substr(begin, end - begin);
    if (end > begin && !is_of_this_process(variable)) variables.push_back(std::move(variable));
    begin = end + 1;
  }
  return variables;
}

/// Closed and opened anew for the line.
class SpawnFiles {
public:
  explicit SpawnFiles(const std::filesystem::path& log) {
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  }
  ~SpawnFiles() { posix_spawn_file_actions_destroy(&actions); }
  SpawnFiles(const SpawnFiles&) = delete;
  SpawnFiles& operator=(const SpawnFiles&) = delete;

  posix_spawn_file_actions_t actions{};
};

/// A session of its own, and no signal held back.
class SpawnAttributes {
public:
  SpawnAttributes() {
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    sigset_t all;
    sigfillset(&all);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes,
                             POSIX_SPAWN_SETSID | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  }
  ~SpawnAttributes() { posix_spawnattr_destroy(&attributes); }
  SpawnAttributes(const SpawnAttributes&) = delete;
  SpawnAttributes& operator=(const SpawnAttributes&) = delete;

  posix_spawnattr_t attributes{};
};

bool is_in(pid_t session, const std::filesystem::path& process) {
  std::ifstream file(process / "stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');  // the name may hold anything
  if (name_end == std::string::npos) return false;
  std::istringstream words(line.substr(name_end + 1));
  std::string state;
  pid_t parent = 0, group = 0, of_process = 0;
  words >> state >> parent >> group >> of_process;
  return words && of_process == session && state != "Z" && state != "X";
}

/// All that live, in whatever groups: launchers give a group to each rank.
std::vector<pid_t> processes_of(pid_t session) {
  std::vector<pid_t> processes;
  std::error_code ignored;  // of a process that ends meanwhile
  for (const auto& entry : std::filesystem::directory_iterator("/proc", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (is_in(session, entry.path())) processes.push_back(static_cast<pid_t>(std::stol(name)));
  }
  return processes;
}

/// Whether all are gone within so many rounds.
bool await_processes(pid_t session, int rounds) {
  constexpr std::chrono::milliseconds step(100);
  for (int round = 0; round < rounds; ++round) {
    if (processes_of(session).empty()) return true;
    std::this_thread::sleep_for(step);
  }
  return processes_of(session).empty();
}

void send_to_all(pid_t session, int signal) {
  for (const pid_t process : processes_of(session)) ::kill(process, signal);
}

void terminate_then_kill(pid_t session) {
  // The launcher tells its ranks. Five seconds lie between being asked and being killed; chosen, not
  // measured.
  constexpr int rounds_to_relay = 25, rounds_to_end = 25, rounds_of_killed = 50;
  ::kill(-session, SIGTERM);
  if (await_processes(session, rounds_to_relay)) return;
  send_to_all(session, SIGTERM);
  if (await_processes(session, rounds_to_end)) return;
  send_to_all(session, SIGKILL);
  await_processes(session, rounds_of_killed);
}

/// For a thread that is not to go on while another ends the program.
void wait_for_end() {
  constexpr std::chrono::minutes longest(1);
  std::this_thread::sleep_for(longest);
  throw std::runtime_error("no run is started while the program ends");
}

}  // namespace

std::string Launcher::line(int ranks, int nodes, const std::vector<std::string>& command) const {
  if (ranks == 1 && !starts_single) return fmt::format("exec {}", quoted(command));
  std::string text = pattern;
  replace_all(text, "{ranks}", std::to_string(ranks));
  replace_all(text, "{nodes}", std::to_string(nodes));
  return with_command(text, "{command}", command);
}

Launcher srun_launcher() {
  return {"srun --mpi=pmix --kill-on-bad-exit --nodes={nodes} --ntasks={ranks} {command}", true};
}

Launcher mpirun_launcher(const std::string& settings, const std::string& options) {
  const char* root = ::getuid() == 0 ? " --allow-run-as-root" : "";
  return {fmt::format("{}mpirun{} --oversubscribe{} -n {{ranks}} {{command}}", settings, root, options),
          false};
}

Launcher make_launcher(const std::string& pattern) {
  if (!pattern.empty()) {
    for (const char* part : {"{ranks}", "{command}"}) {
      if (pattern.find(part) == std::string::npos)
        throw std::invalid_argument(fmt::format(
            "the launcher '{}' lacks {}. Remedy: as in 'mpirun -n {{ranks}} {{command}}'", pattern, part));
    }
    const Launcher launcher{pattern, true};
    launcher.line(2, 1, {"command"});  // refuses what it cannot fill
    return launcher;
  }
  if (std::getenv("SLURM_JOB_ID") != nullptr) return srun_launcher();
  // Ranks that share a core give it to each other while they wait.
  return mpirun_launcher("OMPI_MCA_mpi_yield_when_idle=1 ", " --bind-to none");
}

namespace detail {

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

pid_t start_line(const std::string& line, const std::filesystem::path& log) {
  std::vector<std::string> variables = first_environment();
  std::vector<char*> environment;
  environment.reserve(variables.size() + 1);
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);
  std::string shell = "sh", flag = "-c", text = line;
  std::array<char*, 4> words{shell.data(), flag.data(), text.data(), nullptr};
  const SpawnFiles files(log);
  const SpawnAttributes attributes;
  std::unique_lock lock(beginning);
  if (is_over) {
    lock.unlock();
    wait_for_end();
  }
  pid_t session = 0;
  const int failed = ::posix_spawn(&session, "/bin/sh", &files.actions, &attributes.attributes, words.data(),
                                   environment.data());
  if (failed != 0) throw std::system_error(failed, std::generic_category(), "cannot start '" + line + "'");
  running_session = session;
  return session;
}

int await_line(pid_t session) {
  int status = 0;
  while (::waitpid(session, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) terminate_then_kill(session);
  running_session = 0;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

}  // namespace detail

Ended run_line(const std::string& line, const std::filesystem::path& log) {
  return run_line(line, log, [](pid_t) {});
}

void end_line() {
  pid_t session = 0;
  {
    const std::lock_guard lock(beginning);  // a line that has just begun is known as running
    session = running_session;
  }
  if (session > 0) terminate_then_kill(session);
}

void end_lines() {
  {
    const std::lock_guard lock(beginning);
    is_over = true;
  }
  end_line();
}

void end_session(pid_t session, const std::string& program) {
  if (session <= 1) return;
  for (const pid_t process : processes_of(session)) {
    std::ifstream file(fmt::format("/proc/{}/cmdline", process), std::ios::binary);
    const std::string words{std::istreambuf_iterator<char>(file), {}};
    if (words.find(program) == std::string::npos) continue;
    terminate_then_kill(session);
    return;
  }
}

}  // namespace aeroloom::study
