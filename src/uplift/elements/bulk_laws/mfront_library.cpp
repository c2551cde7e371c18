#include "uplift/elements/bulk_laws/mfront_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <set>

#include "uplift/base/file.h"
#include "uplift/base/text.h"

namespace uplift {
namespace {

constexpr std::string_view entry_mark = "_mfront_mkt";  // ends the name of a symbol that every behaviour has

/// Names of the behaviours in a library, from the names of its symbols. For messages.
std::vector<std::string> behaviours_of(const std::filesystem::path& path) {
  const std::string content = read_file(path);
  std::set<std::string> names;
  for (std::size_t at = content.find(entry_mark); at != std::string::npos; at = content.find(entry_mark, at + 1)) {
    const std::size_t begin = content.rfind('\0', at) + 1, end = at + entry_mark.size();
    if (end < content.size() && content[end] == '\0' && begin < at) names.insert(content.substr(begin, at - begin));
  }
  return {names.begin(), names.end()};
}

/// Whether the end of a library of 64 bits is missing, as after an interrupted copy: the loader maps it all the same, and the process is
/// killed at the first access. The table of sections stands at its end (ELF-64: place at byte 40, size and number of entries at 58).
bool is_cut(const std::filesystem::path& path) {
  const std::string content = read_file(path);
  constexpr std::size_t head = 64;
  if (content.size() < head || !content.starts_with("\177ELF\2")) return false;  // dlopen says what is wrong
  std::uint64_t sections = 0;
  std::uint16_t size = 0, count = 0;
  std::memcpy(&sections, content.data() + 40, sizeof sections);
  std::memcpy(&size, content.data() + 58, sizeof size);
  std::memcpy(&count, content.data() + 60, sizeof count);
  const std::uint64_t table = std::uint64_t{size} * count;
  return sections > content.size() || table > content.size() - sections;
}

std::shared_ptr<void> open_library(const Values& law, const std::filesystem::path& path) {
  constexpr char wanted[] = "a shared library made by MFront";
  require_file(path, law.where("library"), law.path("library"), wanted);
  if (is_cut(path)) fail(law, "library", wanted, in_quotes(law.text("library")) + ", whose end is missing");
  void* handle = ::dlopen(std::filesystem::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) fail(law, "library", wanted, ::dlerror());
  return {handle, [](void* opened) { ::dlclose(opened); }};
}

/// The symbols of one behaviour. What depends on the modelling hypothesis may have a symbol of its own for it: BEHAVIOUR_HYPOTHESIS_name
/// comes before BEHAVIOUR_name.
class Symbols {
 public:
  Symbols(const Values& law, std::shared_ptr<void> library) : law_(law), library_(std::move(library)), behaviour_(law.text("behaviour")) {}

  void choose(const std::string& hypothesis) { hypothesis_ = hypothesis; }
  const void* find(const std::string& name) const {
    const void* special = hypothesis_.empty() ? nullptr : ::dlsym(library_.get(), (behaviour_ + "_" + hypothesis_ + name).c_str());
    return special != nullptr ? special : ::dlsym(library_.get(), (behaviour_ + name).c_str());
  }
  int number(const std::string& name) const { return *static_cast<const unsigned short*>(needed(name)); }
  int number(const std::string& name, int absent) const { return find(name) != nullptr ? number(name) : absent; }
  std::string text(const std::string& name) const { return *static_cast<const char* const*>(needed(name)); }
  std::vector<std::string> names(const std::string& list) const {
    const int count = number("_n" + list);
    if (count == 0) return {};
    const auto* first = static_cast<const char* const*>(needed("_" + list));
    return {first, first + count};
  }
  std::vector<int> types(const std::string& list) const {
    const int count = number("_n" + list);
    if (count == 0) return {};
    const auto* first = static_cast<const int*>(needed("_" + list + "Types"));
    return {first, first + count};
  }
  /// The behaviour's function for the chosen hypothesis.
  MfrontFunction function() const {
    void* symbol = ::dlsym(library_.get(), (behaviour_ + "_" + hypothesis_).c_str());
    if (symbol == nullptr) needed("_" + hypothesis_);
    return reinterpret_cast<MfrontFunction>(symbol);  // NOLINT: what dlsym is for
  }
  [[noreturn]] void refuse(const std::string& wanted, const std::string& found) const { fail(law_, "behaviour", wanted, found); }

 private:
  const void* needed(const std::string& name) const {
    const void* symbol = find(name);
    if (symbol == nullptr) refuse("a behaviour of MFront's generic interface", "no symbol " + in_quotes(behaviour_ + name));
    return symbol;
  }

