// A message is a piece of two lists, whole numbers and real numbers, in which records stand one after another:
//   section   a number of its own; material, thickness
//   node      its number; position; of each unknown the number of entries in T, their rows and values
//   solid     cell, section, nodes; beta
//   matrices  unknowns of a node, nodes; beta; of stiffness, mass and damping whether it is zero, or its entries
// Nodes and sections come before the first element that has them. A record is in one piece; a piece without records is the last one.
#include "uplift/distributed/rank_elements.h"

#include <algorithm>
#include <array>
#include <utility>

#include "uplift/distributed/messages.h"
#include "uplift/elements/solid.h"

namespace uplift {

namespace {

enum class Record : int { section, node, solid, matrices };

constexpr Matrix* Local::*all_matrices[] = {&Local::stiffness, &Local::mass, &Local::damping};

/// An element of which the matrices alone are known.
class MatricesOfElement final : public Element {
 public:
  MatricesOfElement(int unknowns_per_node, std::vector<int> nodes, std::array<Matrix, 3> matrices)
      : unknowns_per_node_(unknowns_per_node), nodes_(std::move(nodes)), matrices_(std::move(matrices)) {}
  std::span<const int> nodes() const override { return nodes_; }
  int unknowns_per_node() const override { return unknowns_per_node_; }
  void form(Local local) const override {
    for (std::size_t k = 0; k < matrices_.size(); ++k) {
      Matrix* const wanted = local.*all_matrices[k];
      if (wanted == nullptr) continue;
      if (matrices_[k].size() > 0)
        *wanted = matrices_[k];
      else
        wanted->setZero(unknowns(), unknowns());
    }
  }

 private:
  int unknowns_per_node_;
  std::vector<int> nodes_;
  std::array<Matrix, 3> matrices_;  // empty: zero
};

/// Sends records in pieces.
class Writer {
 public:
  Writer(int to, MPI_Comm ranks) : to_(to), ranks_(ranks) {}
  std::vector<int> whole;
  std::vector<double> real;
  void end_record() {
    constexpr std::size_t most = 1 << 15;
    if (whole.size() + real.size() >= most) send_piece();
  }
  void end() {
    if (!whole.empty()) send_piece();
    send_piece();
  }

 private:
  void send_piece() {
    const std::int64_t counts[2] = {std::ssize(whole), std::ssize(real)};
    send(counts, 2, MPI_INT64_T, to_, ranks_);
    send(whole.data(), counts[0], MPI_INT, to_, ranks_);
    send(real.data(), counts[1], MPI_DOUBLE, to_, ranks_);
    whole.clear(), real.clear();
  }
  int to_;
  MPI_Comm ranks_;
};

/// The elements of one rank, on rank 0.
class ElementSender {
 public:
  ElementSender(const ElementsOfModel& model, int to, MPI_Comm ranks)
      : model_(model), sent_(model.nodes.size(), false), writer_(to, ranks) {}
  void add(const Element& element) {
    const auto* solid = dynamic_cast<const Solid*>(&element);
    const bool plain = solid != nullptr && solid->is_whole();
    const int section = plain ? number_of(*solid->continuum()) : -1;
    for (const int node : element.nodes())
      if (!sent_[static_cast<std::size_t>(node)]) add_node(node);
    if (plain)
      writer_.whole.insert(writer_.whole.end(), {static_cast<int>(Record::solid), static_cast<int>(solid->cell()), section});
    else
      writer_.whole.insert(writer_.whole.end(),
                           {static_cast<int>(Record::matrices), element.unknowns_per_node(), static_cast<int>(element.nodes().size())});
    writer_.whole.insert(writer_.whole.end(), element.nodes().begin(), element.nodes().end());
    writer_.real.push_back(element.beta);
    if (!plain) add_matrices(element);
    writer_.end_record();
  }
  void end() { writer_.end(); }

