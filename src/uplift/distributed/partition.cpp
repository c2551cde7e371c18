// The graph of a partition is on the last rank alone: rank 0, which has mesh and model, sends it the sets of vertices in pieces. On
// one process, with one thread (Petsc) and the same random numbers PTScotch finds the same partition each time.
#include "uplift/distributed/partition.h"

#include <petscmat.h>
// clang-format off
#include <cstdint>  // scotch.h asks for both
#include <cstdio>
#include <scotch.h>
// clang-format on

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include "uplift/distributed/messages.h"
#include "uplift/distributed/petsc.h"
#include "uplift/distributed/ranks.h"
#include "uplift/linear/memory.h"

namespace uplift {

PartitionGraph::PartitionGraph(std::vector<PetscInt> unknowns, std::vector<std::size_t> start, std::vector<PetscInt> member)
    : unknowns_(std::move(unknowns)) {
  const std::size_t vertices = unknowns_.size();
  std::vector<std::size_t> begin(vertices + 1, 0);  // of the sets of each vertex
  for (const PetscInt vertex : member) ++begin[static_cast<std::size_t>(vertex) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<PetscInt> sets(member.size());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t set = 0; set + 1 < start.size(); ++set)
    for (std::size_t k = start[set]; k < start[set + 1]; ++k)
      sets[next[static_cast<std::size_t>(member[k])]++] = static_cast<PetscInt>(set);
  std::vector<PetscInt> seen(vertices, -1);
  const auto each_neighbour = [&](std::size_t vertex, const auto& take) {
    seen[vertex] = static_cast<PetscInt>(vertex);
    for (std::size_t k = begin[vertex]; k < begin[vertex + 1]; ++k) {
      const auto set = static_cast<std::size_t>(sets[k]);
      for (std::size_t m = start[set]; m < start[set + 1]; ++m)
        if (std::exchange(seen[static_cast<std::size_t>(member[m])], static_cast<PetscInt>(vertex)) != static_cast<PetscInt>(vertex))
          take(member[m]);
    }
  };
  PetscMalloc1(vertices + 1, &first_);
  std::int64_t neighbours = 0;
  for (std::size_t vertex = 0; vertex < vertices && neighbours <= PETSC_MAX_INT; ++vertex) {
    first_[vertex] = static_cast<PetscInt>(neighbours);
    each_neighbour(vertex, [&](PetscInt) { ++neighbours; });
  }
  if (neighbours > PETSC_MAX_INT) {
    PetscFree(first_);
    return;
  }
  first_[vertices] = static_cast<PetscInt>(neighbours);
  PetscMalloc1(std::max<std::size_t>(static_cast<std::size_t>(first_[vertices]), 1), &neighbour_);
  std::ranges::fill(seen, -1);
  for (std::size_t vertex = 0; vertex < vertices; ++vertex) {
    PetscInt* place = neighbour_ + first_[vertex];
    each_neighbour(vertex, [&](PetscInt other) { *place++ = other; });
    std::sort(neighbour_ + first_[vertex], place);
  }
  const auto size = static_cast<PetscInt>(vertices);
  MatCreateMPIAdj(PETSC_COMM_SELF, size, size, first_, neighbour_, nullptr, &graph_);
}

PartitionGraph::~PartitionGraph() {
  MatDestroy(&graph_);
}

std::vector<PetscInt> PartitionGraph::divide(PetscInt parts) const {
  constexpr double most = 1.05;  // imbalance
  std::vector<PetscInt> by_number = ranges(parts);
  if (graph_ == nullptr) return by_number;
  std::vector<PetscInt> by_graph = partition(parts);
  const bool balanced = !by_graph.empty() && imbalance(by_graph, parts) <= std::max(most, imbalance(by_number, parts));
  return balanced && halo(by_graph) < halo(by_number) ? by_graph : by_number;
}

std::vector<PetscInt> PartitionGraph::ranges(PetscInt parts) const {
  const auto all = std::accumulate(unknowns_.begin(), unknowns_.end(), std::int64_t{0});
  std::vector<PetscInt> part;
  std::int64_t before = 0;
  for (const PetscInt unknowns : unknowns_) {
    part.push_back(static_cast<PetscInt>((2 * before + unknowns) * parts / (2 * all)));
    before += unknowns;
  }
  return part;
}

std::vector<PetscInt> PartitionGraph::partition(PetscInt parts) const {
  std::vector<PetscInt> part;
  if (const PetscErrorCode error = ask_ptscotch(parts, part); error != 0) take_petsc_error(), part.clear();
  return part;
}

PetscErrorCode PartitionGraph::ask_ptscotch(PetscInt parts, std::vector<PetscInt>& part) const {
  PetscFunctionBeginUser;
  const auto vertices = static_cast<PetscInt>(unknowns_.size());
  PetscInt* unknowns = nullptr;  // PETSc frees them
  MatPartitioning partitioning = nullptr;
  IS found = nullptr;
  PetscCall(PetscMalloc1(unknowns_.size(), &unknowns));
  std::ranges::copy(unknowns_, unknowns);
  PetscCall(MatPartitioningCreate(PETSC_COMM_SELF, &partitioning));
  PetscCall(MatPartitioningSetAdjacency(partitioning, graph_));
  PetscCall(MatPartitioningSetType(partitioning, MATPARTITIONINGPTSCOTCH));
  PetscCall(MatPartitioningSetNParts(partitioning, parts));
  PetscCall(MatPartitioningSetVertexWeights(partitioning, unknowns));
  SCOTCH_randomSeed(1);  // of builds that take the time for it
  SCOTCH_randomReset();  // else it goes on where the last partition has left the random numbers
  PetscCall(MatPartitioningApply(partitioning, &found));
  const PetscInt* numbers = nullptr;
  PetscCall(ISGetIndices(found, &numbers));
  part.assign(numbers, numbers + vertices);
  PetscCall(ISRestoreIndices(found, &numbers));
  PetscCall(ISDestroy(&found));
  PetscCall(MatPartitioningDestroy(&partitioning));
  PetscFunctionReturn(0);
}

double PartitionGraph::halo(const std::vector<PetscInt>& part) const {
  double sum = 0;
  std::vector<PetscInt> others;
  for (std::size_t vertex = 0; vertex < part.size(); ++vertex) {
    others.clear();
    for (PetscInt k = first_[vertex]; k < first_[vertex + 1]; ++k)
      if (const PetscInt other = part[static_cast<std::size_t>(neighbour_[k])];
          other != part[vertex] && std::ranges::find(others, other) == others.end())
        others.push_back(other);
    sum += static_cast<double>(others.size()) * unknowns_[vertex];
  }
  return sum;
}

double PartitionGraph::imbalance(const std::vector<PetscInt>& part, PetscInt parts) const {
  std::vector<double> sums(static_cast<std::size_t>(parts), 0);
  for (std::size_t vertex = 0; vertex < part.size(); ++vertex) sums[static_cast<std::size_t>(part[vertex])] += unknowns_[vertex];
  return std::ranges::max(sums) * parts / std::accumulate(sums.begin(), sums.end(), 0.0);
}

namespace {

constexpr std::size_t piece = 1 << 16;  // numbers of a message

/// Sends sets: the sizes of those of a piece, then their members. A piece without sets is the last one.
class SetSender {
 public:
  SetSender(int to, MPI_Comm ranks) : to_(to), ranks_(ranks) {}
  void add(std::span<const int> set) {
    sizes_.push_back(static_cast<int>(set.size()));
    members_.insert(members_.end(), set.begin(), set.end());
    if (members_.size() >= piece) send_piece();
  }
  void end() {
    if (!sizes_.empty()) send_piece();
    send_piece();
  }

