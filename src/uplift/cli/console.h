#pragma once
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/run/run.h"

namespace uplift::cli {

/// One line on standard output. Throws OutputError when it cannot be written.
void say(std::string_view line);
/// A text on standard output as it stands, the same.
void print_text(std::string_view text);
/// Writes out what standard output still holds. Throws OutputError when it cannot be written.
void finish_output();
/// One line on standard error. When that cannot be written, nobody can be told.
void complain(std::string_view line);
/// The computing time of a step [s]: "0.991 µs", "268 µs", "1.97 ms".
std::string step_time_text(double seconds);
/// A word as a shell takes it: in quotes where it needs them.
std::string in_shell(const std::string& word);
/// True when standard error is a terminal that can redraw a line.
bool on_terminal();

/// From now on SIGINT (Ctrl-C), SIGTERM, SIGHUP, SIGQUIT and SIGXFSZ (file too large) ask for an orderly end instead of killing the
/// process; a second one kills it. SIGHUP stays ignored under nohup, and a closed pipe is an output error.
void catch_interrupts();
bool interrupt_asked();
/// 128 + the number of the signal that asked for the end, as a shell reports it.
int interrupt_exit_code();
/// "interrupted", or "interrupted (SIGTERM)" for another signal than Ctrl-C.
std::string interrupt_text();

/// Aligned columns; the first row is the head. Numbers (cells that start with a digit or a sign) stand to the right.
void print_table(const std::vector<std::vector<std::string>>& rows);

/// One line that tells how far something is: redrawn ten times a second on a terminal; in a pipe a plain line every ten seconds.
class StatusLine {
 public:
  explicit StatusLine(bool quiet);
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;
  /// Clears the line.
  ~StatusLine();
  void operator()(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_, drawn_ = false;
  std::string told_;  // in a pipe
  Clock::time_point last_ = Clock::now();
};

/// The state of a run on one line of the terminal, redrawn ten times a second; in a pipe a plain line every ten seconds.
/// Watches for Ctrl-C in any case.
class ProgressLine {
 public:
  /// `label` names the run, e.g. "[3/20] sdm".
  ProgressLine(std::string label, bool quiet);
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  /// Clears the line.
  ~ProgressLine();
  /// To be called now and then; false when the run shall end.
  bool operator()(const Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool quiet_, terminal_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

}  // namespace uplift::cli
