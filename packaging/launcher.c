/* A program of a package, `uplift` or `uplift-mpi`: it starts the version that was compiled for the processor, which lies in
   ../libexec/uplift/LEVEL beside the folder of this file and has its name. The levels are those of the x86-64 ABI, as in the folders
   glibc-hwcaps where the dynamic loader finds libuplift (docs/decisions/0006-binaries-for-every-processor.md). */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { size = 4096 };

static const char* level(void) {
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
  if (__builtin_cpu_supports("x86-64-v3")) return "x86-64-v3";
  return "x86-64";
}

int main(int count, char** words) {
  char folder[size], name[size], program[2 * size + 64];
  const ssize_t length = readlink("/proc/self/exe", folder, size - 1);
  (void)count;
  if (length > 0) {
    folder[length] = 0;
    strcpy(name, strrchr(folder, '/') + 1);
    for (int up = 0; up < 2 && strrchr(folder, '/') != NULL; ++up) *strrchr(folder, '/') = 0;
    snprintf(program, sizeof program, "%s/libexec/uplift/%s/%s", folder, level(), name);
    execv(program, words);
    perror(program);
  } else {
    perror("uplift: /proc/self/exe");
  }
  return 1;
}
