// Time series in HDF5.
//
// The file is written in single-writer multiple-reader mode, so others may read while it grows, and
// a killed run leaves a readable file. Compressed chunks cannot be rewritten in place without
// leaking space, so only full chunks go to the compressed data sets; the rows after the last full
// chunk wait in `tail`, which is not compressed. `state` says what counts. close() moves the tail
// into the data sets.
#include <core/error.hpp>
#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/hdf5/entry.hpp>
#include <io/hdf5/handle.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <unistd.h>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* layout_text =
    "Time series written by Whirl. Every data set of the root but 'tail' and 'state' is rows x "
    "columns (double); its "
    "attributes 'columns', 'units' and 'descriptions' name the columns. While the program runs, or "
    "after it was killed, "
    "state = (rows valid in the data sets, row number of the first row of tail, rows in tail), and "
    "tail holds the newest "
    "rows, all columns side by side in the order of the attribute 'order'; open such a file in "
    "SWMR read mode (h5py: "
    "swmr=True) or make it an ordinary file with h5clear -s -i. After a normal end tail is empty.";

struct Group {
  std::string name;
  std::vector<hsize_t> columns;  // columns of the row that go here
  std::vector<std::string> titles, units, descriptions;
  Handle data;
};

std::vector<Group> groups_of(std::span<const Channel> channels) {
  std::vector<Group> groups;
  hsize_t column = 0;
  for (const auto& c : channels) {
    const std::string name = c.group.empty() ? "series" : c.group;
    auto g =
        std::find_if(groups.begin(), groups.end(), [&](const Group& x) { return x.name == name; });
    if (g == groups.end()) g = groups.insert(groups.end(), Group{name, {}, {}, {}, {}, {}});
    for (std::size_t k = 0; k < c.width(); ++k) {
      g->columns.push_back(column++);
      g->titles.push_back(c.column(k));
      g->units.push_back(c.unit);
      g->descriptions.push_back(c.description);
    }
  }
  return groups;
}

void write_strings(const fs::path& file, hid_t where, const char* name,
                   const std::vector<std::string>& values) {
  const hsize_t n = values.size();
  Handle type = string_type();
  Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, file, "cannot write");
  Handle a(H5Acreate2(where, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, file,
           "cannot write");
  std::vector<const char*> p;
  for (const auto& v : values)
    p.push_back(v.c_str());
  if (H5Awrite(a, type, p.data()) < 0) io_failure(file, "cannot write");
}

std::vector<std::string> read_strings(const fs::path& file, hid_t where, const char* name) {
  Handle type = string_type();
  Handle a(H5Aopen(where, name, H5P_DEFAULT), H5Aclose, file, "not a series of Whirl:");
  Handle space(H5Aget_space(a), H5Sclose, file, "cannot read");
  std::vector<char*> p(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (H5Aread(a, type, p.data()) < 0) io_failure(file, "cannot read");
  std::vector<std::string> out(p.begin(), p.end());
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, p.data());
  return out;
}

using State = std::array<std::uint64_t, 3>;  // rows valid in data, first row of tail, rows in tail

struct Opened {
  Handle file, tail, state;
  std::vector<Group> groups;  // in the order of the attribute "order"
  hsize_t width = 0, chunk = 0;
  State s{};
};