 private:
  void add_node(int node) {
    sent_[static_cast<std::size_t>(node)] = true;
    writer_.whole.insert(writer_.whole.end(), {static_cast<int>(Record::node), node});
    const Vec3& position = model_.nodes[static_cast<std::size_t>(node)].position;
    writer_.real.insert(writer_.real.end(), position.begin(), position.end());
    for (int i = 0; i < model_.space.unknowns(); ++i) {
      const std::size_t entries = writer_.whole.size();
      writer_.whole.push_back(0);
      for (Sparse::InnerIterator entry(model_.expansion, model_.space.unknowns() * node + i); entry; ++entry) {
        ++writer_.whole[entries];
        writer_.whole.push_back(static_cast<int>(entry.row()));
        writer_.real.push_back(entry.value());
      }
    }
    writer_.end_record();
  }
  int number_of(const SolidSection& section) {
    // a group has one section, yielding cells a copy each
    const auto known = std::ranges::find_if(sections_, [&](const SolidSection* one) { return one == &section || *one == section; });
    const auto number = static_cast<int>(known - sections_.begin());
    if (known != sections_.end()) return number;
    sections_.push_back(&section);
    writer_.whole.insert(writer_.whole.end(), {static_cast<int>(Record::section), static_cast<int>(section.plane),
                                               static_cast<int>(section.mass), section.incompatible_modes ? 1 : 0});
    const ElasticMaterial& material = section.material;
    writer_.real.insert(writer_.real.end(), {material.young, material.poisson, material.density, section.thickness});
    return number;
  }
  void add_matrices(const Element& element) {
    for (const auto wanted : all_matrices) {
      Local local;
      local.*wanted = &matrix_;
      element.form(local);
      const bool zero = matrix_.isZero(0);
      writer_.whole.push_back(zero ? 1 : 0);
      if (!zero) writer_.real.insert(writer_.real.end(), matrix_.data(), matrix_.data() + matrix_.size());
    }
  }

  const ElementsOfModel& model_;
  std::vector<bool> sent_;  // nodes
  std::vector<const SolidSection*> sections_;
  Writer writer_;
  Matrix matrix_;
};

/// Reads the records of one piece after another.
class Reader {
 public:
  explicit Reader(MPI_Comm ranks) : ranks_(ranks) {}
  /// False: there are no more.
  bool next(Record& record) {
    if (whole_ == whole_numbers_.size() && !receive_piece()) return false;
    record = static_cast<Record>(whole());
    return true;
  }
  int whole() { return whole_numbers_[whole_++]; }
  double real() { return real_numbers_[real_++]; }

 private:
  bool receive_piece() {
    std::int64_t counts[2] = {};
    receive(counts, 2, MPI_INT64_T, ranks_);
    whole_numbers_.resize(static_cast<std::size_t>(counts[0])), real_numbers_.resize(static_cast<std::size_t>(counts[1]));
    receive(whole_numbers_.data(), counts[0], MPI_INT, ranks_);
    receive(real_numbers_.data(), counts[1], MPI_DOUBLE, ranks_);
    whole_ = real_ = 0;
    return counts[0] > 0;
  }
  MPI_Comm ranks_;
  std::vector<int> whole_numbers_;
  std::vector<double> real_numbers_;
  std::size_t whole_ = 0, real_ = 0;
};

/// Makes the elements of this rank.
class ElementReceiver {
 public:
  ElementReceiver(Space space, std::int64_t nodes, MPI_Comm ranks)
      : space_(space), reader_(ranks), place_(static_cast<std::size_t>(nodes), -1), positions_(std::make_shared<std::vector<Vec3>>()) {}
  std::vector<std::unique_ptr<const Element>> elements;
  void run() {
    for (Record record = Record::node; reader_.next(record);) {
      if (record == Record::section)
        take_section();
      else if (record == Record::node)
        take_node();
      else
        elements.push_back(record == Record::solid ? take_solid() : take_matrices());
    }
  }
  Sparse expansion(std::int64_t rows) const {
    Sparse made(rows, std::ssize(start_) - 1);
    made.resizeNonZeros(std::ssize(row_));
    std::ranges::copy(start_, made.outerIndexPtr());
    std::ranges::copy(row_, made.innerIndexPtr());
    std::ranges::copy(value_, made.valuePtr());
    return made;
  }

