/* The C interface from C: a run, a law of one's own against a closed form, refusals, bad arguments and random orders of calls. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "uplift.h"

static int failures = 0;
static void expect_at(int truth, const char* text, int line) {
  if (truth) return;
  printf("line %d: %s\n", line, text);
  ++failures;
}
#define EXPECT(truth) expect_at((truth), #truth, __LINE__)

/* A block of 1000 kg on one joint point of 1 m2: K = 1e6 N/m, so that it settles by m g/K = 9.81 mm, and oscillates with sqrt(K/m). */
static const char* block =
    "title = \"block\"\nbonded = false\n"
    "[nodes]\na = [0, 0]\n"
    "[[mass]]\nnode = \"a\"\nmass = 1000\n"
    "[[support]]\nnode = \"a\"\nfixed = [\"ux\", \"rz\"]\n"
    "[[interface]]\nname = \"under\"\npairs = { upper = [\"a\"], area = 1 }\nlaw = %s\n"
    "[[function]]\nname = \"step\"\nshape = \"constant\"\n"
    "[[load]]\nname = \"weight\"\nnode = \"a\"\nforce = [0, -9810]\nfunction = \"step\"\n"
    "[[stage]]\ntype = \"dynamic\"\nduration = 1\nstep = 1e-3\n";

static int linear(void* user, int points, int components, double step, const double* from, const double* to, const double* old,
                  double* traction, double* slope, double* memory, double* stored, double* dissipated) {
  int i, c;
  const double stiffness = *(const double*)user;
  (void)step, (void)from, (void)old, (void)memory;
  memset(slope, 0, sizeof(double) * (size_t)(points * components * components));
  for (i = 0; i < points; ++i) {
    stored[i] = dissipated[i] = 0;
    for (c = 0; c < components; ++c) {
      const double opening = to[c * points + i];
      traction[c * points + i] = stiffness * opening;
      slope[(c * components + c) * points + i] = stiffness;
      stored[i] += 0.5 * stiffness * opening * opening;
    }
  }
  return 0;
}

static uplift_case* parsed(const char* law, uplift_error* error) {
  char text[4000];
  uplift_case* made = NULL;
  snprintf(text, sizeof text, block, law);
  uplift_case_parse(text, "block.toml", &made, error);
  return made;
}

static void check_against_the_closed_form(const uplift_results* results) {
  const double stiffness = 1e6, mass = 1000, weight = 9810;
  const double omega = sqrt(stiffness / mass);
  uplift_column time, opening;
  size_t k, i;
  int found = 0;
  EXPECT(uplift_results_column(results, 0, 0, &time));
  for (k = 1; k < uplift_results_columns(results, 0); ++k) {
    EXPECT(uplift_results_column(results, 0, k, &opening));
    if (strcmp(opening.name, "a.uy") != 0) continue;
    found = 1;
    EXPECT(strcmp(opening.unit, "m") == 0 && opening.count == time.count);
    for (i = 0; i < time.count; ++i) {
      /* the trapezoidal rule is a period error of (w dt)^2/12 away: at t = 1 s, a phase of w t (w dt)^2/12 = 2.6e-3 */
      const double exact = -weight / stiffness * (1 - cos(omega * time.values[i]));
      EXPECT(fabs(opening.values[i] - exact) < 3e-3 * weight / stiffness);
    }
  }
  EXPECT(found);
}

