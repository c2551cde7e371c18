#pragma once
#include <mpi.h>

#include <algorithm>
#include <cstdint>

// What the orders of rank 0 are carried out with (Ranks).
namespace uplift {

/// Any number of values to another rank: MPI counts a message with an int.
template <class Value>
void send(const Value* values, std::int64_t count, MPI_Datatype type, int to, MPI_Comm ranks) {
  constexpr std::int64_t most = 1 << 27;
  for (std::int64_t first = 0; first < count; first += most)
    MPI_Send(values + first, static_cast<int>(std::min(most, count - first)), type, to, 1, ranks);
}

/// From rank 0, as a rule.
template <class Value>
void receive(Value* values, std::int64_t count, MPI_Datatype type, MPI_Comm ranks, int from = 0) {
  constexpr std::int64_t most = 1 << 27;
  for (std::int64_t first = 0; first < count; first += most)
    MPI_Recv(values + first, static_cast<int>(std::min(most, count - first)), type, from, 1, ranks, MPI_STATUS_IGNORE);
}

/// Marks an order as begun, and as finished unless an exception comes between.
class HalfWay {
 public:
  explicit HalfWay(bool& mark) : mark_(mark) { mark_ = true; }
  HalfWay(const HalfWay&) = delete;
  HalfWay& operator=(const HalfWay&) = delete;
  void done() { mark_ = false; }

 private:
  bool& mark_;
};

}  // namespace uplift
