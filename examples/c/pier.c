/* Runs a case and prints its largest base moment: pier CASE */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <uplift.h>

int main(int count, char** words) {
  uplift_error error = {0, 0, 0, NULL, NULL, NULL};
  uplift_case* each = NULL;
  uplift_results* results = NULL;
  uplift_column column;
  size_t k, i;
  int status;
  if (count != 2) return 2;
  status = uplift_case_load(words[1], &each, &error);
  if (status == UPLIFT_OK) status = uplift_run(each, NULL, &results, &error);
  if (status != UPLIFT_OK) fprintf(stderr, "%s\n", error.message);
  for (k = 1; k < uplift_results_columns(results, 0); ++k) {
    double most = 0;
    uplift_results_column(results, 0, k, &column);
    if (strstr(column.name, ".moment") == NULL) continue;
    for (i = 0; i < column.count; ++i) most = fabs(column.values[i]) > most ? fabs(column.values[i]) : most;
    printf("largest %s: %.4g %s\n", column.name, most, column.unit);
  }
  uplift_results_free(results);
  uplift_case_free(each);
  uplift_error_clear(&error);
  return status;
}
