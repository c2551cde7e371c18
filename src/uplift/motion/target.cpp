#include "uplift/motion/target.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "uplift/motion/intensity.h"

namespace uplift {

#define TARGET(name) const Entry<TargetSpectrum>& entry_target_##name();
#include "uplift/parts.def"

std::span<const Entry<TargetSpectrum>* const> target_catalog() {
  static const std::array entries{
#define TARGET(name) &entry_target_##name(),
#include "uplift/parts.def"
  };
  return entries;
}

std::span<const PartInfo* const> target_spectra() {
  static const std::vector<const PartInfo*> infos(target_catalog().begin(), target_catalog().end());
  return infos;
}

namespace {

constexpr double standard_damping = 0.05;

/// Points with straight lines between them, in the logarithms of both axes or as they are; the end values go on outside, or along a slope
/// in logarithms below the first.
struct Curve {
  std::vector<double> frequencies, values;  // Hz ascending, m/s2
  bool logarithmic = true;
  double slope_below = 0;

  double at(double frequency) const {
    if (frequency <= frequencies.front()) return values.front() * std::pow(frequency / frequencies.front(), slope_below);
    if (frequency >= frequencies.back()) return values.back();
    const auto right = static_cast<std::size_t>(std::ranges::upper_bound(frequencies, frequency) - frequencies.begin()), left = right - 1;
    if (!logarithmic)
      return std::lerp(values[left], values[right], (frequency - frequencies[left]) / (frequencies[right] - frequencies[left]));
    const double share = std::log(frequency / frequencies[left]) / std::log(frequencies[right] / frequencies[left]);
    return values[left] * std::pow(values[right] / values[left], share);
  }
};

class CurveTarget : public TargetSpectrum {
 public:
  CurveTarget(Curve curve, double peak, double damping, Band band, std::string told)
      : curve_(std::move(curve)), peak_(peak), damping_(damping), band_(band), told_(std::move(told)) {}
  double at(double frequency) const override { return curve_.at(frequency); }
  double peak_ground_acceleration() const override { return peak_; }
  double damping() const override { return damping_; }
  Band band() const override { return band_; }
  std::string told() const override { return told_; }