Opened open_series(const fs::path& path, bool writing) {
  Opened o;
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path, "cannot open");
  H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
  hid_t id = -1;
  if (writing) {
    // The mark that a killed writer left: the same properties that the tool h5clear sets.
    const hbool_t clear = 1;
    H5Pset(access, "clear_status_flags", &clear);
    H5Pset(access, "skip_eof_check", &clear);
    // Nor did a killed writer record where the file ends; what it wrote is beyond the recorded end.
    Handle first(H5Fopen(path.c_str(), H5F_ACC_RDWR, access), H5Fclose, path,
                 "cannot open the HDF5 file");
    if (H5Fincrement_filesize(first, 0) < 0) io_failure(path, "cannot repair the HDF5 file");
    first.reset();
    id = H5Fopen(path.c_str(), H5F_ACC_RDWR, access);
  } else {
    id = H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access);
    if (id < 0) id = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  }
  o.file = Handle(id, H5Fclose, path, "cannot open the HDF5 file");
  o.tail = Handle(H5Dopen2(o.file, "tail", H5P_DEFAULT), H5Dclose, path, "not a series of Whirl:");
  o.state =
      Handle(H5Dopen2(o.file, "state", H5P_DEFAULT), H5Dclose, path, "not a series of Whirl:");
  if (H5Dread(o.state, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, o.s.data()) < 0)
    io_failure(path, "cannot read");
  Handle space(H5Dget_space(o.tail), H5Sclose, path, "cannot read");
  hsize_t dims[2] = {0, 0};
  H5Sget_simple_extent_dims(space, dims, nullptr);
  o.chunk = dims[0];
  o.width = dims[1];
  // "order" holds, column by column of the tail, the data set it belongs to.
  const auto order = read_strings(path, o.file, "order");
  if (order.size() != o.width) io_failure(path, "not a series of Whirl:");
  for (hsize_t k = 0; k < o.width; ++k) {
    auto g = std::find_if(o.groups.begin(), o.groups.end(),
                          [&](const Group& x) { return x.name == order[k]; });
    if (g == o.groups.end())
      g = o.groups.insert(o.groups.end(), Group{order[k], {}, {}, {}, {}, {}});
    g->columns.push_back(k);
  }
  for (auto& g : o.groups) {
    g.data = Handle(H5Dopen2(o.file, g.name.c_str(), H5P_DEFAULT), H5Dclose, path,
                    "not a series of Whirl:");
    g.titles = read_strings(path, g.data, "columns");
    g.units = read_strings(path, g.data, "units");
    g.descriptions = read_strings(path, g.data, "descriptions");
    if (g.titles.size() != g.columns.size() || g.units.size() != g.columns.size())
      io_failure(path, "not a series of Whirl:");
  }
  return o;
}

// Rows [first, first + count) of one data set into a row-major table of `width` columns, at row
// `to`.
void read_rows(const fs::path& path, const Group& g, hsize_t first, hsize_t count, hsize_t width,
               hsize_t to, std::vector<double>& table) {
  if (count == 0) return;
  const hsize_t w = g.columns.size();
  std::vector<double> block(count * w);
  Handle fspace(H5Dget_space(g.data), H5Sclose, path, "cannot read");
  const hsize_t start[2] = {first, 0}, size[2] = {count, w};
  H5Sselect_hyperslab(fspace, H5S_SELECT_SET, start, nullptr, size, nullptr);
  Handle mspace(H5Screate_simple(2, size, nullptr), H5Sclose, path, "cannot read");
  if (H5Dread(g.data, H5T_NATIVE_DOUBLE, mspace, fspace, H5P_DEFAULT, block.data()) < 0)
    io_failure(path, "cannot read");
  for (hsize_t i = 0; i < count; ++i)
    for (hsize_t k = 0; k < w; ++k)
      table[(to + i) * width + g.columns[k]] = block[i * w + k];
}

// Rows of the tail from `first` (row number of the series) on.
std::vector<double> read_tail(const fs::path& path, const Opened& o, std::uint64_t first) {
  if (o.s[1] + o.s[2] <= first) return {};
  std::vector<double> all(o.chunk * o.width);
  if (H5Dread(o.tail, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()) < 0)
    io_failure(path, "cannot read");
  const auto from = (first > o.s[1] ? first - o.s[1] : 0) * o.width;
  return {all.begin() + static_cast<std::ptrdiff_t>(from),
          all.begin() + static_cast<std::ptrdiff_t>(o.s[2] * o.width)};
}

class Hdf5Series final : public TimeSeries {
 public:
  Hdf5Series(fs::path file, SeriesOptions options) : path_(std::move(file)), options_(options) {}
  ~Hdf5Series() override {
    try {
      close();
    } catch (...) {  // nobody to tell
    }
  }

  void begin(std::span<const Channel> channels) override {
    close();
    const std::lock_guard lock(library());
    prepare(channels);
    base_ = used_ = flushed_ = 0;
    // Long chunks compress better; the tail that goes with them must stay small.
    chunk_ = std::clamp<hsize_t>((hsize_t{1} << 16) / width_, 128, 4096);
    buffer_.assign(chunk_ * width_, 0.0);
    std::error_code ec;
    if (path_.has_parent_path()) fs::create_directories(path_.parent_path(), ec);
    const fs::path tmp = temporary_beside(path_);
    try {
      make_file(tmp, channels);
    } catch (...) {
      release();
      fs::remove(tmp, ec);
      throw;
    }
    rename_into_place(tmp, path_);
  }

