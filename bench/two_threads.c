/* Two analyses at a time through the C interface: by two threads, beside two processes and beside a loop in registers, which shows what the
 * machine can give. Least times of the rounds, all in turns; the ratio is the work of two over that of one in the same time.
 * Usage: bench_two_threads CASE.toml REPEATS ROUNDS */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "uplift.h"

static const char* file;
static int repeats;
static volatile double sink;

static double seconds(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void analyse(void) {
  int k;
  for (k = 0; k < repeats; ++k) {
    uplift_error error = {0, 0, 0, NULL, NULL, NULL};
    uplift_options options;
    uplift_case* each = NULL;
    uplift_results* results = NULL;
    uplift_options_init(&options);
    options.step_check = 0;
    if (uplift_case_load(file, &each, &error) != UPLIFT_OK || uplift_run(each, &options, &results, &error) != UPLIFT_OK) {
      fprintf(stderr, "%s\n", error.message);
      exit(1);
    }
    uplift_results_free(results);
    uplift_case_free(each);
  }
}

static void count(void) {
  double a[8] = {1, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.7};
  long k;
  int i;
  for (k = 0; k < 200000000; ++k)
    for (i = 0; i < 8; ++i) a[i] = a[i] * 0.999999 + 1e-7;
  for (i = 0; i < 8; ++i) sink = a[i];
}

static double by_processes(int n, void (*work)(void)) {
  const double begin = seconds(CLOCK_MONOTONIC);
  int i;
  for (i = 0; i < n; ++i)
    if (fork() == 0) {
      work();
      _exit(0);
    }
  for (i = 0; i < n; ++i) wait(NULL);
  return seconds(CLOCK_MONOTONIC) - begin;
}

static void* analyse_in_thread(void* unused) {
  analyse();
  return unused;
}

/* `processor`: processor time of one of them. */
static double by_threads(int n, double* processor) {
  const double begin = seconds(CLOCK_MONOTONIC), used = seconds(CLOCK_PROCESS_CPUTIME_ID);
  pthread_t thread[2];
  int i;
  for (i = 0; i < n; ++i) pthread_create(&thread[i], NULL, analyse_in_thread, NULL);
  for (i = 0; i < n; ++i) pthread_join(thread[i], NULL);
  *processor = (seconds(CLOCK_PROCESS_CPUTIME_ID) - used) / n;
  return seconds(CLOCK_MONOTONIC) - begin;
}

static void keep_least(double* least, double time) {
  if (*least == 0 || time < *least) *least = time;
}

int main(int words, char** word) {
  double loop[2] = {0, 0}, process[2] = {0, 0}, thread[2] = {0, 0}, processor[2] = {0, 0}, used;
  int round, n;
  if (words != 4) return 2;
  file = word[1];
  repeats = atoi(word[2]);
  for (round = 0; round < atoi(word[3]); ++round)
    for (n = 1; n <= 2; ++n) {
      keep_least(&loop[n - 1], by_processes(n, count));
      keep_least(&process[n - 1], by_processes(n, analyse));
      keep_least(&thread[n - 1], by_threads(n, &used));
      keep_least(&processor[n - 1], used);
    }
  printf("loop:      %.3f s, two %.3f s, ratio %.2f\n", loop[0], loop[1], 2 * loop[0] / loop[1]);
  printf("processes: %.3f s, two %.3f s, ratio %.2f\n", process[0], process[1], 2 * process[0] / process[1]);
  printf("threads:   %.3f s, two %.3f s, ratio %.2f; processor time of one %.3f s, of one of two %.3f s\n", thread[0], thread[1],
         2 * thread[0] / thread[1], processor[0], processor[1]);
  return 0;
}
