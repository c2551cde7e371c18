#include "uplift/statistics/random.h"

#include "uplift/statistics/distributions.h"

namespace uplift {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t first = std::uint64_t{0xD2511F53} * counter[0], second = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
               static_cast<std::uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

std::uint64_t CounterRandom::bits(std::uint64_t sample, std::uint32_t variable) const {
  const auto words = philox({static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32), variable, stream_},
                            {static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(seed_ >> 32)});
  return std::uint64_t{words[1]} << 32 | words[0];
}

double CounterRandom::uniform(std::uint64_t sample, std::uint32_t variable) const {
  return (static_cast<double>(bits(sample, variable) >> 12) + 0.5) * 0x1p-52;  // with 53 bits the largest would round to 1
}

double CounterRandom::normal(std::uint64_t sample, std::uint32_t variable) const {
  return normal_quantile(uniform(sample, variable));
}

}  // namespace uplift
