#pragma once
#include <algorithm>
#include <cmath>

namespace uplift {

/// How much of a Newton step to take (H. Matthies & G. Strang, Int. J. Numer. Meth. Engng 14, 1979, 1613-1626). Measured by the work that
/// the unbalanced forces would do on the whole step: where they are the descent of a convex function it never grows along the step. All is
/// taken unless this work then is below minus half of what it was at the beginning; else a share that leaves at most half of it, found by
/// the Illinois rule.
class LineSearch {
 public:
  /// `work`: at the beginning, e.g. [J]. Where it is not positive, all is taken.
  explicit LineSearch(double work) : first_(work), low_work_(work) {}
  /// Of the step, to be tried next or taken.
  double share() const { return share_; }
  /// `work`: at the share just tried. False when that share is to be taken, or when no better one is found in 12 tries.
  bool goes_on(double work) {
    if (!(first_ > 0) || ++tries_ >= most_tries) return false;
    if (share_ == 1 ? work >= -0.5 * first_ : std::abs(work) <= 0.5 * first_) return false;
    return narrow(work);
  }

 private:
  static constexpr int most_tries = 12;

  bool narrow(double work) {
    if (work < 0) {
      high_ = share_, high_work_ = work;
      if (side_ < 0) low_work_ /= 2;
      side_ = -1;
    } else {
      low_ = share_, low_work_ = work;
      if (side_ > 0) high_work_ /= 2;
      side_ = 1;
    }
    const double secant = low_work_ / (low_work_ - high_work_);
    share_ = low_ + std::clamp(secant, 0.01, 0.95) * (high_ - low_);
    return true;
  }

  double first_, share_ = 1;
  double low_ = 0, low_work_, high_ = 1, high_work_ = 0;
  int side_ = 0, tries_ = 0;
};

}  // namespace uplift
