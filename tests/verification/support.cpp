#include "support.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "data_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

namespace uplift::verification {
namespace {

const std::vector<double>& named(const std::vector<std::string>& names, const std::vector<std::vector<double>>& columns,
                                 std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::out_of_range(fmt::format("no column \"{}\" among: {}", name, fmt::join(names, ", ")));
  return columns[static_cast<std::size_t>(found - names.begin())];
}

}  // namespace

const std::vector<double>& History::operator[](std::string_view name) const {
  return named(names, columns, name);
}

double History::peak(std::string_view name, double until) const {
  const std::vector<double>& values = (*this)[name];
  double largest = 0;
  for (std::size_t i = 0; i < rows(); ++i)
    if (time()[i] <= until) largest = std::max(largest, std::abs(values[i]));
  return largest;
}

double History::mechanical_energy(std::size_t row) const {
  return (*this)["energy.kinetic"][row] + (*this)["energy.strain"][row] + (*this)["energy.stored"][row];
}

History run_text(const std::string& toml) {
  const Case read = check_case(read_toml_text(toml, "case.toml"), "case.toml");
  BuiltCase built = build(read, RunSpec{});
  built.plan.frames = 0;
  RunResult result = run(built.model, built.plan, built.behaviours);
  History history;
  history.status = to_string(result.status);
  history.reason = result.reason;
  history.names = {"t"};
  for (const Request& request : result.columns) history.names.push_back(request.name);
  history.columns = std::move(result.table);
  return history;
}

const std::vector<double>& Reference::operator[](std::string_view name) const {
  return named(names, columns, name);
}

Reference reference(const std::string& file) {
  Reference result;
  std::ifstream in(support::data_file("reference/" + file));
  std::string line, cell;
  while (std::getline(in, line)) {
    while (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty() || line.front() == '#') continue;
    std::istringstream cells(line);
    if (result.names.empty()) {
      while (std::getline(cells, cell, ',')) result.names.push_back(cell);
      result.columns.resize(result.names.size());
      continue;
    }
    for (std::size_t k = 0; k < result.names.size() && std::getline(cells, cell, ','); ++k) {
      if (k == 0) result.words.push_back(cell);
      char* end = nullptr;
      const double value = std::strtod(cell.c_str(), &end);
      result.columns[k].push_back(end == cell.c_str() ? std::nan("") : value);  // a word, as the name of a scheme
    }
  }
  if (result.columns.empty() || result.columns.front().empty()) throw std::runtime_error("no table in " + file);
  return result;
}

double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at) {
  const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, at);
  const std::size_t i = static_cast<std::size_t>(above - x.begin());
  return y[i - 1] + (y[i] - y[i - 1]) * (at - x[i - 1]) / (x[i] - x[i - 1]);
}

double order(const std::vector<double>& step, const std::vector<double>& error) {
  return std::log(error.front() / error.back()) / std::log(step.front() / step.back());
}

double Bar::wave_speed() const {
  return std::sqrt(modulus / density);
}

double Bar::time_step() const {
  return step > 0 ? step : length / elements / wave_speed();
}

std::string Bar::text() const {
  std::string out = "title = \"Bar on a wall\"\n";
  if (!method.empty()) out += fmt::format("method = {}\n", method);
  out += fmt::format("impact = {}\n[nodes]\n", impact);
  for (int i = 0; i <= elements; ++i) out += fmt::format("n{} = [0, {:.17g}]\n", i, length * i / elements);
  for (int i = 0; i < elements; ++i)
    out += fmt::format(
        "[[beam]]\nname = \"b{}\"\nnodes = [\"n{}\", \"n{}\"]\nE = {:.17g}\nI = 1.0\nA = {:.17g}\nmass = \"lumped\"\ndensity = {:.17g}\n",
        i, i, i + 1, modulus, area, density);
  for (int i = 0; i <= elements; ++i) out += fmt::format("[[support]]\nnode = \"n{}\"\nfixed = [\"ux\", \"rz\"]\n", i);
  if (velocity != 0)
    for (int i = 0; i <= elements; ++i) out += fmt::format("[[initial]]\nnode = \"n{}\"\nvelocity = [0, {:.17g}]\n", i, velocity);
  out += fmt::format("[[interface]]\nname = \"foot\"\ngap = {:.17g}\npairs = {{ upper = [\"n0\"], area = 1 }}\nlaw = {}\n", gap, law);
  if (gravity != 0) out += fmt::format("[gravity]\nacceleration = [0, {:.17g}]\n", -gravity);
  out += stages;
  out += fmt::format("[[stage]]\ntype = \"dynamic\"\nduration = {:.17g}\nstep = {:.17g}\nscheme = {}\ntraction = \"{}\"\n", duration,
                     time_step(), scheme, traction);
  out += fmt::format("[energy]\ncreated_limit = 1e9\n[output]\nframes = 0\nautomatic = false\nevery = {}\n", every);
  out +=
      "history = [{ interface = \"foot\", point = 1, quantity = \"traction\" }, { interface = \"foot\", point = 1, quantity = "
      "\"mean_traction\" },\n"
      "  { interface = \"foot\", point = 1, quantity = \"opening\" },\n"
      "  { name = \"low\", node = \"n0\", quantity = \"uy\" }, { name = \"low.v\", node = \"n0\", quantity = \"vy\" },\n";
  for (int i = 0; i <= 10; ++i) out += fmt::format("  {{ name = \"at{}\", node = \"n{}\", quantity = \"uy\" }},\n", i, i * elements / 10);
  out += fmt::format("  {{ name = \"high\", node = \"n{}\", quantity = \"uy\" }}]\n", elements);
  return out;
}

double mean_height(const History& bar, std::size_t row) {
  double sum = 0;
  for (int i = 0; i <= 10; ++i) sum += (i == 0 || i == 10 ? 0.05 : 0.1) * bar["at" + std::to_string(i)][row];
  return sum;
}

}  // namespace uplift::verification
