#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "uplift/contact/problem.h"

// A stored interface problem is one JSON object:
//   format "uplift interface problem 1", reason, average, scale, step [s], factor (rows of C), shift, free_opening, from, old, and blocks:
//   (with the scheme of filtered energy decay: filter_gain, filter_coefficient [Pa/m], filter_lag [m])
//   name, points, components, area, behaviour {type, parameters}, and substitute {stiffness [Pa/m], memory} where a method had put a law in
//   the place of the cone. Only format, factor, free_opening and blocks are needed: without `scale` it is 1, without `average` false, and
//   the others are zero or empty. Doubles are written so that they read back to the same bits; numbers that
//   are not finite (a failed step may hold some) are the words "nan", "inf", "-inf".
namespace uplift {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* format_name = "uplift interface problem 1";

Json to_json(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}
Json to_json(const double* values, std::size_t n) {
  Json list = Json::array();
  for (std::size_t i = 0; i < n; ++i) list.push_back(to_json(values[i]));
  return list;
}
Json to_json(const Vector& v) {
  return to_json(v.data(), static_cast<std::size_t>(v.size()));
}

Json to_json(const Values& behaviour) {
  Json object = Json::object();
  object["type"] = behaviour.type();
  for (const auto& [key, item] : behaviour.items()) {
    if (const auto* value = std::get_if<bool>(&item.data)) object[key] = *value;
    if (const auto* value = std::get_if<std::int64_t>(&item.data)) object[key] = *value;
    if (const auto* value = std::get_if<double>(&item.data)) object[key] = to_json(*value);
    if (const auto* value = std::get_if<std::string>(&item.data)) object[key] = *value;
    if (const auto* value = std::get_if<std::vector<double>>(&item.data)) object[key] = to_json(value->data(), value->size());
    if (const auto* value = std::get_if<std::vector<std::string>>(&item.data)) object[key] = *value;
  }
  return object;
}

bool is_cone(const std::string& name) {
  const auto catalog = cone_catalog();
  return std::any_of(catalog.begin(), catalog.end(), [&](const Entry<Cone>* entry) { return entry->name == name; });
}

/// Reads one file: every accessor knows the path for its complaint.
class Reader {
 public:
  Reader(const std::string& file, const Json& json) : file_(file), json_(json) {}

