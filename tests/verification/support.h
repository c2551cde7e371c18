#pragma once
#include <string>
#include <string_view>
#include <vector>

// What the verification cases share: a case file as text is run in the program, from the reader to the output table, and the answer is
// plain numbers.
namespace uplift::verification {

/// The output table of a finished run.
struct History {
  std::string status, reason;
  std::vector<std::string> names;            // names[0] = "t"
  std::vector<std::vector<double>> columns;  // columns[0]: time [s]

  /// A column by its name; throws std::out_of_range with the names that there are.
  const std::vector<double>& operator[](std::string_view name) const;
  const std::vector<double>& time() const { return columns.front(); }
  std::size_t rows() const { return columns.front().size(); }
  /// Largest absolute value of a column, over the times up to `until` [s].
  double peak(std::string_view name, double until = 1e300) const;
  /// Kinetic, strain and stored energy [J] of a row.
  double mechanical_energy(std::size_t row) const;
};

/// Runs the case (its first run, without variants and without the bonded model). Throws InputError.
History run_text(const std::string& toml);

/// Columns of a file of tests/data/reference, by name. A file that is missing or empty is an error.
struct Reference {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
  std::vector<std::string> words;  // the first column as text
  const std::vector<double>& operator[](std::string_view name) const;
};
Reference reference(const std::string& file);

/// Value at a time by straight lines between the rows.
double interpolate(const std::vector<double>& x, const std::vector<double>& y, double at);
/// Slope of log(error) over log(step), first to last.
double order(const std::vector<double>& step, const std::vector<double>& error);

/// A vertical bar along y above a rigid wall: axial unknowns only, lumped mass, contact at its lower end "n0".
struct Bar {
  int elements = 100;
  double length = 10, modulus = 900, density = 1, area = 1;  // m, Pa, kg/m3, m2
  double gap = 1, velocity = 0, gravity = 0;                 // m, m/s (up > 0), m/s2
  std::string law = "\"unilateral\"", impact = "\"project_hold\"", method, scheme = "\"average_acceleration\"", traction = "path";
  double step = 0, duration = 0;  // s; step 0: element length / wave speed
  std::string stages;             // put before the dynamic stage
  int every = 1;

  double wave_speed() const;
  double time_step() const;
  /// Columns: foot.1.traction, foot.1.mean_traction, foot.1.opening, motion of the ends (low, low.v, high), of eleven
  /// points along the bar (at0 ... at10; the number of elements is a multiple of ten) and the energies.
  std::string text() const;
};

/// Mean displacement of a bar [m] in one row of its table.
double mean_height(const History& bar, std::size_t row);

}  // namespace uplift::verification
