#include "uplift/linear/lockstep.h"

#include <algorithm>
#include <future>
#include <string_view>
#include <typeinfo>
#include <utility>

#include "uplift/base/file.h"
#include "uplift/linear/large.h"
#include "uplift/linear/supernodal.h"

namespace uplift {

namespace {

template <class Number>
std::string_view bytes_of(const Number* numbers, Index count) {
  return {reinterpret_cast<const char*>(numbers), static_cast<std::size_t>(count) * sizeof(Number)};
}

/// Tells matrices, orders and solvers apart by their numbers.
std::string key_of(const LinearSolver& solver, const Sparse& given, const std::vector<int>* last) {
  Sparse compressed;
  if (!given.isCompressed()) compressed = given, compressed.makeCompressed();
  const Sparse& a = given.isCompressed() ? given : compressed;
  std::string all = typeid(solver).name();
  all += sha256(bytes_of(a.outerIndexPtr(), a.outerSize() + 1)) + sha256(bytes_of(a.innerIndexPtr(), a.nonZeros())) +
         sha256(bytes_of(a.valuePtr(), a.nonZeros()));
  return last != nullptr ? all + sha256(bytes_of(last->data(), std::ssize(*last))) : all;
}

}  // namespace

/// A factor of several runs as one of them sees it.
class Lockstep::SeatFactor final : public FactorWithReach {
 public:
  SeatFactor(Lockstep& all, std::size_t run, std::shared_ptr<const Factor> shared) : all_(all), run_(run), shared_(std::move(shared)) {}
  double reach() const override { return reach_of(*shared_); }
  ~SeatFactor() override { all_.let_go(run_); }
  SeatFactor(const SeatFactor&) = delete;
  SeatFactor& operator=(const SeatFactor&) = delete;
  void solve(const Matrix& b, Matrix& x) const override { shared_->solve(b, x); }
  void solve_to(const Matrix& b, Matrix& x, double residual) const override { uplift::solve_to(*shared_, b, x, residual); }
  double nonzeros() const override { return shared_->nonzeros(); }
  Factorisation refactorise(const Sparse& a) const override { return shared_->refactorise(a); }

 private:
  Lockstep& all_;
  std::size_t run_;
  std::shared_ptr<const Factor> shared_;
};

/// The same for a factor in two halves.
class Lockstep::SeatSplitFactor final : public SplitFactor {
 public:
  SeatSplitFactor(Lockstep& all, std::size_t run, std::shared_ptr<const SplitFactor> shared)
      : all_(all), run_(run), shared_(std::move(shared)) {}
  ~SeatSplitFactor() override { all_.let_go(run_); }
  SeatSplitFactor(const SeatSplitFactor&) = delete;
  SeatSplitFactor& operator=(const SeatSplitFactor&) = delete;
  void forward(const Vector& b, Vector& y) const override { half(Request::Kind::forward, b, y); }
  void backward(const Vector& y, Vector& x) const override { half(Request::Kind::backward, y, x); }
  Matrix last() const override { return shared_->last(); }
  double nonzeros() const override { return shared_->nonzeros(); }
  SplitFactorisation refactorise(const Sparse& a) const override { return shared_->refactorise(a); }

 private:
  /// A new factor is tried on a load first (BulkFactor): while a run waited with that, its matrix would stay beside those of the others.
  void half(Request::Kind kind, const Vector& from, Vector& to) const {
    const bool forward = kind == Request::Kind::forward;
    if (std::exchange(forward ? forward_tried_ : backward_tried_, true) == false)
      return forward ? shared_->forward(from, to) : shared_->backward(from, to);
    Request request;
    request.kind = kind;
    request.through = shared_.get();
    request.from = &from, request.to = &to;
    all_.ask(run_, request);
  }

  Lockstep& all_;
  std::size_t run_;
  std::shared_ptr<const SplitFactor> shared_;
  mutable bool forward_tried_ = false, backward_tried_ = false;
};

class Lockstep::SeatSolver final : public SolverOfStatics {
 public:
  SeatSolver(Lockstep& all, std::size_t run, std::shared_ptr<const LinearSolver> own, const Model* model, const Model* matrices)
      : all_(all), run_(run), own_(std::move(own)), model_(model), matrices_(matrices) {}
  Factorisation factorise(const Sparse& a) const override {
    Made made = all_.factor(run_, *own_, a, nullptr);
    std::unique_ptr<const Factor> mine;
    if (made.factor != nullptr) mine = std::make_unique<SeatFactor>(all_, run_, std::move(made.factor));
    return {.factor = std::move(mine), .failed_unknown = made.failed_unknown, .why = std::move(made.why), .too_large = made.too_large};
  }
  SplitFactorisation factorise_split(const Sparse& a, const std::vector<int>& last) const override {
    Made made = all_.factor(run_, *own_, a, &last);
    std::unique_ptr<const SplitFactor> mine;
    if (made.split != nullptr) mine = std::make_unique<SeatSplitFactor>(all_, run_, std::move(made.split));
    return {.factor = std::move(mine), .failed_unknown = made.failed_unknown, .why = std::move(made.why), .too_large = made.too_large};
  }
  /// Not shared with other runs.
  std::unique_ptr<const LinearSolver> for_statics(const RigidMotions& motions) const override { return solver_for_statics(*own_, motions); }
  FactorCost predict(const Sparse& a, const std::vector<int>& last) const override { return own_->predict(a, last); }
  std::shared_ptr<const SymmetricPair> pair(const Sparse& a, const Sparse& b) const override { return all_.pair(a, b); }
  void wait_for_room() const override { all_.wait_for_room(run_); }
  const Model& matrices_of(const Model& model) const override { return &model == model_ && matrices_ != nullptr ? *matrices_ : model; }

