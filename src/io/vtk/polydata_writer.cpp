// .vtp by VTK's own XML writer, appended raw data; frames of the same cells after the first one of a
// set by what VTK wrote of that.
#include "frame_template.hpp"

#include <core/plugin.hpp>
#include <io/file.hpp>
#include <io/polydata.hpp>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkErrorCode.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <SMP/Common/vtkSMPToolsAPI.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkTypeInt32Array.h>
#include <vtkXMLPolyDataWriter.h>
#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace whirl::io {
namespace {

// The arrays are lent to VTK, not copied: they live until the file is written. They may be others at
// every frame; the objects of VTK around them stay.
template <class VtkArray, class T>
void lend(const std::vector<T>& v, vtkDataArray& to) {
  static_cast<VtkArray&>(to).SetArray(const_cast<T*>(v.data()), static_cast<vtkIdType>(v.size()),
                                      1);
  to.Modified();  // or the range in the file stays that of the first frame
}

void lend(const PolyData::Array& a, vtkDataArray& to) {
  if (const auto* floats = std::get_if<std::vector<float>>(&a.values))
    lend<vtkFloatArray>(*floats, to);
  else
    lend<vtkIntArray>(std::get<std::vector<std::int32_t>>(a.values), to);
}

vtkSmartPointer<vtkDataArray> array_for(const PolyData::Array& a) {
  vtkSmartPointer<vtkDataArray> made;
  if (std::holds_alternative<std::vector<float>>(a.values))
    made = vtkSmartPointer<vtkFloatArray>::New();
  else
    made = vtkSmartPointer<vtkIntArray>::New();
  made->SetName(a.name.c_str());
  made->SetNumberOfComponents(a.components);
  return made;
}

/// Whether the arrays of a frame are those that `made` was made for.
bool fit(const std::vector<PolyData::Array>& arrays,
         const std::vector<vtkSmartPointer<vtkDataArray>>& made) {
  return std::equal(arrays.begin(), arrays.end(), made.begin(), made.end(),
                    [](const PolyData::Array& a, const vtkSmartPointer<vtkDataArray>& m) {
                      return a.name == m->GetName() && a.components == m->GetNumberOfComponents();
                    });
}

vtkSmartPointer<vtkCellArray> copy(const PolyData::Cells& c) {
  vtkNew<vtkTypeInt32Array> offsets, points;
  offsets->SetNumberOfValues(static_cast<vtkIdType>(c.offset.size()));
  points->SetNumberOfValues(static_cast<vtkIdType>(c.point.size()));
  std::copy(c.offset.begin(), c.offset.end(), offsets->GetPointer(0));
  std::copy(c.point.begin(), c.point.end(), points->GetPointer(0));
  auto cells = vtkSmartPointer<vtkCellArray>::New();
  cells->SetData(offsets, points);
  return cells;
}

vtkSmartPointer<vtkStringArray> copy(const PolyData::Names& n) {
  auto a = vtkSmartPointer<vtkStringArray>::New();
  a->SetName(n.name.c_str());
  for (const std::string& value : n.values)
    a->InsertNextValue(value);
  return a;
}

/// The same file with white space where readers of VTK want it. They look for the appended data in
/// blocks of 4096 bytes and hand the tag that opens them to expat in pieces; expat 2.6, and older
/// ones with the cure of CVE-2023-52425, look at a tag in pieces only when there is twice as much of
/// it (https://gitlab.kitware.com/vtk/vtk/-/issues/19258). ParaView 5.12.0, and 5.11 of Debian 12,
/// then take the data for XML. Where a block ends within the tag the rest comes byte by byte, and the
/// tag is whole when it is twice as long.
std::string readable_everywhere(std::string file) {
  constexpr std::string_view tag = "<AppendedData encoding=\"raw\"", end_of_tag = "/>";
  constexpr std::size_t block = 4096;
  const std::size_t place = file.find(tag);
  if (place == std::string::npos) return file;
  const std::size_t tag_ends = place + tag.size();
  const std::size_t before = (block - tag_ends % block) % block;
  file.insert(tag_ends, tag.size() - end_of_tag.size(), ' ');
  file.insert(place, before, ' ');
  return file;
}

/// Once in a process: another writer may be at work on a thread of its own.
void set_up_library() {
  vtkObject::GlobalWarningDisplayOff();  // failures come back as an error code
  // threads for arrays of a few thousand numbers cost more than the numbers
  // (and the backend of std::thread, which asks the system for the number of processors in every
  // look at an array even while it does not work, is told once)
  auto& smp = vtk::detail::smp::vtkSMPToolsAPI::GetInstance();
  smp.SetBackend("STDThread");
  smp.Initialize(1);
  smp.SetBackend("Sequential");
}

class Writer final : public PolyDataWriter {
 public:
  explicit Writer(Compression compression) {
    static std::once_flag done;
    std::call_once(done, set_up_library);
    writer_->SetDataModeToAppended();
    writer_->EncodeAppendedDataOff();
    writer_->WriteToOutputStringOn();  // into a file it writes and seeks some 260 times
    set_compression(compression);
    time_->SetName("TimeValue");
    time_->SetNumberOfValues(1);
    points_->SetData(vtkSmartPointer<vtkFloatArray>::New());
    points_->GetData()->SetNumberOfComponents(3);
    points_->GetData()->SetName("Points");
    writer_->SetInputData(poly_);
  }

