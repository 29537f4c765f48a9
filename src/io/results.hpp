// What a run leaves behind: a results folder, time series that stream to disk, tables, and a JSON
// summary.
//
// Every whole file is written beside its place and renamed, so a reader sees the old one or the new
// one. Time series are append-only: a killed run keeps every row flushed so far, and can be
// continued (`resume`).
#pragma once
#include <io/manifest.hpp>
#include <io/value.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::io {

/// One column, or a few that belong together, of a time series.
struct Channel {
  std::string name;  ///< "DE-XY", "bearing NDE force": unique within a series
  std::string unit;  ///< unit of what is written ("m", "rpm"); "-" = dimensionless
  std::string
      description;  ///< one line, with sign convention and amplitude convention where it matters
  std::vector<std::string>
      components;      ///< empty = scalar; otherwise one name a column ("x", "y", "z")
  double scale = 1.0;  ///< written value = scale * appended value (rad/s -> rpm: 30/pi)
  std::string group;   ///< data set it goes into in binary files; "" = "series"

  std::size_t width() const { return components.empty() ? 1 : components.size(); }
  /// Column title of component k: "name" or "name.component".
  std::string column(std::size_t k) const {
    return components.empty() ? name : name + "." + components[k];
  }
};

/// A sink for rows. begin() or resume() once, append() per row, close() at the end (also done by
/// the destructor, which swallows errors). Errors while writing: Error (Exit::io).
class TimeSeries {
 public:
  virtual ~TimeSeries() = default;
  /// Starts a new series; an older file of that name is replaced. The first channel is the time by
  /// convention.
  virtual void begin(std::span<const Channel> channels) = 0;
  /// Continues a file: keeps its first `rows` rows, drops what follows (a run killed after its last
  /// checkpoint).
  /// @throws Error (Exit::io) when its channels differ or when it holds fewer rows.
  virtual void resume(std::span<const Channel> channels, std::uint64_t rows) = 0;
  /// Appends one row, a value for every column of the channels, unscaled. Does not allocate.
  /// @throws std::logic_error for a row of another length, or before begin().
  virtual void append(std::span<const double> row) = 0;
  /// Everything appended so far becomes readable by others and, in text files, safe from a power
  /// cut: what a checkpoint counts on.
  virtual void flush() = 0;
  virtual void close() = 0;
  /// Rows in the file once flushed, counting those kept by resume(): what a checkpoint remembers.
  virtual std::uint64_t rows() const = 0;
};
using TimeSeriesPtr = std::unique_ptr<TimeSeries>;

struct SeriesOptions {
  double flush_seconds = 1.0;          ///< wall clock between flushes
  std::size_t buffer_bytes = 1 << 18;  ///< flushed earlier when this much is waiting
};

/// Comma-separated values: header "name [unit],...", then shortest decimal forms that read back to
/// the same double.
TimeSeriesPtr make_csv_series(std::filesystem::path file, SeriesOptions options = {});

/// HDF5 (plug-in, loaded by this call): one compressed rows x columns data set a group; the file
/// explains itself in its attribute "layout".
/// @throws Error (Exit::io) when the plug-in was not built.
TimeSeriesPtr make_hdf5_series(const std::filesystem::path& file, SeriesOptions options = {});

/// Sends every row to several sinks.
TimeSeriesPtr make_tee(std::vector<TimeSeriesPtr> sinks);

/// What comes back from a series or table file.
struct Columns {
  std::vector<std::string> names, units;
  std::vector<std::vector<double>> values;  ///< one vector a column
  std::size_t rows() const { return values.empty() ? 0 : values.front().size(); }
  /// Column by title.
  /// @throws Error (Exit::io) when there is none.
  const std::vector<double>& operator[](std::string_view name) const;
};
/// Reads a CSV series or table; an unfinished last line (killed run) is left out. Text cells read
/// as NaN.
/// @throws Error (Exit::io) when it cannot be read or has no header.
Columns read_csv(const std::filesystem::path& file);
/// Reads an HDF5 series, also of a killed or still running program.
/// @throws Error (Exit::io) when it cannot be read or the plug-in was not built.
Columns read_hdf5(const std::filesystem::path& file);

