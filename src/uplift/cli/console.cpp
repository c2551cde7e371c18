#include "uplift/cli/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "uplift/analysis/wording.h"

namespace uplift::cli {
namespace {

/// Set by the signal handler, which can reach nothing but a variable of static storage.
std::atomic<bool>& interrupt_flag() {
  static std::atomic<bool> flag{false};
  return flag;
}

extern "C" void on_interrupt(int) {
  interrupt_flag().store(true);
  std::signal(SIGINT, SIG_DFL);
}

/// Length of a UTF-8 text in characters.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool numeric(const std::string& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || ((text[0] == '-' || text[0] == '+') && text.size() > 1));
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

void say(std::string_view line) {
  fmt::print(stdout, "{}\n", line);
}
void complain(std::string_view line) {
  fmt::print(stderr, "{}\n", line);
}

bool on_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term && std::string_view(term) != "dumb";
}

void catch_interrupts() {
  interrupt_flag();  // made here, not in the handler
  std::signal(SIGINT, on_interrupt);
}

bool interrupt_asked() {
  return interrupt_flag().load();
}

void print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], width_of(row[k]));
  }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) {
      const std::string space(widths[k] - width_of(row[k]), ' ');
      if (k > 0) line += "  ";
      line += numeric(row[k]) ? space + row[k] : row[k] + space;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    say(line);
  }
}

ProgressLine::ProgressLine(std::string label, bool quiet) : label_(std::move(label)), quiet_(quiet), terminal_(on_terminal()) {}

ProgressLine::~ProgressLine() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

bool ProgressLine::operator()(const Progress& progress) {
  if (interrupt_asked()) return false;
  if (quiet_) return true;
  const Clock::time_point now = Clock::now();
  if (now - last_ < (terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10000))) return true;
  last_ = now;
  const double spent = std::chrono::duration<double>(now - start_).count();
  const double left = progress.fraction > 0 ? spent * (1 - progress.fraction) / progress.fraction : 0;
  constexpr int cells = 10;
  const int full = std::clamp(static_cast<int>(progress.fraction * cells), 0, cells);
  std::string line = fmt::format("{} [{}{}] {:.0f} %, {:.0f} s left, t = {:.4g} s, dt = {:.3g} s, open {:.0f} %, energy error {}", label_,
                                 std::string(full, '#'), std::string(cells - full, '.'), 100 * progress.fraction, left, progress.time,
                                 progress.step, 100 * progress.open_fraction, percent(progress.energy_error));
  if (!terminal_) {
    complain(line);
    return true;
  }
  line.resize(std::min(line.size(), static_cast<std::size_t>(terminal_width() - 1)));
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
  drawn_ = true;
  return true;
}

}  // namespace uplift::cli
