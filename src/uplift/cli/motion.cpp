#include "uplift/io/report/motion.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>

#include "uplift/base/file.h"
#include "uplift/base/text.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/cli/words.h"
#include "uplift/io/files.h"
#include "uplift/io/report/report.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/formats/write.h"
#include "uplift/motion/intensity.h"
#include "uplift/motion/processing/processing.h"
#include "uplift/motion/spectrum.h"

namespace uplift::cli {
namespace {

namespace fs = std::filesystem;

/// "NAME KEY=VALUE KEY=VALUE": a part. Blanks around a unit (`0.3 g_n`) belong to the value before.
Words part_of(const std::string& text, const std::string& place) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; (begin = text.find_first_not_of(' ', begin)) != std::string::npos;) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    if (words.size() < 2 || word.find('=') != std::string::npos)
      words.push_back(word);
    else
      words.back() += " " + word;
    begin = end;
  }
  if (words.empty()) throw InputError({place, 0}, "", "the name of a part", in_quotes(text));
  Words pairs{{"type", {words.front(), {place, 0}, "type"}}};
  for (std::size_t i = 1; i < words.size(); ++i) pairs.push_back(word_of(words[i], place));
  return pairs;
}

/// Every motion has a name of its own: channels of a file may be called the same, and files of several folders.
std::vector<ShownMotion> read_all(const MotionOptions& given) {
  std::vector<ShownMotion> shown;
  const auto taken = [&](const std::string& name) { return std::ranges::any_of(shown, [&](const auto& s) { return s.now.name == name; }); };
  for (const std::string& file : given.files)
    for (Motion& motion : read_motions(file, given.record)) {
      const std::string name = motion.name;
      for (int number = 2; taken(motion.name); ++number) motion.name = fmt::format("{} ({})", name, number);
      shown.push_back({motion, motion, std::nullopt});
    }
  return shown;
}

/// "rg_1_122", "0.1:100:300" or "1,2,5,10", ascending.
std::vector<double> frequencies_of(const std::string& text) {
  constexpr double most = 1e5;
  const auto refuse = [&](const std::string& found) {
    throw InputError({"uplift motion --frequencies", 0}, "", "frequencies > 0 Hz with commas, FROM:TO:COUNT or rg_1_122", found);
  };
  if (text == "rg_1_122") return rg_1_122_frequencies();
  const bool range = text.find(':') != std::string::npos;
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(range ? ':' : ',', begin), text.size());
    const std::string_view word = trim(std::string_view(text).substr(begin, end - begin));
    const LeadingNumber number = leading_number(word);
    if (number.length == 0 || number.length != word.size() || !(number.value > 0 && number.value <= most)) refuse(in_quotes(word));
    numbers.push_back(number.value);
    begin = end + 1;
  }
  if (!range) {
    std::ranges::sort(numbers);
    numbers.erase(std::ranges::unique(numbers).begin(), numbers.end());
    if (numbers.size() < 2) refuse(in_quotes(text) + ", a single one");
    return numbers;
  }
  if (numbers.size() != 3 || !(numbers[0] < numbers[1]) || numbers[2] < 2 || numbers[2] != std::floor(numbers[2])) refuse(in_quotes(text));
  return log_spaced(numbers[0], numbers[1], static_cast<int>(numbers[2]));
}

/// KEY=VALUE words that belong to the generation itself, and those that belong to the targets.
std::pair<Words, Words> sorted_words(const std::vector<std::string>& words, const std::string& place) {
  std::pair<Words, Words> sorted;
  for (const std::string& word : words) {
    auto pair = word_of(word, place);
    const bool own = std::ranges::any_of(generate_section().fields, [&](const Field& field) { return field.name == pair.first; });
    (own ? sorted.first : sorted.second).push_back(std::move(pair));
  }
  return sorted;
}

std::vector<std::unique_ptr<const TargetSpectrum>> targets_of(const MotionOptions& given, const Words& common, const std::string& place) {
  std::vector<std::unique_ptr<const TargetSpectrum>> targets;
  for (const std::string& text : given.generate) {
    Words pairs = part_of(text, place);
    refuse_twice(pairs, place);
    for (const auto& pair : common)
      if (std::ranges::none_of(pairs, [&](const auto& own) { return own.first == pair.first; })) pairs.push_back(pair);
    targets.push_back(make_part(target_catalog(), check_part(table_of(std::move(pairs), place), target_spectra())));
  }
  return targets;
}

