#pragma once
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/analysis/run.h"

namespace uplift::cli {

/// One line on standard output.
void say(std::string_view line);
/// One line on standard error.
void complain(std::string_view line);
/// True when standard error is a terminal that can redraw a line.
bool on_terminal();

/// From now on Ctrl-C asks for an orderly end instead of killing the process; a second one kills it.
void catch_interrupts();
bool interrupt_asked();

/// Aligned columns; the first row is the head. Numbers (cells that start with a digit or a sign) stand to the right.
void print_table(const std::vector<std::vector<std::string>>& rows);

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
