// uplift-mpi: the program `uplift` on rank 0 of an MPI job, with the solver "petsc" on all ranks.
#include <csignal>
#include <string_view>

#include "uplift/cli/blas_kernels.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"
#include "uplift/distributed/petsc.h"
#include "uplift/distributed/ranks.h"
#include "uplift/linear/memory.h"

namespace {

/// What ends the job is decided by rank 0, which writes its results first; if it is gone, mpirun kills the others.
void leave_signals_to_rank_0() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) std::signal(number, SIG_IGN);
}

int run_program(int count, char** words) {
  using namespace uplift;
  if (count > 1 && std::string_view(words[1]) == "study") {
    cli::complain("error: uplift-mpi: expected another command than \"study\": studies divide their runs among processes of `uplift`");
    return cli::Exit::bad_input;
  }
  const int code = cli::program(count, words, "uplift-mpi");
  if (const std::string& why = Ranks::all().failure(); !why.empty()) cli::complain("note: " + why);
  return code;
}

}  // namespace

int main(int count, char** words) {
  uplift::cli::choose_blas_kernels(words);
  const uplift::Petsc petsc;
  if (petsc.rank() > 0) {
    leave_signals_to_rank_0();
    uplift::prepare_heap();
    uplift::Ranks::all().serve();
    return 0;
  }
  const int code = run_program(count, words);
  uplift::Ranks::all().end();
  return code;
}