/// The motions, each with its target for the fit after the processing.
std::vector<ShownMotion> generate_all(const MotionOptions& given, std::vector<std::unique_ptr<const TargetSpectrum>>& targets,
                                      GenerateOptions& options) {
  const std::string place = "uplift motion --generate";
  auto [own, common] = sorted_words(given.files, place);
  if (given.record.step) own.push_back({"step", {*given.record.step, {place, 0}, "step"}});
  for (const Words* pairs : {&own, &common}) refuse_twice(*pairs, place);
  for (const std::string* word : {&given.record.unit, &given.record.format, &given.record.column})
    if (!word->empty()) throw InputError({place, 0}, "", "no options for files", in_quotes(*word));
  targets = targets_of(given, common, place);
  options = generate_options(check(table_of(std::move(own), place), generate_section()), *targets.front());
  std::vector<const TargetSpectrum*> list;
  for (const auto& target : targets) list.push_back(target.get());
  std::vector<ShownMotion> shown;
  for (GeneratedMotion& made : generate_motions(list, options)) {
    const std::string& text = given.generate[shown.size()];
    made.motion.name = text.substr(0, text.find(' ')) + (targets.size() > 1 ? fmt::format(" {}", shown.size() + 1) : "");
    shown.push_back({made.motion, made.motion, std::move(made.fit)});
  }
  return shown;
}

void process(std::vector<ShownMotion>& shown, const std::vector<std::string>& steps) {
  const std::string place = "uplift motion --process";
  for (const std::string& step : steps) {
    const auto made = make_part(process_catalog(), check_part(table_of(part_of(step, place), place), motion_processes()));
    for (ShownMotion& each : shown) {
      each.now = made->apply(std::move(each.now));
      check_values(each.now, {place, 0}, step);
    }
  }
}

/// The fit of a generated motion after its processing. What was asked for is done, also when it leaves the bounds of the fit: a warning.
void fit_again(ShownMotion& shown, const TargetSpectrum& target, const GenerateOptions& generating, const Options& options) {
  const bool was_good = shown.fit->good();
  const Motion now = converted(shown.now, MotionKind::acceleration);
  shown.fit = spectrum_fit(now.values, now.step, target, generating.from, generating.to);
  if (was_good && !shown.fit->good() && !options.quiet)
    complain(
        fmt::format("warning: {}: after the processing the spectrum is beyond its bounds: mean error {:.2f} %, down to {:.1f} % of the "
                    "target",
                    shown.now.name, 100 * shown.fit->mean_error, 100 * shown.fit->least_ratio));
}

Provenance provenance_of(const MotionOptions& given, const Options& options, const std::vector<ShownMotion>& shown) {
  Provenance from;
  const bool made = !given.generate.empty();
  const Motion& first = shown.front().now;
  from.title = made ? "Generated motion" : fs::path(given.files.front()).filename().string();
  from.subtitle =
      fmt::format("{}, {:g} s in steps of {:g} s", made ? "spectrum " + given.generate.front() : first.name, first.duration(), first.step);
  if (shown.size() > 1) from.subtitle = fmt::format("{} motions; the first: {}", shown.size(), from.subtitle);
  from.command = options.command;
  from.version = UPLIFT_VERSION;
  from.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  from.case_file = made ? "" : given.files.front();
  from.case_hash = first.sha256;
  return from;
}

std::string folder_of(const MotionOptions& given, const Options& options) {
  if (!options.out.empty()) return options.out;
  if (given.generate.empty()) return "out/motion_" + fs::path(given.files.front()).stem().string();
  const std::string& target = given.generate.front();  // "rg_1_60 pga=3"
  return "out/motion_" + target.substr(0, target.find(' '));
}

