#include "uplift/io/hdf5/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>

namespace uplift {
namespace {

enum ChildExit { done = 0, no_memory = 3, no_answer = 4 };

/// Bytes of address space that this process has taken: the limit of the system counts them too.
std::int64_t address_space() {
  std::int64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * sysconf(_SC_PAGESIZE);
}

/// A limit of the system is lowered at most.
void lower(__rlimit_resource what, std::int64_t most) {
  rlimit now{};
  if (getrlimit(what, &now) != 0) return;
  const auto wanted = static_cast<rlim_t>(most);
  now.rlim_cur = std::min(wanted, now.rlim_max);
  setrlimit(what, &now);
}

bool write_all(int to, const std::string& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t count = write(to, bytes.data() + at, bytes.size() - at);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    at += static_cast<std::size_t>(count);
  }
  return true;
}

[[noreturn]] void be_child(const std::function<std::string()>& work, const ChildLimits& limits, pid_t parent, int answer) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(no_answer);  // it died before this was asked for
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {0, 1, 2}) dup2(nowhere, stream);
  lower(RLIMIT_CORE, 0);
  lower(RLIMIT_CPU, limits.seconds);
  lower(RLIMIT_AS, address_space() + limits.memory);
  for (const int fatal : {SIGXCPU, SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) std::signal(fatal, SIG_DFL);
  try {
    _exit(write_all(answer, work()) ? done : no_answer);
  } catch (const std::bad_alloc&) {
    _exit(no_memory);
  } catch (...) {
    _exit(no_answer);
  }
}

/// Everything that comes through the pipe until its other end is closed; false when it is too much.
bool read_all(int from, std::size_t most, std::string& bytes) {
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::size_t size = 0;
  for (;;) {
    if (bytes.size() < size + piece) bytes.resize(std::max(2 * bytes.size(), size + piece));
    const ssize_t count = read(from, bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    size += static_cast<std::size_t>(count);
    if (size > most) return false;
  }
  bytes.resize(size);
  return true;
}

/// How the child ended, in words; empty when it did its work.
std::string ending(pid_t child, const ChildLimits& limits) {
  int status = 0;
  pid_t waited = -1;
  do waited = waitpid(child, &status, 0);
  while (waited < 0 && errno == EINTR);
  if (waited < 0) return "";  // someone else takes care of all children (SIGCHLD ignored): the answer must speak for itself
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) return fmt::format("no end after {} s of computing", limits.seconds);
  if (WIFSIGNALED(status)) return fmt::format("a crash ({})", strsignal(WTERMSIG(status)));
  if (WEXITSTATUS(status) == no_memory) return fmt::format("a need for more than {} MB of memory", limits.memory / 1'000'000);
  return WEXITSTATUS(status) == done ? "" : "a crash";
}

}  // namespace

ChildAnswer answer_of_child(const std::function<std::string()>& work, const ChildLimits& limits) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {"", fmt::format("no process to read it ({})", std::strerror(errno))};
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    close(ends[0]);
    be_child(work, limits, parent, ends[1]);
  }
  const int forked = errno;
  close(ends[1]);
  ChildAnswer answer;
  if (child < 0) {
    answer.failure = fmt::format("no process to read it ({})", std::strerror(forked));
  } else {
    fcntl(ends[0], F_SETPIPE_SZ, 1 << 20);
    const bool whole = read_all(ends[0], static_cast<std::size_t>(limits.memory), answer.bytes);
    if (!whole) kill(child, SIGKILL);
    answer.failure = ending(child, limits);
    if (!whole) answer.failure = "an answer without end";
  }
  close(ends[0]);
  if (!answer.failure.empty()) answer.bytes.clear();
  return answer;
}

}  // namespace uplift
