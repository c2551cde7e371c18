#include "uplift/ensemble/workers.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>

#include "uplift/base/archive.h"
#include "uplift/io/files.h"
#include "uplift/linear/blas.h"

namespace uplift {
namespace {

/// Writes all bytes; false where the other side is gone.
bool put(int channel, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::send(channel, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// A message: the number of its bytes, then these.
template <class T>
std::string message(const T& value) {
  ArchiveWriter content, size;
  content(value);
  size(content.bytes().size());
  return size.bytes() + content.bytes();
}

/// Takes the first message off the bytes that have come, when it is complete.
template <class T>
bool take(std::string& bytes, T& value) {
  std::size_t size = 0;
  if (bytes.size() < sizeof size) return false;
  std::memcpy(&size, bytes.data(), sizeof size);
  if (bytes.size() < sizeof size + size) return false;
  ArchiveReader reader(std::string_view(bytes).substr(sizeof size, size));
  reader(value);
  bytes.erase(0, sizeof size + size);
  return true;
}

/// Adds what has come; false at the end.
bool get(int channel, std::string& bytes) {
  std::array<char, 1 << 16> room;
  ssize_t count = 0;
  do count = ::recv(channel, room.data(), room.size(), 0);
  while (count < 0 && errno == EINTR);
  if (count <= 0) return false;
  bytes.append(room.data(), static_cast<std::size_t>(count));
  return true;
}

/// Closes all files but the standard ones and the channel: the lock of the study and the channels of the others are not the worker's.
void keep_only(int channel) {
  if (channel > 3) ::close_range(3, static_cast<unsigned>(channel) - 1, 0);
  ::close_range(static_cast<unsigned>(channel) + 1, ~0U, 0);
}

/// Bytes of address space of this process, of which the most part is never touched; 0: not known.
rlim_t address_space() {
  long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return static_cast<rlim_t>(pages) * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE));
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) return fmt::format("signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

/// Zeros that processes forked from this one share with it.
std::shared_ptr<std::atomic<double>[]> shared_numbers(std::size_t count) {
  static_assert(std::atomic<double>::is_always_lock_free);
  const std::size_t bytes = count * sizeof(std::atomic<double>);
  void* shared = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw OutputError(fmt::format("cannot share memory with the workers: {}", std::strerror(errno)));
  auto* numbers = static_cast<std::atomic<double>*>(shared);
  std::uninitialized_fill_n(numbers, count, 0.0);
  return {numbers, [bytes](std::atomic<double>* all) { ::munmap(all, bytes); }};
}

}  // namespace

WorkerPool::WorkerPool(int count, const WorkerLimits& limits, Compute compute)
    : limits_(limits), compute_(std::move(compute)), marched_(shared_numbers(static_cast<std::size_t>(count))) {
  workers_.resize(static_cast<std::size_t>(count));
  for (Worker& worker : workers_) start(worker);
}

WorkerPool::~WorkerPool() {
  for (const Worker& worker : workers_) ::kill(worker.process, SIGKILL);
  for (Worker& worker : workers_) {
    ::waitpid(worker.process, nullptr, 0);
    ::close(worker.channel);
  }
}

std::atomic<double>& WorkerPool::marched_of(const Worker& worker) const {
  return marched_[&worker - workers_.data()];
}

double WorkerPool::marched(std::size_t worker) const {
  return std::min(marched_[worker].load(), static_cast<double>(workers_[worker].outstanding.size()));
}

void WorkerPool::start(Worker& worker) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
    throw OutputError(fmt::format("cannot connect a worker: {}", std::strerror(errno)));
  std::fflush(nullptr);
  const pid_t parent = ::getpid(), process = ::fork();
  if (process < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw OutputError(fmt::format("cannot start a worker: {}", std::strerror(errno)));
  }
  if (process == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a worker does not outlive its coordinator
    if (::getppid() != parent) ::_exit(0);
    for (const int number : {SIGINT, SIGQUIT, SIGHUP}) std::signal(number, SIG_IGN);  // of the terminal: the coordinator answers
    std::signal(SIGTERM, SIG_DFL);
    keep_only(ends[1]);
    use_one_thread_after_fork();
    work(ends[1], marched_of(worker));
  }
  ::close(ends[1]);
  worker = Worker{};
  marched_of(worker) = 0;
  worker.process = process;
  worker.channel = ends[0];
}

void WorkerPool::work(int channel, std::atomic<double>& marched) const {
  if (limits_.memory) {
    const auto bytes = address_space() + static_cast<rlim_t>(std::min(1e6 * *limits_.memory, 1e18));
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  std::string received;
  bool connected = true;
  try {
    while (connected && get(channel, received)) {
      std::vector<RunRequest> batch;
      const auto tell = [&](const StudyResult& result) {
        marched = 0;
        connected = connected && put(channel, message(result));
      };
      const auto watch = [&](double runs) {
        marched = runs;
        return true;
      };
      while (connected && take(received, batch)) compute_(batch, tell, watch);
    }
  } catch (const std::exception&) {
    ::_exit(1);
  }
  ::_exit(0);
}

void WorkerPool::send(std::size_t number, const std::vector<RunRequest>& batch) {
  Worker& worker = workers_[number];
  if (worker.outstanding.empty()) worker.since = Clock::now();
  worker.outstanding.insert(worker.outstanding.end(), batch.begin(), batch.end());
  put(worker.channel, message(batch));  // where the worker is gone, its end is noticed by wait()
}

/// False when the worker has ended.
bool WorkerPool::receive(Worker& worker, Events& events) const {
  const bool alive = get(worker.channel, worker.received);
  for (StudyResult result; take(worker.received, result); result = {}) {
    worker.outstanding.pop_front();
    worker.since = Clock::now();
    events.results.push_back(std::move(result));
  }
  return alive;
}

WorkerPool::Death WorkerPool::bury(Worker& worker) {
  int status = 0;
  while (::waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
  }
  const bool killed = WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
  Death death{std::move(worker.outstanding), worker.too_long, killed && !worker.too_long, how_it_ended(status)};
  ::close(worker.channel);
  worker.channel = -1;
  start(worker);
  return death;
}

WorkerPool::Events WorkerPool::wait(std::chrono::milliseconds most) {
  std::vector<pollfd> asked;
  for (const Worker& worker : workers_) asked.push_back({worker.channel, POLLIN, 0});
  Events events;
  if (::poll(asked.data(), asked.size(), static_cast<int>(most.count())) < 0) return events;  // a signal
  for (std::size_t i = 0; i < workers_.size(); ++i)
    if (asked[i].revents != 0 && !receive(workers_[i], events)) events.deaths.push_back(bury(workers_[i]));
  const Clock::time_point now = Clock::now();
  for (Worker& worker : workers_) {
    const double taken = std::chrono::duration<double>(now - worker.since).count();
    if (!limits_.timeout || worker.outstanding.empty() || worker.too_long || taken < *limits_.timeout) continue;
    worker.too_long = true;
    ::kill(worker.process, SIGKILL);
  }
  return events;
}

}  // namespace uplift
