// The unit tests of the solver on all ranks of an MPI job: rank 0 asserts, the others serve.
#include <gtest/gtest.h>

#include "uplift/distributed/petsc.h"
#include "uplift/distributed/ranks.h"

int main(int count, char** words) {
  const uplift::Petsc petsc;
  if (petsc.rank() > 0) {
    uplift::Ranks::all().serve();
    return 0;
  }
  testing::InitGoogleTest(&count, words);
  const int failed = RUN_ALL_TESTS();
  uplift::Ranks::all().end();
  return failed;
}