static void runs(void) {
  static double stiffness = 1e6;
  uplift_error error = {0, 0, 0, NULL, NULL, NULL};
  uplift_case* each = parsed("{ type = \"external\", name = \"mine\", K_n = 1e6, K_t = 1e6 }", &error);
  uplift_results* results = NULL;
  char* json = NULL;
  EXPECT(each != NULL);
  EXPECT(uplift_run(each, NULL, &results, &error) == UPLIFT_BAD_INPUT && results == NULL); /* not connected */
  EXPECT(error.message != NULL && strstr(error.message, "mine") != NULL && error.line > 0);
  uplift_error_clear(&error);
  EXPECT(uplift_case_check(each, &json, &error) == UPLIFT_BAD_INPUT && json == NULL);
  uplift_error_clear(&error);
  EXPECT(uplift_case_set_law(each, "mine", linear, &stiffness, &error) == UPLIFT_OK);
  EXPECT(uplift_case_check(each, &json, &error) == UPLIFT_OK && json != NULL);
  uplift_text_free(json);
  EXPECT(uplift_trust(each, NULL, &results, &error) == UPLIFT_BAD_INPUT && results == NULL); /* the repetitions have no functions */
  EXPECT(error.message != NULL && strstr(error.message, "statement of reliability") != NULL);
  uplift_error_clear(&error);
  EXPECT(uplift_run(each, NULL, &results, &error) == UPLIFT_OK && results != NULL);
  if (error.message != NULL) printf("%s\n", error.message);
  if (results != NULL) check_against_the_closed_form(results);
  uplift_case_free(each); /* results outlive their case */
  if (results != NULL) {
    const char* json = NULL;
    EXPECT(uplift_results_json(results, &json, &error) == UPLIFT_OK && strstr(json, "\"verdict\"") != NULL);
    EXPECT(uplift_results_runs(results) == 1 && strcmp(uplift_results_run_name(results, 0), "run") == 0);
    EXPECT(uplift_results_run_name(results, 1) == NULL && uplift_results_columns(results, 1) == 0);
  }
  uplift_results_free(results);
  uplift_error_clear(&error);
}

static int calls_left;
static int refusing_once(void* user, int points, int components, double step, const double* from, const double* to, const double* old,
                         double* traction, double* slope, double* memory, double* stored, double* dissipated) {
  static double stiffness = 1e6;
  (void)user;
  if (--calls_left == 0) return 1;
  return linear(&stiffness, points, components, step, from, to, old, traction, slope, memory, stored, dissipated);
}

/* A shorter step would succeed, because the function refuses one call only: the run ends all the same, and the next one is a new run. */
static void a_law_ends_its_run(void) {
  uplift_error error = {0, 0, 0, NULL, NULL, NULL};
  uplift_case* each = parsed("{ type = \"external\", name = \"mine\", K_n = 1e6, K_t = 1e6 }", &error);
  uplift_results* results = NULL;
  uplift_options options;
  const char* json = NULL;
  EXPECT(uplift_case_set_law(each, "mine", refusing_once, NULL, &error) == UPLIFT_OK);
  uplift_options_init(&options);
  options.step_check = 0; /* one run */
  calls_left = 500;
  EXPECT(uplift_run(each, &options, &results, &error) == UPLIFT_OK && results != NULL);
  EXPECT(calls_left == 0);
  EXPECT(uplift_results_json(results, &json, &error) == UPLIFT_OK && strstr(json, "\"status\": \"failed\"") != NULL);
  uplift_results_free(results);
  results = NULL;
  EXPECT(uplift_run(each, &options, &results, &error) == UPLIFT_OK && results != NULL);
  EXPECT(uplift_results_json(results, &json, &error) == UPLIFT_OK && strstr(json, "\"status\": \"completed\"") != NULL);
  uplift_results_free(results);
  uplift_case_free(each);
}

static int count_steps(void* user, const uplift_step* step) {
  int* counted = (int*)user;
  EXPECT(step->unknowns == 1 && step->displacement != NULL);
  return ++*counted >= 10;
}

static void cancelling(void) {
  uplift_error error = {0, 0, 0, NULL, NULL, NULL};
  uplift_case* each = parsed("{ type = \"elastic\", K_n = 1e6 }", &error);
  uplift_options options;
  uplift_results* results = NULL;
  uplift_column column;
  int counted = 0;
  uplift_options_init(&options);
  options.step = count_steps;
  options.user = &counted;
  EXPECT(uplift_run(each, &options, &results, &error) == UPLIFT_OK);
  EXPECT(counted == 10);
  EXPECT(uplift_results_column(results, 0, 0, &column) && column.count <= 13 && column.count >= 10);
  uplift_results_free(results);
  results = NULL;
  options.size = 3;
  EXPECT(uplift_run(each, &options, &results, &error) == UPLIFT_BAD_INPUT && results == NULL);
  uplift_error_clear(&error);
  uplift_case_free(each);
}