 private:
  Curve curve_;
  double peak_, damping_;
  Band band_;
  std::string told_;
};

Field direction_field() {
  return choice("direction", {"horizontal", "vertical"}, "of the motion").standard("horizontal");
}
Field damping_field(double least, double most) {
  return number("damping", "1", "ratio to the critical damping").standard(standard_damping).between(least, most);
}

// ---- Regulatory Guide 1.60 ----

/// Amplification at the control points: of the acceleration at B and C, of the displacement at D. At A (33 Hz) it is 1 throughout.
struct Amplification {
  double damping, b, c, d;
};
constexpr std::array<Amplification, 5> horizontal_1_60{
    {{0.005, 4.96, 5.95, 3.20}, {0.02, 3.54, 4.25, 2.50}, {0.05, 2.61, 3.13, 2.05}, {0.07, 2.27, 2.72, 1.88}, {0.10, 1.90, 2.28, 1.70}}};
constexpr std::array<Amplification, 5> vertical_1_60{
    {{0.005, 4.96, 5.67, 2.13}, {0.02, 3.54, 4.05, 1.67}, {0.05, 2.61, 2.98, 1.37}, {0.07, 2.27, 2.59, 1.25}, {0.10, 1.90, 2.17, 1.13}}};

/// Linear between the dampings of the tables, as the guide's note 2 allows.
Amplification amplification_1_60(const std::array<Amplification, 5>& table, double damping) {
  std::size_t right = 1;
  while (right + 1 < table.size() && table[right].damping < damping) ++right;
  const Amplification &l = table[right - 1], &r = table[right];
  const double share = (damping - l.damping) / (r.damping - l.damping);
  return {damping, std::lerp(l.b, r.b, share), std::lerp(l.c, r.c, share), std::lerp(l.d, r.d, share)};
}

std::unique_ptr<const TargetSpectrum> make_1_60(const Values& v) {
  constexpr double displacement = 36 * 0.0254, a_at = 33, b_at = 9, d_at = 0.25;  // m at a peak acceleration of 1 g; Hz
  const bool vertical = v.text("direction") == "vertical";
  const double peak = v.number("pga"), damping = v.number("damping"), c_at = vertical ? 3.5 : 2.5;
  const Amplification factor = amplification_1_60(vertical ? vertical_1_60 : horizontal_1_60, damping);
  const double w = 2 * std::numbers::pi * d_at, at_d = w * w * factor.d * displacement * peak / standard_gravity;
  Curve curve{{d_at, c_at, b_at, a_at}, {at_d, factor.c * peak, factor.b * peak, peak}};
  curve.slope_below = 2;  // parallel to the line of the ground displacement
  return std::make_unique<CurveTarget>(std::move(curve), peak, damping, TargetSpectrum::Band{0.1, a_at},
                                       fmt::format("Regulatory Guide 1.60, {}, pga {:g} m/s2", v.text("direction"), peak));
}

// ---- Eurocode 8 ----

struct Ground {
  double s, t_b, t_c, t_d;  // soil factor; s
};
constexpr std::array<std::array<Ground, 5>, 2> grounds_8{{{{{1.00, 0.15, 0.40, 2.0},  // type 1, ground A
                                                            {1.20, 0.15, 0.50, 2.0},
                                                            {1.15, 0.20, 0.60, 2.0},
                                                            {1.35, 0.20, 0.80, 2.0},
                                                            {1.40, 0.15, 0.50, 2.0}}},
                                                          {{{1.00, 0.05, 0.25, 1.2},  // type 2, ground A
                                                            {1.35, 0.05, 0.25, 1.2},
                                                            {1.50, 0.10, 0.25, 1.2},
                                                            {1.80, 0.10, 0.30, 1.2},
                                                            {1.60, 0.05, 0.25, 1.2}}}}};

/// Equations 3.2 to 3.5 and 3.8 to 3.11: they differ in their numbers only.
class Eurocode8 : public TargetSpectrum {
 public:
  Eurocode8(Ground ground, double peak, double plateau, double damping, std::string told)
      : ground_(ground),
        peak_(peak),
        damping_(damping),
        top_(plateau * std::max(std::sqrt(0.10 / (0.05 + damping)), 0.55)),
        told_(std::move(told)) {}
  double at(double frequency) const override {
    const double t = 1 / frequency;
    if (t < ground_.t_b) return peak_ * (1 + t / ground_.t_b * (top_ - 1));
    const double after_plateau = t > ground_.t_c ? ground_.t_c / t : 1, after_velocity = t > ground_.t_d ? ground_.t_d / t : 1;
    return peak_ * top_ * after_plateau * after_velocity;
  }
  double peak_ground_acceleration() const override { return peak_; }
  double damping() const override { return damping_; }
  Band band() const override { return {0.25, 50}; }
  std::string told() const override { return told_; }