 private:
  Lockstep& all_;
  std::size_t run_;
  std::shared_ptr<const LinearSolver> own_;
  const Model *model_, *matrices_;
};

Lockstep::Lockstep(std::size_t runs, int threads) : threads_(std::max(1, threads)) {
  for (std::size_t k = 0; k < runs; ++k) seats_.push_back(std::make_unique<Seat>());
}

Lockstep::~Lockstep() = default;

std::shared_ptr<const LinearSolver> Lockstep::seat(std::size_t run, std::shared_ptr<const LinearSolver> own, const Model* model,
                                                   const Model* matrices) {
  return std::make_shared<const SeatSolver>(*this, run, std::move(own), model, matrices);
}

/// Lets as many runs compute as may, in their order; with none left the server has something to do.
void Lockstep::give_turns() {
  for (const std::unique_ptr<Seat>& seat : seats_) {
    if (computing_ >= threads_) return;
    if (seat->state != Seat::State::ready) continue;
    seat->state = Seat::State::computing;
    ++computing_;
    seat->turn.notify_one();
  }
  if (computing_ == 0) server_.notify_one();
}

void Lockstep::begin(std::size_t run) {
  std::unique_lock lock(mutex_);
  Seat& seat = *seats_[run];
  seat.turn.wait(lock, [&] { return seat.state == Seat::State::computing; });
}

void Lockstep::end(std::size_t run) {
  const std::lock_guard lock(mutex_);
  Seat& seat = *seats_[run];
  if (seat.state == Seat::State::computing) --computing_;
  seat.state = Seat::State::ended;
  give_turns();
}

void Lockstep::ask(std::size_t run, Request& request) {
  std::unique_lock lock(mutex_);
  Seat& seat = *seats_[run];
  seat.request = &request;
  seat.state = Seat::State::asking;
  --computing_;
  give_turns();
  seat.turn.wait(lock, [&] { return seat.state == Seat::State::computing; });
  seat.request = nullptr;
  if (request.trouble != nullptr) std::rethrow_exception(request.trouble);
}

void Lockstep::wait_for_room(std::size_t run) {
  {
    const std::lock_guard lock(mutex_);
    if (seats_[run]->held > 0) return;
  }
  Request request;
  ask(run, request);
}

/// A run that has no factor and wants one that is not there waits until no other run works with one.
Lockstep::Made Lockstep::factor(std::size_t run, const LinearSolver& solver, const Sparse& matrix, const std::vector<int>* last) {
  Request request;
  request.kind = Request::Kind::factor;
  request.key = key_of(solver, matrix, last);
  Seat& mine = *seats_[run];
  const auto works = [&](const std::unique_ptr<Seat>& seat) { return seat->held > 0; };
  for (;; ask(run, request)) {
    const std::lock_guard one_at_a_time(making_);
    std::unique_lock lock(mutex_);
    std::optional<Made> made = find(request.key);
    if (!made && mine.held == 0 && std::ranges::any_of(seats_, works)) continue;
    if (!made) {
      lock.unlock();
      made = make(solver, matrix, last, request.key);
      lock.lock();
    }
    if (made->factor != nullptr || made->split != nullptr) ++mine.held;
    return *made;
  }
}

void Lockstep::let_go(std::size_t run) {
  const std::lock_guard lock(mutex_);
  --seats_[run]->held;
}

/// The factor of this matrix where there is one, or why there is none where that was found last.
std::optional<Lockstep::Made> Lockstep::find(const std::string& key) const {
  if (key == last_key_) return last_made_;
  const auto known = kept_.find(key);
  if (known == kept_.end()) return {};
  Made made{known->second.factor.lock(), known->second.split.lock(), -1, {}, false};
  if (made.factor == nullptr && made.split == nullptr) return {};
  return made;
}

Lockstep::Made Lockstep::make(const LinearSolver& solver, const Sparse& matrix, const std::vector<int>* last, const std::string& key) {
  {
    const std::lock_guard lock(mutex_);
    last_key_.clear(), last_made_ = {};
    std::erase_if(kept_, [](const auto& known) { return known.second.factor.expired() && known.second.split.expired(); });
    ++counts_.factorisations;
  }
  Made made;
  if (last != nullptr) {
    SplitFactorisation result = solver.factorise_split(matrix, *last);
    made = {nullptr, std::move(result.factor), result.failed_unknown, std::move(result.why), result.too_large};
  } else {
    Factorisation result = solver.factorise(matrix);
    made = {std::move(result.factor), nullptr, result.failed_unknown, std::move(result.why), result.too_large};
  }
  const std::lock_guard lock(mutex_);
  last_key_ = key, last_made_ = made;
  kept_[key] = {made.factor, made.split};
  return made;
}

std::shared_ptr<const SymmetricPair> Lockstep::pair(const Sparse& a, const Sparse& b) {
  const std::lock_guard lock(mutex_);
  std::weak_ptr<const SymmetricPair>& known = pairs_[{a.valuePtr(), b.valuePtr()}];  // as long as a pair exists, its matrices do
  if (std::shared_ptr<const SymmetricPair> shared = known.lock()) return shared;
  auto made = std::make_shared<const SymmetricPair>(a, b);
  known = made;
  return made;
}

void Lockstep::serve() {
  std::unique_lock lock(mutex_);
  const auto is_ready = [](const std::unique_ptr<Seat>& seat) { return seat->state == Seat::State::ready; };
  const auto has_ended = [](const std::unique_ptr<Seat>& seat) { return seat->state == Seat::State::ended; };
  give_turns();
  for (;;) {
    server_.wait(lock, [&] { return computing_ == 0 && std::ranges::none_of(seats_, is_ready); });
    if (std::ranges::all_of(seats_, has_ended)) return;
    const std::vector<Seat*> next = chosen();
    lock.unlock();  // no run computes: nobody else touches what is solved
    solve(next);
    lock.lock();
    for (Seat* seat : next) seat->state = Seat::State::ready;
    give_turns();
  }
}

std::vector<Lockstep::Seat*> Lockstep::waiting_for(Request::Kind kind) const {
  std::vector<Seat*> found;
  for (const std::unique_ptr<Seat>& seat : seats_)
    if (seat->state == Seat::State::asking && seat->request->kind == kind) found.push_back(seat.get());
  return found;
}

/// Which of the waiting runs go on: always some, and each of them when there are no others before it. Where nobody solves, nobody holds a
/// factor: then those who want the same one.
std::vector<Lockstep::Seat*> Lockstep::chosen() const {
  using enum Request::Kind;
  if (std::vector<Seat*> all = waiting_for(backward); !all.empty()) return all;
  if (std::vector<Seat*> all = waiting_for(forward); !all.empty()) return all;
  std::vector<Seat*> all = waiting_for(factor);
  if (all.empty()) return waiting_for(room);
  const std::string key = all.front()->request->key;
  std::erase_if(all, [&](const Seat* seat) { return seat->request->key != key; });
  return all;
}

/// What the runs wait for, or why it could not be solved.
void Lockstep::solve(const std::vector<Seat*>& seats) {
  std::vector<Request*> rest;
  for (const Seat* seat : seats)
    if (seat->request->through != nullptr) rest.push_back(seat->request);
  while (!rest.empty()) {
    const SplitFactor* factor = rest.front()->through;
    const auto behind = std::stable_partition(rest.begin(), rest.end(), [&](const Request* each) { return each->through == factor; });
    const std::vector<Request*> together(rest.begin(), behind);
    rest.erase(rest.begin(), behind);
    try {
      solve_together(together);
    } catch (...) {
      for (Request* request : together) request->trouble = std::current_exception();
    }
  }
}

/// Right-hand sides of one factor, divided among the threads by whole groups of columns.
void Lockstep::solve_together(const std::vector<Request*>& requests) {
  const bool forward = requests.front()->kind == Request::Kind::forward;
  const SplitFactor& factor = *requests.front()->through;
  std::vector<const Vector*> from;
  std::vector<Vector*> to;
  for (const Request* request : requests) from.push_back(request->from), to.push_back(request->to);
  const auto solve = [&](std::size_t first, std::size_t count) {
    const std::span<const Vector* const> given = std::span(from).subspan(first, count);
    const std::span<Vector* const> wanted = std::span(to).subspan(first, count);
    forward ? factor.forward_all(given, wanted) : factor.backward_all(given, wanted);
  };
  const std::size_t groups = (from.size() + columns_of_a_group - 1) / columns_of_a_group, most = static_cast<std::size_t>(threads_),
                    share = (groups + most - 1) / most * columns_of_a_group;
  std::vector<std::future<void>> others;
  for (std::size_t first = share; first < from.size(); first += share)
    others.push_back(std::async(std::launch::async, solve, first, std::min(share, from.size() - first)));
  solve(0, std::min(share, from.size()));
  for (std::future<void>& other : others) other.get();
  ++counts_.solves;
  counts_.columns += std::ssize(from);
}

}  // namespace uplift