  const Values& law_;
  std::shared_ptr<void> library_;
  std::string behaviour_, hypothesis_;
};

void check_name(const Values& law, const Symbols& symbols, const std::filesystem::path& path) {
  if (symbols.find(std::string(entry_mark)) != nullptr) return;
  const std::vector<std::string> names = behaviours_of(path);
  const std::string& name = law.text("behaviour");
  fail(law, "behaviour", names.empty() ? "a library with a behaviour of MFront" : "a behaviour of the library: " + listed(names),
       in_quotes(name), nearest_name(name, names));
}

/// What the program can use: small strains, isotropic, no fields from outside.
void check_kind(const Symbols& symbols) {
  if (symbols.number(std::string(entry_mark)) != 1) symbols.refuse("a behaviour", "a material property or a model");
  if (const std::string made_for = symbols.text("_mfront_interface"); made_for != "Generic")
    symbols.refuse("a library made with mfront --interface=generic", "the interface " + in_quotes(made_for));
  if (const int version = symbols.number("_api_version", 0); version != 1)
    symbols.refuse("version 1 of the generic interface (TFEL 3.4.1 and later)", fmt::format("version {}", version));
  if (symbols.number("_BehaviourType") != 1 || symbols.number("_BehaviourKinematic") != 1)
    symbols.refuse("a behaviour for small strains", "one of another kind (finite strains, a joint or a general one)");
  if (symbols.number("_SymmetryType") != 0) symbols.refuse("an isotropic behaviour", "an orthotropic one");
}

/// In plane strain also the behaviour for three dimensions is right, with zero strains out of the plane.
std::string hypothesis_for(const Symbols& symbols, int dimension) {
  const std::vector<std::string> offered = symbols.names("ModellingHypotheses");
  for (const char* wanted : {"PlaneStrain", "Tridimensional"})
    if ((dimension == 2 || wanted == std::string_view("Tridimensional")) && std::ranges::find(offered, wanted) != offered.end())
      return wanted;
  symbols.refuse(dimension == 2 ? "a behaviour for PlaneStrain or Tridimensional" : "a behaviour for Tridimensional",
                 offered.empty() ? "no modelling hypothesis" : "one for " + listed(offered));
}

/// Young's modulus and Poisson's ratio come first where MFront asks the caller for the elastic stiffness.
std::vector<std::string> properties_of(const Symbols& symbols) {
  std::vector<std::string> all;
  if (symbols.number("_requiresStiffnessTensor", 0) == 1) all = {"YoungModulus", "PoissonRatio"};
  if (symbols.number("_requiresThermalExpansionCoefficientTensor", 0) == 1) all.emplace_back("ThermalExpansion");
  for (std::string& name : symbols.names("MaterialProperties")) all.push_back(std::move(name));
  return all;
}

std::vector<MfrontVariable> variables_of(const Symbols& symbols, int components) {
  const std::vector<std::string> names = symbols.names("InternalStateVariables");
  const std::vector<int> types = symbols.types("InternalStateVariables");
  const bool space = components == 6;
  const int sizes[] = {1, components, space ? 3 : 2, space ? 9 : 5};  // scalar, symmetric tensor, vector, tensor
  std::vector<MfrontVariable> all;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (types[k] < 0 || types[k] > 3)
      symbols.refuse("internal state variables that are scalars, vectors or tensors", in_quotes(names[k]) + " of another type");
    all.push_back({names[k], sizes[types[k]]});
  }
  return all;
}

void check_external_variables(const Symbols& symbols) {
  std::vector<std::string> names = symbols.names("ExternalStateVariables");
  std::erase(names, "Temperature");
  if (!names.empty()) symbols.refuse("a behaviour without external state variables except the temperature", listed(names));
}

}  // namespace

int MfrontBehaviour::num_variables() const {
  int sum = 0;
  for (const MfrontVariable& each : variables) sum += each.size;
  return sum;
}

std::filesystem::path library_of(const Values& law) {
  return law.items().contains("library") ? std::filesystem::path(path_beside(law.where("library"), law.text("library"))) : "";
}

MfrontBehaviour load_mfront(const Values& law, int dimension) {
  const std::filesystem::path path = library_of(law);
  MfrontBehaviour made;
  made.name = law.text("behaviour");
  made.library = open_library(law, path);
  Symbols symbols(law, made.library);
  check_name(law, symbols, path);
  check_kind(symbols);
  const std::string hypothesis = hypothesis_for(symbols, dimension);
  symbols.choose(hypothesis);
  check_external_variables(symbols);
  made.function = symbols.function();
  made.components = hypothesis == "PlaneStrain" ? 4 : 6;
  made.properties = properties_of(symbols);
  made.variables = variables_of(symbols, made.components);
  made.stores_energy = symbols.number("_ComputesInternalEnergy", 0) == 1;
  return made;
}

}  // namespace uplift