static void refusals(const char* root) {
  uplift_error error = {0, 0, 0, NULL, NULL, NULL};
  uplift_case* each = NULL;
  char* text = NULL;
  char path[2000];
  snprintf(path, sizeof path, "%s/no_such_case.toml", root);
  EXPECT(uplift_case_load(path, &each, &error) == UPLIFT_BAD_INPUT && each == NULL && error.message != NULL);
  uplift_error_clear(&error);
  EXPECT(uplift_case_parse("title = \"x\"\n[[beam]]\nname = 3\n", "x.toml", &each, &error) == UPLIFT_BAD_INPUT);
  EXPECT(error.line == 3 && error.column > 0 && error.file != NULL && strcmp(error.file, "x.toml") == 0);
  uplift_error_clear(&error);
  EXPECT(error.message == NULL && error.status == 0);
  EXPECT(uplift_case_parse("{\"title\": \"x\", \"title\": 2}", "x.json", &each, &error) == UPLIFT_BAD_INPUT);
  uplift_error_clear(&error);
  EXPECT(uplift_case_parse("{\"title\": ", "x.json", &each, &error) == UPLIFT_BAD_INPUT && error.line == 1);
  uplift_error_clear(&error);
  EXPECT(uplift_case_parse(NULL, "x", &each, &error) == UPLIFT_BAD_INPUT);
  uplift_error_clear(&error);
  EXPECT(uplift_case_parse("x", "x", NULL, NULL) == UPLIFT_BAD_INPUT); /* nobody wants the error */
  EXPECT(uplift_run(NULL, NULL, NULL, &error) == UPLIFT_BAD_INPUT);
  uplift_error_clear(&error);
  EXPECT(uplift_schema(&text, &error) == UPLIFT_OK && strstr(text, "json-schema.org") != NULL);
  uplift_text_free(text);
  EXPECT(uplift_spectrum(NULL, 5, 1, 0.05, NULL, 0, NULL, &error) == UPLIFT_BAD_INPUT);
  uplift_error_clear(&error);
  uplift_case_free(NULL);
  uplift_results_free(NULL);
  uplift_error_clear(NULL);
  EXPECT(uplift_results_runs(NULL) == 0 && uplift_abi_version() == UPLIFT_ABI_VERSION);
}

/* A thousand calls in a random order on a few cases and results. */
static void random_orders(void) {
  uplift_case* cases[3] = {NULL, NULL, NULL};
  uplift_results* results[3] = {NULL, NULL, NULL};
  unsigned long seed = 20261123;
  int i;
  for (i = 0; i < 1000; ++i) {
    uplift_error error = {0, 0, 0, NULL, NULL, NULL};
    char* text = NULL;
    const char* lent = NULL;
    uplift_column column;
    double number;
    int slot, other, what;
    seed = (seed * 6364136223846793005UL + 1442695040888963407UL) & 0xffffffffffffffffUL;
    slot = (int)((seed >> 40) % 3), other = (int)((seed >> 45) % 3), what = (int)((seed >> 50) % 12);
    switch (what) {
      case 0:
        uplift_case_free(cases[slot]);
        cases[slot] = parsed(i % 3 ? "{ type = \"springs\", K_n = 1e6 }" : "\"nonsense\"", &error);
        break;
      case 1:
        uplift_case_free(cases[slot]), cases[slot] = NULL;
        break;
      case 2:
      case 3:
        uplift_results_free(results[other]), results[other] = NULL;
        uplift_run(cases[slot], NULL, &results[other], &error);
        break;
      case 4:
        uplift_results_free(results[slot]), results[slot] = NULL;
        break;
      case 5:
        uplift_results_json(results[slot], &lent, &error);
        break;
      case 6:
        uplift_case_toml(cases[slot], &text, &error);
        break;
      case 7:
        uplift_case_modes(cases[slot], other, &text, &error);
        break;
      case 8:
        uplift_results_column(results[slot], (size_t)other, (size_t)(i % 40), &column);
        break;
      case 9:
        uplift_results_frame(results[slot], 0, (size_t)i, &number, &column);
        break;
      case 10:
        uplift_results_floor(results[slot], 0, 0, &number, &column);
        break;
      default:
        uplift_results_free(results[other]);
        uplift_compare(cases[slot], NULL, &results[other], &error); /* no variants: refused, and the results are null */
    }
    uplift_text_free(text);
    uplift_error_clear(&error);
  }
  for (i = 0; i < 3; ++i) uplift_case_free(cases[i]), uplift_results_free(results[i]);
}

int main(int count, char** words) {
  if (count != 2) return 2;
  runs();
  a_law_ends_its_run();
  cancelling();
  refusals(words[1]);
  random_orders();
  printf("%d failures\n", failures);
  return failures != 0;
}
