#include "uplift/study/trust.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/cli/study.h"
#include "uplift/ensemble/trust_study.h"
#include "uplift/linear/memory.h"

namespace uplift::cli {
namespace {

std::string hertz(double frequency) {
  return fmt::format("{:.3g} Hz", frequency);
}

/// Every number from ... to; the half of it as a share where that has a meaning.
void print_bands(const TrustAnswer& answer) {
  const bool many = std::ranges::any_of(
      answer.bands, [&](const TrustBand& band) { return !band.interface.empty() && band.interface != answer.bands.back().interface; });
  std::vector<std::vector<std::string>> rows{{"number", "value", "from", "to", "band", "moved most by"}};
  if (many) rows.front().insert(rows.front().begin() + 1, "of");
  for (const TrustBand& band : answer.bands) {
    const std::optional<double> share = band.share();
    std::vector<std::string>& row = rows.emplace_back(
        std::vector<std::string>{std::string(band.quantity->brief), band.format_value(band.value), band.format_value(band.least),
                                 band.format_value(band.most), share ? "±" + percent(*share) : "", band.dominant});
    if (many) row.insert(row.begin() + 1, band.interface);
  }
  print_table(rows);
}

/// Up to which frequency each spectrum is reliable, what limits it, and what would limit it next.
void print_spectra(const TrustAnswer& answer) {
  if (answer.spectra.empty()) return;
  say(fmt::format("\nfloor spectra: up to where every repetition lies within {} of the case", percent(answer.accepted)));
  std::vector<std::vector<std::string>> rows{{"floor", "damping", "reliable to", "limited by", "next limit", "by", "above broadened"}};
  for (const TrustSpectrum& each : answer.spectra) {
    const bool ends = !each.limited_by.empty(), next = ends && each.reaches.size() > 1;
    const bool next_ends = next && each.reaches[1].to < each.frequencies.back();
    rows.push_back({each.floor, percent(each.damping), hertz(each.speaks_to), ends ? each.limited_by : "last frequency",
                    next ? hertz(each.reaches[1].to) : "",
                    next_ends ? each.reaches[1].choice
                    : next    ? "last frequency"
                              : "",
                    !each.above_broadened          ? ""
                    : *each.above_broadened < 5e-3 ? "nowhere"
                                                   : fmt::format("{} at {}", percent(*each.above_broadened), hertz(each.above_at))});
  }
  print_table(rows);
}

void print_answer(const TrustAnswer& answer) {
  if (!answer.bands.empty()) print_bands(answer);
  print_spectra(answer);
  for (const TrustRun& run : answer.runs)
    if (!run.counts())
      say(run.status == RunStatus::interrupted ? fmt::format("{} is left out: {}", run.label, run.reason)
                                               : fmt::format("{} is left out: {}: {}", run.label, to_string(run.status), run.reason));
  for (const TrustPlan::LeftOut& each : answer.left_out) say(fmt::format("not changed: {}: {}", each.choice, each.reason));
}

/// The repetitions, in a study beside the results. What an earlier command computed is taken from there.
TrustResults compute_beside(const std::string& results, const TrustSamples& samples, bool silent) {
  const std::string folder = results + ".trust";
  writing([&] { std::filesystem::create_directories(folder); });
  const FolderLock lock(folder);
  if (lock.is_taken()) throw InputError({folder, 0}, "", "repetitions that no other process computes", "one that does");
  StudyStore store(folder);
  tell_damage(store);
  StatusLine line(silent);
  TrustStudyControl control;
  control.workers = runs_side_by_side(static_cast<int>(std::thread::hardware_concurrency()));
  control.stopped = interrupt_asked;
  control.follow = [&](std::size_t done, std::size_t all) { line(fmt::format("trust: {}/{} repetitions", done, all)); };
  TrustResults made;
  writing([&] { made = compute_trust_study(samples, folder, store, control); });
  return made;
}

}  // namespace

int trust(const Options& options) {
  const LoadedCase loaded = load(options);
  OutputFolder folder(options, result_path(options, loaded.read));
  const Results results = trust_case(loaded, control_of(options, &folder), [&](const TrustSamples& samples) {
    return compute_beside(folder.path(), samples, options.quiet || options.json);
  });
  const TrustAnswer& answer = *results.trust;
  finish_results(options, loaded, results, folder);

  if (options.json) {
    print_text(read_file(folder.path() + "/trust.json"));
  } else if (!options.quiet) {
    for (const std::string& warning : results.warnings) complain("warning: " + warning);
    say(results.verdict.headline);
    if (!results.verdict.consequence.empty()) say(results.verdict.consequence);
    print_answer(answer);
    say(fmt::format("results: {}/report.html", folder.path()));
  }
  if (!answer.complete) {
    if (!options.quiet) complain(interrupt_text() + ": runs that were not finished are left out; the same command computes them");
    return interrupt_exit_code();
  }
  if (!answer.base.counts()) {
    complain("failed: " + answer.base.reason);
    return Exit::numerical_failure;
  }
  return Exit::done;
}

}  // namespace uplift::cli
