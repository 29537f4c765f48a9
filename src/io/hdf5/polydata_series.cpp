// Frames in one file: VTKHDF 2.0, type PolyData with steps
// (https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/). Points and point data of all
// frames stand one after the other; cells once for as long as they stay the same, as a part that the
// steps refer to. The file is whole after every frame: what was appended counts when NSteps says so.
//
// A '/' in the name of an array would be a path in HDF5: "[m/s]" is written "[m per s]".
#include <core/plugin.hpp>
#include <io/hdf5/entry.hpp>
#include <io/hdf5/handle.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace whirl::io {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 4> kinds{"Vertices", "Lines", "Polygons", "Strips"};
using Four = std::array<std::int64_t, kinds.size()>;

std::string array_name(std::string name) {
  for (std::size_t p = name.find('/'); p != std::string::npos; p = name.find('/'))
    name.replace(p, 1, " per ");
  return name;
}

/// A data set that grows by rows.
class Rows {
 public:
  Rows(const fs::path& file, hid_t where, const std::string& name, hid_t type, hsize_t columns,
       hsize_t chunk, bool packed)
      : file_(file),
        columns_(columns) {
    const hsize_t none[2] = {0, columns}, most[2] = {H5S_UNLIMITED, columns},
                  piece[2] = {std::max<hsize_t>(chunk, 1), columns};
    const Handle space(H5Screate_simple(rank(), none, most), H5Sclose, file_, "cannot write");
    const Handle how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, file_, "cannot write");
    H5Pset_chunk(how, rank(), piece);
    if (packed) {
      H5Pset_shuffle(how);
      H5Pset_deflate(how, 1);
    }
    const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, file_, "cannot write");
    H5Pset_char_encoding(links, H5T_CSET_UTF8);
    data_ = Handle(H5Dcreate2(where, name.c_str(), type, space, links, how, H5P_DEFAULT), H5Dclose,
                   file_, "cannot write");
  }
  /// One that is there.
  Rows(const fs::path& file, hid_t where, const std::string& name, hsize_t columns)
      : file_(file),
        columns_(columns),
        data_(H5Dopen2(where, name.c_str(), H5P_DEFAULT), H5Dclose, file, "no frames of Whirl:") {
    const Handle space(H5Dget_space(data_), H5Sclose, file_, "cannot read");
    hsize_t size[2] = {0, 0};
    H5Sget_simple_extent_dims(space, size, nullptr);
    rows_ = size[0];
  }
  hsize_t rows() const { return rows_; }
  /// To so many rows.
  void resize(hsize_t rows) {
    const hsize_t size[2] = {rows, columns_};
    if (H5Dset_extent(data_, size) < 0) io_failure(file_, "cannot write");
    rows_ = rows;
  }
  void append(hid_t type, const void* values, hsize_t count) { put(rows_, type, values, count); }
  /// count rows from `first` on; the data set ends with them or later.
  void put(hsize_t first, hid_t type, const void* values, hsize_t count) {
    if (first + count > rows_) resize(first + count);
    if (count == 0) return;
    const hsize_t start[2] = {first, 0}, size[2] = {count, columns_};
    const Handle space(H5Dget_space(data_), H5Sclose, file_, "cannot write");
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, size, nullptr);
    const Handle memory(H5Screate_simple(rank(), size, nullptr), H5Sclose, file_, "cannot write");
    if (H5Dwrite(data_, type, memory, space, H5P_DEFAULT, values) < 0)
      io_failure(file_, "cannot write");
  }

 private:
  int rank() const { return columns_ > 1 ? 2 : 1; }
  fs::path file_;
  hsize_t columns_, rows_ = 0;
  Handle data_;
};

Handle group_of(const fs::path& file, hid_t where, const std::string& name, bool there) {
  if (there)
    return {H5Gopen2(where, name.c_str(), H5P_DEFAULT), H5Gclose, file, "no frames of Whirl:"};
  return {H5Gcreate2(where, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, file,
          "cannot write"};
}

void set_attribute(const fs::path& file, hid_t where, const char* name,
                   const std::vector<std::int64_t>& values, bool there = false) {
  const hsize_t n = values.size();
  const Handle space(n == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, nullptr), H5Sclose,
                     file, "cannot write");
  const Handle a(there ? H5Aopen(where, name, H5P_DEFAULT)
                       : H5Acreate2(where, name, H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                 H5Aclose, file, "cannot write");
  if (H5Awrite(a, H5T_NATIVE_INT64, values.data()) < 0) io_failure(file, "cannot write");
}

/// A string of fixed length, as VTK's reader asks for.
void set_type(const fs::path& file, hid_t where, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, file, "cannot write");
  H5Tset_size(type, text.size());
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, file, "cannot write");
  const Handle a(H5Acreate2(where, "Type", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, file,
                 "cannot write");
  if (H5Awrite(a, type, text.data()) < 0) io_failure(file, "cannot write");
}

