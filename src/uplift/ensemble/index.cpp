#include "uplift/ensemble/index.h"

#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <variant>

#include "uplift/io/files.h"

namespace uplift {
namespace {

constexpr const char* tables =
    "PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; BEGIN;"
    "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT);"
    "CREATE TABLE motion(name TEXT PRIMARY KEY, label TEXT, sha256 TEXT, step REAL, duration REAL, intensity REAL, pga REAL, pgv REAL, "
    "arias REAL, "
    "cav REAL, significant_duration REAL);"
    "CREATE TABLE sample(sample INTEGER, variable TEXT, value REAL);"
    "CREATE TABLE run(id TEXT PRIMARY KEY, motion TEXT, sample INTEGER, factor REAL, intensity REAL, outcome TEXT, reason TEXT, attempt "
    "INTEGER, "
    "wall REAL, steps INTEGER, retries INTEGER, end_time REAL, created REAL);"
    "CREATE TABLE number(run TEXT, quantity TEXT, of TEXT, value REAL);"
    "CREATE TABLE spectrum(run TEXT, floor TEXT, damping REAL, frequency REAL, psa REAL);";

using CellValue = std::variant<double, long, std::string>;

/// A data base that is being written. Every failure is an OutputError.
class Writer {
 public:
  explicit Writer(std::string path) : path_(std::move(path)) {
    check(sqlite3_open_v2(path_.c_str(), &base_, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr));
    execute(tables);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { close(); }
  void execute(const char* text) { check(sqlite3_exec(base_, text, nullptr, nullptr, nullptr)); }
  void finish() {
    execute("COMMIT;");
    close();
  }

  /// A statement with places "?", made once for many rows.
  class Insert {
   public:
    Insert(Writer& writer, const std::string& table, int columns) : writer_(writer) {
      std::string text = "INSERT INTO " + table + " VALUES(?";
      for (int i = 1; i < columns; ++i) text += ",?";
      writer.check(sqlite3_prepare_v2(writer.base_, (text + ")").c_str(), -1, &statement_, nullptr));
    }
    Insert(const Insert&) = delete;
    Insert& operator=(const Insert&) = delete;
    ~Insert() { sqlite3_finalize(statement_); }
    void row(const std::vector<CellValue>& cells) {
      int place = 0;
      for (const CellValue& cell : cells) {
        ++place;
        if (const auto* number = std::get_if<double>(&cell))
          sqlite3_bind_double(statement_, place, *number);
        else if (const auto* count = std::get_if<long>(&cell))
          sqlite3_bind_int64(statement_, place, *count);
        else
          sqlite3_bind_text(statement_, place, std::get<std::string>(cell).c_str(), -1, SQLITE_STATIC);
      }
      writer_.check(sqlite3_step(statement_));
      sqlite3_reset(statement_);
    }

   private:
    Writer& writer_;
    sqlite3_stmt* statement_ = nullptr;
  };

 private:
  void check(int code) const {
    if (code == SQLITE_OK || code == SQLITE_DONE || code == SQLITE_ROW) return;
    throw OutputError(fmt::format("cannot write {}: {}", path_, base_ != nullptr ? sqlite3_errmsg(base_) : sqlite3_errstr(code)));
  }
  void close() {
    sqlite3_close(base_);
    base_ = nullptr;
  }
  std::string path_;
  sqlite3* base_ = nullptr;
};

void fill(const Study& study, const StudyStore& store, const std::vector<StudyCurve>& curves, Writer& writer) {
  Writer::Insert meta(writer, "meta", 2), motion(writer, "motion", 11), sample(writer, "sample", 3), run(writer, "run", 13),
      number(writer, "number", 4), spectrum(writer, "spectrum", 5);
  meta.row({std::string("format"), std::string("uplift-study-index-1")});
  meta.row({std::string("version"), std::string(UPLIFT_VERSION)});
  meta.row({std::string("plan_sha256"), study.plan_hash});
  meta.row({std::string("intensity"), study.of.plan.intensity.label()});
  meta.row({std::string("unit"), study.of.plan.intensity.unit});
  meta.row({std::string("lines_in_several_parts"), static_cast<long>(store.repeated())});
  for (const StudyMotion& each : study.of.motions)
    motion.row({each.name, each.label, each.hash, each.step, each.duration, each.intensity, each.measures.pga, each.measures.pgv,
                each.measures.arias, each.measures.cav, each.measures.significant_duration()});
  for (std::size_t i = 0; i < study.of.samples.size(); ++i)
    for (std::size_t k = 0; k < study.of.plan.variables.size(); ++k)
      sample.row({static_cast<long>(i), study.of.plan.variables[k].name, study.of.samples[i].values[k]});
  for (const StudyCurve& curve : curves)
    for (const auto& [intensity, one] : curve.runs()) {
      const StudyResult& result = *one.result;
      run.row({result.id, result.motion, result.sample, result.factor, intensity, std::string(to_string(result.outcome)), result.reason,
               result.attempt, result.wall, result.steps, result.retries, result.end_time, result.created});
      for (const StudyNumber& each : result.numbers) number.row({result.id, each.quantity, each.of, each.value});
      for (const StudySpectrum& each : result.spectra)
        for (std::size_t f = 0; f < each.frequencies.size(); ++f)
          spectrum.row({result.id, each.floor, each.damping, each.frequencies[f], each.values[f]});
    }
}

}  // namespace

void write_index(const Study& study, const StudyStore& store, const std::vector<StudyCurve>& curves) {
  const std::string path = study.folder + "/study.db", draft = fmt::format("{}.{}", path, ::getpid());
  std::error_code error;
  std::filesystem::remove(draft, error);
  try {
    Writer writer(draft);
    fill(study, store, curves, writer);
    writer.finish();
    if (std::rename(draft.c_str(), path.c_str()) != 0) throw OutputError(fmt::format("cannot write {}", path));
  } catch (...) {
    std::filesystem::remove(draft, error);
    throw;
  }
}

}  // namespace uplift