  void resume(std::span<const Channel> channels, std::uint64_t rows) override {
    close();
    const std::lock_guard lock(library());
    prepare(channels);
    Opened o = open_series(path_, true);
    bool same = o.width == width_ && o.groups.size() == groups_.size();
    for (std::size_t k = 0; same && k < groups_.size(); ++k)
      same = o.groups[k].name == groups_[k].name && o.groups[k].titles == groups_[k].titles &&
             o.groups[k].units == groups_[k].units && o.groups[k].columns == groups_[k].columns;
    if (!same) io_failure(path_, "the columns asked for are not those of");
    const std::uint64_t held = std::max(o.s[0], o.s[1] + o.s[2]);
    if (held < rows) io_failure(path_, "fewer rows than the checkpoint knows in");
    chunk_ = o.chunk;
    buffer_.assign(chunk_ * width_, 0.0);
    base_ = rows / chunk_ * chunk_;
    used_ = rows - base_;
    // What remains of the rows after the last full chunk goes into the tail before the data sets
    // are cut.
    const std::uint64_t in_data = std::min<std::uint64_t>(rows, o.s[0]);
    if (in_data < base_) io_failure(path_, "rows are missing in");
    for (const auto& g : o.groups)
      read_rows(path_, g, base_, in_data - base_, width_, 0, buffer_);
    const auto tail = read_tail(path_, o, in_data);
    const std::size_t from = (in_data - base_) * width_;
    std::copy_n(tail.begin(), std::min<std::size_t>(tail.size(), used_ * width_ - from),
                buffer_.begin() + static_cast<std::ptrdiff_t>(from));
    groups_ = std::move(o.groups);
    file_ = std::move(o.file);
    tail_ = std::move(o.tail);
    state_ = std::move(o.state);
    make_spaces();
    flushed_ = 0;
    write_tail();
    if (H5Fflush(file_, H5F_SCOPE_LOCAL) < 0) io_failure(path_, "cannot write");
    for (auto& g : groups_)
      extend(g, base_);
    if (H5Fflush(file_, H5F_SCOPE_LOCAL) < 0 || H5Fstart_swmr_write(file_) < 0)
      io_failure(path_, "cannot continue");
  }

  void append(std::span<const double> row) override {
    if (row.size() != width_ || !file_.open())
      throw std::logic_error("TimeSeries: row of the wrong length, or not begun");
    double* p = buffer_.data() + used_ * width_;
    for (std::size_t k = 0; k < width_; ++k)
      p[k] = scale_[k] == 1.0 ? row[k] : scale_[k] * row[k];
    if (++used_ == chunk_) {
      const std::lock_guard lock(library());
      write_data();
    }
    if (Clock::now() - last_flush_ > flush_every_) hand_over();
  }

  void flush() override {
    hand_over();
    sync();
  }

  void close() override {
    const std::lock_guard lock(library());
    if (!file_.open()) return;
    if (used_ > 0) write_data();
    const State s{base_, base_, 0};
    const bool ok =
        H5Dwrite(state_, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, s.data()) >= 0 &&
        H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0;
    if (ok) sync();
    release();
    if (!ok) io_failure(path_, "cannot write");
  }

  std::uint64_t rows() const override { return base_ + used_; }

 private:
  /// To the kernel: other programs see it, a power cut may lose it.
  void hand_over() {
    const std::lock_guard lock(library());
    last_flush_ = Clock::now();
    if (!file_.open()) return;
    for (auto& g : groups_)
      if (H5Dflush(g.data) < 0) io_failure(path_, "cannot write");
    write_tail();
    if (H5Dflush(tail_) < 0 || H5Dflush(state_) < 0) io_failure(path_, "cannot write");
  }
  /// To the disk: what a checkpoint counts on.
  void sync() {
    void* descriptor = nullptr;
    if (!file_.open() || H5Fget_vfd_handle(file_, H5P_DEFAULT, &descriptor) < 0) return;
    const int fd = *static_cast<const int*>(descriptor);
    if (::fdatasync(fd) != 0 && errno != EINVAL && errno != EROFS)
      io_failure(path_, "cannot write", errno);
  }