bool holds_frames(const fs::path& path) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return false;
  const bool holds = H5Lexists(file, "VTKHDF", H5P_DEFAULT) > 0;
  H5Fclose(file);
  return holds;
}

/// What a step of the file refers to.
struct Step {
  double time = 0;
  std::int64_t part = 0, points = 0, cell_data = 0;
  Four cells{}, ids{};
};

class Series final : public PolyDataSeries {
 public:
  Series(const fs::path& path, bool packed, InArchive* earlier) : path_(path), packed_(packed) {
    const std::lock_guard lock(library());
    prepare_library();
    if (earlier)
      reopen(*earlier);
    else
      create();
  }
  ~Series() override {
    const std::lock_guard lock(library());  // what it holds is closed in order
    arrays_.clear();
    cell_arrays_.clear();
    steps_.reset();
    rows_.clear();
    root_.reset();
    file_.reset();
  }
  void append(const PolyData& data, double time) override {
    const std::lock_guard lock(library());
    prepare_library();
    if (rows_.empty()) make_data_sets(data);
    if (topology_ != data.topology) {
      add_part(data);
      topology_ = data.topology;
    }
    Step s = part_;
    s.time = time;
    s.points = static_cast<std::int64_t>(row("Points").rows());
    const hsize_t points = data.points.size() / 3;
    row("Points").append(H5T_NATIVE_FLOAT, data.points.data(), points);
    for (std::size_t k = 0; k < data.point_data.size(); ++k)
      put(arrays_[k], data.point_data[k], points);
    taken_.push_back(s);
    write_steps(taken_.size() - 1);
  }
  void thin() override {
    const std::lock_guard lock(library());
    prepare_library();
    for (std::size_t k = 1; 2 * k < taken_.size(); ++k)
      taken_[k] = taken_[2 * k];
    taken_.resize((taken_.size() + 1) / 2);
    write_steps(0);
  }
  std::size_t size() const override { return taken_.size(); }
  void save(OutArchive& out) const override {
    out.put_count(taken_.size());
    for (const Step& s : taken_) {
      out.put(s.time);
      for (const std::int64_t x : {s.part, s.points, s.cell_data})
        out.put_count(static_cast<std::uint64_t>(x));
      for (std::size_t k = 0; k < kinds.size(); ++k) {
        out.put_count(static_cast<std::uint64_t>(s.cells[k]));
        out.put_count(static_cast<std::uint64_t>(s.ids[k]));
      }
    }
    out.put_count(names_.size());
    out.put_count(texts_.size());
    for (const auto& [name, columns] : names_) {
      out.put(name);
      out.put_count(columns);
    }
    for (const auto& [name, size] : texts_) {
      out.put(name);
      out.put_count(static_cast<std::uint64_t>(size));
    }
  }

 private:
  void create();
  void reopen(InArchive& earlier);
  void make_data_sets(const PolyData& data);
  void open_data_sets();
  void add_names(const PolyData& data);
  void add_part(const PolyData& data);
  void write_steps(std::size_t from);
  Rows& row(const std::string& name) { return *rows_.at(name); }
  void make(const std::string& name, hid_t type, hsize_t columns, hsize_t chunk, bool packed) {
    rows_[name] = std::make_unique<Rows>(path_, root_, name, type, columns, chunk, packed);
    names_.emplace_back(name, columns);
  }
  void put(const std::string& name, const PolyData::Array& a, hsize_t rows) {
    if (const auto* floats = std::get_if<std::vector<float>>(&a.values))
      row(name).append(H5T_NATIVE_FLOAT, floats->data(), rows);
    else
      row(name).append(H5T_NATIVE_INT32, std::get<std::vector<std::int32_t>>(a.values).data(),
                       rows);
  }

  fs::path path_;
  bool packed_;
  Handle file_, root_, steps_;
  std::map<std::string, std::unique_ptr<Rows>> rows_;         ///< by path below the root
  std::vector<std::pair<std::string, std::uint64_t>> names_;  ///< of these, and their columns
  std::map<std::string, std::int64_t> texts_;                 ///< of field data: how many
  std::vector<std::string> arrays_, cell_arrays_;  ///< paths of the arrays, in their order
  std::vector<Step> taken_;
  Step part_;  ///< where the cells of the frames stand
  std::optional<std::uint64_t> topology_;
};

