// What is checked of every record, whatever its format: unit, step, number of points, gaps, magnitude, the peak that the head states.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/motion/formats/record_format.h"

namespace uplift {
namespace {

struct KnownUnit {
  const char* word;  // lower case, without blanks, "^", "**"; "sec" as "s"
  MotionKind kind;
  double factor;
  const char* name;
};
constexpr double g_n = 9.80665, inch = 0.0254, foot = 0.3048;
using enum MotionKind;
constexpr std::array known_units{
    KnownUnit{"g", acceleration, g_n, "g"},
    KnownUnit{"g_n", acceleration, g_n, "g"},
    KnownUnit{"mg", acceleration, g_n / 1000, "mg"},
    KnownUnit{"gal", acceleration, 0.01, "gal"},
    KnownUnit{"gals", acceleration, 0.01, "gal"},
    KnownUnit{"cm/s2", acceleration, 0.01, "cm/s2"},
    KnownUnit{"m/s2", acceleration, 1, "m/s2"},
    KnownUnit{"mm/s2", acceleration, 0.001, "mm/s2"},
    KnownUnit{"in/s2", acceleration, inch, "in/s2"},
    KnownUnit{"ft/s2", acceleration, foot, "ft/s2"},
    KnownUnit{"cm/s", velocity, 0.01, "cm/s"},
    KnownUnit{"m/s", velocity, 1, "m/s"},
    KnownUnit{"mm/s", velocity, 0.001, "mm/s"},
    KnownUnit{"in/s", velocity, inch, "in/s"},
    KnownUnit{"ft/s", velocity, foot, "ft/s"},
    KnownUnit{"cm", displacement, 0.01, "cm"},
    KnownUnit{"m", displacement, 1, "m"},
    KnownUnit{"mm", displacement, 0.001, "mm"},
    KnownUnit{"in", displacement, inch, "in"},
    KnownUnit{"inch", displacement, inch, "in"},
    KnownUnit{"ft", displacement, foot, "ft"},
};

/// "CM/SEC**2", "cm / s^2", "cm/s/s", "cm s-2", "cm*s^-2" all become "cm/s2".
std::string plain_unit(std::string_view word) {
  std::string plain;
  for (const char c : upper(trim(word)))
    if (c != ' ' && c != '^' && c != '*' && c != '(' && c != ')' && c != '[' && c != ']' && c != '.')
      plain += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  const auto replace = [&](std::string_view from, std::string_view to) {
    for (std::size_t at = plain.find(from); at != plain.npos; at = plain.find(from, at + to.size())) plain.replace(at, from.size(), to);
  };
  replace("\xC2\xB2", "2");  // superscript two
  replace("sec", "s");
  replace("/s/s", "/s2");
  replace("/ss", "/s2");
  replace("s-2", "/s2");
  replace("s-1", "/s");
  return plain;
}

std::string in_unit(double value, MotionKind kind) {
  return fmt::format("{:.4g} {}", value, unit_of(kind));
}

// The largest that was ever recorded on the ground is 4.4 g, some 4 m/s and 10 m; more than a few times that is a wrong unit.
double implausible(MotionKind kind) {
  return kind == acceleration ? 10 * g_n : kind == velocity ? 20 : 50;
}

MotionUnit unit_of_draft(const RecordText& text, const RecordOptions& options, const RecordDraft& draft, Motion& motion) {
  if (options.unit.empty() && draft.unit.empty()) {
    double most = 0;
    for (const double value : draft.samples.values) most = std::max(most, std::abs(draft.scale * value));
    throw InputError(text.where(draft.unit_line), "",
                     "a unit of the values (the file states none: add one, as unit = \"g\" to its [[record]] or --unit g)",
                     fmt::format("numbers up to {:.4g} without a unit", most));
  }
  if (options.unit.empty()) return wanted_unit(draft.unit, text.where(draft.unit_line));
  const MotionUnit asked = wanted_unit(options.unit, {}, "unit");
  const std::optional<MotionUnit> stated = motion_unit(draft.unit);
  if (stated && (stated->kind != asked.kind || stated->factor != asked.factor))
    motion.repairs.push_back(fmt::format("the file states {}; read as {}, as asked", stated->name, asked.name));
  return asked;
}

double step_of_draft(const RecordText& text, const RecordOptions& options, const RecordDraft& draft, Motion& motion) {
  constexpr double least = 1e-7, most = 1e6;  // s: a thousand times beyond what is recorded
  const auto sound = [](double step) { return step >= least && step <= most; };
  const std::string wanted = fmt::format("a time step from {:g} s to {:g} s", least, most);
  if (options.step) {
    if (!sound(*options.step)) throw InputError({}, "step", wanted, fmt::format("{:g} s", *options.step));
    if (draft.step && std::abs(draft.step->value - *options.step) > 1e-6 * *options.step)
      motion.repairs.push_back(
          fmt::format("the file states a step of {:g} s; read with {:g} s, as asked", draft.step->value, *options.step));
    return *options.step;
  }
  if (!draft.step) throw InputError(text.where(), "", "the time step of a file without times (give it, as in step = 0.01)", "none");
  if (!sound(draft.step->value)) throw InputError(text.where(draft.step->line), "", wanted, fmt::format("{:g} s", draft.step->value));
  if (draft.step->value > 1)
    motion.repairs.push_back(
        fmt::format("a step of {:g} s is longer than that of any accelerograph; taken as it stands", draft.step->value));
  return draft.step->value;
}

void check_count(const RecordText& text, RecordDraft& draft, Motion& motion) {
  Samples& samples = draft.samples;
  const std::size_t found = samples.values.size();
  if (draft.count) {
    const double announced = draft.count->value;
    const auto wrong = [&](const std::string& what) {
      return InputError(text.where(draft.count->line), "", what, fmt::format("{}", found));
    };
    if (!(announced >= 2)) throw InputError(text.where(draft.count->line), "", "at least two points", fmt::format("{:g}", announced));
    if (announced != std::floor(announced))
      throw InputError(text.where(draft.count->line), "", "a number of points", fmt::format("{:g}", announced));
    const auto points = static_cast<double>(found);
    // A file that was cut short is still a record; one that lost half of it is not the one that its head describes.
    if (points < announced / 2) throw wrong(fmt::format("{:.0f} points, as announced here", announced));
    if (points < announced) {
      motion.repairs.push_back(
          fmt::format("line {} announces {:.0f} points, the file has {}: read with {}", draft.count->line, announced, found, found));
    } else if (points > announced) {
      if (points - announced >= static_cast<double>(std::max<std::size_t>(draft.per_row, 2)))
        throw wrong(fmt::format("{:.0f} points, as announced here", announced));
      samples.values.resize(static_cast<std::size_t>(announced));
      std::erase_if(samples.missing, [&](const Samples::Missing& m) { return m.index >= samples.values.size(); });
      motion.repairs.push_back(fmt::format("line {} announces {:.0f} points, the file has {}: the last {} left out", draft.count->line,
                                           announced, found, found - samples.values.size()));
    }
  }
  if (samples.values.size() < 2)
    throw InputError(text.where(samples.last_line), "", "at least two points", samples.values.empty() ? "none" : "one");
}

/// Single missing points lie on the straight line between their neighbours; anything more was not measured and is not invented.
void fill_gaps(const RecordText& text, RecordDraft& draft, Motion& motion) {
  Samples& samples = draft.samples;
  for (std::size_t i = 0; i < samples.missing.size(); ++i) {
    const Samples::Missing& gap = samples.missing[i];
    const bool at_end = gap.index == 0 || gap.index + 1 == samples.values.size();
    const bool long_gap = i + 1 < samples.missing.size() && samples.missing[i + 1].index == gap.index + 1;
    if (at_end || long_gap)
      throw InputError(text.where(gap.line), "",
                       at_end ? "a number for the first and the last point" : "a number (only single missing points are interpolated)",
                       gap.found.empty() ? "nothing" : in_quotes(gap.found));
    samples.values[gap.index] = (samples.values[gap.index - 1] + samples.values[gap.index + 1]) / 2;
  }
  if (samples.missing.empty()) return;
  const Samples::Missing& first = samples.missing.front();
  const std::string place =
      fmt::format("point {} (line {}{})", first.index + 1, first.line, first.found.empty() ? "" : ", " + in_quotes(first.found));
  if (20 * samples.missing.size() > samples.values.size())
    throw InputError(text.where(first.line), "", "at most one missing point in twenty",
                     fmt::format("{} of {}", samples.missing.size(), samples.values.size()));
  motion.repairs.push_back(samples.missing.size() == 1
                               ? place + " is missing: the mean of its neighbours was put there"
                               : fmt::format("{} single points are missing, the first is {}: the means of their neighbours were put there",
                                             samples.missing.size(), place));
}

void check_magnitude(const RecordText& text, const RecordDraft& draft, Motion& motion) {
  const double most = std::abs(peak_of(motion).value);
  if (!has_possible_values(motion))
    throw InputError(text.where(draft.unit_line), "", "values of a ground motion",
                     fmt::format("up to {:.4g} {} with the unit {}", most, unit_of(motion.kind), motion.unit));
  if (most > implausible(motion.kind))
    motion.repairs.push_back(fmt::format("the largest {} is {}, more than was ever recorded: is the unit {} right?", to_string(motion.kind),
                                         in_unit(most, motion.kind), motion.unit));
  if (most == 0) motion.repairs.emplace_back("all values are zero");
}

void check_peak(const RecordDraft& draft, Motion& motion) {
  if (!draft.peak || draft.peak->value == 0) return;
  const double found = peak_of(motion).value, stated = motion.factor / draft.scale * draft.peak->value;
  const double difference = std::abs(std::abs(found) - std::abs(stated));
  const std::string head = fmt::format("line {} states a peak of {}, the values have {}", draft.peak->line, in_unit(stated, motion.kind),
                                       in_unit(found, motion.kind));
  if (difference > 0.02 * std::abs(stated)) {
    motion.repairs.push_back(head + ": taken as they stand");
    return;
  }
  if (!draft.peak_signed || found * stated > 0) return;
  // A positive and a negative peak of the same size are no contradiction.
  const bool other = std::ranges::any_of(
      motion.values, [&](double value) { return value * stated > 0 && std::abs(value - stated) <= 0.02 * std::abs(stated); });
  if (!other) motion.repairs.push_back(head + ", of the opposite sign: taken as they stand");
}

void take_off_mean(Motion& motion) {
  double mean = 0;
  for (const double value : motion.values) mean += value / static_cast<double>(motion.values.size());
  for (double& value : motion.values) value -= mean;
  motion.repairs.push_back(fmt::format("the zero of these counts is arbitrary: their mean, {}, was taken off", in_unit(mean, motion.kind)));
}

}  // namespace

std::optional<MotionUnit> motion_unit(std::string_view word) {
  const std::string plain = plain_unit(word);
  for (const KnownUnit& known : known_units)
    if (plain == known.word) return MotionUnit{known.kind, known.factor, known.name};
  return std::nullopt;
}

MotionUnit wanted_unit(std::string_view word, const Where& where, const std::string& path) {
  if (const std::optional<MotionUnit> unit = motion_unit(word)) return *unit;
  std::vector<std::string> names;
  for (const KnownUnit& known : known_units)
    if (std::ranges::find(names, known.name) == names.end()) names.emplace_back(known.name);
  throw InputError(where, path, "a unit of motion: " + listed(names), in_quotes(word), nearest_name(plain_unit(word), names));
}

Motion finished(const RecordText& text, const RecordOptions& options, RecordDraft draft) {
  Motion motion;
  motion.repairs = text.repairs();
  motion.repairs.insert(motion.repairs.end(), draft.notes.begin(), draft.notes.end());
  motion.name = std::move(draft.name);
  motion.event = std::move(draft.event);
  motion.station = std::move(draft.station);
  motion.component = std::move(draft.component);
  motion.azimuth = draft.azimuth;

  check_count(text, draft, motion);
  fill_gaps(text, draft, motion);
  motion.step = step_of_draft(text, options, draft, motion);
  const MotionUnit unit = unit_of_draft(text, options, draft, motion);
  if (draft.kind && *draft.kind != unit.kind)
    throw InputError(text.where(draft.unit_line), "", fmt::format("a unit of {}, which the file says it holds", to_string(*draft.kind)),
                     fmt::format("{} (of {})", unit.name, to_string(unit.kind)));
  motion.kind = unit.kind;
  motion.unit = unit.name;
  motion.factor = unit.factor * draft.scale;
  motion.values = std::move(draft.samples.values);
  for (double& value : motion.values) value *= motion.factor;
  if (draft.arbitrary_zero) take_off_mean(motion);
  check_magnitude(text, draft, motion);
  check_peak(draft, motion);
  return motion;
}

}  // namespace uplift
