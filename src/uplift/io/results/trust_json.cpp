#include "uplift/io/results/trust_json.h"

#include <fmt/format.h>

#include <initializer_list>

#include "uplift/io/results/words.h"

namespace uplift {
namespace {

void write_run(ResultWriter& out, const TrustRun& run) {
  out.text("name", run.name, "name of the run");
  out.text("choice", run.choice, "choice that was changed");
  out.text("label", run.label, "what it was changed to");
  out.word("status", to_string(run.status), run_status_words(), "outcome");
  out.word("bonded_status", to_string(run.bonded_status), run_status_words(), "outcome of its bonded reference run");
  out.text("reason", run.reason, "why it failed or stopped");
  out.flag("counts", run.counts(), "whether it counts for the bands");
  out.number("wall_seconds", run.wall, "s", "elapsed time of both runs");
}

void write_band(ResultWriter& out, const TrustBand& band) {
  static const VerdictQuantity none{"", "", "", ""};
  const VerdictQuantity& quantity = band.quantity ? *band.quantity : none;
  constexpr std::string_view unit = "as stated in unit";
  out.text("quantity", quantity.name, "quantity of the verdict");
  out.text("interface", band.interface, "interface or beam; empty: the run as a whole");
  out.text("unit", quantity.unit, "unit of the numbers beside it");
  out.number("value", band.value, unit, "value of the case as it stands");
  out.number("least", band.least, unit, "smallest value of all runs that count");
  out.number("most", band.most, unit, "largest value of all runs that count");
  out.when(band.swing > 0).number("swing", band.swing, unit, "half of the range in which a residual value of the case still varies");
  out.number("band", band.quantity ? band.share() : std::nullopt, "1",
             "half of the range divided by the value; absent where the value can be near zero or does not change");
  out.text("dominant", band.dominant, "choice with the largest deviation; empty: no choice changes the value");
  out.numbers_or_null("values", band.values, unit, "values of the repetitions in the order of `runs`; null: the run has none");
}

void write_spectrum(ResultWriter& out, const TrustSpectrum& spectrum) {
  out.text("floor", spectrum.floor, "name of the floor");
  out.number("damping", spectrum.damping, "1", "damping ratio of the equipment");
  out.number("speaks_to", spectrum.speaks_to, "Hz", "frequency up to which the spectrum is reliable; 0: nowhere");
  out.text("limited_by", spectrum.limited_by, "choice that limits this frequency; empty: none does");
  out.list("reaches", "frequency up to which the spectrum is reliable, by choice", spectrum.reaches,
           [&](const TrustSpectrum::Reach& reach) {
             out.text("choice", reach.choice, "choice");
             out.number("to", reach.to, "Hz", "frequency");
           });
  const bool above = spectrum.above_broadened.has_value();
  out.number("above_broadened", spectrum.above_broadened, "1",
             "largest excess of the raw curve of a repetition over the broadened curve of the case; 0: nowhere");
  out.when(above).number("above_at", spectrum.above_at, "Hz", "frequency of this excess");
  out.numbers("frequencies", spectrum.frequencies, "Hz", "frequencies of the curves");
  out.numbers("value", spectrum.value, "m/s2", "pseudo-acceleration of the case as it stands");
  out.numbers("least", spectrum.least, "m/s2", "smallest of all runs that count");
  out.numbers("most", spectrum.most, "m/s2", "largest of all runs that count");
}

void write_trust(ResultWriter& out, const TrustAnswer& answer) {
  out.constant("format", "uplift-trust-1", "format of this document");
  out.flag("complete", answer.complete, "whether no repetition was interrupted");
  out.text("dominant", answer.dominant, "choice that is most often the one with the largest deviation");
  out.count("interior", answer.interior, "stiffnesses computed between the case and each end; 0: only the ends");
  out.number("spectrum_band", answer.accepted, "1", "accepted deviation of a floor spectrum (`trust.spectrum_band`)");
  out.object("base", "the case as it stands", [&] { write_run(out, answer.base); });
  out.list("runs", "repetitions, each with one changed choice", answer.runs, [&](const TrustRun& run) { write_run(out, run); });
  out.list("not_changed", "choices that cannot be changed", answer.left_out, [&](const TrustPlan::LeftOut& each) {
    out.text("choice", each.choice, "choice");
    out.text("reason", each.reason, "why it cannot be changed");
  });
  out.list("bands", "numbers of the verdict with their bands", answer.bands, [&](const TrustBand& band) { write_band(out, band); });
  out.list("spectra", "floor spectra with their bands", answer.spectra,
           [&](const TrustSpectrum& spectrum) { write_spectrum(out, spectrum); });
}

}  // namespace

std::string trust_json(const TrustAnswer& answer) {
  JsonWriter json(0, 2);
  json.begin_object();
  ResultWriter out(json);
  write_trust(out, answer);
  json.end_object();
  return json.take() + "\n";
}

std::string trust_schema() {
  ResultWriter out("trust.json", "All values of the repetitions of `uplift trust`. Numbers are in SI units.");
  write_trust(out, {});
  return out.schema();
}

std::string trust_sentence(const TrustAnswer& answer) {
  if (!answer.base.counts())
    return fmt::format("No bands: the run of the case {}.", answer.base.status == RunStatus::failed ? "failed" : "was interrupted");
  if (answer.runs.empty()) return "Nothing was changed.";
  const std::size_t all = answer.runs.size(), counted = answer.counted();
  if (counted == 0) return fmt::format("No bands: none of the {} runs with a changed choice was completed.", all);
  const std::string over = counted == all ? "all changed choices" : fmt::format("{} of {} changed choices", counted, all);
  std::string text;
  for (const QuantityName name : std::initializer_list<QuantityName>{"max_uplifted_ratio", "max_opening", "max_moment"})
    for (const TrustBand& band : answer.bands) {
      if (!band.quantity->is(name)) continue;
      text += fmt::format("{}{} from {} to {}", text.empty() ? "Over " + over + ": " : ", ", band.quantity->brief,
                          band.format_value(band.least), band.format_value(band.most));
      break;  // of the first interface
    }
  if (text.empty()) return "";
  text += answer.dominant.empty() ? "." : fmt::format(". What moves most numbers most is the {}.", answer.dominant);
  if (answer.interior == 0)
    return text + " Only the ends of each range were computed: where uplift responds unsteadily, values between them may lie outside.";
  return text + fmt::format(" Between the case and each end of the stiffness {} computed too.",
                            answer.interior == 1 ? "one value was" : fmt::format("{} values were", answer.interior));
}

}  // namespace uplift