void Series::create() {
  std::error_code ec;
  if (fs::is_symlink(fs::symlink_status(path_, ec)))
    io_failure(path_, "nothing is written through a symbolic link:");
  if (fs::exists(path_, ec) && !holds_frames(path_))
    io_failure(path_, "no frames of an earlier run:");
  file_ = Handle(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, path_,
                 "cannot make the file");
  root_ = group_of(path_, file_, "VTKHDF", false);
  set_attribute(path_, root_, "Version", {2, 0});
  set_type(path_, root_, "PolyData");
  steps_ = group_of(path_, root_, "Steps", false);
  set_attribute(path_, steps_, "NSteps", {0});
}

void Series::reopen(InArchive& in) {
  taken_.resize(in.count());
  for (Step& s : taken_) {
    s.time = in.number();
    for (std::int64_t* x : {&s.part, &s.points, &s.cell_data})
      *x = static_cast<std::int64_t>(in.count());
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      s.cells[k] = static_cast<std::int64_t>(in.count());
      s.ids[k] = static_cast<std::int64_t>(in.count());
    }
  }
  names_.resize(in.count());
  const std::uint64_t texts = in.count();
  for (auto& [name, columns] : names_) {
    name = in.text();
    columns = in.count();
  }
  for (std::uint64_t k = 0; k < texts; ++k) {
    const std::string name = in.text();
    texts_[name] = static_cast<std::int64_t>(in.count());
  }
  if (taken_.empty()) {
    names_.clear();
    texts_.clear();
    return create();
  }
  file_ = Handle(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose, path_,
                 "cannot go on with the frames of the earlier run");
  root_ = group_of(path_, file_, "VTKHDF", true);
  steps_ = group_of(path_, root_, "Steps", true);
  for (const auto& [name, columns] : names_)
    rows_[name] = std::make_unique<Rows>(path_, root_, name, columns);
  write_steps(0);  // without those beyond the checkpoint
}

void Series::make_data_sets(const PolyData& data) {
  constexpr hsize_t few = 256;
  // a chunk a frame; frames that grow share theirs, which are then written again and again: not packed
  const bool grows = data.topology > 0, packed = packed_ && !grows;
  const hsize_t points = grows ? 4096 : data.points.size() / 3;
  const auto type_of = [](const PolyData::Array& a) {
    return a.values.index() == 0 ? H5T_IEEE_F32LE : H5T_STD_I32LE;
  };
  for (const char* group :
       {"PointData", "CellData", "Steps/PointDataOffsets", "Steps/CellDataOffsets"})
    group_of(path_, root_, group, false);
  make("NumberOfPoints", H5T_STD_I64LE, 1, few, false);
  make("Points", H5T_IEEE_F32LE, 3, points, packed);
  for (const char* kind : kinds) {
    const std::string k = kind;
    group_of(path_, root_, k, false);
    for (const char* what : {"/NumberOfCells", "/NumberOfConnectivityIds"})
      make(k + what, H5T_STD_I64LE, 1, few, false);
    for (const char* what : {"/Offsets", "/Connectivity"})
      make(k + what, H5T_STD_I64LE, 1, 4096, packed);
  }
  make("Steps/Values", H5T_IEEE_F64LE, 1, few, false);
  for (const char* what : {"Steps/PartOffsets", "Steps/NumberOfParts", "Steps/PointOffsets"})
    make(what, H5T_STD_I64LE, 1, few, false);
  for (const char* what : {"Steps/CellOffsets", "Steps/ConnectivityIdOffsets"})
    make(what, H5T_STD_I64LE, kinds.size(), few, false);
  for (const PolyData::Array& a : data.point_data) {
    const std::string name = array_name(a.name);
    make("PointData/" + name, type_of(a), static_cast<hsize_t>(a.components), points, packed);
    make("Steps/PointDataOffsets/" + name, H5T_STD_I64LE, 1, few, false);
  }
  for (const PolyData::Array& a : data.cell_data) {
    const std::string name = array_name(a.name);
    make("CellData/" + name, type_of(a), static_cast<hsize_t>(a.components), 4096, packed);
    make("Steps/CellDataOffsets/" + name, H5T_STD_I64LE, 1, few, false);
  }
  add_names(data);
}

/// What cell arrays number, as field data: the same at every step.
void Series::add_names(const PolyData& data) {
  if (data.names.empty()) return;
  const Handle group = group_of(path_, root_, "FieldData", false),
               offsets = group_of(path_, steps_, "FieldDataOffsets", false),
               sizes = group_of(path_, steps_, "FieldDataSizes", false);
  for (const PolyData::Names& n : data.names) {
    const hsize_t count = n.values.size();
    const Handle type = string_type();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, path_, "cannot write");
    const Handle d(
        H5Dcreate2(group, n.name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, path_, "cannot write");
    std::vector<const char*> texts;
    for (const std::string& v : n.values)
      texts.push_back(v.c_str());
    if (H5Dwrite(d, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()) < 0)
      io_failure(path_, "cannot write");
    make("Steps/FieldDataOffsets/" + n.name, H5T_STD_I64LE, 1, 256, false);
    make("Steps/FieldDataSizes/" + n.name, H5T_STD_I64LE, 2, 256, false);
    texts_["Steps/FieldDataSizes/" + n.name] = static_cast<std::int64_t>(count);
  }
}

