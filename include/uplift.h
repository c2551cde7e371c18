/* uplift: uplift of foundations in earthquakes. C interface of the library libuplift.
 *
 * Compiles as C99 and as C++98. All quantities are in SI units; an opening > 0 separates the faces of an interface, a traction > 0 is
 * tension. Texts are UTF-8 and end with a zero byte.
 *
 * Every function that can fail returns a status and, where `error` is not null, fills it; call uplift_error_clear() when it has been
 * read. No exception leaves the library; it never prints and never ends the process. Handles may be used by different threads, one thread
 * at a time each; different handles may be used at the same time. */
#ifndef UPLIFT_H
#define UPLIFT_H

#include <stddef.h>

#if defined(__GNUC__)
#define UPLIFT_API __attribute__((visibility("default")))
#else
#define UPLIFT_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* ---- status and errors ---- */

enum {
  UPLIFT_OK = 0,
  UPLIFT_INTERNAL_ERROR = 1, /* a defect of the library */
  UPLIFT_BAD_INPUT = 2,      /* of a case, a file or an argument */
  UPLIFT_NO_MEMORY = 3,
  UPLIFT_OUTPUT_ERROR = 4 /* results could not be written; what was written is kept */
};

typedef struct uplift_error {
  int status;
  int line, column; /* from 1; 0 where they are not known */
  char* file;       /* null where there is none */
  char* path;       /* key as in "interface[0].law.K_n"; null where there is none */
  char* message;    /* the whole sentence */
} uplift_error;

/* Frees the texts of an error and sets it to zero. An error must be zero (or cleared) before it is passed to a function. */
UPLIFT_API void uplift_error_clear(uplift_error* error);
/* Frees a text that a function returned through `char**`. */
UPLIFT_API void uplift_text_free(char* text);

UPLIFT_API const char* uplift_version(void);
/* Version of this interface: it changes when a structure or the meaning of a function changes. */
UPLIFT_API int uplift_abi_version(void);
#define UPLIFT_ABI_VERSION 1

/* JSON Schema of the case file. */
UPLIFT_API int uplift_schema(char** text, uplift_error* error);

/* A TOML text as JSON, without checking whether it is a case: for callers that build or change cases. */
UPLIFT_API int uplift_toml_to_json(const char* text, const char* file, char** json, uplift_error* error);

/* ---- cases ---- */

typedef struct uplift_case uplift_case;

/* Reads and checks a case file, or the case.toml of a folder. */
UPLIFT_API int uplift_case_load(const char* path, uplift_case** made, uplift_error* error);
/* The same for a text in TOML or JSON. `file` is its name in messages; relative paths of the case start from the folder of this name. */
UPLIFT_API int uplift_case_parse(const char* text, const char* file, uplift_case** made, uplift_error* error);
UPLIFT_API void uplift_case_free(uplift_case* each);
/* The case with all default values, as TOML. */
UPLIFT_API int uplift_case_toml(const uplift_case* each, char** text, uplift_error* error);
/* What a run would compute, as the JSON document of `uplift check --json`. */
UPLIFT_API int uplift_case_check(const uplift_case* each, char** json, uplift_error* error);
/* Natural modes, as the JSON document of `uplift modes --json`. */
UPLIFT_API int uplift_case_modes(const uplift_case* each, int count, char** json, uplift_error* error);

/* ---- interface laws of the caller ---- */

/* One step of all points of an interface, from the openings `from` to the openings `to`. Component c of point i is entry [c * points + i],
 * the normal component is the last one; memory variable h of point i is entry [h * points + i]. `step` is the length of the step in
 * seconds, 0 in statics. The arrays to be filled are zero on entry, except the memory, which is the old one:
 *   traction    Pa, at the end of the step
 *   slope       Pa/m, d traction_r / d opening_c at [(r * components + c) * points + i]
 *   memory      at the end of the step; zero at the beginning of the analysis
 *   stored      J/m2 per point, energy that is stored at the end of the step
 *   dissipated  J/m2 per point, energy that was dissipated since the beginning of the analysis
 * The sum of the two energies must be the work of the traction along the path: the time integration derives the mean traction of the step
 * from it, so that the energy balance closes. A call with `from` equal to `to` must leave the memory as it is. The function may be called
 * by several threads at the same time. It returns 0, or another number to end the run as failed. */
typedef int (*uplift_law_function)(void* user, int points, int components, double step, const double* from, const double* to,
                                   const double* old_memory, double* traction, double* slope, double* memory, double* stored,
                                   double* dissipated);
/* Connects the function to the law of type "external" with this name in the case. Function and `user` must live as long as the case. */
UPLIFT_API int uplift_case_set_law(uplift_case* each, const char* name, uplift_law_function function, void* user, uplift_error* error);

/* ---- analyses ---- */

