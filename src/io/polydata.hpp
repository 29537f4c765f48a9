// One picture frame as plain arrays, and the interface of what writes it to a file.
#pragma once
#include <core/archive.hpp>
#include <core/compression.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace whirl::io {

/// Points, and cells given by counts and point indices. Cell data are ordered: vertices, lines,
/// polygons.
struct PolyData {
  struct Cells {
    std::vector<std::int64_t> offset{0};  ///< starts of the cells in `point`, one more than cells
    std::vector<std::int64_t> point;
    std::size_t size() const { return offset.size() - 1; }
    void add(const std::int64_t* p, std::size_t n) {
      point.insert(point.end(), p, p + n);
      offset.push_back(static_cast<std::int64_t>(point.size()));
    }
    void clear() {
      offset.assign(1, 0);
      point.clear();
    }
  };
  struct Array {
    std::string name;
    int components = 1;
    std::variant<std::vector<float>, std::vector<std::int32_t>>
        values;  ///< bytes would be taken for colours
    std::vector<float>& floats() { return std::get<0>(values); }
  };
  /// What the numbers of a cell array stand for.
  struct Names {
    std::string name;
    std::vector<std::string> values;
  };
  std::vector<float> points;  ///< 3 a point
  Cells vertices, lines, polygons;
  std::vector<Array> point_data, cell_data;
  std::string normals;         ///< name of the point array that holds normals; empty: none
  std::vector<Names> names;    ///< as field data; they change with the cells alone
  std::uint64_t topology = 0;  ///< changes when the cells do; 0: they never do
};

/// Writes frames of one set; keeps what does not change between them.
class PolyDataWriter {
 public:
  virtual ~PolyDataWriter() = default;
  /// Whole file or none (temporary and rename); `time` goes into the field data array TimeValue.
  /// @throws Error (Exit::io) when it cannot be written.
  virtual void write(const std::filesystem::path& file, const PolyData& data, double time) = 0;
};

/// All frames of one set in one file.
class PolyDataSeries {
 public:
  virtual ~PolyDataSeries() = default;
  /// The file is whole after it, and can be read while it grows no further.
  /// @throws Error (Exit::io) when it cannot be written.
  virtual void append(const PolyData& data, double time) = 0;
  /// Leaves every other frame, the first one among them.
  virtual void thin() = 0;
  virtual std::size_t size() const = 0;
  virtual void save(OutArchive& out) const = 0;
};

/// Entry point of the VTK plug-in.
using VtkMakeWriter = PolyDataWriter*(Compression);
inline constexpr const char* vtk_make_writer = "whirl_vtk_make_writer";

}  // namespace whirl::io
