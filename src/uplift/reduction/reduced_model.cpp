#include "uplift/reduction/reduced_model.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "uplift/base/archive.h"
#include "uplift/base/file.h"

namespace uplift {

template <class Archive, SameAs<Matrix> T>
void list_parts(Archive& archive, T& matrix) {
  std::vector<double> values;
  Index rows = matrix.rows(), columns = matrix.cols();
  if constexpr (!Archive::reads) values.assign(matrix.data(), matrix.data() + matrix.size());
  archive(rows, columns, values);
  if constexpr (Archive::reads) {
    const bool fits = rows > 0 && columns > 0 && std::ssize(values) / rows == columns && std::ssize(values) % rows == 0;
    matrix = fits ? Matrix(Eigen::Map<const Matrix>(values.data(), rows, columns)) : Matrix();
  }
}

template <class Archive, SameAs<ControlErrors> T>
void list_parts(Archive& archive, T& c) {
  archive(c.runs, c.different, c.opening, c.moment, c.history, c.slip, c.floor_spectrum, c.least_scale, c.most_scale, c.motions);
}

template <class Archive, SameAs<ReducedModel> T>
void list_parts(Archive& archive, T& r) {
  archive(r.version, r.matrices, r.frequency, r.energy_frequency, r.transfer_error, r.rigid, r.vectors, r.loads, r.controls);
}

namespace {

constexpr std::string_view magic = "uplift reduced model 3\n";

void add(const Sparse& matrix, std::string& bytes) {
  const auto put = [&](const auto& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  put(matrix.rows()), put(matrix.cols());
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry) put(entry.row()), put(entry.col()), put(entry.value());
}

std::string hash(const Sparse& matrix) {
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(matrix.nonZeros()) * 24);
  add(matrix, bytes);
  return sha256(bytes);
}

/// What of a shape lies outside an orthonormal basis; the second pass takes the round-off of the first.
Vector outside(const Matrix& basis, Vector shape) {
  for (int pass = 0; pass < 2 && basis.cols() > 0; ++pass) shape -= basis * (basis.transpose() * shape);
  return shape;
}

bool changes(const TimeLoad& load) {
  return !load.constant && !load.shape.isZero(0);
}

constexpr double least_outside = 1e-9;  // of a shape: less is round-off

}  // namespace

double ControlErrors::confidence() const {
  return 1 - std::pow(0.95, runs - different);
}

std::string ControlErrors::statement() const {
  std::string text = fmt::format(
      "In {} control runs ({}, times a factor between {:.3g} and {:.3g}) the reduced model was off by at most {:.2g} % in the largest "
      "opening, {:.2g} % in the largest base moment, {:.2g} % in the openings over time",
      runs, motions, least_scale, most_scale, 100 * opening, 100 * moment, 100 * history);
  if (slip > 0) text += fmt::format(", {:.2g} % in the slips over time", 100 * slip);
  if (floor_spectrum > 0) text += fmt::format(" and {:.2g} % in the broadened floor spectra", 100 * floor_spectrum);
  text += fmt::format("; each of these bounds the error of 95 % of the runs with motions drawn in this way, with a confidence of {:.3g} %.",
                      100 * confidence());
  if (different > 0) text += fmt::format(" {} of the control runs ended otherwise than the full ones and are left out.", different);
  return text;
}

std::string ReducedModel::statement(const std::string& file) const {
  return fmt::format(
             "The dynamic stages were computed with the reduced model {}: {} coordinates in place of {} unknowns, made for motions up to "
             "{:.3g} Hz, transfer error {:.1e}. ",
             file, vectors.cols(), vectors.rows(), frequency, transfer_error) +
         (controls ? controls->statement() : "It has no control runs: how far its results are from those of the full model is not known.");
}

std::string matrices_hash(const Model& model) {
  std::string all = hash(model.stiffness) + hash(model.mass) + hash(model.damping) + hash(model.reduction());
  for (const Interface& interface : model.interfaces) all += hash(interface.b);
  return sha256(all);
}

Matrix orthonormal_loads(const Model& model) {
  Matrix loads(model.stiffness.rows(), 0);
  for (const TimeLoad& load : model.time_loads) {
    if (!changes(load)) continue;
    const Vector rest = outside(loads, load.shape);
    if (rest.norm() <= least_outside * load.shape.norm()) continue;
    loads.conservativeResize(Eigen::NoChange, loads.cols() + 1);
    loads.rightCols(1) = rest.normalized();
  }
  return loads;
}

std::string load_outside(const Model& model, const Matrix& loads) {
  for (const TimeLoad& load : model.time_loads)
    if (changes(load) && outside(loads, load.shape).norm() > least_outside * load.shape.norm()) return load.name;
  return {};
}

std::string write_reduced_model(const ReducedModel& reduced) {
  ArchiveWriter content;
  content(reduced);
  return sealed(magic, content.bytes());
}

std::optional<ReducedModel> read_reduced_model(std::string_view bytes, std::string& why) {
  const std::optional<std::string_view> content = unsealed(magic, bytes, why);
  if (!content) return {};
  std::optional<ReducedModel> reduced(std::in_place);
  ArchiveReader reader(*content);
  reader(*reduced);
  if (!reader.failed() && reader.at_end() && reduced->vectors.size() > 0) return reduced;
  why = "it was written by another version of the program";
  return {};
}

}  // namespace uplift