 private:
  void take_section() {
    auto section = std::make_shared<SolidSection>();
    section->plane = static_cast<PlaneState>(reader_.whole());
    section->mass = static_cast<SolidSection::Mass>(reader_.whole());
    section->incompatible_modes = reader_.whole() != 0;
    for (double* number : {&section->material.young, &section->material.poisson, &section->material.density, &section->thickness})
      *number = reader_.real();
    sections_.push_back(std::move(section));
  }
  void take_node() {
    place_[static_cast<std::size_t>(reader_.whole())] = static_cast<int>(positions_->size());
    Vec3& position = positions_->emplace_back();
    for (double& number : position) number = reader_.real();
    for (int i = 0; i < space_.unknowns(); ++i) {
      for (int entries = reader_.whole(); entries > 0; --entries) row_.push_back(reader_.whole()), value_.push_back(reader_.real());
      start_.push_back(static_cast<int>(row_.size()));
    }
  }
  void take_nodes(int count) {
    nodes_.clear();
    for (int k = 0; k < count; ++k) nodes_.push_back(place_[static_cast<std::size_t>(reader_.whole())]);
  }
  std::unique_ptr<const Element> take_solid() {
    const auto cell = static_cast<Cell>(reader_.whole());
    const auto& section = sections_[static_cast<std::size_t>(reader_.whole())];
    take_nodes(info(cell).nodes);
    auto made = std::make_unique<Solid>(cell, nodes_, positions_, section);
    made->beta = reader_.real();
    return made;
  }
  std::unique_ptr<const Element> take_matrices() {
    const int unknowns_per_node = reader_.whole();
    take_nodes(reader_.whole());
    const double beta = reader_.real();
    std::array<Matrix, 3> matrices;
    for (Matrix& matrix : matrices) {
      if (reader_.whole() != 0) continue;
      const auto unknowns = static_cast<Index>(unknowns_per_node) * std::ssize(nodes_);
      matrix.resize(unknowns, unknowns);
      for (Index k = 0; k < matrix.size(); ++k) matrix.data()[k] = reader_.real();
    }
    auto made = std::make_unique<MatricesOfElement>(unknowns_per_node, nodes_, std::move(matrices));
    made->beta = beta;
    return made;
  }

  Space space_;
  Reader reader_;
  std::vector<int> place_;  // here of each node of the model; -1: it is not here
  std::shared_ptr<std::vector<Vec3>> positions_;
  std::vector<std::shared_ptr<const SolidSection>> sections_;
  std::vector<int> start_{0}, row_, nodes_;
  std::vector<double> value_;
};

}  // namespace

RankElements::RankElements(std::int64_t rows, MPI_Comm ranks) {
  std::int64_t sizes[2] = {};  // dimension, nodes of the model
  receive(sizes, 2, MPI_INT64_T, ranks);
  space_.dimension = static_cast<int>(sizes[0]);
  ElementReceiver receiver(space_, sizes[1], ranks);
  receiver.run();
  elements_ = std::move(receiver.elements);
  receiver.expansion(rows).swap(expansion_);
}

void send_elements(const ElementsOfModel& model, Index first, Index end, int rank, MPI_Comm ranks) {
  const std::int64_t sizes[2] = {model.space.dimension, std::ssize(model.nodes)};
  send(sizes, 2, MPI_INT64_T, rank, ranks);
  ElementSender sender(model, rank, ranks);
  const auto reaches = [&](const Element& element) {
    for (const int node : element.nodes())
      for (int i = 0; i < element.unknowns_per_node(); ++i)
        for (Sparse::InnerIterator entry(model.expansion, model.space.unknowns() * node + i); entry; ++entry)
          if (entry.row() >= first && entry.row() < end) return true;
    return false;
  };
  for (std::size_t e = 0; e < model.elements.size(); ++e)
    if ((model.left_out.empty() || model.left_out[e] == 0) && reaches(*model.elements[e])) sender.add(*model.elements[e]);
  sender.end();
}

}  // namespace uplift