/// Cells and cell data as they now are, until they change.
void Series::add_part(const PolyData& data) {
  const std::array<const PolyData::Cells*, kinds.size()> cells{&data.vertices, &data.lines,
                                                               &data.polygons, nullptr};
  const PolyData::Cells none;
  part_.part = static_cast<std::int64_t>(row("NumberOfPoints").rows());
  const auto one = [&](const std::string& name, std::size_t value) {
    const auto x = static_cast<std::int64_t>(value);
    row(name).append(H5T_NATIVE_INT64, &x, 1);
  };
  one("NumberOfPoints", data.points.size() / 3);
  std::size_t all = 0;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const PolyData::Cells& c = cells[k] ? *cells[k] : none;
    const std::string kind = kinds[k];
    // each part has a start more than cells
    part_.cells[k] = static_cast<std::int64_t>(row(kind + "/Offsets").rows()) - part_.part;
    part_.ids[k] = static_cast<std::int64_t>(row(kind + "/Connectivity").rows());
    one(kind + "/NumberOfCells", c.size());
    one(kind + "/NumberOfConnectivityIds", c.point.size());
    row(kind + "/Offsets").append(H5T_NATIVE_INT64, c.offset.data(), c.offset.size());
    row(kind + "/Connectivity").append(H5T_NATIVE_INT64, c.point.data(), c.point.size());
    all += c.size();
  }
  cell_arrays_.clear();
  arrays_.clear();
  for (const PolyData::Array& a : data.point_data)
    arrays_.push_back("PointData/" + array_name(a.name));
  for (const PolyData::Array& a : data.cell_data) {
    cell_arrays_.push_back("CellData/" + array_name(a.name));
    part_.cell_data = static_cast<std::int64_t>(row(cell_arrays_.back()).rows());
    put(cell_arrays_.back(), a, all);
  }
}

/// The tables of the steps, from one on; then the file counts them.
void Series::write_steps(std::size_t from) {
  const auto each = [&](const std::string& name, hid_t type, auto value) {
    using T = decltype(value(Step{}));
    std::vector<T> values;
    for (std::size_t k = from; k < taken_.size(); ++k)
      values.push_back(value(taken_[k]));
    if (taken_.size() < row(name).rows()) row(name).resize(taken_.size());
    row(name).put(from, type, values.data(), values.size());
  };
  const auto integer = [&](const std::string& name, auto value) {
    each(name, H5T_NATIVE_INT64, value);
  };
  each("Steps/Values", H5T_NATIVE_DOUBLE, [](const Step& s) { return s.time; });
  integer("Steps/PartOffsets", [](const Step& s) { return s.part; });
  integer("Steps/NumberOfParts", [](const Step&) { return std::int64_t{1}; });
  integer("Steps/PointOffsets", [](const Step& s) { return s.points; });
  integer("Steps/CellOffsets", [](const Step& s) { return s.cells; });
  integer("Steps/ConnectivityIdOffsets", [](const Step& s) { return s.ids; });
  for (const auto& [name, columns] : names_) {
    if (name.starts_with("Steps/PointDataOffsets/"))
      integer(name, [](const Step& s) { return s.points; });
    else if (name.starts_with("Steps/CellDataOffsets/"))
      integer(name, [](const Step& s) { return s.cell_data; });
    else if (name.starts_with("Steps/FieldDataOffsets/"))
      integer(name, [](const Step&) { return std::int64_t{0}; });
    else if (name.starts_with("Steps/FieldDataSizes/"))
      integer(name, [size = texts_.at(name)](const Step&) {
        return std::array<std::int64_t, 2>{1, size};
      });
  }
  H5Fflush(file_, H5F_SCOPE_GLOBAL);
  set_attribute(path_, steps_, "NSteps", {static_cast<std::int64_t>(taken_.size())}, true);
  if (H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0) io_failure(path_, "cannot write");
}

}  // namespace
}  // namespace whirl::io

WHIRL_PLUGIN_EXPORT whirl::io::PolyDataSeries* whirl_hdf5_make_polydata(
    const std::filesystem::path& file, bool packed, whirl::InArchive* earlier) {
  return new whirl::io::Series(file, packed, earlier);
}