  void prepare(std::span<const Channel> channels) {
    prepare_library();
    scale_.clear();
    for (const auto& c : channels)
      scale_.insert(scale_.end(), c.width(), c.scale);
    width_ = scale_.size();
    if (width_ == 0) throw std::logic_error("TimeSeries: no channels");
    groups_ = groups_of(channels);
    for (const auto& g : groups_)
      if (g.name == "tail" || g.name == "state" || g.name.find('/') != std::string::npos)
        throw std::logic_error("TimeSeries: '" + g.name + "' cannot name a group");
    flush_every_ = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(options_.flush_seconds));
    last_flush_ = Clock::now();
  }

  void release() {
    memory_.reset();
    groups_.clear();
    tail_.reset();
    state_.reset();
    file_.reset();
  }

  Handle make_dataset(const char* name, hid_t type, std::array<hsize_t, 2> dims,
                      std::array<hsize_t, 2> most, std::array<hsize_t, 2> chunk, bool compress) {
    Handle space(H5Screate_simple(2, dims.data(), most.data()), H5Sclose, path_, "cannot write");
    Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, path_, "cannot write");
    H5Pset_chunk(how, 2, chunk.data());
    const double missing = std::numeric_limits<double>::quiet_NaN();
    const std::uint64_t zero = 0;
    if (type == H5T_IEEE_F64LE)
      H5Pset_fill_value(how, H5T_NATIVE_DOUBLE, &missing);
    else
      H5Pset_fill_value(how, H5T_NATIVE_UINT64, &zero);
    if (compress) {
      H5Pset_shuffle(how);
      H5Pset_deflate(how, 4);
    }
    return Handle(H5Dcreate2(file_, name, type, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose,
                  path_, "cannot write");
  }

  void make_file(const fs::path& at, std::span<const Channel> channels) {
    Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, path_, "cannot write");
    H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    file_ = Handle(H5Fcreate(at.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, path_,
                   "cannot write");
    write_strings(path_, file_, "layout", {layout_text});
    std::vector<std::string> order;
    for (const auto& c : channels)
      order.insert(order.end(), c.width(), c.group.empty() ? "series" : c.group);
    write_strings(path_, file_, "order", order);
    for (auto& g : groups_) {
      const hsize_t w = g.columns.size();
      g.data = make_dataset(g.name.c_str(), H5T_IEEE_F64LE, {0, w}, {H5S_UNLIMITED, w}, {chunk_, 1},
                            true);
      write_strings(path_, g.data, "columns", g.titles);
      write_strings(path_, g.data, "units", g.units);
      write_strings(path_, g.data, "descriptions", g.descriptions);
    }
    tail_ = make_dataset("tail", H5T_IEEE_F64LE, {chunk_, width_}, {chunk_, width_},
                         {std::min<hsize_t>(chunk_, 64), width_}, false);
    state_ = make_dataset("state", H5T_STD_U64LE, {1, 3}, {1, 3}, {1, 3}, false);
    const State none{};
    if (H5Dwrite(state_, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, none.data()) < 0)
      io_failure(path_, "cannot write");
    make_spaces();
    if (H5Fstart_swmr_write(file_) < 0) io_failure(path_, "cannot write");
  }

  void make_spaces() {
    const hsize_t dims[2] = {chunk_, width_};
    memory_ = Handle(H5Screate_simple(2, dims, nullptr), H5Sclose, path_, "cannot write");
  }

  void extend(Group& g, hsize_t rows) {
    const hsize_t dims[2] = {rows, g.columns.size()};
    if (H5Dset_extent(g.data, dims) < 0) io_failure(path_, "cannot write");
  }

  // The waiting rows into the data sets.
  void write_data() {
    for (auto& g : groups_) {
      extend(g, base_ + used_);
      Handle fspace(H5Dget_space(g.data), H5Sclose, path_, "cannot write");
      const hsize_t w = g.columns.size();
      const hsize_t start[2] = {base_, 0}, size[2] = {used_, w};
      H5Sselect_hyperslab(fspace, H5S_SELECT_SET, start, nullptr, size, nullptr);
      block_.resize(used_ * w);
      for (hsize_t i = 0; i < used_; ++i)
        for (hsize_t k = 0; k < w; ++k)
          block_[i * w + k] = buffer_[i * width_ + g.columns[k]];
      Handle mspace(H5Screate_simple(2, size, nullptr), H5Sclose, path_, "cannot write");
      if (H5Dwrite(g.data, H5T_NATIVE_DOUBLE, mspace, fspace, H5P_DEFAULT, block_.data()) < 0)
        io_failure(path_, "cannot write");
    }
    base_ += used_;
    used_ = flushed_ = 0;
  }

  // The waiting rows into the tail, and then what counts.
  void write_tail() {
    if (used_ > flushed_) {
      Handle fspace(H5Dget_space(tail_), H5Sclose, path_, "cannot write");
      const hsize_t start[2] = {flushed_, 0}, size[2] = {used_ - flushed_, width_};
      H5Sselect_hyperslab(fspace, H5S_SELECT_SET, start, nullptr, size, nullptr);
      H5Sselect_hyperslab(memory_, H5S_SELECT_SET, start, nullptr, size, nullptr);
      if (H5Dwrite(tail_, H5T_NATIVE_DOUBLE, memory_, fspace, H5P_DEFAULT, buffer_.data()) < 0 ||
          H5Dflush(tail_) < 0)
        io_failure(path_, "cannot write");
      flushed_ = used_;
    }
    const State s{base_, base_, used_};
    if (H5Dwrite(state_, H5T_NATIVE_UINT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, s.data()) < 0)
      io_failure(path_, "cannot write");
  }

  fs::path path_;
  SeriesOptions options_;
  std::vector<double> scale_, buffer_, block_;
  std::vector<Group> groups_;
  Handle file_, tail_, state_, memory_;
  hsize_t width_ = 0, chunk_ = 0;
  std::uint64_t base_ = 0;     // rows in the data sets
  std::uint64_t used_ = 0;     // rows waiting in buffer_
  std::uint64_t flushed_ = 0;  // of those, rows already in the tail
  Clock::time_point last_flush_;
  Clock::duration flush_every_{};
};