void print(const MotionReport& report) {
  std::vector<std::vector<std::string>> rows{{"motion", "PGA [m/s2]", "PGV [m/s]", "PGD [m]", "Arias [m/s]", "CAV [m/s]", "D5-95 [s]",
                                              "Housner [m]", "step [s]", "points", "repairs"}};
  for (const ShownMotion& shown : report.motions) {
    const Intensity i = intensity_of(converted(shown.now, MotionKind::acceleration));
    rows.push_back({shown.now.name, fmt::format("{:.4g}", i.pga), fmt::format("{:.4g}", i.pgv), fmt::format("{:.4g}", i.pgd),
                    fmt::format("{:.4g}", i.arias), fmt::format("{:.4g}", i.cav), fmt::format("{:.4g}", i.significant_duration()),
                    fmt::format("{:.4g}", i.housner), shortest(shown.now.step), fmt::format("{}", shown.now.values.size()),
                    fmt::format("{}", shown.now.repairs.size())});
  }
  print_table(rows);
  for (const ShownMotion& shown : report.motions) {
    for (const std::string& text : shown.now.repairs) say(fmt::format("{}: repaired: {}", shown.now.name, text));
    for (const std::string& text : shown.now.processing) say(fmt::format("{}: {}", shown.now.name, text));
    if (shown.fit && shown.now.processing.size() > 1)  // the first one tells the fit before
      say(fmt::format("{}: fit {} from {:.4g} Hz to {:.4g} Hz: mean error {:.2f} %, nowhere below {:.1f} % of the target", shown.now.name,
                      shown.fit->good() ? "good" : "beyond its bounds", shown.fit->frequencies.front(), shown.fit->frequencies.back(),
                      100 * shown.fit->mean_error, 100 * shown.fit->least_ratio));
  }
  for (std::size_t i = 0; i < report.motions.size(); ++i)
    for (std::size_t j = i + 1; j < report.motions.size(); ++j)
      if (const auto value = correlation_of(report.motions[i].now, report.motions[j].now))
        say(fmt::format("correlation of {} and {}: {:.3f}", report.motions[i].now.name, report.motions[j].now.name, *value));
}

/// One file for motions of one step, else one for each.
void write_motions(const MotionReport& report, ResultFolder& folder) {
  std::vector<Motion> all;
  for (const ShownMotion& shown : report.motions) all.push_back(shown.now);
  if (std::ranges::all_of(all, [&](const Motion& motion) { return motion.step == all.front().step; })) {
    folder.write("motion.csv", motion_csv(all));
    return;
  }
  for (std::size_t i = 0; i < all.size(); ++i) folder.write(fmt::format("motion_{}.csv", i + 1), motion_csv({&all[i], 1}));
}

void write(const MotionReport& report, const Options& options, ResultFolder& folder) {
  write_motions(report, folder);
  folder.write("spectra.csv", motion_spectra_csv(report));
  folder.write("summary.json", motion_summary_json(report));
  const std::string page = report_page(motion_report_json(report));
  if (!page.empty())
    folder.write("report.html", page);
  else if (!options.quiet)
    complain("note: this program was built without the report's page (web/dist/report.html): no report.html is written");
  const std::string moved = folder.finish();
  if (!moved.empty() && !options.quiet && !options.json) say("earlier results moved to " + moved + "/");
}

}  // namespace

int motion(const Options& options, const MotionOptions& given) {
  std::vector<std::unique_ptr<const TargetSpectrum>> targets;
  GenerateOptions generating;
  for (const double damping : given.dampings)
    if (!(damping >= 0 && damping <= 0.99))  // the range check of the command line lets "nan" pass
      throw InputError({"uplift motion --damping", 0}, "", "damping ratios from 0 to 0.99", fmt::format("{}", damping));
  if (given.generate.empty() && given.files.empty())
    throw InputError({"uplift motion", 0}, "", "a file of a recorded motion, or --generate TARGET", "neither");
  MotionReport report;
  report.frequencies = frequencies_of(given.frequencies);
  report.motions = given.generate.empty() ? read_all(given) : generate_all(given, targets, generating);
  for (const ShownMotion& shown : report.motions) check_values(shown.now, {"uplift motion", 0}, shown.now.name);
  bool good = true;
  for (const ShownMotion& shown : report.motions)
    if (shown.fit && !shown.fit->good()) {
      complain(
          fmt::format("failed: {}: the spectrum could not be brought within its bounds (mean error {:.2f} %, down to {:.1f} % of the "
                      "target); a longer duration or a narrower band may help",
                      shown.now.name, 100 * shown.fit->mean_error, 100 * shown.fit->least_ratio));
      good = false;
    }
  process(report.motions, given.process);
  if (!given.process.empty())
    for (std::size_t i = 0; i < targets.size(); ++i) fit_again(report.motions[i], *targets[i], generating, options);
  report.dampings = given.dampings;
  report = with_rotated(std::move(report));
  report.from = provenance_of(given, options, report.motions);

  OutputFolder folder(options, folder_of(given, options));
  write(report, options, folder);
  if (options.json) {
    print_text(read_file(folder.path() + "/summary.json"));
  } else if (!options.quiet) {
    print(report);
    say(fmt::format("results: {}/report.html", folder.path()));
  }
  if (interrupt_asked()) return interrupt_exit_code();
  return good ? Exit::done : Exit::numerical_failure;
}

}  // namespace uplift::cli
