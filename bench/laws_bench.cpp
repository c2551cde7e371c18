#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "uplift/laws/law.h"

// Time of one batch call of every interface law: a rocking footing (normal component only, heel open, toe pressed) that moves a little
// within what it has already seen, so that no point passes its threshold; and, for the laws with a memory, a heel that opens further than
// ever before.
namespace {

using namespace uplift;

std::unique_ptr<const InterfaceLaw> law_with_usual_parameters(const Entry<InterfaceLaw>& entry) {
  const std::map<std::string_view, double> usual{{"K_n", 1e9}, {"F_u", 1e5}, {"G_f", 100}, {"F_c", -2e4}};
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::string(entry.name), {}, {}});
  for (const Field& field : entry.params)
    if (const auto value = usual.find(field.name); value != usual.end())
      table->entries.emplace_back(field.name, Raw{value->second, {}, {}});
  return make_part(law_catalog(), check_part(Raw{table, {}, "law"}, interface_behaviours()));
}

/// A footing that has been open to `seen` times its present rotation.
struct Footing {
  Footing(const InterfaceLaw& law, int points, double seen) : batch{points, 1, 1e-3} {
    const auto n = static_cast<std::size_t>(points);
    std::vector<double> zero(n), first(n * 4), spare(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double place = (static_cast<double>(i) + 0.5) / points;
      from.push_back(1e-3 * (place - 0.3));
      to.push_back(1e-3 * (place * 1.01 - 0.301));
      spare[i] = seen * from[i];
    }
    old.resize(n * 4);
    now.resize(n * 4);
    traction.resize(n);
    slope.resize(n);
    end.resize(n);
    LawResponse response{traction.data(), slope.data(), old.data(), end.data()};
    law.mean(batch, zero.data(), spare.data(), first.data(), response);
  }
  LawResponse response() { return {traction.data(), slope.data(), now.data(), end.data()}; }

  Batch batch;
  std::vector<double> from, to, old, now, traction, slope, end;
};

enum Question { path_average, end_of_step, energies };

void time_law(benchmark::State& state, Question question, double seen) {
  const Entry<InterfaceLaw>& entry = *law_catalog()[static_cast<std::size_t>(state.range(0))];
  const auto law = law_with_usual_parameters(entry);
  Footing footing(*law, static_cast<int>(state.range(1)), seen);
  const LawResponse response = footing.response();
  for (auto _ : state) {
    if (question == path_average)
      law->mean(footing.batch, footing.from.data(), footing.to.data(), footing.old.data(), response);
    else if (question == end_of_step)
      law->respond(footing.batch, footing.from.data(), footing.to.data(), footing.old.data(), response);
    else
      law->energy(footing.batch, footing.to.data(), footing.old.data(), response.traction, response.slope);
    benchmark::ClobberMemory();
  }
  state.SetLabel(std::string(entry.name));
  state.SetItemsProcessed(state.iterations() * footing.batch.points);
}

void every_law(benchmark::internal::Benchmark* bench) {
  for (std::size_t law = 0; law < law_catalog().size(); ++law)
    for (const int points : {40, 4000}) bench->Args({static_cast<long>(law), points});
}

void law_mean(benchmark::State& state) {
  time_law(state, path_average, 2);
}
void law_respond(benchmark::State& state) {
  time_law(state, end_of_step, 2);
}
void law_energy(benchmark::State& state) {
  time_law(state, energies, 2);
}
void law_mean_softening(benchmark::State& state) {
  time_law(state, path_average, 1);
}
void law_respond_softening(benchmark::State& state) {
  time_law(state, end_of_step, 1);
}

BENCHMARK(law_mean)->Apply(every_law);
BENCHMARK(law_respond)->Apply(every_law);
BENCHMARK(law_energy)->Apply(every_law);
BENCHMARK(law_mean_softening)->Apply(every_law);
BENCHMARK(law_respond_softening)->Apply(every_law);

}  // namespace