/// A finished table: Campbell lines, critical speeds, modes. Cells are numbers or text.
class Table {
 public:
  struct Cell {
    double number = 0.0;
    std::string text;
    bool is_text = false;
    /// Of pages alone: a figure of the report that it leads to, and its colour.
    enum class Mark { none, passed, failed } mark = Mark::none;
    std::string figure;
    Cell(double x) : number(x) {}
    Cell(int x) : number(x) {}
    Cell(std::string s) : text(std::move(s)), is_text(true) {}
    Cell(const char* s) : text(s), is_text(true) {}
  };
  struct Column {
    std::string name, unit, description;
  };

  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<Cell>> rows;
  /// What "nan" in a cell stands for ("the mode is not there at this speed"); empty: there is to be
  /// none, and one that is written all the same is reported (nonfinite.hpp).
  std::string nan_means;
  /// The row of such a cell has nothing to give there (no such mode at this speed): who looks for the largest
  /// of a column passes it by. Else there is a value, which is without bound or was not found.
  bool nan_is_absence = false;

  /// Adds a row.
  /// @throws std::logic_error when it has not one cell a column.
  void add(std::vector<Cell> row);
};
/// CSV, header "name [unit]", written atomically.
/// @throws Error (Exit::io) when it cannot be written.
void write_csv(const std::filesystem::path& file, const Table& table);

/// A folder of results. Made on construction (with parents), and rid of half-written files of
/// killed runs. All names are relative to it. What is written is listed in its manifest
/// (manifest.hpp), which keeps the user's own files in the same folder safe.
class ResultsFolder {
 public:
  /// @throws Error (Exit::io) when it cannot be made; of all members: when a file cannot be
  /// written.
  explicit ResultsFolder(std::filesystem::path root);
  const std::filesystem::path& root() const { return root_; }
  /// Of texts and tables these alone are written, and no list of what is: for a folder from which
  /// they are read at once, and which is thrown away. Names as in write_table().
  void write_only(std::vector<std::string> names);
  /// Called with every table that is written from now on, with its name.
  using TableSeen = std::function<void(std::string_view name, const Table& table)>;
  void show_tables_to(TableSeen seen) { seen_ = std::move(seen); }
  /// Who writes from now on, by name: two owners do not write one file.
  void set_owner(std::string owner) { owner_ = std::move(owner); }
  /// Path of a file that will be written in it, and listed as such; makes the folders in between.
  std::filesystem::path path(std::string_view name) const;
  /// Path of a folder in it, made when missing.
  /// @throws Error (Exit::io) when it is a symbolic link.
  std::filesystem::path subfolder(std::string_view name) const;
  /// Removes the files of earlier runs that `which` accepts, by their names; never a file that no
  /// run made, or that this one reads.
  void remove(const std::function<bool(const std::string& name)>& which) const;
  /// Files that this run reads: none of them is written over.
  /// @throws Error (Exit::io, E91), by what would write one.
  void protect(const std::vector<std::filesystem::path>& inputs);
  /// Removes what an owner has written in this run.
  void remove_of(const std::string& owner) const;
  void write_text(std::string_view name, std::string_view content) const;  ///< atomic
  void write_json(std::string_view name, const Value& value) const;        ///< atomic
  void write_table(std::string_view name, const Table& table) const;       ///< atomic

 private:
  std::filesystem::path root_;
  /// Claims a file; whether it is to be written.
  bool wanted(std::string_view name) const;

  std::shared_ptr<Manifest> manifest_;
  std::string owner_;
  std::vector<std::string> only_;  ///< empty: all
  TableSeen seen_;                 ///< empty: nobody
};

}  // namespace whirl::io
