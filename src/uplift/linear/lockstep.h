#pragma once
#include <condition_variable>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "uplift/linear/solver.h"

namespace uplift {

/// What several runs have had in common.
struct LockstepCounts {
  long factorisations = 0;  // made; each may serve all runs
  long solves = 0;          // halves of a back-solve, each for some runs at once
  long columns = 0;         // right-hand sides of all of them
};

/// The linear algebra of several runs of the same matrices, each in a thread of its own. Every run is given a solver (`seat`), with which
/// it works as with any other one, and what they ask for is done for all of them at once:
/// - A run that wants half a back-solve waits until all others wait, too, or have ended; then the right-hand sides of one factor are solved
///   together. Backward halves come first: a run that has fallen behind, because it halved a step, is soon beside the others again.
/// - A matrix that several runs factorise is factorised once; what counts are its numbers. A run that holds no factor waits before it
///   assembles the matrix of the next one until no other run works with one, so that the factor of one stage is gone before that of the
///   next one is made. Runs of another matrix come after those of the matrix that is found first.
/// The numbers of a run depend on nothing but this run: not on the others, their number, their order, or the time they take.
class Lockstep {
 public:
  /// At most `threads` runs compute at the same time, the others wait for their turn, and so many threads solve.
  Lockstep(std::size_t runs, int threads);
  ~Lockstep();
  Lockstep(const Lockstep&) = delete;
  Lockstep& operator=(const Lockstep&) = delete;
  /// What run number `run` uses instead of its own solver.
  /// `matrices`: the model that has its matrices; null: its own.
  std::shared_ptr<const LinearSolver> seat(std::size_t run, std::shared_ptr<const LinearSolver> own, const Model* model,
                                           const Model* matrices);
  /// A thread is about to begin with its run: waits for its turn.
  void begin(std::size_t run);
  /// The run is over, or will never begin. All that it was given by its seat must be gone.
  void end(std::size_t run);
  /// Does what the runs ask for, in the thread that calls it, until all have ended.
  void serve();
  const LockstepCounts& counts() const { return counts_; }  // after serve()

 private:
  class SeatSolver;
  class SeatFactor;
  class SeatSplitFactor;
  struct Made {
    std::shared_ptr<const Factor> factor;  // one of the two, or none
    std::shared_ptr<const SplitFactor> split;
    int failed_unknown = -1;
    std::string why;
    bool too_large = false;
  };
  /// What a run waits for: half a back-solve, room for the matrix of the next factor, or that it may make this factor.
  struct Request {
    enum class Kind { forward, backward, room, factor } kind = Kind::room;
    const SplitFactor* through = nullptr;  // of the halves
    const Vector* from = nullptr;
    Vector* to = nullptr;
    std::string key = {};  // of a factor
    std::exception_ptr trouble = {};
  };
  struct Seat {
    enum class State { ready, computing, asking, ended } state = State::ready;
    std::condition_variable turn;
    Request* request = nullptr;
    int held = 0;  // factors that the run has
  };
  struct Kept {
    std::weak_ptr<const Factor> factor;
    std::weak_ptr<const SplitFactor> split;
  };

  void ask(std::size_t run, Request& request);
  void wait_for_room(std::size_t run);
  Made factor(std::size_t run, const LinearSolver& solver, const Sparse& matrix, const std::vector<int>* last);
  Made make(const LinearSolver& solver, const Sparse& matrix, const std::vector<int>* last, const std::string& key);
  std::optional<Made> find(const std::string& key) const;
  void let_go(std::size_t run);
  std::shared_ptr<const SymmetricPair> pair(const Sparse& a, const Sparse& b);
  void give_turns();
  std::vector<Seat*> waiting_for(Request::Kind kind) const;
  std::vector<Seat*> chosen() const;
  void solve(const std::vector<Seat*>& seats);
  void solve_together(const std::vector<Request*>& requests);

  const int threads_;
  std::mutex mutex_;  // guards the rest, but for what the server does while no run computes
  std::condition_variable server_;
  std::vector<std::unique_ptr<Seat>> seats_;
  int computing_ = 0;
  std::mutex making_;  // one factor at a time
  std::map<std::string, Kept> kept_;
  std::string last_key_;
  Made last_made_;  // stays, a failure too, for those who come later until there is another one
  std::map<std::pair<const double*, const double*>, std::weak_ptr<const SymmetricPair>> pairs_;
  LockstepCounts counts_;
};

}  // namespace uplift
