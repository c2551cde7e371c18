#include "uplift/session/history_file.h"

#include <fstream>

#include "uplift/io/results/histories.h"

namespace uplift {

void HistoryFile::follow(const RunResult& so_far) {
  constexpr std::chrono::seconds pause(1);
  if (refused_ || Clock::now() - last_ < pause || so_far.table.empty()) return;
  std::ofstream file(folder_.place(name_), begun_ ? std::ios::app : std::ios::trunc);
  if (!begun_) file << histories_head(so_far);
  file << histories_rows(so_far, rows_);
  file.close();
  refused_ = !file;  // the system will say so again at the end
  begun_ = true;
  rows_ = so_far.table.front().size();
  last_ = Clock::now();
}

}  // namespace uplift
