#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "uplift/model/model.h"

namespace uplift {

/// How far runs with the reduced model are from full ones: largest errors over control runs drawn at random. Shares of the full values.
struct ControlErrors {
  int runs = 0;
  int different = 0;          // whose outcome (completed, overturned, ...) is not that of the full run; left out of the errors
  double opening = 0;         // of the largest opening
  double moment = 0;          // of the largest base moment
  double history = 0;         // of the openings of all points over time: 2-norm of the difference over that of the openings' change
  double slip = 0;            // of the slips of all points over time, in the same way; 0 where nothing slips
  double floor_spectrum = 0;  // of the broadened floor spectra, at the worst frequency up to that of the basis; 0 without floors
  double least_scale = 0, most_scale = 0;  // what the motions were multiplied by, drawn between these
  std::string motions;                     // what was drawn
  /// 1 - 0.95^n: confidence with which the largest error of n runs bounds that of 95 % of all runs drawn like them (Wilks 1941).
  double confidence() const;
  /// What was drawn, the largest errors and what they bound, in sentences.
  std::string statement() const;
};

/// What `uplift reduce` writes and runs of the case read: a basis and how well it represents the model.
struct ReducedModel {
  std::string version;          // of the program
  std::string matrices;         // matrices_hash of the model that it belongs to
  double frequency = 0;         // Hz, see TrainingOptions
  double energy_frequency = 0;  // rad/s, see Basis
  double transfer_error = 0;
  int rigid = 0;
  Matrix vectors;  // free unknowns x coordinates
  Matrix loads;    // orthonormal_loads of the model that it was made of
  std::optional<ControlErrors> controls;
  /// Size, transfer error and errors of the control runs in sentences; `file` names it.
  std::string statement(const std::string& file) const;
};

/// SHA-256 of what a basis belongs to: stiffness, mass, damping, rows of the interfaces, constraints.
std::string matrices_hash(const Model& model);

/// What the shapes of the loads that change with time span, free unknowns x directions: a basis was made for these and represents others
/// badly.
Matrix orthonormal_loads(const Model& model);
/// Name of the first load that changes with time and whose shape lies outside that of `loads`; empty where there is none.
std::string load_outside(const Model& model, const Matrix& loads);

std::string write_reduced_model(const ReducedModel& reduced);
/// Bytes that are cut off or changed are refused: then `why` says so.
std::optional<ReducedModel> read_reduced_model(std::string_view bytes, std::string& why);

}  // namespace uplift
