#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/motion/generate.h"

// What a user may choose of a generated motion.
namespace uplift {

namespace {

Envelope::Shape shape_of(const std::string& name) {
  using Shape = Envelope::Shape;
  for (const Shape shape : {Shape::trapezoid, Shape::jennings})
    if (name == to_string(shape)) return shape;
  return Shape::saragoni_hart;
}

[[noreturn]] void refuse(const Values& v, const char* key, const std::string& wanted, const std::string& found) {
  throw InputError(v.where(key), v.path(key), wanted, found);
}

Envelope envelope_of(const Values& v, double duration) {
  Envelope envelope{shape_of(v.text("envelope")), 0.15 * duration, 0.6 * duration};
  if (v.has("rise")) envelope.rise = v.number("rise");
  if (envelope.shape == Envelope::Shape::saragoni_hart) {
    if (v.has("fall")) refuse(v, "fall", "no such key with the envelope saragoni_hart", "one");
    if (!(envelope.rise < duration))
      refuse(v, "rise", fmt::format("a time before the end ({:g} s)", duration), fmt::format("{:g} s", envelope.rise));
    envelope.fall = envelope.rise;
    return envelope;
  }
  if (v.has("fall"))
    envelope.fall = v.number("fall");
  else
    envelope.fall = std::max(envelope.fall, envelope.rise);
  if (!(envelope.fall < duration))
    refuse(v, v.has("fall") ? "fall" : "rise", fmt::format("a time before the end ({:g} s)", duration),
           fmt::format("{:g} s", envelope.fall));
  if (!(envelope.rise <= envelope.fall))
    refuse(v, "rise", fmt::format("a time up to that of the fall ({:g} s)", envelope.fall), fmt::format("{:g} s", envelope.rise));
  return envelope;
}

}  // namespace

const Section& generate_section() {
  static const Section section{
      "generate",
      "a motion made to have a target spectrum",
      {number("duration", "s", "length of the motion").standard(20.0).between(1, 1000),
       number("step", "s", "time step").standard(0.005).between(1e-4, 0.1),
       integer("seed", "choice of the random numbers; the same seed gives the same motion").standard(1).nonnegative(),
       choice("envelope", {"jennings", "trapezoid", "saragoni_hart"}, "how the strength grows and fades").standard("jennings"),
       number("rise", "s", "end of the growth; absent: 0.15 duration").positive().optional(),
       number("fall", "s", "begin of the fading; absent: 0.6 duration").positive().optional(),
       number("from", "Hz", "lower end of the band of the fit; absent: that of the target, 4/duration at least").positive().optional(),
       number("to", "Hz", "upper end of the band of the fit; absent: that of the target, 0.4/step at most").positive().optional()}};
  return section;
}

GenerateOptions generate_options(const Values& v, const TargetSpectrum& target) {
  constexpr double most_points = 400000;
  GenerateOptions options;
  options.step = v.number("step");
  const double steps = std::round(v.number("duration") / options.step);
  options.duration = steps * options.step;
  if (steps + 1 > most_points)
    refuse(v, "step", fmt::format("a step of {:g} s at least: {:g} points at most", v.number("duration") / (most_points - 1), most_points),
           fmt::format("{:g} s", options.step));
  options.seed = static_cast<std::uint64_t>(v.integer("seed"));
  options.envelope = envelope_of(v, options.duration);
  const TargetSpectrum::Band band = target.band();
  options.from = v.has("from") ? v.number("from") : std::max(band.from, 4 / options.duration);
  options.to = v.has("to") ? v.number("to") : std::min(band.to, 0.4 / options.step);
  const double least = 1 / options.duration, most = 0.5 / options.step;
  if (options.from < least)
    refuse(v, "from", fmt::format("a frequency with one period at least in the duration ({:g} Hz)", least),
           fmt::format("{:g} Hz", options.from));
  if (options.to > most)
    refuse(v, "to", fmt::format("a frequency with two steps at least in a period ({:g} Hz)", most), fmt::format("{:g} Hz", options.to));
  if (!(options.to > 1.5 * options.from))
    refuse(v, v.has("to") ? "to" : "from", fmt::format("a band of half an octave at least: more than {:g} Hz", 1.5 * options.from),
           fmt::format("{:g} Hz", options.to));
  return options;
}

}  // namespace uplift