 private:
  Ground ground_;
  double peak_, damping_, top_;
  std::string told_;
};

std::unique_ptr<const TargetSpectrum> make_eurocode_8(const Values& v) {
  const auto type = static_cast<std::size_t>(v.integer("spectrum") - 1);
  const double a_g = v.number("a_g"), damping = v.number("damping");
  const std::string told = fmt::format("Eurocode 8, type {}, a_g {:g} m/s2, ", type + 1, a_g);
  if (v.text("direction") == "vertical") {
    constexpr Ground vertical{1, 0.05, 0.15, 1.0};
    return std::make_unique<Eurocode8>(vertical, (type == 0 ? 0.90 : 0.45) * a_g, 3.0, damping, told + "vertical");
  }
  const Ground ground = grounds_8[type][static_cast<std::size_t>(v.text("ground").front() - 'A')];
  return std::make_unique<Eurocode8>(ground, ground.s * a_g, 2.5, damping, told + "ground " + v.text("ground"));
}

// ---- the user's points ----

std::unique_ptr<const TargetSpectrum> make_target_table(const Values& v) {
  const std::vector<double>&frequencies = v.numbers("frequencies"), &values = v.numbers("accelerations");
  if (frequencies.size() < 2)
    throw InputError(v.where("frequencies"), v.path("frequencies"), "at least two frequencies", fmt::format("{}", frequencies.size()));
  if (values.size() != frequencies.size())
    throw InputError(v.where("accelerations"), v.path("accelerations"),
                     fmt::format("as many values as frequencies ({})", frequencies.size()), fmt::format("{}", values.size()));
  if (!(frequencies.front() > 0))
    throw InputError(v.where("frequencies"), v.path("frequencies"), "frequencies > 0 Hz", fmt::format("{:g} Hz", frequencies.front()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && !(frequencies[i] > frequencies[i - 1]))
      throw InputError(v.where("frequencies"), v.path("frequencies"), "frequencies in ascending order",
                       fmt::format("{:g} Hz after {:g} Hz", frequencies[i], frequencies[i - 1]));
    if (!(values[i] > 0))
      throw InputError(v.where("accelerations"), v.path("accelerations"), "accelerations > 0 m/s2", fmt::format("{:g} m/s2", values[i]));
  }
  return std::make_unique<CurveTarget>(Curve{frequencies, values, v.text("interpolation") == "logarithmic"}, 0.0, v.number("damping"),
                                       TargetSpectrum::Band{frequencies.front(), frequencies.back()},
                                       fmt::format("a table of {} points", values.size()));
}

}  // namespace

const Entry<TargetSpectrum>& entry_target_rg_1_60() {
  static const Entry<TargetSpectrum> entry{
      {.name = "rg_1_60",
       .summary = "design spectrum of nuclear plants, anchored to a peak ground acceleration",
       .equations = "straight lines in logarithms between the control points A (33 Hz), B (9 Hz), C (2.5 Hz; vertical 3.5 Hz) and\n"
                    "D (0.25 Hz): pga times the factor of the acceleration at A, B, C; at D w2 times the factor of the displacement\n"
                    "times 36 in * pga/(1 g). Constant above A, along constant displacement below D; factors linear in the damping.\n"
                    "pga is that of the horizontal motion for both directions.",
       .source = "US Regulatory Guide 1.60, revision 1 (1973), tables I and II",
       .params = {number("pga", "m/s2", "peak ground acceleration, horizontal").positive(), direction_field(), damping_field(0.005, 0.1)}},
      make_1_60};
  return entry;
}

const Entry<TargetSpectrum>& entry_target_eurocode_8() {
  static const Entry<TargetSpectrum> entry{
      {.name = "eurocode_8",
       .summary = "elastic spectrum of EN 1998-1, types 1 and 2, grounds A to E, recommended values",
       .equations = "S_e = a_g S (1 + T/T_B (2.5 eta - 1)) up to T_B, 2.5 eta a_g S up to T_C, times T_C/T up to T_D, times T_C T_D/T2\n"
                    "beyond; eta = sqrt(10/(5 + damping in per cent)) >= 0.55. Vertical: 3 instead of 2.5, a_vg = 0.9 a_g (type 1) or\n"
                    "0.45 a_g (type 2), S = 1 and T_B, T_C, T_D = 0.05, 0.15, 1 s on any ground. The code speaks for T <= 4 s.",
       .source = "EN 1998-1:2004, 3.2.2.2 (equations 3.2 to 3.6, tables 3.2 and 3.3) and 3.2.2.3 (equations 3.8 to 3.11, table 3.4)",
       .params = {number("a_g", "m/s2", "design ground acceleration on ground A").positive(),
                  choice("ground", {"A", "B", "C", "D", "E"}, "type of the ground").standard("A"),
                  integer("spectrum", "type of the spectrum: 1, or 2 for surface-wave magnitudes below 5.5").between(1, 2).standard(1),
                  direction_field(), damping_field(0.005, 0.3)}},
      make_eurocode_8};
  return entry;
}

const Entry<TargetSpectrum>& entry_target_table() {
  static const Entry<TargetSpectrum> entry{
      {.name = "table",
       .summary = "points given by the user",
       .equations = "straight lines between the points, in the logarithms of both axes or as they are; constant outside",
       .source = "",
       .params = {numbers("frequencies", "Hz", "ascending, > 0"), numbers("accelerations", "m/s2", "pseudo-accelerations there, > 0"),
                  choice("interpolation", {"logarithmic", "linear"}, "between the points").standard("logarithmic"),
                  damping_field(0.005, 0.3)}},
      make_target_table};
  return entry;
}

}  // namespace uplift