  void write(const std::filesystem::path& file, const PolyData& data, double time) override {
    if (const std::string* known = of_template(data, time)) return put(file, *known);
    template_.reset();
    if (topology_ != data.topology) take_cells(data);
    if (!fit(data.point_data, point_arrays_) || !fit(data.cell_data, cell_arrays_))
      make_arrays(data);
    lend<vtkFloatArray>(data.points, *points_->GetData());
    points_->Modified();
    for (std::size_t k = 0; k < point_arrays_.size(); ++k)
      lend(data.point_data[k], *point_arrays_[k]);
    for (std::size_t k = 0; k < cell_arrays_.size(); ++k)
      lend(data.cell_data[k],
           *cell_arrays_[k]);  // a range that is known takes another form in the file
    time_->SetValue(0, time);
    time_->Modified();
    poly_->Modified();
    const bool ok = writer_->Write() == 1 && writer_->GetErrorCode() == vtkErrorCode::NoError;
    const auto code = writer_->GetErrorCode();
    if (!ok)
      io_failure(file, std::string("VTK cannot write (") +
                           vtkErrorCode::GetStringFromErrorCode(code) + ")");
    const std::string text = readable_everywhere(writer_->GetOutputString());
    put(file, text);
    if (data.topology == 0)  // else every frame has cells of its own
      template_.emplace(text, data, writer_->GetCompressor(), writer_->GetBlockSize());
  }

 private:
  static void put(const std::filesystem::path& file, const std::string& text) {
    AppendFile out(0);  // of a name of its own until it is whole
    out.create(file, text);
    out.close();
  }
  /// Null: VTK writes this one.
  const std::string* of_template(const PolyData& data, double time) {
    const bool known = template_ && topology_ == data.topology && template_->fits(data);
    return known ? template_->fill(data, time) : nullptr;
  }
  void set_compression(Compression compression) {
    switch (compression) {
      case Compression::none: writer_->SetCompressorTypeToNone(); break;
      case Compression::lz4: writer_->SetCompressorTypeToLZ4(); break;
      case Compression::zlib:
        writer_->SetCompressorTypeToZLib();
        writer_->SetCompressionLevel(
            1);  // of frames 5 and 9 take 1.6 and 3.8 times the time for 1 %
        break;
    }
  }
  /// What changes with the cells alone.
  void take_cells(const PolyData& data) {
    poly_->Initialize();
    poly_->SetPoints(points_);
    if (data.vertices.size()) poly_->SetVerts(copy(data.vertices));
    if (data.lines.size()) poly_->SetLines(copy(data.lines));
    if (data.polygons.size()) poly_->SetPolys(copy(data.polygons));
    poly_->GetFieldData()->AddArray(time_);
    for (const PolyData::Names& n : data.names)
      poly_->GetFieldData()->AddArray(copy(n));
    make_arrays(data);
    topology_ = data.topology;
  }

  void make_arrays(const PolyData& data) {
    poly_->GetPointData()->Initialize();
    poly_->GetCellData()->Initialize();
    point_arrays_.clear();
    cell_arrays_.clear();
    for (const PolyData::Array& a : data.point_data) {
      point_arrays_.push_back(array_for(a));
      if (a.name == data.normals)
        poly_->GetPointData()->SetNormals(point_arrays_.back());
      else
        poly_->GetPointData()->AddArray(point_arrays_.back());
    }
    for (const PolyData::Array& a : data.cell_data) {
      cell_arrays_.push_back(array_for(a));
      poly_->GetCellData()->AddArray(cell_arrays_.back());
    }
  }

 private:
  vtkNew<vtkXMLPolyDataWriter> writer_;
  vtkNew<vtkDoubleArray> time_;
  vtkNew<vtkPolyData> poly_;
  vtkNew<vtkPoints> points_;
  std::vector<vtkSmartPointer<vtkDataArray>> point_arrays_, cell_arrays_;
  std::optional<std::uint64_t> topology_;
  std::optional<FrameTemplate> template_;
};

}  // namespace
}  // namespace whirl::io

WHIRL_DEFINE_PLUGIN
WHIRL_PLUGIN_EXPORT whirl::io::PolyDataWriter* whirl_vtk_make_writer(
    whirl::Compression compression) {
  return new whirl::io::Writer(compression);
}