  [[noreturn]] void refuse(const std::string& path, const std::string& wanted, const std::string& found) const {
    throw InputError({file_, 0}, path, wanted, found);
  }
  const Json& at(const Json& object, const std::string& path, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) refuse(path.empty() ? key : path + "." + key, "a value", "nothing");
    return *found;
  }
  double number(const Json& value, const std::string& path) const {
    if (value.is_number()) return value.get<double>();
    if (value == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (value == "inf") return std::numeric_limits<double>::infinity();
    if (value == "-inf") return -std::numeric_limits<double>::infinity();
    refuse(path, "a number", value.dump());
  }
  int integer(const Json& value, const std::string& path, int least, int most) const {
    if (!value.is_number_integer() || value.get<double>() < least || value.get<double>() > most)
      refuse(path, "an integer from " + std::to_string(least) + " to " + std::to_string(most), value.dump());
    return value.get<int>();
  }
  std::vector<double> numbers(const Json& value, const std::string& path) const {
    if (!value.is_array()) refuse(path, "a list of numbers", value.dump());
    std::vector<double> result;
    for (std::size_t i = 0; i < value.size(); ++i) result.push_back(number(value[i], path + "[" + std::to_string(i) + "]"));
    return result;
  }
  /// Zeros where the key is left out.
  Vector vector(const char* key, std::size_t size) const {
    if (!json_.contains(key)) return Vector::Zero(static_cast<Index>(size));
    const std::vector<double> list = numbers(at(json_, "", key), key);
    if (list.size() != size) refuse(key, std::to_string(size) + " numbers", std::to_string(list.size()));
    return ConstMap(list.data(), static_cast<Index>(list.size()));
  }
  std::string text(const Json& value, const std::string& path) const {
    if (!value.is_string()) refuse(path, "a text", value.dump());
    return value.get<std::string>();
  }

  /// A parameter table as the checker of case files wants it.
  Raw raw(const Json& value, const std::string& path) const {
    Raw result{{}, {file_, 0}, path};
    if (value.is_boolean()) result.data = value.get<bool>();
    if (value.is_number_integer()) result.data = value.get<std::int64_t>();
    if (value.is_number_float()) result.data = value.get<double>();
    if (value.is_string()) result.data = value.get<std::string>();
    if (value.is_array()) {
      RawList list;
      for (std::size_t i = 0; i < value.size(); ++i) list.push_back(raw(value[i], path + "[" + std::to_string(i) + "]"));
      result.data = std::move(list);
    }
    if (value.is_object()) {
      auto table = std::make_shared<RawTable>();
      for (const auto& [key, entry] : value.items()) table->entries.emplace_back(key, raw(entry, path + "." + key));
      result.data = std::move(table);
    }
    return result;
  }

  Footprint footprint(const Json& object, const std::string& path) const {
    Footprint made;
    const std::string shape = text(at(object, path, "shape"), path + ".shape");
    const auto known = footprint_shape(shape);
    if (!known) refuse(path + ".shape", "strip, rectangle or disc", shape);
    made.shape = *known;
    for (const auto& [key, value] : {std::pair{"width", &made.width}, {"length", &made.length}}) {
      *value = number(at(object, path, key), path + "." + key);
      if (!(*value > 0 && std::isfinite(*value))) refuse(path + "." + key, "a finite length > 0", std::to_string(*value));
    }
    made.dimension = integer(at(object, path, "dimension"), path + ".dimension", 2, 3);
    return made;
  }

  void block(const Json& object, const std::string& path, ContactModel& model, StoredProblem& stored) const {
    Block block;
    block.name = text(at(object, path, "name"), path + ".name");
    block.batch.points = integer(at(object, path, "points"), path + ".points", 1, 10000000);
    block.batch.components = integer(at(object, path, "components"), path + ".components", 1, most_components);
    if (object.contains("foundation")) block.footprint = footprint(object["foundation"], path + ".foundation");
    if (block.footprint) block.batch.rotations = block.footprint->rotations();
    if (block.footprint ? block.batch.components != block.footprint->components() || block.batch.points != 1 : block.batch.components > 3)
      refuse(path + ".components", block.footprint ? "one point with the rows of the foundation" : "at most 3 components",
             std::to_string(block.batch.components));
    const std::vector<double> areas = numbers(at(object, path, "area"), path + ".area");
    block.area = ConstMap(areas.data(), static_cast<Index>(areas.size()));
    if (block.area.size() != block.batch.points)
      refuse(path + ".area", std::to_string(block.batch.points) + " numbers", std::to_string(block.area.size()));
    for (const double area : block.area)
      if (!(area > 0 && std::isfinite(area))) refuse(path + ".area", "finite areas > 0", std::to_string(area));
    const Values values =
        check_part(raw(at(object, path, "behaviour"), path + ".behaviour"), block.footprint ? foundation_models() : interface_behaviours());
    InterfaceProblem& problem = stored.problem;
    for (const Block& other : model.blocks) block.first = other.first + other.rows();
    block.first_history = static_cast<int>(problem.old.size());
    if (!block.footprint && is_cone(values.type())) {
      stored.cones.push_back(make_part(cone_catalog(), values));
      block.cone = stored.cones.back().get();
      if (const auto found = object.find("substitute"); found != object.end()) {
        const std::string inside = path + ".substitute";
        block.substitute_stiffness = number(at(*found, inside, "stiffness"), inside + ".stiffness");
        if (!(block.substitute_stiffness > 0 && std::isfinite(block.substitute_stiffness)))
          refuse(inside + ".stiffness", "a finite stiffness > 0", std::to_string(block.substitute_stiffness));
        block.substitute_memory = numbers(at(*found, inside, "memory"), inside + ".memory");
        if (block.substitute_memory.size() % static_cast<std::size_t>(block.batch.points) != 0)
          refuse(inside + ".memory", "as many numbers for each point", std::to_string(block.substitute_memory.size()));
      }
    } else {
      stored.laws.push_back(make_law(values, block.footprint));
      block.law = stored.laws.back().get();
      problem.old.resize(problem.old.size() + block.law->num_history(block.batch.components) * block.batch.points);
    }
    model.blocks.push_back(std::move(block));
  }

  StoredProblem problem() const {
    if (!json_.is_object()) refuse("", "a JSON object", json_.type_name());
    if (!json_.contains("format"))
      refuse("", std::string("the interface problem of a failed step, \"format\": \"") + format_name + '"', "another document");
    if (const std::string found = text(json_["format"], "format"); found != format_name) refuse("format", format_name, found);
    check_keys();
    StoredProblem stored;
    auto shared = std::make_shared<ContactModel>();
    ContactModel& model = *shared;
    stored.problem.model = shared;
    if (json_.contains("reason")) stored.reason = text(json_["reason"], "reason");
    const Json& blocks = at(json_, "", "blocks");
    if (!blocks.is_array() || blocks.empty()) refuse("blocks", "a list of blocks", blocks.dump().substr(0, 40));
    for (std::size_t b = 0; b < blocks.size(); ++b) block(blocks[b], "blocks[" + std::to_string(b) + "]", model, stored);
    InterfaceProblem& problem = stored.problem;
    const std::size_t rows = static_cast<std::size_t>(model.blocks.back().first + model.blocks.back().rows());
    if (json_.contains("average")) {
      if (!json_["average"].is_boolean()) refuse("average", "true or false", json_["average"].dump());
      model.average = json_["average"].get<bool>();
    }
    if (json_.contains("scale")) model.scale = number(json_["scale"], "scale");
    if (json_.contains("step")) model.step = number(json_["step"], "step");
    if (json_.contains("size")) model.size = number(json_["size"], "size");
    if (model.size < 0) refuse("size", "a length of at least 0", json_["size"].dump());
    const Json& factor = at(json_, "", "factor");
    if (!factor.is_array() || factor.size() != rows)
      refuse("factor", "a list of " + std::to_string(rows) + " rows", factor.is_array() ? std::to_string(factor.size()) : factor.dump());
    for (std::size_t i = 0; i < rows; ++i) {
      const std::string path = "factor[" + std::to_string(i) + "]";
      const std::vector<double> row = numbers(factor[i], path);
      if (i == 0) model.factor.resize(static_cast<Index>(rows), static_cast<Index>(row.size()));
      if (row.size() != static_cast<std::size_t>(model.factor.cols()))
        refuse(path, std::to_string(model.factor.cols()) + " numbers", std::to_string(row.size()));
      model.factor.row(static_cast<Index>(i)) = ConstMap(row.data(), static_cast<Index>(row.size())).transpose();
    }
    if (json_.contains("shift") && json_["shift"] != Json::array()) model.shift = vector("shift", rows);
    at(json_, "", "free_opening");
    problem.free_opening = vector("free_opening", rows);
    problem.from = vector("from", rows);
    problem.old = vector("old", problem.old.size());
    if (json_.contains("filter_gain")) {
      problem.filter.gain = number(json_["filter_gain"], "filter_gain");
      problem.filter.coefficient = vector("filter_coefficient", rows);
      problem.filter.lag = vector("filter_lag", rows);
    }
    return stored;
  }

 private:
  void check_keys() const {
    static const std::vector<std::string> known{
        "format",    "reason",       "average", "scale", "step",   "size",        "factor",
        "shift",     "free_opening", "from",    "old",   "blocks", "filter_gain", "filter_coefficient",
        "filter_lag"};
    for (const auto& [key, value] : json_.items())
      if (std::find(known.begin(), known.end(), key) == known.end())
        throw InputError({file_, 0}, key, "a key of an interface problem", "\"" + key + "\"", nearest_name(key, known));
  }

  const std::string& file_;
  const Json& json_;
};

}  // namespace

