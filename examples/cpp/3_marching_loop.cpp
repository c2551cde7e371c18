// A marching loop of one's own: goes through a run step by step, follows the energy of the structure's motion, and ends the run when the
// footing has come to rest on the ground again after its first uplift: 3_marching_loop CASE
#include <algorithm>
#include <cstdio>
#include <uplift.hpp>

int main(int count, char** words) {
  if (count != 2) return 2;
  try {
    uplift::March march(uplift::Case::load(words[1]));
    bool lifted = false;
    double most = 0;
    while (const uplift::Step* step = march.next()) {
      double opening = 0;
      for (std::size_t row = 1; row < step->opening.size(); row += 2) opening = std::max(opening, step->opening[row]);  // the normal rows
      most = std::max(most, opening);
      if (opening > 1e-3 && !lifted) std::printf("the footing lifts off at %.3f s\n", step->time);
      lifted = lifted || opening > 1e-3;
      if (lifted && opening <= 0) break;
    }
    const uplift::Results results = march.results();
    std::printf("it is closed again at %.3f s, after openings of up to %.4g m\n", results.time()[results.time().size() - 1], most);
  } catch (const uplift::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.status;
  }
}