 private:
  void send_piece() {
    const std::int64_t counts[2] = {std::ssize(sizes_), std::ssize(members_)};
    send(counts, 2, MPI_INT64_T, to_, ranks_);
    send(sizes_.data(), counts[0], MPI_INT, to_, ranks_);
    send(members_.data(), counts[1], MPI_INT, to_, ranks_);
    sizes_.clear(), members_.clear();
  }
  int to_;
  MPI_Comm ranks_;
  std::vector<int> sizes_, members_;
};

PartitionGraph receive_graph(std::int64_t vertices, MPI_Comm ranks) {
  std::vector<PetscInt> unknowns(static_cast<std::size_t>(vertices)), member, sizes;
  receive(unknowns.data(), vertices, MPI_INT, ranks);
  std::vector<std::size_t> start{0};
  for (;;) {
    std::int64_t counts[2] = {};
    receive(counts, 2, MPI_INT64_T, ranks);
    if (counts[0] == 0) return {std::move(unknowns), std::move(start), std::move(member)};
    sizes.resize(static_cast<std::size_t>(counts[0]));
    receive(sizes.data(), counts[0], MPI_INT, ranks);
    for (const PetscInt size : sizes) start.push_back(start.back() + static_cast<std::size_t>(size));
    member.resize(start.back());
    receive(member.data() + member.size() - static_cast<std::size_t>(counts[1]), counts[1], MPI_INT, ranks);
  }
}

}  // namespace

std::vector<int> Ranks::divide(const CoupledVertices& graph) {
  if (count_ == 1) return std::vector<int>(graph.unknowns.size(), 0);
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Order order{What::divide, 0, std::ssize(graph.unknowns)};
  tell(order);
  std::vector<int> part = divide_together(order, &graph);
  half_way.done();
  return part;
}

/// `graph`: on rank 0, which gets the parts from the last rank.
std::vector<int> Ranks::divide_together(const Order& order, const CoupledVertices* graph) const {
  const int last = count_ - 1;
  std::vector<int> part;
  if (graph != nullptr) {
    send(graph->unknowns.data(), order.rows, MPI_INT, last, ranks_);
    SetSender sender(last, ranks_);
    graph->each_set([&](std::span<const int> set) { sender.add(set); });
    sender.end();
    part.resize(graph->unknowns.size());
    receive(part.data(), order.rows, MPI_INT, ranks_, last);
  } else if (rank_ == last) {
    part = receive_graph(order.rows, ranks_).divide(count_);
    give_back_free_memory();
    send(part.data(), order.rows, MPI_INT, 0, ranks_);
  }
  return part;
}

}  // namespace uplift
