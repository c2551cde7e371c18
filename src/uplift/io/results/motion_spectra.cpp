#include <fmt/format.h>

#include <array>
#include <cmath>
#include <iterator>

#include "uplift/base/text.h"
#include "uplift/io/report/motion.h"
#include "uplift/motion/formats/convert.h"
#include "uplift/motion/spectrum.h"

// Response spectra of motions as numbers: every kind of every damping, and those over all directions.
namespace uplift {
namespace {

struct Column {
  std::string head;
  std::vector<double> values;
};

/// A name without what separates cells.
std::string cell_of(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20 || std::string_view(",;\"[]").find(c) != std::string_view::npos) c = ' ';
  return name;
}

void add_columns(const Motion& motion, const MotionReport& report, std::vector<Column>& columns) {
  struct Shown {
    Spectrum::Kind kind;
    const char *name, *unit;
  };
  constexpr std::array kinds{Shown{Spectrum::Kind::psa, "PSA", "m/s2"}, Shown{Spectrum::Kind::sa, "SA", "m/s2"},
                             Shown{Spectrum::Kind::sv, "SV", "m/s"}, Shown{Spectrum::Kind::sd, "SD", "m"}};
  const Motion a = converted(motion, MotionKind::acceleration);
  for (const Shown& shown : kinds)
    for (Spectrum& spectrum : response_spectra(a.values, a.step, report.frequencies, report.dampings, shown.kind))
      columns.push_back({fmt::format("{} {} {:g} % [{}]", cell_of(motion.name), shown.name, 100 * spectrum.damping, shown.unit),
                         std::move(spectrum.values)});
}

std::pair<const Motion*, const Motion*> horizontal_pair(const std::vector<ShownMotion>& motions) {
  if (motions.size() == 2) return {&motions[0].now, &motions[1].now};
  std::vector<const Motion*> found;
  for (const ShownMotion& shown : motions)
    if (shown.now.azimuth) found.push_back(&shown.now);
  constexpr double nearly = 0.02;  // of the cosine between them
  if (found.size() != 2 || std::abs(std::cos(*found[0]->azimuth - *found[1]->azimuth)) > nearly) return {};
  return {found[0], found[1]};
}

}  // namespace

MotionReport with_rotated(MotionReport report) {
  const auto [first, second] = horizontal_pair(report.motions);
  if (!first) return report;
  const Motion a = converted(*first, MotionKind::acceleration), b = converted(*second, MotionKind::acceleration);
  if (a.step != b.step || a.values.size() != b.values.size()) return report;
  report.rotated_names = a.name + " and " + b.name;
  report.rotated = rotated_spectra(a.values, b.values, a.step, report.frequencies, report.dampings.front(), Spectrum::Kind::psa);
  return report;
}

std::string motion_spectra_csv(const MotionReport& report) {
  std::vector<Column> columns{{"frequency [Hz]", report.frequencies}};
  for (const ShownMotion& shown : report.motions) add_columns(shown.now, report, columns);
  if (report.rotated)
    for (const auto& [name, spectrum] : {std::pair("RotD50", &report.rotated->median), std::pair("RotD100", &report.rotated->largest)})
      columns.push_back({fmt::format("{} PSA {:g} % [m/s2]", name, 100 * spectrum->damping), spectrum->values});
  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + column.head;
  for (std::size_t row = 0; row < report.frequencies.size(); ++row)
    for (std::size_t k = 0; k < columns.size(); ++k)
      fmt::format_to(std::back_inserter(text), "{}{:.8g}", k == 0 ? "\n" : ",", columns[k].values[row]);
  return text + "\n";
}

}  // namespace uplift
