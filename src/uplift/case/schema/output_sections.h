#pragma once
#include "uplift/case/schema/case_table.h"
#include "uplift/elements/element_entry.h"

// What is written: declarations, used by case/schema/sections.cpp alone, and what their tables are read into.
namespace uplift {

/// A node by its name, or the one nearest to a place: which of them must be given is checked where it is looked for.
struct NodeAsked : CaseTable {
  std::optional<NameUsed> node;
  std::optional<Vec3> at;  // m
};

struct CaseHistory : NodeAsked {
  std::optional<NameUsed> name, interface, beam, group, below;
  std::optional<int> point;               // of the interface, from 1
  std::optional<double> position, level;  // m
  NameUsed quantity;
};

struct CaseEnvelope : CaseTable {
  NameUsed beam;
  int sections;
};

struct CaseFloor : NodeAsked {
  NameUsed name;
  Vec3 direction;                   // of length 1
  std::vector<double> dampings;     // ratios
  std::vector<double> frequencies;  // Hz
  double broadening;                // share of the frequency to either side
};

struct CaseFields : CaseTable {
  enum class Format { vtu, xdmf };
  std::optional<Format> format;  // absent: by the size
  std::optional<int> every;      // n-th step
  bool events;
  std::vector<std::string> quantities;  // empty: all
  std::optional<std::vector<std::string>> groups;
  bool float32, variants;
};

const Section& output_section();
struct CaseOutput : CaseTable {
  int every = 1;
  bool automatic = true, energies = true;
  int frames = 0;
  std::vector<CaseHistory> histories;
  std::vector<CaseFloor> floors;
  std::vector<CaseEnvelope> envelopes;
  std::vector<double> floor_bands;   // Hz
  std::optional<double> checkpoint;  // s on the clock
  std::optional<CaseFields> fields;
};
CaseOutput case_output(const Values&, Space);

}  // namespace uplift