void read(const fs::path& path, Columns& out) {
  const std::lock_guard lock(library());
  prepare_library();
  const Opened o = open_series(path, false);
  const auto tail = read_tail(path, o, o.s[0]);
  const std::size_t rows = o.s[0] + tail.size() / o.width;
  std::vector<double> all(rows * o.width);
  for (const auto& g : o.groups)
    read_rows(path, g, 0, o.s[0], o.width, 0, all);
  std::copy(tail.begin(), tail.end(), all.begin() + static_cast<std::ptrdiff_t>(o.s[0] * o.width));
  out.names.resize(o.width);
  out.units.resize(o.width);
  out.values.assign(o.width, std::vector<double>(rows));
  for (const auto& g : o.groups)
    for (std::size_t k = 0; k < g.columns.size(); ++k) {
      const auto c = g.columns[k];
      out.names[c] = g.titles[k];
      out.units[c] = g.units[k];
      for (std::size_t i = 0; i < rows; ++i)
        out.values[c][i] = all[i * o.width + c];
    }
}

void write_words(const fs::path& file, hid_t group, const WordColumn& column) {
  std::string name = column.name;
  for (std::size_t at = name.find('/'); at != std::string::npos; at = name.find('/', at))
    name.replace(at, 1, "\u2044");
  const hsize_t rows = column.cells.size();
  const Handle type = string_type();
  const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose, file, "cannot write");
  const Handle data(
      H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
      file, "cannot write");
  std::vector<const char*> cells;
  for (const std::string& cell : column.cells)
    cells.push_back(cell.c_str());
  if (rows > 0 && H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, cells.data()) < 0)
    io_failure(file, "cannot write");
  write_strings(file, data, "description", {column.description});
}

void add_words(const fs::path& path, const std::vector<WordColumn>& columns) {
  const std::lock_guard lock(library());
  prepare_library();
  Opened o = open_series(path, true);
  Handle group(H5Gcreate2(o.file, "words", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path,
               "cannot write");
  for (const WordColumn& column : columns)
    write_words(path, group, column);
  if (H5Fflush(o.file, H5F_SCOPE_GLOBAL) < 0) io_failure(path, "cannot write");
}

}  // namespace
}  // namespace whirl::io

WHIRL_DEFINE_PLUGIN

WHIRL_PLUGIN_EXPORT whirl::io::TimeSeries* whirl_hdf5_make_series(
    const std::filesystem::path& file, const whirl::io::SeriesOptions& options) {
  return new whirl::io::Hdf5Series(file, options);
}

WHIRL_PLUGIN_EXPORT void whirl_hdf5_read(const std::filesystem::path& file,
                                         whirl::io::Columns& out) {
  whirl::io::read(file, out);
}

WHIRL_PLUGIN_EXPORT void whirl_hdf5_add_words(const std::filesystem::path& file,
                                              const std::vector<whirl::io::WordColumn>& columns) {
  whirl::io::add_words(file, columns);
}