/* Where a run is. */
typedef struct uplift_progress {
  const char* label;
  double fraction; /* of the stage, 0 to 1 */
  double time;     /* s */
  double uplifted; /* share of the area of the first interface */
} uplift_progress;

/* A step of the case's own run. The arrays belong to the library and are valid during the call. */
typedef struct uplift_step {
  double time; /* s */
  long number; /* of the step in its stage */
  int stage;
  size_t unknowns, rows;      /* free unknowns; rows of all interfaces */
  const double* displacement; /* unknowns [m, rad] */
  const double* velocity;     /* unknowns; null in static stages */
  const double* opening;      /* rows [m] */
  const double* force;        /* rows [N] at the end of the step, tension > 0 */
} uplift_step;

/* Initialise with uplift_options_init(). Functions return 0 to go on; any other number ends the analysis in order, at the latest after
 * the next step, with complete results up to that instant. */
typedef struct uplift_options {
  size_t size;                                                  /* of this structure */
  int step_check;                                               /* 0: without the companion run with twice the step */
  const char* fields_folder;                                    /* results folder, for fields and all results; null: none is written */
  int (*progress)(void* user, const uplift_progress* progress); /* may be null; called by one thread at a time */
  int (*step)(void* user, const uplift_step* step);             /* may be null */
  void* user;                                                   /* first argument of both functions */
  const volatile int* cancel;                                   /* may be null; another number than 0 ends the analysis in order */
} uplift_options;
UPLIFT_API void uplift_options_init(uplift_options* options);

typedef struct uplift_results uplift_results;

/* The case, its bonded run, and the same with twice the step. Numerical failure is no error but a status in the results. */
UPLIFT_API int uplift_run(const uplift_case* each, const uplift_options* options, uplift_results** made, uplift_error* error);
/* All variants of the case. */
UPLIFT_API int uplift_compare(const uplift_case* each, const uplift_options* options, uplift_results** made, uplift_error* error);
/* The case with every choice of the computation changed, one at a time. */
UPLIFT_API int uplift_trust(const uplift_case* each, const uplift_options* options, uplift_results** made, uplift_error* error);
UPLIFT_API void uplift_results_free(uplift_results* results);

/* The results document (summary.json). The text belongs to the results. */
UPLIFT_API int uplift_results_json(const uplift_results* results, const char** json, uplift_error* error);
/* The bands of uplift_trust (trust.json). */
UPLIFT_API int uplift_results_trust(const uplift_results* results, char** json, uplift_error* error);
/* The report as one HTML page; empty when the library was built without it. The text belongs to the results. */
UPLIFT_API int uplift_results_report(const uplift_results* results, const char** page, uplift_error* error);
/* Writes everything that the program writes. Earlier results are moved aside, and `moved` (may be null) says where; null: there were none.
 */
UPLIFT_API int uplift_results_write(const uplift_results* results, const char* folder, char** moved, uplift_error* error);

/* Histories. Run 0 is the case's own; pointers belong to the results. Column 0 is the time [s] (the load factor of static cases). */
UPLIFT_API size_t uplift_results_runs(const uplift_results* results);
UPLIFT_API const char* uplift_results_run_name(const uplift_results* results, size_t run);
UPLIFT_API size_t uplift_results_columns(const uplift_results* results, size_t run);
typedef struct uplift_column {
  const char *name, *unit;
  const double* values;
  size_t count;
} uplift_column;
/* Fills `column`; false (0) when there is no such run or column. */
UPLIFT_API int uplift_results_column(const uplift_results* results, size_t run, size_t index, uplift_column* column);
/* Absolute accelerations of the floors of the case at every step. `unit` is "m/s2". `step` is the time step [s]. */
UPLIFT_API int uplift_results_floor(const uplift_results* results, size_t run, size_t index, double* step, uplift_column* column);
/* Frames of the animation: all displacements [m, rad] of the model at an instant. */
UPLIFT_API int uplift_results_frame(const uplift_results* results, size_t run, size_t index, double* time, uplift_column* column);

/* ---- the interface problem of one step ---- */

/* Solves an interface problem alone: the content of a file problem_NAME.json, which is stored when a step fails, or a text of the caller in
 * this format (docs/guide/library.md). `method` is the name of a contact method; null: all of them. The JSON document is that of
 * `uplift replay --json`: convergence, iterations, contact residual, openings [m] and forces [N]. */
UPLIFT_API int uplift_problem_solve(const char* problem, const char* method, char** json, uplift_error* error);

/* ---- motions ---- */

/* Pseudo-acceleration response spectrum [m/s2] of an acceleration history [m/s2] with equal steps [s], at `count` frequencies [Hz]. Peaks
 * between the points are found too (within 1e-4), as in floor_spectra.csv. */
UPLIFT_API int uplift_spectrum(const double* acceleration, size_t length, double step, double damping, const double* frequencies,
                               size_t count, double* psa, uplift_error* error);

#ifdef __cplusplus
}
#endif

#endif