std::string save_problem(const InterfaceProblem& problem, const std::vector<const Values*>& behaviours, const std::string& reason) {
  Json json = Json::object();
  json["format"] = format_name;
  json["reason"] = reason;
  json["average"] = problem.model->average;
  json["scale"] = to_json(problem.model->scale);
  json["step"] = to_json(problem.model->step);
  json["size"] = to_json(problem.model->size);
  json["blocks"] = Json::array();
  std::vector<double> old;
  for (std::size_t b = 0; b < problem.model->blocks.size(); ++b) {
    const Block& block = problem.model->blocks[b];
    Json object = Json::object();
    object["name"] = block.name;
    object["points"] = block.batch.points;
    object["components"] = block.batch.components;
    if (block.footprint) {
      const Footprint& under = *block.footprint;
      object["foundation"] = {{"shape", std::string(to_string(under.shape))},
                              {"width", to_json(under.width)},
                              {"length", to_json(under.length)},
                              {"dimension", under.dimension}};
    }
    object["behaviour"] = to_json(*behaviours[b]);
    if (block.footprint && block.footprint->soil) {  // the problem states what the soil has given
      double stiffness[most_components] = {};
      block.law->closed_stiffness(block.batch.components, stiffness);
      const auto keys = foundation_stiffness_keys(block.batch.components);
      for (std::size_t r = 0; r < keys.size(); ++r) object["behaviour"][keys[r]] = to_json(stiffness[r]);
    }
    object["area"] = to_json(block.area.data(), block.area.size());
    const double* memory = problem.old.data() + block.first_history;
    const std::size_t values =
        block.law != nullptr ? static_cast<std::size_t>(block.law->num_history(block.batch.components) * block.batch.points) : 0;
    if (block.law != nullptr && !block.footprint && is_cone(behaviours[b]->type())) {
      double stiffness[most_components] = {};
      block.law->closed_stiffness(block.batch.components, stiffness);
      object["substitute"]["stiffness"] = to_json(stiffness[block.batch.translations() - 1]);
      object["substitute"]["memory"] = to_json(memory, values);
    } else {
      old.insert(old.end(), memory, memory + values);
    }
    json["blocks"].push_back(std::move(object));
  }
  json["factor"] = Json::array();
  for (Index i = 0; i < problem.model->factor.rows(); ++i)
    json["factor"].push_back(to_json(Vector(problem.model->factor.row(i).transpose())));
  json["shift"] = to_json(problem.model->shift);
  json["free_opening"] = to_json(problem.free_opening);
  json["from"] = to_json(problem.from);
  json["old"] = to_json(old.data(), old.size());
  if (problem.filter.acts()) {
    json["filter_gain"] = to_json(problem.filter.gain);
    json["filter_coefficient"] = to_json(problem.filter.coefficient);
    json["filter_lag"] = to_json(problem.filter.lag);
  }
  // one key a line, one row of the factor a line: readable, and it can be compared
  std::string text = "{";
  for (const auto& [key, value] : json.items()) {
    text += (text.size() > 1 ? ",\n  " : "\n  ") + Json(key).dump() + ": ";
    if ((key != "factor" && key != "blocks") || value.empty()) {
      text += value.dump();
      continue;
    }
    for (std::size_t i = 0; i < value.size(); ++i) text += (i == 0 ? "[\n    " : ",\n    ") + value[i].dump();
    text += "]";
  }
  return text + "\n}\n";
}

StoredProblem load_problem(const std::string& text, const std::string& file) {
  constexpr int most_levels = 20;  // of nested lists and tables
  const auto watch = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > most_levels) throw InputError({file, 0}, "", "at most 20 levels of JSON", "more");
    return true;
  };
  Json json;
  try {
    json = Json::parse(text, watch);
  } catch (const Json::parse_error& error) {
    const std::size_t end = std::min(error.byte, text.size());
    const int line = 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
    throw InputError({file, line}, "", "a JSON file of an interface problem", "a syntax error at byte " + std::to_string(error.byte));
  } catch (const Json::exception&) {
    throw InputError({file, 0}, "", "JSON with numbers of at most 1e308", "a larger number");
  }
  return Reader(file, json).problem();
}

}  // namespace uplift
