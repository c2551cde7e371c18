#include "uplift/cli/console.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "uplift/base/format.h"
#include "uplift/io/files.h"

namespace uplift::cli {
namespace {

/// The signal that asked for the end (0: none). The handler can reach nothing but a variable of static storage.
std::atomic<int>& interrupt_signal() {
  static std::atomic<int> number{0};
  return number;
}

/// SIGXFSZ keeps its handler: every further write to the file raises it again, and fails.
extern "C" void on_interrupt(int number) {
  int none = 0;
  interrupt_signal().compare_exchange_strong(none, number);
  if (number != SIGXFSZ) std::signal(number, SIG_DFL);
}

constexpr std::pair<int, const char*> ending_signals[] = {
    {SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}, {SIGQUIT, "SIGQUIT"}, {SIGXFSZ, "SIGXFSZ"}};

void put(std::FILE* to, std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), to);
}

/// Length of a UTF-8 text in characters.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool numeric(const std::string& text) {
  return text.starts_with("±") ||
         (!text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || ((text[0] == '-' || text[0] == '+') && text.size() > 1)));
}

int terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

void print_text(std::string_view text) {
  put(stdout, text);
  if (std::ferror(stdout) != 0) throw OutputError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}
void say(std::string_view line) {
  print_text(fmt::format("{}\n", line));
}
void finish_output() {
  if (std::fflush(stdout) != 0) throw OutputError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}
void complain(std::string_view line) {
  put(stderr, fmt::format("{}\n", line));
}

std::string in_shell(const std::string& word) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./+:@%=,-";
  if (word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

bool on_terminal() {
  const char* term = std::getenv("TERM");
  return isatty(STDERR_FILENO) == 1 && term && std::string_view(term) != "dumb";
}

void catch_interrupts() {
  interrupt_signal();  // made here, not in the handler
  for (const auto& [number, name] : ending_signals)
    if (std::signal(number, on_interrupt) == SIG_IGN && number == SIGHUP) std::signal(number, SIG_IGN);
  std::signal(SIGPIPE, SIG_IGN);
}

bool interrupt_asked() {
  return interrupt_signal().load() != 0;
}

int interrupt_exit_code() {
  return 128 + interrupt_signal().load();
}

std::string interrupt_text() {
  const int asked = interrupt_signal().load();
  for (const auto& [number, name] : ending_signals)
    if (number == asked && number != SIGINT) return fmt::format("interrupted ({})", name);
  return "interrupted";
}

std::string step_time_text(double seconds) {
  return seconds < 9.995e-4 ? fmt::format("{:.3g} µs", 1e6 * seconds) : format_quantity(seconds, "s");
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

StatusLine::StatusLine(bool quiet) : quiet_(quiet), terminal_(on_terminal()) {}

StatusLine::~StatusLine() {
  if (drawn_) put(stderr, "\r\033[K");
}

void StatusLine::operator()(const std::string& text) {
  const Clock::time_point now = Clock::now();
  if (quiet_ || now - last_ < (terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10000))) return;
  last_ = now;
  if (!terminal_) {
    if (text != told_) complain(text);  // a log has a line for every change
    told_ = text;
    return;
  }
  put(stderr, "\r\033[K" + text);
  std::fflush(stderr);
  drawn_ = true;
}

ProgressLine::ProgressLine(std::string label, bool quiet) : label_(std::move(label)), quiet_(quiet), terminal_(on_terminal()) {}

ProgressLine::~ProgressLine() {
  if (drawn_) put(stderr, "\r\033[K");
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
  std::string line = fmt::format("{} [{}{}] {:.0f} %, {:.0f} s left", label_, std::string(full, '#'), std::string(cells - full, '.'),
                                 100 * progress.fraction, left);
  if (progress.step > 0)  // the basis of a reduced model has no steps
    line += fmt::format(", t = {:.4g} s, dt = {:.3g} s, open {:.0f} %, energy error {}", progress.time, progress.step,
                        100 * progress.open_fraction, percent(progress.energy_error));
  if (!terminal_) {
    complain(line);
    return true;
  }
  line.resize(std::min(line.size(), static_cast<std::size_t>(terminal_width() - 1)));
  put(stderr, "\r\033[K" + line);
  std::fflush(stderr);
  drawn_ = true;
  return true;
}

}  // namespace uplift::cli
