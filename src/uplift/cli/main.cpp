#include "uplift/cli/commands.h"

int main(int count, char** words) {
  return uplift::cli::program(count, words, "uplift");
}
